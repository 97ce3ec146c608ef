//! Functions, written from what the standard says that each computes, on numbers without a width; but for logarithms, powers
//! and angles, which the tested functions compute here, too.

use rung::elementary::{Elementary, Value};
use rung::ladder::functions::{Function, StandardFunction};
use rung::ladder::{BinaryOperator, UnaryOperator};
use rung::mathematics::{self, Native};

use super::expression::{binary, double, number, single, unary, wrapped};

const NANOSECONDS: i128 = 1_000_000_000;

/// A call with a result of type `ty`.
pub(super) fn call(function: Function, ty: Elementary, arguments: &[Value]) -> Value {
    match function {
        Function::Standard(function) => standard(function, ty, arguments),
        Function::Convert { .. } => convert(arguments[0], ty),
        Function::Truncate { .. } => nearest_in_range(ty, real(arguments[0]).trunc()),
    }
}

fn standard(function: StandardFunction, ty: Elementary, arguments: &[Value]) -> Value {
    use StandardFunction as F;
    let first = arguments[0];
    match function {
        // IEEE 754, 5.5.1: the magnitude is without its sign bit, of a NaN too.
        F::Absolute if ty.is_real() => Value::from_bits(ty, first.bits() & !(1 << (ty.bits() - 1))),
        F::Absolute => wrapped(ty, number(first).abs()),
        F::SquareRoot => rounded(ty, real(first).sqrt()),
        // Computed by the tested functions: the same bits are asked for, which nothing else gives. So only the choice of
        // them is tested; `tests/mathematics.rs` compares them with another library's.
        F::Ln => rounded(ty, mathematics::ln(Native, real(first))),
        F::Log => rounded(ty, mathematics::log10(Native, real(first))),
        F::Exp => rounded(ty, mathematics::exp(Native, real(first))),
        F::Sin => rounded(ty, mathematics::sin(Native, real(first))),
        F::Cos => rounded(ty, mathematics::cos(Native, real(first))),
        F::Tan => rounded(ty, mathematics::tan(Native, real(first))),
        F::Asin => rounded(ty, mathematics::asin(Native, real(first))),
        F::Acos => rounded(ty, mathematics::acos(Native, real(first))),
        F::Atan => rounded(ty, mathematics::atan(Native, real(first))),
        F::Power => rounded(ty, mathematics::pow(Native, real(first), real(arguments[1]))),
        // Rounded to the type after every step, as infix operators are.
        F::Add if ty.is_real() => reduce(arguments, |a, b| sum(ty, a, b)),
        F::Add => wrapped(ty, arguments.iter().map(|value| number(*value)).sum()),
        F::Multiply if ty.is_real() => reduce(arguments, |a, b| product(ty, a, b)),
        F::Multiply => reduce(arguments, |a, b| wrapped(ty, number(a).wrapping_mul(number(b)))),
        F::And => reduce(arguments, |a, b| Value::from_bits(ty, a.bits() & b.bits())),
        F::Or => reduce(arguments, |a, b| Value::from_bits(ty, a.bits() | b.bits())),
        F::Xor => reduce(arguments, |a, b| Value::from_bits(ty, a.bits() ^ b.bits())),
        // By less than nothing is by too much.
        F::ShiftLeft | F::ShiftRight if number(arguments[1]) < 0 => Value::default_of(ty),
        F::ShiftLeft => by_places(first, |place| place.checked_sub(number(arguments[1]))),
        F::ShiftRight => by_places(first, |place| place.checked_add(number(arguments[1]))),
        F::RotateLeft => by_places(first, |place| Some((place - number(arguments[1])).rem_euclid(ty.bits().into()))),
        F::RotateRight => by_places(first, |place| Some((place + number(arguments[1])).rem_euclid(ty.bits().into()))),
        F::Select => arguments[if first == Value::bool(true) { 2 } else { 1 }],
        F::Multiplex => {
            let inputs = i128::try_from(arguments.len() - 1).expect("a program of the tests is small");
            match number(first) {
                chosen if (0..inputs).contains(&chosen) => arguments[1 + usize::try_from(chosen).expect("in range")],
                _ => Value::default_of(ty),
            }
        }
        F::Maximum => reduce(arguments, greater),
        F::Minimum => reduce(arguments, lesser),
        F::Limit => lesser(greater(arguments[1], arguments[0]), arguments[2]),
        F::Greater => falls(arguments, |a, b| is_less(b, a)),
        F::GreaterOrEqual => falls(arguments, |a, b| is_less(b, a) || is_equal(a, b)),
        F::Equal => falls(arguments, is_equal),
        F::LessOrEqual => falls(arguments, |a, b| is_less(a, b) || is_equal(a, b)),
        F::Less => falls(arguments, is_less),
        F::MultiplyTime if arguments[1].ty() == Elementary::Lint => wrapped(ty, number(first) * number(arguments[1])),
        F::MultiplyTime => nearest_in_range(ty, (real(first) * real(arguments[1])).round_ties_even()),
        F::DivideTime if arguments[1].ty() == Elementary::Lint => match number(arguments[1]) {
            0 => Value::time(0),
            divisor => wrapped(ty, number(first) / divisor),
        },
        F::DivideTime => nearest_in_range(ty, (real(first) / real(arguments[1])).round_ties_even()),
        // In an expression checking turns these into operators, which they are; in a box they stay what they are.
        F::Subtract | F::SubtractTime => binary(BinaryOperator::Subtract, first, arguments[1]),
        F::AddTime => binary(BinaryOperator::Add, first, arguments[1]),
        F::Divide => binary(BinaryOperator::Divide, first, arguments[1]),
        F::Modulo => binary(BinaryOperator::Modulo, first, arguments[1]),
        F::NotEqual => binary(BinaryOperator::NotEqual, first, arguments[1]),
        F::Not => unary(UnaryOperator::Not, first),
        F::Move => first,
    }
}

fn reduce(values: &[Value], two: impl Fn(Value, Value) -> Value) -> Value {
    values.iter().copied().reduce(two).expect("a function has arguments")
}

fn falls(values: &[Value], holds: impl Fn(Value, Value) -> bool) -> Value {
    Value::bool(values.windows(2).all(|pair| holds(pair[0], pair[1])))
}

fn is_less(a: Value, b: Value) -> bool {
    if a.ty().is_real() { real(a) < real(b) } else { number(a) < number(b) }
}

fn is_equal(a: Value, b: Value) -> bool {
    if a.ty().is_real() { real(a) == real(b) } else { number(a) == number(b) }
}

/// The second only where it is greater than the first: of equal ones, and beside a NaN, the first.
fn greater(a: Value, b: Value) -> Value {
    if is_less(a, b) { b } else { a }
}

fn lesser(a: Value, b: Value) -> Value {
    if is_less(b, a) { b } else { a }
}

/// A bit string of which each bit comes from another place; zeros come from outside.
fn by_places(value: Value, from: impl Fn(i128) -> Option<i128>) -> Value {
    let bits = i128::from(value.ty().bits());
    let bit =
        |place: &i128| from(*place).is_some_and(|from| (0..bits).contains(&from) && value.bits() >> from & 1 == 1);
    let set = (0..bits).filter(bit).fold(0, |set, place| set | 1 << place);
    Value::from_bits(value.ty(), set)
}

/// Of two REALs it is rounded twice, which is the same as once.
fn sum(ty: Elementary, a: Value, b: Value) -> Value {
    rounded(ty, real(a) + real(b))
}

fn product(ty: Elementary, a: Value, b: Value) -> Value {
    rounded(ty, real(a) * real(b))
}

/// The number as an LREAL, of any type.
fn real(value: Value) -> f64 {
    #[expect(clippy::cast_precision_loss, reason = "rounding to nearest is the meaning")]
    value.as_real().unwrap_or_else(|| number(value) as f64)
}

#[expect(clippy::cast_possible_truncation, reason = "rounding to REAL is the meaning")]
fn rounded(ty: Elementary, value: f64) -> Value {
    if ty == Elementary::Real { single(value as f32) } else { double(value) }
}

/// A whole number, or the end of the range that it lies beyond; 0 for NaN.
fn nearest_in_range(ty: Elementary, whole: f64) -> Value {
    let (least, greatest) = ty.range().expect("an integer type");
    if whole.is_nan() {
        return Value::default_of(ty);
    }
    // Of what lies beyond 2^100 only the side matters.
    #[expect(clippy::cast_possible_truncation, reason = "it is within 2^100")]
    let number = whole.clamp(-1e30, 1e30) as i128;
    Value::integer(ty, number.max(least).min(greatest)).expect("within the range")
}

/// By value; what does not fit an integer keeps its low bits, what does not fit from a real
/// number becomes the nearest that does. A duration counts its seconds.
fn convert(value: Value, to: Elementary) -> Value {
    let from = value.ty();
    let is_time = |ty| ty == Elementary::Time;
    if from == to {
        return value;
    }
    if to == Elementary::Bool {
        return Value::bool(if from.is_real() { real(value) != 0.0 } else { number(value) != 0 });
    }
    if from.is_real() {
        return match to {
            Elementary::Real | Elementary::Lreal => rounded(to, real(value)),
            Elementary::Time => nearest_in_range(to, (real(value) * 1e9).round_ties_even()),
            _ => nearest_in_range(to, real(value).round_ties_even()),
        };
    }
    #[expect(clippy::cast_precision_loss, reason = "rounding to nearest is the meaning")]
    match to {
        Elementary::Real | Elementary::Lreal if is_time(from) => rounded(to, real(value) / 1e9),
        Elementary::Real => single(number(value) as f32),
        Elementary::Lreal => double(number(value) as f64),
        _ if is_time(to) => wrapped(to, number(value) * NANOSECONDS),
        _ if is_time(from) => wrapped(to, number(value) / NANOSECONDS),
        _ => wrapped(to, number(value)),
    }
}
