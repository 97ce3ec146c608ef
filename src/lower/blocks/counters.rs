//! The counters of IEC 61131-3, 6.6.3.5.4, as matiec's `counter.txt` runs them. The memories of the edges follow
//! their inputs on every run, under reset and load as well. One rule serves every type that is counted in.

use super::{Rule, Rules, Run};
use crate::elementary::{Elementary, Value};
use crate::ladder::library::StandardBlock::{
    Ctd, CtdDint, CtdInt, CtdLint, CtdUdint, CtdUlint, Ctu, CtuDint, CtuInt, CtuLint, CtuUdint, CtuUlint, Ctud,
    CtudDint, CtudInt, CtudLint, CtudUdint, CtudUlint,
};
use crate::logic::{Binary, Compare, ValueId};

pub(super) const RULES: Rules = &[
    (&[Ctu, CtuInt, CtuDint, CtuLint, CtuUdint, CtuUlint], Rule { states: &[("CU", Elementary::Bool)], run: ctu }),
    (&[Ctd, CtdInt, CtdDint, CtdLint, CtdUdint, CtdUlint], Rule { states: &[("CD", Elementary::Bool)], run: ctd }),
    (
        &[Ctud, CtudInt, CtudDint, CtudLint, CtudUdint, CtudUlint],
        Rule { states: &[("CU", Elementary::Bool), ("CD", Elementary::Bool)], run: ctud },
    ),
];

/// Up: R clears and wins; else a rising CU counts while CV is below PV.
fn ctu(run: &mut Run<'_>) {
    let [cu, reset, preset] = [0, 1, 2].map(|pin| run.input(pin));
    let rises = run.rises(cu, 0);
    let count = run.output(1);
    let counted = count_up(run, rises, count, preset);
    let zero = zero(run, count);
    let count = run.logic.select(reset, zero, counted);
    let q = run.logic.compare(Compare::GreaterOrEqual, count, preset);
    run.set_output(0, q);
    run.set_output(1, count);
}

/// Down: LD loads PV and wins; else a rising CD counts while CV is above 0.
fn ctd(run: &mut Run<'_>) {
    let [cd, load, preset] = [0, 1, 2].map(|pin| run.input(pin));
    let rises = run.rises(cd, 0);
    let count = run.output(1);
    let counted = count_down(run, rises, count);
    let count = run.logic.select(load, preset, counted);
    let zero = zero(run, count);
    let q = run.logic.compare(Compare::LessOrEqual, count, zero);
    run.set_output(0, q);
    run.set_output(1, count);
}

/// Both: R before LD before counting; two edges in one scan cancel.
fn ctud(run: &mut Run<'_>) {
    let [cu, cd, reset, load, preset] = [0, 1, 2, 3, 4].map(|pin| run.input(pin));
    let (up, down) = (run.rises(cu, 0), run.rises(cd, 1));
    let (not_up, not_down) = (run.logic.not(up), run.logic.not(down));
    let (only_up, only_down) = (run.logic.and(up, not_down), run.logic.and(down, not_up));
    let count = run.output(2);
    let counted_up = count_up(run, only_up, count, preset);
    let counted_down = count_down(run, only_down, count);
    let counted = run.logic.select(only_up, counted_up, counted_down);
    let loaded = run.logic.select(load, preset, counted);
    let zero = zero(run, count);
    let count = run.logic.select(reset, zero, loaded);
    let at_preset = run.logic.compare(Compare::GreaterOrEqual, count, preset);
    let at_zero = run.logic.compare(Compare::LessOrEqual, count, zero);
    run.set_output(0, at_preset);
    run.set_output(1, at_zero);
    run.set_output(2, count);
}

/// One more while `counts`, below the preset.
fn count_up(run: &mut Run<'_>, counts: ValueId, count: ValueId, preset: ValueId) -> ValueId {
    let below = run.logic.compare(Compare::Less, count, preset);
    let steps = run.logic.and(counts, below);
    step(run, Binary::Add, steps, count)
}

/// One less while `counts`, above zero.
fn count_down(run: &mut Run<'_>, counts: ValueId, count: ValueId) -> ValueId {
    let zero = zero(run, count);
    let above = run.logic.compare(Compare::Greater, count, zero);
    let steps = run.logic.and(counts, above);
    step(run, Binary::Subtract, steps, count)
}

fn step(run: &mut Run<'_>, op: Binary, steps: ValueId, count: ValueId) -> ValueId {
    // A BOOL as a number is the step itself: 1 or 0.
    let amount = run.logic.convert(steps, run.logic.ty(count));
    run.logic.binary(op, count, amount)
}

fn zero(run: &mut Run<'_>, like: ValueId) -> ValueId {
    let ty = run.logic.ty(like);
    run.logic.constant(Value::default_of(ty))
}
