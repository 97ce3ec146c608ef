//! Tasks: which sections run together, and in which rounds.
//!
//! When a task is due is a function of the image and of `now` alone, and it is computed here only: every engine asks
//! [`Turn`], and none must have a rule of its own.

use super::image::{read, write};
use super::{Layout, SlotId};
use crate::elementary::{Elementary, Value};

/// A run of sections that is executed as a whole, or left out as a whole, in each round.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Task {
    /// Its name; empty of the one that was not asked for.
    pub name: String,
    /// Nanoseconds, above 0: it is due once at or after each multiple. Without one it is due in every round.
    pub interval: Option<i64>,
    /// Where it is kept when it is due next: a slot of type TIME, there where there is an interval.
    pub due: Option<SlotId>,
    /// One past its last section; the first is where the task before ends.
    pub end: u32,
}

impl Task {
    /// A task that is due in every round, up to a section.
    pub fn always(end: u32) -> Self {
        Self { name: String::new(), interval: None, due: None, end }
    }

    /// Whether it runs in every round and has no name: all that a program without tasks has.
    pub fn is_plain(&self) -> bool {
        self.name.is_empty() && self.interval.is_none() && self.due.is_none()
    }
}

/// What an engine keeps of a task to know when it runs.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub struct Turn {
    /// The interval, and where in the image it lies when the task is due next.
    periodic: Option<(i64, u32)>,
}

impl Turn {
    /// That of a task of a verified program.
    pub fn of(task: &Task, layout: &Layout) -> Self {
        Self { periodic: task.interval.zip(task.due.map(|slot| layout.slot(slot).offset)) }
    }

    /// The interval in nanoseconds, above 0, and the offset in the image where it lies when the task is due next; `None`
    /// of one that always is. For code that does what [`Turn::take`] does.
    pub fn periodic(self) -> Option<(i64, u32)> {
        self.periodic
    }

    /// Whether the task runs in the round at `now`. If so, the image is told when it is due next: at the next multiple of
    /// its interval, however many have passed.
    ///
    /// # Panics
    /// When the image is not of the layout's size.
    pub fn take(self, image: &mut [u8], now: i64) -> bool {
        let Some((interval, offset)) = self.periodic else { return true };
        let due = read(image, offset, Elementary::Time).bits().cast_signed();
        if now < due {
            return false;
        }
        write(image, offset, Value::time(next(interval, now)));
        true
    }
}

/// The first multiple of an interval after `now`, or the end of time.
fn next(interval: i64, now: i64) -> i64 {
    // Of an interval that no verified program has it is the very next nanosecond.
    let passed = now.checked_rem_euclid(interval.max(1)).unwrap_or_default();
    now.saturating_add(interval.max(1) - passed)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::logic::{Area, LayoutBuilder, Slot};

    fn layout() -> (Layout, SlotId) {
        let mut layout = LayoutBuilder::new();
        let (ty, initial) = (Elementary::Time, Value::time(0));
        let name = "#task fast".to_owned();
        let due =
            layout.slot(Slot { name: name.into(), ty, offset: 0, area: Area::State, retain: false, initial, line: 0 });
        (layout.finish(None).unwrap(), due)
    }

    /// At which of some times a task runs, and when it is due at last.
    fn turns(interval: i64, times: &[i64]) -> (Vec<i64>, i64) {
        let (layout, due) = layout();
        let task = Task { name: "fast".to_owned(), interval: Some(interval), due: Some(due), end: 0 };
        let turn = Turn::of(&task, &layout);
        let mut image = layout.initial_image();
        let ran = times.iter().copied().filter(|now| turn.take(&mut image, *now)).collect();
        (ran, layout.slot(due).read(&image).bits().cast_signed())
    }

    #[test]
    fn a_task_runs_once_at_or_after_each_multiple_of_its_interval() {
        assert_eq!(turns(10, &[0, 5, 9, 10, 19, 20]), (vec![0, 10, 20], 30));
        assert_eq!(turns(10, &[3, 9, 10, 45, 46, 50]), (vec![3, 10, 45, 50], 60));
        assert_eq!(turns(1, &[0, 1, 1, 2]), (vec![0, 1, 2], 3));
    }

    #[test]
    fn no_time_and_no_interval_is_too_large() {
        assert_eq!(turns(i64::MAX, &[0, i64::MAX - 1, i64::MAX]), (vec![0, i64::MAX], i64::MAX));
        assert_eq!(turns(10, &[i64::MIN, -1, i64::MAX]), (vec![i64::MAX], i64::MAX));
        assert_eq!(next(10, i64::MIN), i64::MIN + 8);
        assert_eq!(next(10, -11), -10);
        assert_eq!(next(i64::MAX, i64::MIN), -i64::MAX);
    }

    #[test]
    fn a_task_without_an_interval_runs_in_every_round_and_leaves_the_image_alone() {
        let (layout, _) = layout();
        let turn = Turn::of(&Task::always(0), &layout);
        let mut image = layout.initial_image();
        assert!([i64::MIN, 0, 0, i64::MAX].iter().all(|now| turn.take(&mut image, *now)));
        assert_eq!(image, layout.initial_image());
    }
}
