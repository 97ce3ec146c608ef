//! Tracked slots, of all lanes of a group: which choice was taken last, and in which scan.
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
use super::plan::{Class, Plan, Track};
use super::recognise::Leaf;
use super::word::Word;

/// Scans of an epoch: a power of two, so that the number of a scan in it is some bits of its number.
pub(super) const ROWS: usize = 1 << ROW_BITS;
pub(super) const ROW_BITS: usize = 4;

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
    /// By class: memory for the sums of an epoch.
    sums: Vec<Vec<Word>>,
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
            sums: plan.classes.iter().map(|class| vec![Word::ZEROS; class.sums() * class.tracks.len()]).collect(),
            codes: vec![Word::ZEROS; plan.row_words],
            planes: Vec::new(),
            values: vec![None; plan.tracks.len()],
            epochs: vec![None; plan.presets.len()],
            windows: vec![[Word::ZEROS; ROWS]; plan.dues.len()],
        }
    }

    /// Makes the answers for a scan that has begun, and its row ready: with all 0, if not everything will run. `sum_up`
    /// makes the sums of a class out of rows.
    pub(super) fn begin(
        &mut self,
        plan: &Plan,
        history: &History,
        words: &mut [Word],
        all_run: bool,
        sum_up: impl Fn(usize, &mut [Word], &mut [Word]),
    ) {
        let scan = history.last();
        if plan.tracks.is_empty() {
            return;
        }
        let last = row(scan - 1) * self.row_words;
        for (set, noted) in self.set.iter_mut().zip(&self.rows[last..]) {
            *set |= *noted;
        }
        if row(scan) == 0 {
            for (class, to) in self.sums.iter_mut().enumerate() {
                sum_up(class, to, &mut self.rows);
            }
            self.end_epoch(plan, history);
        }
        if !all_run {
            self.row(scan).fill(Word::ZEROS);
        }
        let answers = &mut words[plan.first_due as usize..][..plan.dues.len()];
        for (index, preset) in plan.presets.iter().enumerate() {
            // One past the last scan that is long ago.
            let end = history.reach(index);
            let reached = end.wrapping_sub(1);
            if end == scan || end == 0 {
                answers[preset.dues.clone()].fill(Word::all(end != 0));
            } else if epoch(reached) == epoch(scan) {
                for due in preset.dues.clone() {
                    let later = row(end)..row(scan);
                    let set = later.fold(Word::ZEROS, |set, at| set | self.rows[at * self.row_words + plan.dues[due]]);
                    answers[due] = !set;
                }
            } else {
                if self.epochs[index] != Some(epoch(reached)) {
                    self.epochs[index] = Some(epoch(reached));
                    for due in preset.dues.clone() {
                        self.windows[due] = self.window(plan.dues[due], epoch(reached));
                    }
                }
                let at = row(reached);
                let dues = answers[preset.dues.clone()].iter_mut();
                let windows = &self.windows[preset.dues.clone()];
                for ((answer, window), latch) in dues.zip(windows).zip(&plan.dues[preset.dues.clone()]) {
                    *answer = window[at] & !self.set[*latch];
                }
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

    /// Adds the sums of the epoch before the one that begins to those of all before.
    #[cold]
    #[inline(never)]
    fn end_epoch(&mut self, plan: &Plan, history: &History) {
        let ended = epoch(history.last()) - 1;
        let highest = (history.last() - 1).checked_ilog2().map_or(0, |bit| bit as usize + 1);
        while self.planes.len() < highest.clamp(ROW_BITS, PLANES) {
            self.planes.push(vec![Word::ZEROS; plan.tracks.len()]);
        }
        // Differences look at what their latches held, and the latches are the first class.
        for (index, class) in plan.classes.iter().enumerate().rev() {
            self.add_codes(plan, history, index, class);
            self.add_numbers(index, class, ended);
        }
        for (window, latch) in self.windows.iter_mut().zip(&plan.dues) {
            let still = !self.set[*latch];
            window.iter_mut().for_each(|word| *word &= still);
        }
        self.set.fill(Word::ZEROS);
    }

    /// Brings the last codes up to date. A difference to a latch that was set since becomes a value that is kept.
    fn add_codes(&mut self, plan: &Plan, history: &History, index: usize, class: &Class) {
        let (length, sums) = (class.tracks.len(), &self.sums[index]);
        let any = &sums[..length];
        // The only bit of a code is whether there is one.
        let code = |bit: usize| if class.bits == 1 { any } else { &sums[(1 + ROW_BITS + bit) * length..][..length] };
        for bit in 0..class.bits {
            let codes = &mut self.codes[class.row + bit * length..][..length];
            for ((code, new), any) in codes.iter_mut().zip(code(bit)).zip(any) {
                *code = *code & !*any | *new;
            }
        }
        for (place, track) in class.tracks.clone().enumerate() {
            let since = plan.tracks[track].since.iter();
            let moved = since.fold(Word::ZEROS, |all, (code, latch)| {
                all | self.moved(&plan.tracks[track], index, place, *code, *latch)
            });
            for lane in moved.lanes() {
                let scans = history.last() - ROWS as u64..history.last();
                let value = self.value(plan, history, track, lane, scans);
                self.keep(&plan.tracks[track], track, lane, value);
                for bit in 0..class.bits {
                    self.codes[class.row + bit * length + place].set(lane, false);
                }
            }
        }
    }

    /// Brings the numbers of the scans of the last codes up to date.
    fn add_numbers(&mut self, index: usize, class: &Class, ended: u64) {
        let (length, sums) = (class.tracks.len(), &self.sums[index]);
        let any = &sums[..length];
        for (bit, plane) in self.planes.iter_mut().enumerate() {
            let plane = &mut plane[class.tracks.clone()];
            if bit < ROW_BITS {
                let number = &sums[(1 + bit) * length..][..length];
                for ((plane, number), any) in plane.iter_mut().zip(number).zip(any) {
                    *plane = *plane & !*any | *number;
                }
            } else if ended >> (bit - ROW_BITS) & 1 != 0 {
                plane.iter_mut().zip(any).for_each(|(plane, any)| *plane |= *any);
            } else {
                plane.iter_mut().zip(any).for_each(|(plane, any)| *plane &= !*any);
            }
        }
    }

    /// The lanes in which a slot now holds a difference to a latch that was set in the same scan or later, in the epoch
    /// that ended: in a row as late as that of the code, or in any if the code is from before.
    fn moved(&self, track: &Track, index: usize, place: usize, code: usize, latch: usize) -> Word {
        let holding = (0..track.tracked.bits()).fold(Word::ONES, |holding, bit| {
            let word = self.codes[track.row + bit * track.stride];
            holding & if code >> bit & 1 != 0 { word } else { !word }
        });
        // Latches are the first class, in their own order.
        let (sums, latches) = (&self.sums[index], &self.sums[0]);
        let (length, latch_length) = (track.stride, latches.len() / (1 + ROW_BITS));
        let (any, set) = (sums[place], latches[latch]);
        let (mut less, mut same) = (Word::ZEROS, Word::ONES);
        for bit in (1..=ROW_BITS).rev() {
            let (own, of_latch) = (sums[bit * length + place], latches[bit * latch_length + latch]);
            less |= same & of_latch & !own;
            same &= own & of_latch | !(own | of_latch);
        }
        holding & set & (!any | less | same)
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
            let bit = |bit: usize| usize::from(words[track.row + bit * track.stride].get(lane)) << bit;
            (0..track.tracked.bits()).map(bit).sum::<usize>()
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
        for bit in 0..track.tracked.bits() {
            let word = track.row + bit * track.stride;
            self.codes[word].set(lane, false);
            self.rows.chunks_mut(self.row_words).for_each(|row| row[word].set(lane, false));
        }
        true
    }
}
