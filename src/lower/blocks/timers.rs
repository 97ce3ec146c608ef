//! The timers of IEC 61131-3, 6.6.3.5.5, as matiec's `timer.txt` runs them. Each keeps the time at which it
//! started, so that one that is skipped for some scans counts what it missed. TONR, which the standard leaves out,
//! starts and expires as TON does.
//!
//! The three states of the source need no state of their own: with the input's last value (`previous`) and the
//! output, which timer is idle, timing or expired can be told. Each rule says how. "start + PT <= now" is computed as
//! "now - start >= PT", which is the same where nothing overflows, and then right as well.

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
    let (on, was_on, q) = (run.input(IN), run.state(PREVIOUS), run.output(Q));
    let clock = Clock::read(run);
    let stays_on = run.logic.and(on, was_on);
    let expired = run.logic.or(q, clock.due);
    let new_q = run.logic.and(stays_on, expired);
    let et = run.output(ET);
    let running = clock.elapsed_or_preset(run);
    let held = run.logic.select(q, et, running);
    let zero = run.logic.constant(Value::time(0));
    let new_et = run.logic.select(stays_on, held, zero);
    let new_start = run.logic.select(was_on, clock.start, clock.now);
    run.set_state(START, new_start);
    run.set_state(PREVIOUS, on);
    run.set_output(Q, new_q);
    run.set_output(ET, new_et);
}

/// Off-delay. Timing while the input was off and Q is on; expired while both are off.
fn tof(run: &mut Run<'_>) {
    let (on, was_on, q) = (run.input(IN), run.state(PREVIOUS), run.output(Q));
    let clock = Clock::read(run);
    let not_due = run.logic.not(clock.due);
    let falls_or_times = run.logic.or(was_on, not_due);
    let delayed = run.logic.and(q, falls_or_times);
    let new_q = run.logic.or(on, delayed);
    let et = run.output(ET);
    let was_off = run.logic.not(was_on);
    let timing = run.logic.and(was_off, q);
    let running = clock.elapsed_or_preset(run);
    let off_et = run.logic.select(timing, running, et);
    let zero = run.logic.constant(Value::time(0));
    let new_et = run.logic.select(on, zero, off_et);
    let new_start = run.logic.select(was_on, clock.now, clock.start);
    run.set_state(START, new_start);
    run.set_state(PREVIOUS, on);
    run.set_output(Q, new_q);
    run.set_output(ET, new_et);
}

/// Pulse. Timing while Q is on; else expired while the input was on, else idle.
fn tp(run: &mut Run<'_>) {
    let (on, was_on, timing) = (run.input(IN), run.state(PREVIOUS), run.output(Q));
    let clock = Clock::read(run);
    let was_off = run.logic.not(was_on);
    let rises = run.logic.and(on, was_off);
    let not_timing = run.logic.not(timing);
    let begins = run.logic.and(rises, not_timing);
    let not_due = run.logic.not(clock.due);
    let goes_on = run.logic.and(timing, not_due);
    let new_q = run.logic.or(begins, goes_on);
    let et = run.output(ET);
    let running = clock.elapsed_or_preset(run);
    let held = run.logic.select(timing, running, et);
    // Expired with the input off is idle, in the same scan.
    let keeps = run.logic.or(on, goes_on);
    let zero = run.logic.constant(Value::time(0));
    let new_et = run.logic.select(keeps, held, zero);
    let new_start = run.logic.select(timing, clock.start, clock.now);
    run.set_state(START, new_start);
    run.set_state(PREVIOUS, on);
    run.set_output(Q, new_q);
    run.set_output(ET, new_et);
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
    now: ValueId,
    start: ValueId,
    elapsed: ValueId,
    preset: ValueId,
    /// Whether the preset has passed since the start.
    due: ValueId,
}

impl Clock {
    fn read(run: &mut Run<'_>) -> Self {
        let (now, start, preset) = (run.logic.now(), run.state(START), run.input(PT));
        let elapsed = run.logic.binary(Binary::Subtract, now, start);
        let due = run.logic.compare(Compare::GreaterOrEqual, elapsed, preset);
        Self { now, start, elapsed, preset, due }
    }

    /// ET of a timer that is timing, or expires now.
    fn elapsed_or_preset(&self, run: &mut Run<'_>) -> ValueId {
        run.logic.select(self.due, self.preset, self.elapsed)
    }
}
