//! BS and BC: one bit of a register.
//!
//! A bit above 15 has no mask: a shift by the width or more gives 0. So nothing is changed, and the coil is off.

use super::super::{Rule, Rules, Run};
use super::number;
use crate::elementary::Elementary::{Udint, Word};
use crate::ladder::library::StandardBlock::{Bc, Bs};
use crate::logic::{Binary, Compare, ValueId};

const IN: usize = 0;
const REGISTER: usize = 1;
const BIT: usize = 2;
const Q: usize = 0;

pub(in super::super) const RULES: Rules =
    &[(&[Bs], Rule { states: &[], run: set_bit }), (&[Bc], Rule { states: &[], run: clear_bit })];

/// The coil is on while the bit is set.
fn set_bit(run: &mut Run<'_>) {
    let (bit, changed) = masks(run);
    let register = run.register(REGISTER, 0);
    let register = run.logic.or(register, changed);
    run.set_register(REGISTER, 0, register);
    set_coil(run, register, bit);
}

/// The coil is on while the bit is clear.
fn clear_bit(run: &mut Run<'_>) {
    let (bit, changed) = masks(run);
    let register = run.register(REGISTER, 0);
    let others = run.logic.not(changed);
    let register = run.logic.and(register, others);
    run.set_register(REGISTER, 0, register);
    let clear = run.logic.not(register);
    set_coil(run, clear, bit);
}

/// The mask of the bit, and that of what this run changes.
fn masks(run: &mut Run<'_>) -> (ValueId, ValueId) {
    let (power, number_of_bit) = (run.input(IN), run.input(BIT));
    let (one, none) = (number(run, Word, 1), number(run, Word, 0));
    let places = run.logic.convert(number_of_bit, Udint);
    let bit = run.logic.binary(Binary::ShiftLeft, one, places);
    (bit, run.logic.select(power, bit, none))
}

fn set_coil(run: &mut Run<'_>, bits: ValueId, bit: ValueId) {
    let found = run.logic.and(bits, bit);
    let none = number(run, Word, 0);
    let q = run.logic.compare(Compare::NotEqual, found, none);
    run.set_output(Q, q);
}
