//! The tick interrupt of a host: a thread that wakes at absolute deadlines.
//!
//! Being late, it adds all the ticks that have passed, so that time never drifts. It does nothing else, but wake
//! the one thread that waits for a tick, should that have been awake before the tick was counted.

use std::io;
use std::num::NonZeroU32;
use std::sync::atomic::{AtomicBool, AtomicU32, AtomicU64, Ordering, fence};
use std::sync::{Arc, Mutex, OnceLock, PoisonError, mpsc};
use std::thread::{self, JoinHandle, Thread};
use std::time::Duration;

use super::{Alarm, Grant, MonotonicClock, Pace, Role, schedule_this_thread};
use crate::{Clock, TickCounter, TickSource};

/// How long a wait lasts before it looks around, in nanoseconds.
const LONGEST_WAIT: u64 = 50_000_000;
/// How long a thread that woke with the tick, but a little before it was counted, looks for it before it sleeps
/// again, in nanoseconds: less than being woken a second time takes.
const SPIN: u64 = 40_000;

/// A running tick thread; dropping it ends it.
#[derive(Debug)]
pub struct TickThread {
    shared: Arc<Shared>,
    /// The alarm of the thread that waits.
    waiting: Mutex<Alarm>,
    scheduling: Grant,
    thread: Option<JoinHandle<()>>,
}

#[derive(Debug)]
struct Shared {
    counter: TickCounter,
    /// The moment of tick 0.
    origin: u64,
    /// All ticks, unlike the counter's without wrapping around.
    total: AtomicU64,
    waiter: OnceLock<Thread>,
    awaited: AtomicU32,
    stop: AtomicBool,
}

impl TickThread {
    /// Starts ticking, `period` nanoseconds apart.
    ///
    /// # Errors
    /// When the system gives no thread or no timer.
    pub fn start(period: NonZeroU32) -> io::Result<Self> {
        let mut alarm = Alarm::new()?;
        let waiting = Mutex::new(Alarm::new()?);
        let shared = Arc::new(Shared {
            counter: TickCounter::new(period),
            origin: MonotonicClock.nanoseconds(),
            total: AtomicU64::new(0),
            waiter: OnceLock::new(),
            awaited: AtomicU32::new(0),
            stop: AtomicBool::new(false),
        });
        let (sender, granted) = mpsc::sync_channel(1);
        let ticking = Arc::clone(&shared);
        let thread = thread::Builder::new().name("rung-tick".to_owned()).spawn(move || {
            // The starter waits for it.
            let _ = sender.send(schedule_this_thread(Role::Tick));
            ticking.run(&mut alarm);
        })?;
        let scheduling = granted.recv().unwrap_or(Grant::Unsupported);
        Ok(Self { shared, waiting, scheduling, thread: Some(thread) })
    }

    /// Whether the thread runs with real-time scheduling.
    pub fn scheduling(&self) -> &Grant {
        &self.scheduling
    }
}

impl Drop for TickThread {
    fn drop(&mut self) {
        self.shared.stop.store(true, Ordering::Relaxed);
        if let Some(thread) = self.thread.take() {
            // It does not panic; and if it did, there is nothing to be done here.
            let _ = thread.join();
        }
    }
}

impl Shared {
    fn run(&self, alarm: &mut Alarm) {
        let period = u64::from(self.counter.period().get());
        while !self.stop.load(Ordering::Relaxed) {
            let given = self.total.load(Ordering::Relaxed);
            if alarm.sleep_until(self.origin + (given + 1) * period).is_err() {
                // Without ticks nothing is due any more, which the watchdog finds.
                return;
            }
            let passed = due(self.origin, period, MonotonicClock.nanoseconds());
            self.total.store(passed, Ordering::Relaxed);
            // In pieces, if ever more have passed than a call can say.
            let mut missing = passed - given;
            while missing > 0 {
                let some = u32::try_from(missing).unwrap_or(u32::MAX);
                self.counter.advance(some);
                missing -= u64::from(some);
            }
            fence(Ordering::SeqCst);
            if reached(self.counter.ticks(), self.awaited.load(Ordering::Relaxed))
                && let Some(waiter) = self.waiter.get()
            {
                waiter.unpark();
            }
        }
    }
}

/// Periods that have passed at a moment.
fn due(origin: u64, period: u64, moment: u64) -> u64 {
    moment.saturating_sub(origin) / period
}

/// Whether a counter that wraps around has come to a tick that was less than half its range ahead.
fn reached(ticks: u32, awaited: u32) -> bool {
    ticks.wrapping_sub(awaited) < 1 << 31
}

impl TickSource for TickThread {
    fn period(&self) -> NonZeroU32 {
        self.shared.counter.period()
    }

    fn ticks(&self) -> u32 {
        self.shared.counter.ticks()
    }
}

/// Only one thread may wait: the first that does is the one that is woken.
impl Pace for TickThread {
    fn wait(&self, tick: u32) {
        // With an alarm of its own: to be woken by the tick thread, which had to be woken first, takes twice as long.
        let (moment, now) = (self.moment(tick), MonotonicClock.nanoseconds());
        let until = moment.min(now + LONGEST_WAIT);
        let slept = self.waiting.lock().unwrap_or_else(PoisonError::into_inner).sleep_until(until);
        if slept.is_ok() && until < moment {
            return;
        }
        while MonotonicClock.nanoseconds() < until + SPIN {
            if reached(self.ticks(), tick) {
                return;
            }
            std::hint::spin_loop();
        }
        self.shared.waiter.get_or_init(thread::current);
        self.shared.awaited.store(tick, Ordering::Relaxed);
        // With the fence of the tick thread: either it sees what is awaited, or the tick is seen here.
        fence(Ordering::SeqCst);
        if !reached(self.ticks(), tick) {
            thread::park_timeout(Duration::from_nanos(LONGEST_WAIT));
        }
    }

    fn moment(&self, tick: u32) -> u64 {
        let total = self.shared.total.load(Ordering::Relaxed);
        let bytes = total.to_le_bytes();
        let low = u32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]);
        let ahead = i64::from(tick.wrapping_sub(low).cast_signed());
        let period = u64::from(self.period().get());
        self.shared.origin + total.saturating_add_signed(ahead) * period
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn late_wakes_lose_no_tick_and_early_ones_add_none() {
        let mut given = 0;
        for (moment, expected) in [(1_000, 0), (1_099, 0), (1_100, 1), (1_730, 7), (1_799, 7), (1_801, 8)] {
            let passed = due(1_000, 100, moment);
            assert!(passed >= given);
            given = passed;
            assert_eq!(given, expected);
        }
    }

    #[test]
    fn a_tick_is_awaited_over_the_end_of_the_counter() {
        assert!(!reached(u32::MAX, 2));
        assert!(!reached(1, 2));
        assert!(reached(2, 2));
        assert!(reached(3, u32::MAX));
    }

    #[test]
    fn a_tick_thread_ticks_and_wakes_who_waits() {
        let ticks = TickThread::start(NonZeroU32::new(1_000_000).expect("not zero")).expect("a thread");
        while !reached(ticks.ticks(), 5) {
            ticks.wait(5);
        }
        let now = MonotonicClock.nanoseconds();
        assert!(ticks.moment(5) <= now && ticks.moment(5) == ticks.moment(0) + 5_000_000);
    }
}
