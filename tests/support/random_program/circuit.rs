//! Random networks: series, parallel, nodes.

use rung::elementary::Elementary;
use rung::ladder::{Branch, CoilKind, ContactKind, Element, ElementKind, ExpressionKind, Reference};

use super::expression::boolean;
use super::{Generator, Purpose};
use crate::support::drawing;

/// How deep parallels and circuits at pins nest.
const DEPTH: usize = 3;

impl Generator {
    /// One to three elements.
    pub(super) fn series(&mut self, depth: usize) -> Vec<Element> {
        (0..self.dice.between(1, if depth == 0 { 3 } else { 2 })).map(|_| self.element(depth)).collect()
    }

    fn element(&mut self, depth: usize) -> Element {
        match self.dice.below(100) {
            0..15 if depth < DEPTH => self.parallel(depth + 1),
            15..32 if depth < DEPTH => self.some_call(depth + 1),
            32..40 => {
                let condition = self.expression(Elementary::Bool, 2);
                drawing::element(ElementKind::Condition(condition))
            }
            40..45 => self.write(),
            45..48 => self.braces(),
            _ => self.contact(),
        }
    }

    pub(super) fn contact(&mut self) -> Element {
        use ContactKind::{Closed, Falling, Open, Rising};
        let kinds = [Open, Open, Open, Closed, Closed, Rising, Falling];
        // A function has no memory for edges.
        let kind = *self.dice.pick(if self.in_function { &kinds[..5] } else { &kinds });
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

    /// Structured text in a rung.
    fn braces(&mut self) -> Element {
        let statements = self.statements(0, false);
        drawing::element(ElementKind::Statements(statements))
    }

    fn write(&mut self) -> Element {
        use CoilKind::{Falling, Negated, Plain, Reset, Rising, Set};
        if self.dice.percent(18) {
            return self.braces();
        }
        if self.dice.percent(35) {
            let ty = self.some_type();
            if let Some(target) = self.target(ty) {
                let value = self.expression(ty, 2);
                return drawing::element(ElementKind::Assignment { target, value: Box::new(value) });
            }
        }
        let kinds = [Plain, Plain, Plain, Negated, Set, Set, Reset, Reset, Rising, Falling];
        let kind = *self.dice.pick(if self.in_function { &kinds[..8] } else { &kinds });
        let target = self.target(Elementary::Bool).expect("every program has a BOOL output");
        drawing::element(ElementKind::Coil { kind, target })
    }

    /// Something of a type that can be written.
    pub(super) fn target(&mut self, ty: Elementary) -> Option<Reference> {
        if ty == Elementary::Bool
            && self.dice.percent(8)
            && let Some(bit) = self.bit(Purpose::Write)
        {
            return Some(bit);
        }
        if self.dice.percent(4)
            && let Some(pin) = self.pin(ty)
        {
            return Some(pin);
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
            .then(|| Box::new(drawing::name(&self.dice.pick(&self.fed_nodes).clone())));
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
                    .then(|| Box::new(drawing::name(self.dice.pick::<String>(&own[..index]))));
                let to = Some(Box::new(drawing::name(node)));
                branches.push(Branch { from, to, ..drawing::branch(self.series(depth)) });
            }
        }
        for node in &own {
            let is_used = branches.iter().any(|branch| branch.from.as_ref().is_some_and(|from| from.text == *node));
            if !is_used || self.dice.percent(70) {
                let from = Some(Box::new(drawing::name(node)));
                branches.push(Branch { from, ..drawing::branch(self.series(depth)) });
            }
        }
        if !self.in_pin {
            self.fed_nodes.extend(own);
        }
        branches
    }
}
