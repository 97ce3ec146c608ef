//! The synthetic program that is measured: what `rung gen` makes with a timer per six rungs.

use rung::generate::{Options, generate};
use rung::logic::Program;
use rung::source::Source;
use rung::{check, lower};

/// Lowered and not yet optimised.
pub(crate) fn workload(rungs: u32) -> Program {
    let program = generate(&Options { rungs, timers: rungs / 6, ..Options::default() }).expect("options that fit");
    let checked = check::check(&program).0.expect("a generated program has no errors");
    lower::lower(&checked, &Source::new("synthetic", ""), None).expect("a small image")
}
