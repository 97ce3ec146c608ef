//! Tasks and program instances: what runs in a round, and in which order.

use crate::support::script::follows;

#[test]
fn a_task_runs_in_the_first_round_at_or_after_each_multiple_of_its_interval() {
    follows(
        "task slow(interval := 10ms)
program p with slow
var n : INT
rung
  {n := n + 1}",
        "ms | n
         0  | 1
         1  | 1
         9  | 1
         10 | 2
         10 | 2
         19 | 2
         25 | 3
         29 | 3
         30 | 4
         75 | 5
         79 | 5
         80 | 6",
    );
}

#[test]
fn a_first_round_that_comes_late_runs_every_task() {
    follows(
        "task slow(interval := 10ms)
program p with slow
var n : INT
rung
  {n := n + 1}",
        "ms   | n
         1234 | 1
         1239 | 1
         1240 | 2",
    );
}

#[test]
fn due_tasks_run_by_priority_and_programs_without_a_task_last() {
    follows(
        "global order : DINT
task late(interval := 20ms, priority := 5)
task every(priority := 3)
task early(interval := 10ms, priority := 1)
program free
rung
  {order := order * 10 + 1}
program d with late
rung
  {order := order * 10 + 2}
program e with every
rung
  {order := order * 10 + 3}
program b with early
rung
  {order := order * 10 + 4}
program c with early
rung
  {order := order * 10 + 5}",
        "ms order | order
         0  0     | 45321
         5  0     | 31
         10 0     | 4531
         20 0     | 45321
         31 0     | 4531",
    );
}

#[test]
fn each_instance_of_a_program_has_variables_and_memories_of_its_own() {
    follows(
        "task slow(interval := 10ms)
program pump
input start
output runs
var n : INT
rung
  ^start {n := n + 1} 
rung
  start delay:TON(PT := T#15ms) (runs)
program one : pump
program two : pump with slow",
        "ms one.start two.start | one.n two.n one.runs two.runs two.delay.ET
         0  0         1         | 0     1     0        0        0
         5  1         0         | 1     1     0        0        0
         10 1         1         | 1     1     0        0        10
         20 1         1         | 1     1     1        1        15
         25 0         0         | 1     1     0        1        15
         30 1         0         | 2     1     0        0        0
         40 1         1         | 2     2     0        0        0",
    );
}

#[test]
fn a_return_ends_its_own_program_only() {
    follows(
        "global n : INT
program first
input a
rung
  a >> return
rung
  {n := n + 1}
program second
rung
  {n := n + 10}",
        "ms first.a | n
         0  0       | 11
         1  1       | 21
         2  0       | 32",
    );
}

#[test]
fn what_a_fast_task_writes_a_slow_one_sees() {
    follows(
        "global count : INT
task fast(interval := 1ms, priority := 1)
task slow(interval := 4ms, priority := 2)
program counts with fast
temp t : INT := 1
rung
  {count := count + t; t := 5;}
program looks with slow
output seen : INT
rung
  {seen := count}",
        "ms | count looks.seen counts.t
         0  | 1     1          5
         2  | 2     1          5
         3  | 3     1          5
         4  | 4     4          5
         9  | 5     5          5",
    );
}
