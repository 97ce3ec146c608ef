//! When cycles are due, by the ticks alone.
//!
//! Cycle k is due at tick k times the cycle, however long the cycles before it took: the schedule never drifts.
//! A cycle that cannot start before its successor is due is skipped and counted, never caught up in a burst.

use core::num::NonZeroU32;

/// The schedule of a periodic scan.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Schedule {
    cycle: NonZeroU32,
    due: u64,
    late: bool,
    overruns: u64,
    skipped: u64,
}

impl Schedule {
    /// One cycle every `cycle` ticks, the first at tick 0.
    pub fn new(cycle: NonZeroU32) -> Self {
        Self { cycle, due: 0, late: false, overruns: 0, skipped: 0 }
    }

    /// The tick at which the next cycle is to begin.
    pub fn due(&self) -> u64 {
        self.due
    }

    /// A cycle begins at tick `at`, not before it is [due](Schedule::due); gives the tick at which it was due,
    /// those not counted that it skips.
    pub fn begin(&mut self, at: u64) -> u64 {
        let cycle = u64::from(self.cycle.get());
        let behind = at.saturating_sub(self.due);
        // Only what is late pays for a division, which is long work for a 32-bit core.
        let skipped = if behind < cycle { 0 } else { behind / cycle };
        let began_for = self.due + skipped * cycle;
        self.late = skipped > 0;
        self.skipped += skipped;
        self.due = began_for + cycle;
        began_for
    }

    /// The cycle has ended at tick `at`.
    pub fn end(&mut self, at: u64) {
        if self.late || at >= self.due {
            self.overruns += 1;
        }
    }

    /// Cycles that began when one or more before them had been skipped, or ended only when the next was due.
    pub fn overruns(&self) -> u64 {
        self.overruns
    }

    /// Cycles that never ran.
    pub fn skipped(&self) -> u64 {
        self.skipped
    }
}
