//! Rungs, circuits and their elements to primitives: each maps the power on its left to the power on its right.
//!
//! Nothing short-circuits: a dead branch computes like a live one.

use super::Lowering;
use crate::check::{Circuit, Element, Expression, Place, Rung};
use crate::ladder::{CoilKind, ContactKind};
use crate::logic::ValueId;

/// The power on each node of a rung, as far as it is fed.
type Nodes = Vec<Option<ValueId>>;

impl Lowering<'_> {
    /// A rung from the left rail.
    pub(super) fn rung(&mut self, rung: &Rung) {
        let mut nodes = vec![None; rung.nodes as usize];
        let left = self.logic.bool(true);
        self.circuit(&rung.circuit, left, &mut nodes);
    }

    /// Branches in parallel; gives the power on their right.
    pub(super) fn circuit(&mut self, circuit: &Circuit, left: ValueId, nodes: &mut Nodes) -> ValueId {
        let mut right = None;
        for branch in &circuit.branches {
            let mut power = match branch.from {
                None => left,
                Some(node) => self.given(nodes[node.0 as usize]),
            };
            for element in &branch.elements {
                power = self.element(element, power, nodes);
            }
            let end = match branch.to {
                None => &mut right,
                Some(node) => &mut nodes[node.0 as usize],
            };
            *end = Some(match *end {
                None => power,
                Some(other) => self.logic.or(other, power),
            });
        }
        self.given(right)
    }

    /// The power, or none where nothing feeds it.
    fn given(&mut self, power: Option<ValueId>) -> ValueId {
        power.unwrap_or_else(|| self.logic.bool(false))
    }

    fn element(&mut self, element: &Element, left: ValueId, nodes: &mut Nodes) -> ValueId {
        match element {
            Element::Contact { kind, operand } => self.contact(*kind, operand, left),
            Element::Coil { kind, target } => {
                self.coil(*kind, target, left);
                left
            }
            Element::Call(call) => self.call(call, left, nodes),
            Element::Condition(condition) => {
                let holds = self.expression(condition);
                self.logic.and(left, holds)
            }
            Element::Assignment { target, value } => {
                let value = self.expression(value);
                self.write_if(left, target, value);
                left
            }
            Element::Parallel(circuit) => self.circuit(circuit, left, nodes),
            Element::Jump(target) => self.jump(*target, left),
            Element::Return => self.jump(self.end, left),
            Element::Statements(_) => left,
        }
    }

    fn contact(&mut self, kind: ContactKind, operand: &Expression, left: ValueId) -> ValueId {
        let operand = self.expression(operand);
        let conducts = match kind {
            ContactKind::Open => operand,
            ContactKind::Closed => self.logic.not(operand),
            ContactKind::Rising => self.edge(operand),
            ContactKind::Falling => self.falling_edge(operand),
        };
        self.logic.and(left, conducts)
    }

    fn coil(&mut self, kind: CoilKind, target: &Place, power: ValueId) {
        let value = match kind {
            CoilKind::Plain => power,
            CoilKind::Negated => self.logic.not(power),
            CoilKind::Set => {
                let old = self.read(target);
                self.logic.or(old, power)
            }
            CoilKind::Reset => {
                let old = self.read(target);
                let no_power = self.logic.not(power);
                self.logic.and(old, no_power)
            }
            CoilKind::Rising => self.edge(power),
            CoilKind::Falling => self.falling_edge(power),
        };
        self.write(target, value);
    }

    /// Whether a signal has become TRUE since the last scan: R_TRIG, with a memory of its own.
    fn edge(&mut self, signal: ValueId) -> ValueId {
        let memory = *self.edges.next().unwrap_or_else(|| unreachable!("every edge of the drawing has a memory"));
        let before = self.logic.load(memory);
        self.store(memory, signal);
        let was_off = self.logic.not(before);
        self.logic.and(signal, was_off)
    }

    /// Whether a signal has become FALSE: F_TRIG, which is R_TRIG of its negation, so that a signal that is FALSE
    /// on the first scan pulses.
    fn falling_edge(&mut self, signal: ValueId) -> ValueId {
        let off = self.logic.not(signal);
        self.edge(off)
    }
}
