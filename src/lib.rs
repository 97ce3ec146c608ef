//! Rung: a compiler and runtime for PLC ladder diagrams.
//!
//! A host program embeds it as a [`Controller`]: a ladder in, in any format that Rung reads, compiled for this process;
//! scanned when the host program says; its variables read and written by name. `docs/embedding.md` is the manual page,
//! `examples/embed.rs` a whole program.
//!
//! ```
//! use std::time::Duration;
//! use rung::Controller;
//!
//! let ladder = b"
//! program motor
//! input  start, stop
//! output motor
//!
//! rung r10 \"seal-in: stop wins\"
//!   [ start | motor ] /stop (motor)
//! ";
//! let mut controller = Controller::load("motor.rung", ladder)?;
//!
//! controller.write("start", true)?;
//! controller.scan(Duration::ZERO);
//! controller.write("start", false)?;
//! controller.scan(Duration::from_millis(10));
//! assert!(controller.read::<bool>("motor")?);
//!
//! for variable in controller.variables() {
//!     println!("{} : {}", variable.name(), variable.ty());
//! }
//! # Ok::<(), rung::Error>(())
//! ```
//!
//! Inside, a program goes through these stages, each a module that knows only those before it; `ARCHITECTURE.md` is the
//! map.
//!
//! [`frontend`] reads bytes into a [`ladder::Program`]; [`check`] resolves it to a [`check::Checked`]; [`lower`]
//! turns that into one straight-line scan of [`logic`], which [`opt`] improves and [`engine`] interprets or compiles.

pub mod batch;
pub mod check;
pub mod cli;
pub mod controller;
pub mod diagnostic;
pub mod draw;
pub mod elementary;
pub mod emit;
pub mod engine;
pub mod frontend;
pub mod generate;
pub mod interface;
pub mod ladder;
pub mod load;
pub mod logic;
pub mod lower;
pub mod mathematics;
pub mod opt;
mod parallel;
pub mod replay;
pub mod simulate;
pub mod source;
pub mod trace;

pub use batch::Batch;
pub use controller::{Controller, Engine, Error, Retained, Settings, Variable};
