//! What is said about a file: at most so much, and what is not supported once per kind.

use std::collections::HashMap;

use super::expression::Fault;
use crate::diagnostic::{Code, Diagnostic};
use crate::frontend::native::MOST_DIAGNOSTICS;
use crate::source::Span;

/// The diagnostics so far.
#[derive(Default)]
pub(in crate::frontend) struct Report {
    diagnostics: Vec<Diagnostic>,
    /// How many were left out.
    more: usize,
    /// Kinds of what is not supported, in order of their first places, each with its count.
    missing: Vec<(String, Span, usize)>,
    places: HashMap<String, usize>,
}

impl Report {
    /// Takes a diagnostic down.
    pub(in crate::frontend) fn push(&mut self, problem: Diagnostic) {
        if self.diagnostics.len() < MOST_DIAGNOSTICS {
            self.diagnostics.push(problem);
        } else {
            self.more += 1;
        }
    }

    /// Takes a diagnostic down.
    pub(in crate::frontend) fn error(&mut self, code: Code, span: Span, message: impl Into<String>) {
        self.push(Diagnostic::new(code, span, message));
    }

    /// Counts a use of something that Rung has not.
    pub(in crate::frontend) fn not_supported(&mut self, kind: impl Into<String>, span: Span) {
        let kind = kind.into();
        if let Some(place) = self.places.get(&kind) {
            self.missing[*place].2 += 1;
        } else if self.missing.len() < MOST_DIAGNOSTICS {
            self.places.insert(kind.clone(), self.missing.len());
            self.missing.push((kind, span, 1));
        }
    }

    /// Says why an expression at a place cannot be read.
    pub(in crate::frontend) fn fault(&mut self, fault: Fault, span: Span) {
        match fault {
            Fault::Bad(message) => self.error(Code::BadLiteral, span, message),
            Fault::NotSupported(kind) => self.not_supported(kind, span),
        }
    }

    /// What was read, or nothing where it could not be read, which is then said.
    pub(in crate::frontend) fn read<T>(&mut self, result: Result<T, Fault>, span: Span) -> Option<T> {
        result.map_err(|fault| self.fault(fault, span)).ok()
    }

    /// Whether nothing was said so far.
    pub(in crate::frontend) fn is_empty(&self) -> bool {
        self.diagnostics.is_empty() && self.missing.is_empty()
    }

    /// All diagnostics.
    pub(in crate::frontend) fn finish(mut self) -> Vec<Diagnostic> {
        for (kind, span, count) in self.missing {
            let times = if count == 1 { "once".to_owned() } else { format!("{count} times, first") };
            let message = format!("Rung has no {kind}: used {times} here");
            self.diagnostics.push(Diagnostic::new(Code::NotSupported, span, message));
        }
        if self.more > 0 {
            let message = format!("there are {} more errors", self.more);
            self.diagnostics.push(Diagnostic::new(Code::TooManyDiagnostics, Span::default(), message));
        }
        self.diagnostics
    }
}
