//! The engines: what runs a scan of logic.
//!
//! Each takes a verified [`Program`](crate::logic::Program) and becomes a [`Scan`](rung_runtime::Scan) over its image.
//! None holds code for a particular block, and all compute what [`evaluate`](crate::logic::evaluate) says.

pub mod both;
pub mod clif;
pub mod disassemble;
pub mod elide;
pub mod helpers;
pub mod interp;
pub mod jit;
pub mod lanes;
pub mod object;
pub mod report;
pub mod target;
