//! The periodic scan-cycle driver: one cycle whenever one is due, until it is asked to end or something is wrong.

use std::num::NonZeroU32;
use std::sync::atomic::{AtomicBool, Ordering};

use super::{Heartbeat, Statistics};
use crate::{Clock, Cycle, FieldIo, Scan, ScanLoop, Schedule, Stopped, TickSource};

/// A tick source that a thread can wait for.
pub trait Pace: TickSource {
    /// Waits until the source reads `tick`, or for a short while: whoever waits looks again.
    fn wait(&self, tick: u32);

    /// The moment at which the source read or will read `tick`, in nanoseconds of the scan loop's clock.
    fn moment(&self, tick: u32) -> u64;
}

impl<P: Pace + ?Sized> Pace for &P {
    fn wait(&self, tick: u32) {
        (**self).wait(tick);
    }

    fn moment(&self, tick: u32) -> u64 {
        (**self).moment(tick)
    }
}

/// What a run is driven by.
#[derive(Debug)]
pub struct Driver<'a> {
    /// Ticks from one cycle to the next.
    pub cycle: NonZeroU32,
    /// The tick at which the run ends, if it does by itself; cycles due then or later do not run.
    pub ends_at: Option<u64>,
    /// Nanoseconds that a cycle may take, or be late, before the heartbeat fails.
    pub watchdog: u64,
    /// Beats while all is well.
    pub heartbeat: &'a Heartbeat,
    /// Where it is measured.
    pub statistics: &'a Statistics,
    /// Asks it to end after the current cycle.
    pub stop: &'a AtomicBool,
}

/// How a run ended.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum End<E> {
    /// It was asked to end, or its time was up. The payload tells whether the outputs are off.
    Asked(Result<(), E>),
    /// The scan loop stopped.
    Stopped(Stopped<E>),
    /// The watchdog's thread found no heartbeat in time, and has put the outputs off itself.
    NoHeartbeat,
}

impl Driver<'_> {
    /// Runs cycles; `after` is called after each, with the image as it went out.
    pub fn run<S, F, T, C>(
        &self,
        scan_loop: &mut ScanLoop<'_, S, F, T, C>,
        mut after: impl FnMut(&[u8], Cycle),
    ) -> End<F::Error>
    where
        S: Scan,
        F: FieldIo,
        T: Pace,
        C: Clock,
    {
        let mut schedule = Schedule::new(self.cycle);
        let end = loop {
            let due = schedule.due();
            if !self.await_tick(scan_loop, due) {
                break if self.heartbeat.tripped() { End::NoHeartbeat } else { End::Asked(scan_loop.stop()) };
            }
            let began = scan_loop.clock().nanoseconds();
            self.heartbeat.beat(began.saturating_add(self.watchdog));
            let at = scan_loop.ticks().latch();
            let due = schedule.begin(at);
            let ticks = scan_loop.ticks();
            self.statistics.lateness.record(began.saturating_sub(ticks.source().moment(ticks.raw(due))));
            let cycle = match scan_loop.cycle() {
                Ok(cycle) => cycle,
                Err(stopped) => break End::Stopped(stopped),
            };
            schedule.end(scan_loop.ticks().latch());
            self.statistics.scan.record(cycle.took);
            self.statistics.note(&schedule);
            after(scan_loop.image(), cycle);
        };
        self.heartbeat.rest();
        end
    }

    /// Waits for a tick; FALSE where the run is to end instead.
    fn await_tick<S, F, T, C>(&self, scan_loop: &mut ScanLoop<'_, S, F, T, C>, tick: u64) -> bool
    where
        S: Scan,
        F: FieldIo,
        T: Pace,
        C: Clock,
    {
        // The run ends on time even where the next cycle would be due only after that.
        let until = self.ends_at.map_or(tick, |end| end.min(tick));
        let ticks = scan_loop.ticks();
        let raw = ticks.raw(until);
        self.heartbeat.beat(ticks.source().moment(raw).saturating_add(self.watchdog));
        loop {
            if self.stop.load(Ordering::Relaxed) || self.heartbeat.tripped() {
                return false;
            }
            let now = ticks.latch();
            if now >= until {
                return self.ends_at.is_none_or(|end| tick < end && now < end);
            }
            ticks.source().wait(raw);
        }
    }
}
