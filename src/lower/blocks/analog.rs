//! The blocks on REAL of IEC 61131-3, annex F, as matiec's `integral_st.txt` and its neighbours run them: CYCLE, the
//! time between two runs, is a pin.
//!
//! Each operation rounds to REAL, in the order that the formulas say, and none is fused with another. A division by
//! zero (by a CYCLE or TR of 0) follows IEEE 754: it gives an infinity or NaN. Neither traps; one that comes into an
//! integral stays there until its reset.

use super::{Rule, Rules, Run};
use crate::elementary::Elementary::{Lreal, Real, Time};
use crate::elementary::Value;
use crate::ladder::library::StandardBlock;
use crate::logic::{Binary, Compare, ValueId};

pub(super) const RULES: Rules = &[
    (&[StandardBlock::Integral], Rule { states: &[], run: integral }),
    (&[StandardBlock::Derivative], Rule { states: &[("X1", Real), ("X2", Real), ("X3", Real)], run: derivative }),
    (&[StandardBlock::Pid], Rule { states: &[("X1", Real), ("X2", Real), ("X3", Real), ("integral", Real)], run: pid }),
    (&[StandardBlock::Ramp], Rule { states: &[("XI", Real), ("T", Time)], run: ramp }),
    (&[StandardBlock::Hysteresis], Rule { states: &[], run: hysteresis }),
];

/// XOUT is X0 under R1, else `XOUT + XIN * CYCLE` while RUN; Q is NOT R1.
fn integral(run: &mut Run<'_>) {
    let [runs, reset, xin, x0, cycle] = [0, 1, 2, 3, 4].map(|pin| run.input(pin));
    let (cycle, sum) = (seconds(run, cycle), run.output(1));
    let sum = integrated(run, sum, runs, reset, xin, x0, cycle);
    let q = run.logic.not(reset);
    run.set_output(0, q);
    run.set_output(1, sum);
}

/// XOUT is the slope of a line through the last four XIN while RUN, else 0.
fn derivative(run: &mut Run<'_>) {
    let [runs, xin, cycle] = [0, 1, 2].map(|pin| run.input(pin));
    let cycle = seconds(run, cycle);
    let slope = slope(run, runs, xin, cycle);
    run.set_output(0, slope);
}

/// `XOUT := KP * ((ERROR + integral of ERROR / TR) + slope of ERROR * TD)`, where `ERROR := PV - SP`. Without AUTO the
/// integral is set to `TR * (X0 - ERROR)`, which makes XOUT KP * X0.
fn pid(run: &mut Run<'_>) {
    let [auto, pv, sp, x0, kp, tr, td, cycle] = [0, 1, 2, 3, 4, 5, 6, 7].map(|pin| run.input(pin));
    let cycle = seconds(run, cycle);
    let error = run.logic.binary(Binary::Subtract, pv, sp);
    let manual = run.logic.not(auto);
    let above_error = run.logic.binary(Binary::Subtract, x0, error);
    let first = run.logic.binary(Binary::Multiply, tr, above_error);
    let sum = run.state(3);
    let sum = integrated(run, sum, auto, manual, error, first, cycle);
    run.set_state(3, sum);
    let slope = slope(run, auto, error, cycle);
    let integral_term = run.logic.binary(Binary::Divide, sum, tr);
    let two_terms = run.logic.binary(Binary::Add, error, integral_term);
    let derivative_term = run.logic.binary(Binary::Multiply, slope, td);
    let three_terms = run.logic.binary(Binary::Add, two_terms, derivative_term);
    let xout = run.logic.binary(Binary::Multiply, kp, three_terms);
    run.set_output(0, xout);
}

/// While RUN: `XOUT := XI + ((X1 - XI) * T) / TR` and then `T := T + CYCLE`, until T has come to TR: X1, not BUSY.
/// Else XOUT and XI follow X0.
fn ramp(run: &mut Run<'_>) {
    let [runs, x0, x1, tr, cycle] = [0, 1, 2, 3, 4].map(|pin| run.input(pin));
    let (from, time) = (run.state(0), run.state(1));
    let arrived = run.logic.compare(Compare::GreaterOrEqual, time, tr);
    let (passed, whole) = (seconds(run, time), seconds(run, tr));
    let distance = run.logic.binary(Binary::Subtract, x1, from);
    let product = run.logic.binary(Binary::Multiply, distance, passed);
    let share = run.logic.binary(Binary::Divide, product, whole);
    let between = run.logic.binary(Binary::Add, from, share);
    let reached = run.logic.select(arrived, x1, between);
    let xout = run.logic.select(runs, reached, x0);
    let not_arrived = run.logic.not(arrived);
    let busy = run.logic.and(runs, not_arrived);
    let later = run.logic.binary(Binary::Add, time, cycle);
    let new_time = run.logic.select(busy, later, time);
    let zero = run.logic.constant(Value::time(0));
    let new_time = run.logic.select(runs, new_time, zero);
    let new_from = run.logic.select(runs, from, x0);
    run.set_state(0, new_from);
    run.set_state(1, new_time);
    run.set_output(0, busy);
    run.set_output(1, xout);
}

/// Q comes with `XIN1 > XIN2 + EPS` and goes with `XIN1 < XIN2 - EPS`.
fn hysteresis(run: &mut Run<'_>) {
    let [xin1, xin2, eps] = [0, 1, 2].map(|pin| run.input(pin));
    let (low, high) = (run.logic.binary(Binary::Subtract, xin2, eps), run.logic.binary(Binary::Add, xin2, eps));
    let below = run.logic.compare(Compare::Less, xin1, low);
    let above = run.logic.compare(Compare::Greater, xin1, high);
    let not_below = run.logic.not(below);
    let q = run.output(0);
    let q = run.logic.select(q, not_below, above);
    run.set_output(0, q);
}

/// What an integral is after a run.
fn integrated(
    run: &mut Run<'_>,
    sum: ValueId,
    runs: ValueId,
    reset: ValueId,
    xin: ValueId,
    x0: ValueId,
    cycle: ValueId,
) -> ValueId {
    let area = run.logic.binary(Binary::Multiply, xin, cycle);
    let added = run.logic.binary(Binary::Add, sum, area);
    let held = run.logic.select(runs, added, sum);
    run.logic.select(reset, x0, held)
}

/// `(((3 * (XIN - X3)) + X1) - X2) / (10 * CYCLE)` while it runs, else 0. States 0 to 2 are X1 to X3, the last three
/// XIN; they are all XIN while it does not run.
fn slope(run: &mut Run<'_>, runs: ValueId, xin: ValueId, cycle: ValueId) -> ValueId {
    let [x1, x2, x3] = [0, 1, 2].map(|state| run.state(state));
    let (three, ten, zero) = (real(run, 3.0), real(run, 10.0), real(run, 0.0));
    let outer = run.logic.binary(Binary::Subtract, xin, x3);
    let outer = run.logic.binary(Binary::Multiply, three, outer);
    let sum = run.logic.binary(Binary::Add, outer, x1);
    let sum = run.logic.binary(Binary::Subtract, sum, x2);
    let divisor = run.logic.binary(Binary::Multiply, ten, cycle);
    let slope = run.logic.binary(Binary::Divide, sum, divisor);
    for (state, earlier) in [xin, x1, x2].into_iter().enumerate() {
        let new = run.logic.select(runs, earlier, xin);
        run.set_state(state, new);
    }
    run.logic.select(runs, slope, zero)
}

/// A TIME as a REAL of seconds: the quotient in LREAL, rounded.
fn seconds(run: &mut Run<'_>, time: ValueId) -> ValueId {
    let nanoseconds = run.logic.convert(time, Lreal);
    let second = run.logic.constant(Value::from_bits(Lreal, 1e9_f64.to_bits()));
    let seconds = run.logic.binary(Binary::Divide, nanoseconds, second);
    run.logic.convert(seconds, Real)
}

fn real(run: &mut Run<'_>, value: f32) -> ValueId {
    run.logic.constant(Value::from_bits(Real, u64::from(value.to_bits())))
}
