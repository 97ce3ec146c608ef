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

use super::epoch::{
    BITS, COMMON, ERA, ERA_BEFORE, ERA_BITS, IN_EITHER, IN_ERA, IN_ERA_BEFORE, KINDS, LOW, LOW_BITS, NEXT_BITS,
    NEXT_IN_ERA, NEXT_IN_ERA_BEFORE, ROW_BITS, ROWS, below, sum,
};
use super::history::History;
use super::plan::{Plan, TRUE_WORD};
use super::word::Word;

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
    /// Rows, planes of the low bits from the lowest on, and the lanes that were set in this era, before this epoch, and
    /// in the era before.
    words: Vec<Word>,
    /// By bit: planes of the high bits of numbers before this era. Those that no number has yet are not there.
    high: Vec<Vec<Word>>,
    foreseen: Vec<Foreseen>,
    /// What the segments of an epoch are told.
    common: Vec<Word>,
    /// The epoch that they were told of, and in which.
    told: Option<(u64, u64)>,
    /// Presets that reach into this epoch, or will before its end.
    short: Vec<usize>,
}

/// Runs a segment of [`epoch`](super::epoch), by its number: on the common words, on those of stamps from the first on,
/// for so many of them.
pub(super) type Run<'r> = &'r dyn Fn(usize, &mut [Word], &mut [Word], usize);

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
        let stride = plan.stamp_stride();
        let mut words = vec![Word::ZEROS; KINDS * stride];
        // By scan 0, in all lanes.
        words[ERA * stride..][..count].fill(Word::ONES);
        let mut common = vec![Word::ZEROS; COMMON];
        common[TRUE_WORD as usize] = Word::ONES;
        Self {
            count,
            stride,
            words,
            high: Vec::new(),
            foreseen: vec![Foreseen::default(); plan.presets.len()],
            common,
            told: None,
            short: Vec::new(),
        }
    }

    /// A word of a stamp.
    #[inline]
    fn word(&self, kind: usize, stamp: usize) -> Word {
        self.words[kind * self.stride + stamp]
    }

    /// The row of a scan of this epoch.
    pub(super) fn row(&mut self, scan: u64) -> &mut [Word] {
        &mut self.words[row(scan) * self.stride..][..self.count]
    }

    /// Whether a scan that has begun is the first of an epoch, so that the one before is to be summed up.
    pub(super) fn ends_epoch(&self, history: &History) -> bool {
        row(history.last()) == 0 && self.count > 0
    }

    /// Makes the answers for a scan that has begun.
    #[inline]
    pub(super) fn begin(&mut self, plan: &Plan, history: &History, words: &mut [Word], run: Run<'_>) {
        let scan = history.last();
        if row(scan) == 0 {
            plan.stamps.iter().filter_map(|stamp| stamp.recent).for_each(|word| words[word as usize] = Word::ZEROS);
            self.short.clear();
        }
        if row(scan) == 0 || !history.went_on() {
            self.foresee_all(plan, history, run);
        }
        for preset in &self.short {
            let end = history.reach(*preset);
            if epoch(end) == epoch(scan) {
                for stamp in plan.presets[*preset].stamps.clone() {
                    let after = (row(end)..row(scan)).map(|row| self.word(row, stamp));
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
    fn foresee_all(&mut self, plan: &Plan, history: &History, run: Run<'_>) {
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
            if !self.foresee_quickly(preset.stamps.clone(), new, epoch(scan), run) {
                self.foresee(preset.stamps.clone(), new, epoch(scan));
            }
        }
    }

    /// Makes the answers of some stamps for the scans that are left of this epoch.
    fn foresee(&mut self, stamps: Range<usize>, foreseen: Foreseen, this: u64) {
        let Foreseen { row: from, end, goes_on } = foreseen;
        let (first, first_row) = (epoch(end), row(end));
        let reaches_next = goes_on && first_row + (ROWS - 1 - from) >= ROWS;
        for stamp in stamps {
            let (before, within) = self.around(stamp, first, this);
            let next = if reaches_next { self.around(stamp, first + 1, this).1 } else { Word::ZEROS };
            let below = below(std::array::from_fn(|bit| self.word(LOW + bit, stamp)));
            let before_next = before | within;
            for row in from..ROWS {
                let end = first_row + if goes_on { row - from } else { 0 };
                self.words[row * self.stride + stamp] = match end % ROWS {
                    0 if end == 0 => before,
                    0 => before_next,
                    below_end if end < ROWS => before | within & below[below_end - 1],
                    below_end => before_next | next & below[below_end - 1],
                };
            }
        }
    }

    /// The lanes that were last set before an epoch, and those in it, of what was before this one.
    #[inline]
    fn around(&self, stamp: usize, epoch: u64, this: u64) -> (Word, Word) {
        let in_era = self.word(ERA, stamp);
        let (mut before, mut within) = match era(this).checked_sub(era(epoch)) {
            // Later than all that was.
            None => return (Word::ONES, Word::ZEROS),
            Some(0) => (!in_era, in_era),
            Some(1) => {
                let within = self.word(ERA_BEFORE, stamp) & !in_era;
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
            let plane = self.word(LOW + ROW_BITS + bit, stamp);
            narrow(&mut before, &mut within, plane, epoch >> bit & 1 != 0);
        }
        (before, within)
    }

    /// Adds the rows of the epoch that ends, before the scan that has begun, to the numbers.
    pub(super) fn end_epoch(&mut self, history: &History, run: Run<'_>) {
        let ended = epoch(history.last()) - 1;
        self.told = None;
        self.tell_bits(BITS, ended);
        run(0, &mut self.common, &mut self.words, self.count);
        if era(ended) != era(ended + 1) {
            self.end_era(era(ended));
        }
    }

    /// Tells the segments the bits of an epoch.
    fn tell_bits(&mut self, first: usize, epoch: u64) {
        for (bit, word) in self.common[first..][..ERA_BITS].iter_mut().enumerate() {
            *word = Word::all(epoch >> bit & 1 != 0);
        }
    }

    /// Makes the answers of some stamps for all scans of this epoch, by a segment, if what is foreseen is the common case.
    fn foresee_quickly(&mut self, stamps: Range<usize>, foreseen: Foreseen, this: u64, run: Run<'_>) -> bool {
        let Foreseen { row: from, end, goes_on } = foreseen;
        let eras = [epoch(end), epoch(end) + 1].map(|epoch| era(this).checked_sub(era(epoch)));
        if from > 0 || !goes_on || eras[0].is_some_and(|ago| ago > 1) {
            return false;
        }
        // Presets side by side often reach the same epoch.
        if self.told != Some((epoch(end), this)) {
            self.told = Some((epoch(end), this));
            self.tell_bits(BITS, epoch(end));
            self.tell_bits(NEXT_BITS, epoch(end) + 1);
            for (word, holds) in [
                (IN_ERA, eras[0] == Some(0)),
                (IN_ERA_BEFORE, eras[0] == Some(1)),
                (IN_EITHER, eras[0].is_some()),
                (NEXT_IN_ERA, eras[1] == Some(0)),
                (NEXT_IN_ERA_BEFORE, eras[1] == Some(1)),
            ] {
                self.common[word] = Word::all(holds);
            }
        }
        run(1 + row(end), &mut self.common, &mut self.words[stamps.start..], stamps.len());
        true
    }

    /// Brings the high bits of the numbers up to date.
    fn end_era(&mut self, ended: u64) {
        while u64::BITS - ended.leading_zeros() > u32::try_from(self.high.len()).unwrap_or(u32::MAX) {
            self.high.push(vec![Word::ZEROS; self.count]);
        }
        for (bit, plane) in self.high.iter_mut().enumerate() {
            for (plane, any) in plane.iter_mut().zip(&self.words[ERA * self.stride..]) {
                *plane = if ended >> bit & 1 != 0 { *plane | *any } else { *plane & !*any };
            }
        }
        self.words.copy_within(ERA * self.stride..(ERA + 1) * self.stride, ERA_BEFORE * self.stride);
        self.words[ERA * self.stride..][..self.stride].fill(Word::ZEROS);
    }

    /// The lanes in which the last scan of this epoch that set one stamp is not after the last that set another, if any
    /// set that; a scan of an earlier epoch counts as before all. All rows must have been set.
    pub(super) fn not_after(&self, one: usize, other: usize) -> Word {
        let ((any, number), (other_any, other_number)) =
            [one, other].map(|stamp| sum(std::array::from_fn(|row| self.word(row, stamp)))).into();
        let (mut less, mut same) = (Word::ZEROS, Word::ONES);
        for (bit, other_bit) in number.into_iter().zip(other_number).rev() {
            less |= same & other_bit & !bit;
            same &= bit & other_bit | !(bit | other_bit);
        }
        other_any & (!any | less | same)
    }

    /// The scan before `until` that set a lane last, of those up to the last one; 0 if none did.
    ///
    /// `until` must not be before the scan that set it last, if that is of an earlier epoch than the last one's.
    pub(super) fn last_set(&self, stamp: usize, lane: usize, last: u64, until: u64) -> u64 {
        let rows = epoch(last) * ROWS as u64..until.min(last + 1);
        let in_rows = rows.rev().find(|scan| self.word(row(*scan), stamp).get(lane));
        in_rows.unwrap_or_else(|| {
            let bit = |(bit, plane): (usize, Word)| u64::from(plane.get(lane)) << bit;
            let low: u64 = (0..LOW_BITS).map(|at| bit((at, self.word(LOW + at, stamp)))).sum();
            let high: u64 = self.high.iter().map(|plane| plane[stamp]).enumerate().map(bit).sum();
            let high = if self.word(ERA, stamp).get(lane) { era(epoch(last)) } else { high };
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
