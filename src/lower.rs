//! Lowering: from a checked program to one straight-line scan of logic.
use crate::check::Checked;
use crate::logic::Program;
use crate::logic::image::{EarlierLayout, ImageTooLarge};
use crate::source::Source;

/// Lowers a checked program; slots that an earlier layout has keep their offsets.
///
/// # Errors
/// [`ImageTooLarge`]
pub fn lower(_checked: &Checked, _source: &Source, _earlier: Option<&EarlierLayout>) -> Result<Program, ImageTooLarge> {
    unimplemented!()
}
