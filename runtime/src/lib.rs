//! What every Rung program runs on: the process image, the tick counter and the scan loop.
#![cfg_attr(not(feature = "host"), no_std)]

/// One scan of a program over its process image.
pub trait Scan {
    /// Runs one scan at `now`, nanoseconds since the controller started, latched once for all of it.
    ///
    /// # Panics
    /// When `image` is not of the program's size.
    fn scan(&mut self, image: &mut [u8], now: i64);

    /// Whether the image that the last scan left may go out. A scan that checks itself, as two engines side by
    /// side do, says FALSE once it has found a difference; outputs are put off then.
    fn trusted(&self) -> bool {
        true
    }
}
