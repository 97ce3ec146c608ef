//! Statements in braces: what is executed, in which order, and what leaves what.

use crate::support::script::follows;

#[test]
fn statements_execute_in_order_while_there_is_power_and_pass_it_on() {
    follows(
        "program p
input a
output q
var n, m : INT
rung
  a {n := n + 1; m := n * 2; n := m;} (q)",
        "ms a | n m q
         0  0 | 0 0 0
         1  1 | 2 2 1
         2  1 | 6 6 1
         3  0 | 6 6 0",
    );
}

#[test]
fn the_first_condition_that_holds_chooses_the_branch() {
    follows(
        "program p
input n : INT
output x : INT
rung
  {IF n > 10 THEN x := 1; ELSIF n > 5 THEN x := 2; ELSIF n > 3 THEN x := x + 10; ELSE x := 4; END_IF;}
rung
  {IF n = 0 THEN x := 0; END_IF;}",
        "ms n  | x
         0  11 | 1
         1  6  | 2
         2  4  | 12
         3  3  | 4
         4  0  | 0
         5  5  | 10",
    );
}

#[test]
fn a_case_is_the_first_range_that_holds_the_selector() {
    follows(
        "program p
input n : INT
output x : INT
rung
  {CASE n OF -1, 5: x := 1; 3..6: x := 2; 7: ; ELSE x := 9; END_CASE;}",
        "ms n  | x
         0  -1 | 1
         1  5  | 1
         2  6  | 2
         3  7  | 2
         4  8  | 9
         5  3  | 2
         6  0  | 9",
    );
}

#[test]
fn a_loop_counts_one_step_past_its_end() {
    follows(
        "program p
input a
var i, up, down, never : INT
var s : SINT
var sum : INT
rung
  {sum := 0; FOR i := 1 TO 4 DO sum := sum + i; END_FOR; up := i;}
rung
  {FOR i := 9 TO 1 BY -3 DO sum := sum * 2; END_FOR; down := i;}
rung
  {FOR i := 5 TO 4 DO sum := 0; END_FOR; never := i;}
rung
  a {FOR s := 120 TO 127 BY 7 DO sum := sum + 1; END_FOR;}",
        "ms a | sum up down never s
         0  0 | 80  5  0    5     0
         1  1 | 82  5  0    5     -122",
    );
}

#[test]
fn exit_leaves_the_inner_loop_only_and_keeps_the_count() {
    follows(
        "program p
input n : INT
var i, j, times : INT
rung
  {times := 0;
      FOR i := 0 TO 2 DO
        FOR j := 0 TO 9 DO
          IF j = n THEN EXIT; END_IF;
          times := times + 1;
        END_FOR;
      END_FOR;}",
        "ms n  | times i j
         0  3  | 9     3 3
         1  0  | 0     3 0
         2  20 | 30    3 10",
    );
}

#[test]
fn a_loop_may_write_elements_and_its_own_variable() {
    follows(
        "program p
input n : INT
var i : INT
var a : array [0..3] of INT
rung
  {FOR i := 0 TO 3 DO a[i] := n + i; IF i = 1 THEN i := 7; END_IF; END_FOR;}",
        "ms n  | a[0] a[1] a[2] a[3] i #fault
         0  5  | 5    6    7    8    4 0",
    );
}

#[test]
fn return_leaves_the_program_out_of_any_depth() {
    follows(
        "program p
input n : INT
output q
var i, m, k : INT
rung
  {m := m + 1; FOR i := 0 TO 3 DO IF i = n THEN RETURN; END_IF; END_FOR; k := k + 1;} (q)
rung
  {k := k + 10}",
        "ms n | m k  i q
         0  9 | 1 11 4 1
         1  2 | 2 11 2 1
         2  4 | 3 22 4 1",
    );
}

#[test]
fn a_call_in_a_statement_keeps_the_inputs_that_it_does_not_name() {
    follows(
        "program p
input a, b
output q
var t : TON
var n : INT
var c : CTU := (PV := 2)
rung
  a {t(IN := b, PT := T#10ms); n := n + 1;}
rung
  {c(CU := b); c(R := n > 3); q := c.Q;}",
        "ms a b | t.Q t.ET n c.CV q
         0  1 1 | 0   0    1 1    0
         10 1 1 | 1   10   2 1    0
         20 0 0 | 1   10   2 1    0
         30 0 1 | 1   10   2 2    1
         40 1 0 | 0   0    3 2    1
         50 1 0 | 0   0    4 0    0",
    );
}

#[test]
fn a_block_that_is_not_called_in_its_branch_does_not_run() {
    follows(
        "program p
input a, b
var up, down : CTU
rung
  {IF a THEN up(CU := b, PV := 9); ELSE down(CU := b, PV := 9); END_IF;}",
        "ms a b | up.CV down.CV
         0  1 1 | 1     0
         1  0 1 | 1     1
         2  1 0 | 1     1
         3  1 1 | 2     1
         4  0 1 | 2     1",
    );
}
