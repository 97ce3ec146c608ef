//! Objects: read back, linked with C and run, and refused without a file where the target cannot be.

mod bad;
mod format;
mod linked;
