//! Whether two chunks, of one program or of two, become the same code.
//!
//! Code is made from a chunk's instructions, from where its slots and arrays lie, and from what the sections before have
//! stored lately. Nothing else of a program may ever count, so that what was compiled once can be kept.

use std::ops::Range;
use std::sync::Arc;

use super::place;
use crate::elementary::Elementary;
use crate::logic::{ArrayId, Instruction, Layout, Op, Program, SlotId, ValueId};
use crate::parallel;

/// Two programs whose chunks are compared.
pub(in crate::engine) struct Comparison<'a> {
    programs: [&'a Program; 2],
    /// How many slots from the first on lie at the same place in both: all before the first that an edit adds or takes away.
    /// Others are looked up.
    same_slots: u32,
    /// How many sections are the same in both, from the first on and up to the last. After an edit that is all but a few, so
    /// that each is looked at once, and not again as what a chunk may have behind it.
    same_first: usize,
    same_last: usize,
}

impl<'a> Comparison<'a> {
    /// Looks for what two programs have in common.
    pub(in crate::engine) fn new(one: &'a Program, other: &'a Program) -> Self {
        let slots = one.layout.slots().iter().zip(other.layout.slots());
        let same_slots = if Arc::ptr_eq(&one.layout, &other.layout) {
            one.layout.slots().len()
        } else {
            slots.take_while(|(a, b)| (a.offset, a.ty) == (b.offset, b.ty)).count()
        };
        let same_slots = u32::try_from(same_slots).unwrap_or(u32::MAX);
        let mut found = Self { programs: [one, other], same_slots, same_first: 0, same_last: 0 };
        let same = parallel::each(2, || (), |(), way| if way == 0 { found.same_first() } else { found.same_last() });
        (found.same_first, found.same_last) = (same[0], same[1]);
        found
    }

    /// How many sections are the same from the first on.
    fn same_first(&self) -> usize {
        let [one, other] = self.programs;
        let pairs = one.instructions.iter().zip(&other.instructions);
        let same = pairs.take_while(|(a, b)| self.instructions(**a, **b, [0; 2])).count();
        let ends = one.sections.iter().zip(&other.sections).map(|(a, b)| [a.end as usize, b.end as usize]);
        ends.take_while(|[a, b]| a == b && *a <= same).count()
    }

    /// How many sections are the same up to the last.
    fn same_last(&self) -> usize {
        let lengths = self.programs.map(|program| program.instructions.len());
        let [ones, others] = self.programs.map(|program| program.instructions.iter().rev());
        let same = ones.zip(others).take_while(|(a, b)| self.instructions(**a, **b, lengths)).count();
        let [ones, others] = self.programs.map(|program| {
            let length = program.instructions.len();
            (0..program.sections.len()).rev().map(move |section| length - program.section_range(section).start)
        });
        ones.zip(others).take_while(|(a, b)| a == b && *a <= same).count()
    }

    /// Whether sections of the first program become the same code as those of the second, on one target.
    pub(in crate::engine) fn is_same(&self, sections: Range<usize>, others: Range<usize>) -> bool {
        let [one, other] = self.programs;
        let before = |sections: &Range<usize>| Some(sections.start.checked_sub(place::LATELY)?..sections.start);
        self.computes_the_same(sections.clone(), others.clone())
            && (before(&sections).zip(before(&others)).is_some_and(|(a, b)| self.is_known(&a, &b))
                || place::stored_before(one, sections.start).eq(place::stored_before(other, others.start)))
    }

    /// Whether sections are among those that the two programs have in common.
    fn is_known(&self, sections: &Range<usize>, others: &Range<usize>) -> bool {
        let behind = |program: &Program, sections: &Range<usize>| {
            let count = program.sections.len();
            [count - sections.start, count - sections.end]
        };
        let [from, to] = behind(self.programs[0], sections);
        (sections == others && sections.end <= self.same_first)
            || (from <= self.same_last && [from, to] == behind(self.programs[1], others))
    }

    /// Whether sections, which are chunks, consist of the same instructions.
    fn computes_the_same(&self, sections: Range<usize>, others: Range<usize>) -> bool {
        if self.is_known(&sections, &others) {
            return true;
        }
        let [one, other] = self.programs;
        let (a, b) = (one.instruction_range(sections.clone()), other.instruction_range(others.clone()));
        let starts = [a.start, b.start];
        // Which section an instruction belongs to decides which stores are late, and is told with the code.
        let lengths =
            |program: &'a Program, sections: Range<usize>| sections.map(|section| program.section_range(section).len());
        a.len() == b.len()
            && lengths(one, sections).eq(lengths(other, others))
            && one.instructions[a].iter().zip(&other.instructions[b]).all(|(a, b)| self.instructions(*a, *b, starts))
    }

    /// Whether two instructions are the same: their operands are if they are as far from two places.
    #[inline]
    fn instructions(&self, a: Instruction, b: Instruction, [here, there]: [usize; 2]) -> bool {
        // Nearly all, where an edit adds and removes no instruction.
        if here == there && a == b && self.reaches_the_same(a.op) {
            return true;
        }
        let near = |a: ValueId, b: ValueId| a.index() + there == b.index() + here;
        a.ty == b.ty
            && match (a.op, b.op) {
                (Op::Constant(a), Op::Constant(b)) => a == b,
                (Op::Now, Op::Now) => true,
                (Op::Load(a), Op::Load(b)) => self.slots(a, b),
                (Op::Store(to, a), Op::Store(other, b)) => self.slots(to, other) && near(a, b),
                (Op::Unary(op, a), Op::Unary(other, b)) => op == other && near(a, b),
                (Op::Binary(op, a, x), Op::Binary(other, b, y)) => op == other && near(a, b) && near(x, y),
                (Op::Compare(op, a, x), Op::Compare(other, b, y)) => op == other && near(a, b) && near(x, y),
                (Op::Select(a, x, v), Op::Select(b, y, w)) => near(a, b) && near(x, y) && near(v, w),
                (Op::Convert(a), Op::Convert(b)) | (Op::Reinterpret(a), Op::Reinterpret(b)) => near(a, b),
                (Op::Call(helper, a, x), Op::Call(other, b, y)) => {
                    helper == other && near(a, b) && x.zip(y).is_none_or(|(x, y)| near(x, y))
                }
                (Op::LoadIndexed(from, a), Op::LoadIndexed(other, b)) => self.arrays(from, other) && near(a, b),
                (Op::StoreIndexed(to, a, x), Op::StoreIndexed(other, b, y)) => {
                    self.arrays(to, other) && near(a, b) && near(x, y)
                }
                (Op::CopyArray(to, from, a), Op::CopyArray(other, source, b)) => {
                    self.arrays(to, other) && self.arrays(from, source) && near(a, b)
                }
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

    /// Whether an operation of both programs is known to reach the same bytes in them.
    #[inline]
    fn reaches_the_same(&self, op: Op) -> bool {
        match op {
            Op::Load(slot) | Op::Store(slot, _) => slot.0 < self.same_slots,
            Op::LoadIndexed(..) | Op::StoreIndexed(..) | Op::CopyArray(..) => false,
            Op::Constant(_)
            | Op::Now
            | Op::Unary(..)
            | Op::Binary(..)
            | Op::Compare(..)
            | Op::Select(..)
            | Op::Convert(_)
            | Op::Reinterpret(_)
            | Op::Call(..) => true,
        }
    }

    fn slots(&self, a: SlotId, b: SlotId) -> bool {
        let place = |layout: &Layout, slot: SlotId| -> (u32, Elementary) {
            let slot = layout.slot(slot);
            (slot.offset, slot.ty)
        };
        (a == b && a.0 < self.same_slots) || place(&self.programs[0].layout, a) == place(&self.programs[1].layout, b)
    }

    fn arrays(&self, a: ArrayId, b: ArrayId) -> bool {
        let (a, b) = (self.programs[0].layout.array(a), self.programs[1].layout.array(b));
        a.count == b.count && self.slots(a.first, b.first)
    }
}
