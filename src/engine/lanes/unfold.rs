//! Timers that move their start along with the time while they are idle, written the other way round.
//!
//! `now - select(c, start, now)` is `select(c, now - start, 0)`, and to compare that with a constant is to compare
//! `now - start` with it while `c` is TRUE, and 0 otherwise, of which the answer is known. So the differences and questions
//! that [`recognise`](super::recognise) knows come to light. Every value that is left has the value that it had.

use crate::elementary::Elementary;
use crate::logic::{Binary, Compare, Instruction, Op, Program, Unary, ValueId, evaluate};

/// See the module.
pub(super) fn unfold(program: &Program) -> Program {
    let mut unfolded = Program { instructions: Vec::with_capacity(program.instructions.len()), ..program.clone() };
    let mut copies: Vec<ValueId> = Vec::with_capacity(program.instructions.len());
    let mut output = Output { instructions: &mut unfolded.instructions };
    for section in 0..program.sections.len() {
        for index in program.section_range(section) {
            let Instruction { ty, op } = program.instructions[index];
            let op = op.map_operands(|operand| copies[operand.index()]);
            let copy = output.difference(ty, op).or_else(|| output.question(op));
            copies.push(copy.unwrap_or_else(|| output.emit(ty, op)));
        }
        unfolded.sections[section].end = u32::try_from(output.instructions.len()).unwrap_or(u32::MAX);
    }
    unfolded
}

struct Output<'a> {
    instructions: &'a mut Vec<Instruction>,
}

impl Output<'_> {
    fn emit(&mut self, ty: Elementary, op: Op) -> ValueId {
        let value = ValueId(u32::try_from(self.instructions.len()).unwrap_or(u32::MAX));
        self.instructions.push(Instruction { ty, op });
        value
    }

    fn op(&self, value: ValueId) -> Op {
        self.instructions[value.index()].op
    }

    /// The time minus a start that is the time itself unless a condition holds.
    fn difference(&mut self, ty: Elementary, op: Op) -> Option<ValueId> {
        let Op::Binary(Binary::Subtract, now, start) = op else { return None };
        let Op::Select(condition, kept, moved) = self.op(start) else { return None };
        let (Op::Now, Op::Now, Op::Load(_)) = (self.op(now), self.op(moved), self.op(kept)) else { return None };
        let since = self.emit(ty, Op::Binary(Binary::Subtract, now, kept));
        let zero = self.emit(ty, Op::Constant(0));
        Some(self.emit(ty, Op::Select(condition, since, zero)))
    }

    /// Such a difference compared with a constant.
    fn question(&mut self, op: Op) -> Option<ValueId> {
        let Op::Compare(compare, elapsed, preset) = op else { return None };
        let Op::Constant(bits) = self.op(preset) else { return None };
        let Op::Select(condition, since, zero) = self.op(elapsed) else { return None };
        let (Op::Binary(Binary::Subtract, now, _), Op::Constant(0)) = (self.op(since), self.op(zero)) else {
            return None;
        };
        let Op::Now = self.op(now) else { return None };
        Some(self.either(compare, condition, since, preset, bits))
    }

    fn either(&mut self, compare: Compare, condition: ValueId, since: ValueId, preset: ValueId, bits: u64) -> ValueId {
        let holds = self.emit(Elementary::Bool, Op::Compare(compare, since, preset));
        if evaluate::compare(compare, Elementary::Time, 0, bits) {
            let idle = self.emit(Elementary::Bool, Op::Unary(Unary::Not, condition));
            self.emit(Elementary::Bool, Op::Binary(Binary::Or, holds, idle))
        } else {
            self.emit(Elementary::Bool, Op::Binary(Binary::And, condition, holds))
        }
    }
}
