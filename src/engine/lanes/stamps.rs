//! Stamps: for each lane, the number of the scan that set a latch last, or another slot that needs it.
//!
//! A scan leaves a **row**: for each stamp, the lanes in which it was set. Rows of [`ROWS`] scans, an **epoch**, are kept
//! as they are; then they are summed up into the number of the last scan of each lane, as bit planes: the low bits of it,
//! and whether it was in this **era** of numbers with the same high bits, or in the one before; the high bits are brought
//! up to date when an era ends. So a scan costs one store a stamp, and an epoch some ten planes.
//!
//! An **answer** is whether a latch was last set in one of the scans that a preset [reaches](History::reach), which are
//! all before some number. How these numbers go on while an epoch lasts is foreseen at its beginning, and the answers are
//! made for all its scans at once, of what was before: each lies in the row of its scan until that scan sets it, so that
//! both take one line of memory. It holds in the lanes in which the latch was not set since the epoch began; those are
//! the **recent** ones, words that scans add to. When times come otherwise than was foreseen, the answers that are left
//! are made again. Where a preset reaches into this epoch, the answer is whether no row after that has the lane: then
//! those are what is recent.

use std::ops::Range;

use super::history::History;
use super::plan::Plan;
use super::word::Word;

/// Scans of an epoch: a power of two, so that the number of a scan in it is some bits of its number.
const ROWS: usize = 1 << ROW_BITS;
const ROW_BITS: usize = 3;

/// Low bits of a scan's number, which are kept up to date with every epoch; and epochs of an era.
const LOW_BITS: usize = 8;
const ERA_BITS: usize = LOW_BITS - ROW_BITS;

/// What is foreseen of a preset: how far it reaches in the scan of a row, and whether one further with each after it.
#[derive(Clone, Copy, PartialEq, Eq, Default, Debug)]
struct Foreseen {
    row: usize,
    end: u64,
    goes_on: bool,
}

impl Foreseen {
    fn end_at(self, row: usize) -> u64 {
        if self.goes_on { self.end + (row - self.row) as u64 } else { self.end }
    }
}

/// See the module.
#[derive(Clone, PartialEq, Debug)]
pub(super) struct Stamps {
    /// How many, and words of a row or plane.
    count: usize,
    stride: usize,
    /// Rows, one after another.
    rows: Vec<Word>,
    /// Planes of the low bits, one after another, the lowest first.
    low: Vec<Word>,
    /// The lanes that were set in this era, before this epoch; and those in the era before.
    era: Vec<Word>,
    era_before: Vec<Word>,
    /// By bit: planes of the high bits of numbers before this era. Those that no number has yet are not there.
    high: Vec<Vec<Word>>,
    foreseen: Vec<Foreseen>,
    /// Presets that reach into this epoch, or will before its end.
    short: Vec<usize>,
}

fn epoch(scan: u64) -> u64 {
    scan >> ROW_BITS
}

fn era(epoch: u64) -> u64 {
    epoch >> ERA_BITS
}

fn row(scan: u64) -> usize {
    usize::try_from(scan).unwrap_or_default() % ROWS
}

impl Stamps {
    /// Before the first scan.
    pub(super) fn new(plan: &Plan) -> Self {
        let count = plan.stamps.len();
        // An odd number of lines of the cache: so rows and planes of a stamp do not contend for the same place in it.
        let stride = count | 1;
        Self {
            count,
            stride,
            rows: vec![Word::ZEROS; ROWS * stride],
            low: vec![Word::ZEROS; LOW_BITS * stride],
            // By scan 0, in all lanes.
            era: vec![Word::ONES; count],
            era_before: vec![Word::ZEROS; count],
            high: Vec::new(),
            foreseen: vec![Foreseen::default(); plan.presets.len()],
            short: Vec::new(),
        }
    }

    /// The row of a scan of this epoch.
    pub(super) fn row(&mut self, scan: u64) -> &mut [Word] {
        &mut self.rows[row(scan) * self.stride..][..self.count]
    }

    /// Whether a scan that has begun is the first of an epoch, so that the one before is to be summed up.
    pub(super) fn ends_epoch(&self, history: &History) -> bool {
        row(history.last()) == 0 && self.count > 0
    }

    /// Makes the answers for a scan that has begun.
    #[inline]
    pub(super) fn begin(&mut self, plan: &Plan, history: &History, words: &mut [Word]) {
        let scan = history.last();
        if row(scan) == 0 {
            plan.stamps.iter().filter_map(|stamp| stamp.recent).for_each(|word| words[word as usize] = Word::ZEROS);
            self.short.clear();
        }
        if row(scan) == 0 || !history.went_on() {
            self.foresee_all(plan, history);
        }
        for preset in &self.short {
            let end = history.reach(*preset);
            if epoch(end) == epoch(scan) {
                for stamp in plan.presets[*preset].stamps.clone() {
                    let after = (row(end)..row(scan)).map(|row| self.rows[row * self.stride + stamp]);
                    let recent = after.fold(Word::ZEROS, |recent, row| recent | row);
                    if let Some(word) = plan.stamps[stamp].recent {
                        words[word as usize] = recent;
                    }
                }
            }
        }
    }

    /// In a scan that has begun, a task does not run: nothing of it is set.
    #[cold]
    pub(super) fn leave_out(&mut self, plan: &Plan, task: usize, scan: u64) {
        for (word, stamp) in self.row(scan).iter_mut().zip(&plan.stamps) {
            if stamp.task == task {
                *word = Word::ZEROS;
            }
        }
    }

    /// Makes the answers that were not foreseen, from the scan on that has begun.
    fn foresee_all(&mut self, plan: &Plan, history: &History) {
        let scan = history.last();
        let from = row(scan);
        for (index, preset) in plan.presets.iter().enumerate() {
            let new = Foreseen { row: from, end: history.reach(index), goes_on: history.goes_on(index) };
            let old = self.foreseen[index];
            if from > 0 && old.end_at(from) == new.end && old.goes_on == new.goes_on {
                continue;
            }
            self.foreseen[index] = new;
            if epoch(new.end_at(ROWS - 1)) >= epoch(scan) && !self.short.contains(&index) {
                self.short.push(index);
            }
            self.foresee(preset.stamps.clone(), new, epoch(scan));
        }
    }

    /// Makes the answers of some stamps for the scans that are left of this epoch.
    fn foresee(&mut self, stamps: Range<usize>, foreseen: Foreseen, this: u64) {
        let Foreseen { row: from, end, goes_on } = foreseen;
        let (first, first_row) = (epoch(end), row(end));
        let reaches_next = goes_on && first_row + (ROWS - 1 - from) >= ROWS;
        let low = &self.low;
        for stamp in stamps {
            let plane = |bit: usize| low[bit * self.stride + stamp];
            let (before, within) = self.around(stamp, first, this);
            let next = if reaches_next { self.around(stamp, first + 1, this).1 } else { Word::ZEROS };
            let below = below([plane(0), plane(1), plane(2)]);
            let before_next = before | within;
            for row in from..ROWS {
                let end = first_row + if goes_on { row - from } else { 0 };
                self.rows[row * self.stride + stamp] = match end.checked_sub(ROWS) {
                    None => before | within & below[end],
                    Some(end) => before_next | next & below[end],
                };
            }
        }
    }

    /// The lanes that were last set before an epoch, and those in it, of what was before this one.
    #[inline]
    fn around(&self, stamp: usize, epoch: u64, this: u64) -> (Word, Word) {
        let in_era = self.era[stamp];
        let (mut before, mut within) = match era(this).checked_sub(era(epoch)) {
            // Later than all that was.
            None => return (Word::ONES, Word::ZEROS),
            Some(0) => (!in_era, in_era),
            Some(1) => {
                let within = self.era_before[stamp] & !in_era;
                (!(in_era | within), within)
            }
            Some(_) => {
                let (mut before, mut within) = (Word::ZEROS, !in_era);
                for (bit, plane) in self.high.iter().enumerate().rev() {
                    narrow(&mut before, &mut within, plane[stamp], era(epoch) >> bit & 1 != 0);
                }
                (before, within)
            }
        };
        for bit in (0..ERA_BITS).rev() {
            let plane = self.low[(ROW_BITS + bit) * self.stride + stamp];
            narrow(&mut before, &mut within, plane, epoch >> bit & 1 != 0);
        }
        (before, within)
    }

    /// Adds the rows of the epoch that ends, before the scan that has begun, to the numbers.
    pub(super) fn end_epoch(&mut self, history: &History) {
        let ended = epoch(history.last()) - 1;
        for stamp in 0..self.count {
            let (any, number) = self.sum(stamp);
            let plane = |bit: usize| bit * self.stride + stamp;
            for (bit, new) in number.into_iter().enumerate() {
                let plane = &mut self.low[plane(bit)];
                *plane = *plane & !any | new;
            }
            for bit in 0..ERA_BITS {
                let plane = &mut self.low[plane(ROW_BITS + bit)];
                *plane = if ended >> bit & 1 != 0 { *plane | any } else { *plane & !any };
            }
            self.era[stamp] |= any;
        }
        if era(ended) != era(ended + 1) {
            self.end_era(era(ended));
        }
    }

    /// Brings the high bits of the numbers up to date.
    fn end_era(&mut self, ended: u64) {
        while u64::BITS - ended.leading_zeros() > u32::try_from(self.high.len()).unwrap_or(u32::MAX) {
            self.high.push(vec![Word::ZEROS; self.count]);
        }
        for (bit, plane) in self.high.iter_mut().enumerate() {
            for (plane, any) in plane.iter_mut().zip(&self.era) {
                *plane = if ended >> bit & 1 != 0 { *plane | *any } else { *plane & !*any };
            }
        }
        std::mem::swap(&mut self.era, &mut self.era_before);
        self.era.fill(Word::ZEROS);
    }

    /// Of all rows: the lanes with any, and the bits of the last row that has each, the lowest first.
    #[inline]
    fn sum(&self, stamp: usize) -> (Word, [Word; ROW_BITS]) {
        let row = |row: usize| self.rows[row * self.stride + stamp];
        // Of two halves, the later counts in the lanes that it has, and whether it has is the bit that tells them apart.
        let two = |first: usize| (row(first) | row(first + 1), row(first + 1));
        let four = |first: usize| {
            let ((early, early_0), (late, late_0)) = (two(first), two(first + 2));
            (early | late, early_0 & !late | late_0, late)
        };
        let ((early, early_0, early_1), (late, late_0, late_1)) = (four(0), four(4));
        (early | late, [early_0 & !late | late_0, early_1 & !late | late_1, late])
    }

    /// The lanes in which the last scan of this epoch that set one stamp is not after the last that set another, if any
    /// set that; a scan of an earlier epoch counts as before all. All rows must have been set.
    pub(super) fn not_after(&self, one: usize, other: usize) -> Word {
        let ((any, number), (other_any, other_number)) = (self.sum(one), self.sum(other));
        let (mut less, mut same) = (Word::ZEROS, Word::ONES);
        for (bit, other_bit) in number.into_iter().zip(other_number).rev() {
            less |= same & other_bit & !bit;
            same = same & (bit & other_bit | !(bit | other_bit));
        }
        other_any & (!any | less | same)
    }

    /// The scan before `until` that set a lane last, of those up to the last one; 0 if none did.
    ///
    /// `until` must not be before the scan that set it last, if that is of an earlier epoch than the last one's.
    pub(super) fn last_set(&self, stamp: usize, lane: usize, last: u64, until: u64) -> u64 {
        let rows = epoch(last) * ROWS as u64..until.min(last + 1);
        let in_rows = rows.rev().find(|scan| self.rows[row(*scan) * self.stride + stamp].get(lane));
        in_rows.unwrap_or_else(|| {
            let bit = |(bit, plane): (usize, Word)| u64::from(plane.get(lane)) << bit;
            let low: u64 = self.low[stamp..].iter().step_by(self.stride).copied().enumerate().map(bit).sum();
            let high: u64 = self.high.iter().map(|plane| plane[stamp]).enumerate().map(bit).sum();
            let high = if self.era[stamp].get(lane) { era(epoch(last)) } else { high };
            high << LOW_BITS | low
        })
    }
}

/// Takes one more bit of numbers into account, from the highest on, in comparing them with one that has the bit or not:
/// lanes that are below so far, and those that are the same.
#[inline]
fn narrow(before: &mut Word, within: &mut Word, plane: Word, bit: bool) {
    if bit {
        *before |= *within & !plane;
        *within &= plane;
    } else {
        *within &= !plane;
    }
}

/// The lanes in which a number of three bits is below 0, 1, up to 7.
#[inline]
fn below([low, middle, high]: [Word; ROW_BITS]) -> [Word; ROWS] {
    let any = low | middle;
    [
        Word::ZEROS,
        !(any | high),
        !(middle | high),
        !(high | low & middle),
        !high,
        !(high & any),
        !(high & middle),
        !(high & middle & low),
    ]
}
