//! `rung bench`: every engine on the given programs, side by side.
//!
//! Every engine gets the same images at the same times. What is measured is the scan alone: the inputs are changed
//! between the measured scans, a tenth of the BOOLs each time. The engines take turns, so that whatever else the
//! machine does hits all of them alike, and the figures are medians over the turns. All tasks run in every scan.

mod plant;

use std::fmt::Write as _;
use std::path::PathBuf;
use std::time::{Duration, Instant};

use rung_runtime::Scan;
use target_lexicon::Triple;

use super::{Failure, Missing, load_checked, print};
use crate::diagnostic::Code;
use crate::engine::disassemble::lines;
use crate::engine::interp::{Interpreter, Textbook};
use crate::engine::jit::{Jit, host_isa};
use crate::logic::Program;
use crate::{lower, opt};
use plant::Plant;

/// Measures every engine on the given programs
#[derive(Debug, clap::Args)]
pub(super) struct Arguments {
    /// The programs
    #[arg(required = true)]
    files: Vec<PathBuf>,
    #[command(flatten)]
    missing: Missing,
    /// Only this engine
    #[arg(long)]
    engine: Option<Engine>,
    /// Run exactly so many scans, for counting instructions, instead of as many as measuring takes
    #[arg(long, value_parser = clap::value_parser!(u64).range(1..))]
    scans: Option<u64>,
}

#[derive(Clone, Copy, PartialEq, Debug, clap::ValueEnum)]
enum Engine {
    Jit,
    Interp,
    Textbook,
}

impl Engine {
    const ALL: [Self; 3] = [Self::Jit, Self::Interp, Self::Textbook];

    const fn name(self) -> &'static str {
        match self {
            Self::Jit => "jit",
            Self::Interp => "interp",
            Self::Textbook => "textbook",
        }
    }
}

/// Turns that the median is taken of, and how long one should take.
const TURNS: usize = 41;
const TURN_TIME: Duration = Duration::from_millis(10);
/// Scans of a turn, also of a program that takes no time.
const MOST_SCANS: u64 = 1 << 20;

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let mut table = format!(
        "{:<20} {:>6} {:<8} {:>11} {:>8} {:>7}  {:<BAR$} {:>10} {:>10} {:>10}\n",
        "program", "rungs", "engine", "ns/scan", "ns/rung", "ratio", "", "compile ms", "bytes/rung", "instr/rung"
    );
    for path in &arguments.files {
        let (loaded, checked) = load_checked(path, arguments.missing)?;
        let program = lower::lower(&checked, &loaded.source, None)
            .map_err(|_| Failure::new(Code::ImageTooLarge, "the process image is too large"))?;
        let mut program = opt::optimise(program);
        every_task_every_scan(&mut program);
        let chosen = Engine::ALL.into_iter().filter(|engine| arguments.engine.is_none_or(|only| only == *engine));
        let mut subjects = chosen.map(|engine| Subject::new(engine, &program)).collect::<Result<Vec<_>, _>>()?;
        let medians = measure(&mut subjects, arguments.scans);
        table.push_str(&rows(&program, &subjects, &medians));
    }
    print(&table)
}

/// Makes every task due in every scan: what is to be known is how long a round takes at most.
fn every_task_every_scan(program: &mut Program) {
    for task in &mut program.tasks {
        (task.interval, task.due) = (None, None);
    }
}

/// The rows of one program. Ratios are to the fastest engine, and a full bar is the slowest.
fn rows(program: &Program, subjects: &[Subject<'_>], medians: &[f64]) -> String {
    // A clock may be too coarse to see a scan at all.
    let (fastest, slowest) =
        medians.iter().fold((f64::INFINITY, 0.1f64), |(least, most), median| (least.min(*median), most.max(*median)));
    let sections = program.sections.len();
    let a_rung = |count: f64| if sections == 0 { "-".to_owned() } else { format!("{:.1}", count / to_f64(sections)) };
    let mut rows = String::new();
    for (subject, median) in subjects.iter().zip(medians) {
        // Writing to a string does not fail.
        let _ = writeln!(
            rows,
            "{:<20} {:>6} {:<8} {:>11.1} {:>8} {:>7.2}  {:<BAR$} {:>10.2} {:>10} {:>10}",
            program.name,
            sections,
            subject.engine.name(),
            median,
            a_rung(*median),
            median / fastest.max(0.1),
            bar(*median / slowest),
            subject.compile.as_secs_f64() * 1e3,
            a_rung(to_f64(subject.code_bytes)),
            subject.instructions.map_or_else(|| "-".to_owned(), |count| a_rung(to_f64(count))),
        );
    }
    rows
}

/// Cells of the longest bar.
const BAR: usize = 16;

/// A bar of a length from 0 to 1, at least a sliver.
fn bar(share: f64) -> String {
    (0..BAR).take_while(|cell| *cell == 0 || share * to_f64(BAR) >= to_f64(*cell) + 0.5).map(|_| '█').collect()
}

/// An engine that is ready to run, and its plant.
struct Subject<'p> {
    engine: Engine,
    scan: Box<dyn Scan>,
    plant: Plant<'p>,
    compile: Duration,
    /// Bytes of machine code, or of what the engine has in its place.
    code_bytes: usize,
    /// Machine instructions of a scan: exact, since the code is a straight line. `None` where they are not known.
    instructions: Option<usize>,
}

impl<'p> Subject<'p> {
    fn new(engine: Engine, program: &'p Program) -> Result<Self, Failure> {
        let start = Instant::now();
        let (scan, code_bytes, instructions, compile): (Box<dyn Scan>, _, _, _) = match engine {
            Engine::Jit => {
                let refused = |error: String| Failure::new(Code::CannotCompile, error);
                let jit = Jit::compile(program).map_err(|error| refused(error.to_string()))?;
                let compile = start.elapsed();
                let instructions = host_isa().ok().and_then(|isa| instructions(&jit, isa.triple()).ok());
                let bytes = jit.code_bytes();
                (Box::new(jit), bytes, instructions, compile)
            }
            Engine::Interp => {
                let interpreter = Interpreter::new(program);
                let bytes = interpreter.code_bytes();
                (Box::new(interpreter), bytes, None, start.elapsed())
            }
            Engine::Textbook => {
                let textbook = Textbook::new(program);
                (Box::new(textbook), size_of_val(program.instructions.as_slice()), None, start.elapsed())
            }
        };
        Ok(Self { engine, scan, plant: Plant::new(program), compile, code_bytes, instructions })
    }

    /// Runs scans; gives nanoseconds a scan.
    fn run(&mut self, scans: u64) -> f64 {
        self.plant.run(self.scan.as_mut(), scans)
    }
}

/// Machine instructions of one scan.
fn instructions(jit: &Jit, target: &Triple) -> Result<usize, String> {
    jit.chunks().iter().map(|chunk| Ok(lines(&chunk.code[..chunk.instruction_bytes], target)?.len())).sum()
}

/// Nanoseconds a scan of each engine: the medians of the turns, or the means over exactly so many scans.
fn measure(subjects: &mut [Subject<'_>], scans: Option<u64>) -> Vec<f64> {
    if let Some(scans) = scans {
        return subjects.iter_mut().map(|subject| subject.run(scans)).collect();
    }
    let least = TURN_TIME.as_secs_f64() * 1e9;
    let turns: Vec<u64> = subjects
        .iter_mut()
        .map(|subject| {
            let mut scans = 1;
            while subject.run(scans) * to_f64(scans) < least / 2.0 && scans < MOST_SCANS {
                scans *= 2;
            }
            scans
        })
        .collect();
    let mut measured = vec![Vec::with_capacity(TURNS); subjects.len()];
    for _ in 0..TURNS {
        for ((subject, scans), measured) in subjects.iter_mut().zip(&turns).zip(&mut measured) {
            measured.push(subject.run(*scans));
        }
    }
    measured
        .into_iter()
        .map(|mut measured| {
            measured.sort_by(f64::total_cmp);
            measured[TURNS / 2]
        })
        .collect()
}

/// A count for people to read.
fn to_f64(count: impl TryInto<u64>) -> f64 {
    let count: u64 = count.try_into().unwrap_or(u64::MAX);
    #[expect(clippy::cast_precision_loss, reason = "a count for people to read")]
    let count = count as f64;
    count
}
