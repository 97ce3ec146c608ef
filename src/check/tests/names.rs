//! Names: declared, undeclared, twice, unused, and what they stand for.

use super::build::*;
use super::*;
use crate::check::{Type, VariableId};
use crate::elementary::Elementary;
use crate::ladder::library::StandardBlock;

#[test]
fn names_are_found_in_any_case_and_keep_their_first_spelling() {
    let checked = clean(&program(vec![input("Start"), output("Pump")], vec![rung(vec![open("START"), coil("pump")])]));
    let names: Vec<&str> = checked.variables().iter().map(|variable| variable.name.as_str()).collect();
    assert_eq!(names, ["Start", "Pump"]);
}

#[test]
fn faults_of_names_point_at_the_name() {
    table(vec![
        (program(vec![output("q")], vec![rung(vec![open("a"), coil("q")])]), Code::UndeclaredName, "a"),
        (program(vec![output("q"), output("Q")], vec![rung(vec![coil("q")])]), Code::DuplicateName, "Q"),
        (program(vec![output("q").typed("BOOLE")], vec![rung(vec![coil("q")])]), Code::UnknownType, "BOOLE"),
        (program(vec![output("q")], vec![rung(vec![call("t:TONN", vec![]), coil("q")])]), Code::UnknownType, "TONN"),
        (
            program(
                vec![output("q")],
                vec![rung(vec![call("t:TON", vec![]), coil("q")]), rung(vec![open("t.X"), coil("t.IN")])],
            ),
            Code::UnknownMember,
            "X",
        ),
        (program(vec![input("a"), output("q")], vec![rung(vec![open("a.x"), coil("q")])]), Code::UnknownMember, "x"),
        (
            program(vec![output("q"), output("r")], vec![named("r1", vec![coil("q")]), named("R1", vec![coil("r")])]),
            Code::DuplicateName,
            "R1",
        ),
    ]);
}

#[test]
fn an_undeclared_name_is_reported_once_with_the_nearest_one() {
    let variables = vec![input("start"), output("pump"), output("alarm")];
    let rungs = vec![rung(vec![open("start"), coil("pump")]), rung(vec![open("strat"), open("STRAT"), coil("alarm")])];
    let found = only(&program(variables, rungs));
    assert_eq!((found.code, found.hint.as_deref()), (Code::UndeclaredName, Some("did you mean `start`?")));
}

#[test]
fn an_undeclared_instance_is_told_how_to_be_declared() {
    let found = only(&program(vec![output("q")], vec![rung(vec![call("delay", vec![]), coil("q")])]));
    assert_eq!(found.code, Code::UndeclaredName);
    assert_eq!(found.hint.as_deref(), Some("declare the instance by its use, as in `delay:TON(PT := T#1s)`"));
}

#[test]
fn a_second_declaration_names_the_first() {
    let found = only(&program(vec![input("a"), output("A"), output("q")], vec![rung(vec![open("a"), coil("q")])]));
    let related: Vec<String> = found.related.iter().map(|(span, _)| text_at(*span)).collect();
    assert_eq!((found.code, related), (Code::DuplicateName, vec!["a".to_owned()]));
}

#[test]
fn what_no_rung_names_is_unused_but_for_underscored_names() {
    let variables = vec![
        input("a"),
        output("b"),
        memory("c", "INT"),
        memory("d", "TON"),
        constant("e", "INT", int(1)),
        input("_f"),
    ];
    let unused = |name: &str| (Code::UnusedName, name.to_owned());
    assert_eq!(findings(&program(variables, vec![])), ["a", "b", "c", "d", "e"].map(unused));
}

#[test]
fn a_constant_that_an_initial_value_names_is_used() {
    let variables = vec![constant("c", "INT", int(1)), memory("n", "INT").starting(read("c"))];
    clean(&program(variables, vec![rung(vec![assign("n", int(2))])]));
}

#[test]
fn instances_are_declared_by_their_use_even_later_and_inside_of_circuits() {
    let inner = wired("IN", vec![open("a"), call("inner:TOF", vec![value("PT", seconds(1))])]);
    let checked = clean(&program(
        vec![input("a"), output("q"), output("r")],
        vec![rung(vec![open("outer.Q"), coil("r")]), rung(vec![call("outer:TON", vec![inner]), coil("q")])],
    ));
    let found: Vec<_> = checked.variables().iter().map(|variable| (variable.name.as_str(), variable.ty)).collect();
    let bool = Type::Elementary(Elementary::Bool);
    let blocks = [StandardBlock::Ton, StandardBlock::Tof].map(Type::Block);
    assert_eq!(found, [("a", bool), ("q", bool), ("r", bool), ("outer", blocks[0]), ("inner", blocks[1])]);
    assert_eq!(checked.variable(VariableId(3)).name, "outer");
}

#[test]
fn several_errors_come_in_one_run_in_order_of_place() {
    let variables = vec![input("a").typed("NONE"), output("q"), memory("n", "INT").starting(int(40_000))];
    let rungs = vec![rung(vec![open("a"), open("nobody"), coil("q")]), rung(vec![when(read("n")), coil("a2")])];
    let expected = [
        (Code::UnknownType, "NONE"),
        (Code::OutOfRange, "40000"),
        (Code::UndeclaredName, "nobody"),
        (Code::TypeMismatch, "n"),
        (Code::UndeclaredName, "a2"),
    ];
    assert_eq!(findings(&program(variables, rungs)), expected.map(|(code, text)| (code, text.to_owned())));
}
