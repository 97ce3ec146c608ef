//! Expressions and places to primitives.

use super::Lowering;
use crate::check::{Expression, ExpressionKind, Place};
use crate::elementary::Value;
use crate::ladder::{BinaryOperator, UnaryOperator};
use crate::logic::{Binary, Compare, Unary, ValueId};

impl Lowering<'_> {
    /// The value of an expression.
    pub(super) fn expression(&mut self, expression: &Expression) -> ValueId {
        match &expression.kind {
            ExpressionKind::Constant(value) => self.logic.constant(*value),
            ExpressionKind::Read(place) => self.read(place),
            ExpressionKind::UserCall { .. } => self.logic.constant(Value::default_of(expression.ty)),
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
            ExpressionKind::Call { function, arguments } => self.function(*function, expression.ty, arguments),
        }
    }

    /// What a place holds.
    pub(super) fn read(&mut self, place: &Place) -> ValueId {
        let whole = self.logic.load(self.slots.of(place));
        match place.bit {
            None => whole,
            Some(bit) => {
                let mask = self.mask(whole, bit);
                let masked = self.logic.and(whole, mask);
                let zero = self.logic.constant(Value::default_of(self.logic.ty(whole)));
                self.logic.compare(Compare::NotEqual, masked, zero)
            }
        }
    }

    /// Sets a place.
    pub(super) fn write(&mut self, place: &Place, value: ValueId) {
        let slot = self.slots.of(place);
        let value = match place.bit {
            None => value,
            Some(bit) => {
                let whole = self.logic.load(slot);
                let mask = self.mask(whole, bit);
                let with = self.logic.or(whole, mask);
                let other_bits = self.logic.not(mask);
                let without = self.logic.and(whole, other_bits);
                self.logic.select(value, with, without)
            }
        };
        self.store(slot, value);
    }

    /// Sets a place while a condition holds.
    pub(super) fn write_if(&mut self, condition: ValueId, place: &Place, value: ValueId) {
        let old = self.read(place);
        let value = self.logic.select(condition, value, old);
        self.write(place, value);
    }

    /// One bit, in the type of a bit string.
    fn mask(&mut self, whole: ValueId, bit: u8) -> ValueId {
        let ty = self.logic.ty(whole);
        self.logic.constant(Value::from_bits(ty, 1 << bit))
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
