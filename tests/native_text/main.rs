//! The native text from outside: what each construct means, what each mistake is called, that printing loses
//! nothing, and that no bytes do harm.

mod comments;
mod constructs;
mod errors;
mod hostile;
mod random_program;
mod round_trip;

use rung::diagnostic::Diagnostic;
use rung::frontend::native;
use rung::ladder::{Program, UnitKind};
use rung::source::Source;

/// Parses a text under the name `test.rung`.
fn parse(text: &str) -> (Program, Vec<Diagnostic>) {
    let parsed = native::parse(&Source::new("test.rung", text));
    (parsed.program, parsed.diagnostics)
}

/// Parses a text that has no errors.
fn parse_well(text: &str) -> Program {
    let (program, diagnostics) = parse(text);
    assert_eq!(diagnostics, [], "in\n{text:.5000}");
    program
}

/// A program with everything but its spans, to compare by: its debug form with each `1..2` taken out.
fn without_spans(program: &Program) -> String {
    let debug = format!("{program:?}");
    let mut result = String::with_capacity(debug.len());
    let mut rest = debug.as_str();
    while let Some(dots) = rest.find("..") {
        let is_digit = |c: char| c.is_ascii_digit();
        let before = rest[..dots].trim_end_matches(is_digit).len();
        let after = rest[dots + 2..].trim_start_matches(is_digit);
        result.push_str(&rest[..before]);
        rest = after;
    }
    result.push_str(rest);
    result
}

/// Prints a program, and checks that the text gives the same program and prints as itself.
fn print_and_check(program: &Program) -> String {
    let text = native::print(program);
    assert!(text.lines().all(|line| !line.ends_with(' ')), "blanks at the end of a line in\n{text}");
    let mut again = parse_well(&text);
    if again.units.iter().filter(|unit| matches!(unit.kind, UnitKind::Program { .. })).count() != 1 {
        // Its name is that of the file, which the text does not have.
        again.name = program.name.clone();
    }
    assert_eq!(without_spans(program), without_spans(&again), "printed as\n{text}");
    assert_eq!(native::print(&again), text);
    text
}
