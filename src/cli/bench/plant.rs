//! What a measured program is wired to: inputs that change at random, the same for every engine.

use std::time::Instant;

use rung_runtime::Scan;

use super::to_f64;
use crate::elementary::{Elementary, Value};
use crate::logic::{Area, Program, Slot};

/// An image whose BOOL inputs change at random.
pub(super) struct Plant<'a> {
    image: Vec<u8>,
    inputs: Vec<&'a Slot>,
    now: i64,
    random: u64,
}

/// Time from one scan to the next, in nanoseconds.
pub(super) const CYCLE: i64 = 1_000_000;
/// Scans between two changes of the inputs, so that changing them costs next to nothing beside the scans.
pub(super) const SCANS_PER_CHANGE: u64 = 16;

impl<'a> Plant<'a> {
    pub(super) fn new(program: &'a Program) -> Self {
        let slots = program.layout.slots().iter();
        let inputs = slots.filter(|slot| slot.area == Area::Input && slot.ty == Elementary::Bool).collect();
        Self { image: program.layout.initial_image(), inputs, now: 0, random: 0x9E37_79B9_7F4A_7C15 }
    }

    /// The image as it is.
    pub(super) fn image(&self) -> &[u8] {
        &self.image
    }

    /// What `harness.c`, which does the same as this, takes first.
    pub(super) fn start(&self) -> Vec<u8> {
        let count = |count: usize| u32::try_from(count).unwrap_or(u32::MAX).to_ne_bytes();
        let mut start = count(self.image.len()).to_vec();
        start.extend(&self.image);
        start.extend(count(self.inputs.len()));
        self.inputs.iter().for_each(|slot| start.extend(slot.offset.to_ne_bytes()));
        start
    }

    fn next_random(&mut self) -> u64 {
        // xorshift64: cheap, and the same on every machine.
        self.random ^= self.random << 13;
        self.random ^= self.random >> 7;
        self.random ^= self.random << 17;
        self.random
    }

    /// Runs scans, at least one; gives nanoseconds a scan. Changing the inputs counts: reading the clock around the
    /// scans between two changes instead would weigh on a small program, whose scans take no longer than that.
    pub(super) fn run(&mut self, scan: &mut dyn Scan, scans: u64) -> f64 {
        let mut left = scans;
        let start = Instant::now();
        while left > 0 {
            for _ in 0..self.inputs.len().div_ceil(10) {
                let (which, value) = (self.next_random(), self.next_random());
                let index = usize::try_from(which % self.inputs.len() as u64).unwrap_or(0);
                self.inputs[index].write(&mut self.image, Value::bool(value >> 63 == 1));
            }
            let batch = left.min(SCANS_PER_CHANGE);
            for _ in 0..batch {
                scan.scan(&mut self.image, self.now);
                self.now += CYCLE;
            }
            left -= batch;
        }
        start.elapsed().as_secs_f64() * 1e9 / to_f64(scans)
    }
}
