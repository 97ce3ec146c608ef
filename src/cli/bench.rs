//! `rung bench`: every engine on the given programs, side by side, and what C compilers make of them.
//!
//! Every engine gets the same images at the same times. What is measured is the scan alone: the inputs are changed
//! between the measured scans, a tenth of the BOOLs each time. The engines take turns, so that whatever else the
//! machine does hits all of them alike, and the figures are medians over the turns. All tasks run in every scan. Nothing is
//! measured that does not leave the image that the first engine leaves.

mod chart;
mod compiler;
mod engine;
mod paper;
mod plant;
mod table;

use std::path::PathBuf;
use std::time::Duration;

use super::{Failure, Missing, duration, load_checked, print, report, write_whole};
use crate::diagnostic::Code;
use crate::load::Loaded;
use crate::logic::Program;
use crate::{lower, opt};
use engine::{Engine, Subject};
use table::{Measured, Row};

/// Measures every engine on the given programs, and what gcc and clang make of them where they are installed
#[derive(Debug, clap::Args)]
pub(super) struct Arguments {
    /// The programs
    #[arg(required_unless_present = "paper")]
    files: Vec<PathBuf>,
    #[command(flatten)]
    missing: Missing,
    /// Only this engine; may be given several times [default: all but gcc-whole]
    #[arg(long)]
    engine: Vec<Engine>,
    /// Run exactly so many scans, for counting instructions, instead of as many as measuring takes
    #[arg(long, value_parser = clap::value_parser!(u64).range(1..))]
    scans: Option<u64>,
    /// How long a C compiler may take before it is stopped
    #[arg(long, value_name = "TIME", default_value = "1m", value_parser = duration::parse)]
    patience: i64,
    /// Also write what was measured as JSON
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
    /// Also draw it
    #[arg(long, value_name = "FILE")]
    svg: Option<PathBuf>,
    /// Measure programs of the sizes that the literature measured, 18 rungs with 3 timers and 1451 with 246, and print
    /// the ratios beside those
    #[arg(long)]
    paper: bool,
}

/// Turns that the median is taken of, and how long one should take.
const TURNS: usize = 41;
const TURN_TIME: Duration = Duration::from_millis(10);
/// Scans of a turn, also of a program that takes no time.
const MOST_SCANS: u64 = 1 << 20;
/// Scans after which the images of all engines are compared.
const COMPARED_SCANS: u64 = 64;

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let mut measured = Vec::new();
    if arguments.paper {
        for program in paper::programs() {
            measured.push(measure(arguments, program)?);
        }
    }
    for path in &arguments.files {
        let (Loaded { source, .. }, checked) = load_checked(path, arguments.missing)?;
        let program = lower::lower(&checked, &source, None)
            .map_err(|_| Failure::new(Code::ImageTooLarge, "the process image is too large"))?;
        drop(checked);
        measured.push(measure(arguments, program)?);
    }
    let mut text = table::text(&measured);
    if arguments.paper {
        text.push_str(&paper::ratios(&measured));
    }
    if let Some(path) = &arguments.json {
        write_whole(path, table::json(&measured).as_bytes())?;
    }
    if let Some(path) = &arguments.svg {
        write_whole(path, chart::draw(&measured).as_bytes())?;
    }
    print(&text)
}

/// All engines on one program, which is lowered and not yet optimised.
fn measure(arguments: &Arguments, mut lowered: Program) -> Result<Measured, Failure> {
    every_task_every_scan(&mut lowered);
    let optimised = opt::optimise(lowered.clone());
    let patience = Duration::from_nanos(arguments.patience.unsigned_abs());
    let chosen: Vec<Engine> = match arguments.engine.as_slice() {
        [] => Engine::ALL.into_iter().filter(|engine| *engine != Engine::GccWhole).collect(),
        chosen => chosen.to_vec(),
    };
    let mut rows = Vec::new();
    let mut subjects = Vec::new();
    for engine in chosen {
        let (row, subject) = prepare(engine, &lowered, &optimised, patience)?;
        match (row.missing, arguments.engine.is_empty()) {
            (true, true) => continue,
            (true, false) => report(&format!("{}: the compiler is not installed\n", engine.name())),
            (false, _) => {}
        }
        subjects.extend(subject.map(|subject| (rows.len(), subject)));
        rows.push(row);
    }
    compare(&lowered, &rows, &mut subjects)?;
    for (row, nanoseconds) in take_turns(&mut subjects, arguments.scans)? {
        rows[row].nanoseconds = Some(nanoseconds);
    }
    Ok(Measured { program: lowered.name.clone(), rungs: lowered.sections.len(), rows })
}

/// Makes every task due in every scan: what is to be known is how long a round takes at most.
fn every_task_every_scan(program: &mut Program) {
    for task in &mut program.tasks {
        (task.interval, task.due) = (None, None);
    }
}

/// An engine ready to run, and what is known of it before it does; no subject where there is no compiler or too little time.
fn prepare<'p>(
    engine: Engine,
    lowered: &'p Program,
    optimised: &Program,
    patience: Duration,
) -> Result<(Row, Option<Subject<'p>>), Failure> {
    let mut row = Row::new(engine.name());
    if engine.compiler().is_none() {
        let (subject, facts) = Subject::native(engine, lowered)?;
        row.compile_ms = Some(facts.compile.as_secs_f64() * 1e3);
        row.code_bytes = Some(facts.code_bytes);
        row.instructions = facts.instructions.map(to_f64);
        return Ok((row, Some(subject)));
    }
    match compiler::compile(engine, lowered, optimised, patience)? {
        compiler::Outcome::Missing => {
            row.missing = true;
            Ok((row, None))
        }
        compiler::Outcome::TooSlow(after) => {
            row.stopped_after_ms = Some(after.as_secs_f64() * 1e3);
            Ok((row, None))
        }
        compiler::Outcome::Compiled(compiled) => {
            row.compile_ms = Some(compiled.compile.as_secs_f64() * 1e3);
            row.code_bytes = Some(compiled.code_bytes);
            row.instructions = compiled.instructions();
            Ok((row, Some(Subject::compiled(compiled)?)))
        }
    }
}

/// Runs all engines for some scans from the start.
///
/// # Errors
/// When one leaves another image than the first.
fn compare(program: &Program, rows: &[Row], subjects: &mut [(usize, Subject<'_>)]) -> Result<(), Failure> {
    let mut expected: Option<(&str, Vec<u8>)> = None;
    for (row, subject) in subjects {
        let image = subject.image_after(program, COMPARED_SCANS)?;
        let name = rows[*row].engine;
        match &expected {
            None => expected = Some((name, image)),
            Some((first, expected)) => {
                let differs = |slot: &&crate::logic::Slot| slot.read(&image) != slot.read(expected);
                if let Some(slot) = program.layout.slots().iter().find(differs) {
                    let message = format!(
                        "{}: after {COMPARED_SCANS} scans `{}` is not the same by {first} and by {name}",
                        program.name, slot.name
                    );
                    return Err(Failure::new(Code::EnginesDiffer, message));
                }
            }
        }
    }
    Ok(())
}

/// Nanoseconds a scan of each engine, with its row: the medians of the turns, or the means over exactly so many scans.
fn take_turns(subjects: &mut [(usize, Subject<'_>)], scans: Option<u64>) -> Result<Vec<(usize, f64)>, Failure> {
    if let Some(scans) = scans {
        return subjects.iter_mut().map(|(row, subject)| Ok((*row, subject.run(scans)?))).collect();
    }
    let least = TURN_TIME.as_secs_f64() * 1e9;
    let mut turns = Vec::new();
    for (_, subject) in subjects.iter_mut() {
        let mut scans = 1;
        while subject.run(scans)? * to_f64(scans) < least / 2.0 && scans < MOST_SCANS {
            scans *= 2;
        }
        turns.push(scans);
    }
    let mut measured = vec![Vec::with_capacity(TURNS); subjects.len()];
    for _ in 0..TURNS {
        for (((_, subject), scans), measured) in subjects.iter_mut().zip(&turns).zip(&mut measured) {
            measured.push(subject.run(*scans)?);
        }
    }
    let median = |mut measured: Vec<f64>| {
        measured.sort_by(f64::total_cmp);
        measured[TURNS / 2]
    };
    Ok(subjects.iter().zip(measured).map(|((row, _), measured)| (*row, median(measured))).collect())
}

/// A count for people to read.
fn to_f64(count: impl TryInto<u64>) -> f64 {
    let count: u64 = count.try_into().unwrap_or(u64::MAX);
    #[expect(clippy::cast_precision_loss, reason = "a count for people to read")]
    let count = count as f64;
    count
}
