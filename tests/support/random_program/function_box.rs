//! Random boxes of functions, standard or the program's own, which have EN and ENO.

use rung::elementary::Elementary;
use rung::ladder::{Argument, BlockCall, ExpressionKind, Reference, Wire};

use super::call::values;
use super::shape::Shape;
use super::{Generator, Purpose, Signature};
use crate::support::drawing;

impl Generator {
    /// A box in a circuit at a depth, or without one a statement.
    pub(super) fn function_box(&mut self, depth: Option<usize>) -> BlockCall {
        if !self.functions.is_empty() && self.dice.percent(35) {
            let own = self.dice.pick(&self.functions).clone();
            if self.affords(&own) {
                return self.own_box(&own, depth);
            }
        }
        if self.dice.percent(12)
            && let Some(copy) = self.copy_box(depth)
        {
            return copy;
        }
        let ty = if self.dice.percent(35) { Elementary::Bool } else { self.some_type() };
        let (name, operands) = self.called(ty, 2);
        let mut arguments = self.enable(depth);
        for (pin, value) in operands {
            // A wire may come from a circuit where the pin is a BOOL.
            arguments.push(drawing::argument(&pin, Wire::Value(value)));
        }
        if self.dice.percent(70)
            && let Some(target) = self.target(ty)
        {
            arguments.push(drawing::argument("OUT", Wire::Output(target)));
        }
        self.box_of(&name, arguments, &[("OUT".to_owned(), ty)], depth)
    }

    fn own_box(&mut self, own: &Signature, depth: Option<usize>) -> BlockCall {
        let mut arguments = self.enable(depth);
        for (name, ty) in &own.inputs {
            if !self.dice.percent(20) {
                let wire =
                    if *ty == Elementary::Bool { self.bool_wire(depth) } else { Wire::Value(self.expression(*ty, 1)) };
                arguments.push(drawing::argument(name, wire));
            }
        }
        for (name, shape) in &own.references {
            let reference = self.reference_to(shape);
            arguments.push(drawing::argument(name, Wire::Value(read(reference))));
        }
        let mut outputs = values(&own.outputs);
        outputs.extend(own.result.map(|ty| ("OUT".to_owned(), ty)));
        arguments.extend(self.wired_outputs(&outputs));
        self.box_of(&own.name, arguments, &outputs, depth)
    }

    /// MOVE of an array or structure.
    fn copy_box(&mut self, depth: Option<usize>) -> Option<BlockCall> {
        let (target, source) = self.copied()?;
        let mut arguments = Vec::new();
        if self.dice.percent(30) {
            let enable = self.expression(Elementary::Bool, 1);
            arguments.push(drawing::argument("EN", Wire::Value(enable)));
        }
        arguments.push(drawing::argument("IN", Wire::Value(read(source))));
        arguments.push(drawing::argument("OUT", Wire::Output(target)));
        Some(self.box_of("MOVE", arguments, &[], depth))
    }

    /// Two arrays or structures of one type, the first of which can be written.
    pub(super) fn copied(&mut self) -> Option<(Reference, Reference)> {
        let (target, shape) = self.whole(|whole| Purpose::Write.allows(whole.class))?;
        let (source, _) = self.whole(|whole| whole.shape == shape)?;
        Some((target, source))
    }

    fn box_of(
        &mut self,
        name: &str,
        mut arguments: Vec<Argument>,
        outputs: &[(String, Elementary)],
        depth: Option<usize>,
    ) -> BlockCall {
        if !arguments.iter().any(|argument| argument.pin.text == "ENO")
            && self.dice.percent(15)
            && let Some(target) = self.target(Elementary::Bool)
        {
            arguments.push(drawing::argument("ENO", Wire::Output(target)));
        }
        BlockCall {
            instance: Reference::of_name(drawing::name(name)),
            type_name: None,
            arguments,
            power_output: depth.and_then(|_| self.power_output(outputs)),
        }
    }

    /// A call of a function of the program's own with a result of a type, for an expression.
    pub(super) fn own_function(&mut self, ty: Elementary, depth: usize) -> Option<(Signature, Vec<ExpressionKind>)> {
        let fitting = self.functions.iter().filter(|own| own.result == Some(ty));
        let fitting: Vec<Signature> = fitting.cloned().collect();
        if fitting.is_empty() {
            return None;
        }
        let own = self.dice.pick(&fitting).clone();
        if !self.affords(&own) {
            return None;
        }
        let mut arguments: Vec<ExpressionKind> =
            own.inputs.iter().map(|(_, ty)| self.expression(*ty, depth - 1).kind).collect();
        for (_, shape) in &own.references {
            let reference = match shape {
                Shape::Value(ty) => self.place(*ty, Purpose::Write),
                _ => self
                    .whole(|whole| whole.shape == *shape && Purpose::Write.allows(whole.class))
                    .map(|(whole, _)| whole),
            };
            arguments.push(ExpressionKind::Read(reference?));
        }
        Some((own, arguments))
    }
}

fn read(reference: Reference) -> rung::ladder::Expression {
    drawing::expression(ExpressionKind::Read(reference))
}
