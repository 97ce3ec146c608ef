//! Rungs, circuits and their elements to primitives: each maps the power on its left to the power on its right.
//!
//! Nothing short-circuits: a dead branch computes like a live one.

use super::Lowering;
use super::attempt::Attempt;
use super::cell::Cell;
use crate::check::{Circuit, Element, Expression, Place, Rung, RungIndex};
use crate::ladder::{CoilKind, ContactKind};
use crate::logic::ValueId;

impl Lowering<'_> {
    /// A rung from the left rail.
    pub(super) fn rung(&mut self, rung: &Rung) {
        self.unit.nodes = vec![None; rung.nodes as usize];
        let left = self.logic.bool(true);
        self.circuit(&rung.circuit, left);
    }

    /// Branches in parallel; gives the power on their right.
    pub(super) fn circuit(&mut self, circuit: &Circuit, left: ValueId) -> ValueId {
        let mut right = None;
        for branch in &circuit.branches {
            let mut power = match branch.from {
                None => left,
                Some(node) => self.given(self.unit.nodes[node.index()]),
            };
            for element in &branch.elements {
                power = self.element(element, power);
            }
            let end = match branch.to {
                None => &mut right,
                Some(node) => &mut self.unit.nodes[node.index()],
            };
            let before = *end;
            let power = before.map_or(power, |before| self.logic.or(before, power));
            *end = Some(power);
        }
        self.given(right)
    }

    /// The power, or none where nothing feeds it.
    fn given(&mut self, power: Option<ValueId>) -> ValueId {
        power.unwrap_or_else(|| self.logic.bool(false))
    }

    fn element(&mut self, element: &Element, left: ValueId) -> ValueId {
        match element {
            Element::Contact { kind, operand } => {
                let outer = self.begin(Some(left));
                let right = self.contact(*kind, operand, left);
                self.end(outer);
                right
            }
            Element::Coil { kind, target } => {
                let outer = self.begin(Some(left));
                self.coil(*kind, target, left);
                self.end(outer);
                left
            }
            Element::Call(call) => self.call(call, Some(left)).right,
            Element::Condition(condition) => {
                let outer = self.begin(Some(left));
                let holds = self.expression(condition);
                let right = self.logic.and(left, holds);
                self.end_with_power(outer, right)
            }
            Element::Assignment { target, value } => {
                let outer = self.begin(Some(left));
                let value = self.expression(value);
                let target = self.spot(target);
                self.store(target, value, Some(left));
                self.end_with_power(outer, left)
            }
            Element::Statements(statements) => self.braces(statements, left),
            Element::Parallel(circuit) => self.circuit(circuit, left),
            Element::Jump(target) => self.jump_away(*target, left),
            Element::Return => self.jump_away(self.unit.end, left),
        }
    }

    /// The end of braces: the power on their right, of which there is none where an index was out of range.
    fn end_with_power(&mut self, outer: Attempt, right: ValueId) -> ValueId {
        let in_range = self.end(outer);
        in_range.map_or(right, |in_range| self.logic.and(right, in_range))
    }

    /// A jump; gives the power on its right, of which there is none.
    fn jump_away(&mut self, target: RungIndex, power: ValueId) -> ValueId {
        self.jump(target, Some(power));
        self.logic.bool(false)
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
        let spot = self.spot(target);
        let value = match kind {
            CoilKind::Plain => power,
            CoilKind::Negated => self.logic.not(power),
            CoilKind::Set => {
                let old = self.load(spot);
                self.logic.or(old, power)
            }
            CoilKind::Reset => {
                let old = self.load(spot);
                let no_power = self.logic.not(power);
                self.logic.and(old, no_power)
            }
            CoilKind::Rising => self.edge(power),
            CoilKind::Falling => self.falling_edge(power),
        };
        self.store(spot, value, None);
    }

    /// Whether a signal has become TRUE since the last scan: R_TRIG, with a memory of its own.
    fn edge(&mut self, signal: ValueId) -> ValueId {
        let cells = *self.unit.edges.next().unwrap_or_else(|| unreachable!("every edge of the drawing has a memory"));
        let memory = Cell { cells, pick: self.unit.pick };
        let before = memory.load(&mut self.logic);
        let executed = self.effective(None);
        memory.store(&mut self.logic, executed, signal);
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
