//! Emitted C: whatever compiles it, every scan leaves the image that the interpreter leaves, byte for byte.
//!
//! The compilers are gcc, clang and tcc; where one is missing, its tests fail and say so. Other machines than this one
//! are for the tests of the soft-cores.

mod header;
mod interface;
mod programs;
mod random;
mod rig;
mod straight_line;

#[path = "../support"]
mod support {
    #![allow(dead_code, reason = "this test uses a part of the support only")]
    pub(crate) mod dice;
    pub(crate) mod drawing;
    pub(crate) mod random_program;
}
