//! Units, their instances, what they come to, and when they run.

use super::Code;
use super::written::*;
use crate::check::MOST_ELEMENTS;

fn one(text: &str) -> (Code, String) {
    let mut found = found(text);
    assert_eq!(found.len(), 1, "{text}\n{found:?}");
    found.remove(0)
}

#[test]
fn what_calls_or_holds_itself_is_found_once() {
    let program = "program p\nvar i : f\nrung i()\n";
    let direct = "function_block f\nvar g : f\nrung g()\n";
    assert_eq!(one(&format!("{direct}{program}")), (Code::RecursiveUnit, "g".to_owned()));
    let around = "function_block f\nvar a : g\nrung a()\nfunction_block g\nvar b : s\nrung b.c()\ntype s : struct c : f end_struct\n";
    let types = "type s : struct c : f end_struct\n";
    let around = around.replace(types, "");
    assert_eq!(one(&format!("{types}{around}{program}")).0, Code::RecursiveUnit);
    let function = "function f : INT\ninput x : INT\nrung {f := g(x)}\nfunction g : INT\ninput x : INT\nrung {g := f(x)}\nprogram p\nvar n : INT\nrung {n := g(n)}\n";
    assert_eq!(one(function).0, Code::RecursiveUnit);
}

#[test]
fn a_chain_of_ten_thousand_units_is_walked_without_recursion() {
    assert_eq!(one(&chain_of(10_000)), (Code::TooDeep, "i()".to_owned()));
}

#[test]
fn calls_nest_as_deep_as_what_is_written_out_can_be_walked() {
    clean(&chain_of(95));
    assert_eq!(one(&chain_of(105)), (Code::TooDeep, "i()".to_owned()));
}

/// A program that calls a block that calls another, and so on.
fn chain_of(blocks: usize) -> String {
    let block = |at: usize| format!("function_block f{at}\nvar g : f{}\nrung g()\n", at + 1);
    let chain: String = (0..blocks).map(block).collect();
    let end = format!("function_block f{blocks}\nvar _b : BOOL\nrung {{_b := TRUE}}\n");
    format!("{chain}{end}program p\nvar i : f0\nrung i()\n")
}

#[test]
fn calls_that_double_at_each_level_are_too_large() {
    let block =
        |at: usize| format!("function f{at} : INT\ninput x : INT\nrung {{f{at} := f{}(x) + f{}(x)}}\n", at + 1, at + 1);
    let of = |levels: usize| {
        let calls: String = (0..levels).map(block).collect();
        format!(
            "{calls}function f{levels} : INT\ninput x : INT\nrung {{f{levels} := x}}\nprogram p\nvar n : INT\nrung {{n := f0(n)}}\n"
        )
    };
    clean(&of(10));
    assert_eq!(one(&of(40)), (Code::TooLargeInlined, "f0".to_owned()));
}

#[test]
fn loops_count_by_their_turns() {
    let of = |turns: u32| {
        format!(
            "program p\nvar i, j, n : INT\nrung {{FOR i := 1 TO {turns} DO FOR j := 1 TO {turns} DO n := n + 1; END_FOR; END_FOR;}}\n"
        )
    };
    clean(&of(300));
    assert_eq!(one(&of(1000)).0, Code::TooLargeInlined);
    assert_eq!(one(&of(30000)).0, Code::TooLargeInlined);
}

#[test]
fn all_values_of_arrays_and_instances_count_together() {
    let of = |count: u32| format!("program p\nvar _a : array [1..{count}] of INT var _b : array [1..1000] of INT\n");
    clean(&of(MOST_ELEMENTS - 1000));
    assert_eq!(one(&of(MOST_ELEMENTS - 999)), (Code::TooManyElements, "_a".to_owned()));
    let nested = "function_block f\nvar _a : array [1..1000] of INT\ntype t : array [1..1000] of f\n";
    let types = "type t : array [1..2000] of f\n";
    let nested = nested.replace("type t : array [1..1000] of f\n", "");
    assert_eq!(one(&format!("{types}{nested}program p\nvar _i : t\n")), (Code::TooManyElements, "_i".to_owned()));
    let two = "program _q\nvar _a : array [1..600000] of INT\nprogram p1 : _q\nprogram p2 : _q\n";
    assert_eq!(one(two), (Code::TooManyElements, "_a".to_owned()));
}

#[test]
fn declarations_stand_where_they_mean_something() {
    let cases: &[(&str, Code, &str)] = &[
        ("program p\ninout _a : INT\n", Code::MisplacedDeclaration, "_a"),
        ("function_block _f\ninout _a : INT := 3\nprogram p\n", Code::MisplacedDeclaration, "_a"),
        ("function_block _f\ntemp _a : INT retain\nprogram p\n", Code::MisplacedDeclaration, "_a"),
        ("function_block _f\ntemp _a : TON\nprogram p\n", Code::TypeMismatch, "_a"),
        ("function_block _f\nvar _a at %MX0.0 : BOOL\nprogram p\n", Code::AddressConflict, "%MX0.0"),
        ("function _f : TON\nprogram p\n", Code::TypeMismatch, "TON"),
        (
            "function add : INT\ninput _x : INT\nprogram p\nvar _n : INT\nrung {_n := add(_n)}\n",
            Code::DuplicateName,
            "add",
        ),
        ("global _a : INT\nprogram p\nvar _a : INT\n", Code::DuplicateName, "_a"),
        ("function_block f\nvar _a : INT\nprogram p\n", Code::UnusedName, "f"),
        ("function f\nvar _a : INT\nprogram p\n", Code::UnusedName, "f"),
        ("function_block f\ninput _a : INT\nrung {_a := 1}\nprogram p\nvar _i : f\n", Code::NotWritable, "_a"),
        (
            "function_block f\nvar _a : INT\nprogram p\nvar _i : f var _n : INT\nrung {_n := _i._a}\n",
            Code::UnknownMember,
            "_a",
        ),
        ("function_block f\noutput _a : INT\nprogram p\nvar _i : f\nrung {_i._a := 3}\n", Code::NotWritable, "_i._a"),
        (
            "function_block f\ninput _a : array [0..1] of INT\nprogram p\nvar _i : f\nrung _i(_a := 3)\n",
            Code::TypeMismatch,
            "3",
        ),
        ("function_block f\ninout _a : INT\nprogram p\nvar _i : f\nrung _i()\n", Code::WrongArguments, "_i"),
        (
            "function_block f\nvar _a : INT\nfunction_block F\nvar _a : INT\nprogram p\nvar _i : f\n",
            Code::DuplicateName,
            "F",
        ),
        (
            "program p\nvar _i : array [0..3] of TON var _n : INT\nrung _i[_n](PT := T#1s)\n",
            Code::NotConstant,
            "_i[_n]",
        ),
        (
            "function_block f\ninout _t : TON\nprogram p\nvar _i : f var _ts : array [0..3] of TON var _n : INT\nrung _i(_t := _ts[_n])\n",
            Code::NotConstant,
            "_ts[_n]",
        ),
        ("function_block f\ntemp _a : INT\nprogram p\nvar _i : f := (_a := 3)\nrung _i()\n", Code::NotWritable, "_a"),
        (
            "function_block f\nconst _a : INT := 2\nprogram p\nvar _i : f := (_a := 3)\nrung _i()\n",
            Code::NotWritable,
            "_a",
        ),
    ];
    for (text, code, place) in cases {
        let found = found(text);
        assert!(found.contains(&(*code, (*place).to_owned())) && found.len() <= 2, "{text}\n{found:?}");
    }
    clean("global _a : INT\nfunction_block f\nvar _a : INT\nprogram p\nvar _i : f\n");
    clean(
        "function_block f\ninput a : INT := 3\nvar n : INT retain\ntemp t : INT\nrung {t := a; n := t;}\nprogram p\ntemp t : INT\nrung {t := 1} i:f(a := t)\n",
    );
    clean("program p\nvar _i : array [0..3] of TON\nrung _i[0](PT := T#1s) _i[1](PT := T#2s)\n");
    clean(
        "function_block f\ninout t : TON\nrung\n  t(PT := T#1s)\nprogram p\nvar _i : f var _ts : array [0..3] of TON\nrung\n  _i(t := _ts[1])\n",
    );
}

#[test]
fn what_is_copied_or_set_value_by_value_counts_as_often() {
    let row = "type row : array [0..4000] of INT\n";
    let copies = |declared: &str, body: &str| {
        let text =
            format!("{row}program p\nvar _i : DINT {declared}\nrung\n  {{FOR _i := 1 TO 1000 DO {body}; END_FOR;}}\n");
        one(&text).0
    };
    assert_eq!(copies("var _m : array [0..1] of row", "_m[0] := _m[1]"), Code::TooLargeInlined);
    assert_eq!(copies("var _m : array [0..1] of row var _r : row", "_r := _m[1]"), Code::TooLargeInlined);
    assert_eq!(
        copies("var _m : array [0..1] of row var _r : row", "MOVE(IN := _r, OUT => _m[1])"),
        Code::TooLargeInlined
    );
    clean(&format!(
        "{row}program p\nvar _i : DINT var _r : row var _s : row\nrung\n  {{FOR _i := 1 TO 1000 DO _r := _s; END_FOR;}}\n"
    ));
    let temporary = "type row : array [0..4000] of INT\nfunction_block f\ntemp _t : row\nprogram p\nvar _i : DINT var _f : f\nrung\n  {FOR _i := 1 TO 1000 DO _f(); END_FOR;}\n";
    assert_eq!(one(temporary).0, Code::TooLargeInlined);
}

#[test]
fn double_coils_are_found_across_units_and_say_where() {
    let text = "global g : BOOL\nprogram p\ninput a\nrung a (g)\nprogram q\ninput a\nrung a (g)\n";
    let found = diagnostics(text);
    assert_eq!(found.len(), 1, "{found:?}");
    assert_eq!(
        (found[0].code, found[0].message.as_str()),
        (Code::DoubleCoil, "`g` is written by coils in rung 1 of p and rung 2 of q")
    );
}

#[test]
fn tasks_run_by_priority_and_programs_without_a_task_last() {
    let checked = clean(
        "task slow(interval := 100ms, priority := 5)\ntask fast(interval := 10ms, priority := 1)\ntask each(priority := 1)\n\
         program a\nvar _x : INT\nprogram b with slow\nvar _x : INT\nprogram c\nvar _x : INT\nprogram c1 : c with fast\nprogram c2 : c with each\n",
    );
    let tasks: Vec<(&str, Option<i64>)> =
        checked.tasks().iter().map(|task| (task.name.as_str(), task.interval)).collect();
    assert_eq!(tasks, [("fast", Some(10_000_000)), ("each", None), ("slow", Some(100_000_000)), ("", None)]);
    let programs: Vec<(&str, usize)> =
        checked.programs().iter().map(|program| (program.name.as_str(), program.task.index())).collect();
    assert_eq!(programs, [("c1", 0), ("c2", 1), ("b", 2), ("a", 3)]);
}

#[test]
fn faults_of_tasks_and_instances_are_found() {
    let cases: &[(&str, Code, &str)] = &[
        ("program p with fast\n", Code::BadResource, "fast"),
        ("task fast(interval := T#0s)\nprogram p with fast\n", Code::BadResource, "T#0s"),
        ("task fast(interval := -T#5ms)\nprogram p with fast\n", Code::BadResource, "-T#5ms"),
        ("task fast(interval := 5)\nprogram p with fast\n", Code::TypeMismatch, "5"),
        ("task fast(priority := 1.5)\nprogram p with fast\n", Code::TypeMismatch, "1.5"),
        ("task fast()\ntask Fast()\nprogram p with fast\n", Code::DuplicateName, "Fast"),
        ("program p\nprogram i : nothing\n", Code::BadResource, "nothing"),
        ("program p\nprogram P\n", Code::DuplicateName, "P"),
        ("program p\nprogram i : p\nprogram I : p\n", Code::DuplicateName, "I"),
        (
            "global i : INT\nprogram p\nvar _n : INT\nrung {i := 1}\nprogram i : p\nprogram j : p\n",
            Code::DuplicateName,
            "i",
        ),
        ("function_block _f\nvar _n : INT\n", Code::BadResource, ""),
    ];
    for (text, code, place) in cases {
        let (found, text_found) = one(text);
        assert_eq!(found, *code, "{text}");
        assert!(place.is_empty() || text_found == *place, "{text}: {text_found}");
    }
    clean("program p\nprogram p : p\n");
}

#[test]
fn registers_are_as_many_as_their_use_or_the_program_says() {
    let count = |text: &str| {
        let checked = clean(text);
        let hreg = checked.variables().iter().find(|variable| variable.name == "hreg").unwrap();
        match hreg.ty {
            crate::check::Type::Array(array) => checked.array(array).count(),
            other => panic!("{other:?}"),
        }
    };
    assert_eq!(count("program p\nrung {hreg[7] := hreg[3]}\n"), 8);
    assert_eq!(count("program p\nvar n : INT\nrung {hreg[n] := 1} {n := 0}\n"), 512);
    assert_eq!(count("registers(hreg := 64)\nprogram p\nrung {hreg[7] := 1}\n"), 64);
    let cases: &[(&str, Code, &str)] = &[
        ("registers(hreg := 4)\nprogram p\nrung {hreg[7] := 1}\n", Code::OutOfRange, "7"),
        ("registers(hreg := 4000)\nprogram p\nrung {hreg[7] := 1}\n", Code::BadResource, "hreg"),
        ("registers(greg := 4)\nprogram p\n", Code::BadResource, "greg"),
        ("registers(hreg := 0)\nprogram p\n", Code::OutOfRange, "0"),
        ("program p\nrung {ireg[7] := 1}\n", Code::CoilOnInput, "ireg[7]"),
        ("program p\nrung {hreg[9223372036854775807] := 1}\n", Code::TooManyElements, "hreg"),
    ];
    for (text, code, place) in cases {
        assert_eq!(one(text), (*code, (*place).to_owned()), "{text}");
    }
}

#[test]
fn an_instance_is_of_one_kind_in_all_its_calls() {
    let of = |kind: u32| {
        format!(
            "program p\ninput i\nvar t : TT\nrung {{t(TIMING := i, KIND := 1);}}\nrung i t(KIND := {kind}, PRESET := 5)\n"
        )
    };
    let codes = |text: &str| found(text).into_iter().map(|(code, _)| code).collect::<Vec<_>>();
    assert_eq!(codes(&of(1)), [Code::RepeatedBlock]);
    assert!(codes(&of(3)).contains(&Code::WrongArguments));
}
