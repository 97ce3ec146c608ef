//! The monotonic clock, and sleeping until a moment of it.
//!
//! Deadlines are absolute, so that being late once makes nothing late after.
#![cfg_attr(target_os = "linux", expect(unsafe_code, reason = "system calls that the standard library does not offer"))]

use std::io;

use crate::Clock;

/// The system's monotonic clock; adjusting the time of day does not move it.
#[derive(Clone, Copy, Debug, Default)]
pub struct MonotonicClock;

impl Clock for MonotonicClock {
    fn nanoseconds(&self) -> u64 {
        system::now()
    }
}

/// Puts a thread to sleep until a moment of the [`MonotonicClock`].
#[derive(Debug)]
pub struct Alarm(system::Timer);

impl Alarm {
    /// A new alarm.
    ///
    /// # Errors
    /// When the system has no timer left.
    pub fn new() -> io::Result<Self> {
        system::Timer::new().map(Self)
    }

    /// Sleeps until the clock shows `moment` nanoseconds or more; not at all if it does already.
    ///
    /// # Errors
    /// When the system refuses its own timer.
    pub fn sleep_until(&mut self, moment: u64) -> io::Result<()> {
        while system::now() < moment {
            self.0.sleep_until(moment)?;
        }
        Ok(())
    }
}

#[cfg(target_os = "linux")]
mod system {
    use std::fs::File;
    use std::io::{self, Read};
    use std::os::fd::{AsRawFd, FromRawFd};

    const SECOND: u64 = 1_000_000_000;

    pub(super) fn now() -> u64 {
        let mut time = libc::timespec { tv_sec: 0, tv_nsec: 0 };
        // SAFETY: `time` is a valid place to write to. The clock exists on every Linux, so the call cannot fail.
        unsafe { libc::clock_gettime(libc::CLOCK_MONOTONIC, &raw mut time) };
        u64::try_from(time.tv_sec).unwrap_or(0) * SECOND + u64::try_from(time.tv_nsec).unwrap_or(0)
    }

    /// A timer as a file: unlike a sleep, it is not subject to the timer slack of 50 us that a thread without
    /// real-time priority has.
    #[derive(Debug)]
    pub(super) struct Timer(File);

    impl Timer {
        pub(super) fn new() -> io::Result<Self> {
            // SAFETY: no memory is handed over.
            let descriptor = unsafe { libc::timerfd_create(libc::CLOCK_MONOTONIC, libc::TFD_CLOEXEC) };
            if descriptor < 0 {
                return Err(io::Error::last_os_error());
            }
            // SAFETY: the descriptor was just opened and nothing else owns it.
            Ok(Self(unsafe { File::from_raw_fd(descriptor) }))
        }

        pub(super) fn sleep_until(&mut self, moment: u64) -> io::Result<()> {
            // A moment of 0 would disarm the timer.
            let moment = moment.max(1);
            let seconds = libc::time_t::try_from(moment / SECOND).unwrap_or(libc::time_t::MAX);
            let rest = libc::c_long::try_from(moment % SECOND).unwrap_or(0);
            let once = libc::itimerspec {
                it_interval: libc::timespec { tv_sec: 0, tv_nsec: 0 },
                it_value: libc::timespec { tv_sec: seconds, tv_nsec: rest },
            };
            let descriptor = self.0.as_raw_fd();
            // SAFETY: `once` outlives the call, and no old value is asked for.
            let set = unsafe {
                libc::timerfd_settime(descriptor, libc::TFD_TIMER_ABSTIME, &raw const once, std::ptr::null_mut())
            };
            if set < 0 {
                return Err(io::Error::last_os_error());
            }
            match self.0.read(&mut [0; 8]) {
                Err(error) if error.kind() != io::ErrorKind::Interrupted => Err(error),
                _ => Ok(()),
            }
        }
    }
}

#[cfg(not(target_os = "linux"))]
mod system {
    use std::io;
    use std::sync::OnceLock;
    use std::time::{Duration, Instant};

    pub(super) fn now() -> u64 {
        static START: OnceLock<Instant> = OnceLock::new();
        u64::try_from(START.get_or_init(Instant::now).elapsed().as_nanos()).unwrap_or(u64::MAX)
    }

    #[derive(Debug)]
    pub(super) struct Timer;

    impl Timer {
        pub(super) fn new() -> io::Result<Self> {
            Ok(Self)
        }

        pub(super) fn sleep_until(&mut self, moment: u64) -> io::Result<()> {
            std::thread::sleep(Duration::from_nanos(moment.saturating_sub(now())));
            Ok(())
        }
    }
}
