//! Emitters: a program as source text for other compilers.
//!
//! Each takes a verified [`Program`](crate::logic::Program), first says all that its language cannot hold, and then
//! writes the whole text. An emitter must know nothing of ladder and of engines, and what it writes must compute what
//! [`evaluate`](crate::logic::evaluate) says, to the bit.

pub mod c;
pub mod header;
mod names;
mod notes;
mod structure;

pub use names::validate;
pub use notes::{Declaration, Notes};
