//! Tests of checking: one file a theme, on programs that [`build`] makes.

mod addresses;
mod boxes;
mod build;
mod jumps;
mod limits;
mod names;
mod random;
mod room;
mod statements;
mod structure;
mod types;
mod units;
mod values;
mod written;

use super::{Checked, check};
use crate::diagnostic::{Code, Diagnostic};
use crate::ladder::Program;
use build::text_at;

/// What checking finds: each code with the text that it points at, in order of place.
fn findings(program: &Program) -> Vec<(Code, String)> {
    let (checked, diagnostics) = check(program);
    assert_eq!(checked.is_none(), diagnostics.iter().any(Diagnostic::is_error), "{diagnostics:?}");
    diagnostics.iter().map(|diagnostic| (diagnostic.code, text_at(diagnostic.span))).collect()
}

/// The only finding.
fn only(program: &Program) -> Diagnostic {
    let (_, mut diagnostics) = check(program);
    assert_eq!(diagnostics.len(), 1, "{diagnostics:?}");
    diagnostics.remove(0)
}

/// The checked program, about which there is nothing to say.
fn clean(program: &Program) -> Checked {
    let (checked, diagnostics) = check(program);
    assert_eq!(diagnostics, []);
    checked.unwrap()
}

/// Checks each program of a table for one finding: a code and the text that it points at.
fn table(cases: Vec<(Program, Code, &str)>) {
    for (place, (program, code, text)) in cases.into_iter().enumerate() {
        assert_eq!(findings(&program), [(code, text.to_owned())], "case {place}");
    }
}
