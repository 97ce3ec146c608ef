//! Whole-scan elision: a scan that would change nothing is left out.
//!
//! A scan is a function of the image and of `now`. If one has left the image as it found it, and no later time would make
//! it do otherwise (no timer is running), then every later scan of the same image leaves it so, too. Until something is
//! written from outside, such scans need not run.
//!
//! What is left out are whole scans, never a rung, and it is opt-in: a scan that is left out takes far less time than one
//! that is not, and the one that finds the program still takes longer, and memory of its own; constant time is what machine
//! code promises without. Results stay exact. The one thing that lags behind is what no program reads meanwhile, as the
//! start that an idle timer keeps noting; [`Elided::settle`] catches it up, and so does the next scan that runs. What later
//! times would change is the matter of `forever`.

mod forever;
#[cfg(test)]
mod tests;

use std::ops::Range;

use rung_runtime::Scan;

use crate::elementary::Elementary;
use crate::logic::Program;
use crate::logic::image::read;
use forever::{HORIZON, Outlook};

/// Scans that find nothing changed, but a time that counts, after which it is asked again only now and then.
const MOST_PAUSE: u32 = 1024;

/// An engine of which the scans that would change nothing are left out.
#[derive(Debug)]
pub struct Elided<S> {
    engine: S,
    outlook: Outlook,
    /// What scans may move along with the time.
    moving: Vec<Range<usize>>,
    inputs: Vec<Range<usize>>,
    /// Where the tasks with an interval keep when they are due.
    due: Vec<u32>,
    /// The image that the last scan was given; while [`Idle::Still`], the one that all scans leave as it is.
    image: Vec<u8>,
    idle: Idle,
    left_out: u64,
}

/// What is known of the image that the last scan left.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Idle {
    /// Nothing: there was no scan, or the last one changed it.
    No,
    /// It was not changed, but may be at a later time. It is asked again after so many scans, of which so many are left.
    Awake { pause: u32, left: u32 },
    /// It stays as it is from a time on. Of the scans that were left out since, the last was at the other time.
    Still { since: i64, pending: Option<i64> },
}

impl<S: Scan> Elided<S> {
    /// Leaves out scans of an engine that runs this program and that has not run a scan yet.
    pub fn new(engine: S, program: &Program) -> Self {
        let layout = &program.layout;
        let outlook = Outlook::of(program);
        let range = |bytes: &Range<u32>| bytes.start as usize..bytes.end as usize;
        Self {
            engine,
            moving: outlook.may_move().collect(),
            outlook,
            inputs: layout.inputs().iter().map(|run| range(&run.bytes)).collect(),
            due: program.tasks.iter().filter_map(|task| task.due).map(|slot| layout.slot(slot).offset).collect(),
            image: vec![0; layout.size() as usize],
            idle: Idle::No,
            left_out: 0,
        }
    }

    /// Scans that were left out so far.
    pub fn left_out(&self) -> u64 {
        self.left_out
    }

    /// The engine.
    pub fn engine(&self) -> &S {
        &self.engine
    }

    /// Makes the image, which must be the one that was scanned last, what it would be without elision to the last byte.
    /// To be called before all of it is compared or kept; variables and outputs are right without.
    pub fn settle(&mut self, image: &mut [u8]) {
        let Idle::Still { pending, .. } = &mut self.idle else { return };
        let Some(now) = pending.take() else { return };
        // What was written from outside since then stays.
        let before = std::mem::take(&mut self.image);
        let mut settled = before.clone();
        self.engine.scan(&mut settled, now);
        for range in &self.moving {
            if image[range.clone()] == before[range.clone()] {
                image[range.clone()].copy_from_slice(&settled[range.clone()]);
            }
        }
        self.image = settled;
    }

    /// Whether a scan at `now` leaves an image alone of which `same` says that it is the one of the last scan.
    fn is_left_out(&mut self, image: &[u8], now: i64, same: impl FnOnce(&Self) -> bool) -> bool {
        let Idle::Still { since, .. } = self.idle else { return false };
        let foreseen = (since..=since.saturating_add(HORIZON)).contains(&now);
        if !foreseen || self.is_any_due(image, now) || !same(self) {
            return false;
        }
        self.idle = Idle::Still { since, pending: Some(now) };
        self.left_out += 1;
        true
    }

    /// Whether a task with an interval runs at `now`.
    fn is_any_due(&self, image: &[u8], now: i64) -> bool {
        self.due.iter().any(|offset| now >= read(image, *offset, Elementary::Time).bits().cast_signed())
    }

    /// Runs a scan, and finds out whether the next can be left out.
    fn run(&mut self, image: &mut [u8], now: i64) {
        self.settle(image);
        // What some tasks do others may undo: a round of more of them says nothing of one of fewer.
        let periodic = self.is_any_due(image, now);
        let size = self.image.len();
        self.image.copy_from_slice(&image[..size]);
        self.engine.scan(image, now);
        let before = &mut self.image;
        for range in &self.moving {
            before[range.clone()].copy_from_slice(&image[range.clone()]);
        }
        self.idle = match self.idle {
            _ if periodic || *before != image[..size] => Idle::No,
            Idle::Awake { pause, left } if left > 0 => Idle::Awake { pause, left: left - 1 },
            _ if self.outlook.is_still(before, now) => Idle::Still { since: now, pending: None },
            Idle::Awake { pause, .. } => {
                let pause = (pause * 2).min(MOST_PAUSE);
                Idle::Awake { pause, left: pause }
            }
            Idle::No | Idle::Still { .. } => Idle::Awake { pause: 1, left: 0 },
        };
    }
}

impl<S: Scan> Scan for Elided<S> {
    fn scan(&mut self, image: &mut [u8], now: i64) {
        if !self.is_left_out(image, now, |own| own.image == image[..own.image.len()]) {
            self.run(image, now);
        }
    }

    fn scan_inputs(&mut self, image: &mut [u8], now: i64) {
        let same = |own: &Self| own.inputs.iter().all(|run| own.image[run.clone()] == image[run.clone()]);
        if !self.is_left_out(image, now, same) {
            self.run(image, now);
        }
    }

    fn trusted(&self) -> bool {
        self.engine.trusted()
    }
}
