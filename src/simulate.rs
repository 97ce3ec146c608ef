//! Simulation: a program run in virtual time, with the stimuli that set its variables.
//!
//! Scan k, from 0, happens at time k x cycle, or when a replay says. Everything here is a pure function of program,
//! stimuli and schedule: this module must never do I/O or read a clock, so that the same files give the same trace on
//! every engine.
//!
//! ```no_run
//! # use rung::{engine::interp::Interpreter, logic::Program, simulate::{Schedule, Simulation, Stimuli}};
//! # fn example(program: &Program, stimuli: &Stimuli, schedule: Schedule) {
//! let mut engine = Interpreter::new(program);
//! let mut simulation = Simulation::new(&program.layout, stimuli, schedule);
//! while let Some(now) = simulation.step(&mut engine) {
//!     println!("{now} ns: {:?}", simulation.image());
//! }
//! # }
//! ```

pub mod assertion;
pub mod decimal;
mod stimuli;
#[cfg(test)]
mod tests;

use rung_runtime::Scan;

use crate::logic::Layout;
use crate::replay::Replay;

pub use stimuli::{Row, Setting, Stimuli};

/// When the scans of a simulation happen.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Schedule {
    cycle: i64,
    scans: u64,
}

/// Simulated time after the last stimulus, when nothing else is asked for, in nanoseconds.
const AFTERMATH: i64 = 1_000_000_000;

impl Schedule {
    /// Scans that are run when there are no stimuli and nothing else is asked for.
    pub const DEFAULT_SCANS: u64 = 100;

    /// So many scans, one every `cycle` nanoseconds from 0; `None` when the cycle is not above 0 or a scan would come
    /// after the last time that there is.
    pub fn scans(cycle: i64, scans: u64) -> Option<Self> {
        let last = i64::try_from(scans.saturating_sub(1)).ok()?;
        (cycle > 0 && last.checked_mul(cycle).is_some()).then_some(Self { cycle, scans })
    }

    /// The scans before `end`, in nanoseconds; `None` when the cycle is not above 0.
    pub fn before(cycle: i64, end: i64) -> Option<Self> {
        if cycle <= 0 {
            return None;
        }
        let end = end.max(0).cast_unsigned();
        Self::scans(cycle, end.div_ceil(cycle.cast_unsigned()))
    }

    /// Until a second after the last stimulus, which is always reached; without stimuli
    /// [`Schedule::DEFAULT_SCANS`]. `None` when the cycle is not above 0, or too long.
    pub fn covering(cycle: i64, stimuli: &Stimuli) -> Option<Self> {
        let Some(last) = stimuli.rows().last() else { return Self::scans(cycle, Self::DEFAULT_SCANS) };
        let reaching = Self::before(cycle, last.time)?.scans.checked_add(1)?;
        let settled = Self::before(cycle, last.time.saturating_add(AFTERMATH))?.scans;
        Self::scans(cycle, reaching.max(settled))
    }

    /// Nanoseconds from one scan to the next.
    pub fn cycle(self) -> i64 {
        self.cycle
    }

    /// How many scans there are.
    pub fn count(self) -> u64 {
        self.scans
    }

    /// One cycle after the last scan, in nanoseconds.
    pub fn end(self) -> i64 {
        i64::try_from(self.scans).unwrap_or(i64::MAX).saturating_mul(self.cycle)
    }
}

/// One run of a program in virtual time.
#[derive(Debug)]
pub struct Simulation<'a> {
    layout: &'a Layout,
    course: Course<'a>,
    image: Vec<u8>,
    scans_done: u64,
}

/// Where times and inputs come from.
#[derive(Debug)]
enum Course<'a> {
    Stimulated { stimuli: &'a Stimuli, schedule: Schedule, rows_done: usize },
    Replayed(&'a Replay),
}

impl<'a> Simulation<'a> {
    /// A run that has not started: every variable holds its initial value.
    ///
    /// The stimuli must have been read for this layout.
    pub fn new(layout: &'a Layout, stimuli: &'a Stimuli, schedule: Schedule) -> Self {
        let course = Course::Stimulated { stimuli, schedule, rows_done: 0 };
        Self { layout, course, image: layout.initial_image(), scans_done: 0 }
    }

    /// A recorded run, from its start.
    ///
    /// [`Replay::check`] must have passed for this layout.
    pub fn replaying(layout: &'a Layout, replay: &'a Replay) -> Self {
        Self { layout, course: Course::Replayed(replay), image: replay.first_image(layout), scans_done: 0 }
    }

    /// Sets what is due, in order, and runs one scan; gives its time in nanoseconds, or `None` when all scans are
    /// done.
    pub fn step(&mut self, scan: &mut (impl Scan + ?Sized)) -> Option<i64> {
        let now = match &mut self.course {
            Course::Stimulated { stimuli, schedule, rows_done } => {
                if self.scans_done == schedule.scans {
                    return None;
                }
                // In range: the schedule was made so that its last scan's time is.
                let now = i64::try_from(self.scans_done).ok()?.checked_mul(schedule.cycle)?;
                while let Some(row) = stimuli.row(*rows_done).filter(|row| row.time <= now) {
                    for setting in row.settings {
                        self.layout.slot(setting.slot).write(&mut self.image, setting.value);
                    }
                    *rows_done += 1;
                }
                now
            }
            Course::Replayed(replay) => {
                let recorded = replay.scans.get(usize::try_from(self.scans_done).ok()?)?;
                recorded.copy_in(self.layout, &mut self.image);
                recorded.now
            }
        };
        scan.scan(&mut self.image, now);
        self.scans_done += 1;
        Some(now)
    }

    /// The process image as the last scan left it.
    pub fn image(&self) -> &[u8] {
        &self.image
    }
}
