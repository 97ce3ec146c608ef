//! Boxes: EN and ENO of functions and blocks, and which output is the power on the right.

use crate::support::script::follows;

#[test]
fn a_function_box_runs_while_there_is_power_and_else_keeps_what_is_wired() {
    follows(
        "program p
input a
input n : INT
output x : INT
output ok
rung
  a ADD(IN1 := n, IN2 := x, OUT => x) (ok)",
        "ms a n | x ok
         0  0 3 | 0 0
         1  1 3 | 3 1
         2  0 4 | 3 0
         3  1 4 | 7 1",
    );
}

#[test]
fn both_the_power_and_en_must_be_on() {
    follows(
        "program p
input a, b
output x : INT
output ok
rung
  a ADD(EN := b, IN1 := x, IN2 := 1, OUT => x) (ok)",
        "ms a b | x ok
         0  0 1 | 0 0
         1  1 0 | 0 0
         2  1 1 | 1 1",
    );
}

#[test]
fn a_chosen_output_is_the_power_while_the_box_is_enabled() {
    follows(
        "program p
input a
input n : INT
output q
rung
  a GT(IN1 := n, IN2 := 5).OUT (q)",
        "ms a n | q
         0  1 6 | 1
         1  1 5 | 0
         2  0 6 | 0
         3  1 7 | 1",
    );
}

#[test]
fn an_integer_divided_by_zero_clears_eno() {
    follows(
        "program p
input n : INT
output x, y : INT
output z : REAL
output div_ok, mod_ok, wired, real_ok
rung
  DIV(IN1 := 7, IN2 := n, OUT => x, ENO => wired) (div_ok)
rung
  MOD(IN1 := 7, IN2 := n, OUT => y) (mod_ok)
rung
  DIV(IN1 := 7.0, IN2 := INT_TO_REAL(n), OUT => z) (real_ok)",
        "ms n | x y z   div_ok mod_ok wired real_ok
         0  2 | 3 1 3.5 1      1      1     1
         1  0 | 0 0 inf 0      0      0     1
         2  7 | 1 0 1   1      1      1     1",
    );
}

#[test]
fn an_operator_that_divides_by_zero_clears_nothing() {
    follows(
        "program p
input n : INT
output x : INT
output q
rung
  {x := 7 / n} ADD(IN1 := 7 MOD n, IN2 := 1, OUT => x) (q)",
        "ms n | x q
         0  2 | 2 1
         1  0 | 1 1",
    );
}

#[test]
fn of_a_block_the_power_on_the_left_is_an_input_beside_en() {
    follows(
        "program p
input a, b
output q, ok
rung
  a t:TON(EN := b, PT := T#10ms, ENO => ok) (q)",
        "ms a b | q t.ET ok
         0  1 1 | 0 0    1
         5  1 1 | 0 5    1
         20 1 0 | 0 5    0
         30 0 0 | 0 5    0
         40 1 1 | 1 10   1
         50 0 0 | 1 10   0
         60 0 1 | 0 0    1",
    );
}

#[test]
fn eno_may_be_the_power_on_the_right_of_a_block() {
    follows(
        "program p
input a, b
output q
rung
  a c:CTU(EN := b, PV := 9).ENO (q)",
        "ms a b | q c.CV
         0  0 1 | 1 0
         1  1 0 | 0 0
         2  1 1 | 1 1",
    );
}

#[test]
fn a_conversion_and_a_choice_are_boxes_like_others() {
    follows(
        "program p
input g
input n : INT
output r : REAL
output x : INT
output moved : INT
rung
  INT_TO_REAL(IN := n, OUT => r) SEL(G := g, IN0 := n, IN1 := 9, OUT => x) MOVE(IN := x, OUT => moved)",
        "ms g n  | r  x moved
         0  0 -3 | -3 -3 -3
         1  1 4  | 4  9  9",
    );
}

#[test]
fn a_statement_that_moves_a_whole_row_says_whether_there_is_one() {
    follows(
        "type row : array [0..1] of INT
program p
input i : INT
input e
var rows : array [0..1] of row
var one : row := [7, 8]
output ok
rung
  {MOVE(EN := e, IN := one, OUT => rows[i], ENO => ok);}",
        "ms i e | ok rows[1][0]
         0  1 1 | 1  7
         1  2 1 | 0  7
         2  1 0 | 0  7
         3  0 1 | 1  7",
    );
}
