//! Whole-scan elision: a scan that would change nothing is left out.
//!
//! A scan is a function of the image and of `now`. If one has left the image as it found it, and `now` had no way to any
//! variable in it (no timer was running), then every later scan of the same image leaves it so, too, whatever the time.
//! Until something is written from outside, such scans need not run.
//!
//! What is left out are whole scans, never a rung, and it is opt-in: a scan that is left out takes far less time than one
//! that is not, and constant time is what the machine code promises. Results stay exact. The one thing that lags behind is
//! what no program reads meanwhile, as the start that an idle timer keeps noting; [`Elided::settle`] catches it up, and so
//! does the next scan that runs. When `now` counts is the matter of [`sensitivity`].

mod sensitivity;
#[cfg(test)]
mod tests;

use std::collections::BTreeSet;
use std::ops::Range;

use rung_runtime::Scan;

use crate::elementary::Elementary;
use crate::engine::interp::Interpreter;
use crate::logic::image::read;
use crate::logic::{Layout, Program, SlotId};
use sensitivity::Twin;

/// An engine of which the scans that would change nothing are left out.
#[derive(Debug)]
pub struct Elided<S> {
    engine: S,
    /// Runs the same program, which also says whether `now` counts; `None` where there is no room for the answer.
    twin: Option<Asked>,
    /// What the engine may leave behind: see [`sensitivity`].
    passive: Vec<Range<usize>>,
    inputs: Vec<Range<usize>>,
    /// Where the tasks with an interval keep when they are due.
    due: Vec<u32>,
    /// The image that the last scan was given; while [`Idle::Still`], the one that all scans leave as it is.
    image: Vec<u8>,
    idle: Idle,
    left_out: u64,
}

/// What says whether `now` counts. It is asked once for every time that a program falls still, and not worth compiling.
#[derive(Debug)]
struct Asked {
    engine: Interpreter,
    image: Vec<u8>,
    /// Where in the image the answer is.
    answer: usize,
}

impl Asked {
    /// Whether a scan of an image would do something else at another time than `now`.
    fn time_counts(&mut self, image: &[u8], now: i64) -> bool {
        self.image[..image.len()].copy_from_slice(image);
        self.image[self.answer] = 0;
        self.engine.scan(&mut self.image, now);
        self.image[self.answer] != 0
    }
}

/// What is known of the image that the last scan left.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Idle {
    /// Nothing: there was no scan, or the last one changed it, or another time would.
    No,
    /// It stays as it is. Of the scans that were left out since, the last was at this time.
    Still(Option<i64>),
}

impl<S: Scan> Elided<S> {
    /// Leaves out scans of an engine that runs this program and that has not run a scan yet.
    pub fn new(engine: S, program: &Program) -> Self {
        let layout = &program.layout;
        let (twin, passive) = match sensitivity::twin(program) {
            Some(Twin { program, answer, passive }) => {
                let (engine, image) = (Interpreter::new(&program), vec![0; program.layout.size() as usize]);
                (Some(Asked { engine, image, answer }), passive)
            }
            None => (None, BTreeSet::new()),
        };
        let range = |bytes: &Range<u32>| bytes.start as usize..bytes.end as usize;
        let due = program.tasks.iter().filter_map(|task| task.due).map(|slot| layout.slot(slot).offset).collect();
        Self {
            engine,
            twin,
            passive: passive.iter().map(|slot| range_of(layout, *slot)).collect(),
            inputs: layout.inputs().iter().map(|run| range(&run.bytes)).collect(),
            due,
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
        let Idle::Still(pending) = &mut self.idle else { return };
        let Some(now) = pending.take() else { return };
        // What was written from outside since then is put aside, and written again.
        let before = std::mem::take(&mut self.image);
        let mut settled = before.clone();
        self.engine.scan(&mut settled, now);
        for range in &self.passive {
            if image[range.clone()] == before[range.clone()] {
                image[range.clone()].copy_from_slice(&settled[range.clone()]);
            }
        }
        self.image = settled;
    }

    /// Whether a scan at `now` leaves an image alone of which `same` says that it is the one of the last scan.
    fn is_left_out(&mut self, image: &[u8], now: i64, same: impl FnOnce(&Self) -> bool) -> bool {
        let Idle::Still(_) = self.idle else { return false };
        if self.is_any_due(image, now) || !same(self) {
            return false;
        }
        self.idle = Idle::Still(Some(now));
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
        for range in &self.passive {
            before[range.clone()].copy_from_slice(&image[range.clone()]);
        }
        let unchanged = !periodic && *before == image[..before.len()];
        let still = unchanged && self.twin.as_mut().is_some_and(|twin| !twin.time_counts(before, now));
        self.idle = if still { Idle::Still(None) } else { Idle::No };
    }
}

fn range_of(layout: &Layout, slot: SlotId) -> Range<usize> {
    let slot = layout.slot(slot);
    slot.offset as usize..(slot.offset + slot.ty.size()) as usize
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
