//! Programs written in the native text, where building them by hand would hide what they are.

use super::{Checked, Code, check};
use crate::diagnostic::Diagnostic;
use crate::frontend::native;
use crate::ladder::{Origin, Program};
use crate::source::Source;

fn parsed(text: &str) -> (Source, Program) {
    // No rung has a name here, so that its circuit may stand on its line.
    let source = Source::new("test.rung", text.replace("rung ", "rung\n"));
    let parsed = native::parse(&source);
    assert_eq!(parsed.diagnostics, [], "{text}");
    (source, parsed.program)
}

fn found_in(text: &str, origin: Origin) -> Vec<(Code, String)> {
    let (source, program) = parsed(text);
    let (checked, diagnostics) = check(&Program { origin, ..program });
    assert_eq!(checked.is_none(), diagnostics.iter().any(Diagnostic::is_error), "{diagnostics:?}");
    diagnostics.iter().map(|found| (found.code, source.text()[found.span.range()].to_owned())).collect()
}

/// What checking finds: each code with the text that it points at, in order of place.
pub(super) fn found(text: &str) -> Vec<(Code, String)> {
    found_in(text, Origin::Native)
}

/// The same of a program of another tool.
pub(super) fn found_imported(text: &str) -> Vec<(Code, String)> {
    found_in(text, Origin::Imported)
}

/// All diagnostics.
pub(super) fn diagnostics(text: &str) -> Vec<Diagnostic> {
    check(&parsed(text).1).1
}

/// The checked program, about which there is nothing to say.
pub(super) fn clean(text: &str) -> Checked {
    let (checked, diagnostics) = check(&parsed(text).1);
    assert_eq!(diagnostics, [], "{text}");
    checked.unwrap()
}

/// The checked program of another tool, about which there is nothing to say.
pub(super) fn clean_imported(text: &str) -> Checked {
    let program = Program { origin: Origin::Imported, ..parsed(text).1 };
    let (checked, diagnostics) = check(&program);
    assert_eq!(diagnostics, [], "{text}");
    checked.unwrap()
}

/// Checks each of a list of texts, put behind what they have in common, for its only finding.
pub(super) fn each(before: &str, cases: &[(&str, Code, &str)]) {
    for (text, code, place) in cases {
        assert_eq!(found(&format!("{before}{text}\n")), [(*code, (*place).to_owned())], "{text}");
    }
}
