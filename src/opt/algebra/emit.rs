//! Trees as instructions, each in the polarity that costs no inversion.
//!
//! What must not hold is joined by OR and what must by AND; `NOT x AND y` is one instruction where the target has it,
//! and a load one where it is joined with a value. So an AND of which some parts must hold comes out as it is, one of
//! which none must comes out inverted, and the one that uses it takes either. Only a root whose polarity is the wrong
//! one costs an inversion.

use super::graph::{Graph, Literal, Node};
use crate::elementary::Elementary;
use crate::logic::{Binary, Op, Unary, ValueId};
use crate::opt::rewrite::Output;

/// What a node came out as.
#[derive(Clone, Copy, Debug)]
pub(super) struct Emitted {
    value: ValueId,
    /// Whether the value is its inverse.
    inverted: bool,
    /// The inverse of the value, once that was wanted.
    opposite: Option<ValueId>,
}

impl Graph {
    /// The value of a root.
    pub(super) fn root(&mut self, output: &mut Output, literal: Literal) -> ValueId {
        let literal = self.simplify(literal);
        let emitted = self.emit(output, literal.node);
        if emitted.inverted == literal.inverted {
            return emitted.value;
        }
        if let Some(opposite) = emitted.opposite {
            return opposite;
        }
        let opposite = output.not(emitted.value);
        self.emitted[literal.node as usize] = Some(Emitted { opposite: Some(opposite), ..emitted });
        opposite
    }

    fn emit(&mut self, output: &mut Output, node: u32) -> Emitted {
        if let Some(emitted) = self.emitted[node as usize] {
            return emitted;
        }
        let (value, inverted) = match &self.nodes[node as usize] {
            Node::Leaf(leaf) => {
                let leaf = *leaf;
                (output.copy(leaf).unwrap_or_else(|| unreachable!("a leaf stands before its tree")), false)
            }
            Node::And(parts) => {
                let parts = parts.clone();
                self.join_all(output, &parts)
            }
        };
        let emitted = Emitted { value, inverted, opposite: None };
        self.emitted[node as usize] = Some(emitted);
        emitted
    }

    /// An AND, or its inverse.
    fn join_all(&mut self, output: &mut Output, parts: &[Literal]) -> (ValueId, bool) {
        // What is computed is joined at once, so that few values wait; what is at hand comes after, and so can be part
        // of the instruction that joins it.
        let (mut holds, mut fails) = (None, None);
        let (mut straight, mut inverted) = (Vec::new(), Vec::new());
        for part in parts {
            if matches!(self.nodes[part.node as usize], Node::Leaf(_)) {
                let value = self.emit(output, part.node).value;
                if part.inverted { inverted.push(value) } else { straight.push(value) }
            } else {
                let emitted = self.emit(output, part.node);
                if emitted.inverted == part.inverted {
                    holds = Some(join(output, Binary::And, holds, emitted.value));
                } else {
                    fails = Some(join(output, Binary::Or, fails, emitted.value));
                }
            }
        }
        for value in inverted {
            fails = Some(join(output, Binary::Or, fails, value));
        }
        if let Some(fails) = fails {
            if holds.is_none() {
                // A load can be part of the instruction that inverts.
                let first = straight.iter().position(|value| matches!(output.op(*value), Op::Load(_))).unwrap_or(0);
                if straight.is_empty() {
                    return (fails, true);
                }
                holds = Some(straight.remove(first));
            }
            let inverse = output.emit(Elementary::Bool, Op::Unary(Unary::Not, fails));
            holds = Some(join(output, Binary::And, holds, inverse));
        }
        for value in straight {
            holds = Some(join(output, Binary::And, holds, value));
        }
        let value = holds.unwrap_or_else(|| output.constant(Elementary::Bool, 1));
        (value, false)
    }
}

fn join(output: &mut Output, op: Binary, before: Option<ValueId>, value: ValueId) -> ValueId {
    before.map_or(value, |before| output.emit(Elementary::Bool, Op::Binary(op, before, value)))
}
