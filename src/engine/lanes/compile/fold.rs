//! A segment's operations, brought into the form of a processor's instructions, for whichever back end.
//!
//! What is in memory is an operand where it is used, as often as it is; what would be stored in between is loaded
//! before. x AND NOT y is one instruction. What is not used is not made.

use std::collections::HashMap;

use crate::engine::lanes::plan::{Bit, BitOp, Cell, FALSE_WORD, TRUE_WORD};

/// What an instruction works on.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Operand {
    /// What the instruction at an index made, one before.
    Made(u32),
    /// What is in memory now.
    Memory(Cell),
}

/// An instruction. Of two operands of which one is in memory, that is the second.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Instruction {
    Load(Cell),
    Not(Operand),
    And(Operand, Operand),
    /// The first and not the second.
    AndNot(Operand, Operand),
    Or(Operand, Operand),
    Xor(Operand, Operand),
    Store(Cell, Operand),
}

impl Instruction {
    /// What instructions before it made of what it works on.
    pub(super) fn made(&self) -> impl Iterator<Item = u32> + use<> {
        let operands = match *self {
            Self::Load(_) => [None, None],
            Self::Not(a) | Self::Store(_, a) => [Some(a), None],
            Self::And(a, b) | Self::AndNot(a, b) | Self::Or(a, b) | Self::Xor(a, b) => [Some(a), Some(b)],
        };
        operands.into_iter().flatten().filter_map(|operand| match operand {
            Operand::Made(index) => Some(index),
            Operand::Memory(_) => None,
        })
    }
}

/// The instructions of a segment.
pub(super) fn fold(ops: &[BitOp]) -> Vec<Instruction> {
    let mut uses = vec![0; ops.len()];
    ops.iter().flat_map(operands).for_each(|operand| uses[operand as usize] += 1);
    let held = vec![None; ops.len()];
    let mut folding = Folding { ops, uses, held, pending: HashMap::new(), made: Vec::with_capacity(ops.len()) };
    for index in 0..ops.len() {
        folding.op(index);
    }
    folding.made
}

/// The operands of an operation.
fn operands(op: &BitOp) -> impl Iterator<Item = u32> + use<> {
    let operands = match *op {
        BitOp::Load(_) | BitOp::Store(_, Bit::Constant(_)) => [None, None],
        BitOp::Not(a) | BitOp::Store(_, Bit::Made(a)) => [Some(a), None],
        BitOp::And(a, b) | BitOp::Or(a, b) | BitOp::Xor(a, b) => [Some(a), Some(b)],
    };
    operands.into_iter().flatten()
}

struct Folding<'a> {
    ops: &'a [BitOp],
    /// By operation: uses that are still to come.
    uses: Vec<u32>,
    /// By operation: the instruction that made it.
    held: Vec<Option<u32>>,
    /// Loads of a place in memory since it was last stored.
    pending: HashMap<Cell, Vec<u32>>,
    made: Vec<Instruction>,
}

impl Folding<'_> {
    fn op(&mut self, index: usize) {
        let id = u32::try_from(index).unwrap_or(u32::MAX);
        let instruction = match self.ops[index] {
            BitOp::Store(cell, bit) => {
                let value = match bit {
                    Bit::Constant(value) => Operand::Memory(Cell::Word(if value { TRUE_WORD } else { FALSE_WORD })),
                    Bit::Made(id) => self.value(id),
                };
                self.make_pending(cell);
                self.made.push(Instruction::Store(cell, value));
                return;
            }
            _ if self.uses[index] == 0 => return,
            // Left to where they are used.
            BitOp::Load(cell) => return self.pending.entry(cell).or_default().push(id),
            BitOp::Not(_) if self.is_late_not(id) => return,
            BitOp::Not(a) => Instruction::Not(self.value(a)),
            BitOp::And(a, b) => self.and(a, b),
            BitOp::Or(a, b) => {
                let (a, b) = self.both(a, b);
                Instruction::Or(a, b)
            }
            BitOp::Xor(a, b) => {
                let (a, b) = self.both(a, b);
                Instruction::Xor(a, b)
            }
        };
        self.held[index] = Some(self.push(instruction));
    }

    fn push(&mut self, instruction: Instruction) -> u32 {
        self.made.push(instruction);
        u32::try_from(self.made.len() - 1).unwrap_or(u32::MAX)
    }

    /// Uses a value.
    fn value(&mut self, id: u32) -> Operand {
        let index = id as usize;
        self.uses[index] = self.uses[index].saturating_sub(1);
        match (self.held[index], self.ops[index]) {
            (Some(made), _) => Operand::Made(made),
            (None, BitOp::Load(cell)) => Operand::Memory(cell),
            (None, BitOp::Not(a)) => {
                let a = self.value(a);
                Operand::Made(self.push(Instruction::Not(a)))
            }
            (None, BitOp::And(..) | BitOp::Or(..) | BitOp::Xor(..) | BitOp::Store(..)) => {
                unreachable!("operands are made before, and only the above are late")
            }
        }
    }

    /// Whether a NOT is left to its only use. Not so that of a NOT, or a long chain of them would nest as deep.
    fn is_late_not(&self, id: u32) -> bool {
        match self.ops[id as usize] {
            BitOp::Not(inner) => self.uses[id as usize] == 1 && !matches!(self.ops[inner as usize], BitOp::Not(_)),
            _ => false,
        }
    }

    /// What a NOT that was left to its use inverts.
    fn late_not(&self, id: u32) -> Option<u32> {
        match self.ops[id as usize] {
            BitOp::Not(inner) if self.held[id as usize].is_none() && self.is_late_not(id) => Some(inner),
            _ => None,
        }
    }

    /// Two values, one in memory behind the other.
    fn both(&mut self, a: u32, b: u32) -> (Operand, Operand) {
        match (self.value(a), self.value(b)) {
            (a @ Operand::Memory(_), b @ Operand::Made(_)) => (b, a),
            (a, b) => (a, b),
        }
    }

    fn and(&mut self, a: u32, b: u32) -> Instruction {
        let (kept, inverted) = match (self.late_not(a), self.late_not(b)) {
            (Some(inner), None) => (b, inner),
            (_, Some(inner)) => (a, inner),
            (None, None) => {
                let (a, b) = self.both(a, b);
                return Instruction::And(a, b);
            }
        };
        let inverted = self.value(inverted);
        Instruction::AndNot(self.value(kept), inverted)
    }

    /// Makes the loads of a place that is about to be stored.
    fn make_pending(&mut self, cell: Cell) {
        for load in self.pending.remove(&cell).unwrap_or_default() {
            let index = load as usize;
            if self.uses[index] > 0 && self.held[index].is_none() {
                self.held[index] = Some(self.push(Instruction::Load(cell)));
            }
        }
    }
}
