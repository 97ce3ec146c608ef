//! DR, the drum counter: an up counter with taps.

use super::super::{Rule, Rules, Run};
use super::counters::{count_up, set_value};
use super::{number, preset};
use crate::elementary::Elementary::{Bool, Dint, Uint};
use crate::ladder::library::StandardBlock::Dr;
use crate::logic::Compare;

const STEP: usize = 0;
const ENABLE: usize = 1;
const PRESET: usize = 2;
const FIRST_TAP: usize = 3;
const Q: usize = 0;
const VALUE: usize = 1;
const FIRST_TAP_COIL: usize = 2;
const TAPS: usize = 16;
/// The greatest value: 11 bits.
const LIMIT: u16 = 2047;

pub(in super::super) const RULES: Rules = &[(&[Dr], Rule { states: &[("circuit", Bool)], run: drum })];

/// Each coil is on while the value has come to what belongs to it.
fn drum(run: &mut Run<'_>) {
    let enabled = run.input(ENABLE);
    let count = count_up(run, STEP, VALUE, LIMIT);
    let zero = number(run, Uint, 0);
    let value = run.logic.select(enabled, count, zero);
    set_value(run, VALUE, value);
    // Below every tap while not enabled, a tap of 0 included.
    let (below_all, level) = (number(run, Dint, -1), run.logic.convert(count, Dint));
    let level = run.logic.select(enabled, level, below_all);
    let preset = preset(run, PRESET, LIMIT, Dint);
    let q = run.logic.compare(Compare::GreaterOrEqual, level, preset);
    run.set_output(Q, q);
    for tap in 0..TAPS {
        let at = run.logic.convert(run.input(FIRST_TAP + tap), Dint);
        let reached = run.logic.compare(Compare::GreaterOrEqual, level, at);
        run.set_output(FIRST_TAP_COIL + tap, reached);
    }
}
