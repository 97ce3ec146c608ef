//! Structured text in braces.

use super::Code;
use super::written::*;
use crate::check::{Element, Statement};

const BEFORE: &str = "program p\nvar _i : INT var _u : USINT var _b : BOOL var _r : REAL var _x : array [0..3] of INT var _y : array [1..4] of INT var _t : TON\nrung ";

fn statement(text: &str) -> Statement {
    let checked = clean(&format!("{BEFORE}{{{text}}}"));
    match &checked.units()[0].rungs[0].circuit.branches[0].elements[0] {
        Element::Statements(statements) => statements[0].clone(),
        other => panic!("{other:?}"),
    }
}

#[test]
fn a_for_turns_as_often_as_its_bounds_say() {
    let turns = |text: &str| match statement(&format!("FOR {text} DO _b := TRUE; END_FOR;")) {
        Statement::For { count, step, .. } => (count, step),
        other => panic!("{other:?}"),
    };
    assert_eq!(turns("_i := 0 TO 9"), (10, 1));
    assert_eq!(turns("_i := 0 TO 9 BY 4"), (3, 4));
    assert_eq!(turns("_i := 9 TO 0 BY -3"), (4, -3));
    assert_eq!(turns("_i := 5 TO 4"), (0, 1));
    assert_eq!(turns("_i := 5 TO 5 BY -1"), (1, -1));
    assert_eq!(turns("_u := 255 TO 0 BY -1"), (256, -1));
    assert_eq!(turns("_i := -32768 TO 32767 BY 32767"), (3, 32767));
}

#[test]
fn faults_of_statements_are_found() {
    each(
        BEFORE,
        &[
            (
                "{FOR _i := 0 TO 9 BY 0 DO _b := TRUE; END_FOR;}",
                Code::OutOfRange,
                "FOR _i := 0 TO 9 BY 0 DO _b := TRUE; END_FOR",
            ),
            ("{FOR _i := 0 TO _u DO _b := TRUE; END_FOR;}", Code::NotConstant, "_u"),
            ("{FOR _r := 0 TO 3 DO _b := TRUE; END_FOR;}", Code::TypeMismatch, "_r"),
            ("{FOR _x[1] := 0 TO 3 DO _b := TRUE; END_FOR;}", Code::TypeMismatch, "_x[1]"),
            ("{FOR _i := 0 TO 40000 DO _b := TRUE; END_FOR;}", Code::OutOfRange, "40000"),
            ("{IF _i THEN _b := TRUE; END_IF;}", Code::TypeMismatch, "_i"),
            ("{EXIT;}", Code::MisplacedJump, "EXIT"),
            ("{CASE _r OF 1: _b := TRUE; END_CASE;}", Code::TypeMismatch, "_r"),
            ("{CASE _i OF _u: _b := TRUE; END_CASE;}", Code::NotConstant, "_u"),
            ("{CASE _i OF 1..70000: _b := TRUE; END_CASE;}", Code::OutOfRange, "70000"),
            ("{_x := _y;}", Code::TypeMismatch, "_y"),
            ("{_x := 3;}", Code::TypeMismatch, "3"),
            ("{_t := _t;}", Code::NotWritable, "_t"),
            ("{_i := _x;}", Code::TypeMismatch, "_x"),
            ("{_x[4] := 3;}", Code::OutOfRange, "4"),
            ("{_x[1, 2] := 3;}", Code::WrongArguments, "[1, 2]"),
            ("{_i[1] := 3;}", Code::UnknownMember, "[1]"),
            ("{ADD(IN1 := 1, IN2 := _b);}", Code::TypeMismatch, "1, IN2 := _b"),
            ("_t(IN := [_b {RETURN;}])", Code::MisplacedJump, "RETURN"),
        ],
    );
}

#[test]
fn faults_in_all_parts_of_a_statement_are_found_at_once() {
    let text = format!(
        "{BEFORE}{{IF a THEN b := 1; ELSIF c THEN CASE d OF 1: e := 1; ELSE f := 1; END_CASE; ELSE g := 1; END_IF;}}"
    );
    let names: Vec<String> = found(&text).into_iter().map(|(_, name)| name).collect();
    assert_eq!(names, ["a", "b", "c", "d", "e", "f", "g"]);
}

#[test]
fn an_instance_may_be_called_in_several_branches_but_not_twice_in_a_row() {
    clean(&format!("{BEFORE}{{IF _b THEN _t(IN := TRUE); ELSE _t(IN := FALSE); END_IF;}}"));
    let twice = found(&format!("{BEFORE}{{_t(IN := TRUE); _t(IN := FALSE);}}"));
    assert_eq!(twice, [(Code::RepeatedBlock, "_t(IN := FALSE)".to_owned())]);
}

#[test]
fn an_assignment_of_a_whole_array_is_a_copy() {
    assert!(matches!(statement("_x := _x;"), Statement::Copy { .. }));
}
