//! Random calls of functions with a result of the type that they should have.

use rung::elementary::Elementary;
use rung::ladder::functions::StandardFunction;
use rung::ladder::{Expression, ExpressionKind, FunctionArgument};

use super::{Generator, Purpose};
use crate::support::drawing;

impl Generator {
    /// A function with a result of type `ty`, and operands at most `depth` - 1 operators deep.
    pub(super) fn function(&mut self, ty: Elementary, depth: usize) -> Expression {
        if self.dice.percent(25)
            && let Some((own, arguments)) = self.own_function(ty, depth)
        {
            let named = self.dice.percent(40);
            let names = own.inputs.iter().map(|(name, _)| name).chain(own.references.iter().map(|(name, _)| name));
            let arguments = names.zip(arguments).map(|(name, value)| FunctionArgument {
                parameter: named.then(|| drawing::name(name)),
                value: drawing::expression(value),
            });
            return call(&own.name, arguments.collect());
        }
        let (name, operands) = self.called(ty, depth);
        let is_conversion = name.contains("TO_") || name.starts_with("TRUNC");
        let named = !is_conversion && self.dice.percent(20);
        let arguments = operands.into_iter();
        let mut arguments: Vec<FunctionArgument> = arguments
            .map(|(pin, value)| FunctionArgument { parameter: named.then(|| drawing::name(&pin)), value })
            .collect();
        if named {
            // In any order.
            let turn = self.dice.below(arguments.len());
            arguments.rotate_left(turn);
        }
        call(&name, arguments)
    }

    /// A standard function with a result of type `ty`, and its operands, each with its parameter.
    pub(super) fn called(&mut self, ty: Elementary, depth: usize) -> (String, Vec<(String, Expression)>) {
        use StandardFunction as F;
        let mut choices = vec![F::Move, F::Select, F::Multiplex, F::Limit, F::Maximum, F::Minimum];
        if ty.is_integer() || ty.is_real() {
            choices.extend([F::Absolute, F::Add, F::Multiply, F::Subtract, F::Divide]);
        }
        if ty.is_integer() {
            choices.push(F::Modulo);
        }
        if ty.is_real() {
            choices.extend([F::SquareRoot, F::Power, F::Ln, F::Log, F::Exp, F::Sin, F::Cos, F::Tan]);
            choices.extend([F::Asin, F::Acos, F::Atan]);
        }
        if ty.is_bit_string() {
            choices.extend([F::And, F::Or, F::Xor, F::Not]);
        }
        match ty {
            Elementary::Bool => {
                choices.extend([F::Greater, F::GreaterOrEqual, F::Equal, F::LessOrEqual, F::Less, F::NotEqual]);
            }
            Elementary::Time => choices.extend([F::AddTime, F::SubtractTime, F::MultiplyTime, F::DivideTime]),
            _ if ty.is_bit_string() => {
                choices.extend([F::ShiftLeft, F::ShiftRight, F::RotateLeft, F::RotateRight]);
            }
            _ => {}
        }
        if self.dice.percent(30) {
            return self.conversion(ty, depth);
        }
        let function = *self.dice.pick(&choices);
        let operands = self.operands(function, ty, depth);
        let pins = (0..operands.len()).map(|place| parameter(function, place));
        (function.name().to_owned(), pins.zip(operands).collect())
    }

    fn operands(&mut self, function: StandardFunction, ty: Elementary, depth: usize) -> Vec<Expression> {
        use StandardFunction as F;
        let depth = depth - 1;
        let more = if function.is_extensible() { self.dice.below(3) } else { 0 };
        let count = function.parameters().len() + more;
        match function {
            F::Select => {
                vec![self.anchored(Elementary::Bool, depth), self.anchored(ty, depth), self.anchored(ty, depth)]
            }
            F::Multiplex => {
                let selector = self.integer_type();
                let mut operands = vec![self.anchored(selector, depth)];
                operands.extend((1..count).map(|_| self.anchored(ty, depth)));
                operands
            }
            F::ShiftLeft | F::ShiftRight | F::RotateLeft | F::RotateRight => {
                let amount = self.integer_type();
                vec![self.anchored(ty, depth), self.anchored(amount, depth)]
            }
            F::Power | F::MultiplyTime | F::DivideTime => {
                use Elementary::{Int, Lint, Lreal, Real, Udint};
                let scale = *self.dice.pick(&[Int, Lint, Udint, Real, Lreal]);
                vec![self.anchored(ty, depth), self.anchored(scale, depth)]
            }
            F::Greater | F::GreaterOrEqual | F::Equal | F::LessOrEqual | F::Less | F::NotEqual => {
                let compared = self.some_type();
                (0..count).map(|_| self.anchored(compared, depth)).collect()
            }
            _ => (0..count).map(|_| self.anchored(ty, depth)).collect(),
        }
    }

    fn integer_type(&mut self) -> Elementary {
        let integers: Vec<Elementary> = Elementary::ALL.into_iter().filter(|ty| ty.is_integer()).collect();
        *self.dice.pick(&integers)
    }

    fn conversion(&mut self, to: Elementary, depth: usize) -> (String, Vec<(String, Expression)>) {
        let from = if to.is_integer() && self.dice.percent(20) { Elementary::Real } else { self.some_type() };
        // What is converted from a constant is one, and may then overflow.
        let from = if self.place(from, Purpose::ReadVariable).is_some() { from } else { Elementary::Bool };
        let operand = self.anchored(from, depth - 1);
        let name = match self.dice.below(3) {
            0 => format!("TO_{to}"),
            1 if to.is_integer() && from.is_real() => format!("TRUNC_{to}"),
            _ => format!("{from}_TO_{to}"),
        };
        (name, vec![("IN".to_owned(), operand)])
    }
}

fn call(name: &str, arguments: Vec<FunctionArgument>) -> Expression {
    drawing::expression(ExpressionKind::Call { function: drawing::name(name), arguments: arguments.into() })
}

fn parameter(function: StandardFunction, place: usize) -> String {
    let listed = function.parameters().get(place).map(|parameter| parameter.name.to_owned());
    // The inputs of MUX are numbered from 0, behind its selector.
    let first = if function == StandardFunction::Multiplex { 0 } else { 2 };
    listed.unwrap_or_else(|| format!("IN{}", place - 1 + first))
}
