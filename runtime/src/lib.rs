//! What every Rung program runs on: the process image, the tick counter and the scan loop.
//!
//! The core needs no standard library, no memory but what it is given and no other crate. Ticks come from an
//! interrupt, the field is behind [`FieldIo`], and [`ScanLoop`] runs one cycle after another between them.
//! What runs may be any [`Scan`]: an engine of the library `rung`, or machine code that `rung build` wrote and
//! [`program!`] names, in firmware without any of Rung's compiler.
//!
//! With the feature `host` there is also [`host`]: a thread for the interrupt, real-time scheduling, a periodic
//! driver with statistics and a simulated panel. Only that part reads clocks, starts threads or calls the system.
#![cfg_attr(not(feature = "host"), no_std)]

#[cfg(feature = "host")]
pub mod host;
mod image;
mod io;
mod linked;
mod scan_loop;
mod schedule;
mod tick;

pub use image::{BadRegions, Extent, Inputs, Outputs, Regions};
pub use io::FieldIo;
#[doc(hidden)]
pub use linked::Symbols;
pub use linked::{ABI_VERSION, IMAGE_ALIGNMENT, Instance, LinkError, Linked, Memory, Retained};
pub use scan_loop::{Clock, Cycle, Fault, ScanLoop, Stopped};
pub use schedule::Schedule;
pub use tick::{Latch, TickCounter, TickSource};

/// One scan of a program over its process image.
pub trait Scan {
    /// Runs one scan at `now`, nanoseconds since the controller started, latched once for all of it.
    ///
    /// # Panics
    /// When `image` is not of the program's size.
    fn scan(&mut self, image: &mut [u8], now: i64);

    /// The same, called by someone who since the last scan of this image wrote nothing to it but inputs. A program that
    /// leaves out scans which would change nothing has less to look at then.
    ///
    /// # Panics
    /// When `image` is not of the program's size.
    fn scan_inputs(&mut self, image: &mut [u8], now: i64) {
        self.scan(image, now);
    }

    /// Whether the image that the last scan left may go out. A scan that checks itself, as two engines side by
    /// side do, says FALSE once it has found a difference; outputs are put off then.
    fn trusted(&self) -> bool {
        true
    }
}

impl<S: Scan + ?Sized> Scan for &mut S {
    fn scan(&mut self, image: &mut [u8], now: i64) {
        (**self).scan(image, now);
    }

    fn scan_inputs(&mut self, image: &mut [u8], now: i64) {
        (**self).scan_inputs(image, now);
    }

    fn trusted(&self) -> bool {
        (**self).trusted()
    }
}
