//! Blocks, loops, functions and references inside one another.

use crate::support::script::follows;

#[test]
fn blocks_in_blocks_keep_their_memories_where_a_loop_is_left_or_en_is_off() {
    follows(
        "function_block leaf
  input a
  output q
  var n : INT retain
rung
  ^a {n := n + 1} (q)
function_block mid
  input a
  output q
  var l : array [0..2] of leaf
  var e
rung
  l[0](a := [a]) l[1](a := [/a]) >> done
rung
  l[2](a := [a]) (e)
rung done
  e (q)
program p
  input s
  var s2, o : BOOL
  var seen : INT
  var m : array [0..1] of mid
  var i : INT
  var z : array [0..1] of INT
rung
  {FOR i := 0 TO 3 DO m[0](a := i MOD 2 = 0); IF i = 2 THEN EXIT; END_IF; m[1](a := TRUE); END_FOR;}
rung
  s m[1](EN := FALSE, q => s2) (o)
rung
  {z[0] := i}",
        "ms s | o m[0].q m[1].q i s2
         0  0 | 0 1      0      2 0
         10 1 | 0 1      0      2 0
         20 0 | 0 1      0      2 0
         30 1 | 0 1      0      2 0
         40 1 | 0 1      0      2 0",
    );
}

#[test]
fn functions_stand_in_the_indices_of_their_own_arguments() {
    follows(
        "type colour : (red, green := 4, blue)
function pick : INT
  input x : INT
  inout cnt : INT
rung
  {cnt := cnt + 1}
rung
  {pick := x * 2}
program p
  var c : colour
  var a : array [0..3, 1..3] of INT
  var k, n, f : INT
  output q
rung
  {CASE c OF red: c := green; green, blue: c := red; k := k + 1; ELSE k := 99; END_CASE;}
rung
  {a[pick(x := k, cnt := n), pick(x := 1, cnt := f)] := a[k, pick(pick(k, n), f)] + n;}
rung
  FALSE ADD(IN1 := a[pick(k, n), 9 - k], IN2 := 3, OUT => a[k + 1, k]) (q)
rung
  {k > 1} DIV(EN := [{k > 2}], IN1 := 4, IN2 := a[k, 1], OUT => f, ENO => q)",
        "ms | a[0,1] a[0,2] a[1,3] k n  f  q c
         0  | 0      1      0      0 2  2  0 4
         10 | 0      1      0      1 4  4  0 0
         20 | 0      1      0      1 6  6  0 4
         30 | 0      1      0      2 8  8  0 0
         40 | 0      1      0      2 10 10 0 4",
    );
}

#[test]
fn a_reference_to_an_element_of_a_reference_keeps_the_index_of_its_call() {
    follows(
        "type row : array [0..3] of INT
function_block fb
  inout n : INT
  inout v : row
  temp t : INT := 7
  output q : INT
rung
  {v[n] := v[n] + t; t := t + v[n + 1]; n := n + 1; q := v[n];}
function_block outer
  inout n : INT
  inout w : array [0..1] of row
  var f : fb
  output q : INT
rung
  f(n := w[n][0], v := w[n], q => q)
program p
  var m : array [0..1] of row
  var i : INT
  var o : array [0..1] of outer
  var p1, p2 : INT
rung
  o[1](n := i, w := m, q => p1) o[0](n := i, w := m, q => p2)
rung
  {i := (i + 1) MOD 3}",
        "ms | m[0][0] m[1][0] m[1][1] i o[0].q o[1].q p1 p2
         0  | 9       0       0       1 0      0      0  0
         10 | 9       9       0       2 0      0      0  0
         20 | 9       9       0       0 0      0      0  0
         30 | 11      9       0       1 0      0      0  0
         40 | 11      11      0       2 0      0      0  0",
    );
}

#[test]
fn a_loop_counts_with_a_reference_and_is_left_by_a_return() {
    follows(
        "function_block b
  inout n : INT
  output q : INT
  var arr : array [0..4] of INT
rung
  {FOR n := 0 TO 4 DO arr[n] := arr[n] + n; IF arr[n] > 20 THEN RETURN; END_IF; q := q + arr[4 - n]; END_FOR;}
rung
  >> out
rung
  {q := -1}
rung out
  {n := n + 100}
program p
  var x : array [0..2] of b
  var a : array [0..2] of INT
  var i, r : INT
rung
  {FOR i := 0 TO 2 DO x[1](n := a[i]); x[2](n := i); END_FOR;}
rung
  {r := r + 1} {r > 3} >> return
rung
  x[0](n := r)",
        "ms | x[0].q x[1].q x[2].q a[0] a[1] a[2] i r
         0  | 3      39     39     105  105  105  3 105
         10 | 3      168    168    105  105  4    3 106
         20 | 3      351    351    3    3    3    3 107
         30 | 3      530    530    3    2    2    3 108
         40 | 3      692    692    2    2    2    3 109",
    );
}
