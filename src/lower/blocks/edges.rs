//! The edge detectors of IEC 61131-3, 6.6.3.5.3.

use super::{Rule, Rules, Run};
use crate::elementary::Elementary;
use crate::ladder::library::StandardBlock::{FTrig, RTrig};

pub(super) const RULES: Rules = &[
    (&[RTrig], Rule { states: &[("memory", Elementary::Bool)], run: r_trig }),
    (&[FTrig], Rule { states: &[("memory", Elementary::Bool)], run: f_trig }),
];

/// Q for the run in which CLK has become TRUE; a CLK that is TRUE on the first run pulses.
fn r_trig(run: &mut Run<'_>) {
    let q = run.rises(run.input(0), 0);
    run.set_output(0, q);
}

/// Q for the run in which CLK has become FALSE; a CLK that is FALSE on the first run pulses, as the standard's
/// equation (and matiec) has it.
fn f_trig(run: &mut Run<'_>) {
    let off = run.logic.not(run.input(0));
    let q = run.rises(off, 0);
    run.set_output(0, q);
}
