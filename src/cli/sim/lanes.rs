//! `rung sim --lanes N`: so many plants at once, each with random inputs of its own, summed up in a table.
//!
//! The table is a function of the files and the options, byte for byte; how fast it went is told beside it.

mod summary;

use std::collections::HashSet;
use std::io::IsTerminal;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

use indicatif::{ProgressBar, ProgressStyle};

use super::super::run::time;
use super::super::{Failure, print, report, write_whole};
use crate::batch::{Batch, Part, RandomInputs, Variable, WORD_LANES};
use crate::diagnostic::Code;
use crate::logic::{Layout, Program, SlotId};
use crate::simulate::{Schedule, Stimuli};
use crate::trace::Signal;
use summary::{Summary, table};

#[derive(Debug, clap::Args)]
#[command(next_help_heading = "Many plants")]
pub(super) struct Plants {
    /// Run so many plants at once, each with random inputs of its own, and sum up what they did
    #[arg(long, value_name = "N", conflicts_with_all = ["trace", "replay", "engine", "lane"])]
    pub(super) lanes: Option<usize>,
    /// What the random inputs start from; with `--lane`, or alone, run the plant of that number and trace it
    #[arg(long, value_name = "S", conflicts_with = "replay")]
    pub(super) seed: Option<u64>,
    /// Run the plant of this number alone [default: 0 with `--seed`]
    #[arg(long, value_name = "L", conflicts_with = "replay")]
    pub(super) lane: Option<usize>,
    /// A boolean expression over variables that is to hold after every scan; may be given several times
    #[arg(long = "assert", value_name = "EXPRESSION")]
    pub(super) assertions: Vec<String>,
    /// Write what the first plant of which an assertion fails was given, up to then, as stimuli
    #[arg(long, value_name = "FILE.csv", requires = "lanes", requires = "assertions")]
    pub(super) failing: Option<PathBuf>,
}

impl Plants {
    /// Whether inputs are random.
    pub(super) fn random(&self) -> bool {
        self.lanes.is_some() || self.seed.is_some() || self.lane.is_some()
    }

    /// The stimuli of the one plant that is to run, given those of all.
    pub(super) fn stimuli_of_one(&self, layout: &Layout, schedule: Schedule, common: &Stimuli) -> Stimuli {
        let lane = self.lane.unwrap_or_default();
        stimuli_of(layout, self.seed.unwrap_or_default(), lane, schedule.cycle(), schedule.count(), common)
    }
}

/// What one lane of a seed gets in its first scans.
fn stimuli_of(layout: &Layout, seed: u64, lane: usize, cycle: i64, scans: u64, common: &Stimuli) -> Stimuli {
    let inputs = RandomInputs::new(layout, seed, lane / WORD_LANES, &given(common));
    inputs.stimuli_of(lane, cycle, scans, common)
}

/// The variables that all lanes are given alike.
fn given(stimuli: &Stimuli) -> HashSet<SlotId> {
    stimuli.rows().flat_map(|row| row.settings).map(|setting| setting.slot).collect()
}

/// An assertion: what it says, and the slot that tells whether it holds.
#[derive(Clone, Debug)]
pub(super) struct Assertion {
    pub(super) text: String,
    pub(super) holds: SlotId,
}

/// Where an assertion failed first.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
struct Violation {
    scan: u64,
    lane: usize,
    assertion: usize,
}

/// What a part did.
struct Done {
    summaries: Vec<Summary>,
    first: Option<Violation>,
    /// Lanes in which an assertion failed at any time.
    failed: u32,
    joined: bool,
}

/// A run of many plants.
pub(super) struct Run<'a> {
    pub(super) file: &'a Path,
    pub(super) arguments: &'a Plants,
    pub(super) program: &'a Program,
    pub(super) signals: Option<&'a [String]>,
    pub(super) schedule: Schedule,
    pub(super) stimuli: &'a Stimuli,
    pub(super) assertions: &'a [Assertion],
    pub(super) stop: &'a AtomicBool,
}

impl Run<'_> {
    pub(super) fn run(&self, lanes: usize) -> Result<(), Failure> {
        let refused = |error: &dyn std::fmt::Display| Failure::new(Code::CannotBatch, error.to_string());
        let layout = &self.program.layout;
        let mut batch = Batch::new(self.program, lanes).map_err(|error| refused(&error))?;
        let shown = summary::shown(layout, self.signals)?;
        let seed = self.arguments.seed.unwrap_or_default();
        let except = given(self.stimuli);
        if RandomInputs::new(layout, seed, 0, &except).is_empty() {
            report("note: no input is random, so all plants do the same\n");
        }
        let bar = progress(self.schedule.count(), lanes);
        let begin = Instant::now();
        let parts = batch.each(|part| self.part(part, &except, &shown, &bar));
        let spent = begin.elapsed();
        bar.finish_and_clear();
        if self.stop.load(Ordering::Relaxed) {
            return Err(Failure::Interrupted);
        }
        if parts.iter().any(|part| !part.joined) {
            report("note: this program's plants had to run one by one, which is slower\n");
        }
        #[expect(clippy::cast_precision_loss, reason = "a rate for people to read")]
        let scans = self.schedule.count() as f64 * lanes as f64;
        report(&format!(
            "{lanes} plants x {} scans in {:.3} s: {} scans a second\n",
            self.schedule.count(),
            spent.as_secs_f64(),
            summary::rounded(scans / spent.as_secs_f64().max(1e-9)),
        ));
        self.finish(&mut batch, seed, &parts, &shown)
    }

    /// Runs all scans of a part.
    fn part(&self, mut part: Part<'_>, given: &HashSet<SlotId>, shown: &[(Signal, SlotId)], bar: &ProgressBar) -> Done {
        let seed = self.arguments.seed.unwrap_or_default();
        let layout = &self.program.layout;
        let words = part.first() / WORD_LANES..part.first() / WORD_LANES + part.words();
        let mut random: Vec<RandomInputs> = words.map(|word| RandomInputs::new(layout, seed, word, given)).collect();
        let variables: Vec<Variable> = shown.iter().map(|(_, slot)| part.variable(*slot)).collect();
        let asserted: Vec<Variable> = self.assertions.iter().map(|one| part.variable(one.holds)).collect();
        let mut summaries: Vec<Summary> = variables.iter().map(|one| Summary::new(one.ty())).collect();
        let mut rows = self.stimuli.rows().peekable();
        let (mut first, mut failed) = (None, vec![0u128; part.words()]);
        for scan in 0..self.schedule.count() {
            if scan % SCANS_PER_LOOK == 0 {
                bar.inc(SCANS_PER_LOOK.min(self.schedule.count() - scan) * part.lanes() as u64);
                if self.stop.load(Ordering::Relaxed) {
                    break;
                }
            }
            // In range: the schedule was made so that its last scan's time is.
            let now = i64::try_from(scan).unwrap_or(i64::MAX).saturating_mul(self.schedule.cycle());
            while let Some(row) = rows.next_if(|row| row.time <= now) {
                for setting in row.settings {
                    (0..part.lanes()).for_each(|lane| part.put(lane, setting.slot, setting.value));
                }
            }
            random.iter_mut().enumerate().for_each(|(word, random)| random.apply(&mut part, word));
            part.scan(now);
            for (summary, variable) in summaries.iter_mut().zip(&variables) {
                summary.add(&part, *variable);
            }
            for (assertion, holds) in asserted.iter().enumerate() {
                for (word, failed) in failed.iter_mut().enumerate() {
                    let fails = part.all(word) & !part.word(word, *holds).unwrap_or(u128::MAX);
                    *failed |= fails;
                    if fails != 0 && first.is_none() {
                        let lane = part.first() + word * WORD_LANES + fails.trailing_zeros() as usize;
                        first = Some(Violation { scan, lane, assertion });
                    }
                }
            }
        }
        let failed = failed.iter().map(|failed| failed.count_ones()).sum();
        Done { summaries, first, failed, joined: part.is_joined() }
    }

    /// Prints the table, and says which assertion failed.
    fn finish(&self, batch: &mut Batch, seed: u64, parts: &[Done], shown: &[(Signal, SlotId)]) -> Result<(), Failure> {
        let mut summaries: Vec<Summary> = shown.iter().map(|(signal, _)| Summary::new(signal.ty())).collect();
        for part in parts {
            summaries.iter_mut().zip(&part.summaries).for_each(|(all, one)| all.join(one));
        }
        let variables: Vec<Variable> = shown.iter().map(|(_, slot)| batch.part(0).variable(*slot)).collect();
        let unlike: Vec<usize> = variables
            .iter()
            .map(|one| batch.differing(0, std::slice::from_ref(one)).map_or(0, |lanes| lanes.len()))
            .collect();
        print(&table(shown, &summaries, &unlike, batch.lanes()))?;
        let Some(first) = parts.iter().filter_map(|part| part.first).min() else { return Ok(()) };
        let Violation { scan, lane, assertion } = first;
        let failed: u32 = parts.iter().map(|part| part.failed).sum();
        let cycle = self.schedule.cycle();
        if let Some(path) = &self.arguments.failing {
            let stimuli = stimuli_of(&self.program.layout, seed, lane, cycle, scan + 1, self.stimuli);
            write_whole(path, stimuli.to_csv(&self.program.layout).as_bytes())?;
        }
        let now = i64::try_from(scan).unwrap_or(i64::MAX).saturating_mul(cycle);
        let text = format!(
            "the assertion `{}` does not hold in lane {lane} after scan {scan}, at {}, of seed {seed}; {failed} of {} \
             plants fail\n  hint: the same options with `--seed {seed} --lane {lane} --scans {}` in place of `--lanes` \
             trace it ({})",
            self.assertions[assertion].text,
            time::exact(now),
            batch.lanes(),
            scan + 1,
            self.file.display(),
        );
        Err(Failure::new(Code::AssertionFails, text))
    }
}

/// Scans between two looks at whether to stop.
const SCANS_PER_LOOK: u64 = 64;

/// A bar with rate and time left, on a terminal.
fn progress(scans: u64, lanes: usize) -> ProgressBar {
    if !std::io::stderr().is_terminal() {
        return ProgressBar::hidden();
    }
    let bar = ProgressBar::new(scans.saturating_mul(lanes as u64));
    let style = ProgressStyle::with_template("{bar:40} {percent:>3} %  {human_pos} scans  {per_sec}  {eta} left");
    // The template is known to be right.
    style.map_or_else(|_| bar.clone(), |style| bar.clone().with_style(style))
}
