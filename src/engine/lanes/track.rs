//! Tracked slots, of all 128 lanes: which choice was taken last, and in which scan.
//!
//! A scan leaves a **row** of codes: for each tracked slot, in each lane, which of its [leaves](Leaf) it was given, or 0
//! where it kept what it held. A row costs the scan one store a bit. Rows of [`ROWS`] scans side by side, an **epoch**,
//! are kept as they are; then they are summed up into the last code of each lane, other than 0, and the number of its
//! scan as bit planes. So what a slot holds can be told at any time, exactly: the code and the scan are in the rows of
//! this epoch or, where these are all 0, in the sums; and with them the value is the leaf's, at that scan.
//!
//! - A constant is itself, and `now` the time of that scan in the [`History`].
//! - `now` minus a latch is that time minus what the latch held **before** that scan. That is found the same way, as long
//!   as the latch was not set since: by the rows before that scan, or the sums. When an epoch is summed up in which a
//!   latch was set in the same scan or later, in a lane whose slot still holds an earlier difference, the value is
//!   computed for that lane and kept as it is, as is what is written from outside.
//!
//! An **answer** is whether a latch was last set in one of the scans that a preset [reaches](History::reach), which are
//! all before some number. Where that number lies in this epoch, it is whether no later row has the latch's bit. Else it
//! is whether the sums say so and no row of this epoch has the bit; of the sums, the answers for all numbers of one
//! earlier epoch, a **window**, are computed at once, since the number goes on from scan to scan. At the end of an epoch
//! what was set in it is taken out of the windows, for it was set after any scan that they tell of.

use std::ops::Range;

use super::LANES;
use super::history::History;
use super::plan::{Plan, Track};
use super::recognise::Leaf;
use super::word::Word;

/// Scans of an epoch: a power of two, so that the number of a scan in it is some bits of its number.
pub(super) const ROWS: usize = 1 << ROW_BITS;
const ROW_BITS: usize = 4;

/// Bits of a code, at most.
const CODE_BITS: usize = 3;

/// Bits of a scan's number.
const PLANES: usize = 32;

/// Values that are kept for themselves, of lanes with code 0.
type Values = Option<Box<[u64; LANES]>>;

/// See the module.
#[derive(Clone, PartialEq, Debug)]
pub(super) struct Tracks {
    /// Rows side by side.
    rows: Vec<Word>,
    row_words: usize,
    /// By latch: the lanes in which it was set in this epoch, before the last scan's row was added.
    set: Vec<Word>,
    /// By tracked slot, as in a row: the last code before this epoch.
    codes: Vec<Word>,
    /// By bit, then by tracked slot: the number of the scan that had it. Bits that no number has yet are not there.
    planes: Vec<Vec<Word>>,
    /// By tracked slot: what the lanes with code 0 hold, where it is not the initial value.
    values: Vec<Values>,
    /// By preset: the epoch that its window tells of.
    epochs: Vec<Option<u64>>,
    /// By answer: the lanes whose latch was last set by each scan of the window's epoch, or before.
    windows: Vec<[Word; ROWS]>,
}

fn epoch(scan: u64) -> u64 {
    scan >> ROW_BITS
}

fn row(scan: u64) -> usize {
    usize::try_from(scan).unwrap_or_default() % ROWS
}

impl Tracks {
    /// Before the first scan.
    pub(super) fn new(plan: &Plan) -> Self {
        Self {
            rows: vec![Word::ZEROS; plan.row_words * ROWS],
            row_words: plan.row_words,
            set: vec![Word::ZEROS; plan.latches],
            codes: vec![Word::ZEROS; plan.row_words],
            planes: Vec::new(),
            values: vec![None; plan.tracks.len()],
            epochs: vec![None; plan.presets.len()],
            windows: vec![[Word::ZEROS; ROWS]; plan.dues.len()],
        }
    }

    /// Makes the answers for a scan that has begun, and its row ready: with all 0, if not everything will run.
    pub(super) fn begin(&mut self, plan: &Plan, history: &History, words: &mut [Word], all_run: bool) {
        let scan = history.last();
        if !plan.tracks.is_empty() {
            let last = row(scan - 1) * self.row_words;
            for (set, noted) in self.set.iter_mut().zip(&self.rows[last..]) {
                *set |= *noted;
            }
            if row(scan) == 0 {
                self.end_epoch(plan, history);
            }
            if !all_run {
                self.row(scan).fill(Word::ZEROS);
            }
        }
        let answers = &mut words[plan.first_due as usize..][..plan.dues.len()];
        for (index, preset) in plan.presets.iter().enumerate() {
            // One past the last scan that is long ago.
            let end = history.reach(index);
            if end == scan {
                answers[preset.dues.clone()].fill(Word::ONES);
                continue;
            }
            let Some(reached) = end.checked_sub(1) else {
                answers[preset.dues.clone()].fill(Word::ZEROS);
                continue;
            };
            if epoch(reached) == epoch(scan) {
                for due in preset.dues.clone() {
                    let later = row(end)..row(scan);
                    let set = later.fold(Word::ZEROS, |set, at| set | self.rows[at * self.row_words + plan.dues[due]]);
                    answers[due] = !set;
                }
                continue;
            }
            if self.epochs[index] != Some(epoch(reached)) {
                self.epochs[index] = Some(epoch(reached));
                for due in preset.dues.clone() {
                    self.windows[due] = self.window(plan.dues[due], epoch(reached));
                }
            }
            let at = row(reached);
            for due in preset.dues.clone() {
                answers[due] = self.windows[due][at] & !self.set[plan.dues[due]];
            }
        }
    }

    /// The row of a scan of this epoch.
    pub(super) fn row(&mut self, scan: u64) -> &mut [Word] {
        &mut self.rows[row(scan) * self.row_words..][..self.row_words]
    }

    /// The lanes in which a latch was last set by each scan of an earlier epoch, or before, as the sums tell.
    fn window(&self, latch: usize, epoch: u64) -> [Word; ROWS] {
        // The lanes in which it was set before the epoch, and in it.
        let (mut before, mut within) = (Word::ZEROS, Word::ONES);
        for (bit, plane) in self.planes.iter().enumerate().skip(ROW_BITS).rev() {
            let plane = plane[latch];
            if epoch >> (bit - ROW_BITS) & 1 != 0 {
                before |= within & !plane;
                within &= plane;
            } else {
                within &= !plane;
            }
        }
        // The same of each half of the epoch, of each half of those, and so on.
        let (mut less, mut same) = ([Word::ZEROS; ROWS], [Word::ZEROS; ROWS]);
        (less[0], same[0]) = (before, within);
        for (parts, plane) in self.planes[..ROW_BITS].iter().rev().enumerate() {
            let plane = plane[latch];
            for part in (0..1 << parts).rev() {
                let lower = same[part] & !plane;
                (less[2 * part + 1], same[2 * part + 1]) = (less[part] | lower, same[part] & plane);
                (less[2 * part], same[2 * part]) = (less[part], lower);
            }
        }
        less.iter_mut().zip(same).for_each(|(less, same)| *less |= same);
        less
    }

    /// Sums up the epoch before the one that begins.
    #[cold]
    #[inline(never)]
    fn end_epoch(&mut self, plan: &Plan, history: &History) {
        let ended = epoch(history.last()) - 1;
        let highest = (history.last() - 1).checked_ilog2().map_or(0, |bit| bit as usize + 1);
        while self.planes.len() < highest.max(ROW_BITS).min(PLANES) {
            self.planes.push(vec![Word::ZEROS; plan.tracks.len()]);
        }
        // Differences look at what their latches held, so latches come last.
        for (index, track) in plan.tracks.iter().enumerate().rev() {
            self.sum_up(plan, history, index, track, ended);
        }
        for (window, latch) in self.windows.iter_mut().zip(&plan.dues) {
            let still = !self.set[*latch];
            window.iter_mut().for_each(|word| *word &= still);
        }
        self.set.fill(Word::ZEROS);
    }

    fn sum_up(&mut self, plan: &Plan, history: &History, index: usize, track: &Track, ended: u64) {
        let bits = track.tracked.bits();
        // Lanes of which the last code is not found yet; then those of which it was before this epoch.
        let mut open = Word::ONES;
        let mut codes = [Word::ZEROS; CODE_BITS];
        let mut numbers = [Word::ZEROS; ROW_BITS];
        for at in (0..ROWS).rev() {
            let noted = &self.rows[at * self.row_words + track.row..][..bits];
            let found = noted.iter().fold(Word::ZEROS, |any, bit| any | *bit) & open;
            if found.is_zero() {
                continue;
            }
            for (code, noted) in codes.iter_mut().zip(noted) {
                *code |= *noted & found;
            }
            for (bit, number) in numbers.iter_mut().enumerate() {
                if at >> bit & 1 != 0 {
                    *number |= found;
                }
            }
            open &= !found;
            if open.is_zero() {
                break;
            }
        }
        for (code, before) in codes.iter_mut().zip(&self.codes[track.row..][..bits]) {
            *code |= *before & open;
        }
        // Before any of them loses its code.
        let moved = track.since.iter().map(|(code, latch)| self.moved(track, *code, *latch, codes, open));
        for lane in moved.fold(Word::ZEROS, |all, moved| all | moved).lanes() {
            let value = self.value(plan, history, index, lane, ended * ROWS as u64..history.last());
            self.keep(track, index, lane, value);
            codes.iter_mut().for_each(|code| code.set(lane, false));
        }
        self.codes[track.row..][..bits].copy_from_slice(&codes[..bits]);
        for (bit, plane) in self.planes.iter_mut().enumerate() {
            let number = match numbers.get(bit) {
                Some(number) => *number,
                None => Word::all(ended >> (bit - ROW_BITS) & 1 != 0) & !open,
            };
            plane[index] = plane[index] & open | number;
        }
    }

    /// The lanes in which a slot holds a difference to a latch that was set in the same scan or later, in the epoch that
    /// ended. `open` are those whose code is from before.
    fn moved(&self, track: &Track, code: usize, latch: usize, codes: [Word; CODE_BITS], mut open: Word) -> Word {
        let bits = track.tracked.bits();
        let has = |bits: &[Word]| {
            let pairs = bits.iter().enumerate();
            pairs.fold(Word::ONES, |has, (bit, word)| has & if code >> bit & 1 != 0 { *word } else { !*word })
        };
        let holding = has(&codes[..bits]);
        if (holding & self.set[latch]).is_zero() {
            return Word::ZEROS;
        }
        let mut moved = holding & open & self.set[latch];
        let mut set = Word::ZEROS;
        open = !open;
        for at in (0..ROWS).rev() {
            let row = &self.rows[at * self.row_words..];
            set |= row[latch];
            let noted = &row[track.row..][..bits];
            let found = noted.iter().fold(Word::ZEROS, |any, bit| any | *bit) & open;
            moved |= found & has(noted) & set;
            open &= !found;
            if open.is_zero() {
                break;
            }
        }
        moved
    }

    /// Keeps a value for itself in a lane.
    fn keep(&mut self, track: &Track, index: usize, lane: usize, value: u64) {
        let values = self.values[index].get_or_insert_with(|| Box::new([track.initial; LANES]));
        values[lane] = value;
    }

    /// What a slot holds in a lane after the last scan, in register form.
    pub(super) fn get(&self, plan: &Plan, history: &History, index: usize, lane: usize) -> u64 {
        let last = history.last();
        self.value(plan, history, index, lane, epoch(last) * ROWS as u64..last + 1)
    }

    /// What it holds after the last of some scans, which begin with those that the rows tell of.
    fn value(&self, plan: &Plan, history: &History, index: usize, lane: usize, scans: Range<u64>) -> u64 {
        let track = &plan.tracks[index];
        let code_in = |words: &[Word]| {
            let bits = words[track.row..].iter().take(track.tracked.bits()).enumerate();
            bits.fold(0, |code, (bit, word)| code | usize::from(word.get(lane)) << bit)
        };
        let found = scans.clone().rev().map(|scan| (code_in(&self.rows[row(scan) * self.row_words..]), scan));
        let (code, scan) = found.into_iter().find(|(code, _)| *code != 0).unwrap_or_else(|| {
            let number = |(bit, plane): (usize, &Vec<Word>)| u64::from(plane[index].get(lane)) << bit;
            (code_in(&self.codes), self.planes.iter().enumerate().map(number).sum())
        });
        match code.checked_sub(1).map(|leaf| track.tracked.leaves[leaf]) {
            None => self.values[index].as_ref().map_or(track.initial, |values| values[lane]),
            Some(Leaf::Constant(bits)) => bits,
            Some(Leaf::Now) => history.time(scan).cast_unsigned(),
            Some(Leaf::Since(_)) => {
                let latch = track.since.iter().find(|(since, _)| *since == code).map_or(0, |(_, latch)| *latch);
                // A latch is no difference, so this goes no deeper.
                let start = self.value(plan, history, latch, lane, scans.start..scan.max(scans.start));
                history.time(scan).cast_unsigned().wrapping_sub(start)
            }
        }
    }

    /// Gives a slot a value in a lane, unless it is a latch, which can hold no other than times of scans.
    pub(super) fn set(&mut self, plan: &Plan, index: usize, lane: usize, value: u64) -> bool {
        let track = &plan.tracks[index];
        if index < plan.latches {
            return false;
        }
        self.keep(track, index, lane, value);
        let own = track.row..track.row + track.tracked.bits();
        self.codes[own.clone()].iter_mut().for_each(|code| code.set(lane, false));
        for row in self.rows.chunks_mut(self.row_words) {
            row[own.clone()].iter_mut().for_each(|code| code.set(lane, false));
        }
        true
    }
}
