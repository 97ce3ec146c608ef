//! Programs that are too deep, too faulty, or shaped as no front end would.

use super::build::*;
use super::*;
use crate::check::{MAXIMUM_DEPTH, MOST_REPORTED};
use crate::ladder::{Circuit, Element, ElementKind, Expression};

/// A circuit of as many circuits in each other, the innermost with a contact.
fn nested(depth: usize) -> Circuit {
    let innermost = circuit(vec![branch(vec![open("_a")])]);
    (1..depth).fold(innermost, |inner, _| {
        let element = Element { span: inner.span, kind: ElementKind::Parallel(inner) };
        circuit(vec![branch(vec![element])])
    })
}

fn negated(depth: usize) -> Expression {
    (1..depth).fold(read("_a"), |inner, _| not(inner))
}

fn in_rung(circuit: Circuit) -> Program {
    let mut rung = rung(vec![]);
    rung.circuit = circuit;
    program(vec![memory("_a", "BOOL")], vec![rung])
}

fn codes(program: &Program) -> Vec<Code> {
    check(program).1.iter().map(|found| found.code).collect()
}

#[test]
fn circuits_nest_up_to_the_limit() {
    // Beside the contact's own expression.
    assert_eq!(codes(&in_rung(nested(MAXIMUM_DEPTH - 1))), [Code::EmptyRung]);
    assert_eq!(codes(&in_rung(nested(MAXIMUM_DEPTH))), [Code::TooDeep]);
    assert_eq!(codes(&in_rung(nested(5_000))), [Code::TooDeep]);
}

#[test]
fn expressions_nest_up_to_the_limit() {
    let of = |depth| program(vec![memory("_a", "BOOL")], vec![rung(vec![assign("_a", negated(depth))])]);
    assert_eq!(codes(&of(MAXIMUM_DEPTH - 1)), []);
    assert_eq!(codes(&of(MAXIMUM_DEPTH)), [Code::TooDeep]);
    let declared = program(vec![memory("_a", "BOOL"), memory("_b", "BOOL").starting(negated(3_000))], vec![]);
    assert_eq!(codes(&declared), [Code::TooDeep]);
}

#[test]
fn calls_nest_up_to_the_limit() {
    let of = |depth| {
        let innermost = vec![open("_a")];
        let element = |inner, at| vec![call(&format!("t{at}:TON"), vec![wired("IN", inner)])];
        program(vec![memory("_a", "BOOL")], vec![rung((2..depth).fold(innermost, element))])
    };
    assert_eq!(codes(&of(MAXIMUM_DEPTH)), []);
    assert_eq!(codes(&of(MAXIMUM_DEPTH + 1)), [Code::TooDeep]);
}

#[test]
fn errors_and_warnings_past_the_limit_are_counted() {
    let variables = (0..MOST_REPORTED + 5).map(|at| memory(&format!("v{at}"), "BOOL")).collect();
    let (checked, diagnostics) = check(&program(variables, vec![]));
    assert!(checked.is_some());
    let last = diagnostics.last().map(|found| (found.code, found.message.as_str()));
    let expected = (Code::TooManyWarnings, "5 more warnings from here on are not listed");
    assert_eq!((diagnostics.len(), last), (MOST_REPORTED + 1, Some(expected)));

    let rungs = (0..MOST_REPORTED + 2).map(|at| rung(vec![coil(&format!("v{at}"))])).collect();
    let (checked, diagnostics) = check(&program(vec![], rungs));
    assert!(checked.is_none());
    let last = diagnostics.last().map(|found| (found.code, found.message.as_str()));
    let expected = (Code::TooManyDiagnostics, "2 more errors from here on are not listed");
    assert_eq!((diagnostics.len(), last), (MOST_REPORTED + 1, Some(expected)));
}

#[test]
fn a_long_name_is_not_repeated_in_full_where_it_is_not_written() {
    let long = "n".repeat(1_000_000);
    let found = only(&program(vec![input(&long).at("%IX0.0")], vec![rung(vec![coil("%IX0.0")])]));
    assert_eq!(found.message, format!("`{}…` is an input", "n".repeat(80)));
}

#[test]
fn an_empty_program_runs() {
    let checked = clean(&program(vec![], vec![]));
    assert_eq!((checked.name(), checked.variables().len(), checked.units()[0].rungs.len()), ("test", 0, 0));
}
