//! A load of a slot whose value is at hand becomes that value, and a store of what the slot holds goes.
//!
//! Only near: a value that was stored or loaded within the last [`WINDOW`] sections. Farther, values that wait in
//! registers would push each other out to the stack, which costs more than loading again. A load that can be part of
//! the instruction that uses it costs nothing, and back ends make such a one again.

use std::collections::BTreeMap;

use super::rewrite::rewrite;
use crate::logic::{Op, Program, SlotId, ValueId};

/// Sections for which a value is kept.
pub(super) const WINDOW: usize = 6;

/// See the module.
pub(super) fn forward(program: Program) -> Program {
    /// A value that a slot holds, and the last section in which a load becomes it.
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
                known.insert(slot, Known { value, until: place.section + WINDOW });
                Some(value)
            }
            Op::Store(slot, value) if known.get(&slot).is_some_and(|known| known.value == value) => None,
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
