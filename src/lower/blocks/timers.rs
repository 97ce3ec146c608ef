//! The timers of IEC 61131-3, 6.6.3.5.5, as matiec's `timer.txt` runs them. Each keeps the time at which it
//! started, so that one that is skipped for some scans counts what it missed. TONR, which the standard leaves out,
//! starts and expires as TON does.
//!
//! The three states of the source need no state of their own: with the input's last value (`previous`) and the
//! output, which timer is idle, timing or expired can be told. Each rule says how. "start + PT <= now" is computed as
//! "now - start >= PT", which is the same where nothing overflows, and then right as well. The start is moved along with
//! the time while a timer is not timing, so that what has elapsed is then 0 and needs no choice.
//!
//! A preset that is [`fixed`] makes a timer shorter by a third: it has not passed where nothing has elapsed, what has
//! expired stays so by the time alone, and ET of an expired timer is the preset.

use super::{Rule, Rules, Run};
use crate::elementary::{Elementary, Value};
use crate::ladder::library::StandardBlock::{Tof, Ton, Tonr, Tp};
use crate::logic::{Binary, Compare, ValueId};

const IN: usize = 0;
const PT: usize = 1;
const Q: usize = 0;
const ET: usize = 1;
const PREVIOUS: usize = 0;
const START: usize = 1;
const STATES: &[(&str, Elementary)] = &[("previous", Elementary::Bool), ("start", Elementary::Time)];

pub(super) const RULES: Rules = &[
    (&[Ton], Rule { states: STATES, run: ton }),
    (&[Tof], Rule { states: STATES, run: tof }),
    (&[Tp], Rule { states: STATES, run: tp }),
    (&[Tonr], Rule { states: &[("timing", Elementary::Bool), ("last", Elementary::Time)], run: tonr }),
];

/// On-delay. Idle while the input was off; else expired while Q is on, else timing.
fn ton(run: &mut Run<'_>) {
    let (on, was_on) = (run.input(IN), run.state(PREVIOUS));
    let stays_on = run.logic.and(on, was_on);
    let clock = Clock::going_on(run, stays_on);
    let (new_q, new_et) = if fixed(run) {
        (clock.due, run.logic.select(clock.due, clock.preset, clock.elapsed))
    } else {
        let (q, et) = (run.output(Q), run.output(ET));
        let expired = run.logic.or(q, clock.due);
        let new_q = run.logic.and(stays_on, expired);
        let reached = run.logic.select(q, et, clock.preset);
        (new_q, run.logic.select(new_q, reached, clock.elapsed))
    };
    finish(run, &clock, new_q, new_et);
}

/// Off-delay. Timing while the input was off and Q is on; expired while both are off.
fn tof(run: &mut Run<'_>) {
    let (on, was_on, q, et) = (run.input(IN), run.state(PREVIOUS), run.output(Q), run.output(ET));
    let fresh = run.logic.or(on, was_on);
    let stays_off = run.logic.not(fresh);
    let clock = Clock::going_on(run, stays_off);
    // With a preset above 0 nothing is due where nothing has elapsed.
    let due = if fixed(run) { clock.due } else { run.logic.and(stays_off, clock.due) };
    let not_due = run.logic.not(due);
    let delayed = run.logic.and(q, not_due);
    let new_q = run.logic.or(on, delayed);
    let running = run.logic.select(due, clock.preset, clock.elapsed);
    let not_expired = run.logic.or(on, q);
    let new_et = run.logic.select(not_expired, running, et);
    finish(run, &clock, new_q, new_et);
}

/// Pulse. Timing while Q is on; else expired while the input was on, else idle.
fn tp(run: &mut Run<'_>) {
    let (on, was_on, timing) = (run.input(IN), run.state(PREVIOUS), run.output(Q));
    let clock = Clock::going_on(run, timing);
    let was_off = run.logic.not(was_on);
    let rises = run.logic.and(on, was_off);
    let begins_or_times = run.logic.or(timing, rises);
    let due = if fixed(run) { clock.due } else { run.logic.and(timing, clock.due) };
    let not_due = run.logic.not(due);
    let new_q = run.logic.and(begins_or_times, not_due);
    let reached = if fixed(run) {
        clock.preset
    } else {
        let et = run.output(ET);
        run.logic.select(timing, clock.preset, et)
    };
    // Expired with the input off is idle, in the same scan.
    let zero = run.logic.constant(Value::time(0));
    let at_rest = run.logic.select(on, reached, zero);
    let new_et = run.logic.select(new_q, clock.elapsed, at_rest);
    finish(run, &clock, new_q, new_et);
}

/// Whether the preset is one constant above zero in every run of the instance, and the time of its last run never lies
/// ahead: a retained instance may have run last under a clock that was further on.
fn fixed(run: &Run<'_>) -> bool {
    run.only_constant(PT).is_some_and(|preset| preset.as_integer() > Some(0)) && !run.is_retained()
}

fn finish(run: &mut Run<'_>, clock: &Clock, q: ValueId, et: ValueId) {
    run.set_state(START, clock.start);
    run.set_state(PREVIOUS, run.input(IN));
    run.set_output(Q, q);
    run.set_output(ET, et);
}

/// Retentive on-delay. R clears and wins; else ET sums up the time between runs that both have IN, until it is PT;
/// then Q and ET stay until R. The time since the last run is added whole, also if runs were skipped.
fn tonr(run: &mut Run<'_>) {
    let [on, reset, preset] = [0, 1, 2].map(|pin| run.input(pin));
    let (was_timing, last, q, et) = (run.state(0), run.state(1), run.output(Q), run.output(ET));
    let not_reset = run.logic.not(reset);
    let timing = run.logic.and(on, not_reset);
    let stays_on = run.logic.and(timing, was_timing);
    let not_expired = run.logic.not(q);
    let counts = run.logic.and(stays_on, not_expired);
    let (now, zero) = (run.logic.now(), run.logic.constant(Value::time(0)));
    let passed = run.logic.binary(Binary::Subtract, now, last);
    // A retained instance may have run last under a clock that was further on.
    let passed = run.logic.binary(Binary::Maximum, passed, zero);
    let sum = run.logic.binary(Binary::Add, et, passed);
    let due = run.logic.compare(Compare::GreaterOrEqual, sum, preset);
    let expires = run.logic.and(counts, due);
    let expired = run.logic.or(q, expires);
    let new_q = run.logic.and(not_reset, expired);
    let running = run.logic.select(due, preset, sum);
    let held = run.logic.select(counts, running, et);
    let new_et = run.logic.select(reset, zero, held);
    run.set_state(0, timing);
    run.set_state(1, now);
    run.set_output(Q, new_q);
    run.set_output(ET, new_et);
}

/// What a timer knows of the time.
struct Clock {
    /// The time at which it started; while it is not timing, now.
    start: ValueId,
    /// The time since then.
    elapsed: ValueId,
    preset: ValueId,
    /// Whether that is the preset or more.
    due: ValueId,
}

impl Clock {
    /// That of a timer which keeps its start while `times`.
    fn going_on(run: &mut Run<'_>, times: ValueId) -> Self {
        let (now, start, preset) = (run.logic.now(), run.state(START), run.input(PT));
        let start = run.logic.select(times, start, now);
        let elapsed = run.logic.binary(Binary::Subtract, now, start);
        let due = run.logic.compare(Compare::GreaterOrEqual, elapsed, preset);
        Self { start, elapsed, preset, due }
    }
}
