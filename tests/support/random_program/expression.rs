//! Random expressions that have the type they should.

use rung::elementary::Elementary;
use rung::ladder::library::{Pin, StandardBlock, Takes};
use rung::ladder::{BinaryOperator, Expression, ExpressionKind, Literal, Reference, Step, UnaryOperator};

use super::{Generator, Kind, Purpose};
use crate::support::drawing::{self, NOWHERE};

const MILLISECOND: i64 = 1_000_000;

impl Generator {
    /// A value of a type; at most `depth` operators deep.
    pub(super) fn expression(&mut self, ty: Elementary, depth: usize) -> Expression {
        // Checking refuses constants that overflow, so that arithmetic needs a variable.
        if depth == 0 || self.dice.percent(25) || self.place(ty, Purpose::ReadVariable).is_none() {
            return self.operand(ty);
        }
        self.operation(ty, depth)
    }

    /// An operator of a type of which there is a variable, which is somewhere in it.
    fn operation(&mut self, ty: Elementary, depth: usize) -> Expression {
        if ty == Elementary::Bool && self.dice.percent(55) {
            return self.comparison(depth);
        }
        if self.dice.percent(25) {
            return self.function(ty, depth);
        }
        let operators: &[BinaryOperator] = if ty.is_bit_string() {
            &[BinaryOperator::And, BinaryOperator::Or, BinaryOperator::Xor]
        } else if ty.is_integer() {
            &[
                BinaryOperator::Add,
                BinaryOperator::Subtract,
                BinaryOperator::Multiply,
                BinaryOperator::Divide,
                BinaryOperator::Modulo,
            ]
        } else if ty.is_real() {
            &[BinaryOperator::Add, BinaryOperator::Subtract, BinaryOperator::Multiply, BinaryOperator::Divide]
        } else {
            &[BinaryOperator::Add, BinaryOperator::Subtract]
        };
        let unary = match ty {
            _ if ty.is_bit_string() => Some(UnaryOperator::Not),
            Elementary::Time => None,
            _ => (ty.is_real() || ty.is_signed()).then_some(UnaryOperator::Negate),
        };
        match unary {
            Some(operator) if self.dice.percent(20) => {
                let operand = self.anchored(ty, depth - 1);
                drawing::expression(ExpressionKind::Unary(operator, Box::new(operand)))
            }
            _ => {
                let operator = *self.dice.pick(operators);
                self.binary(operator, ty, depth)
            }
        }
    }

    fn comparison(&mut self, depth: usize) -> Expression {
        use BinaryOperator as B;
        let ty = self.some_type();
        let operators = [B::Equal, B::NotEqual, B::Less, B::LessOrEqual, B::Greater, B::GreaterOrEqual];
        // BOOLs have no order that a ladder needs.
        let operator = *self.dice.pick(if ty == Elementary::Bool { &operators[..2] } else { &operators });
        self.binary(operator, ty, depth)
    }

    /// A type of which there is something to read.
    pub(super) fn some_type(&mut self) -> Elementary {
        let types: Vec<Elementary> = self.scope.iter().map(|entry| entry.ty).collect();
        *self.dice.pick(&types)
    }

    fn binary(&mut self, operator: BinaryOperator, ty: Elementary, depth: usize) -> Expression {
        let left = self.anchored(ty, depth - 1);
        let right = if self.dice.percent(40) { self.literal(ty, false) } else { self.anchored(ty, depth - 1) };
        drawing::expression(ExpressionKind::Binary(operator, Box::new(left), Box::new(right)))
    }

    /// An expression whose type shows without what stands around it, and which is not constant where that can be.
    pub(super) fn anchored(&mut self, ty: Elementary, depth: usize) -> Expression {
        if depth > 0 && self.dice.percent(50) && self.place(ty, Purpose::ReadVariable).is_some() {
            return self.operation(ty, depth);
        }
        match self.readable(ty, Purpose::ReadVariable) {
            Some(reference) => drawing::expression(ExpressionKind::Read(reference)),
            None => self.literal(ty, true),
        }
    }

    fn operand(&mut self, ty: Elementary) -> Expression {
        if self.dice.percent(12)
            && let Some(narrow) = self.narrower(ty)
            && let Some(reference) = self.place(narrow, Purpose::Read)
        {
            return drawing::expression(ExpressionKind::Read(reference));
        }
        match self.readable(ty, Purpose::Read) {
            Some(reference) if !self.dice.percent(15) => drawing::expression(ExpressionKind::Read(reference)),
            _ if ty == Elementary::Int && self.has_colours() && self.dice.percent(50) => self.colour(),
            _ => self.literal(ty, false),
        }
    }

    /// A type that widens to this one without loss.
    fn narrower(&mut self, ty: Elementary) -> Option<Elementary> {
        use Elementary::{Dint, Int, Lint, Lreal, Real, Sint, Udint, Uint, Ulint, Usint};
        let narrower: &[Elementary] = match ty {
            Int => &[Sint],
            Dint => &[Sint, Int],
            Lint => &[Sint, Int, Dint],
            Uint => &[Usint],
            Udint => &[Usint, Uint],
            Ulint => &[Usint, Uint, Udint],
            Real => &[Int],
            Lreal => &[Dint, Real],
            _ => return None,
        };
        Some(*self.dice.pick(narrower))
    }

    /// Something of a type to read: a variable, a member, a bit.
    pub(super) fn readable(&mut self, ty: Elementary, purpose: Purpose) -> Option<Reference> {
        if ty == Elementary::Bool && self.dice.percent(10) {
            return self.bit(purpose).or_else(|| self.place(ty, purpose));
        }
        if self.dice.percent(25)
            && let Some(member) = self.member(ty)
        {
            return Some(member);
        }
        self.place(ty, purpose)
    }

    /// An output of a standard block, seldom an input.
    fn member(&mut self, ty: Elementary) -> Option<Reference> {
        let (instance, block) = self.standard_instance()?;
        let pins = if self.dice.percent(10) { block.inputs() } else { block.outputs() };
        self.pin_of(instance, pins, ty)
    }

    /// An input of an instance of a standard block, which may be written like a variable.
    pub(super) fn pin(&mut self, ty: Elementary) -> Option<Reference> {
        let (instance, block) = self.standard_instance()?;
        self.pin_of(instance, block.inputs(), ty)
    }

    fn standard_instance(&mut self) -> Option<(Reference, StandardBlock)> {
        if self.instances.is_empty() {
            return None;
        }
        let instance = self.dice.pick(&self.instances).clone();
        match instance.kind {
            Kind::Standard(block) => Some((instance.reference, block)),
            Kind::Own(_) => None,
        }
    }

    fn pin_of(&mut self, mut instance: Reference, pins: &[Pin], ty: Elementary) -> Option<Reference> {
        let fits = |pin: &&Pin| pin.ty == ty && pin.takes == Takes::Value;
        let fitting: Vec<&str> = pins.iter().filter(fits).map(|pin| pin.name).collect();
        let pin = *fitting.get(self.dice.below(fitting.len()))?;
        instance.steps.push(Step::Member(drawing::name(pin)));
        Some(instance)
    }

    /// A bit of a bit string.
    pub(super) fn bit(&mut self, purpose: Purpose) -> Option<Reference> {
        let ty = *self.dice.pick(&[Elementary::Byte, Elementary::Word, Elementary::Dword, Elementary::Lword]);
        let mut reference = self.place(ty, purpose)?;
        let last = ty.bits() as usize - 1;
        let bit = if self.dice.percent(30) { last } else { self.dice.below(last.min(4)) };
        reference.steps.push(Step::Bit(u8::try_from(bit).expect("types have at most 64 bits"), NOWHERE));
        Some(reference)
    }

    /// What a variable of a type starts with: also the ends of its range.
    pub(super) fn initial_value(&mut self, ty: Elementary) -> Expression {
        match ty.range() {
            Some((least, _)) if least < 0 && ty != Elementary::Time && self.dice.percent(10) => drawing::expression(
                ExpressionKind::Unary(UnaryOperator::Negate, Box::new(integer(least.unsigned_abs(), 10, None))),
            ),
            _ => self.literal(ty, false),
        }
    }

    /// A literal, with its type where asked for or where its number does not fit every type that could be meant.
    fn literal(&mut self, ty: Elementary, typed: bool) -> Expression {
        let typed = typed || self.dice.percent(30);
        match ty {
            Elementary::Bool => boolean(self.dice.percent(50)),
            Elementary::Time => time(self.duration()),
            Elementary::Real | Elementary::Lreal => {
                let value = *self.dice.pick(&[0.0, 0.1, 0.5, 1.0, 1.5, 3.0, 100.25, 1e30]);
                // Where an INT stands beside it only its type makes it a REAL.
                let literal = ExpressionKind::Literal(Literal::Real { value, ty: Some(ty) });
                self.signed(drawing::expression(literal))
            }
            _ => {
                let (_, most) = ty.range().expect("the other types have a range");
                let most = most.unsigned_abs();
                let value = *self.dice.pick(&[0, 1, 1, 2, 3, 5, 7, 10, 100, most, most - 1, most / 3]);
                let base = *self.dice.pick(&[10, 10, 10, 16, 2, 8]);
                let literal = integer(value, base, (typed || value > 100).then_some(ty));
                if ty.is_signed() { self.signed(literal) } else { literal }
            }
        }
    }

    fn signed(&mut self, literal: Expression) -> Expression {
        if self.dice.percent(25) {
            drawing::expression(ExpressionKind::Unary(UnaryOperator::Negate, Box::new(literal)))
        } else {
            literal
        }
    }

    /// A short time, in nanoseconds; now and then an absurd one.
    fn duration(&mut self) -> i64 {
        let milliseconds = [0, 1, 2, 5, 10, 20, 50, 100, 250];
        match self.dice.below(40) {
            0 => -5 * MILLISECOND,
            1 => i64::MAX,
            2 => 1,
            3 => MILLISECOND + 500_000,
            _ => self.dice.pick(&milliseconds) * MILLISECOND,
        }
    }

    /// What a pin other than a BOOL gets: small, so that it is reached.
    pub(super) fn preset(&mut self, ty: Elementary) -> Expression {
        if self.dice.percent(30) {
            return self.expression(ty, 1);
        }
        match ty {
            Elementary::Time => time(self.duration()),
            _ => integer(self.dice.below(5) as u128, 10, None),
        }
    }
}

/// TRUE or FALSE.
pub(super) fn boolean(value: bool) -> Expression {
    drawing::expression(ExpressionKind::Literal(Literal::Bool(value)))
}

pub(super) fn time(nanoseconds: i64) -> Expression {
    drawing::expression(ExpressionKind::Literal(Literal::Time(nanoseconds)))
}

fn integer(value: u128, base: u8, ty: Option<Elementary>) -> Expression {
    drawing::expression(ExpressionKind::Literal(Literal::Integer { value: value.into(), base, ty }))
}
