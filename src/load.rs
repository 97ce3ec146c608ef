//! Loading: from a program's bytes, in whatever format, to what may run, with all that there is to say about it.
//!
//! The way that the command and an embedding program share. This module must never read a file: bytes come in from
//! the caller.

use crate::check::{Checked, check};
use crate::diagnostic::{Code, Diagnostic, any_error};
use crate::frontend::{self, Parsed, leave_out};
use crate::ladder::Program;
use crate::source::Source;

/// A source that was parsed, with or without errors.
#[derive(Debug)]
pub struct Loaded {
    /// The source.
    pub source: Source,
    /// The program, as far as it could be read.
    pub program: Program,
    /// What was found in it so far.
    pub diagnostics: Vec<Diagnostic>,
}

impl Loaded {
    /// Reads the bytes of a file. What is no text is told in [`Loaded::diagnostics`].
    pub fn decode(name: impl Into<String>, bytes: impl Into<Vec<u8>>) -> Self {
        match Source::decode(name, bytes) {
            Ok(source) => Self::parse(source),
            Err(undecoded) => {
                let (source, problem) = *undecoded;
                // What the parser says of the readable part would only distract.
                Self { diagnostics: vec![problem], ..Self::parse(source) }
            }
        }
    }

    /// Reads a source in the format that its content shows.
    pub fn parse(source: Source) -> Self {
        let Parsed { program, diagnostics } = frontend::parse(&source);
        Self { source, program, diagnostics }
    }

    /// Checks what there is of the program, with everything that there is to say about it. What Rung has not is left out, and
    /// the rest checked; where the front end found other errors, what the rest would mean is guesswork.
    pub fn check(&mut self) -> Option<Checked> {
        if self.diagnostics.iter().any(|found| found.is_error() && found.code != Code::NotSupported) {
            return None;
        }
        self.diagnostics.extend(leave_out(&mut self.program));
        let (checked, found) = check(&self.program);
        self.diagnostics.extend(found);
        checked
    }

    /// The program if it may run: `None` where there is an error among the diagnostics then. With `allow_missing` what
    /// Rung has not is an error no more, but a warning that it is left out.
    pub fn check_to_run(&mut self, allow_missing: bool) -> Option<Checked> {
        let checked = self.check();
        if allow_missing {
            for found in self.diagnostics.iter_mut().filter(|found| found.code == Code::NotSupported) {
                found.code = Code::LeftOut;
            }
        }
        checked.filter(|_| !any_error(&self.diagnostics))
    }
}
