//! Random calls of instances, standard or the program's own, with all that can be wired to them.

use rung::elementary::Elementary;
use rung::ladder::library::{Pin, StandardBlock, Takes};
use rung::ladder::{
    Argument, BlockCall, Circuit, Element, ElementKind, Expression, ExpressionKind, Reference, Root, VariableClass,
    Wire,
};

use super::shape::{Bounds, Shape};
use super::{Generator, Instance, Kind, Purpose, Signature};
use crate::support::drawing::{self, NOWHERE};

impl Generator {
    /// A call of an instance that was not called yet or, seldom, of one that was; or a box of a function.
    pub(super) fn some_call(&mut self, depth: usize) -> Element {
        if self.pending.is_empty() || self.dice.percent(35) {
            if !self.instances.is_empty() && self.dice.percent(5) {
                let instance = self.dice.pick(&self.instances).clone();
                if let Kind::Own(own) = &instance.kind
                    && !self.affords(own)
                {
                    return self.contact();
                }
                return self.call(&Instance { declared: true, ..instance }, depth);
            }
            return drawing::element(ElementKind::Block(Box::new(self.function_box(Some(depth)))));
        }
        let next = self.dice.below(self.pending.len());
        let instance = self.pending.swap_remove(next);
        if let Kind::Own(own) = &instance.kind {
            self.weight += own.weight;
        }
        self.call(&instance, depth)
    }

    fn call(&mut self, instance: &Instance, depth: usize) -> Element {
        drawing::element(ElementKind::Block(Box::new(self.instance_call(instance, Some(depth)))))
    }

    /// A call in a statement, if there is anything to call.
    pub(super) fn call_statement(&mut self) -> Option<BlockCall> {
        let callable = !self.instances.is_empty() && self.dice.percent(60);
        if !callable {
            return Some(self.function_box(None)).filter(|_| self.dice.percent(80));
        }
        let instance = self.dice.pick(&self.instances).clone();
        if let Kind::Own(own) = &instance.kind
            && !self.affords(own)
        {
            return None;
        }
        Some(self.instance_call(&Instance { declared: true, ..instance }, None))
    }

    /// A call of an instance: in a circuit at a depth, or without one a statement.
    fn instance_call(&mut self, instance: &Instance, depth: Option<usize>) -> BlockCall {
        let mut arguments = match &instance.kind {
            Kind::Standard(block) => self.wired_inputs(*block, timer_kind(&instance.reference), depth),
            Kind::Own(own) => self.own_inputs(own, depth),
        };
        let outputs: Vec<(String, Elementary)> = match &instance.kind {
            Kind::Standard(block) => block.outputs().iter().map(|pin| (pin.name.to_owned(), pin.ty)).collect(),
            Kind::Own(own) => values(&own.outputs),
        };
        arguments.extend(self.wired_outputs(&outputs));
        if self.dice.percent(20) {
            arguments.reverse();
        }
        let type_name = match &instance.kind {
            Kind::Standard(block) => block.name(),
            Kind::Own(own) => &own.name,
        };
        let names_type = depth.is_some() && (!instance.declared || self.dice.percent(10));
        BlockCall {
            instance: instance.reference.clone(),
            type_name: (names_type && instance.reference.steps.is_empty()).then(|| drawing::name(type_name)),
            arguments,
            power_output: depth.and_then(|_| self.power_output(&outputs)),
        }
    }

    pub(super) fn wired_outputs(&mut self, outputs: &[(String, Elementary)]) -> Vec<Argument> {
        let mut arguments = Vec::new();
        for (name, ty) in outputs {
            if self.dice.percent(25)
                && let Some(target) = self.target(*ty)
            {
                arguments.push(drawing::argument(name, Wire::Output(target)));
            }
        }
        if self.dice.percent(10)
            && let Some(target) = self.target(Elementary::Bool)
        {
            arguments.push(drawing::argument("ENO", Wire::Output(target)));
        }
        arguments
    }

    pub(super) fn power_output(&mut self, outputs: &[(String, Elementary)]) -> Option<rung::ladder::Name> {
        let bools = outputs.iter().filter(|(_, ty)| *ty == Elementary::Bool).map(|(name, _)| name.as_str());
        let bools: Vec<&str> = bools.chain(["ENO"]).collect();
        let percent = if bools.len() > 2 { 60 } else { 15 };
        self.dice.percent(percent).then(|| drawing::name(self.dice.pick::<&str>(&bools)))
    }

    /// With the first BOOL input among them, or without one, the power on the left is EN.
    fn wired_inputs(&mut self, block: StandardBlock, kind: i128, depth: Option<usize>) -> Vec<Argument> {
        let enable = depth.is_none() || self.dice.percent(25);
        let mut arguments = self.enable(depth);
        let power = block.inputs().iter().position(|pin| pin.ty == Elementary::Bool);
        let registers = self.registers(block);
        for (index, pin) in block.inputs().iter().enumerate() {
            let wire = match (pin.takes, &registers) {
                (Takes::Reference, Some((register, _))) => {
                    Wire::Value(drawing::expression(ExpressionKind::Read(register.clone())))
                }
                (Takes::Constant, Some((_, length))) => {
                    Wire::Value(drawing::integer(self.dice.between(1, *length) as i128))
                }
                (Takes::Constant, None) => Wire::Value(drawing::integer(kind)),
                _ if Some(index) == power && !enable => continue,
                _ if Some(index) == power => self.bool_wire(depth),
                _ if pin.ty == Elementary::Bool && pin.initial != 0 && self.dice.percent(60) => continue,
                _ if pin.ty == Elementary::Bool && self.dice.percent(30) => continue,
                _ if pin.ty == Elementary::Bool => self.bool_wire(depth),
                // Of the many taps of a drum only some.
                _ if self.dice.percent(if pin.initial == 65535 { 80 } else { 8 }) => continue,
                _ => Wire::Value(self.preset_of(pin)),
            };
            let name = if self.dice.percent(20) { pin.name.to_lowercase() } else { pin.name.to_owned() };
            arguments.push(drawing::argument(&name, wire));
        }
        arguments
    }

    /// EN, now and then.
    pub(super) fn enable(&mut self, depth: Option<usize>) -> Vec<Argument> {
        let wired = self.dice.percent(12).then(|| drawing::argument("EN", self.bool_wire(depth)));
        wired.into_iter().collect()
    }

    fn own_inputs(&mut self, own: &Signature, depth: Option<usize>) -> Vec<Argument> {
        let mut arguments = self.enable(depth);
        for (name, ty) in &own.inputs {
            if self.dice.percent(30) {
                continue;
            }
            let wire =
                if *ty == Elementary::Bool { self.bool_wire(depth) } else { Wire::Value(self.expression(*ty, 1)) };
            arguments.push(drawing::argument(name, wire));
        }
        for (name, shape) in &own.references {
            let reference = self.reference_to(shape);
            let value = drawing::expression(ExpressionKind::Read(reference));
            arguments.push(drawing::argument(name, Wire::Value(value)));
        }
        arguments
    }

    /// A variable of a type that can be written; declared here where there is none.
    pub(super) fn reference_to(&mut self, shape: &Shape) -> Reference {
        let found = match shape {
            Shape::Value(ty) => self.place(*ty, Purpose::Write),
            _ => {
                self.whole(|whole| whole.shape == *shape && Purpose::Write.allows(whole.class)).map(|(whole, _)| whole)
            }
        };
        found.unwrap_or_else(|| {
            let name = format!("given_{}", self.unit.variables.len());
            self.declare_shape(VariableClass::Memory, &name, shape);
            Reference::of_name(drawing::name(&name))
        })
    }

    /// What a block of the register machine works on, and of how many registers from there on: those of its unit, or just one.
    fn registers(&mut self, block: StandardBlock) -> Option<(Reference, usize)> {
        block.input("REGISTER")?;
        let chained = block.input("LENGTH").is_some();
        let is_register = |whole: &super::Whole| match &whole.shape {
            Shape::Array(bounds, element) => {
                let class = whole.class;
                **element == Shape::Value(Elementary::Word)
                    && (!chained || (bounds.len() == 1 && class != VariableClass::InOut))
                    && Purpose::Write.allows(class)
            }
            _ => false,
        };
        self.fixed_indices = chained;
        let found = self.whole(is_register);
        self.fixed_indices = false;
        let (mut reference, shape) = found.unwrap_or_else(|| {
            let name = format!("registers_{}", self.unit.variables.len());
            let bounds = Bounds { first: 0, count: u32::try_from(self.dice.between(1, 4)).expect("it is small") };
            let shape = Shape::Array(vec![bounds], Box::new(Shape::Value(Elementary::Word)));
            self.declare_shape(VariableClass::Memory, &name, &shape);
            (Reference::of_name(drawing::name(&name)), shape)
        });
        let Shape::Array(bounds, _) = shape else { return None };
        if chained {
            let place = self.dice.below(bounds[0].count as usize);
            let index = drawing::integer(i128::from(bounds[0].first) + place as i128);
            reference.steps.push(rung::ladder::Step::Index(vec![index], NOWHERE));
            return Some((reference, bounds[0].count as usize - place));
        }
        let steps = self.refer(&reference.root.clone(), &[super::shape::Way::Element(bounds)]).steps;
        reference.steps.extend(steps);
        Some((reference, 1))
    }

    /// What an input other than a BOOL gets. A constant is in its range.
    fn preset_of(&mut self, pin: &Pin) -> Expression {
        let Some((least, greatest)) = pin.range else { return self.preset(pin.ty) };
        if self.dice.percent(40)
            && let Some(reference) = self.place(pin.ty, Purpose::ReadVariable)
        {
            return drawing::expression(ExpressionKind::Read(reference));
        }
        let near = [least, least + 1, least + 2, least + 3, greatest];
        drawing::integer(i128::from(*self.dice.pick(&near).min(&greatest)))
    }

    /// What a BOOL input gets. In a statement that is no circuit.
    pub(super) fn bool_wire(&mut self, depth: Option<usize>) -> Wire {
        let Some(depth) = depth.filter(|_| self.dice.percent(50)) else {
            return Wire::Value(self.expression(Elementary::Bool, 1));
        };
        let around = std::mem::replace(&mut self.in_pin, true);
        let branches = (0..self.dice.between(1, 2)).map(|_| drawing::branch(self.series(depth + 1))).collect();
        self.in_pin = around;
        Wire::Circuit(Circuit { branches, span: NOWHERE })
    }
}

/// What kind of timer an instance is, in every call of it.
fn timer_kind(instance: &Reference) -> i128 {
    let name = match &instance.root {
        Root::Name(name) => name.text.as_str(),
        Root::Address(_) => "",
    };
    name.bytes().last().map_or(0, |last| i128::from(last % 4))
}

/// The outputs that are single values.
pub(super) fn values(outputs: &[(String, Shape)]) -> Vec<(String, Elementary)> {
    let single = outputs.iter().filter_map(|(name, shape)| match shape {
        Shape::Value(ty) => Some((name.clone(), *ty)),
        _ => None,
    });
    single.collect()
}
