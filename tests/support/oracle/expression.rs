//! Expressions: every operand is computed, from left to right; integers wrap around, what is divided by zero is 0, REAL and LREAL follow IEEE 754 with one NaN.

use std::cmp::Ordering;

use rung::check::{Expression, ExpressionKind};
use rung::elementary::{Elementary, Value};
use rung::ladder::{BinaryOperator, UnaryOperator};

use super::place::Attempt;
use super::storage::Frame;
use super::{Oracle, function};

impl Oracle<'_> {
    /// The value of an expression now. What is not executed changes nothing.
    pub(super) fn value(&mut self, frame: &Frame, expression: &Expression, attempt: &mut Attempt) -> Value {
        let value = match &expression.kind {
            ExpressionKind::Constant(value) => *value,
            ExpressionKind::Read(place) => self.read(frame, place, attempt),
            ExpressionKind::Unary(operator, operand) => unary(*operator, self.value(frame, operand, attempt)),
            ExpressionKind::Binary(operator, left, right) => {
                let left = self.value(frame, left, attempt);
                binary(*operator, left, self.value(frame, right, attempt))
            }
            ExpressionKind::Widen(operand) => widen(expression.ty, self.value(frame, operand, attempt)),
            ExpressionKind::Call { function, arguments } => {
                let arguments: Vec<Value> =
                    arguments.iter().map(|argument| self.value(frame, argument, attempt)).collect();
                function::call(*function, expression.ty, &arguments)
            }
            ExpressionKind::UserCall { unit, arguments, references } => {
                let value = |argument: &Option<Expression>| {
                    argument.as_ref().map(|argument| self.value(frame, argument, attempt))
                };
                let inputs: Vec<Option<Value>> = arguments.iter().map(value).collect();
                let references = references.iter().map(|place| self.locate(frame, place, attempt)).collect();
                let result = self.result(*unit, &inputs, references, attempt.executed);
                self.activities.saw(frame.id, expression, "own function f(a)", vec![result]);
                result
            }
        };
        assert_eq!(value.ty(), expression.ty, "checking gave {expression:?} a type that it does not have");
        value
    }
}

pub(super) fn unary(operator: UnaryOperator, operand: Value) -> Value {
    let ty = operand.ty();
    match (operator, ty) {
        (UnaryOperator::Not, _) => Value::from_bits(ty, !operand.bits()),
        // IEEE 754, 5.5.1: negation changes the sign bit and nothing else, of a NaN too.
        (UnaryOperator::Negate, Elementary::Real | Elementary::Lreal) => {
            Value::from_bits(ty, operand.bits() ^ 1 << (ty.bits() - 1))
        }
        (UnaryOperator::Negate, _) => wrapped(ty, -number(operand)),
    }
}

pub(super) fn binary(operator: BinaryOperator, left: Value, right: Value) -> Value {
    use BinaryOperator as B;
    assert_eq!(left.ty(), right.ty(), "checking gives both operands one type");
    let ty = left.ty();
    if operator.is_comparison() {
        // None where one is a NaN, which equals nothing and is neither less nor greater.
        let order = match (left.as_real(), right.as_real()) {
            (Some(left), Some(right)) => left.partial_cmp(&right),
            _ => Some(number(left).cmp(&number(right))),
        };
        return Value::bool(match operator {
            B::Equal => order == Some(Ordering::Equal),
            B::NotEqual => order != Some(Ordering::Equal),
            B::Less => order == Some(Ordering::Less),
            B::LessOrEqual => matches!(order, Some(Ordering::Less | Ordering::Equal)),
            B::Greater => order == Some(Ordering::Greater),
            _ => matches!(order, Some(Ordering::Greater | Ordering::Equal)),
        });
    }
    match operator {
        B::Or => return Value::from_bits(ty, left.bits() | right.bits()),
        B::Xor => return Value::from_bits(ty, left.bits() ^ right.bits()),
        B::And => return Value::from_bits(ty, left.bits() & right.bits()),
        _ => {}
    }
    match ty {
        Elementary::Real => {
            let of = |value: Value| f32::from_bits(u32::try_from(value.bits()).expect("a REAL has 32 bits"));
            single(real_arithmetic(operator, of(left), of(right)))
        }
        Elementary::Lreal => {
            double(real_arithmetic(operator, f64::from_bits(left.bits()), f64::from_bits(right.bits())))
        }
        _ => wrapped(ty, integer_arithmetic(operator, number(left), number(right))),
    }
}

fn integer_arithmetic(operator: BinaryOperator, left: i128, right: i128) -> i128 {
    match operator {
        BinaryOperator::Add => left + right,
        BinaryOperator::Subtract => left - right,
        BinaryOperator::Multiply => left.wrapping_mul(right),
        BinaryOperator::Divide | BinaryOperator::Modulo if right == 0 => 0,
        BinaryOperator::Divide => left / right,
        BinaryOperator::Modulo => left % right,
        _ => unreachable!("the other operators were told apart before"),
    }
}

fn real_arithmetic<T>(operator: BinaryOperator, left: T, right: T) -> T
where
    T: std::ops::Add<Output = T> + std::ops::Sub<Output = T> + std::ops::Mul<Output = T> + std::ops::Div<Output = T>,
{
    match operator {
        BinaryOperator::Add => left + right,
        BinaryOperator::Subtract => left - right,
        BinaryOperator::Multiply => left * right,
        BinaryOperator::Divide => left / right,
        _ => panic!("{} is not for REAL", operator.symbol()),
    }
}

fn widen(ty: Elementary, value: Value) -> Value {
    #[expect(clippy::cast_precision_loss, reason = "checking widens only what the wider type holds exactly")]
    match (ty, value.as_integer(), value.as_real()) {
        (Elementary::Real, Some(integer), _) => single(integer as f32),
        (Elementary::Lreal, Some(integer), _) => double(integer as f64),
        (Elementary::Lreal, None, Some(real)) => double(real),
        (_, Some(integer), _) => Value::integer(ty, integer).expect("widening is without loss"),
        _ => panic!("{} does not widen to {ty}", value.ty()),
    }
}

pub(super) fn number(value: Value) -> i128 {
    value.as_integer().expect("only REAL and LREAL are no integers")
}

/// The low bits of a number, as many as the type has.
pub(super) fn wrapped(ty: Elementary, number: i128) -> Value {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "wrapping around is the point")]
    Value::from_bits(ty, number as u64)
}

pub(super) fn single(value: f32) -> Value {
    Value::from_bits(Elementary::Real, u64::from(if value.is_nan() { 0x7FC0_0000 } else { value.to_bits() }))
}

pub(super) fn double(value: f64) -> Value {
    Value::from_bits(Elementary::Lreal, if value.is_nan() { 0x7FF8_0000_0000_0000 } else { value.to_bits() })
}
