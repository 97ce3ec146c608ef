//! SHIFTL and SHIFTR: up to 32 registers in a chain, the first of them the lowest.
//!
//! To shift a register is to multiply it by a power of two, as 32 bits, of which one half stays in the register and the other goes
//! to its neighbour. So one factor says everything: whether the registers shift, how far, and, as 0, that they are cleared;
//! and no register needs a select.

use super::super::{Rule, Rules, Run};
use super::number;
use crate::elementary::Elementary::{self, Bool, Dword, Udint, Usint, Word};
use crate::ladder::library::StandardBlock::{Shiftl, Shiftr};
use crate::logic::{Binary, Compare, ValueId};

const SHIFT: usize = 0;
const DATA: usize = 1;
const ENABLE: usize = 2;
const COUNT: usize = 3;
const REGISTER: usize = 4;
const LENGTH: usize = 5;
const Q: usize = 0;
const STATES: &[(&str, Elementary)] = &[("circuit", Bool)];
/// One bit above those of a register.
const ABOVE: i64 = 1 << 16;

pub(in super::super) const RULES: Rules =
    &[(&[Shiftl], Rule { states: STATES, run: shift_left }), (&[Shiftr], Rule { states: STATES, run: shift_right })];

/// Up: a product's high half, what left its register, comes into the register above.
fn shift_left(run: &mut Run<'_>) {
    let rises = run.rises(run.input(SHIFT), 0);
    let (one, places) = (number(run, Dword, 1), places(run));
    let power = run.logic.binary(Binary::ShiftLeft, one, places);
    let factor = factor(run, rises, power, 1);
    let (data, enabled) = (run.input(DATA), run.input(ENABLE));
    let (one, zero) = (number(run, Udint, 1), number(run, Udint, 0));
    let ones = run.logic.binary(Binary::Subtract, factor, one);
    let fills = run.logic.and(data, enabled);
    let mut carry = run.logic.select(fills, ones, zero);
    for register in 0..length(run) {
        let product = product(run, register, factor);
        let shifted = run.logic.binary(Binary::Add, product, carry);
        set_register(run, register, shifted);
        carry = high_half(run, product);
    }
    set_coil(run, rises, carry, 1);
}

/// Down: a product's low half, what left its register, comes into the register below. What stands above the low half is
/// cut off there.
fn shift_right(run: &mut Run<'_>) {
    let rises = run.rises(run.input(SHIFT), 0);
    let (above, places) = (number(run, Dword, ABOVE), places(run));
    let power = run.logic.binary(Binary::ShiftRight, above, places);
    let factor = factor(run, rises, power, ABOVE);
    let (data, zero) = (run.input(DATA), number(run, Udint, 0));
    let ones = run.logic.binary(Binary::Subtract, zero, factor);
    let mut carry = run.logic.select(data, ones, zero);
    for register in (0..length(run)).rev() {
        let product = product(run, register, factor);
        let high = high_half(run, product);
        let shifted = run.logic.binary(Binary::Add, high, carry);
        set_register(run, register, shifted);
        carry = product;
    }
    set_coil(run, rises, carry, ABOVE / 2);
}

/// How many places a shift goes, a UDINT: COUNT, or the nearest from 1 to 15.
fn places(run: &mut Run<'_>) -> ValueId {
    let (count, least, greatest) = (run.input(COUNT), number(run, Usint, 1), number(run, Usint, 15));
    let count = run.logic.binary(Binary::Maximum, count, least);
    let count = run.logic.binary(Binary::Minimum, count, greatest);
    run.logic.convert(count, Udint)
}

fn length(run: &Run<'_>) -> u32 {
    u32::try_from(run.constant(LENGTH).bits()).unwrap_or(0)
}

/// What every register is multiplied by, a UDINT: what shifts it, what leaves it where it is or what clears it.
fn factor(run: &mut Run<'_>, rises: ValueId, shifts: ValueId, stays: i64) -> ValueId {
    let (enabled, shifts) = (run.input(ENABLE), run.logic.convert(shifts, Udint));
    let (stays, clears) = (number(run, Udint, stays), number(run, Udint, 0));
    let factor = run.logic.select(rises, shifts, stays);
    run.logic.select(enabled, factor, clears)
}

fn product(run: &mut Run<'_>, register: u32, factor: ValueId) -> ValueId {
    let register = run.register(REGISTER, register);
    let register = run.logic.convert(register, Udint);
    run.logic.binary(Binary::Multiply, register, factor)
}

fn high_half(run: &mut Run<'_>, product: ValueId) -> ValueId {
    let bits = run.logic.convert(product, Dword);
    let places = number(run, Udint, 16);
    let high = run.logic.binary(Binary::ShiftRight, bits, places);
    run.logic.convert(high, Udint)
}

fn set_register(run: &mut Run<'_>, register: u32, low_half: ValueId) {
    let value = run.logic.convert(low_half, Word);
    run.set_register(REGISTER, register, value);
}

/// The coil is the bit of the carry that left last, until the next shift.
fn set_coil(run: &mut Run<'_>, rises: ValueId, carry: ValueId, bit: i64) {
    let (carry, bit) = (run.logic.convert(carry, Dword), number(run, Dword, bit));
    let left = run.logic.and(carry, bit);
    let none = number(run, Dword, 0);
    let left = run.logic.compare(Compare::NotEqual, left, none);
    let (held, enabled) = (run.output(Q), run.input(ENABLE));
    let q = run.logic.select(rises, left, held);
    let q = run.logic.and(enabled, q);
    run.set_output(Q, q);
}
