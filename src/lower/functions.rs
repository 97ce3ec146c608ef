//! The standard functions, each by one rule in primitives. What each computes at its boundaries is said in
//! `docs/functions.md`.

use super::Lowering;
use crate::check::Expression;
use crate::elementary::{Elementary, Value};
use crate::ladder::functions::{Function, StandardFunction};
use crate::logic::{Binary, Compare, Helper, Unary, ValueId};

const SECOND: i64 = 1_000_000_000;
/// From here on every LREAL is whole.
const WHOLE: f64 = 4_503_599_627_370_496.0;

impl Lowering<'_> {
    /// The value of a function in an expression, with a result of type `ty`.
    pub(super) fn function(&mut self, function: Function, ty: Elementary, arguments: &[Expression]) -> ValueId {
        let values: Vec<ValueId> = arguments.iter().map(|argument| self.expression(argument)).collect();
        self.apply(function, ty, &values)
    }

    /// The same of values, each of which has the type of its parameter.
    pub(super) fn apply(&mut self, function: Function, ty: Elementary, values: &[ValueId]) -> ValueId {
        match (function, values) {
            (Function::Standard(function), values) => self.standard(function, ty, values),
            (Function::Convert { .. }, values) => self.conversion(values[0], ty),
            (Function::Truncate { .. }, values) => self.truncation(values[0], ty),
        }
    }

    fn standard(&mut self, function: StandardFunction, ty: Elementary, values: &[ValueId]) -> ValueId {
        use StandardFunction as F;
        match function {
            F::Absolute => self.logic.unary(Unary::Absolute, values[0]),
            F::SquareRoot => self.logic.unary(Unary::SquareRoot, values[0]),
            F::Ln => self.logic.call(Helper::Ln, values[0], None),
            F::Log => self.logic.call(Helper::Log10, values[0], None),
            F::Exp => self.logic.call(Helper::Exp, values[0], None),
            F::Sin => self.logic.call(Helper::Sin, values[0], None),
            F::Cos => self.logic.call(Helper::Cos, values[0], None),
            F::Tan => self.logic.call(Helper::Tan, values[0], None),
            F::Asin => self.logic.call(Helper::Asin, values[0], None),
            F::Acos => self.logic.call(Helper::Acos, values[0], None),
            F::Atan => self.logic.call(Helper::Atan, values[0], None),
            F::Power => {
                let (base, exponent) = (self.to(values[0], Elementary::Lreal), self.to(values[1], Elementary::Lreal));
                let power = self.logic.call(Helper::Power, base, Some(exponent));
                self.to(power, ty)
            }
            F::Add | F::AddTime => self.chain(Binary::Add, values),
            F::Multiply => self.chain(Binary::Multiply, values),
            F::Subtract | F::SubtractTime => self.chain(Binary::Subtract, values),
            F::Divide => self.chain(Binary::Divide, values),
            F::Modulo => self.chain(Binary::Remainder, values),
            F::And => self.chain(Binary::And, values),
            F::Or => self.chain(Binary::Or, values),
            F::Xor => self.chain(Binary::Xor, values),
            F::Move => values[0],
            F::Not => self.logic.not(values[0]),
            F::ShiftLeft => self.shift(Binary::ShiftLeft, values[0], values[1]),
            F::ShiftRight => self.shift(Binary::ShiftRight, values[0], values[1]),
            F::RotateLeft => self.rotation(Binary::RotateLeft, values[0], values[1]),
            F::RotateRight => self.rotation(Binary::RotateRight, values[0], values[1]),
            F::Select => self.logic.select(values[0], values[2], values[1]),
            F::Multiplex => self.multiplex(values[0], &values[1..], ty),
            F::Maximum => self.furthest(Compare::Greater, values[0], &values[1..]),
            F::Minimum => self.furthest(Compare::Less, values[0], &values[1..]),
            F::Limit => {
                let raised = self.furthest(Compare::Greater, values[1], &values[..1]);
                self.furthest(Compare::Less, raised, &values[2..])
            }
            F::Greater => self.sequence(Compare::Greater, values),
            F::GreaterOrEqual => self.sequence(Compare::GreaterOrEqual, values),
            F::Equal => self.sequence(Compare::Equal, values),
            F::LessOrEqual => self.sequence(Compare::LessOrEqual, values),
            F::Less => self.sequence(Compare::Less, values),
            F::NotEqual => self.sequence(Compare::NotEqual, values),
            F::MultiplyTime => self.scaled(Binary::Multiply, values[0], values[1]),
            F::DivideTime => self.scaled(Binary::Divide, values[0], values[1]),
        }
    }

    fn chain(&mut self, op: Binary, values: &[ValueId]) -> ValueId {
        values[1..].iter().fold(values[0], |so_far, next| self.logic.binary(op, so_far, *next))
    }

    /// Whether each value stands so to the next.
    fn sequence(&mut self, op: Compare, values: &[ValueId]) -> ValueId {
        let first = self.logic.compare(op, values[0], values[1]);
        values[1..].windows(2).fold(first, |so_far, pair| {
            let next = self.logic.compare(op, pair[0], pair[1]);
            self.logic.and(so_far, next)
        })
    }

    /// Of the values so far the one that each next must pass to take its place.
    fn furthest(&mut self, op: Compare, first: ValueId, rest: &[ValueId]) -> ValueId {
        let by_operation = match op {
            Compare::Greater => Binary::Maximum,
            _ => Binary::Minimum,
        };
        let integers = by_operation.domain().contains(self.logic.ty(first));
        rest.iter().fold(first, |so_far, next| {
            if integers {
                return self.logic.binary(by_operation, so_far, *next);
            }
            let passes = self.logic.compare(op, *next, so_far);
            self.logic.select(passes, *next, so_far)
        })
    }

    /// By the width or more, or by less than nothing, all bits leave.
    fn shift(&mut self, op: Binary, value: ValueId, amount: ValueId) -> ValueId {
        // A negative amount is a great one without its sign; cut to what an UDINT holds it must stay one.
        let amount = self.logic.convert(amount, Elementary::Ulint);
        let width = self.logic.constant(Value::from_bits(Elementary::Ulint, 64));
        let amount = self.logic.binary(Binary::Minimum, amount, width);
        let amount = self.logic.convert(amount, Elementary::Udint);
        self.logic.binary(op, value, amount)
    }

    /// Modulo the width, which divides 2^32: the low bits are all of the amount that matters, a negative one's too.
    fn rotation(&mut self, op: Binary, value: ValueId, amount: ValueId) -> ValueId {
        let amount = self.logic.convert(amount, Elementary::Udint);
        self.logic.binary(op, value, amount)
    }

    fn multiplex(&mut self, which: ValueId, inputs: &[ValueId], ty: Elementary) -> ValueId {
        let which_type = self.logic.ty(which);
        let none = self.logic.constant(Value::default_of(ty));
        (0..).zip(inputs).fold(none, |otherwise, (index, input)| {
            // What the selector's type cannot say selects nothing.
            let Some(index) = Value::integer(which_type, index) else { return otherwise };
            let index = self.logic.constant(index);
            let chosen = self.logic.compare(Compare::Equal, which, index);
            self.logic.select(chosen, *input, otherwise)
        })
    }

    /// A duration times or by a LINT or an LREAL.
    fn scaled(&mut self, op: Binary, duration: ValueId, scale: ValueId) -> ValueId {
        if self.logic.ty(scale).is_real() {
            let duration = self.logic.convert(duration, Elementary::Lreal);
            let result = self.logic.binary(op, duration, scale);
            self.logic.convert(result, Elementary::Time)
        } else {
            let scale = self.logic.convert(scale, Elementary::Time);
            self.logic.binary(op, duration, scale)
        }
    }

    /// A value as another type; the number of a TIME is its seconds.
    fn conversion(&mut self, value: ValueId, to: Elementary) -> ValueId {
        let from = self.logic.ty(value);
        if from == to {
            return value;
        }
        match (from, to) {
            (_, Elementary::Bool) => self.logic.convert(value, to),
            (Elementary::Real | Elementary::Lreal, Elementary::Time) => {
                let seconds = self.to(value, Elementary::Lreal);
                let nanoseconds = self.scaled_by_second(Binary::Multiply, seconds);
                self.logic.convert(nanoseconds, to)
            }
            (_, Elementary::Time) => {
                let seconds = self.logic.convert(value, to);
                self.scaled_by_second(Binary::Multiply, seconds)
            }
            (Elementary::Time, Elementary::Real | Elementary::Lreal) => {
                let nanoseconds = self.logic.convert(value, Elementary::Lreal);
                let seconds = self.scaled_by_second(Binary::Divide, nanoseconds);
                self.to(seconds, to)
            }
            (Elementary::Time, _) => {
                let seconds = self.scaled_by_second(Binary::Divide, value);
                self.logic.convert(seconds, to)
            }
            _ => self.logic.convert(value, to),
        }
    }

    /// A value as a type that it may have already.
    fn to(&mut self, value: ValueId, ty: Elementary) -> ValueId {
        if self.logic.ty(value) == ty { value } else { self.logic.convert(value, ty) }
    }

    fn scaled_by_second(&mut self, op: Binary, value: ValueId) -> ValueId {
        let second =
            if self.logic.ty(value).is_real() { self.lreal(1e9) } else { self.logic.constant(Value::time(SECOND)) };
        self.logic.binary(op, value, second)
    }

    /// A real number cut towards zero, as an integer.
    fn truncation(&mut self, value: ValueId, to: Elementary) -> ValueId {
        let value = self.to(value, Elementary::Lreal);
        // The nearest whole number, and one less if it is beyond; without the sign, so that there is one case only.
        let magnitude = self.logic.unary(Unary::Absolute, value);
        let nearest = self.logic.convert(magnitude, Elementary::Lint);
        let nearest = self.logic.convert(nearest, Elementary::Lreal);
        let beyond = self.logic.compare(Compare::Greater, nearest, magnitude);
        let one = self.lreal(1.0);
        let less = self.logic.binary(Binary::Subtract, nearest, one);
        let cut = self.logic.select(beyond, less, nearest);
        let opposite = self.logic.unary(Unary::Negate, cut);
        let zero = self.lreal(0.0);
        let negative = self.logic.compare(Compare::Less, value, zero);
        let cut = self.logic.select(negative, opposite, cut);
        let limit = self.lreal(WHOLE);
        let has_fraction = self.logic.compare(Compare::Less, magnitude, limit);
        let cut = self.logic.select(has_fraction, cut, value);
        self.logic.convert(cut, to)
    }

    fn lreal(&mut self, value: f64) -> ValueId {
        self.logic.constant(Value::from_bits(Elementary::Lreal, value.to_bits()))
    }
}
