//! Expressions to primitives. Every operand is computed.

use super::Lowering;
use crate::check::{Expression, ExpressionKind};
use crate::elementary::Value;
use crate::ladder::{BinaryOperator, UnaryOperator};
use crate::logic::evaluate;
use crate::logic::{Binary, Compare, Unary, ValueId};

impl Lowering<'_> {
    /// The value of an expression.
    pub(super) fn expression(&mut self, expression: &Expression) -> ValueId {
        match &expression.kind {
            ExpressionKind::Constant(value) => self.logic.constant(*value),
            ExpressionKind::Read(place) => self.read(place),
            ExpressionKind::Unary(operator, operand) => {
                let operand = self.expression(operand);
                self.logic.unary(unary(*operator), operand)
            }
            ExpressionKind::Binary(operator, left, right) => {
                let (left, right) = (self.expression(left), self.expression(right));
                match operation(*operator) {
                    Operation::Binary(op) => self.logic.binary(op, left, right),
                    Operation::Compare(op) => self.logic.compare(op, left, right),
                }
            }
            ExpressionKind::Widen(operand) => {
                let operand = self.expression(operand);
                self.logic.convert(operand, expression.ty)
            }
            ExpressionKind::UserCall { unit, arguments, references } => self.operand(*unit, arguments, references),
            ExpressionKind::Call { function, arguments } => self.function(*function, expression.ty, arguments),
        }
    }

    /// The number of an integer expression that is known while lowering: made of constants and of the variables of loops that
    /// are being unrolled.
    pub(super) fn known(&self, expression: &Expression) -> Option<i128> {
        self.known_value(expression)?.as_integer()
    }

    fn known_value(&self, expression: &Expression) -> Option<Value> {
        let ty = expression.ty;
        let bits = match &expression.kind {
            ExpressionKind::Constant(value) => return Some(*value),
            ExpressionKind::Read(place) => return self.counter(place),
            ExpressionKind::Widen(operand) => {
                let operand = self.known_value(operand)?;
                evaluate::convert(operand.ty(), ty, operand.bits())
            }
            ExpressionKind::Unary(operator, operand) => {
                evaluate::unary(unary(*operator), ty, self.known_value(operand)?.bits())
            }
            ExpressionKind::Binary(operator, left, right) => {
                let (left, right) = (self.known_value(left)?, self.known_value(right)?);
                match operation(*operator) {
                    Operation::Binary(op) => evaluate::binary(op, ty, left.bits(), right.bits()),
                    Operation::Compare(op) => u64::from(evaluate::compare(op, left.ty(), left.bits(), right.bits())),
                }
            }
            ExpressionKind::UserCall { .. } | ExpressionKind::Call { .. } => return None,
        };
        Some(Value::from_bits(ty, bits))
    }
}

fn unary(operator: UnaryOperator) -> Unary {
    match operator {
        UnaryOperator::Not => Unary::Not,
        UnaryOperator::Negate => Unary::Negate,
    }
}

enum Operation {
    Binary(Binary),
    Compare(Compare),
}

fn operation(operator: BinaryOperator) -> Operation {
    use Operation::{Binary as Two, Compare as Test};
    match operator {
        BinaryOperator::Or => Two(Binary::Or),
        BinaryOperator::Xor => Two(Binary::Xor),
        BinaryOperator::And => Two(Binary::And),
        BinaryOperator::Equal => Test(Compare::Equal),
        BinaryOperator::NotEqual => Test(Compare::NotEqual),
        BinaryOperator::Less => Test(Compare::Less),
        BinaryOperator::LessOrEqual => Test(Compare::LessOrEqual),
        BinaryOperator::Greater => Test(Compare::Greater),
        BinaryOperator::GreaterOrEqual => Test(Compare::GreaterOrEqual),
        BinaryOperator::Add => Two(Binary::Add),
        BinaryOperator::Subtract => Two(Binary::Subtract),
        BinaryOperator::Multiply => Two(Binary::Multiply),
        BinaryOperator::Divide => Two(Binary::Divide),
        BinaryOperator::Modulo => Two(Binary::Remainder),
    }
}
