//! The bistables of IEC 61131-3, 6.6.3.5.2: the output is the memory.

use super::{Rule, Rules, Run};
use crate::ladder::library::StandardBlock::{Rs, Sema, Sr};

pub(super) const RULES: Rules =
    &[(&[Sr, Sema], Rule { states: &[], run: set_dominant }), (&[Rs], Rule { states: &[], run: reset_dominant })];

/// Set wins: `Q1 := S1 OR (NOT R AND Q1)`. SEMA is this with other names, as matiec's `sema.txt` has it.
fn set_dominant(run: &mut Run<'_>) {
    let (set, reset, q) = (run.input(0), run.input(1), run.output(0));
    let not_reset = run.logic.not(reset);
    let held = run.logic.and(not_reset, q);
    let q = run.logic.or(set, held);
    run.set_output(0, q);
}

/// Reset wins: `Q1 := NOT R1 AND (S OR Q1)`.
fn reset_dominant(run: &mut Run<'_>) {
    let (set, reset, q) = (run.input(0), run.input(1), run.output(0));
    let not_reset = run.logic.not(reset);
    let set_or_held = run.logic.or(set, q);
    let q = run.logic.and(not_reset, set_or_held);
    run.set_output(0, q);
}
