//! TT and TS: on-delay, off-delay and interval timers that count tenths of a second, or seconds.
//!
//! The time is summed up in nanoseconds and only shown in units, so that nothing is lost between runs. What passed since the last
//! run is added whole, also if runs were skipped. No time is added beyond the preset.

use super::super::{Rule, Rules, Run};
use super::{DIGITS, number, preset};
use crate::elementary::Elementary;
use crate::elementary::Elementary::{Bool, Lword, Time, Udint, Word};
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
    let (units, nanoseconds) = (preset(run, PRESET, DIGITS, Time), number(run, Time, unit));
    let preset = run.logic.binary(Binary::Multiply, units, nanoseconds);
    let enabled = run.input(ENABLE);
    let (time, q) = match kind {
        0 => off_delay(run, preset),
        1 => on_delay(run, preset),
        _ => interval(run, preset),
    };
    let zero = number(run, Time, 0);
    let time = run.logic.select(enabled, time, zero);
    let q = run.logic.and(enabled, q);
    let now = run.logic.now();
    let value = whole_units(run, time, unit);
    run.set_state(LAST, now);
    run.set_state(TIME, time);
    run.set_output(Q, q);
    run.set_output(VALUE, value);
}

/// How many whole units a time from 0 to 9999 of them is, as a WORD: the quotient, without a division, which small processors
/// take long for and hardware much room. The product with the reciprocal, which is cut off, is at most one too small: what is
/// cut off is worth less than `time / 2^49`, below 1.
fn whole_units(run: &mut Run<'_>, time: ValueId, unit: i64) -> ValueId {
    // The powers of two in the unit go first, so that the product stays within 63 bits.
    let twos = unit.trailing_zeros();
    let reciprocal = number(run, Time, (1 << 49) / (unit >> twos));
    let without_twos = shifted_down(run, time, twos);
    let product = run.logic.binary(Binary::Multiply, without_twos, reciprocal);
    let estimate = shifted_down(run, product, 49);
    let unit = number(run, Time, unit);
    let counted = run.logic.binary(Binary::Multiply, estimate, unit);
    let rest = run.logic.binary(Binary::Subtract, time, counted);
    let one_more = run.logic.compare(Compare::GreaterOrEqual, rest, unit);
    let one_more = run.logic.convert(one_more, Time);
    let whole = run.logic.binary(Binary::Add, estimate, one_more);
    run.logic.convert(whole, Word)
}

fn shifted_down(run: &mut Run<'_>, time: ValueId, places: u32) -> ValueId {
    let (bits, places) = (run.logic.convert(time, Lword), number(run, Udint, i64::from(places)));
    let bits = run.logic.binary(Binary::ShiftRight, bits, places);
    run.logic.convert(bits, Time)
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
    let zero = number(run, Time, 0);
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
    let zero = number(run, Time, 0);
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
