//! Whether two chunks, of one program or of two, become the same code.
//!
//! Code is made from a chunk's instructions, from where its slots and arrays lie, and from what the sections before have
//! stored lately. Nothing else of a program may ever count, so that what was compiled once can be kept.

use std::ops::Range;

use super::place;
use crate::logic::{ArrayId, Instruction, Layout, Op, Program, SlotId, ValueId};

/// Whether the sections of one program become the same code as those of another, on one target.
pub(in crate::engine) fn is_same(one: &Program, sections: Range<usize>, other: &Program, others: Range<usize>) -> bool {
    let (a, b) = (one.instruction_range(sections.clone()), other.instruction_range(others.clone()));
    // Which section an instruction belongs to decides which stores are late, and is told with the code.
    let lengths = |program: &Program, sections: Range<usize>| -> Vec<usize> {
        sections.map(|section| program.section_range(section).len()).collect()
    };
    let same = Same { layouts: [&one.layout, &other.layout], starts: [a.start, b.start] };
    a.len() == b.len()
        && lengths(one, sections.clone()) == lengths(other, others.clone())
        && one.instructions[a].iter().zip(&other.instructions[b]).all(|(a, b)| same.instructions(*a, *b))
        && place::stored_before(one, sections.start) == place::stored_before(other, others.start)
}

/// Comparing what stands in two programs.
struct Same<'a> {
    layouts: [&'a Layout; 2],
    /// The first instruction of each chunk.
    starts: [usize; 2],
}

impl Same<'_> {
    fn instructions(&self, a: Instruction, b: Instruction) -> bool {
        // An operand is the same if it is as far behind the start.
        let operands = || {
            let [mut a, mut b] = [a.op.operands(), b.op.operands()];
            std::iter::from_fn(move || Some((a.next(), b.next())).filter(|pair| *pair != (None, None)))
        };
        let near = |pair: (Option<ValueId>, Option<ValueId>)| match pair {
            (Some(a), Some(b)) => a.index() - self.starts[0] == b.index() - self.starts[1],
            _ => false,
        };
        a.ty == b.ty && self.kinds(a.op, b.op) && operands().all(near)
    }

    /// Whether two operations are the same but for their operands.
    fn kinds(&self, a: Op, b: Op) -> bool {
        match (a, b) {
            (Op::Load(a), Op::Load(b)) | (Op::Store(a, _), Op::Store(b, _)) => self.slots(a, b),
            (Op::LoadIndexed(a, _), Op::LoadIndexed(b, _)) | (Op::StoreIndexed(a, ..), Op::StoreIndexed(b, ..)) => {
                self.arrays(a, b)
            }
            (Op::CopyArray(a, from, _), Op::CopyArray(b, other, _)) => self.arrays(a, b) && self.arrays(from, other),
            (Op::Constant(a), Op::Constant(b)) => a == b,
            (Op::Unary(a, _), Op::Unary(b, _)) => a == b,
            (Op::Binary(a, ..), Op::Binary(b, ..)) => a == b,
            (Op::Compare(a, ..), Op::Compare(b, ..)) => a == b,
            (Op::Call(a, ..), Op::Call(b, ..)) => a == b,
            (Op::Now, Op::Now)
            | (Op::Select(..), Op::Select(..))
            | (Op::Convert(_), Op::Convert(_))
            | (Op::Reinterpret(_), Op::Reinterpret(_)) => true,
            (
                Op::Constant(_)
                | Op::Now
                | Op::Load(_)
                | Op::Store(..)
                | Op::Unary(..)
                | Op::Binary(..)
                | Op::Compare(..)
                | Op::Select(..)
                | Op::Convert(_)
                | Op::Reinterpret(_)
                | Op::Call(..)
                | Op::LoadIndexed(..)
                | Op::StoreIndexed(..)
                | Op::CopyArray(..),
                _,
            ) => false,
        }
    }

    fn slots(&self, a: SlotId, b: SlotId) -> bool {
        let (a, b) = (self.layouts[0].slot(a), self.layouts[1].slot(b));
        (a.offset, a.ty) == (b.offset, b.ty)
    }

    fn arrays(&self, a: ArrayId, b: ArrayId) -> bool {
        let (a, b) = (self.layouts[0].array(a), self.layouts[1].array(b));
        a.count == b.count && self.slots(a.first, b.first)
    }
}
