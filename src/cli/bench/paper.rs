//! The sizes that the literature measured, and its ratios beside ours.
//!
//! Its Table 1 has an example of 18 rungs with 3 timers on a MicroBlaze soft-core of 50 MHz, in cycles of its clock; its
//! Table 2 a program of 1451 rungs with 246 timers, in hardware only. The programs themselves were not published: ours
//! are synthetic ones of those sizes. What compares is the ratio of interpreting to compiling on one machine, not the times.

use std::fmt::Write as _;

use super::table::Measured;
use crate::generate::{Options, generate};
use crate::logic::Program;
use crate::source::Source;
use crate::{check, lower};

/// Rungs and timers.
const SIZES: [(u32, u32); 2] = [(18, 3), (1451, 246)];

/// Cycles of a scan in Table 1: interpreted and compiled software.
const INTERPRETED: f64 = 12_819.0;
const COMPILED: f64 = 891.0;

/// Synthetic programs of these sizes, not yet optimised: those of `rung gen` with these rungs and timers.
pub(super) fn programs() -> impl Iterator<Item = Program> {
    SIZES.into_iter().filter_map(|(rungs, timers)| {
        let program = generate(&Options { rungs, timers, ..Options::default() }).ok()?;
        let checked = check::check(&program).0?;
        lower::lower(&checked, &Source::new(program.name.text.clone(), ""), None).ok()
    })
}

/// How many times as long an interpreter takes as compiled code, in Table 1 and in what was measured.
pub(super) fn ratios(measured: &[Measured]) -> String {
    let mut text = format!(
        "\ninterpreted : compiled                             ratio\n{:<50} {:>5.1}\n",
        "Table 1, 18 rungs, MicroBlaze: software : software",
        INTERPRETED / COMPILED
    );
    for measured in measured.iter().take(SIZES.len()) {
        for (interpreter, compiled) in
            [("interp", "jit"), ("textbook", "jit"), ("textbook", "gcc-c"), ("textbook", "gcc-equations")]
        {
            let time = |engine: &str| measured.row(engine).and_then(|row| row.nanoseconds);
            if let (Some(slow), Some(fast)) = (time(interpreter), time(compiled)) {
                let what = format!("{} rungs here: {interpreter} : {compiled}", measured.rungs);
                let _ = writeln!(text, "{what:<50} {:>5.1}", slow / fast.max(0.1));
            }
        }
    }
    text
}
