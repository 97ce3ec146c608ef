//! Programs that were once written as something else: each has the same trace when it is read again, or is refused.

use rung::check::{Checked, check};
use rung::diagnostic::{Code, Diagnostic};
use rung::frontend::{self, structured_text};
use rung::ladder::Program;
use rung::source::Source;

use crate::support::same_trace::same_trace;

fn read(name: &str, text: &str) -> (Program, Checked) {
    let parsed = frontend::parse(&Source::new(name, text));
    assert_eq!(parsed.diagnostics, [], "{text}");
    let (checked, problems) = check(&parsed.program);
    let errors: Vec<Diagnostic> = problems.into_iter().filter(Diagnostic::is_error).collect();
    (parsed.program, checked.unwrap_or_else(|| panic!("{errors:?}\n{text}")))
}

/// Writes the program of some native text, reads it again and compares; gives what was written.
fn comes_back(text: &str) -> String {
    let (program, drawn) = read("drawn.rung", text);
    let written = structured_text::print(&program).unwrap_or_else(|problems| panic!("{problems:?}\n{text}"));
    let (_, again) = read("written.st", &written);
    for seed in 0..5 {
        assert_eq!(same_trace(&drawn, &again, seed, 200, |_| true), Ok(()), "{written}");
    }
    written
}

fn is_refused(text: &str) {
    let (program, _) = read("drawn.rung", text);
    let problems = structured_text::print(&program).expect_err(text);
    assert!(problems.iter().all(|problem| problem.code == Code::CannotConvert), "{problems:?}\n{text}");
}

#[test]
fn eno_of_a_box_that_is_not_enabled_is_written_false() {
    let before = "function half : INT\n  input x : INT\nrung {half := x / 2}\n\
                  program p\n  input a, b\n  input n : INT\n  output q, e\n  var m : INT\n  var t : TON\n  var c : CTU\n";
    for rung in [
        "a half(x := n, OUT => m, ENO => e)",
        "a half(x := n, ENO => e) (q)",
        "a ADD(EN := b, IN1 := n, IN2 := 1, OUT => m, ENO => e)",
        "a ADD(IN1 := n, IN2 := 1, ENO => e) (q)",
        "a GT(IN1 := n, IN2 := 1, ENO => e).OUT (q)",
        "{half(EN := a, x := n, OUT => m, ENO => e);}",
        "t(EN := a, PT := T#5ms, ENO => e) (q)",
        "a t(EN := b, IN := FALSE, PT := T#5ms, ENO => e) (q)",
        "a c(CU := b, PV := 3, ENO => e).ENO (q)",
        "FALSE c(CU := b, PV := 3, ENO => e) (q)",
    ] {
        comes_back(&format!("{before}rung\n  {rung}\n"));
    }
}

#[test]
fn an_index_out_of_range_takes_eno_away_or_the_box_is_refused() {
    let before = "program p\n  input a\n  input n : INT\n  output q, e\n  var m : INT\n  var c : CTU\n\
                  var x : array [0..2] of INT := [3(1)]\n  var y : array [0..2] of BOOL\n";
    for rung in [
        "c(CU := a, PV := x[n]).ENO (q)",
        "a c(CU := TRUE, PV := x[n], ENO => e) (q)",
        "c(CU := a, PV := 1, ENO => y[n])",
        "ADD(IN1 := x[n], IN2 := 1, OUT => m) (q)",
    ] {
        comes_back(&format!("{before}rung\n  {rung}\n"));
    }
    for rung in [
        "c(CU := a, PV := x[n], ENO => e).ENO (q)",
        "ADD(EN := NOT y[n], IN1 := n, IN2 := 1, OUT => m) (q)",
        "a ADD(IN1 := n, IN2 := 1, OUT => m, ENO => y[n])",
        "ADD(IN1 := x[n], IN2 := 1) (q)",
        "DIV(IN1 := m, IN2 := n) (q)",
        "{ADD(EN := a, IN1 := n, IN2 := 1, OUT => m, ENO => y[n]);}",
    ] {
        is_refused(&format!("{before}rung\n  {rung}\n"));
    }
}

#[test]
fn a_second_jump_to_a_rung_skips_what_lies_between() {
    let written = comes_back(
        "program p\n  input a, b\n  output q, r\n\
         rung\n  a >> last\nrung\n  b >> last\nrung\n  /q (q)\nrung last\n  q (r)\n",
    );
    assert_eq!(written.matches("IF NOT skip1 THEN").count(), 2, "{written}");
}

#[test]
fn a_box_moves_a_whole_array() {
    let written = comes_back(
        "program p\n  input a\n  input x : array [0..2] of INT\n  output y : array [0..2] of INT\n\
         rung\n  a MOVE(IN := x, OUT => y)\n",
    );
    assert!(written.contains("y := x;"), "{written}");
}

#[test]
fn a_circuit_at_a_pin_that_writes_the_pin_before_it_is_refused() {
    is_refused(
        "program p\n  input a, b\n  var t : R_TRIG\n  var c : CTD\n\
         rung\n  a c(LD := [ b {t(CLK := b, Q => c.CD);} ], PV := 4)\n",
    );
}

#[test]
fn an_index_out_of_range_takes_the_power_behind_a_condition() {
    comes_back(
        "program p\n  input a\n  input n : INT\n  output q\n  var x : array [0..2] of BOOL\n\
         rung\n  {a XOR x[n]} (q)\n",
    );
}

#[test]
fn power_behind_a_moved_array_that_an_index_decides_is_refused() {
    let before = "type row : array [0..1] of INT\nprogram p\n  input n : INT\n  output q\n\
                  var x : array [0..2] of row\n  var y : row\n";
    for rung in ["MOVE(IN := y, OUT => x[n]) (q)", "{x[n] := y} (q)"] {
        is_refused(&format!("{before}rung\n  {rung}\n"));
    }
}

#[test]
fn a_not_without_a_place_for_its_result_is_refused() {
    is_refused("program p\ninput a\noutput q\nrung\n  a {`NOT`(IN := a); q := a;}\n");
}

#[test]
fn an_index_in_a_circuit_at_a_pin_does_not_take_eno_away() {
    comes_back(
        "program p\ninput n : INT\noutput q\nvar c : CTD\nvar y : array [0..2] of BOOL\n\
         rung\n  c(LD := [ y[n] ], PV := 3).ENO (S q)\n",
    );
}

#[test]
fn an_input_that_enable_reads_is_set_though_the_call_is_not_enabled() {
    let written = comes_back("program p\ninput a\nvar c : CTU\nrung\n  a c(EN := c.CU, PV := 2)\n");
    assert!(written.contains("EN := "), "{written}");
}

#[test]
fn eno_and_an_output_that_go_to_one_variable_are_refused() {
    is_refused("program p\ninput a\noutput q\nvar c : CTU\nrung\n  a c(CU := a, PV := 2, ENO => q, Q => q)\n");
}
