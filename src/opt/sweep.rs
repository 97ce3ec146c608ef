//! What nobody sees is removed: values without a use, and stores that are overwritten in their own chunk before anything
//! loads the slot. So of several coils of a variable only the last is stored, unless a rung between reads it.
//!
//! Nobody looks at the image while a task runs. But a chunk ends what is known: that a later one stores a slot again must
//! not be part of this one's code, or they could not be replaced one by one.

use std::collections::BTreeSet;
use std::ops::Range;

use super::rewrite::rewrite;
use crate::logic::{Op, Program, SlotId};

/// See the module.
pub(super) fn sweep(program: Program) -> Program {
    let mut needed = vec![false; program.instructions.len()];
    // Slots that this chunk stores, later than where we are and with no load between.
    let mut overwritten = BTreeSet::new();
    for section in (0..program.sections.len()).rev() {
        for index in program.section_range(section).rev() {
            match program.instructions[index].op {
                Op::Store(slot, _) => needed[index] = overwritten.insert(slot),
                Op::Load(slot) if needed[index] => {
                    overwritten.remove(&slot);
                }
                Op::StoreIndexed(..) => needed[index] = true,
                Op::CopyArray(_, from, _) => {
                    needed[index] = true;
                    remove(&mut overwritten, program.layout.array(from).slots());
                }
                Op::LoadIndexed(array, _) if needed[index] => {
                    remove(&mut overwritten, program.layout.array(array).slots());
                }
                Op::Constant(_)
                | Op::Now
                | Op::Load(_)
                | Op::Unary(..)
                | Op::Binary(..)
                | Op::Compare(..)
                | Op::Select(..)
                | Op::Convert(_)
                | Op::Reinterpret(_)
                | Op::Call(..)
                | Op::LoadIndexed(..) => {}
            }
            if needed[index] {
                program.instructions[index].op.operands().for_each(|operand| needed[operand.index()] = true);
            }
        }
        if program.sections[section].starts_chunk {
            overwritten.clear();
        }
    }
    rewrite(program, |output, place, instruction| {
        needed[place.index].then(|| output.emit(instruction.ty, instruction.op))
    })
}

/// Takes out the slots of a range, in time that grows with those that are there.
fn remove(slots: &mut BTreeSet<SlotId>, range: Range<SlotId>) {
    let gone: Vec<SlotId> = slots.range(range).copied().collect();
    gone.iter().for_each(|slot| {
        slots.remove(slot);
    });
}
