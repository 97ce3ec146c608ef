//! A watchdog for what hangs.
//!
//! The scan loop itself finds a cycle that took too long, once it is over. A field that never answers, a tick
//! that never comes or a processor that is never given need another thread: this one. It must depend on nothing
//! that it watches, and so waits for nothing but time.

use std::io;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::thread::{self, JoinHandle};
use std::time::Duration;

use super::{MonotonicClock, Role, schedule_this_thread};
use crate::Clock;

/// The sign of life that a driver gives.
#[derive(Debug)]
pub struct Heartbeat {
    /// The moment by which it must have been given again.
    deadline: AtomicU64,
    tripped: AtomicBool,
    stop: AtomicBool,
}

impl Default for Heartbeat {
    /// One that nothing is expected of yet.
    fn default() -> Self {
        Self { deadline: AtomicU64::new(u64::MAX), tripped: AtomicBool::new(false), stop: AtomicBool::new(false) }
    }
}

impl Heartbeat {
    /// The driver lives, and will say so again by this moment of the monotonic clock.
    pub fn beat(&self, until: u64) {
        self.deadline.store(until, Ordering::Relaxed);
    }

    /// Nothing is expected any more.
    pub fn rest(&self) {
        self.beat(u64::MAX);
    }

    /// Whether it failed to come once; that is final.
    pub fn tripped(&self) -> bool {
        self.tripped.load(Ordering::Acquire)
    }
}

/// A thread that watches a heartbeat; dropping it ends it.
#[derive(Debug)]
pub struct Watchdog {
    heartbeat: Arc<Heartbeat>,
    thread: Option<JoinHandle<()>>,
}

impl Watchdog {
    /// Watches. When a beat is not there in time, `outputs_off` is called, once and from another thread than the
    /// driver's, which may be stuck in the field: it must reach the outputs by another way, and for good.
    ///
    /// # Errors
    /// When the system gives no thread.
    pub fn start(heartbeat: Arc<Heartbeat>, outputs_off: impl FnOnce() + Send + 'static) -> io::Result<Self> {
        let watched = Arc::clone(&heartbeat);
        let thread = thread::Builder::new().name("rung-watchdog".to_owned()).spawn(move || {
            // Without real-time scheduling it works as well as the system lets it.
            let _ = schedule_this_thread(Role::Watchdog);
            watch(&watched, outputs_off);
        })?;
        Ok(Self { heartbeat, thread: Some(thread) })
    }
}

fn watch(heartbeat: &Heartbeat, outputs_off: impl FnOnce()) {
    const LONGEST: Duration = Duration::from_millis(20);
    while !heartbeat.stop.load(Ordering::Relaxed) {
        let (now, deadline) = (MonotonicClock.nanoseconds(), heartbeat.deadline.load(Ordering::Relaxed));
        if now > deadline {
            outputs_off();
            heartbeat.tripped.store(true, Ordering::Release);
            return;
        }
        // A beat can only move the deadline on; but the first one brings it from never.
        thread::park_timeout(Duration::from_nanos(deadline - now + 1).min(LONGEST));
    }
}

impl Drop for Watchdog {
    fn drop(&mut self) {
        self.heartbeat.stop.store(true, Ordering::Relaxed);
        if let Some(thread) = self.thread.take() {
            thread.thread().unpark();
            // It only panics if `outputs_off` does, which was then said already.
            let _ = thread.join();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::mpsc;

    #[test]
    fn a_beat_that_does_not_come_puts_the_outputs_off() {
        let (sender, off) = mpsc::channel();
        let heartbeat = Arc::new(Heartbeat::default());
        let _watchdog =
            Watchdog::start(Arc::clone(&heartbeat), move || sender.send(()).expect("a listener")).expect("a thread");
        heartbeat.beat(MonotonicClock.nanoseconds());
        off.recv().expect("outputs off");
        while !heartbeat.tripped() {
            thread::yield_now();
        }
    }

    #[test]
    fn a_resting_heart_trips_nothing() {
        let heartbeat = Arc::new(Heartbeat::default());
        heartbeat.beat(0);
        heartbeat.rest();
        let watchdog = Watchdog::start(Arc::clone(&heartbeat), || panic!("nothing is wrong")).expect("a thread");
        drop(watchdog);
        assert!(!heartbeat.tripped());
    }
}
