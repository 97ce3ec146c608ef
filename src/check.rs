//! Checking: from the program as drawn to a program that runs, or to all that keeps it from running.
//!
//! Names, types, addresses and structure are resolved here and nowhere later. Checking must never stop at the
//! first error, and must never change what a program means.

mod model;

pub use model::{
    Branch, Call, Checked, Circuit, Element, Expression, ExpressionKind, Input, NodeId, PinId, Place, Rung, Type,
    Variable, VariableId, Wire,
};

use crate::diagnostic::Diagnostic;
use crate::ladder::Program;

/// Checks a program: the checked program where there is no error, and everything there is to say about it.
pub fn check(_program: &Program) -> (Option<Checked>, Vec<Diagnostic>) {
    unimplemented!()
}
