//! Indices out of range: what is read, what is lost, what loses its power, and what is remembered of it.

use crate::support::script::follows;

#[test]
fn what_is_read_is_the_default_and_what_is_written_is_lost() {
    follows(
        "program p
input i : INT
output x : INT
output ok, later
var a : array [1..3] of INT := [7, 8, 9]
rung
  {x := a[i]} (ok)
rung
  {a[i + 1] := 5} (later)",
        "ms i      | x a[1] a[2] a[3] ok later #fault
         0  2      | 8 7    8    5    1  1     0
         1  3      | 5 7    8    5    1  0     1
         2  4      | 0 7    8    5    0  0     1
         3  0      | 0 5    8    5    0  1     1
         4  -32768 | 0 5    8    5    0  0     1
         5  1      | 5 5    5    5    1  1     1",
    );
}

#[test]
fn an_index_that_would_lead_into_the_next_row_is_out_of_range_too() {
    follows(
        "program p
input i, j : INT
output x : INT
var m : array [0..1, 0..2] of INT := [1, 2, 3, 4, 5, 6]
rung
  {x := m[i, j]}",
        "ms i j  | x #fault
         0  0 2  | 3 0
         1  0 3  | 0 1
         2  1 -1 | 0 1
         3  1 2  | 6 1",
    );
}

#[test]
fn without_power_or_jumped_over_an_index_is_no_fault() {
    follows(
        "program p
input a, j
input i : INT
output x : INT
output q
var b : array [0..1] of BOOL := [TRUE, TRUE]
rung
  j >> behind
rung
  a {x := i} b[i] (q)
rung
  a (b[i]) 
rung behind
  a {x := x + 1}",
        "ms a j i | x q b[0] b[1] #fault
         0  0 0 9 | 0 0 1    1    0
         1  1 1 9 | 1 0 1    1    0
         2  1 0 1 | 2 1 1    1    0
         3  0 0 7 | 2 0 1    1    0
         4  1 0 7 | 8 0 1    1    1
         5  0 0 0 | 8 0 0    1    1",
    );
}

#[test]
fn a_closed_contact_on_no_element_conducts() {
    follows(
        "program p
input i : INT
output q, r
var b : array [0..1] of BOOL := [TRUE, FALSE]
rung
  /b[i] (q)
rung
  b[i] (r)",
        "ms i | q r #fault
         0  0 | 0 1 0
         1  1 | 1 0 0
         2  2 | 1 0 1",
    );
}

#[test]
fn a_condition_on_no_element_does_not_conduct() {
    follows(
        "program p
input i : INT
output q
var a : array [0..1] of INT := [0, 1]
rung
  {a[i] = 0} (q)",
        "ms i | q #fault
         0  0 | 1 0
         1  1 | 0 0
         2  2 | 0 1",
    );
}

#[test]
fn what_a_statement_does_not_execute_is_no_fault() {
    follows(
        "program p
input i : INT
output x : INT
output ok
var a : array [0..2] of INT := [1, 2, 3]
rung
  {IF i < 0 THEN x := 0; ELSIF a[i] = 2 THEN x := 10; ELSE x := a[i - 1]; END_IF;} (ok)",
        "ms i  | x  ok #fault
         0  -1 | 0  1  0
         1  1  | 10 1  0
         2  2  | 2  1  0
         3  0  | 0  0  1
         4  -1 | 0  1  1",
    );
}

#[test]
fn a_pin_with_an_index_out_of_range_clears_eno_and_the_block_runs() {
    follows(
        "program p
input i : INT
output x, y : INT
output ok, full
var a : array [0..1] of INT := [4, 1]
rung
  ADD(IN1 := a[i], IN2 := 1, OUT => x) (ok)
rung
  SUB(IN1 := 10, IN2 := i, OUT => a[i])
rung
  TRUE c:CTU(PV := a[i], R := FALSE, CV => y, ENO => full)",
        "ms i | x a[0] a[1] ok y c.CV full #fault
         0  0 | 5 10   1    1  1 1    1    0
         1  2 | 1 10   1    0  1 1    0    1
         2  1 | 2 10   9    1  1 1    1    1",
    );
}

#[test]
fn a_call_that_is_not_enabled_is_no_fault() {
    follows(
        "program p
input a
input i : INT
output x : INT
var t : array [0..1] of INT := [4, 1]
rung
  a ADD(IN1 := t[i], IN2 := 1, OUT => t[i])
rung
  c:CTU(EN := a, PV := t[i], CV => x)",
        "ms a i | t[0] t[1] x #fault
         0  0 7 | 4    1    0 0
         1  1 1 | 4    2    1 0
         2  0 2 | 4    2    1 0
         3  1 2 | 4    2    1 1",
    );
}

#[test]
fn a_structure_out_of_range_reads_as_zeros_and_is_not_written() {
    follows(
        "type point : struct x : INT := 4 y : REAL := 0.5 end_struct
program p
input i, k : INT
output ok
var pts : array [0..1] of point
rung
  {pts[k] := pts[i];} (ok)",
        "ms i k | pts[0].x pts[0].y pts[1].x pts[1].y ok #fault
         0  1 0 | 4        0.5      4        0.5      1  0
         1  1 2 | 4        0.5      4        0.5      0  1
         2  2 1 | 4        0.5      0        0        0  1
         3  0 1 | 4        0.5      4        0.5      1  1",
    );
}

#[test]
fn a_reference_to_no_element_reads_as_zero_and_loses_what_is_written() {
    follows(
        "function takes : INT
inout n : INT
rung
  {takes := n * 10; n := n + 1; takes := takes + n;}
program p
input a
input i : INT
output x : INT
output ok, boxed
var l : array [0..1] of INT := [3, 5]
rung
  a {x := takes(n := l[i])} (ok)
rung
  a takes(n := l[i]) (boxed)",
        "ms a i | x  l[0] l[1] ok boxed #fault
         0  1 0 | 34 5    5    1  1     0
         1  0 9 | 34 5    5    0  0     0
         2  1 1 | 56 5    7    1  1     0
         3  1 2 | 0  5    7    0  0     1",
    );
}

#[test]
fn a_fault_inside_of_a_function_takes_no_power_from_its_caller() {
    follows(
        "global l : array [0..1] of INT := [3, 5]
function looks : INT
input i : INT
rung
  {looks := l[i] + 1}
program p
input a
input i : INT
output x : INT
output ok, more
rung
  a {x := looks(i)} (ok)
rung
  {looks(i) > 3} (more)",
        "ms a i  | x ok more #fault
         0  1 0  | 4 1  1    0
         1  0 1  | 4 0  1    0
         2  0 -1 | 4 0  0    1
         3  1 -1 | 1 1  0    1",
    );
}

#[test]
fn what_is_computed_for_nothing_is_no_fault_and_has_no_effect() {
    follows(
        "global calls : INT
global l : array [0..1] of INT := [3, 5]
function counts : INT
input i : INT
rung
  {calls := calls + 1; counts := l[i];}
program p
input a
input i : INT
output x : INT
output q
rung
  a {x := counts(i)}
rung
  a {counts(i) > 4} (q)
rung
  {IF a THEN x := x + 1; ELSIF counts(i) = 5 THEN x := 0; END_IF;}",
        "ms a i | x calls q #fault
         0  1 0 | 4 2     0 0
         1  1 1 | 6 4     1 0
         2  0 0 | 6 5     0 0
         3  0 1 | 0 6     0 0
         4  1 7 | 1 8     0 1",
    );
}

#[test]
fn an_index_is_no_fault_where_a_function_that_uses_it_is_not_called() {
    follows(
        "global l : array [0..1] of INT := [3, 5]
function looks : INT
input i : INT
rung
  {looks := l[i]}
program p
input a
input i : INT
output x : INT
rung
  a {x := looks(i)}
rung
  a looks(i := i, OUT => x)",
        "ms a i | x #fault
         0  1 1 | 5 0
         1  0 9 | 5 0
         2  1 9 | 0 1",
    );
}
