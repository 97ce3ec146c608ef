//! Rungs and their networks: contacts, coils, parallel branches and nodes.
//!
//! Beside checking, the walk follows power that is constantly FALSE: behind a contact or condition that is constantly
//! so, and where only such power comes together. Behind a block nothing is known, for a block may turn power on. A
//! rung is said to never conduct when it has coils or assignments, and such power is at every one of them.

use std::collections::HashMap;

use super::expression::constant;
use super::function_box::Boxed;
use super::jump::Labels;
use super::model::{self, NodeId, Place, UnitId};
use super::report::clipped;
use super::{Checker, types};
use crate::diagnostic::{Code, Diagnostic};
use crate::elementary::{Elementary, Value};
use crate::ladder::{self, CoilKind, ContactKind, ElementKind, Name, Reference, Rung};
use crate::source::Span;

/// What is known of the power at a point.
#[derive(Clone, Copy)]
pub(super) enum Power {
    /// It may be TRUE.
    Maybe,
    /// It is always FALSE, because of what stands here.
    Never(Span),
}

impl Power {
    /// Of power that comes together.
    fn or(self, other: Self) -> Self {
        if matches!(other, Self::Maybe) { other } else { self }
    }

    /// Behind an element that never conducts.
    fn and_never(self, span: Span) -> Self {
        if matches!(self, Self::Maybe) { Self::Never(span) } else { self }
    }
}

/// What is known of the rung that is walked.
pub(super) struct Walk {
    /// Its unit.
    pub(super) unit: usize,
    /// Its place among all rungs of that.
    pub(super) rung: usize,
    /// Whether it runs.
    pub(super) enabled: bool,
    nodes: HashMap<String, Node>,
    /// Nodes that were fed.
    fed: u32,
    /// Whether anything in it has an effect.
    active: bool,
    /// Whether a coil or an assignment may have power.
    conducts: bool,
    /// What keeps the power from the first coil or assignment that has none.
    barrier: Option<Span>,
    /// Whether this is a circuit at a pin.
    pub(super) in_pin: bool,
    /// Whether this is only one of the ways that an IF or CASE may take.
    pub(super) conditional: bool,
}

struct Node {
    id: NodeId,
    power: Power,
    /// Where it was first named.
    span: Span,
    /// Where a branch starts from it.
    used: Option<Span>,
    /// Whether a fault of it was reported.
    faulty: bool,
}

impl Walk {
    fn new(unit: usize, rung: usize, enabled: bool) -> Self {
        Self {
            unit,
            rung,
            enabled,
            nodes: HashMap::new(),
            fed: 0,
            active: false,
            conducts: false,
            barrier: None,
            in_pin: false,
            conditional: false,
        }
    }

    pub(super) fn effect(&mut self, power: Power) {
        self.active = true;
        match power {
            Power::Maybe => self.conducts = true,
            Power::Never(span) => {
                self.barrier.get_or_insert(span);
            }
        }
    }
}

impl<'p> Checker<'p> {
    /// Checks all rungs of a unit but those nested too deeply; the result holds those that run.
    pub(super) fn check_unit(&mut self, unit: usize) -> Vec<model::Rung> {
        let program = self.program;
        let drawn = &program.units[unit];
        self.scope.enter(u32::try_from(unit).ok().map(UnitId));
        self.labels = Labels::of(drawn);
        let mut rungs = Vec::with_capacity(drawn.rungs.len());
        for (index, rung) in drawn.rungs.iter().enumerate() {
            if let Some(name) = &rung.name
                && let Some(first) = self.labels.earlier(drawn, name, index)
            {
                let message = format!("two rungs are called `{}`", name.text);
                let problem = Diagnostic::new(Code::DuplicateName, name.span, message);
                self.report.push(problem.related(first, "the first is here"));
            }
            if !self.too_deep.contains(&(unit, index)) {
                self.turns = rung.enabled.then_some(1);
                let checked = self.rung(rung, unit, index);
                self.turns = None;
                rungs.extend(rung.enabled.then_some(checked));
            }
        }
        self.labels = Labels::default();
        rungs
    }

    /// The unit that is being checked, as drawn; of global declarations, which have no rungs, the first.
    pub(super) fn drawn(&self) -> &'p ladder::Unit {
        &self.program.units[self.scope.unit().map_or(0, UnitId::index)]
    }

    fn rung(&mut self, rung: &Rung, unit: usize, index: usize) -> model::Rung {
        let mut walk = Walk::new(unit, index, rung.enabled);
        let (circuit, _) = self.circuit(&rung.circuit, Power::Maybe, &mut walk);
        let mut unused: Vec<&Node> = walk.nodes.values().filter(|node| node.used.is_none()).collect();
        unused.sort_by_key(|node| node.id.0);
        for node in unused {
            let problem = Diagnostic::new(Code::NodeMisuse, node.span, "no branch starts at this node");
            self.report.push(problem.hint("its name at the start of a later branch continues from it"));
        }
        if !walk.active {
            let message = format!("{} has no coil, block or assignment", self.rung_name(unit, index));
            self.report.push(Diagnostic::new(Code::EmptyRung, rung.span, message));
        } else if let (false, Some(barrier)) = (walk.conducts, walk.barrier) {
            let message = format!("{} can never conduct: no power passes here", self.rung_name(unit, index));
            let problem = Diagnostic::new(Code::NeverConducts, barrier, message);
            self.report.push(problem.hint("`rung off` keeps a rung from running"));
        }
        let label = rung.name.as_ref().map_or_else(|| self.rung_name(unit, index).into(), |name| name.text.clone());
        model::Rung { label, title: rung.title.clone(), nodes: walk.fed, circuit, span: rung.span }
    }

    /// A rung by its name or else its number among all rungs of the source, for messages.
    pub(super) fn rung_name(&self, unit: usize, index: usize) -> String {
        match self.program.units[unit].rungs.get(index).and_then(|rung| rung.name.as_ref()) {
            Some(name) => format!("rung {}", clipped(&name.text)),
            None => format!("rung {}", self.first_rungs[unit] + index + 1),
        }
    }

    /// A circuit and the power on its right. What is faulty in it was reported and is left out.
    pub(super) fn circuit(
        &mut self,
        circuit: &ladder::Circuit,
        left: Power,
        walk: &mut Walk,
    ) -> (model::Circuit, Power) {
        let mut right: Option<Power> = None;
        let mut branches = Vec::with_capacity(circuit.branches.len());
        for branch in &circuit.branches {
            let (from, mut power) = match &branch.from {
                None => (None, left),
                Some(name) => self.leave_node(name, walk),
            };
            let mut elements = Vec::with_capacity(branch.elements.len());
            for element in &branch.elements {
                let (element, after) = self.element(element, power, walk);
                elements.extend(element);
                power = after;
            }
            self.check_jumps_end(branch);
            let to = branch.to.as_ref().map(|name| self.feed_node(name, power, walk));
            if to.is_none() {
                right = Some(right.map_or(power, |others| others.or(power)));
            }
            branches.push(model::Branch { from, elements: elements.into_boxed_slice(), to });
        }
        // Where every branch ends at a node there is no power on the right.
        (model::Circuit { branches: branches.into_boxed_slice() }, right.unwrap_or(Power::Never(circuit.span)))
    }

    /// The node that a branch starts at, and its power.
    fn leave_node(&mut self, name: &Name, walk: &mut Walk) -> (Option<NodeId>, Power) {
        if let Some(node) = walk.nodes.get_mut(&name.key()) {
            node.used.get_or_insert(name.span);
            return (Some(node.id), node.power);
        }
        let message = format!("no branch before this one ends at node `{}`", name.text);
        let problem = Diagnostic::new(Code::NodeMisuse, name.span, message);
        self.report.push(problem.hint("all branches that feed a node stand before the first that starts from it"));
        let node =
            Node { id: NodeId(walk.fed), power: Power::Maybe, span: name.span, used: Some(name.span), faulty: true };
        walk.nodes.insert(name.key(), node);
        (None, Power::Maybe)
    }

    /// The node that a branch ends at.
    fn feed_node(&mut self, name: &Name, power: Power, walk: &mut Walk) -> NodeId {
        let Some(node) = walk.nodes.get_mut(&name.key()) else {
            let id = NodeId(walk.fed);
            walk.fed += 1;
            walk.nodes.insert(name.key(), Node { id, power, span: name.span, used: None, faulty: false });
            return id;
        };
        node.power = node.power.or(power);
        if let (Some(used), false) = (node.used, node.faulty) {
            node.faulty = true;
            let message = format!("node `{}` is fed after a branch started from it", name.text);
            let problem =
                Diagnostic::new(Code::NodeMisuse, name.span, message).related(used, "that branch starts here");
            self.report.push(problem.hint("let this branch stand before that one"));
        }
        node.id
    }

    /// An element and the power on its right. Circuits nest, so that what has none in it is checked in a function of its own.
    fn element(&mut self, element: &ladder::Element, left: Power, walk: &mut Walk) -> (Option<model::Element>, Power) {
        self.weigh(1);
        match &element.kind {
            ElementKind::Block(call) => {
                walk.active = true;
                let call = self.call(call, element.span, true, walk);
                (call.map(Boxed::element), Power::Maybe)
            }
            ElementKind::Parallel(circuit) => {
                let (circuit, right) = self.circuit(circuit, left, walk);
                (Some(model::Element::Parallel(circuit)), right)
            }
            _ => self.simple_element(element, left, walk),
        }
    }

    fn simple_element(
        &mut self,
        element: &ladder::Element,
        left: Power,
        walk: &mut Walk,
    ) -> (Option<model::Element>, Power) {
        match &element.kind {
            ElementKind::Contact { kind, operand } => {
                let is_edge = matches!(kind, ContactKind::Rising | ContactKind::Falling);
                self.check_edge(is_edge, "a contact", element.span);
                let operand = self.value(operand, Elementary::Bool);
                let blocks = operand.as_ref().and_then(model::Expression::constant).is_some_and(|value| {
                    // An edge of what never is so does not come either.
                    match kind {
                        ContactKind::Open | ContactKind::Rising => !value.is_true(),
                        ContactKind::Closed | ContactKind::Falling => value.is_true(),
                    }
                });
                let right = if blocks { left.and_never(element.span) } else { left };
                (operand.map(|operand| model::Element::Contact { kind: *kind, operand }), right)
            }
            ElementKind::Condition(condition) => {
                let condition = self.value(condition, Elementary::Bool);
                let blocks = condition.as_ref() == Some(&constant(Value::bool(false)));
                let right = if blocks { left.and_never(element.span) } else { left };
                (condition.map(model::Element::Condition), right)
            }
            ElementKind::Coil { kind, target } => {
                self.check_edge(matches!(kind, CoilKind::Rising | CoilKind::Falling), "a coil", element.span);
                walk.effect(left);
                let target = self.coil_target(target);
                if let Some(target) = &target {
                    self.note_coil(*kind, target, element.span, walk);
                }
                (target.map(|target| model::Element::Coil { kind: *kind, target }), left)
            }
            ElementKind::Assignment { target, value } => {
                walk.effect(left);
                let assignment = self.assign(target, value).map(|statement| match statement {
                    model::Statement::Assignment { target, value } => {
                        model::Element::Assignment { target, value: Box::new(value) }
                    }
                    statement => model::Element::Statements(vec![statement]),
                });
                (assignment, left)
            }
            ElementKind::Statements(statements) => {
                walk.effect(left);
                let statements = self.statements(statements, walk);
                (Some(model::Element::Statements(statements)), left)
            }
            ElementKind::Jump { target } => {
                (self.jump(Some(target), element.span, left, walk), left.and_never(element.span))
            }
            ElementKind::Return => (self.jump(None, element.span, left, walk), left.and_never(element.span)),
            ElementKind::Block(_) | ElementKind::Parallel(_) => (None, left),
        }
    }

    /// Reports an edge in a function, which has no memory for it.
    fn check_edge(&mut self, is_edge: bool, what: &str, span: Span) {
        if is_edge && self.in_function() {
            let message = format!("a function remembers nothing, and {what} for an edge does");
            let problem = Diagnostic::new(Code::NoMemoryHere, span, message);
            self.report.push(problem.hint("declare a function block instead, which has instances"));
        }
    }

    /// Where a coil writes.
    fn coil_target(&mut self, target: &Reference) -> Option<Place> {
        let (place, ty) = self.write(target)?;
        if ty != Elementary::Bool {
            let message = format!("a coil writes a BOOL, and this is {}", types::with_article(ty.name()));
            let problem = Diagnostic::new(Code::TypeMismatch, target.span, message);
            self.report.push(problem.hint("write other types in braces, as in `{x := 1}`"));
        }
        (ty == Elementary::Bool).then_some(place)
    }
}
