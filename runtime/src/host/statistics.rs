//! What a driver measures, readable while it runs.

use std::sync::atomic::{AtomicU64, Ordering};

use super::Histogram;
use crate::Schedule;

/// Figures of a run so far. The driver's thread alone writes them; reading never holds it up.
#[derive(Debug, Default)]
pub struct Statistics {
    /// Nanoseconds from before the copy in to after the copy out.
    pub scan: Histogram,
    /// Nanoseconds from the moment at which a cycle was due to its begin.
    pub lateness: Histogram,
    cycles: AtomicU64,
    overruns: AtomicU64,
    skipped: AtomicU64,
}

impl Statistics {
    pub(super) fn note(&self, schedule: &Schedule) {
        self.cycles.store(self.cycles() + 1, Ordering::Relaxed);
        self.overruns.store(schedule.overruns(), Ordering::Relaxed);
        self.skipped.store(schedule.skipped(), Ordering::Relaxed);
    }

    /// Cycles that ran.
    pub fn cycles(&self) -> u64 {
        self.cycles.load(Ordering::Relaxed)
    }

    /// [`Schedule::overruns`]
    pub fn overruns(&self) -> u64 {
        self.overruns.load(Ordering::Relaxed)
    }

    /// [`Schedule::skipped`]
    pub fn skipped(&self) -> u64 {
        self.skipped.load(Ordering::Relaxed)
    }
}
