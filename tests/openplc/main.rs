//! The front end for OpenPLC Editor 4: every quirk of the format in a small drawing of its own, projects, and
//! hostile files.

mod bodies;
mod drawing;
mod errors;
mod hostile;
mod projects;

use rung::check::check;
use rung::diagnostic::Diagnostic;
use rung::frontend::{self, Parsed, native};
use rung::source::Source;

/// What a file is read as.
fn parse(text: &str) -> Parsed {
    frontend::parse(&Source::new("main.ld", text))
}

/// The rungs of a program that has no fault, in reading or in checking, each on a line, without `rung`.
fn rungs_of(parsed: &Parsed) -> Vec<String> {
    assert_eq!(codes(&parsed.diagnostics), Vec::<String>::new(), "{:#?}", parsed.diagnostics);
    let (_, found) = check(&parsed.program);
    let wrong: Vec<&Diagnostic> = found.iter().filter(|found| found.is_error()).collect();
    let printed = native::print(&parsed.program);
    assert!(wrong.is_empty(), "{printed}\n{wrong:#?}");
    let body = printed.split_once("\nrung").map_or("", |(_, body)| body);
    body.split("\nrung").map(|rung| rung.split_whitespace().collect::<Vec<_>>().join(" ")).collect()
}

/// The rungs of a file that has no fault.
fn rungs(text: &str) -> Vec<String> {
    rungs_of(&parse(text))
}

fn codes(diagnostics: &[Diagnostic]) -> Vec<String> {
    diagnostics.iter().map(|diagnostic| diagnostic.code.to_string()).collect()
}
