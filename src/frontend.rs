//! Front ends: from the bytes of a file to a [`Program`] and what is to be said about it.
//!
//! One module a format. A front end is pure, and must never panic: whatever the bytes, the answer is a program,
//! as far as one could be made out, and diagnostics. The format is found by content, never by the file's name.

mod events;
mod global_lists;
mod graph;
mod instances;
mod leave_out;
mod located;
mod missing;
pub mod native;
pub mod openplc;
mod other_names;
pub mod plcopen;
mod rewrite;
pub mod structured_text;
mod text;
mod uses;

pub use leave_out::leave_out;

use crate::diagnostic::Diagnostic;
use crate::ladder::Program;
use crate::source::Source;

/// What a front end made of a source.
#[derive(Debug)]
pub struct Parsed {
    /// The program as far as it could be read.
    pub program: Program,
    /// What is to be said about it; with an error among them the program is incomplete.
    pub diagnostics: Vec<Diagnostic>,
}

/// A format that Rung reads.
pub struct Frontend {
    /// Its name, as the manual has it.
    pub name: &'static str,
    /// Whether a text looks like this format. It must be quick: it reads no further than it must.
    pub recognises: fn(&str) -> bool,
    /// Reads a source.
    pub parse: fn(&Source) -> Parsed,
}

/// The formats, the most particular first. The native text comes last and takes whatever the others leave.
pub const FRONTENDS: &[Frontend] = &[
    Frontend { name: "PLCopen XML", recognises: plcopen::recognises, parse: plcopen::parse },
    Frontend { name: "OpenPLC Editor 4", recognises: openplc::recognises, parse: openplc::parse },
    Frontend { name: "Structured Text", recognises: structured_text::recognises, parse: structured_text::parse },
    Frontend { name: "Rung text", recognises: |_| true, parse: native::parse },
];

/// Reads a source in the format that its content shows.
pub fn parse(source: &Source) -> Parsed {
    let found = FRONTENDS.iter().find(|frontend| (frontend.recognises)(source.text()));
    let mut parsed = (found.map_or(native::parse as fn(&Source) -> Parsed, |frontend| frontend.parse))(source);
    other_names::settle(&mut parsed.program);
    parsed
}

/// Whether a text looks like native text: like none of the other formats.
pub fn is_native(text: &str) -> bool {
    FRONTENDS.split_last().is_none_or(|(_, others)| !others.iter().any(|frontend| (frontend.recognises)(text)))
}
