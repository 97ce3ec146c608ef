//! Copying a program with some instructions replaced: what the passes are written with. Keeps origins, sections and
//! chunks.

use crate::elementary::Elementary;
use crate::logic::{Instruction, Op, Program, Unary, ValueId};

/// The program that is being made, and the one that it is made from.
#[derive(Debug)]
pub(super) struct Output {
    instructions: Vec<Instruction>,
    /// The instructions of the program before.
    old: Vec<Instruction>,
    /// By instruction of the program before: what stands for it, so far.
    copies: Vec<Option<ValueId>>,
}

impl Output {
    /// Adds an instruction.
    pub(super) fn emit(&mut self, ty: Elementary, op: Op) -> ValueId {
        // No copy is longer than 2^32 instructions: passes add few, and a program is far shorter.
        let value = ValueId(u32::try_from(self.instructions.len()).unwrap_or(u32::MAX));
        self.instructions.push(Instruction { ty, op });
        value
    }

    /// Adds an instruction as it is; gives its value, if it has one.
    pub(super) fn keep(&mut self, Instruction { ty, op }: Instruction) -> Option<ValueId> {
        let value = self.emit(ty, op);
        op.has_value().then_some(value)
    }

    /// Adds a constant, in register form.
    pub(super) fn constant(&mut self, ty: Elementary, bits: u64) -> ValueId {
        self.emit(ty, Op::Constant(bits))
    }

    /// Adds the inverse of a BOOL, or finds it.
    pub(super) fn not(&mut self, value: ValueId) -> ValueId {
        match self.op(value) {
            Op::Unary(Unary::Not, inner) => inner,
            Op::Constant(bits) => self.constant(Elementary::Bool, bits ^ 1),
            _ => self.emit(Elementary::Bool, Op::Unary(Unary::Not, value)),
        }
    }

    /// What defines a value of the output.
    pub(super) fn op(&self, value: ValueId) -> Op {
        self.instructions[value.index()].op
    }

    /// The type of a value of the output.
    pub(super) fn ty(&self, value: ValueId) -> Elementary {
        self.instructions[value.index()].ty
    }

    /// The constant that a value of the output is.
    pub(super) fn constant_of(&self, value: ValueId) -> Option<u64> {
        if let Op::Constant(bits) = self.op(value) { Some(bits) } else { None }
    }

    /// The instructions of the program before.
    pub(super) fn old(&self) -> &[Instruction] {
        &self.old
    }

    /// An instruction of the program before with the operands that it has in the copy. `None` where one of them has no
    /// copy: a pass knew it to be unused, and so is this.
    pub(super) fn mapped(&self, index: usize) -> Option<Instruction> {
        let Instruction { ty, op } = self.old[index];
        let mut complete = true;
        let op = op.map_operands(|operand| {
            let copy = self.copies[operand.index()];
            complete &= copy.is_some();
            copy.unwrap_or(operand)
        });
        complete.then_some(Instruction { ty, op })
    }

    /// What stands for a value of the program before, once it has a copy.
    pub(super) fn copy(&self, old: ValueId) -> Option<ValueId> {
        self.copies[old.index()]
    }
}

/// Where in a program an instruction stands.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place {
    /// Its index in the old program.
    pub(super) index: usize,
    /// Its section.
    pub(super) section: usize,
    /// Where that starts, and one past its end.
    pub(super) start: usize,
    pub(super) end: usize,
    /// Its chunk.
    pub(super) chunk: usize,
}

/// Copies a program. For every instruction, with its operands already those of the copy, `visit` gives what stands
/// for it there, having added what it wants; `None` where nothing does, as for stores and for what nobody uses.
pub(super) fn rewrite(
    program: Program,
    mut visit: impl FnMut(&mut Output, Place, Instruction) -> Option<ValueId>,
) -> Program {
    rewrite_raw(program, |output, place| {
        output.mapped(place.index).and_then(|instruction| visit(output, place, instruction))
    })
}

/// The same for passes that look at the program before: see [`Output::old`], [`Output::mapped`].
pub(super) fn rewrite_raw(
    mut program: Program,
    mut visit: impl FnMut(&mut Output, Place) -> Option<ValueId>,
) -> Program {
    let old = std::mem::take(&mut program.instructions);
    let copies = vec![None; old.len()];
    let mut output = Output { instructions: Vec::with_capacity(old.len()), old, copies };
    let (mut start, mut chunk) = (0, 0);
    for (section, part) in program.sections.iter_mut().enumerate() {
        let end = part.end as usize;
        chunk += usize::from(part.starts_chunk);
        for index in start..end {
            output.copies[index] = visit(&mut output, Place { index, section, start, end, chunk });
        }
        start = end;
        part.end = u32::try_from(output.instructions.len()).unwrap_or(u32::MAX);
    }
    program.instructions = output.instructions;
    program
}
