//! Constant folding. Literals without a type are computed exactly, as numbers without a width, and take a type only
//! where they meet one; values with a type are computed in it. It must never wrap around: what does not fit is `None`,
//! for the caller to report. REALs are rounded after each operation, and what is not finite is no constant.

use std::cmp::Ordering;

use crate::elementary::{Elementary, Value};
use crate::ladder::{BinaryOperator, UnaryOperator};

/// A constant without a type.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) enum Untyped {
    /// An integer, for every type that holds it.
    Integer(i128),
    /// What AND, OR, XOR and NOT make of integers, as two's complement without an end: for bit strings only.
    Bits(i128),
    /// A real number.
    Real(f64),
}

/// What became of an operation on constants.
pub(super) enum Folded<T> {
    /// A constant of the operands' kind.
    Value(T),
    /// A comparison's BOOL.
    Bool(bool),
    /// More than the type, or any type, holds.
    Overflow,
    /// Operands that the operator does not take.
    Mismatch,
}

impl<T> Folded<T> {
    fn checked(value: Option<T>) -> Self {
        value.map_or(Self::Overflow, Self::Value)
    }
}

fn finite(value: f64) -> Option<f64> {
    value.is_finite().then_some(value)
}

/// As `f64`, rounded to nearest.
fn real_of(integer: i128) -> f64 {
    integer as f64
}

impl Untyped {
    fn as_real(self) -> Option<f64> {
        match self {
            Self::Integer(value) => Some(real_of(value)),
            Self::Real(value) => Some(value),
            Self::Bits(_) => None,
        }
    }

    pub(super) fn unary(self, op: UnaryOperator) -> Folded<Self> {
        match (op, self) {
            (UnaryOperator::Not, Self::Integer(value) | Self::Bits(value)) => Folded::Value(Self::Bits(!value)),
            (UnaryOperator::Negate, Self::Integer(value)) => Folded::checked(value.checked_neg().map(Self::Integer)),
            (UnaryOperator::Negate, Self::Real(value)) => Folded::Value(Self::Real(-value)),
            _ => Folded::Mismatch,
        }
    }

    pub(super) fn binary(self, op: BinaryOperator, other: Self) -> Folded<Self> {
        use Untyped::{Bits, Integer, Real};
        match (self, other) {
            (Integer(a) | Bits(a), Integer(b) | Bits(b)) if op.is_comparison() => {
                Folded::Bool(holds(op, Some(a.cmp(&b))))
            }
            (Integer(a) | Bits(a), Integer(b) | Bits(b)) if is_bitwise(op) => {
                Folded::checked(integers(op, a, b).map(Bits))
            }
            (Integer(a), Integer(b)) => Folded::checked(integers(op, a, b).map(Integer)),
            _ => match (self.as_real(), other.as_real()) {
                (Some(a), Some(b)) if op.is_comparison() => Folded::Bool(holds(op, a.partial_cmp(&b))),
                (Some(a), Some(b)) if !is_bitwise(op) && op != BinaryOperator::Modulo => {
                    Folded::checked(reals(op, a, b).map(Real))
                }
                _ => Folded::Mismatch,
            },
        }
    }

    /// Whether it is a number of a kind that a type holds, in range or not.
    pub(super) fn suits(self, ty: Elementary) -> bool {
        match self {
            Self::Integer(_) => ty != Elementary::Time,
            Self::Bits(_) => ty.is_bit_string(),
            Self::Real(_) => ty.is_real(),
        }
    }

    /// As a value of a type that it suits; `None` when it is out of range.
    pub(super) fn typed(self, ty: Elementary) -> Option<Value> {
        match self {
            Self::Integer(value) if ty == Elementary::Real => Value::real(ty, f64::from(value as f32)),
            Self::Integer(value) if ty.is_real() => Value::real(ty, real_of(value)),
            Self::Integer(value) => Value::integer(ty, value),
            Self::Bits(value) => {
                let (_, greatest) = ty.range()?;
                (-greatest - 1..=greatest).contains(&value).then(|| Value::integer(ty, value & greatest))?
            }
            Self::Real(value) => Value::real(ty, value).filter(is_finite),
        }
    }

    /// What it is, in words.
    pub(super) fn describe(self) -> &'static str {
        match self {
            Self::Integer(_) => "integer",
            Self::Bits(_) => "bit string",
            Self::Real(_) => "real number",
        }
    }

    /// Whether it is zero.
    pub(super) fn is_zero(self) -> bool {
        match self {
            Self::Integer(value) | Self::Bits(value) => value == 0,
            Self::Real(value) => value == 0.0,
        }
    }
}

fn is_bitwise(op: BinaryOperator) -> bool {
    matches!(op, BinaryOperator::And | BinaryOperator::Or | BinaryOperator::Xor)
}

fn is_finite(value: &Value) -> bool {
    value.as_real().is_none_or(f64::is_finite)
}

/// Whether a value is zero, of whatever type; both zeros of a real are.
pub(super) fn is_zero(value: Value) -> bool {
    value.as_real().map_or(!value.is_true(), |real| real == 0.0)
}

/// An operator that takes the value's type, on a value.
pub(super) fn unary(op: UnaryOperator, value: Value) -> Option<Value> {
    let ty = value.ty();
    match (op, value.as_real()) {
        (UnaryOperator::Not, _) => Some(Value::from_bits(ty, !value.bits())),
        (UnaryOperator::Negate, Some(real)) => Value::real(ty, -real),
        (UnaryOperator::Negate, None) => Value::integer(ty, -value.as_integer()?),
    }
}

/// An operator that takes the values' type, on two values of one type.
pub(super) fn binary(op: BinaryOperator, a: Value, b: Value) -> Folded<Value> {
    let ty = a.ty();
    if let (Some(a), Some(b)) = (a.as_real(), b.as_real()) {
        if op.is_comparison() {
            return Folded::Bool(holds(op, a.partial_cmp(&b)));
        }
        // Computed in LREAL and rounded to REAL: 53 bits are enough for the correctly rounded REAL.
        return Folded::checked(reals(op, a, b).and_then(|real| Value::real(ty, real)).filter(is_finite));
    }
    let (Some(a), Some(b)) = (a.as_integer(), b.as_integer()) else { return Folded::Mismatch };
    if op.is_comparison() {
        return Folded::Bool(holds(op, Some(a.cmp(&b))));
    }
    Folded::checked(integers(op, a, b).and_then(|value| Value::integer(ty, value)))
}

/// A value in a type that its own widens to.
pub(super) fn widen(value: Value, ty: Elementary) -> Option<Value> {
    match (value.as_integer(), value.as_real()) {
        (Some(integer), _) => Untyped::Integer(integer).typed(ty),
        (None, real) => Value::real(ty, real?),
    }
}

fn holds(op: BinaryOperator, order: Option<Ordering>) -> bool {
    match op {
        BinaryOperator::Equal => order == Some(Ordering::Equal),
        BinaryOperator::NotEqual => order != Some(Ordering::Equal),
        BinaryOperator::Less => order.is_some_and(Ordering::is_lt),
        BinaryOperator::LessOrEqual => order.is_some_and(Ordering::is_le),
        BinaryOperator::Greater => order.is_some_and(Ordering::is_gt),
        _ => order.is_some_and(Ordering::is_ge),
    }
}

/// Exact; what is divided by zero is 0, as it is when the program runs.
fn integers(op: BinaryOperator, a: i128, b: i128) -> Option<i128> {
    match op {
        BinaryOperator::And => Some(a & b),
        BinaryOperator::Or => Some(a | b),
        BinaryOperator::Xor => Some(a ^ b),
        BinaryOperator::Add => a.checked_add(b),
        BinaryOperator::Subtract => a.checked_sub(b),
        BinaryOperator::Multiply => a.checked_mul(b),
        BinaryOperator::Divide | BinaryOperator::Modulo if b == 0 => Some(0),
        BinaryOperator::Divide => a.checked_div(b),
        BinaryOperator::Modulo => a.checked_rem(b),
        _ => None,
    }
}

fn reals(op: BinaryOperator, a: f64, b: f64) -> Option<f64> {
    finite(match op {
        BinaryOperator::Add => a + b,
        BinaryOperator::Subtract => a - b,
        BinaryOperator::Multiply => a * b,
        BinaryOperator::Divide => a / b,
        _ => return None,
    })
}
