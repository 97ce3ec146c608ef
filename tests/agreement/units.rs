//! Function blocks and functions of the program's own: what each instance keeps, what stands for the caller's variables.

use crate::support::script::follows;

#[test]
fn every_instance_has_its_own_variables_timers_and_edges() {
    follows(
        "function_block counts
input run
output n : INT
output late
var t : TON
rung
  ^run {n := n + 1}
rung
  run t(PT := T#10ms) (late)
program p
input a, b
var one, two : counts
rung
  a one() 
rung
  b two()",
        "ms a b | one.n two.n one.late two.late
         0  1 0 | 1     0     0        0
         5  1 1 | 1     1     0        0
         10 0 1 | 1     1     0        0
         15 1 1 | 2     1     0        1
         25 1 0 | 2     1     1        0
         26 0 1 | 2     2     0        0",
    );
}

#[test]
fn an_input_that_is_not_wired_keeps_its_value() {
    follows(
        "function_block adds
input go
input step : INT := 5
output sum : INT
rung
  go {sum := sum + step}
program p
input a, b
output x : INT
var fb : adds
rung
  {IF b THEN fb(go := FALSE, step := 2); END_IF;}
rung
  a fb(sum => x)
rung
  {fb.step = 5} {fb.step := 3}",
        "ms a b | fb.sum x
         0  1 0 | 5      5
         1  1 0 | 8      8
         2  0 1 | 8      8
         3  1 0 | 10     10",
    );
}

#[test]
fn blocks_lie_in_blocks_and_in_arrays() {
    follows(
        "function_block inner
input x
output q
rung
  ^x (q)
function_block outer
input x
output n : INT
var c : array [0..1] of inner
rung
  x c[0]() {n := n + 1}
rung
  /x c[1]() {n := n + 10}
program p
input a, b
var fb : array [1..2] of outer
rung
  a fb[1]()
rung
  b fb[2]()",
        "ms a b | fb[1].n fb[2].n
         0  0 1 | 10      1
         1  1 1 | 11      1
         2  1 0 | 11      11
         3  0 1 | 21      12",
    );
}

#[test]
fn a_reference_is_the_callers_variable_itself() {
    follows(
        "function_block moves
input go
inout n : INT
inout list : array [0..2] of INT
output seen : INT
rung
  go {n := n + 1} {seen := n} {list[n] := seen}
program p
input a
var x, y : INT
var l : array [0..2] of INT
var fb : moves
rung
  a fb(n := x, list := l)
rung
  {y := x}",
        "ms a | x y fb.seen l[0] l[1] l[2] #fault
         0  1 | 1 1 1       0    1    0    0
         1  1 | 2 2 2       0    1    2    0
         2  0 | 2 2 2       0    1    2    0
         3  1 | 3 3 3       0    1    2    1",
    );
}

#[test]
fn the_index_of_a_reference_is_computed_once_at_the_call() {
    follows(
        "global i : INT
function_block bumps
input go
inout n : INT
rung
  go {n := n + 1} {i := i + 1} {n := n + 10}
program p
input a
output ok
var l : array [0..2] of INT
var fb : bumps
rung
  a fb(n := l[i]).ENO (ok)",
        "ms a | i l[0] l[1] l[2] ok #fault
         0  1 | 1 11   0    0    1  0
         1  1 | 2 11   11   0    1  0
         2  0 | 2 11   11   0    1  0
         3  1 | 3 11   11   11   1  0
         4  1 | 4 11   11   11   0  1",
    );
}

#[test]
fn two_references_may_be_one_variable() {
    follows(
        "function swap
inout a, b : INT
temp t : INT
rung
  {t := a; a := b; b := t;}
program p
input same
var x : INT := 1
var y : INT := 2
rung
  /same swap(a := x, b := y)
rung
  same swap(a := x, b := x)",
        "ms same | x y
         0  0    | 2 1
         1  1    | 2 1
         2  0    | 1 2",
    );
}

#[test]
fn a_function_starts_afresh_at_each_call() {
    follows(
        "function scale : INT
input x : INT
input factor : INT := 3
output calls : INT
var n : INT := 40
rung
  {n := n + 1; scale := x * factor; calls := n;}
program p
input a
input v : INT
output r, s, c : INT
output ok
rung
  {r := scale(x := v) + scale(x := 2, factor := v)}
rung
  a scale(x := v, factor := 2, OUT => s, calls => c) (ok)",
        "ms a v | r  s c  ok
         0  0 4 | 20 0 0  0
         1  1 5 | 25 10 41 1
         2  0 6 | 30 10 41 0",
    );
}

#[test]
fn a_jump_or_return_stays_within_its_unit() {
    follows(
        "function_block skips
input a, b
output n : INT
rung
  a >> behind
rung
  {n := n + 1}
rung behind
  b >> return
rung
  {n := n + 10}
program p
input a, b
var fb : skips
var m : INT
rung
  TRUE fb(a := a, b := b) {m := m + 1}
rung
  {m := m + 10}",
        "ms a b | fb.n m
         0  0 0 | 11   11
         1  1 0 | 21   22
         2  0 1 | 22   33
         3  1 1 | 22   44",
    );
}

#[test]
fn a_temporary_starts_afresh_at_each_run() {
    follows(
        "function_block sums
input x : INT
output s : INT
temp t : INT := 100
rung
  {t := t + x; s := t;}
program p
input v : INT
temp k : INT := 7
output o : INT
var fb : sums
rung
  {k := k + v; o := k;} fb(x := v)
rung
  fb(x := v + 1)",
        "ms v | o fb.s
         0  1 | 8 102
         1  5 | 12 106",
    );
}

#[test]
fn a_block_that_is_not_enabled_keeps_everything() {
    follows(
        "function_block latch
input set
output q
var n : INT
rung
  ^set {n := n + 1} 
rung
  {n > 1} (q)
program p
input a, e
output x, right
var fb : latch
rung
  a fb(EN := e, q => x) (right)",
        "ms a e | fb.q x right
         0  1 1 | 0    0 0
         1  0 0 | 0    0 0
         2  1 0 | 0    0 0
         3  1 1 | 0    0 0
         4  0 1 | 0    0 0
         5  1 1 | 1    1 1
         6  0 0 | 1    1 1",
    );
}

#[test]
fn a_block_that_is_jumped_over_keeps_everything() {
    follows(
        "function_block blinks
input go
output n : INT
output q
var t : TP
rung
  ^go {n := n + 1}
rung
  go t(PT := T#10ms) (q)
program p
input j, a
output x
var fb : blinks
rung
  j >> behind
rung
  a fb()
rung behind
  fb.q (x)",
        "ms j a | fb.n fb.q x
         0  0 1 | 1    1    1
         5  1 0 | 1    1    1
         9  1 1 | 1    1    1
         15 0 1 | 1    0    0
         16 0 0 | 1    0    0
         17 1 1 | 1    0    0
         18 0 1 | 2    1    1",
    );
}

#[test]
fn blocks_are_called_in_loops_and_keep_a_memory_each() {
    follows(
        "function_block edges
input x
output n : INT
rung
  ^x {n := n + 1}
function_block all
input a, b
output sum : INT
var fb : array [0..1] of edges
var i : INT
rung
  {fb[0](x := a); fb[1](x := b); sum := 0; FOR i := 0 TO 1 DO sum := sum * 10 + fb[i].n; END_FOR;}
rung
  {FOR i := 0 TO 2 DO fb[1](x := i = 1); END_FOR;}
program p
input a, b
var all_1 : all
rung
  {all_1(a := a, b := b);}",
        "ms a b | all_1.sum
         0  1 0 | 10
         1  1 1 | 12
         2  0 0 | 13
         3  1 1 | 25",
    );
}

#[test]
fn an_instance_may_be_given_as_a_reference() {
    follows(
        "function_block counts
input x
output n : INT
rung
  ^x {n := n + 1}
function_block twice
input x
inout c : counts
rung
  x c()
rung
  /x c()
program p
input a
var shared : counts
var fb : twice
rung
  a fb(c := shared)
rung
  a shared()",
        "ms a | shared.n
         0  0 | 1
         1  1 | 3
         2  1 | 4
         3  0 | 5",
    );
}

#[test]
fn a_register_is_declared_by_its_use_and_shared_by_all() {
    follows(
        "registers(hreg := 4)
function_block stores
input x : WORD
rung
  {hreg[1] := x}
program first
var fb : stores
rung
  fb(x := ireg[2])
program second
input i : INT
rung
  {oreg[0] := hreg[i]}",
        "ms ireg[2] second.i | hreg[1] oreg[0] #fault
         0  7       1        | 7       7       0
         1  8       0        | 8       0       0
         2  9       4        | 9       0       1",
    );
}

#[test]
fn a_function_gives_its_outputs_though_an_index_at_one_calls_it_again() {
    follows(
        "function shift : INT
input x : INT
output y : INT
rung
  {shift := x}
rung
  {y := x + 100}
program p
input a : INT
var cells : array [0..9] of INT
var result : INT
rung
  shift(x := a, y => cells[shift(x := 2)], OUT => result)",
        "ms a | cells[2] result
         0  1 | 101      1
         1  5 | 105      5",
    );
}

#[test]
fn a_block_reads_and_writes_what_a_program_declares_at_an_address() {
    follows(
        "function_block counts
input go
output seen : INT
rung
  go {%MW4 := %MW4 + 1} {seen := %MW4}
program p
input a
var n at %MW4 : INT := 5
var fb : counts
rung
  a fb()",
        "ms a | n fb.seen
         0  0 | 5 0
         1  1 | 6 6
         2  1 | 7 7",
    );
}

#[test]
fn an_output_of_no_instance_reads_as_its_default() {
    follows(
        "function_block counts
input go
output n : INT := 7
rung
  go {n := n + 1}
program p
input i : INT
output x, y : INT
var own : array [0..1] of counts
var standard : array [0..1] of CTU
rung
  [ own[0]() | own[1]() | standard[0](PV := 3) ]
rung
  {x := own[i].n} {y := standard[i].CV}",
        "ms i | x y #fault
         0  0 | 8 1 0
         1  1 | 9 0 0
         2  2 | 0 0 1",
    );
}

#[test]
fn a_function_that_is_not_enabled_leaves_what_its_caller_gave_it() {
    follows(
        "function inner
inout x : BOOL
var off : BOOL
rung {x := off}
function outer : BOOL
input e
var flag : BOOL := TRUE
rung
  inner(EN := e, x := flag)
rung {outer := flag}
program p
input e
output q, r
rung
  outer(e := e, OUT => q)
rung {r := outer(e)}",
        "ms e | q r
         0  0 | 1 1
         1  1 | 0 0
         2  0 | 1 1",
    );
}
