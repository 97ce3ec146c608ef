//! The run as plain lines: one for each change of an output or a block's power, one a second with statistics.
//!
//! It must stay readable: what changes all the time is told a few times a second, and counted beyond.

use std::collections::HashMap;
use std::sync::mpsc::RecvTimeoutError;
use std::time::{Duration, Instant};

use rung_runtime::Scan;
use rung_runtime::host::{Histogram, Statistics};

use super::super::tasks;
use super::machine::{Change, Machine};
use super::points::{Point, shown};
use super::{Failure, print, time};
use crate::logic::image::FAULT;

/// Lines in a second about one variable, and about all of them.
const MOST_OF_ONE: u32 = 10;
const MOST_OF_ALL: u32 = 50;

const SECOND: Duration = Duration::from_secs(1);

/// Tells of a running program until it is over.
pub(super) fn watch<E: Scan + Send + 'static>(machine: &Machine<E>, told: &[Point]) -> Result<(), Failure> {
    let mut second = Second::default();
    let mut next = Instant::now() + SECOND;
    loop {
        // Short, to notice soon that it is over.
        let wait = next.saturating_duration_since(Instant::now()).min(Duration::from_millis(50));
        match machine.changes.recv_timeout(wait) {
            Ok(change) => {
                if let Some(line) = second.line(&change, told) {
                    print(&line)?;
                }
            }
            Err(RecvTimeoutError::Timeout) if machine.is_over() => return Ok(()),
            Err(RecvTimeoutError::Timeout) => {}
            Err(RecvTimeoutError::Disconnected) => return Ok(()),
        }
        if Instant::now() >= next {
            next += SECOND;
            second.hidden += machine.shared.take_untold();
            let hidden = match std::mem::take(&mut second).hidden {
                0 => String::new(),
                hidden => format!(", {hidden} more changes"),
            };
            let now = moment(machine.shared.now());
            print(&format!("{now}  {}{hidden}\n", figures(&machine.shared.statistics)))?;
        }
    }
}

/// What was told in the current second.
#[derive(Debug, Default)]
struct Second {
    lines: u32,
    of: HashMap<usize, u32>,
    hidden: u64,
}

impl Second {
    /// The line for a change, unless there were enough.
    fn line(&mut self, change: &Change, told: &[Point]) -> Option<String> {
        let of_this = self.of.entry(change.index).or_default();
        *of_this += 1;
        if *of_this > MOST_OF_ONE || self.lines >= MOST_OF_ALL {
            self.hidden += 1;
            return None;
        }
        self.lines += 1;
        let name = &told.get(change.index)?.name;
        if name == FAULT {
            return Some(format!("{}  {}\n", moment(change.now), tasks::FAULT));
        }
        Some(format!("{}  {name} = {}\n", moment(change.now), shown(change.value)))
    }
}

/// A time since the start, in milliseconds: `   12.345 s`.
fn moment(nanoseconds: i64) -> String {
    let milliseconds = nanoseconds.max(0) / 1_000_000;
    format!("{:>5}.{:03} s", milliseconds / 1000, milliseconds % 1000)
}

/// The statistics on one line.
fn figures(statistics: &Statistics) -> String {
    format!(
        "{} cycles, scan {}, lateness {}, {} overruns, {} skipped",
        statistics.cycles(),
        quantiles(&statistics.scan),
        quantiles(&statistics.lateness),
        statistics.overruns(),
        statistics.skipped()
    )
}

/// Median, 99 % and maximum of a histogram.
pub(super) fn quantiles(histogram: &Histogram) -> String {
    let all = histogram.quantiles();
    [all.p50, all.p99, all.max].map(time::rounded).join(" / ")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::elementary::{Elementary, Value};
    use crate::logic::image::{Area, Slot};

    fn point(name: &str) -> Point {
        let initial = Value::bool(false);
        let (ty, area) = (Elementary::Bool, Area::Output);
        let slot = Slot { name: name.into(), ty, offset: 0, area, retain: false, initial, line: 0 };
        Point { name: name.to_owned(), slot, key: None }
    }

    #[test]
    fn an_index_out_of_range_is_told_in_words() {
        let line = Second::default().line(&Change { now: 0, index: 0, value: Value::bool(true) }, &[point(FAULT)]);
        assert_eq!(line, Some(format!("    0.000 s  {}\n", tasks::FAULT)));
    }

    #[test]
    fn what_changes_all_the_time_leaves_room_for_the_rest() {
        let told = [point("blink"), point("alarm")];
        let mut second = Second::default();
        let change = |now, index| Change { now, index, value: Value::bool(true) };
        let lines: Vec<_> = (0..100).filter_map(|now| second.line(&change(now, 0), &told)).collect();
        assert_eq!(lines.len(), 10);
        let line = second.line(&change(61_234_567_890, 1), &told);
        assert_eq!(line.as_deref(), Some("   61.234 s  alarm = 1\n"));
        assert_eq!(second.hidden, 90);
    }
}
