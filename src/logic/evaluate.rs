//! What each primitive operation computes, on register forms (see [`Value`](crate::elementary::Value)).
//!
//! This is the definition. The interpreters and the constant folder call it; compiled code is tested against it.
//! Every function is total and must never panic, whatever the operands. Arithmetic that IEC 61131-3 leaves to
//! the implementer is fixed here: integers wrap around, a quotient by zero is 0, a NaN that an operation makes is
//! the canonical quiet one. [`helper`] is the one thing here that compiled code calls, too.

#[cfg(test)]
mod tests;

use super::{Binary, Compare, Helper, Unary};
use crate::elementary::{Elementary, canonical, f32_of};
use crate::mathematics::{self, Native};

/// The one NaN that arithmetic makes, as a REAL's bits.
pub const NAN32: u32 = 0x7FC0_0000;
/// The one NaN that arithmetic makes, as an LREAL's bits.
pub const NAN64: u64 = 0x7FF8_0000_0000_0000;

fn real_bits(ty: Elementary, value: f64) -> u64 {
    if ty == Elementary::Real {
        // Sum, difference, product, quotient and root of two REALs, computed in LREAL and rounded to REAL, are the
        // correctly rounded REALs: 53 bits are more than twice 24 and two.
        #[expect(clippy::cast_possible_truncation, reason = "rounding to REAL is the point")]
        let rounded = value as f32;
        u64::from(if rounded.is_nan() { NAN32 } else { rounded.to_bits() })
    } else if value.is_nan() {
        NAN64
    } else {
        value.to_bits()
    }
}

fn real_of(ty: Elementary, bits: u64) -> f64 {
    if ty == Elementary::Real { f64::from(f32_of(bits)) } else { f64::from_bits(bits) }
}

/// One operand of type `ty`.
pub fn unary(op: Unary, ty: Elementary, a: u64) -> u64 {
    match op {
        Unary::Not => canonical(ty, !a),
        // On the sign bit alone, as IEEE 754 has it: a NaN keeps its payload.
        Unary::Negate if ty.is_real() => a ^ sign_bit(ty),
        Unary::Absolute if ty.is_real() => a & !sign_bit(ty),
        Unary::Negate => canonical(ty, a.wrapping_neg()),
        Unary::Absolute if ty.is_signed() => canonical(ty, a.cast_signed().unsigned_abs()),
        Unary::Absolute => a,
        Unary::SquareRoot => real_bits(ty, real_of(ty, a).sqrt()),
    }
}

fn sign_bit(ty: Elementary) -> u64 {
    1 << (ty.bits() - 1)
}

/// Two operands; both of type `ty`, but that the amount of a shift or rotation is a UDINT.
pub fn binary(op: Binary, ty: Elementary, a: u64, b: u64) -> u64 {
    let width = u64::from(ty.bits());
    match op {
        Binary::And => a & b,
        Binary::Or => a | b,
        Binary::Xor => a ^ b,
        Binary::Add | Binary::Subtract | Binary::Multiply | Binary::Divide if ty.is_real() => {
            let (a, b) = (real_of(ty, a), real_of(ty, b));
            real_bits(
                ty,
                match op {
                    Binary::Add => a + b,
                    Binary::Subtract => a - b,
                    Binary::Multiply => a * b,
                    _ => a / b,
                },
            )
        }
        Binary::Add => canonical(ty, a.wrapping_add(b)),
        Binary::Subtract => canonical(ty, a.wrapping_sub(b)),
        Binary::Multiply => canonical(ty, a.wrapping_mul(b)),
        Binary::Divide | Binary::Remainder if b == 0 => 0,
        Binary::Divide if ty.is_signed() => {
            canonical(ty, a.cast_signed().wrapping_div(b.cast_signed()).cast_unsigned())
        }
        Binary::Divide => a / b,
        Binary::Remainder if ty.is_signed() => a.cast_signed().wrapping_rem(b.cast_signed()).cast_unsigned(),
        Binary::Remainder => a % b,
        Binary::Minimum | Binary::Maximum => {
            let a_is_less = compare(Compare::Less, ty, a, b);
            if a_is_less == (op == Binary::Minimum) { a } else { b }
        }
        Binary::ShiftLeft if b >= width => 0,
        Binary::ShiftLeft => canonical(ty, a << b),
        Binary::ShiftRight if b >= width => 0,
        Binary::ShiftRight => a >> b,
        Binary::RotateLeft => rotate_left(ty, a, b % width),
        Binary::RotateRight => rotate_left(ty, a, (width - b % width) % width),
    }
}

fn rotate_left(ty: Elementary, a: u64, amount: u64) -> u64 {
    if amount == 0 { a } else { canonical(ty, a << amount | a >> (u64::from(ty.bits()) - amount)) }
}

/// Which of an array's `count` elements an index, a LINT, names.
pub fn element(count: u32, index: u64) -> Option<u32> {
    u32::try_from(index).ok().filter(|index| *index < count)
}

/// Two operands of type `ty`.
pub fn compare(op: Compare, ty: Elementary, a: u64, b: u64) -> bool {
    fn holds<T: PartialOrd>(op: Compare, a: T, b: T) -> bool {
        match op {
            Compare::Equal => a == b,
            Compare::NotEqual => a != b,
            Compare::Less => a < b,
            Compare::LessOrEqual => a <= b,
            Compare::Greater => a > b,
            Compare::GreaterOrEqual => a >= b,
        }
    }
    if ty.is_real() {
        holds(op, real_of(ty, a), real_of(ty, b))
    } else if ty.is_signed() {
        holds(op, a.cast_signed(), b.cast_signed())
    } else {
        holds(op, a, b)
    }
}

/// A helper's operands, all of type `ty`: REALs are computed in LREAL and rounded once. A second operand counts only
/// where the helper takes two.
pub fn call(function: Helper, ty: Elementary, a: u64, b: Option<u64>) -> u64 {
    real_bits(ty, helper(function, real_of(ty, a), b.map_or(0.0, |b| real_of(ty, b))))
}

/// What a helper computes, but that a NaN may be any. `b` counts only where it takes two operands.
///
/// [`mathematics::program`](super::mathematics::program) is the same as logic.
pub fn helper(function: Helper, a: f64, b: f64) -> f64 {
    match function {
        Helper::Ln => mathematics::ln(Native, a),
        Helper::Log10 => mathematics::log10(Native, a),
        Helper::Exp => mathematics::exp(Native, a),
        Helper::Sin => mathematics::sin(Native, a),
        Helper::Cos => mathematics::cos(Native, a),
        Helper::Tan => mathematics::tan(Native, a),
        Helper::Asin => mathematics::asin(Native, a),
        Helper::Acos => mathematics::acos(Native, a),
        Helper::Atan => mathematics::atan(Native, a),
        Helper::Power => mathematics::pow(Native, a, b),
    }
}

/// The operand, of type `from`, as type `to`.
///
/// - To BOOL: whether it is other than zero (NaN is).
/// - Between integers, bit strings and TIME: the low bits, so that what does not fit wraps around.
/// - REAL or LREAL to those: rounded half to even, then held at the ends of the range; NaN is 0.
/// - To REAL or LREAL: rounded to nearest; a NaN becomes the canonical one.
pub fn convert(from: Elementary, to: Elementary, a: u64) -> u64 {
    if from == to {
        return a;
    }
    match (from.is_real(), to.is_real()) {
        _ if to == Elementary::Bool => u64::from(compare(Compare::NotEqual, from, a, 0)),
        (false, false) => canonical(to, a),
        (true, true) => real_bits(to, real_of(from, a)),
        (true, false) => integer_of(to, real_of(from, a).round_ties_even()),
        (false, true) => integer_to_real(from, to, a),
    }
}

/// The operand's bits as type `to`, which is as wide.
pub fn reinterpret(to: Elementary, a: u64) -> u64 {
    canonical(to, a)
}

fn integer_of(to: Elementary, rounded: f64) -> u64 {
    // `as` holds at the ends of the range and makes NaN 0.
    #[expect(clippy::cast_possible_truncation, reason = "saturation is wanted")]
    let (wide, (least, greatest)) = (rounded as i128, to.range().unwrap_or((0, 0)));
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "within 64 bits after the clamp")]
    let bits = wide.clamp(least, greatest) as u64;
    bits
}

fn integer_to_real(from: Elementary, to: Elementary, a: u64) -> u64 {
    // Straight to the target's precision: by way of LREAL a large integer would be rounded twice.
    #[expect(clippy::cast_precision_loss, reason = "rounding to nearest is the meaning")]
    match (to == Elementary::Real, from.is_signed()) {
        (true, true) => u64::from((a.cast_signed() as f32).to_bits()),
        (true, false) => u64::from((a as f32).to_bits()),
        (false, true) => (a.cast_signed() as f64).to_bits(),
        (false, false) => (a as f64).to_bits(),
    }
}
