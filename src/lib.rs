//! Rung: a compiler and runtime for PLC ladder diagrams.
//!
//! A program goes through these stages, each a module that knows only those before it; `ARCHITECTURE.md` is the map.
//!
//! [`frontend`] reads bytes into a [`ladder::Program`]; [`check`] resolves it to a [`check::Checked`]; [`lower`]
//! turns that into one straight-line scan of [`logic`], which [`opt`] improves and [`engine`] interprets or compiles.

pub mod batch;
pub mod check;
pub mod cli;
pub mod diagnostic;
pub mod draw;
pub mod elementary;
pub mod engine;
pub mod frontend;
pub mod generate;
pub mod interface;
pub mod ladder;
pub mod logic;
pub mod lower;
pub mod opt;
mod parallel;
pub mod replay;
pub mod simulate;
pub mod source;
pub mod trace;

pub use batch::Batch;
