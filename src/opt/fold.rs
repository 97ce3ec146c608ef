//! Operations on constants are computed, and an element whose index is a constant is its slot.
//!
//! First of the passes, since a load or store of a slot tells the others far more than one of any element.

use super::rewrite::{Output, rewrite};
use crate::logic::{Array, ArrayId, Instruction, Op, Program, SlotId, ValueId, evaluate};

/// See the module.
pub(super) fn fold(program: Program) -> Program {
    let arrays = program.layout.arrays().to_vec();
    rewrite(program, |output, _, instruction| {
        folded(output, &arrays, instruction).unwrap_or_else(|| output.keep(instruction))
    })
}

/// What stands for an operation whose operands are constants as far as they count; of a store it is nothing. `None` where
/// the operation has to stay.
pub(super) fn folded(output: &mut Output, arrays: &[Array], instruction: Instruction) -> Option<Option<ValueId>> {
    let Instruction { ty, op } = instruction;
    let constant = |value| output.constant_of(value);
    let slot = |array: ArrayId, index| {
        let Array { first, count } = arrays[array.index()];
        evaluate::element(count, index).map(|element| SlotId(first.0 + element))
    };
    let bits = match op {
        Op::Constant(_) | Op::Now | Op::Load(_) | Op::Store(..) => return None,
        Op::Unary(op, a) => evaluate::unary(op, ty, constant(a)?),
        Op::Binary(op, a, b) => evaluate::binary(op, ty, constant(a)?, constant(b)?),
        Op::Compare(op, a, b) => u64::from(evaluate::compare(op, output.ty(a), constant(a)?, constant(b)?)),
        Op::Select(condition, a, b) => return Some(Some(if constant(condition)? != 0 { a } else { b })),
        Op::Convert(a) => evaluate::convert(output.ty(a), ty, constant(a)?),
        Op::Reinterpret(a) => evaluate::reinterpret(ty, constant(a)?),
        Op::Call(helper, a, None) => evaluate::call(helper, ty, constant(a)?, None),
        Op::Call(helper, a, Some(b)) => evaluate::call(helper, ty, constant(a)?, Some(constant(b)?)),
        Op::LoadIndexed(array, index) => match slot(array, constant(index)?) {
            Some(slot) => return Some(output.keep(Instruction { ty, op: Op::Load(slot) })),
            None => 0,
        },
        Op::StoreIndexed(array, index, value) => {
            let slot = slot(array, constant(index)?);
            return Some(slot.and_then(|slot| output.keep(Instruction { ty, op: Op::Store(slot, value) })));
        }
        Op::CopyArray(to, from, condition) => {
            let (to, from) = (arrays[to.index()], arrays[from.index()]);
            return (to == from || constant(condition)? == 0).then_some(None);
        }
    };
    Some(Some(output.constant(ty, bits)))
}
