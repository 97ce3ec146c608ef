//! Real-time scheduling and locked memory, where the system allows them; where not, it is said, and all runs on.
#![cfg_attr(target_os = "linux", expect(unsafe_code, reason = "system calls that the standard library does not offer"))]

use std::{fmt, io};

/// What a request to the system came to.
#[derive(Debug)]
pub enum Grant {
    /// It was granted.
    Granted,
    /// It was refused, and why.
    Refused(io::Error),
    /// This system has no such thing, or Rung does not know how to ask for it.
    Unsupported,
}

impl fmt::Display for Grant {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Granted => f.write_str("granted"),
            Self::Refused(error) => write!(f, "refused ({error})"),
            Self::Unsupported => f.write_str("not supported on this system"),
        }
    }
}

/// What a thread does, from the least urgent to the most.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub enum Role {
    /// It scans.
    Scan,
    /// It is the tick interrupt.
    Tick,
    /// It watches the others.
    Watchdog,
}

/// Asks for first-in-first-out real-time scheduling of the calling thread. Priorities are low among the real-time
/// ones, so that the system's own threads stay ahead.
pub fn schedule_this_thread(role: Role) -> Grant {
    system::schedule(match role {
        Role::Scan => 10,
        Role::Tick => 11,
        Role::Watchdog => 12,
    })
}

/// Asks to keep in memory all that the process has mapped by now. What it maps later is not covered, so that it
/// cannot run into a limit while it runs: call this when everything was allocated.
pub fn lock_memory() -> Grant {
    system::lock()
}

#[cfg(target_os = "linux")]
mod system {
    use super::Grant;
    use std::io;

    pub(super) fn schedule(priority: libc::c_int) -> Grant {
        let parameter = libc::sched_param { sched_priority: priority };
        // SAFETY: `parameter` outlives the call; thread 0 is the calling one.
        grant(unsafe {
            libc::sched_setscheduler(0, libc::SCHED_FIFO | libc::SCHED_RESET_ON_FORK, &raw const parameter)
        })
    }

    pub(super) fn lock() -> Grant {
        // SAFETY: locking changes no contents.
        grant(unsafe { libc::mlockall(libc::MCL_CURRENT) })
    }

    fn grant(result: libc::c_int) -> Grant {
        if result == 0 { Grant::Granted } else { Grant::Refused(io::Error::last_os_error()) }
    }
}

#[cfg(not(target_os = "linux"))]
mod system {
    use super::Grant;

    pub(super) fn schedule(_priority: i32) -> Grant {
        Grant::Unsupported
    }

    pub(super) fn lock() -> Grant {
        Grant::Unsupported
    }
}
