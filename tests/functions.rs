//! What each function computes at its boundaries: one row a case, on every engine and in the evaluator.

#[path = "support"]
mod support {
    #![allow(dead_code, reason = "this test draws nothing and uses a part of the support only")]
    pub(crate) mod drawing;
    pub(crate) mod oracle;
    pub(crate) mod rig;
    pub(crate) mod step_table;
}

use rung::diagnostic::{self, Code};
use rung::elementary::Elementary;
use rung::source::Source;
use rung::{check, frontend};

use support::rig::{Rig, checked};

/// A program that computes an expression of `a`, `b` and `c`, all of a type, into `result`.
fn text(ty: &str, values: &[&str], result: &str, expression: &str) -> String {
    let mut text = format!("var result : {result}\n");
    for (name, value) in ["a", "b", "c"].iter().zip(values) {
        // What a constant cannot say comes from a computation.
        let initial = if *value == "NaN" { "0.0" } else { value };
        text += &format!("var {name} : {ty} := {initial}\n");
    }
    text += "rung r\n";
    for (name, value) in ["a", "b", "c"].iter().zip(values) {
        if *value == "NaN" {
            text += &format!("{{{name} := {name} / {name}}} ");
        }
    }
    text + &format!("{{result := {expression}}}\n")
}

/// The value everywhere, in its debugging form.
fn computed(text: &str) -> String {
    let source = Source::new("functions.rung", text);
    let parsed = frontend::parse(&source);
    assert!(parsed.diagnostics.is_empty(), "{}", diagnostic::render(&source, &parsed.diagnostics));
    let checked = checked(&parsed.program).unwrap_or_else(|problems| panic!("{text}\n{problems}"));
    let mut rig = Rig::new(&checked).unwrap_or_else(|problem| panic!("{text}\n{problem}"));
    for now in [0, 1] {
        rig.scan(now).unwrap_or_else(|difference| panic!("{text}\n{difference:?}"));
    }
    format!("{:?}", rig.oracle.get("result"))
}

/// Rows: the operands' type, their values, the expression and its value with its type.
fn table(rows: &[(&str, &[&str], &str, &str)]) {
    for (ty, values, expression, expected) in rows {
        let result = expected.split('#').next().unwrap_or(expected);
        let text = text(ty, values, result, expression);
        assert_eq!(computed(&text), *expected, "{ty} {values:?}: {expression}");
        // The same of constants, but where such are refused or no such can be written.
        if !values.contains(&"NaN") {
            let constants = text.replace("var a", "const a").replace("var b", "const b").replace("var c", "const c");
            let (checked, problems) = check::check(&frontend::parse(&Source::new("constants", &*constants)).program);
            if checked.is_some() {
                assert_eq!(computed(&constants), *expected, "{ty} {values:?}: {expression} of constants");
            } else {
                assert!(
                    problems
                        .iter()
                        .filter(|problem| problem.is_error())
                        .all(|problem| problem.code == Code::OutOfRange),
                    "{constants}\n{problems:?}"
                );
            }
        }
    }
}

#[test]
fn selection() {
    table(&[
        ("INT", &["7", "9"], "SEL(FALSE, a, b)", "INT#7"),
        ("INT", &["7", "9"], "SEL(IN1 := b, IN0 := a, G := a > 0)", "INT#9"),
        ("REAL", &["1.5", "NaN"], "SEL(a > 2.0, a, b)", "REAL#1.5"),
        ("INT", &["0", "9", "5"], "MUX(a, b, c)", "INT#9"),
        ("INT", &["1", "9", "5"], "MUX(a, b, c)", "INT#5"),
        ("INT", &["2", "9", "5"], "MUX(a, b, c)", "INT#0"),
        ("INT", &["-1", "9", "5"], "MUX(a, b, c)", "INT#0"),
        ("ULINT", &["18446744073709551615", "9", "5"], "MUX(a, b, c)", "ULINT#0"),
        ("SINT", &["3"], "MUX(K := a, IN0 := T#0s, IN1 := T#1s, IN2 := T#2s, IN3 := T#3s)", "TIME#3000000000"),
        ("INT", &["-5"], "LIMIT(0, a, 10)", "INT#0"),
        ("INT", &["11"], "LIMIT(0, a, 10)", "INT#10"),
        ("INT", &["10", "5", "0"], "LIMIT(MN := a, IN := b, MX := c)", "INT#0"),
        ("REAL", &["NaN"], "LIMIT(0.0, a, 10.0)", "REAL#NaN"),
        ("REAL", &["NaN", "3.0"], "LIMIT(a, b, a)", "REAL#3.0"),
        ("WORD", &["16#8000", "1"], "MAX(a, b)", "WORD#32768"),
        ("BOOL", &["TRUE", "FALSE"], "MIN(a, b)", "BOOL#0"),
        ("TIME", &["-T#1s", "T#1s", "T#2s"], "MIN(c, b, a)", "TIME#-1000000000"),
        ("INT", &["-32768", "32767", "0"], "MAX(a, b, c)", "INT#32767"),
        ("REAL", &["NaN", "1.0"], "MAX(a, b)", "REAL#NaN"),
        ("REAL", &["1.0", "NaN"], "MAX(a, b)", "REAL#1.0"),
        ("REAL", &["0.0", "-0.0"], "MIN(a, b)", "REAL#0.0"),
        ("LREAL", &["2.5"], "MOVE(a)", "LREAL#2.5"),
    ]);
}

#[test]
fn arithmetic() {
    table(&[
        ("INT", &["-32768"], "ABS(a)", "INT#-32768"),
        ("SINT", &["-128"], "ABS(a)", "SINT#-128"),
        ("INT", &["-5"], "ABS(a)", "INT#5"),
        ("REAL", &["-0.0"], "ABS(a)", "REAL#0.0"),
        ("UINT", &["65535"], "ABS(a)", "UINT#65535"),
        ("INT", &["32767", "1", "1"], "ADD(a, b, c)", "INT#-32767"),
        ("INT", &["300", "300", "300"], "MUL(a, b, c)", "INT#-832"),
        ("USINT", &["3", "4"], "SUB(a, b)", "USINT#255"),
        ("INT", &["7", "0"], "DIV(a, b)", "INT#0"),
        ("INT", &["-32768", "-1"], "DIV(a, b)", "INT#-32768"),
        ("INT", &["-7", "2"], "DIV(a, b)", "INT#-3"),
        ("INT", &["-7", "2"], "MOD(a, b)", "INT#-1"),
        ("INT", &["7", "0"], "MOD(IN1 := a, IN2 := b)", "INT#0"),
        ("REAL", &["1.0", "0.0"], "DIV(a, b)", "REAL#inf"),
        ("REAL", &["16777216.0", "1.0", "1.0"], "ADD(a, b, c)", "REAL#16777216.0"),
        ("TIME", &["T#1s", "T#2s", "T#3s"], "ADD(a, b, c)", "TIME#6000000000"),
        ("TIME", &["T#1s", "T#2s"], "SUB_TIME(a, b)", "TIME#-1000000000"),
        ("REAL", &["-1.0"], "SQRT(a)", "REAL#NaN"),
        ("REAL", &["2.0"], "SQRT(a)", "REAL#1.4142135381698608"),
        ("LREAL", &["2.0"], "SQRT(a)", "LREAL#1.4142135623730951"),
        ("REAL", &["-0.0"], "SQRT(a)", "REAL#-0.0"),
        ("LREAL", &["0.0"], "LN(a)", "LREAL#-inf"),
        ("LREAL", &["-1.0"], "LN(a)", "LREAL#NaN"),
        ("LREAL", &["1000.0"], "LOG(a)", "LREAL#3.0"),
        ("REAL", &["100.0"], "EXP(a)", "REAL#inf"),
        ("LREAL", &["1.0"], "EXP(a)", "LREAL#2.7182818284590455"),
        ("LREAL", &["0.0"], "SIN(a)", "LREAL#0.0"),
        ("LREAL", &["0.0"], "COS(a)", "LREAL#1.0"),
        ("LREAL", &["1.0"], "TAN(a)", "LREAL#1.5574077246549023"),
        ("LREAL", &["1.0"], "ASIN(a)", "LREAL#1.5707963267948966"),
        ("LREAL", &["2.0"], "ACOS(a)", "LREAL#NaN"),
        ("LREAL", &["1.0"], "ACOS(a)", "LREAL#0.0"),
        ("REAL", &["1.0"], "ATAN(a)", "REAL#0.7853981852531433"),
        ("REAL", &["2.0"], "EXPT(a, 10)", "REAL#1024.0"),
        ("LREAL", &["2.0", "0.5"], "EXPT(a, b)", "LREAL#1.4142135623730951"),
        ("LREAL", &["-8.0"], "EXPT(a, 0.5)", "LREAL#NaN"),
        ("REAL", &["-2.0"], "EXPT(IN2 := 3, IN1 := a)", "REAL#-8.0"),
        ("REAL", &["0.0"], "EXPT(a, 0)", "REAL#1.0"),
    ]);
}

#[test]
fn durations_by_numbers() {
    table(&[
        ("TIME", &["T#1s500ms"], "MUL(a, 3)", "TIME#4500000000"),
        ("TIME", &["T#1s"], "MUL(a, 0.25)", "TIME#250000000"),
        ("TIME", &["T#1ns"], "MULTIME(a, 2.5)", "TIME#2"),
        ("TIME", &["T#9223372036854775807ns"], "MUL_TIME(a, 2)", "TIME#-2"),
        ("TIME", &["T#9223372036854775807ns"], "MUL_TIME(a, 2.0)", "TIME#9223372036854775807"),
        ("TIME", &["-T#1s"], "DIV(a, 3)", "TIME#-333333333"),
        ("TIME", &["T#1s"], "DIV_TIME(a, 0)", "TIME#0"),
        ("TIME", &["T#1s"], "DIVTIME(a, 0.0)", "TIME#9223372036854775807"),
        ("TIME", &["T#0s"], "DIV(IN1 := a, IN2 := 0.0)", "TIME#0"),
    ]);
}

#[test]
fn bits() {
    table(&[
        ("BYTE", &["16#81"], "SHL(a, 1)", "BYTE#2"),
        ("BYTE", &["16#81"], "SHL(a, 8)", "BYTE#0"),
        ("BYTE", &["16#81"], "SHR(IN := a, N := 7)", "BYTE#1"),
        ("WORD", &["16#FFFF"], "SHR(a, 16)", "WORD#0"),
        ("WORD", &["16#FFFF"], "SHR(a, -1)", "WORD#0"),
        ("WORD", &["16#FFFF"], "SHL(a, LINT#4294967296)", "WORD#0"),
        ("LWORD", &["1"], "SHL(a, 63)", "LWORD#9223372036854775808"),
        ("BYTE", &["16#81"], "ROL(a, 1)", "BYTE#3"),
        ("BYTE", &["16#81"], "ROR(a, 1)", "BYTE#192"),
        ("BYTE", &["16#81"], "ROL(a, 8)", "BYTE#129"),
        ("BYTE", &["16#81"], "ROL(a, 9)", "BYTE#3"),
        ("BYTE", &["16#81"], "ROL(a, -1)", "BYTE#192"),
        ("LWORD", &["1"], "ROR(a, SINT#-1)", "LWORD#2"),
        ("DWORD", &["1"], "ROR(a, 1)", "DWORD#2147483648"),
        ("BYTE", &["16#F0", "16#3C", "16#FF"], "AND(a, b, c)", "BYTE#48"),
        ("BYTE", &["16#F0", "16#3C", "1"], "OR(a, b, c)", "BYTE#253"),
        ("BYTE", &["16#F0", "16#3C", "1"], "XOR(a, b, c)", "BYTE#205"),
        ("BOOL", &["TRUE", "TRUE", "TRUE"], "XOR(a, b, c)", "BOOL#1"),
        ("WORD", &["16#00FF"], "`NOT`(a)", "WORD#65280"),
        ("WORD", &["16#00FF"], "NOT(a)", "WORD#65280"),
    ]);
}

#[test]
fn comparisons_of_sequences() {
    table(&[
        ("INT", &["3", "2", "1"], "GT(a, b, c)", "BOOL#1"),
        ("INT", &["3", "2", "2"], "GT(a, b, c)", "BOOL#0"),
        ("INT", &["3", "2", "2"], "GE(a, b, c)", "BOOL#1"),
        ("INT", &["1", "3", "2"], "LT(a, b, c)", "BOOL#0"),
        ("INT", &["1", "1", "2"], "LE(a, b, c)", "BOOL#1"),
        ("INT", &["2", "2", "2"], "EQ(a, b, c)", "BOOL#1"),
        ("INT", &["2", "2"], "NE(a, b)", "BOOL#0"),
        ("REAL", &["NaN", "NaN"], "EQ(a, b)", "BOOL#0"),
        ("REAL", &["1.0", "NaN", "3.0"], "LT(a, b, c)", "BOOL#0"),
        ("REAL", &["NaN", "1.0"], "NE(a, b)", "BOOL#1"),
    ]);
}

#[test]
fn conversions() {
    table(&[
        ("INT", &["300"], "INT_TO_SINT(a)", "SINT#44"),
        ("INT", &["-1"], "INT_TO_WORD(a)", "WORD#65535"),
        ("WORD", &["65535"], "WORD_TO_INT(a)", "INT#-1"),
        ("INT", &["-1"], "TO_ULINT(a)", "ULINT#18446744073709551615"),
        ("SINT", &["5"], "INT_TO_REAL(a)", "REAL#5.0"),
        ("DINT", &["16777217"], "DINT_TO_REAL(a)", "REAL#16777216.0"),
        ("ULINT", &["18446744073709551615"], "ULINT_TO_LREAL(a)", "LREAL#1.8446744073709552e19"),
        ("REAL", &["2.5"], "REAL_TO_INT(IN := a)", "INT#2"),
        ("REAL", &["3.5"], "REAL_TO_INT(a)", "INT#4"),
        ("REAL", &["-0.5"], "REAL_TO_INT(a)", "INT#0"),
        ("REAL", &["1.0e9"], "REAL_TO_INT(a)", "INT#32767"),
        ("REAL", &["-1.0e9"], "REAL_TO_UINT(a)", "UINT#0"),
        ("REAL", &["NaN"], "REAL_TO_INT(a)", "INT#0"),
        ("REAL", &["NaN"], "TO_BOOL(a)", "BOOL#1"),
        ("REAL", &["-0.0"], "TO_BOOL(a)", "BOOL#0"),
        ("LREAL", &["1.0e300"], "LREAL_TO_REAL(a)", "REAL#inf"),
        ("LREAL", &["0.1"], "TO_REAL(a)", "REAL#0.10000000149011612"),
        ("BOOL", &["TRUE"], "BOOL_TO_REAL(a)", "REAL#1.0"),
        ("INT", &["256"], "INT_TO_BOOL(a)", "BOOL#1"),
        ("REAL", &["300.5"], "REAL_TO_BYTE(a)", "BYTE#255"),
        ("REAL", &["2.9"], "TRUNC(a)", "INT#2"),
        ("REAL", &["-2.9"], "TRUNC(a)", "DINT#-2"),
        ("REAL", &["-0.9"], "REAL_TRUNC_SINT(a)", "SINT#0"),
        ("LREAL", &["4503599627370495.5"], "TRUNC_LINT(a)", "LINT#4503599627370495"),
        ("LREAL", &["1.8e19"], "TRUNC_ULINT(a)", "ULINT#18000000000000000000"),
        ("LREAL", &["-1.0e300"], "TRUNC_INT(a)", "INT#-32768"),
        ("LREAL", &["NaN"], "TRUNC_INT(a)", "INT#0"),
        ("TIME", &["T#1s999ms"], "TIME_TO_INT(a)", "INT#1"),
        ("TIME", &["-T#1s999ms"], "TIME_TO_DINT(a)", "DINT#-1"),
        ("TIME", &["T#18h12m16s"], "TIME_TO_INT(a)", "INT#0"),
        ("TIME", &["T#250ms"], "TIME_TO_REAL(a)", "REAL#0.25"),
        ("TIME", &["T#1ms"], "TIME_TO_BOOL(a)", "BOOL#1"),
        ("INT", &["-3"], "INT_TO_TIME(a)", "TIME#-3000000000"),
        ("LINT", &["9223372036854775807"], "LINT_TO_TIME(a)", "TIME#-1000000000"),
        ("REAL", &["0.25"], "REAL_TO_TIME(a)", "TIME#250000000"),
        ("LREAL", &["1.0e300"], "LREAL_TO_TIME(a)", "TIME#9223372036854775807"),
        ("REAL", &["NaN"], "TO_TIME(a)", "TIME#0"),
        ("BOOL", &["TRUE"], "TO_TIME(a)", "TIME#1000000000"),
    ]);
}

#[test]
fn every_pair_of_types_converts_alike_everywhere() {
    for from in Elementary::ALL {
        let (values, extra): (&[&str], &[&str]) = match from {
            Elementary::Bool => (&["FALSE", "TRUE"], &[]),
            Elementary::Time => (&["T#0s", "T#1500ms", "-T#1ns"], &["T#-9223372036854775808ns"]),
            ty if ty.is_real() => (&["0.0", "-0.5", "1.5", "3.0e38", "-3.0e38"], &["NaN"]),
            ty if ty.is_signed() => (&["0", "-1", "127", "-128"], &[]),
            _ => (&["0", "1", "255"], &[]),
        };
        for to in Elementary::ALL {
            for value in values.iter().chain(extra) {
                let _ = computed(&text(from.name(), &[value], to.name(), &format!("{from}_TO_{to}(a)")));
            }
        }
    }
}

/// The codes of the errors of a program, and all that is said of them.
fn errors(text: &str) -> (Vec<Code>, String) {
    let source = Source::new("errors.rung", text);
    let parsed = frontend::parse(&source);
    let (_, mut problems) = check::check(&parsed.program);
    problems.splice(0..0, parsed.diagnostics);
    problems.retain(diagnostic::Diagnostic::is_error);
    (problems.iter().map(|problem| problem.code).collect(), diagnostic::render(&source, &problems))
}

#[test]
fn wrong_calls_are_told_with_a_code_and_a_hint() {
    use Code::{
        DuplicatePin, OutOfRange, TypeMismatch, UndeclaredName, UnexpectedToken, UnknownFunction, UnknownPin,
        WrongArguments,
    };
    let cases = [
        ("LIMT(0, n, 10)", vec![UnknownFunction], "did you mean `LIMIT`?"),
        ("INT_TO_REEL(n)", vec![UnknownFunction], "did you mean `INT_TO_REAL`?"),
        ("TON(n)", vec![UnknownFunction], "a block is called in the rung"),
        ("LIMIT(0, n)", vec![WrongArguments], "its parameters are LIMIT(MN, IN, MX)"),
        ("ADD(n)", vec![WrongArguments], "at least 2 arguments, and this is 1"),
        ("ABS()", vec![WrongArguments], "its parameters are ABS(IN)"),
        ("SEL(G := on, n, n)", vec![WrongArguments], "either all arguments name their parameters or none does"),
        ("SEL(G := on, IN0 := n)", vec![WrongArguments], "a parameter has no argument"),
        ("ADD(IN1 := n, IN2 := n, IN4 := n)", vec![WrongArguments], "its parameters are ADD(IN1, IN2, …)"),
        ("ABS(X := n)", vec![UnknownPin], "its parameters are ABS(IN)"),
        ("ABS(EN := on, IN := n)", vec![UnknownPin], "the power before the braces"),
        ("ADD(IN1 := n, IN2 := n, in1 := n)", vec![DuplicatePin], "an argument already"),
        ("SQRT(n)", vec![TypeMismatch], "SQRT works on REAL and LREAL, and this is an INT"),
        ("MAX(n, on)", vec![TypeMismatch], "MAX takes operands of one type, and these are INT, BOOL"),
        ("SHL(n, 1)", vec![TypeMismatch], "SHL works on BYTE, WORD, DWORD and LWORD"),
        ("MUX(on, n, n)", vec![TypeMismatch], "MUX works on integers, and this is a BOOL"),
        ("MIN(n, 40000)", vec![OutOfRange], "INT holds -32768 to 32767"),
        ("REAL_TO_INT(on)", vec![TypeMismatch], "a REAL is expected here"),
        ("LIMIT(0, x, y)", vec![UndeclaredName, UndeclaredName], "`y`"),
        ("DIV(T#1s, ULINT#1)", vec![TypeMismatch], "an LINT is expected here"),
        ("ABS(-INT#32768)", vec![OutOfRange], "outside the range of INT"),
        ("n.3(n)", vec![UnexpectedToken], ""),
        ("AND n", vec![UnexpectedToken], "stands between two values"),
        ("ABS(-n := 3)", vec![UnexpectedToken], "the name of a parameter"),
        ("ABS(n", vec![Code::Unclosed], ""),
    ];
    for (expression, codes, words) in cases {
        let text = format!("var n : INT\ninput on\nrung r\n{{n := {expression}}}\n");
        let (found, said) = errors(&text);
        assert_eq!(found, codes, "{expression}\n{said}");
        assert!(said.contains(words), "{expression}\n{said}");
    }
}

#[test]
fn calls_of_constants_are_constants() {
    let text = "const low : INT := 3
const n : INT := MAX(low, 7, MUL(2, 5))
const r : LREAL := EXPT(SQRT(2.25), 2)
const w : WORD := ROL(16#8001, 1)
var result : INT := LIMIT(0, n * 2, 15)
var x : LREAL := r
var y : WORD := w
rung r1
{x > 0.0} {y > 0} {result := result}
";
    assert_eq!(computed(text), "INT#15");
    let (found, said) = errors("var n : INT\nvar x : INT := ABS(n)\nrung r\n{x := n}\n");
    assert_eq!(found, [Code::NotConstant], "{said}");
}

#[test]
fn a_literal_takes_the_type_that_is_wanted_where_no_operand_has_one() {
    table(&[
        ("BOOL", &["TRUE"], "SEL(a, 1, 200)", "USINT#200"),
        ("BOOL", &["TRUE"], "SEL(a, 1, 100000)", "DINT#100000"),
        ("INT", &["1"], "MUX(a, 0.5, 0.1)", "LREAL#0.1"),
        ("INT", &["3"], "SHL(16#1001, a)", "DWORD#32776"),
        ("INT", &["3"], "MAX(a, 2.5)", "REAL#3.0"),
        ("REAL", &["9.0"], "SQRT(a) + 1.0", "REAL#4.0"),
    ]);
    // Within a formula, the first usual type that holds them.
    assert_eq!(computed("var result : DINT\ninput on\nrung r\n{result := 1 + SEL(on, 40000, 1)}"), "DINT#40001");
}
