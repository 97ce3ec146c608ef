//! The soft PLC on a desktop or server: a thread for the tick interrupt, real-time scheduling where it is allowed,
//! a periodic driver with statistics, a watchdog for what hangs, and a simulated panel.
//!
//! This part reads the monotonic clock, starts threads and calls the system. It must never use the clock of the
//! day, which jumps, and must never allocate in a cycle.

mod clock;
mod driver;
mod histogram;
mod panel;
mod scheduling;
mod statistics;
mod ticks;
mod watchdog;

pub use clock::{Alarm, MonotonicClock};
pub use driver::{Driver, End, Pace};
pub use histogram::{Histogram, Quantiles};
pub use panel::{Panel, PanelIo};
pub use scheduling::{Grant, Role, lock_memory, schedule_this_thread};
pub use statistics::Statistics;
pub use ticks::TickThread;
pub use watchdog::{Heartbeat, Watchdog};
