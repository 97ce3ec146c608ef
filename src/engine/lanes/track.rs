//! Tracked slots, of all lanes of a group: which choice was taken last, and in which scan.
//!
//! Which it was is the slot's **code**, bits in words that a scan writes as it does BOOLs: 0 for a value that is kept for
//! itself, else a [leaf](Leaf). With the number of the scan it tells the value:
//!
//! - A constant is itself, and `now` the time of that scan in the [`History`].
//! - `now` minus a latch is that time minus what the latch held **before** that scan.
//!
//! A slot that [follows](super::recognise::Tracked::follows) got its value in the last run of its task, and its latches
//! are as they were before. For a latch, and every other slot of which the value depends on the scan, a **stamp** tells in
//! which scan each lane was set last ([`stamps`](super::stamps)). There a difference is found by looking at what the latch
//! held before that scan, as long as the latch was not set since: when an epoch ends in which it was, in the same scan or
//! later, in a lane whose slot still holds that difference, the value is computed for that lane and kept as it is, as is
//! what is written from outside.

use super::LANES;
use super::history::History;
use super::plan::{Plan, Track};
use super::recognise::Leaf;
use super::stamps::{Run, Stamps};
use super::word::Word;

/// Values that are kept for themselves, of lanes with code 0.
type Values = Option<Box<[u64; LANES]>>;

/// See the module.
#[derive(Clone, PartialEq, Debug)]
pub(super) struct Tracks {
    pub(super) stamps: Stamps,
    /// By tracked slot: what the lanes with code 0 hold, where it is not the initial value.
    values: Vec<Values>,
    /// By task: its last run.
    ran: Vec<u64>,
}

impl Tracks {
    /// Before the first scan.
    pub(super) fn new(plan: &Plan) -> Self {
        Self { stamps: Stamps::new(plan), values: vec![None; plan.tracks.len()], ran: vec![0; plan.tasks.len()] }
    }

    /// Makes ready for a scan that has begun.
    #[inline]
    pub(super) fn begin(&mut self, plan: &Plan, history: &History, words: &mut [Word], run: Run<'_>) {
        if self.stamps.ends_epoch(history) {
            self.end_epoch(plan, history, words, run);
        }
        self.stamps.begin(plan, history, words, run);
    }

    /// Notes whether a task runs in a scan that has begun, before it does.
    #[inline]
    pub(super) fn note_run(&mut self, plan: &Plan, task: usize, scan: u64, runs: bool) {
        if runs {
            self.ran[task] = scan;
        } else {
            self.stamps.leave_out(plan, task, scan);
        }
    }

    /// Keeps the differences that cannot be told any more once an epoch is summed up, and sums it up.
    #[cold]
    #[inline(never)]
    fn end_epoch(&mut self, plan: &Plan, history: &History, words: &mut [Word], run: Run<'_>) {
        let last = history.last() - 1;
        for (index, track) in plan.tracks.iter().enumerate().filter(|(_, track)| !track.tracked.follows) {
            let moved = track
                .since
                .iter()
                .fold(Word::ZEROS, |all, (code, latch)| all | self.moved(track, &plan.tracks[*latch], *code, words));
            for lane in moved.lanes() {
                let value = self.value(plan, history, words, (index, lane), last);
                self.keep(track, words, (index, lane), value);
            }
        }
        self.stamps.end_epoch(history, run);
    }

    /// The lanes in which a slot holds a difference, as a code says, to a latch that was set in the same scan or later,
    /// in the epoch that ends.
    fn moved(&self, track: &Track, latch: &Track, code: usize, words: &[Word]) -> Word {
        let holding = track.codes.clone().enumerate().fold(Word::ONES, |holding, (bit, word)| {
            let word = words[word as usize];
            holding & if code >> bit & 1 != 0 { word } else { !word }
        });
        match (&track.stamps[..], &latch.stamps[..]) {
            ([own, ..], [of_latch, ..]) if !holding.is_zero() => holding & self.stamps.not_after(*own, *of_latch),
            _ => Word::ZEROS,
        }
    }

    /// Keeps a value for itself in a lane.
    fn keep(&mut self, track: &Track, words: &mut [Word], (index, lane): (usize, usize), value: u64) {
        let values = self.values[index].get_or_insert_with(|| Box::new([track.initial; LANES]));
        values[lane] = value;
        track.codes.clone().for_each(|word| words[word as usize].set(lane, false));
    }

    /// What a slot holds in a lane after the last scan, in register form.
    pub(super) fn get(&self, plan: &Plan, history: &History, words: &[Word], place: (usize, usize)) -> u64 {
        self.value(plan, history, words, place, history.last())
    }

    /// What it holds after a scan, of an epoch that is not summed up yet.
    fn value(&self, plan: &Plan, history: &History, words: &[Word], place: (usize, usize), last: u64) -> u64 {
        let (index, lane) = place;
        let track = &plan.tracks[index];
        let set = |track: &Track, until: u64| {
            track.stamps.first().map(|stamp| self.stamps.last_set(*stamp, lane, last, until))
        };
        let time = |scan: u64| history.time(scan).cast_unsigned();
        if index < plan.latches {
            // Before it was ever set, it holds the time 0, which is that of scan 0.
            return time(set(track, last + 1).unwrap_or_default());
        }
        let bit = |(bit, word): (usize, u32)| usize::from(words[word as usize].get(lane)) << bit;
        let code = track.codes.clone().enumerate().map(bit).sum::<usize>();
        let scan = set(track, last + 1).unwrap_or(self.ran[track.task]);
        match code.checked_sub(1).map(|leaf| track.tracked.leaves[leaf]) {
            None => self.values[index].as_ref().map_or(track.initial, |values| values[lane]),
            Some(Leaf::Constant(bits)) => bits,
            Some(Leaf::Now) => time(scan),
            Some(Leaf::Since(_)) => {
                let latch = track.since.iter().find(|(since, _)| *since == code).map_or(0, |(_, latch)| *latch);
                let until = if track.tracked.follows { last + 1 } else { scan };
                time(scan).wrapping_sub(time(set(&plan.tracks[latch], until).unwrap_or_default()))
            }
        }
    }

    /// Gives a slot a value in a lane, unless it is a latch, which can hold no other than times of scans.
    pub(super) fn set(&mut self, plan: &Plan, words: &mut [Word], place: (usize, usize), value: u64) -> bool {
        let is_latch = place.0 < plan.latches;
        if !is_latch {
            self.keep(&plan.tracks[place.0], words, place, value);
        }
        !is_latch
    }
}
