//! What every Rung program runs on: the process image, the tick counter and the scan loop.
#![cfg_attr(not(feature = "host"), no_std)]

/// One scan of a program over its process image.
pub trait Scan {
    /// Runs one scan at `now`, nanoseconds since the controller started, latched once for all of it.
    ///
    /// # Panics
    /// When `image` is not of the program's size.
    fn scan(&mut self, image: &mut [u8], now: i64);
}
