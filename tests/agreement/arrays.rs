//! Arrays and structures: elements with constant and with computed indices, and what they start with.

use crate::support::oracle::Oracle;
use crate::support::rig::Rig;
use crate::support::script::{checked_text, follows};

#[test]
fn an_element_is_chosen_by_what_its_index_holds_now() {
    follows(
        "program p
input i, v : INT
output x : INT
var a : array [-1..2] of INT := [10, 20, 30, 40]
rung
  {x := a[i]} {a[i] := v}
rung
  {a[2] := a[2] + 1}",
        "ms  i  v | x   a[-1] a[0] a[1] a[2]  #fault
         0  -1 5 | 10  5     20   30   41    0
         1   0 6 | 20  5      6   30   42    0
         2   2 7 | 42  5      6   30    8    0
         3  -1 9 | 5   9      6   30    9    0",
    );
}

#[test]
fn of_many_dimensions_the_last_runs_fastest() {
    follows(
        "program p
input i, j : INT
output x : INT
var m : array [0..1, 1..3] of INT := [1, 2, 3, 4, 5, 6]
rung
  {x := m[i, j]} {m[i, 1] := m[1, j] * 10}",
        "ms i j | x m[0,1] m[0,2] m[0,3] m[1,1] m[1,2] m[1,3] #fault
         0  0 2 | 2 50     2      3      4      5      6      0
         1  1 3 | 6 50     2      3      60     5      6      0
         2  0 1 | 50 600   2      3      60     5      6      0",
    );
}

#[test]
fn members_lie_in_elements_and_elements_in_members() {
    follows(
        "type point : struct x, y : INT := 3 tag : array [0..1] of BOOL end_struct
program p
input i, k : INT
output s : INT
var pts : array [0..2] of point := [(x := 1), (x := 2, y := 7), 1((tag := [TRUE, FALSE]))]
var one : point := (y := 9)
rung
  {s := pts[i].x * 100 + pts[i].y} {pts[k].y := one.y} {pts[2].tag[k] := pts[i].tag[0]}
rung
  pts[2].tag[1] (one.tag[1])",
        "ms i k | s   pts[0].y pts[1].y pts[2].y pts[2].tag[0] pts[2].tag[1] one.tag[1] #fault
         0  0 1 | 103 3        9        3        1             0             0          0
         1  1 0 | 209 9        9        3        0             0             0          0
         2  2 0 | 303 9        9        3        0             0             0          0",
    );
}

#[test]
fn an_index_may_be_an_element_itself() {
    follows(
        "program p
input i : INT
output x : INT
var next : array [0..3] of INT := [2, 3, 1, 0]
rung
  {x := next[next[i]]} {next[next[3]] := x}",
        "ms i | x next[0] next[1] next[2] next[3] #fault
         0  0 | 1 1       3       1       0       0
         1  1 | 0 0       3       1       0       0
         2  2 | 3 3       3       1       0       0",
    );
}

#[test]
fn contacts_and_coils_on_an_element_follow_the_index() {
    follows(
        "program p
input i : INT
output q
var b : array [0..2] of BOOL := [TRUE, FALSE, TRUE]
rung
  b[i] (q)
rung
  /b[i] (S b[2]) (R b[0])",
        "ms i | q b[0] b[1] b[2] #fault
         0  0 | 1 1    0    1    0
         1  1 | 0 0    0    1    0
         2  0 | 0 0    0    1    0
         3  2 | 1 0    0    1    0",
    );
}

#[test]
fn an_edge_contact_remembers_what_it_read_whichever_element_that_was() {
    follows(
        "program p
input i : INT
output q
var b : array [0..2] of BOOL := [FALSE, TRUE, TRUE]
rung
  ^b[i] (q)",
        "ms i | q
         0  0 | 0
         1  1 | 1
         2  2 | 0
         3  0 | 0
         4  2 | 1",
    );
}

#[test]
fn one_bit_of_an_element_is_read_and_written_alone() {
    follows(
        "program p
input i : INT
output q
var w : array [0..1] of WORD := [16#8000, 16#7FFF]
rung
  w[i].15 (q) (w[1].0)
rung
  (/w[i].3)",
        "ms i | q w[0]  w[1]  #fault
         0  0 | 1 32768 32767 0
         1  1 | 0 32768 32758 0",
    );
}

#[test]
fn all_of_an_array_or_structure_is_copied_at_once() {
    follows(
        "type point : struct x : INT y : REAL end_struct
program p
input i : INT
var a : array [0..2] of INT := [1, 2, 3]
var b : array [0..2] of INT
var pts : array [0..2] of point := [(x := 1, y := 0.5), (x := 2, y := 1.5), (x := 3, y := 2.5)]
rung
  {b := a; a[0] := a[0] + 1; pts[0] := pts[i]; pts[i] := pts[2];}",
        "ms i | a[0] b[0] b[1] b[2] pts[0].x pts[0].y pts[1].x pts[1].y pts[2].x #fault
         0  1 | 2    1    2    3    2        1.5      3        2.5      3        0
         1  0 | 3    2    2    3    3        2.5      3        2.5      3        0",
    );
}

#[test]
fn a_reference_to_pins_may_give_them_what_they_start_with() {
    follows(
        "program p
input a
output q
var t : TON := (PT := T#20ms)
var c : array [1..2] of CTU := [(PV := 2), (PV := 1)]
rung
  a t() (q)
rung
  a c[1]()
rung
  ^a c[2]()",
        "ms a | q t.ET c[1].Q c[1].CV c[2].Q c[2].CV
         0  0 | 0 0    0      0       0      0
         10 1 | 0 0    0      1       1      1
         20 1 | 0 10   0      1       1      1
         30 1 | 1 20   0      1       1      1
         40 0 | 0 0    0      1       1      1
         50 1 | 0 0    1      2       1      1",
    );
}

#[test]
fn everything_that_is_declared_has_a_name_and_of_instances_the_outputs() {
    let checked = checked_text(
        "type point : struct x, y : INT end_struct
global total : DINT
global grid : array [0..1, -1..0] of BOOL
function_block inner
input set
output hit
output at : point
rung
  set (hit) {at.x := 1}
function_block outer
input set
output q
output seen : array [1..2] of BOOL
var in_1 : inner
rung
  set in_1() (q) (seen[1])
function half : INT
input x : INT
rung
  {half := x / 2}
program first
input a : INT
temp t : BOOL
const k : INT := 3
var fb : outer
var t_1 : array [0..1] of TON
rung
  TRUE fb() (t)
rung
  t t_1[0]() {total := half(a + k)} t_1[1]() (grid[0, 0])
rung
  %IX0.3 (%QX0.1)
program one : first
program again : first",
    );
    let of_program = |name: &str| {
        ["a", "t", "k", "fb.q", "fb.seen[1]", "fb.seen[2]", "t_1[0].Q", "t_1[0].ET", "t_1[1].Q", "t_1[1].ET"]
            .map(|variable| format!("{name}.{variable}"))
    };
    let globals = ["total", "grid[0,-1]", "grid[0,0]", "grid[1,-1]", "grid[1,0]", "%IX0.3", "%QX0.1"];
    let mut expected: Vec<String> = globals.map(str::to_owned).to_vec();
    expected.extend(checked.programs().iter().flat_map(|program| of_program(&program.name)));
    assert_eq!(Oracle::new(&checked).names(), expected);
    if let Err(problem) = Rig::new(&checked) {
        panic!("{problem}");
    }
}
