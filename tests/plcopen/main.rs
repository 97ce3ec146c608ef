//! The front end for PLCopen XML: every quirk of the format in a small drawing of its own, and hostile files.

mod codesys;
mod declarations;
mod drawing;
mod errors;
mod hostile;
mod networks;
mod size;

use rung::check::check;
use rung::diagnostic::Diagnostic;
use rung::frontend::{self, Parsed, native};
use rung::source::Source;

/// What a file is read as.
fn parse(text: &str) -> Parsed {
    frontend::parse(&Source::new("test.xml", text))
}

/// The native text of a file that has no fault, in reading or in checking.
fn native_text(text: &str) -> String {
    let parsed = parse(text);
    assert_eq!(codes(&parsed.diagnostics), Vec::<String>::new(), "{:#?}", parsed.diagnostics);
    let (_, found) = check(&parsed.program);
    let wrong: Vec<&Diagnostic> = found.iter().filter(|found| found.is_error()).collect();
    let printed = native::print(&parsed.program);
    assert!(wrong.is_empty(), "{printed}\n{wrong:#?}");
    printed
}

/// The rungs of a file that has no fault, each on a line, without `rung`.
fn rungs(text: &str) -> Vec<String> {
    let text = native_text(text);
    let body = text.split_once("\nrung").map_or("", |(_, body)| body);
    body.split("\nrung").map(|rung| rung.split_whitespace().collect::<Vec<_>>().join(" ")).collect()
}

fn codes(diagnostics: &[Diagnostic]) -> Vec<String> {
    diagnostics.iter().map(|diagnostic| diagnostic.code.to_string()).collect()
}
