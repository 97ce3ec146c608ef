//! A load of a slot whose value is at hand becomes that value.
//!
//! Only near: a value that was stored within the last [`WINDOW`] sections, or loaded in this one. Farther, values
//! that wait in registers would push each other out to the stack, which costs more than loading again.

use std::collections::BTreeMap;

use super::rewrite::rewrite;
use crate::logic::{Op, Program, SlotId, ValueId};

/// Sections for which a stored value is kept.
const WINDOW: usize = 6;

/// See the module.
pub(super) fn forward(program: Program) -> Program {
    /// A value that a slot holds, and the last section in which it is used for that.
    struct Known {
        value: ValueId,
        until: usize,
    }
    let mut known: BTreeMap<SlotId, Known> = BTreeMap::new();
    let mut chunk = None;
    let arrays = program.layout.arrays().to_vec();
    rewrite(program, |output, place, instruction| {
        if chunk.replace(place.chunk) != Some(place.chunk) {
            known.clear();
        }
        match instruction.op {
            Op::Load(slot) => {
                if let Some(known) = known.get(&slot).filter(|known| place.section <= known.until) {
                    return Some(known.value);
                }
                let value = output.emit(instruction.ty, instruction.op);
                known.insert(slot, Known { value, until: place.section });
                Some(value)
            }
            Op::Store(slot, value) => {
                known.insert(slot, Known { value, until: place.section + WINDOW });
                output.keep(instruction)
            }
            Op::StoreIndexed(array, ..) | Op::CopyArray(array, ..) => {
                // Any of its elements may be another now.
                let slots: Vec<SlotId> = known.range(arrays[array.index()].slots()).map(|(slot, _)| *slot).collect();
                slots.iter().for_each(|slot| {
                    known.remove(slot);
                });
                output.keep(instruction)
            }
            Op::Constant(_)
            | Op::Now
            | Op::Unary(..)
            | Op::Binary(..)
            | Op::Compare(..)
            | Op::Select(..)
            | Op::Convert(_)
            | Op::Reinterpret(_)
            | Op::Call(..)
            | Op::LoadIndexed(..) => output.keep(instruction),
        }
    })
}
