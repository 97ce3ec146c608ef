//! Functions of constants. As with operators, arithmetic that does not fit its type is for the caller to report; but
//! conversions mean what they mean when the program runs, since what does not fit is often why they are written.

use super::constant::{self, Folded};
use crate::elementary::{Elementary, Value};
use crate::ladder::BinaryOperator;
use crate::ladder::functions::{Function, StandardFunction};
use crate::mathematics::{self, Native};

const SECOND: i128 = 1_000_000_000;
const REAL_SECOND: f64 = 1e9;

/// A function of constants of the types that it takes, with a result of type `ty`; `None` where that does not fit.
pub(super) fn function(function: Function, ty: Elementary, arguments: &[Value]) -> Option<Value> {
    let value = match (function, arguments) {
        (Function::Standard(function), _) => standard(function, ty, arguments),
        (Function::Convert { .. }, [value]) => convert(ty, *value),
        (Function::Truncate { .. }, [value]) => value.as_real().map(|real| saturated(ty, real.trunc())),
        _ => None,
    };
    value.filter(|value| value.as_real().is_none_or(f64::is_finite))
}

fn standard(function: StandardFunction, ty: Elementary, arguments: &[Value]) -> Option<Value> {
    use StandardFunction as F;
    let real = |compute: fn(f64) -> f64| Value::real(ty, compute(arguments.first()?.as_real()?));
    match (function, arguments) {
        (F::Absolute, [value]) => match value.as_integer() {
            Some(integer) => Value::integer(ty, integer.abs()),
            None => real(f64::abs),
        },
        (F::SquareRoot, _) => real(f64::sqrt),
        (F::Ln, _) => real(|a| mathematics::ln(Native, a)),
        (F::Log, _) => real(|a| mathematics::log10(Native, a)),
        (F::Exp, _) => real(|a| mathematics::exp(Native, a)),
        (F::Sin, _) => real(|a| mathematics::sin(Native, a)),
        (F::Cos, _) => real(|a| mathematics::cos(Native, a)),
        (F::Tan, _) => real(|a| mathematics::tan(Native, a)),
        (F::Asin, _) => real(|a| mathematics::asin(Native, a)),
        (F::Acos, _) => real(|a| mathematics::acos(Native, a)),
        (F::Atan, _) => real(|a| mathematics::atan(Native, a)),
        (F::Power, [base, exponent]) => {
            let exponent = exponent.as_real().or_else(|| exponent.as_integer().map(|integer| integer as f64))?;
            Value::real(ty, mathematics::pow(Native, base.as_real()?, exponent))
        }
        (F::Add, _) => chain(BinaryOperator::Add, arguments),
        (F::Multiply, _) => chain(BinaryOperator::Multiply, arguments),
        (F::And, _) => chain(BinaryOperator::And, arguments),
        (F::Or, _) => chain(BinaryOperator::Or, arguments),
        (F::Xor, _) => chain(BinaryOperator::Xor, arguments),
        (F::ShiftLeft | F::ShiftRight, [value, amount]) => {
            let amount = u32::try_from(amount.as_integer()?).ok().filter(|amount| *amount < ty.bits());
            let shifted = |amount| match function {
                F::ShiftLeft => value.bits() << amount,
                _ => value.bits() >> amount,
            };
            Some(Value::from_bits(ty, amount.map_or(0, shifted)))
        }
        (F::RotateLeft | F::RotateRight, [value, amount]) => {
            let left = if function == F::RotateLeft { amount.as_integer()? } else { -amount.as_integer()? };
            let left = u32::try_from(left.rem_euclid(i128::from(ty.bits()))).ok()?;
            // A window as wide as the value over two copies of it.
            let twice = u128::from(value.bits()) << ty.bits() | u128::from(value.bits());
            Some(wrapped(ty, (twice >> (ty.bits() - left)).cast_signed()))
        }
        (F::Select, [which, zero, one]) => Some(if which.is_true() { *one } else { *zero }),
        (F::Multiplex, [which, inputs @ ..]) => {
            let chosen = usize::try_from(which.as_integer()?).ok().and_then(|which| inputs.get(which));
            Some(chosen.copied().unwrap_or(Value::default_of(ty)))
        }
        (F::Maximum, [first, rest @ ..]) => Some(furthest(BinaryOperator::Greater, *first, rest)),
        (F::Minimum, [first, rest @ ..]) => Some(furthest(BinaryOperator::Less, *first, rest)),
        (F::Limit, [least, value, greatest]) => {
            let raised = furthest(BinaryOperator::Greater, *value, &[*least]);
            Some(furthest(BinaryOperator::Less, raised, &[*greatest]))
        }
        (F::Greater, _) => Some(sequence(BinaryOperator::Greater, arguments)),
        (F::GreaterOrEqual, _) => Some(sequence(BinaryOperator::GreaterOrEqual, arguments)),
        (F::Equal, _) => Some(sequence(BinaryOperator::Equal, arguments)),
        (F::LessOrEqual, _) => Some(sequence(BinaryOperator::LessOrEqual, arguments)),
        (F::Less, _) => Some(sequence(BinaryOperator::Less, arguments)),
        (F::MultiplyTime | F::DivideTime, [duration, scale]) => {
            let nanoseconds = duration.as_integer()?;
            match (scale.as_integer(), scale.as_real()) {
                (Some(scale), _) if function == F::MultiplyTime => Value::integer(ty, nanoseconds * scale),
                (Some(scale), _) => Value::integer(ty, nanoseconds.checked_div(scale).unwrap_or(0)),
                (None, scale) => {
                    let scale = scale?;
                    let nanoseconds = nanoseconds as f64;
                    let scaled = if function == F::MultiplyTime { nanoseconds * scale } else { nanoseconds / scale };
                    scaled.is_finite().then(|| saturated(ty, scaled.round_ties_even()))
                }
            }
        }
        // The others are operators of one or two operands, and were folded as such.
        _ => None,
    }
}

fn chain(op: BinaryOperator, arguments: &[Value]) -> Option<Value> {
    let (first, rest) = arguments.split_first()?;
    rest.iter().try_fold(*first, |so_far, next| match constant::binary(op, so_far, *next) {
        Folded::Value(value) => Some(value),
        _ => None,
    })
}

fn holds(op: BinaryOperator, a: Value, b: Value) -> bool {
    matches!(constant::binary(op, a, b), Folded::Bool(true))
}

fn sequence(op: BinaryOperator, arguments: &[Value]) -> Value {
    Value::bool(arguments.windows(2).all(|pair| holds(op, pair[0], pair[1])))
}

fn furthest(op: BinaryOperator, first: Value, rest: &[Value]) -> Value {
    rest.iter().fold(first, |so_far, next| if holds(op, *next, so_far) { *next } else { so_far })
}

/// A value as another type.
fn convert(to: Elementary, value: Value) -> Option<Value> {
    let from = value.ty();
    Some(match (value.as_integer(), value.as_real()) {
        _ if from == to => value,
        _ if to == Elementary::Bool => Value::bool(!constant::is_zero(value)),
        (Some(integer), _) if to == Elementary::Time => wrapped(to, integer * SECOND),
        (Some(integer), _) if from == Elementary::Time && to.is_real() => {
            Value::real(to, integer as f64 / REAL_SECOND)?
        }
        (Some(integer), _) if from == Elementary::Time => wrapped(to, integer / SECOND),
        (Some(integer), _) if to == Elementary::Real => Value::real(to, f64::from(integer as f32))?,
        (Some(integer), _) if to == Elementary::Lreal => Value::real(to, integer as f64)?,
        (Some(integer), _) => wrapped(to, integer),
        (None, Some(real)) if to == Elementary::Time => saturated(to, (real * REAL_SECOND).round_ties_even()),
        (None, Some(real)) if to.is_real() => Value::real(to, real)?,
        (None, Some(real)) => saturated(to, real.round_ties_even()),
        (None, None) => return None,
    })
}

/// The low bits of a number.
fn wrapped(ty: Elementary, number: i128) -> Value {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "wrapping around is the meaning")]
    Value::from_bits(ty, number as u64)
}

/// A whole number, held at the ends of a type's range.
fn saturated(ty: Elementary, whole: f64) -> Value {
    let (least, greatest) = ty.range().unwrap_or((0, 0));
    #[expect(clippy::cast_possible_truncation, reason = "saturation is wanted")]
    let number = (whole as i128).clamp(least, greatest);
    wrapped(ty, number)
}
