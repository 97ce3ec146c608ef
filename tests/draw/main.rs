//! The pictures that `rung show` draws: golden ones beside this file, and laws that hold for any program.
//!
//! `BLESS=1` rewrites the golden pictures.

mod build;
mod golden;
mod laws;
