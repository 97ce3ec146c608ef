//! Random networks: series, parallel, nodes, and calls with all that can be wired to them.

use rung::elementary::Elementary;
use rung::ladder::library::{Pin, Takes};
use rung::ladder::{
    Argument, BlockCall, Branch, Circuit, CoilKind, ContactKind, Element, ElementKind, Expression, ExpressionKind,
    Reference, Wire,
};

use super::declaration::{REGISTER_COUNT, REGISTERS};
use super::expression::boolean;
use super::{Generator, Instance, Purpose};
use crate::support::drawing::{self, NOWHERE};

/// How deep parallels and circuits at pins nest.
const DEPTH: usize = 3;

/// The most registers in a chain.
const LONGEST_CHAIN: usize = 4;

impl Generator {
    /// One to three elements.
    pub(super) fn series(&mut self, depth: usize) -> Vec<Element> {
        (0..self.dice.between(1, if depth == 0 { 3 } else { 2 })).map(|_| self.element(depth)).collect()
    }

    fn element(&mut self, depth: usize) -> Element {
        match self.dice.below(100) {
            0..15 if depth < DEPTH => self.parallel(depth + 1),
            15..30 if depth < DEPTH && !self.instances.is_empty() => self.some_call(depth + 1),
            30..40 => {
                let condition = self.expression(Elementary::Bool, 2);
                drawing::element(ElementKind::Condition(condition))
            }
            40..46 => self.write(),
            _ => self.contact(),
        }
    }

    pub(super) fn contact(&mut self) -> Element {
        use ContactKind::{Closed, Falling, Open, Rising};
        let kind = *self.dice.pick(&[Open, Open, Open, Closed, Closed, Rising, Falling]);
        let constant = self.dice.percent(3).then(|| boolean(self.dice.percent(70)));
        let operand = constant.unwrap_or_else(|| {
            let reference = self.readable(Elementary::Bool, Purpose::Read).expect("every program has a BOOL");
            drawing::expression(ExpressionKind::Read(reference))
        });
        drawing::element(ElementKind::Contact { kind, operand })
    }

    /// What stands at the right end of a rung: coils and assignments, in series or parallel.
    pub(super) fn ending(&mut self) -> Vec<Element> {
        let count = self.dice.between(1, 3);
        let writes: Vec<Element> = (0..count).map(|_| self.write()).collect();
        if count > 1 && self.dice.percent(50) {
            let branches = writes.into_iter().map(|write| {
                let lead = self.dice.percent(30).then(|| self.contact());
                drawing::branch(lead.into_iter().chain([write]).collect())
            });
            vec![drawing::parallel(branches.collect())]
        } else {
            writes
        }
    }

    fn write(&mut self) -> Element {
        use CoilKind::{Falling, Negated, Plain, Reset, Rising, Set};
        if self.dice.percent(35) {
            let ty = self.some_type();
            if let Some(target) = self.target(ty) {
                let value = self.expression(ty, 2);
                return drawing::element(ElementKind::Assignment { target, value });
            }
        }
        let kind = *self.dice.pick(&[Plain, Plain, Plain, Negated, Set, Set, Reset, Reset, Rising, Falling]);
        let target = self.target(Elementary::Bool).expect("every program has a BOOL output");
        drawing::element(ElementKind::Coil { kind, target })
    }

    /// Something of a type that can be written.
    fn target(&mut self, ty: Elementary) -> Option<Reference> {
        if ty == Elementary::Bool
            && self.dice.percent(8)
            && let Some(bit) = self.bit(Purpose::Write)
        {
            return Some(bit);
        }
        self.place(ty, Purpose::Write)
    }

    fn parallel(&mut self, depth: usize) -> Element {
        let branches = if self.dice.percent(15) {
            self.network(depth)
        } else {
            (0..self.dice.between(2, 3)).map(|_| self.plain_branch(depth)).collect()
        };
        drawing::parallel(branches)
    }

    fn plain_branch(&mut self, depth: usize) -> Branch {
        // Before the elements, whose own nodes are fed too late for this branch.
        let from = (!self.in_pin && !self.fed_nodes.is_empty() && self.dice.percent(10))
            .then(|| drawing::name(&self.dice.pick(&self.fed_nodes).clone()));
        let elements = if self.dice.percent(3) { Vec::new() } else { self.series(depth) };
        Branch { from, ..drawing::branch(elements) }
    }

    /// Branches over one to three nodes, each of which starts from the left or from an earlier node: bridges, too.
    fn network(&mut self, depth: usize) -> Vec<Branch> {
        let first = self.nodes;
        self.nodes += self.dice.between(1, 3);
        let own: Vec<String> = (first..self.nodes).map(|node| format!("w{node}")).collect();
        let mut branches = Vec::new();
        for (index, node) in own.iter().enumerate() {
            for _ in 0..self.dice.between(1, 2) {
                let from = (index > 0 && self.dice.percent(60))
                    .then(|| drawing::name(self.dice.pick::<String>(&own[..index])));
                let to = Some(drawing::name(node));
                branches.push(Branch { from, to, ..drawing::branch(self.series(depth)) });
            }
        }
        for node in &own {
            let is_used = branches.iter().any(|branch| branch.from.as_ref().is_some_and(|from| from.text == *node));
            if !is_used || self.dice.percent(70) {
                let from = Some(drawing::name(node));
                branches.push(Branch { from, ..drawing::branch(self.series(depth)) });
            }
        }
        if !self.in_pin {
            self.fed_nodes.extend(own);
        }
        branches
    }

    /// A call of an instance that was not called yet or, seldom, of one that was.
    fn some_call(&mut self, depth: usize) -> Element {
        if self.pending.is_empty() {
            if !self.dice.percent(5) {
                return self.contact();
            }
            let instance = self.dice.pick(&self.instances).clone();
            return self.call(&Instance { declared: true, ..instance }, depth);
        }
        let next = self.dice.below(self.pending.len());
        let instance = self.pending.swap_remove(next);
        self.call(&instance, depth)
    }

    fn call(&mut self, instance: &Instance, depth: usize) -> Element {
        let block = instance.block;
        let mut arguments = self.wired_inputs(instance, depth);
        for pin in block.outputs() {
            if self.dice.percent(20)
                && let Some(target) = self.target(pin.ty)
            {
                arguments.push(drawing::argument(pin.name, Wire::Output(target)));
            }
        }
        if self.dice.percent(20) {
            arguments.reverse();
        }
        let bools: Vec<&str> =
            block.outputs().iter().filter(|pin| pin.ty == Elementary::Bool).map(|pin| pin.name).collect();
        let chosen = !bools.is_empty() && self.dice.percent(if bools.len() > 1 { 60 } else { 15 });
        drawing::element(ElementKind::Block(BlockCall {
            instance: Reference::of_name(drawing::name(&instance.name)),
            type_name: (!instance.declared || self.dice.percent(10)).then(|| drawing::name(block.name())),
            arguments,
            power_output: chosen.then(|| drawing::name(self.dice.pick::<&str>(&bools))),
        }))
    }

    /// With the first BOOL input among them, or without one, the power on the left is EN.
    fn wired_inputs(&mut self, instance: &Instance, depth: usize) -> Vec<Argument> {
        let block = instance.block;
        let enable = self.dice.percent(25);
        let mut arguments = Vec::new();
        let power = block.inputs().iter().position(|pin| pin.ty == Elementary::Bool);
        for (index, pin) in block.inputs().iter().enumerate() {
            let wire = match (index, pin.ty) {
                _ if pin.takes == Takes::Reference => Wire::Value(self.register()),
                _ if pin.takes == Takes::Constant => Wire::Value(constant(pin, instance)),
                _ if Some(index) == power && !enable => continue,
                _ if Some(index) == power => self.bool_wire(depth),
                (_, Elementary::Bool) if self.dice.percent(30) => continue,
                (_, Elementary::Bool) => self.bool_wire(depth),
                _ if self.dice.percent(8) => continue,
                (_, ty) if pin.range.is_some() => {
                    // A constant beyond the range is an error, also one that is computed.
                    let variable = self.dice.percent(30).then(|| self.place(ty, Purpose::ReadVariable)).flatten();
                    Wire::Value(variable.map_or_else(
                        || self.small_constant(pin),
                        |reference| drawing::expression(ExpressionKind::Read(reference)),
                    ))
                }
                (_, ty) => Wire::Value(self.preset(ty)),
            };
            let name = if self.dice.percent(20) { pin.name.to_lowercase() } else { pin.name.to_owned() };
            arguments.push(drawing::argument(&name, wire));
        }
        arguments
    }

    /// One of the registers that every program has, such that a chain of some more may follow.
    fn register(&mut self) -> Expression {
        drawing::read(&format!("{REGISTERS}[{}]", self.dice.below(REGISTER_COUNT as usize - LONGEST_CHAIN)))
    }

    fn small_constant(&mut self, pin: &Pin) -> Expression {
        let numbers = small_constants(pin);
        drawing::integer((*self.dice.pick(&numbers)).into())
    }

    fn bool_wire(&mut self, depth: usize) -> Wire {
        if self.dice.percent(50) {
            return Wire::Value(self.expression(Elementary::Bool, 1));
        }
        let around = std::mem::replace(&mut self.in_pin, true);
        let branches = (0..self.dice.between(1, 2)).map(|_| drawing::branch(self.series(depth + 1))).collect();
        self.in_pin = around;
        Wire::Circuit(Circuit { branches, span: NOWHERE })
    }
}

/// The same in every call of an instance: what kind of timer it is does not change.
fn constant(pin: &Pin, instance: &Instance) -> Expression {
    let numbers = small_constants(pin);
    let chosen = instance.name.bytes().map(usize::from).sum::<usize>() % numbers.len();
    drawing::integer(numbers[chosen].into())
}

fn small_constants(pin: &Pin) -> Vec<i64> {
    let (least, greatest) = pin.range.expect("a pin that takes a constant says which");
    (least..=greatest).take(LONGEST_CHAIN).collect()
}
