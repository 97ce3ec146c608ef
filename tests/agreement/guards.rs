//! What stands under several conditions at once, under random inputs: leaving loops and units from within branches, calls that
//! are computed for nothing, instances behind computed indices.

use rung::elementary::{Elementary, Value};

use crate::support::dice::Dice;
use crate::support::rig::Rig;
use crate::support::script::checked_text;

const PROGRAMS: &[(&str, &str)] = &[
    ("leaving loops from within branches", "
global log : array [0..3] of INT
program p
input a, b : BOOL
input n, m : INT
var x : array [0..3] of INT
var i, j, k : INT
rung
  {FOR i := 0 TO 3 DO
     IF a THEN
       IF x[i] > n THEN EXIT; END_IF;
       FOR j := 3 TO 0 BY -1 DO
         IF j = m THEN EXIT; END_IF;
         IF b AND j = n THEN RETURN; END_IF;
         x[j] := x[j] + i;
         k := k + 1;
       END_FOR;
       IF m > 2 THEN EXIT; ELSIF n > 2 THEN x[n] := 0; ELSE log[i] := k; END_IF;
     ELSE
       x[i] := n; EXIT;
     END_IF;
     x[i] := x[i] + 1;
   END_FOR;
   k := k * 2;} (%QX0.0)
rung
  a {CASE n OF 0: k := 1; RETURN; 1, 3..4: k := 2; ELSE x[m] := k; END_CASE;} (%QX0.1)
rung
  b (%QX0.2)
"),
    ("functions that leave early and write elsewhere", "
global calls : INT
function clamp : INT
input v, top : INT
inout hits : INT
var i : INT
var seen : array [0..2] of INT := [7, 8, 9]
rung
  {calls := calls + 1;
   FOR i := 0 TO 2 DO seen[i] := seen[i] + v; IF seen[i] > 9 THEN hits := hits + 1; EXIT; END_IF; END_FOR;
   clamp := top;
   IF v > top THEN hits := hits + 10; RETURN; END_IF;
   clamp := seen[i];}
rung
  {hits := hits + 100}
program p
input a, b : BOOL
input n, m : INT
var h, r, s : INT
var t1 : TON
var x : array [0..3] of INT
rung
  a {clamp(n, m, h) > 1} (%QX0.0)
rung
  a b {r := clamp(clamp(n, 2, h), m, s)} (%QX0.1)
rung
  [a {clamp(n, 1, h) = 1} | b] t1(PT := T#1s) (%QX0.2)
rung
  a clamp(EN := b, v := n, top := m, hits := x[n], ENO => %QX0.4, clamp => r) (%QX0.3)
rung
  {IF a THEN r := clamp(n, m, x[m]); ELSIF clamp(m, n, h) > 2 THEN s := s + 1; END_IF;} (%QX0.5)
"),
    ("blocks that jump, hold each other and lie in arrays", "
type pair : struct low : INT := 1  high : INT end_struct
function_block inner
input go : BOOL
input step : INT := 1
inout sum : INT
output done : BOOL
temp t : INT := 5
var n : INT
rung
  /go >> return
rung
  {step > 2} >> behind
rung
  {n := n + step; t := t + 1; sum := sum + t;}
rung behind
  ^go {sum := sum + 100} (done)
function_block outer
input go : BOOL
input which : INT
inout p : pair
output total : INT
output got : BOOL := FALSE
var cells : array [0..2] of inner
var own : array [0..2] of INT
var i : INT
rung
  go {FOR i := 0 TO 2 DO cells[0](go := i = which, step := which, sum := own[i], done => got); IF got THEN EXIT; END_IF; cells[2](go := got, sum := own[which]); END_FOR;}
rung
  cells[1](step := 1, sum := p.low).done (S got)
rung
  {total := own[0] + own[1] + own[2] + p.high}
program main
input a, b : BOOL
input n, m : INT
var ps : array [0..2] of pair := [(low := 4), (high := 2)]
var qs : array [0..2] of pair
var o1, o2 : outer
var many : array [0..1] of outer
var k : INT
rung
  a o1(which := n, p := ps[n], total => k).got (%QX0.0)
rung
  b >> skip
rung
  b o2(EN := a, which := m, p := ps[m], total => ps[n].high, ENO => %QX0.2) (%QX0.1)
rung skip
  {FOR k := 0 TO 1 DO IF a THEN many[0](go := b, which := n + k, p := qs[k]); ELSIF b THEN EXIT; ELSE many[1](go := n > 2, which := m, p := ps[m]); END_IF; END_FOR; qs[2] := ps[m]; IF b THEN ps := qs; END_IF;} (%QX0.3)
rung
  a {qs[m].low := many[1].total} (%QX0.4)
"),
];

#[test]
fn what_stands_under_several_conditions_is_executed_only_where_all_hold() {
    for (what, text) in PROGRAMS {
        let checked = checked_text(text);
        let mut rig = Rig::new(&checked).expect("it runs");
        let mut dice = Dice::new(7, 0);
        for scan in 0..500 {
            for name in ["a", "b"] {
                rig.set(name, Value::bool(dice.percent(50)));
            }
            for name in ["n", "m"] {
                let value = Value::integer(Elementary::Int, dice.between(0, 6) as i128 - 1);
                rig.set(name, value.expect("it is small"));
            }
            rig.scan(scan * 1_000_000).unwrap_or_else(|difference| panic!("{what}, scan {scan}: {difference:?}"));
        }
    }
}
