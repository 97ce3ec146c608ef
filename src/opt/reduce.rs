//! Costly operations with a constant become cheap ones: products, quotients and remainders by powers of two are shifts
//! and masks, quotients of up to 32 bits by other constants are products, and what changes nothing goes.
//!
//! All as `evaluate` defines it: quotients are cut towards zero, remainders have the sign of the dividend, by zero both
//! are 0, and the least integer is its own magnitude. Signed ones are computed of the magnitude, as a bit string, and then
//! get their sign.

use super::rewrite::{Output, rewrite};
use crate::elementary::{Elementary, canonical};
use crate::logic::{Binary, Compare, Op, Program, Unary, ValueId};

/// See the module.
pub(super) fn reduce(program: Program) -> Program {
    rewrite(program, |output, _, instruction| match instruction.op {
        Op::Binary(op, a, b) => reduced(output, op, instruction.ty, a, b).or_else(|| output.keep(instruction)),
        Op::Constant(_)
        | Op::Now
        | Op::Load(_)
        | Op::Store(..)
        | Op::Unary(..)
        | Op::Compare(..)
        | Op::Select(..)
        | Op::Convert(_)
        | Op::Reinterpret(_)
        | Op::Call(..)
        | Op::LoadIndexed(..)
        | Op::StoreIndexed(..)
        | Op::CopyArray(..) => output.keep(instruction),
    })
}

fn reduced(output: &mut Output, op: Binary, ty: Elementary, a: ValueId, b: ValueId) -> Option<ValueId> {
    if ty.is_real() {
        return if op == Binary::Divide { product_by_reciprocal(output, ty, a, b) } else { None };
    }
    match op {
        Binary::Add => match (output.constant_of(a), output.constant_of(b)) {
            (_, Some(0)) => Some(a),
            (Some(0), _) => Some(b),
            _ => None,
        },
        Binary::Subtract if a == b => Some(output.constant(ty, 0)),
        Binary::Subtract => (output.constant_of(b)? == 0).then_some(a),
        Binary::Multiply => match (output.constant_of(a), output.constant_of(b)) {
            (_, Some(bits)) => product(output, ty, a, bits),
            (Some(bits), _) => product(output, ty, b, bits),
            (None, None) => None,
        },
        Binary::Divide => {
            let divisor = output.constant_of(b)?;
            quotient(output, ty, a, divisor)
        }
        Binary::Remainder => {
            let divisor = output.constant_of(b)?;
            remainder(output, ty, a, divisor)
        }
        Binary::Minimum | Binary::Maximum => (a == b).then_some(a),
        Binary::ShiftLeft | Binary::ShiftRight => match output.constant_of(b)? {
            0 => Some(a),
            amount => (amount >= u64::from(ty.bits())).then(|| output.constant(ty, 0)),
        },
        Binary::RotateLeft | Binary::RotateRight => (output.constant_of(b)? % u64::from(ty.bits()) == 0).then_some(a),
        Binary::And | Binary::Or | Binary::Xor => None,
    }
}

/// `x / 2` is `x * 0.5`, bit by bit: both are exact before they are rounded. Only where the reciprocal is a power of two
/// that is no subnormal.
fn product_by_reciprocal(output: &mut Output, ty: Elementary, a: ValueId, b: ValueId) -> Option<ValueId> {
    let bits = output.constant_of(b)?;
    // Exponent bits, and by how much they exceed the exponent.
    let (fraction, bias) = if ty == Elementary::Real { (23, 127) } else { (52, 1023) };
    let exponent = (bits >> fraction) & (2 * bias + 1);
    let reciprocal = (2 * bias).checked_sub(exponent).filter(|reciprocal| *reciprocal > 0)?;
    if bits & ((1 << fraction) - 1) != 0 || exponent == 0 {
        return None;
    }
    let sign = bits & (1 << (ty.bits() - 1));
    let factor = output.constant(ty, sign | reciprocal << fraction);
    Some(output.emit(ty, Op::Binary(Binary::Multiply, a, factor)))
}

/// A constant's magnitude, and whether it is negative.
fn magnitude_of(ty: Elementary, bits: u64) -> (u64, bool) {
    let negative = ty.is_signed() && bits.cast_signed() < 0;
    (if negative { bits.wrapping_neg() } else { bits }, negative)
}

fn product(output: &mut Output, ty: Elementary, a: ValueId, bits: u64) -> Option<ValueId> {
    let (magnitude, negative) = magnitude_of(ty, bits);
    let shifted = match magnitude {
        0 => return Some(output.constant(ty, 0)),
        1 => a,
        // Narrow ones are brought into form before and after, which costs more than it saves.
        _ if !magnitude.is_power_of_two() || ty.size() < 4 => return None,
        _ => {
            let wide = output.emit(string(ty), Op::Convert(a));
            let wide = shift(output, Binary::ShiftLeft, wide, magnitude.trailing_zeros());
            output.emit(ty, Op::Convert(wide))
        }
    };
    Some(if negative { output.emit(ty, Op::Unary(Unary::Negate, shifted)) } else { shifted })
}

fn quotient(output: &mut Output, ty: Elementary, a: ValueId, bits: u64) -> Option<ValueId> {
    let (divisor, negative) = magnitude_of(ty, bits);
    match divisor {
        0 => return Some(output.constant(ty, 0)),
        1 if negative => return Some(output.emit(ty, Op::Unary(Unary::Negate, a))),
        1 => return Some(a),
        _ => {}
    }
    let magic = Magic::of(ty, divisor);
    if magic.is_none() && !divisor.is_power_of_two() {
        return None;
    }
    let dividend = magnitude(output, ty, a);
    let value = match magic.filter(|_| !divisor.is_power_of_two()) {
        None => shift(output, Binary::ShiftRight, dividend, divisor.trailing_zeros()),
        Some(Magic { factor, amount }) => {
            let wide = output.emit(Elementary::Ulint, Op::Convert(dividend));
            let factor = output.constant(Elementary::Ulint, factor);
            let wide = output.emit(Elementary::Ulint, Op::Binary(Binary::Multiply, wide, factor));
            let wide = output.emit(Elementary::Lword, Op::Convert(wide));
            shift(output, Binary::ShiftRight, wide, amount)
        }
    };
    let value = output.emit(ty, Op::Convert(value));
    Some(signed_as(output, ty, a, value, negative))
}

fn remainder(output: &mut Output, ty: Elementary, a: ValueId, bits: u64) -> Option<ValueId> {
    let (divisor, _) = magnitude_of(ty, bits);
    if divisor <= 1 {
        return Some(output.constant(ty, 0));
    }
    if divisor.is_power_of_two() {
        let dividend = magnitude(output, ty, a);
        let mask = output.constant(string(ty), divisor - 1);
        let value = output.emit(string(ty), Op::Binary(Binary::And, dividend, mask));
        let value = output.emit(ty, Op::Convert(value));
        return Some(signed_as(output, ty, a, value, false));
    }
    let quotient = quotient(output, ty, a, bits)?;
    let divisor = output.constant(ty, bits);
    let multiple = output.emit(ty, Op::Binary(Binary::Multiply, quotient, divisor));
    Some(output.emit(ty, Op::Binary(Binary::Subtract, a, multiple)))
}

/// The magnitude of a value, as a bit string of its size.
fn magnitude(output: &mut Output, ty: Elementary, a: ValueId) -> ValueId {
    let a = if ty.is_signed() { output.emit(ty, Op::Unary(Unary::Absolute, a)) } else { a };
    output.emit(string(ty), Op::Convert(a))
}

/// `value` with the sign of `like`, or with the other one.
fn signed_as(output: &mut Output, ty: Elementary, like: ValueId, value: ValueId, other: bool) -> ValueId {
    if !ty.is_signed() {
        return value;
    }
    let zero = output.constant(ty, 0);
    let below = output.emit(Elementary::Bool, Op::Compare(Compare::Less, like, zero));
    let opposite = output.emit(ty, Op::Unary(Unary::Negate, value));
    let (a, b) = if other { (value, opposite) } else { (opposite, value) };
    output.emit(ty, Op::Select(below, a, b))
}

fn shift(output: &mut Output, op: Binary, a: ValueId, amount: u32) -> ValueId {
    let amount = output.constant(Elementary::Udint, u64::from(amount));
    output.emit(output.ty(a), Op::Binary(op, a, amount))
}

/// The bit string of a type's size.
fn string(ty: Elementary) -> Elementary {
    match ty.size() {
        1 => Elementary::Byte,
        2 => Elementary::Word,
        4 => Elementary::Dword,
        _ => Elementary::Lword,
    }
}

/// A product of 64 bits and a shift in place of a quotient.
#[derive(Clone, Copy)]
struct Magic {
    factor: u64,
    amount: u32,
}

impl Magic {
    /// One that is right for every magnitude of a type of up to 32 bits. With `factor * divisor = 2^amount + error`, the
    /// product exceeds the quotient by less than the next one's distance while `error * 2^width <= 2^amount`
    /// (T. Granlund, P. Montgomery: Division by Invariant Integers using Multiplication, theorem 4.2).
    fn of(ty: Elementary, divisor: u64) -> Option<Self> {
        let width = ty.bits();
        if width > 32 || divisor == 0 {
            return None;
        }
        (width..64).find_map(|amount| {
            let factor = (1u128 << amount).div_ceil(u128::from(divisor));
            let error = factor * u128::from(divisor) - (1 << amount);
            let fits = factor < 1 << (64 - width) && error << width <= 1 << amount;
            fits.then(|| Self { factor: canonical(Elementary::Ulint, u64::try_from(factor).unwrap_or(0)), amount })
        })
    }
}
