//! Lowering: from a checked program to one straight-line scan of logic.
//!
//! `slots` gives every variable, pin and memory its slot; `network` and `expression` turn the rungs into
//! primitives, element by element in the order of the drawing; `blocks` has each function block's rule, `functions` each
//! function's; `jump` keeps what a jump leaves out from having an effect. The code that comes out is naive on purpose:
//! nothing here may simplify or reorder, that is for the passes.

mod blocks;
mod expression;
mod functions;
mod jump;
mod network;
mod slots;

use jump::Jumps;

use crate::check::{Checked, RungIndex};
use crate::logic::image::{EarlierLayout, ImageTooLarge};
use crate::logic::{Builder, Origin, Program};
use crate::source::{Source, Span};

/// Lowers a checked program; slots that an earlier layout has keep their offsets.
///
/// # Errors
/// [`ImageTooLarge`] when the variables and memories do not fit an image.
pub fn lower(checked: &Checked, source: &Source, earlier: Option<&EarlierLayout>) -> Result<Program, ImageTooLarge> {
    let line = |span: Span| u32::try_from(source.line(span.start)).unwrap_or(0);
    let (slots, layout) = slots::allocate(checked, line, earlier)?;
    let mut lowering = Lowering {
        logic: Builder::new(checked.name(), layout),
        edges: slots.edges.iter(),
        slots: &slots,
        jumps: Jumps::default(),
        end: RungIndex(u32::try_from(checked.units()[0].rungs.len()).unwrap_or(u32::MAX)),
    };
    for (index, rung) in (0..).zip(&checked.units()[0].rungs) {
        lowering.land(RungIndex(index));
        lowering.rung(rung);
        lowering.logic.end_section(Origin { label: rung.label.clone(), line: line(rung.span) });
    }
    Ok(lowering.logic.finish())
}

/// The state of lowering one program.
struct Lowering<'a> {
    logic: Builder,
    slots: &'a slots::Slots,
    /// The memories of the edge contacts and edge coils that are still to come, in the order of the drawing.
    edges: std::slice::Iter<'a, crate::logic::SlotId>,
    jumps: Jumps,
    /// Behind the last rung.
    end: RungIndex,
}
