//! TT and TS: on-delay, off-delay and interval timers that count tenths of a second, or seconds.
//!
//! The time is summed up in nanoseconds and only shown in units, so that nothing is lost between runs. What passed since the last
//! run is added whole, also if runs were skipped. No time is added beyond the preset.

use super::super::{Rule, Rules, Run};
use super::{DIGITS, number, preset};
use crate::elementary::Elementary::{Bool, Time, Word};
use crate::elementary::{Elementary, Value};
use crate::ladder::library::StandardBlock::{Ts, Tt};
use crate::logic::{Binary, Compare, ValueId};

const TIMING: usize = 0;
const ENABLE: usize = 1;
const KIND: usize = 2;
const PRESET: usize = 3;
const Q: usize = 0;
const VALUE: usize = 1;
const CIRCUIT: usize = 0;
const LAST: usize = 1;
const TIME: usize = 2;
/// The timing circuit (of an on-delay: while enabled), the time and the sum of the last run.
const STATES: &[(&str, Elementary)] = &[("circuit", Bool), ("last", Time), ("time", Time)];

pub(in super::super) const RULES: Rules = &[
    (&[Tt], Rule { states: STATES, run: |run| timer(run, 100_000_000) }),
    (&[Ts], Rule { states: STATES, run: |run| timer(run, 1_000_000_000) }),
];

fn timer(run: &mut Run<'_>, unit: i64) {
    let kind = run.constant(KIND).bits();
    let unit = run.logic.constant(Value::time(unit));
    let units = preset(run, PRESET, DIGITS, Time);
    let preset = run.logic.binary(Binary::Multiply, units, unit);
    let enabled = run.input(ENABLE);
    let (time, q) = match kind {
        0 => off_delay(run, preset),
        1 => on_delay(run, preset),
        _ => interval(run, preset),
    };
    let zero = run.logic.constant(Value::time(0));
    let time = run.logic.select(enabled, time, zero);
    let q = run.logic.and(enabled, q);
    let now = run.logic.now();
    let value = run.logic.binary(Binary::Divide, time, unit);
    let value = run.logic.convert(value, Word);
    run.set_state(LAST, now);
    run.set_state(TIME, time);
    run.set_output(Q, q);
    run.set_output(VALUE, value);
}

/// The time between two runs that both have the timing circuit is summed up; the coil is on while the sum has come to the
/// preset. Gives the time and the coil, as all three kinds do, as they are while enabled.
fn on_delay(run: &mut Run<'_>, preset: ValueId) -> (ValueId, ValueId) {
    let (timing, enabled, timed) = (run.input(TIMING), run.input(ENABLE), run.state(CIRCUIT));
    let times = run.logic.and(timing, enabled);
    run.set_state(CIRCUIT, times);
    let passes = run.logic.and(times, timed);
    let time = time_after(run, passes, preset);
    let q = run.logic.compare(Compare::GreaterOrEqual, time, preset);
    (time, q)
}

/// The coil is on with the timing circuit, and after it until the preset has passed; once off it stays so.
fn off_delay(run: &mut Run<'_>, preset: ValueId) -> (ValueId, ValueId) {
    let (timing, timed, q) = (run.input(TIMING), run.state(CIRCUIT), run.output(Q));
    run.set_state(CIRCUIT, timing);
    let was_open = run.logic.not(timed);
    let passes = run.logic.and(q, was_open);
    let delayed = time_after(run, passes, preset);
    let zero = run.logic.constant(Value::time(0));
    let time = run.logic.select(timing, zero, delayed);
    let remains = run.logic.compare(Compare::Less, time, preset);
    let holds = run.logic.and(q, remains);
    let q = run.logic.or(timing, holds);
    (time, q)
}

/// A rise of the timing circuit starts a pulse; one that comes while the coil was on changes nothing.
fn interval(run: &mut Run<'_>, preset: ValueId) -> (ValueId, ValueId) {
    let (timing, q) = (run.input(TIMING), run.output(Q));
    let rises = run.rises(timing, CIRCUIT);
    let was_off = run.logic.not(q);
    let starts = run.logic.and(rises, was_off);
    let passed = time_after(run, q, preset);
    let zero = run.logic.constant(Value::time(0));
    let time = run.logic.select(starts, zero, passed);
    let remains = run.logic.compare(Compare::Less, time, preset);
    let pulse = run.logic.or(q, starts);
    let q = run.logic.and(pulse, remains);
    (time, q)
}

/// The sum, to which the time since the last run is added if it `passes`, but nothing beyond the preset.
fn time_after(run: &mut Run<'_>, passes: ValueId, preset: ValueId) -> ValueId {
    let (now, last, time) = (run.logic.now(), run.state(LAST), run.state(TIME));
    let zero = number(run, Time, 0);
    let room = run.logic.binary(Binary::Subtract, preset, time);
    let passed = run.logic.binary(Binary::Subtract, now, last);
    let passed = run.logic.binary(Binary::Minimum, passed, room);
    // The preset may have fallen below the sum; and a retained instance may have run last under a clock that was further on.
    let passed = run.logic.binary(Binary::Maximum, passed, zero);
    let passed = run.logic.select(passes, passed, zero);
    run.logic.binary(Binary::Add, time, passed)
}
