//! What a program's tasks mean for the commands that run it: the cycle, and what is said about the intervals.

use super::run::time;
use crate::logic::{Program, Task};

/// From one scan to the next where no task has an interval: 10 ms.
const CYCLE: i64 = 10_000_000;

/// What is said once an index was out of its range.
pub(super) const FAULT: &str =
    "an index was out of its range: such an element reads as its type's default and is not written";

/// The cycle of a program when none is asked for: the longest that meets every interval, in nanoseconds.
pub(super) fn cycle(program: &Program) -> i64 {
    program.tasks.iter().filter_map(|task| task.interval).reduce(common).unwrap_or(CYCLE)
}

/// The greatest common divisor of numbers above 0.
fn common(a: i64, b: i64) -> i64 {
    let (mut a, mut b) = (a, b);
    while b != 0 {
        (a, b) = (b, a % b);
    }
    a
}

/// A note for each interval that a cycle does not meet.
pub(super) fn notes(program: &Program, cycle: i64) -> String {
    let unmet = program.tasks.iter().filter_map(|task| Some((&task.name, task.interval?)));
    unmet
        .filter(|(_, interval)| interval % cycle != 0)
        .map(|(name, interval)| {
            let (interval, cycle) = (time::exact(interval), time::exact(cycle));
            format!("note: the interval of the task `{name}`, {interval}, is no multiple of the cycle, {cycle}\n")
        })
        .collect()
}

/// The tasks and their intervals on one line; `None` of a program that has but the plain one.
pub(super) fn listed(program: &Program) -> Option<String> {
    let one = |task: &Task| {
        let name = if task.name.is_empty() { "the others" } else { &task.name };
        let when = task.interval.map_or_else(|| "every cycle".to_owned(), |of| format!("every {}", time::exact(of)));
        format!("{name} {when}")
    };
    let plain = program.tasks.iter().all(Task::is_plain);
    (!plain).then(|| program.tasks.iter().map(one).collect::<Vec<_>>().join(", "))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::logic::{Builder, LayoutBuilder};

    /// A program with tasks of these intervals.
    fn program(intervals: &[Option<i64>]) -> Program {
        let mut program = Builder::new("p", LayoutBuilder::new().finish(None).expect("an empty image")).finish();
        let task = |(index, interval): (usize, &Option<i64>)| Task {
            name: format!("t{index}"),
            interval: *interval,
            ..Task::always(0)
        };
        if !intervals.is_empty() {
            program.tasks = intervals.iter().enumerate().map(task).collect();
        }
        program
    }

    #[test]
    fn the_cycle_is_the_longest_that_meets_every_interval() {
        assert_eq!(cycle(&program(&[])), 10_000_000);
        assert_eq!(cycle(&program(&[None])), 10_000_000);
        assert_eq!(cycle(&program(&[Some(15), None, Some(100), Some(35)])), 5);
        assert_eq!(cycle(&program(&[Some(i64::MAX)])), i64::MAX);
    }

    #[test]
    fn intervals_that_the_cycle_does_not_meet_are_told() {
        let program = program(&[Some(10_000_000), None, Some(25_000_000)]);
        assert_eq!(notes(&program, 5_000_000), "");
        assert_eq!(
            notes(&program, 10_000_000),
            "note: the interval of the task `t2`, 25ms, is no multiple of the cycle, 10ms\n"
        );
        assert_eq!(listed(&program).as_deref(), Some("t0 every 10ms, t1 every cycle, t2 every 25ms"));
    }

    #[test]
    fn a_program_without_tasks_lists_none() {
        assert_eq!(listed(&program(&[])), None);
    }
}
