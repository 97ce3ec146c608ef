//! Time, as an interrupt counts it.
//!
//! The interrupt adds one to a 32-bit counter, whatever the number of timers. The scan loop latches the counter
//! once a scan and extends it to 64 bits; nothing else is shared, so nothing can race. This module must never
//! read a clock.

use core::num::NonZeroU32;
use core::sync::atomic::{AtomicU32, Ordering};

/// The counter that a tick interrupt advances.
///
/// There must be one interrupt (or thread) that advances it, so that a load and a store are enough also on cores
/// that have no other atomic operation; anything may read it.
#[derive(Debug)]
pub struct TickCounter {
    ticks: AtomicU32,
    period: NonZeroU32,
}

impl TickCounter {
    /// A counter at 0 of ticks `period` nanoseconds apart.
    pub const fn new(period: NonZeroU32) -> Self {
        Self::starting_at(period, 0)
    }

    /// A counter that stands at `ticks`, as it does when it was running before the controller started.
    pub const fn starting_at(period: NonZeroU32, ticks: u32) -> Self {
        Self { ticks: AtomicU32::new(ticks), period }
    }

    /// One period has passed: call this from the timer interrupt.
    pub fn tick(&self) {
        self.advance(1);
    }

    /// Some periods have passed since the last call; the counter wraps around.
    pub fn advance(&self, ticks: u32) {
        self.ticks.store(self.ticks.load(Ordering::Relaxed).wrapping_add(ticks), Ordering::Release);
    }
}

/// Where ticks come from: a [`TickCounter`] that an interrupt or a test advances, or a thread of the host part.
pub trait TickSource {
    /// Nanoseconds from one tick to the next.
    fn period(&self) -> NonZeroU32;

    /// Ticks so far, which wrap around.
    fn ticks(&self) -> u32;
}

impl TickSource for TickCounter {
    fn period(&self) -> NonZeroU32 {
        self.period
    }

    fn ticks(&self) -> u32 {
        self.ticks.load(Ordering::Acquire)
    }
}

impl<T: TickSource + ?Sized> TickSource for &T {
    fn period(&self) -> NonZeroU32 {
        (**self).period()
    }

    fn ticks(&self) -> u32 {
        (**self).ticks()
    }
}

/// The reader's side of a tick source: its ticks since this was made, in 64 bits.
///
/// It must be latched before 2^32 ticks have passed since the last time, 49 days at 1 ms; what wrapped around
/// twice is lost.
#[derive(Debug)]
pub struct Latch<T> {
    source: T,
    last: u32,
    total: u64,
}

impl<T: TickSource> Latch<T> {
    /// Counts from now on.
    pub fn new(source: T) -> Self {
        let last = source.ticks();
        Self { source, last, total: 0 }
    }

    /// Reads the source: ticks since this was made.
    pub fn latch(&mut self) -> u64 {
        let ticks = self.source.ticks();
        self.total += u64::from(ticks.wrapping_sub(self.last));
        self.last = ticks;
        self.total
    }

    /// What the source reads, or read, when [`Latch::latch`] gives `total`.
    pub fn raw(&self, total: u64) -> u32 {
        // Both wrap around at a multiple of 2^32, so the low bits of the distance are enough.
        #[expect(clippy::cast_possible_truncation, reason = "the low bits are wanted")]
        let ahead = total.wrapping_sub(self.total) as u32;
        self.last.wrapping_add(ahead)
    }

    /// A number of ticks as nanoseconds; held at the end of the range, after 292 years.
    pub fn nanoseconds(&self, ticks: u64) -> i64 {
        let period = i64::from(self.source.period().get());
        i64::try_from(ticks).map_or(i64::MAX, |ticks| ticks.saturating_mul(period))
    }

    /// The source.
    pub fn source(&self) -> &T {
        &self.source
    }
}
