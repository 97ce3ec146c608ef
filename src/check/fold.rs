//! Functions of constants. As with operators, arithmetic that does not fit its type is for the caller to report; but
//! conversions mean what they mean when the program runs, since what does not fit is often why they are written.

use super::constant::{self, Folded};
use crate::elementary::{Elementary, Value};
use crate::ladder::BinaryOperator;
use crate::ladder::functions::{Function, StandardFunction};

const SECOND: i128 = 1_000_000_000;
const REAL_SECOND: f64 = 1e9;

/// What became of a call.
pub(super) enum Call {
    /// A constant.
    Value(Value),
    /// More than the type holds.
    Overflow,
    /// Something that is computed when the program runs.
    Open,
}

/// A function of constants of the types that it takes, with a result of type `ty`.
pub(super) fn function(function: Function, ty: Elementary, arguments: &[Value]) -> Call {
    let value = match (function, arguments) {
        (Function::Standard(function), _) => match standard(function, ty, arguments) {
            Some(value) => value,
            None => return Call::Open,
        },
        (Function::Convert { .. }, [value]) => convert(ty, *value),
        (Function::Truncate { .. }, [value]) => value.as_real().map(|real| saturated(ty, real.trunc())),
        _ => return Call::Open,
    };
    match value.filter(|value| value.as_real().is_none_or(f64::is_finite)) {
        Some(value) => Call::Value(value),
        None => Call::Overflow,
    }
}

/// `None`: it is not for constants; `Some(None)`: it does not fit.
fn standard(function: StandardFunction, ty: Elementary, arguments: &[Value]) -> Option<Option<Value>> {
    use StandardFunction as F;
    Some(match (function, arguments) {
        (F::Absolute, [value]) => match (value.as_real(), value.as_integer()) {
            (Some(real), _) => Value::real(ty, real.abs()),
            (None, integer) => Value::integer(ty, integer?.abs()),
        },
        (F::SquareRoot, [value]) => Value::real(ty, value.as_real()?.sqrt()),
        (F::Add, _) => chain(BinaryOperator::Add, arguments),
        (F::Multiply, _) => chain(BinaryOperator::Multiply, arguments),
        (F::And, _) => chain(BinaryOperator::And, arguments),
        (F::Or, _) => chain(BinaryOperator::Or, arguments),
        (F::Xor, _) => chain(BinaryOperator::Xor, arguments),
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
        // Shifts, and durations by numbers.
        _ => return None,
    })
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
