//! The image laid out by use: slots that rungs use near each other lie near each other.
//!
//! Code is shorter and fewer cache lines are touched when what a run of rungs uses lies within short reach of a few
//! pointers. So each slot comes where the program first stores it, or first loads it if no rung stores it: a coil near
//! the coils of its neighbours, and so the states of a block and the members of an instance. What no rung uses comes last.

use std::sync::Arc;

use crate::logic::image::{EarlierLayout, ImageTooLarge};
use crate::logic::{ArrayId, Op, Program, SlotId};

/// Gives the slots of a lowered program their places anew.
///
/// # Errors
/// [`ImageTooLarge`], as far as padding now makes the difference.
pub(super) fn by_use(mut program: Program, earlier: Option<&EarlierLayout>) -> Result<Program, ImageTooLarge> {
    let ranks = ranks(&program);
    program.layout = Arc::new(Arc::unwrap_or_clone(program.layout).by_use(earlier, &ranks)?);
    Ok(program)
}

/// By slot: the place of the instruction for whose sake it lies where it does.
fn ranks(program: &Program) -> Vec<u32> {
    let count = program.layout.slots().len();
    let (mut stored, mut loaded) = (vec![u32::MAX; count], vec![u32::MAX; count]);
    let first = |array: ArrayId| program.layout.array(array).first;
    let note = |places: &mut [u32], slot: SlotId, place: u32| {
        let noted = &mut places[slot.index()];
        *noted = place.min(*noted);
    };
    for (place, instruction) in (0..).zip(&program.instructions) {
        match instruction.op {
            Op::Load(slot) => note(&mut loaded, slot, place),
            Op::Store(slot, _) => note(&mut stored, slot, place),
            Op::LoadIndexed(array, _) => note(&mut loaded, first(array), place),
            Op::StoreIndexed(array, ..) => note(&mut stored, first(array), place),
            Op::CopyArray(to, from, _) => {
                note(&mut stored, first(to), place);
                note(&mut loaded, first(from), place);
            }
            Op::Constant(_)
            | Op::Now
            | Op::Unary(..)
            | Op::Binary(..)
            | Op::Compare(..)
            | Op::Select(..)
            | Op::Convert(_)
            | Op::Reinterpret(_)
            | Op::Call(..) => {}
        }
    }
    stored.into_iter().zip(loaded).map(|(stored, loaded)| if stored == u32::MAX { loaded } else { stored }).collect()
}
