//! Types that a program declares: structures, enumerations, arrays, and what they start with.

use super::Code;
use super::written::*;
use crate::check::{Initial, Type};
use crate::elementary::{Elementary, Value};

const AFTER: &str = "\nprogram p\n";

fn initial_of(text: &str, name: &str) -> (Type, Initial) {
    let checked = clean(text);
    let variable = checked.variables().iter().find(|variable| variable.name == name).unwrap();
    (variable.ty, variable.initial.clone())
}

fn int(number: i128) -> Initial {
    Initial::Value(Value::integer(Elementary::Int, number).unwrap())
}

#[test]
fn enumerations_count_on_and_start_with_their_first_value() {
    let text = "type colour : (red, green := 4, blue)\nprogram p\nvar a : colour var b : colour := blue var c : INT := colour#green\n\
        rung {a := red; b := colour#blue; c := a;}";
    let ty = Type::Elementary(Elementary::Int);
    assert_eq!(initial_of(text, "a"), (ty, int(0)));
    assert_eq!(initial_of(text, "b"), (ty, int(5)));
    assert_eq!(initial_of(text, "c"), (ty, int(4)));
}

#[test]
fn arrays_start_with_lists_and_what_is_left_with_what_the_type_says() {
    let of = |text: &str| initial_of(&format!("{text}\nprogram p\nvar _v : t"), "_v").1;
    let elements = |numbers: &[i128]| Initial::Elements(numbers.iter().map(|number| int(*number)).collect());
    assert_eq!(of("type t : array [0..3] of INT := [1, 2(3), 4]"), elements(&[1, 3, 3, 4]));
    assert_eq!(of("type e : (a, b) := b\ntype t : array [1..2] of e"), elements(&[1, 1]));
    let Initial::Elements(short) = of("type t : array [0..2] of INT := [7]") else { panic!() };
    assert_eq!(short, [int(7), Initial::Default, Initial::Default]);
}

#[test]
fn types_may_be_declared_in_any_order() {
    clean("type a : array [0..1] of b\ntype b : struct x : c end_struct\ntype c : INT := 5\nprogram p\nvar _v : a\n");
}

#[test]
fn faults_of_types_are_found_once() {
    let cases: &[(&str, Code, &str)] = &[
        ("type a : struct x : a end_struct", Code::RecursiveUnit, "a"),
        ("type a : array [0..1] of a", Code::RecursiveUnit, "a"),
        ("type a : array [3..1] of INT", Code::OutOfRange, "array [3..1] of INT"),
        ("type a : array [0..1048576] of INT", Code::TooManyElements, "array [0..1048576] of INT"),
        ("type a : array [0..1023, 0..1024] of INT", Code::TooManyElements, "array [0..1023, 0..1024] of INT"),
        (
            "type a : array [-9223372036854775808..9223372036854775807] of INT",
            Code::TooManyElements,
            "array [-9223372036854775808..9223372036854775807] of INT",
        ),
        ("type a : array [0..n] of INT", Code::UndeclaredName, "n"),
        ("type a : array [0..9223372036854775808] of INT", Code::OutOfRange, "9223372036854775808"),
        ("type a : array [0..1] of nothing", Code::UnknownType, "nothing"),
        ("type a : array [0..1] of INT := [1, 2, 3]", Code::OutOfRange, "[1, 2, 3]"),
        ("type a : array [0..1] of INT := [9223372036854775807(1)]", Code::OutOfRange, "[9223372036854775807(1)]"),
        ("type a : array [0..1] of INT := [-1(1)]", Code::OutOfRange, "-1"),
        ("type a : array [0..1] of INT := 3", Code::TypeMismatch, "3"),
        ("type a : (x, x)", Code::DuplicateName, "x"),
        ("type a : SINT (x := 128)", Code::OutOfRange, "x"),
        ("type a : REAL (x)", Code::TypeMismatch, "REAL"),
        ("type a : (x) := y", Code::UnknownMember, "y"),
        ("type a : struct x : INT  X : INT end_struct", Code::DuplicateName, "X"),
        ("type a : struct x : INT := 1.5 end_struct", Code::TypeMismatch, "1.5"),
        ("type a : INT\ntype A : INT", Code::DuplicateName, "A"),
        ("type TON : INT", Code::DuplicateName, "TON"),
    ];
    for (text, code, place) in cases {
        assert_eq!(found(&format!("{text}{AFTER}")), [(*code, (*place).to_owned())], "{text}");
    }
}

#[test]
fn faults_of_places_are_found() {
    each(
        "type point : struct x, y : INT end_struct\ntype e1 : (red)\ntype e2 : (red)\nprogram p\n\
         var _p : point := (x := 1) var _a : array [1..3, 0..1] of point var _b : BOOL var _n : INT var _t : TON var _k : array [5..5] of INT\nrung ",
        &[
            ("{_p.z := 1}", Code::UnknownMember, "z"),
            ("{_n := _p}", Code::TypeMismatch, "_p"),
            ("{_a[0, 0].x := 1}", Code::OutOfRange, "0"),
            ("{_a[4, 0].x := 1}", Code::OutOfRange, "4"),
            ("{_a[1].x := 1}", Code::WrongArguments, "[1]"),
            ("{_a[1][0].q := 1}", Code::UnknownMember, "q"),
            ("{_a[1, TRUE].x := 1}", Code::TypeMismatch, "TRUE"),
            ("{_a[1, 0] := 1}", Code::TypeMismatch, "1"),
            ("{_n := red}", Code::TypeMismatch, "red"),
            ("{_n := e1#blue}", Code::UndeclaredName, "e1#blue"),
            ("_a[1, 0].x (_b)", Code::TypeMismatch, "_a[1, 0].x"),
            ("{_n := _t}", Code::TypeMismatch, "_t"),
            ("{_k[_k[5]] := _k[6]}", Code::OutOfRange, "6"),
            ("{_n.x := 1}", Code::UnknownMember, "x"),
        ],
    );
}

#[test]
fn initial_values_of_members_are_of_their_types() {
    each(
        "type point : struct x, y : INT end_struct\nprogram p\nvar _p : ",
        &[
            ("point := (z := 1)", Code::UnknownMember, "z"),
            ("point := (x := 1, x := 2)", Code::DuplicateClause, "x"),
            ("point := (x := TRUE)", Code::TypeMismatch, "TRUE"),
            ("point := 3", Code::TypeMismatch, "3"),
            ("TON := (PT := 3)", Code::TypeMismatch, "3"),
            ("INT := (x := 3)", Code::TypeMismatch, "(x := 3)"),
        ],
    );
    clean(
        "type point : struct x, y : INT end_struct\nprogram p\nvar _p : point := (x := 1) var _t : TON := (PT := T#1s)",
    );
}

#[test]
fn long_chains_and_wide_trees_of_types_are_refused_without_being_walked() {
    let forward: String = (0..10_000).map(|at| format!("type t{at} : array [0..1] of t{}\n", at + 1)).collect();
    let codes = |text: &str| diagnostics(text).into_iter().map(|found| found.code).collect::<Vec<_>>();
    let chain = codes(&format!("{forward}type t10000 : INT\nprogram p\n"));
    assert!(!chain.is_empty() && chain.iter().all(|code| *code == Code::TooDeep), "{chain:?}");
    let backward: String = (1..10_000).map(|at| format!("type t{at} : struct x : t{} end_struct\n", at - 1)).collect();
    assert_eq!(codes(&format!("type t0 : INT\n{backward}program p\n")), [Code::TooDeep]);
    // 2^60 values of a few lines.
    let tree: String = (1..=60).map(|at| format!("type t{at} : struct x, y : t{} end_struct\n", at - 1)).collect();
    assert_eq!(codes(&format!("type t0 : INT\n{tree}program p\nvar _v : t60\n")), [Code::TooManyElements]);
}

#[test]
fn initial_values_are_bounded_however_they_multiply() {
    let inner = "type row : array [0..99999] of INT := [100000(7)]\n";
    let found = found(&format!("{inner}type all : array [0..99999] of row\nprogram p\n"));
    assert_eq!(found, [(Code::TooManyElements, "array [0..99999] of row".to_owned())]);
}
