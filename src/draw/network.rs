//! A rung's circuits as nested groups of lines with their sizes: what is placed, before anything has a place.
//!
//! One pass over the model, each element once. It must not recurse deeper than a fixed depth, whatever the model
//! holds: a circuit nested deeper is drawn as a box with `…`.

use super::symbol::{InstanceTypes, Limits, Symbol, node_text};
use super::{label, statements};
use crate::ladder::{BlockCall, Branch, Circuit, ElementKind, Wire};

/// How deep circuits are drawn one inside the other.
const MAXIMUM_DEPTH: usize = 256;

/// Lines in parallel.
pub(super) struct Group {
    pub(super) lines: Vec<Line>,
    /// Grid cells from left to right, at least one.
    pub(super) cells: usize,
    /// Rows above the first line's wire.
    pub(super) above: usize,
    /// Rows below the first line's wire.
    pub(super) below: usize,
    /// Whether all that it holds are outputs.
    pub(super) is_output: bool,
}

/// Parts in series.
pub(super) struct Line {
    pub(super) parts: Vec<Part>,
    /// From which part on there are outputs only; they are placed at the right end.
    pub(super) tail: usize,
    /// Whether it is joined to the left side of its group.
    pub(super) joins_left: bool,
    /// Whether it is joined to the right side of its group.
    pub(super) joins_right: bool,
    /// Grid cells from left to right.
    pub(super) cells: usize,
    /// Rows above its wire.
    pub(super) above: usize,
    /// Rows below its wire.
    pub(super) below: usize,
}

/// One part of a line.
pub(super) enum Part {
    Symbol(Symbol),
    Group(Group),
}

impl Part {
    /// Grid cells from left to right.
    pub(super) fn cells(&self) -> usize {
        match self {
            Self::Symbol(_) => 1,
            Self::Group(group) => group.cells,
        }
    }

    fn above(&self) -> usize {
        match self {
            Self::Symbol(symbol) => symbol.above,
            Self::Group(group) => group.above,
        }
    }

    fn below(&self) -> usize {
        match self {
            Self::Symbol(symbol) => symbol.below,
            Self::Group(group) => group.below,
        }
    }

    fn is_output(&self) -> bool {
        match self {
            Self::Symbol(symbol) => symbol.is_output,
            Self::Group(group) => group.is_output,
        }
    }
}

impl Group {
    fn of(lines: Vec<Line>) -> Self {
        let cells = lines.iter().map(|line| line.cells).max().unwrap_or(0).max(1);
        let above = lines.first().map_or(0, |line| line.above);
        let height: usize = lines.iter().map(|line| line.above + 1 + line.below).sum();
        let is_output = !lines.is_empty() && lines.iter().all(|line| line.tail == 0 && !line.parts.is_empty());
        Self { cells, above, below: height.saturating_sub(above + 1), is_output, lines }
    }
}

impl Line {
    fn of(parts: Vec<Part>, joins_left: bool, joins_right: bool) -> Self {
        let outputs = parts.iter().rev().take_while(|part| part.is_output()).count();
        let tail = if joins_right { parts.len() - outputs } else { parts.len() };
        Self {
            tail,
            joins_left,
            joins_right,
            cells: parts.iter().map(Part::cells).sum(),
            above: parts.iter().map(Part::above).max().unwrap_or(0),
            below: parts.iter().map(Part::below).max().unwrap_or(0),
            parts,
        }
    }
}

/// The networks of one rung, in the order in which they run: the circuits on pins that are too large to be
/// written beside them, each ending at a connector, and the rung's own circuit last.
pub(super) fn networks(circuit: &Circuit, types: &InstanceTypes<'_>, limits: Limits) -> Vec<Group> {
    let mut builder = Builder { types, limits, networks: Vec::new(), depth: 0 };
    let main = builder.circuit(circuit);
    let mut networks = builder.networks;
    networks.push(main);
    networks
}

struct Builder<'a> {
    types: &'a InstanceTypes<'a>,
    limits: Limits,
    networks: Vec<Group>,
    depth: usize,
}

impl Builder<'_> {
    fn circuit(&mut self, circuit: &Circuit) -> Group {
        self.depth += 1;
        let lines = circuit.branches.iter().map(|branch| self.branch(branch)).collect();
        self.depth -= 1;
        Group::of(lines)
    }

    fn branch(&mut self, branch: &Branch) -> Line {
        let from = branch.from.as_ref().map(|node| Part::Symbol(Symbol::node_start(&node.text, self.limits)));
        let to = branch.to.as_ref().map(|node| Part::Symbol(Symbol::node_end(&node.text, self.limits)));
        let ends_in_jump = branch
            .elements
            .last()
            .is_some_and(|last| matches!(last.kind, ElementKind::Jump { .. } | ElementKind::Return));
        let (joins_left, joins_right) = (from.is_none(), to.is_none() && !ends_in_jump);
        let elements = branch.elements.iter().map(|element| self.element(&element.kind));
        let parts = from.into_iter().chain(elements).chain(to).collect();
        Line::of(parts, joins_left, joins_right)
    }

    fn element(&mut self, element: &ElementKind) -> Part {
        let limits = self.limits;
        Part::Symbol(match element {
            ElementKind::Contact { kind, operand } => Symbol::contact(*kind, operand, limits),
            ElementKind::Coil { kind, target } => Symbol::coil(*kind, target, limits),
            ElementKind::Condition(condition) => {
                Symbol::boxed(vec![label::expression(condition, limits.expression)], false)
            }
            ElementKind::Assignment { target, value } => {
                Symbol::boxed(vec![label::assignment(target, value, limits.expression)], true)
            }
            ElementKind::Block(call) => self.block(call),
            ElementKind::Statements(list) => Symbol::boxed(statements::lines(list, limits.expression), true),
            ElementKind::Jump { target } => Symbol::jump(&target.text, limits),
            ElementKind::Return => Symbol::jump("return", limits),
            ElementKind::Parallel(_) if self.depth >= MAXIMUM_DEPTH => Symbol::boxed(vec!["…".to_owned()], false),
            ElementKind::Parallel(inner) => return Part::Group(self.circuit(inner)),
        })
    }

    fn block(&mut self, call: &BlockCall) -> Symbol {
        let mut labels = Vec::new();
        for argument in &call.arguments {
            if let Wire::Circuit(circuit) = &argument.wire {
                let written = label::circuit(circuit, self.limits.pin);
                labels.push(match written {
                    Some(text) => text,
                    None if self.depth >= MAXIMUM_DEPTH => "…".to_owned(),
                    None => self.pin_circuit(
                        circuit,
                        &format!("{}.{}", label::reference(&call.instance, self.limits.pin), argument.pin.text),
                    ),
                });
            }
        }
        Symbol::block(call, self.types, labels, self.limits)
    }

    /// Draws a circuit on a pin as a network of its own; returns what to write at the pin.
    fn pin_circuit(&mut self, circuit: &Circuit, node: &str) -> String {
        let group = self.circuit(circuit);
        // A cut name must be the same at both ends, so that the limit of the narrower place counts.
        let limits = Limits { name: self.limits.name.min(self.limits.pin), ..self.limits };
        let parts = vec![Part::Group(group), Part::Symbol(Symbol::node_end(node, limits))];
        self.networks.push(Group::of(vec![Line::of(parts, true, false)]));
        node_text(node, limits)
    }
}
