//! The `rung` command: one file per subcommand; this one parses, dispatches and holds what they share.
//!
//! With the runtime's host part this is the only place that does I/O. Nothing here may know how a program is
//! parsed, lowered or run; and no output file may ever be left half-written.

mod bench;
mod build;
mod check;
mod convert;
mod duration;
mod fmt;
mod generate;
mod help;
mod load;
mod output;
mod run;
mod show;
mod sim;
mod tasks;

use std::process::ExitCode;

use clap::{Parser, Subcommand};

pub(crate) use load::{Missing, load, load_checked, read_source};
pub(crate) use output::{Failure, WholeFile, cannot_write, print, report, write_whole};

/// A compiler and runtime for PLC ladder diagrams.
#[derive(Debug, Parser)]
#[command(name = "rung", version, max_term_width = 100, disable_help_subcommand = true)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    Bench(bench::Arguments),
    Build(build::Arguments),
    Check(check::Arguments),
    Convert(convert::Arguments),
    Fmt(fmt::Arguments),
    Gen(generate::Arguments),
    Show(show::Arguments),
    Run(run::Arguments),
    Sim(sim::Arguments),
    Help(help::Arguments),
}

/// Runs the command that the process was started with, and gives its exit code: 0, or 1 when there was an error
/// in what it was given, or 2 for a wrong command line.
pub fn main() -> ExitCode {
    let arguments = Arguments::parse();
    let result = match &arguments.command {
        Command::Bench(arguments) => bench::run(arguments),
        Command::Build(arguments) => build::run(arguments),
        Command::Check(arguments) => check::run(arguments),
        Command::Convert(arguments) => convert::run(arguments),
        Command::Fmt(arguments) => fmt::run(arguments),
        Command::Gen(arguments) => generate::run(arguments),
        Command::Show(arguments) => show::run(arguments),
        Command::Run(arguments) => run::run(arguments),
        Command::Sim(arguments) => sim::run(arguments),
        Command::Help(arguments) => help::run(arguments),
    };
    output::exit(result)
}
