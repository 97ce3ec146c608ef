//! UC and DC, which count between 0 and 9999.

use super::super::{Rule, Rules, Run};
use super::{DIGITS, number, preset};
use crate::elementary::Elementary::{Bool, Uint, Word};
use crate::ladder::library::StandardBlock::{Dc, Uc};
use crate::logic::{Binary, Compare, ValueId};

const COUNT: usize = 0;
const ENABLE: usize = 1;
const PRESET: usize = 2;
const Q: usize = 0;
const VALUE: usize = 1;

pub(in super::super) const RULES: Rules = &[
    (&[Uc], Rule { states: &[("circuit", Bool)], run: up_counter }),
    (&[Dc], Rule { states: &[("circuit", Bool), ("loaded", Bool)], run: down_counter }),
];

/// Counts on past the preset, up to the limit.
fn up_counter(run: &mut Run<'_>) {
    let enabled = run.input(ENABLE);
    let count = count_up(run, COUNT, VALUE, DIGITS);
    let zero = number(run, Uint, 0);
    let count = run.logic.select(enabled, count, zero);
    let preset = preset(run, PRESET, DIGITS, Uint);
    let reached = run.logic.compare(Compare::GreaterOrEqual, count, preset);
    let q = run.logic.and(enabled, reached);
    run.set_output(Q, q);
    set_value(run, VALUE, count);
}

/// Counts from the preset, which it takes while it is not enabled and on its first run, down to 0.
fn down_counter(run: &mut Run<'_>) {
    let (enabled, count) = (run.input(ENABLE), run.input(COUNT));
    let rises = run.rises(count, 0);
    let preset = preset(run, PRESET, DIGITS, Uint);
    let (value, loaded) = (run.output(VALUE), run.state(1));
    let value = run.logic.convert(value, Uint);
    let keeps = run.logic.and(enabled, loaded);
    let value = run.logic.select(keeps, value, preset);
    let zero = number(run, Uint, 0);
    let above = run.logic.compare(Compare::Greater, value, zero);
    let steps = run.logic.and(rises, above);
    let steps = run.logic.and(steps, enabled);
    let steps = run.logic.convert(steps, Uint);
    let value = run.logic.binary(Binary::Subtract, value, steps);
    let empty = run.logic.compare(Compare::Equal, value, zero);
    let q = run.logic.and(enabled, empty);
    let yes = run.logic.bool(true);
    run.set_state(1, yes);
    run.set_output(Q, q);
    set_value(run, VALUE, value);
}

/// The value, a UINT, as it is after a run that is enabled: one more if the circuit at a pin rises, up to a limit. State 0 is the
/// memory of the edge.
pub(super) fn count_up(run: &mut Run<'_>, circuit: usize, value: usize, limit: u16) -> ValueId {
    let rises = run.rises(run.input(circuit), 0);
    let value = run.output(value);
    let value = run.logic.convert(value, Uint);
    let limit = number(run, Uint, i64::from(limit));
    let below = run.logic.compare(Compare::Less, value, limit);
    let steps = run.logic.and(rises, below);
    let steps = run.logic.convert(steps, Uint);
    run.logic.binary(Binary::Add, value, steps)
}

/// Sets the output that shows a UINT as a WORD.
pub(super) fn set_value(run: &mut Run<'_>, pin: usize, value: ValueId) {
    let value = run.logic.convert(value, Word);
    run.set_output(pin, value);
}
