//! Building a program, one instruction after another.
//!
//! The builder keeps values inside chunks and gives each section its origin. It must never simplify anything:
//! that is for the passes.

use std::sync::Arc;

use super::{
    ArrayId, Binary, CHUNK_SECTIONS, Compare, Helper, Instruction, Layout, Op, Origin, Program, Section, SlotId, Task,
    Unary, ValueId,
};
use crate::elementary::{Elementary, Value};

/// Makes one [`Program`].
#[derive(Debug)]
pub struct Builder {
    program: Program,
    chunk_sections: u32,
}

impl Builder {
    /// An empty program over an image.
    pub fn new(name: impl Into<String>, layout: impl Into<Arc<Layout>>) -> Self {
        let program = Program {
            name: name.into(),
            layout: layout.into(),
            origins: Vec::new(),
            sections: Vec::new(),
            tasks: Vec::new(),
            instructions: Vec::new(),
        };
        Self { program, chunk_sections: 0 }
    }

    /// Makes room for so many instructions, where there is as much. Growing step by step would copy them, and hold them
    /// twice at the end.
    pub fn reserve(&mut self, instructions: usize) {
        let _ = self.program.instructions.try_reserve(instructions);
    }

    /// The image that it is built over.
    pub fn layout(&self) -> &Layout {
        &self.program.layout
    }

    /// Ends a section: all instructions since the last one get this origin. Where the chunk is full, values made
    /// so far must not be used after.
    pub fn end_section(&mut self, origin: Origin) {
        let starts_chunk = self.chunk_sections == 0;
        self.chunk_sections = (self.chunk_sections + 1) % CHUNK_SECTIONS;
        let origin_index = index(self.program.origins.len());
        self.program.origins.push(origin);
        let end = index(self.program.instructions.len());
        self.program.sections.push(Section { origin: origin_index, end, starts_chunk });
    }

    /// Ends a task: all sections since the last one are its. With an interval, in nanoseconds, it has a slot of type TIME
    /// for when it is due next. Values made so far must not be used after.
    pub fn end_task(&mut self, name: impl Into<String>, interval: Option<i64>, due: Option<SlotId>) {
        let end = index(self.program.sections.len());
        self.program.tasks.push(Task { name: name.into(), interval, due, end });
        self.chunk_sections = 0;
    }

    /// The finished program. Instructions after the last section's end belong to none and are dropped; sections after the
    /// last task's end, as all are where none was asked for, belong to one more task without an interval.
    pub fn finish(mut self) -> Program {
        let sections = index(self.program.sections.len());
        if self.program.tasks.last().is_none_or(|task| task.end != sections) {
            self.program.tasks.push(Task::always(sections));
        }
        let end = self.program.sections.last().map_or(0, |section| section.end as usize);
        self.program.instructions.truncate(end);
        self.program
    }

    /// The type of a value made before.
    pub fn ty(&self, value: ValueId) -> Elementary {
        self.program.instructions[value.index()].ty
    }

    /// What makes a value made before.
    pub(super) fn op(&self, value: ValueId) -> Op {
        self.program.instructions[value.index()].op
    }

    /// Any instruction.
    pub(super) fn push(&mut self, ty: Elementary, op: Op) -> ValueId {
        let value = ValueId(index(self.program.instructions.len()));
        self.program.instructions.push(Instruction { ty, op });
        value
    }

    /// A constant.
    pub fn constant(&mut self, value: Value) -> ValueId {
        self.push(value.ty(), Op::Constant(value.bits()))
    }

    /// FALSE or TRUE.
    pub fn bool(&mut self, value: bool) -> ValueId {
        self.constant(Value::bool(value))
    }

    /// The latched time, a TIME.
    pub fn now(&mut self) -> ValueId {
        self.push(Elementary::Time, Op::Now)
    }

    /// The value of a slot.
    pub fn load(&mut self, slot: SlotId) -> ValueId {
        let ty = self.program.layout.slot(slot).ty;
        self.push(ty, Op::Load(slot))
    }

    /// Sets a slot.
    pub fn store(&mut self, slot: SlotId, value: ValueId) {
        let ty = self.program.layout.slot(slot).ty;
        self.push(ty, Op::Store(slot, value));
    }

    /// Sets a slot while a condition, if there is one, is TRUE.
    pub fn store_if(&mut self, condition: Option<ValueId>, slot: SlotId, value: ValueId) {
        let value = match condition {
            None => value,
            Some(condition) => {
                let old = self.load(slot);
                self.select(condition, value, old)
            }
        };
        self.store(slot, value);
    }

    /// The element of an array that a LINT names, from 0.
    pub fn load_indexed(&mut self, array: ArrayId, index: ValueId) -> ValueId {
        self.push(self.element_type(array), Op::LoadIndexed(array, index))
    }

    /// Sets the element of an array that a LINT names, from 0.
    pub fn store_indexed(&mut self, array: ArrayId, index: ValueId, value: ValueId) {
        self.push(self.element_type(array), Op::StoreIndexed(array, index, value));
    }

    /// Copies all elements of an array to another of the same type and count, while a condition, if there is one, is
    /// TRUE.
    pub fn copy_array(&mut self, to: ArrayId, from: ArrayId, condition: Option<ValueId>) {
        let condition = condition.unwrap_or_else(|| self.bool(true));
        self.push(self.element_type(to), Op::CopyArray(to, from, condition));
    }

    fn element_type(&self, array: ArrayId) -> Elementary {
        let layout = &self.program.layout;
        layout.slot(layout.array(array).first).ty
    }

    /// An operation on one operand.
    pub fn unary(&mut self, op: Unary, a: ValueId) -> ValueId {
        self.push(self.ty(a), Op::Unary(op, a))
    }

    /// An operation on two operands; the result has the type of the first.
    pub fn binary(&mut self, op: Binary, a: ValueId, b: ValueId) -> ValueId {
        self.push(self.ty(a), Op::Binary(op, a, b))
    }

    /// A comparison.
    pub fn compare(&mut self, op: Compare, a: ValueId, b: ValueId) -> ValueId {
        self.push(Elementary::Bool, Op::Compare(op, a, b))
    }

    /// `a` while `condition` is TRUE, else `b`.
    pub fn select(&mut self, condition: ValueId, a: ValueId, b: ValueId) -> ValueId {
        self.push(self.ty(a), Op::Select(condition, a, b))
    }

    /// `a` as another type.
    pub fn convert(&mut self, a: ValueId, to: Elementary) -> ValueId {
        self.push(to, Op::Convert(a))
    }

    /// The bits of `a` as another type, which is as wide.
    pub fn reinterpret(&mut self, a: ValueId, to: Elementary) -> ValueId {
        self.push(to, Op::Reinterpret(a))
    }

    /// A helper of `a` and, where it takes two operands, `b`, which is of the same type.
    pub fn call(&mut self, helper: Helper, a: ValueId, b: Option<ValueId>) -> ValueId {
        self.push(self.ty(a), Op::Call(helper, a, b))
    }

    /// NOT a.
    pub fn not(&mut self, a: ValueId) -> ValueId {
        self.unary(Unary::Not, a)
    }

    /// a AND b.
    pub fn and(&mut self, a: ValueId, b: ValueId) -> ValueId {
        self.binary(Binary::And, a, b)
    }

    /// a OR b.
    pub fn or(&mut self, a: ValueId, b: ValueId) -> ValueId {
        self.binary(Binary::Or, a, b)
    }
}

/// A count as a 32-bit index. A program of more than 2^32 instructions would need over 90 GB first.
fn index(count: usize) -> u32 {
    u32::try_from(count).unwrap_or(u32::MAX)
}
