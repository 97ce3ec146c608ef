//! Structured Text (IEC 61131-3, 7.3), as other tools write it: whole files, and the bodies of units in files of other formats.
//! `docs/structured-text.md` says what of it is read and written.
//!
//! [`parse`] reads a file, [`body`] the statements of one unit, and [`print()`] writes any program for other IEC compilers. Syntax
//! only, with one exception: a call with EN gives the default of the target's type while it is off, so that the type of that
//! target is looked up among the declarations.

mod body;
mod configuration;
mod declarations;
mod enable;
mod parser;
mod place;
pub(in crate::frontend) mod print;
mod recognise;

pub use body::{Body, Scope, body};
pub use print::print;
pub use recognise::recognises;

use super::Parsed;
use super::text::MOST_TOKENS;
use crate::ladder::Program;
use crate::source::Source;

/// Reads a file of structured text. After a syntax error it goes on at the next statement, declaration or unit, and the program
/// holds the others.
pub fn parse(source: &Source) -> Parsed {
    parser::Parser::new(source, MOST_TOKENS).program()
}

/// As [`parse`], for a format that has its types, globals, tasks and program instances elsewhere: `around` holds them.
pub(super) fn parse_within(source: &Source, around: Program) -> Parsed {
    let mut parser = parser::Parser::new(source, MOST_TOKENS);
    parser.program = Program { name: parser.program.name, ..around };
    parser.program()
}
