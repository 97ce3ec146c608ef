//! `rung gen`: a synthetic program from a seed.

use std::path::PathBuf;

use super::{Failure, write_whole};
use crate::diagnostic::Code;
use crate::frontend::native;
use crate::generate::{Options, generate};

/// Writes a synthetic program: random rungs with timers, the same for the same options on every machine
#[derive(Debug, clap::Args)]
pub(super) struct Arguments {
    /// Rungs
    #[arg(long, default_value_t = 100)]
    rungs: u32,
    /// On-delay timers, at most one a rung; one per six rungs where it is left out
    #[arg(long)]
    timers: Option<u32>,
    /// Contacts in a rung, on average
    #[arg(long, default_value_t = 6)]
    contacts: u32,
    /// How many references in a hundred are to near rungs; the others go anywhere
    #[arg(long, default_value_t = 0, value_name = "PERCENT")]
    near: u32,
    /// What the random choices start from
    #[arg(long, default_value_t = 0)]
    seed: u64,
    /// The file to write; `-` is the standard output
    #[arg(short, long, default_value = "-", value_name = "FILE")]
    output: PathBuf,
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let options = Options {
        rungs: arguments.rungs,
        timers: arguments.timers.unwrap_or(arguments.rungs / 6),
        contacts_per_rung: arguments.contacts,
        near_percent: arguments.near,
        seed: arguments.seed,
    };
    let program = generate(&options).map_err(|error| Failure::new(Code::BadOptions, error.to_string()))?;
    write_whole(&arguments.output, native::print(&program).as_bytes())
}
