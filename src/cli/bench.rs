//! `rung bench`: every engine on the given programs, side by side.
//!
//! Every engine gets the same images at the same times. What is measured is the scan alone: the inputs are changed
//! between the measured runs, a tenth of the BOOLs each time.

use std::fmt::Write as _;
use std::path::PathBuf;
use std::time::{Duration, Instant};

use rung_runtime::Scan;

use super::{Failure, load_checked, print};
use crate::diagnostic::Code;
use crate::elementary::{Elementary, Value};
use crate::engine::interp::{Interpreter, Textbook};
use crate::engine::jit::Jit;
use crate::logic::{Area, Program, Slot};
use crate::{lower, opt};

/// Measures every engine on the given programs
#[derive(Debug, clap::Args)]
pub(super) struct Arguments {
    /// The programs
    #[arg(required = true)]
    files: Vec<PathBuf>,
    /// Only this engine
    #[arg(long)]
    engine: Option<Engine>,
    /// Run exactly so many scans, for counting instructions, instead of as many as measuring takes
    #[arg(long)]
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

/// Runs that the median is taken of, and how long one should take.
const RUNS: usize = 41;
const RUN_TIME: Duration = Duration::from_millis(10);

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let mut table = format!(
        "{:<24} {:>7} {:<9} {:>10} {:>8} {:>8} {:>11} {:>10}\n",
        "program", "rungs", "engine", "ns/scan", "ns/rung", "ratio", "compile ms", "bytes/rung"
    );
    for path in &arguments.files {
        let (loaded, checked) = load_checked(path)?;
        let program = lower::lower(&checked, &loaded.source, None)
            .map_err(|_| Failure::new(Code::ImageTooLarge, "the process image is too large"))?;
        let program = opt::optimise(program);
        let mut fastest = None;
        for engine in Engine::ALL.into_iter().filter(|engine| arguments.engine.is_none_or(|only| only == *engine)) {
            let start = Instant::now();
            let (mut scan, code_bytes) = make(engine, &program)?;
            let compile = start.elapsed();
            let nanoseconds = measure(scan.as_mut(), &program, arguments.scans);
            let fastest = *fastest.get_or_insert(nanoseconds);
            #[expect(clippy::cast_precision_loss, reason = "counts for people to read")]
            let (rungs, bytes) = (program.sections.len().max(1) as f64, code_bytes as f64);
            // Writing to a string does not fail.
            let _ = writeln!(
                table,
                "{:<24} {:>7} {:<9} {:>10.1} {:>8.2} {:>8.2} {:>11.2} {:>10.1}",
                program.name,
                program.sections.len(),
                engine.name(),
                nanoseconds,
                nanoseconds / rungs,
                nanoseconds / fastest,
                compile.as_secs_f64() * 1e3,
                bytes / rungs
            );
        }
    }
    print(&table)
}

fn make(engine: Engine, program: &Program) -> Result<(Box<dyn Scan>, usize), Failure> {
    Ok(match engine {
        Engine::Jit => {
            let jit = Jit::compile(program).map_err(|error| Failure::new(Code::CannotCompile, error.to_string()))?;
            let bytes = jit.code_bytes();
            (Box::new(jit), bytes)
        }
        Engine::Interp => {
            let interpreter = Interpreter::new(program);
            let bytes = interpreter.code_bytes();
            (Box::new(interpreter), bytes)
        }
        Engine::Textbook => {
            let textbook = Textbook::new(program);
            (Box::new(textbook), size_of_val(program.instructions.as_slice()))
        }
    })
}

/// Nanoseconds a scan: the median of the runs, or the mean over exactly so many scans.
fn measure(scan: &mut dyn Scan, program: &Program, scans: Option<u64>) -> f64 {
    let mut plant = Plant::new(program);
    if let Some(scans) = scans {
        return plant.run(scan, scans);
    }
    let mut scans = 1;
    while plant.run(scan, scans) * to_f64(scans) < RUN_TIME.as_secs_f64() * 1e9 / 2.0 {
        scans *= 2;
    }
    let mut runs: Vec<f64> = (0..RUNS).map(|_| plant.run(scan, scans)).collect();
    runs.sort_by(f64::total_cmp);
    runs[RUNS / 2]
}

/// An image whose BOOL inputs change at random.
struct Plant<'a> {
    image: Vec<u8>,
    inputs: Vec<&'a Slot>,
    now: i64,
    random: u64,
}

/// Time from one scan to the next, in nanoseconds.
const CYCLE: i64 = 1_000_000;
/// Scans between two changes of the inputs, so that changing them costs next to nothing beside the scans.
const SCANS_PER_CHANGE: u64 = 16;

impl<'a> Plant<'a> {
    fn new(program: &'a Program) -> Self {
        let slots = program.layout.slots().iter();
        let inputs = slots.filter(|slot| slot.area == Area::Input && slot.ty == Elementary::Bool).collect();
        Self { image: program.layout.initial_image(), inputs, now: 0, random: 0x9E37_79B9_7F4A_7C15 }
    }

    fn next_random(&mut self) -> u64 {
        // xorshift64: cheap, and the same on every machine.
        self.random ^= self.random << 13;
        self.random ^= self.random >> 7;
        self.random ^= self.random << 17;
        self.random
    }

    /// Runs scans; gives nanoseconds a scan, without the time for changing inputs.
    fn run(&mut self, scan: &mut dyn Scan, scans: u64) -> f64 {
        let mut spent = Duration::ZERO;
        let mut left = scans;
        while left > 0 {
            for _ in 0..self.inputs.len().div_ceil(10) {
                let (which, value) = (self.next_random(), self.next_random());
                let index = usize::try_from(which % self.inputs.len() as u64).unwrap_or(0);
                self.inputs[index].write(&mut self.image, Value::bool(value >> 63 == 1));
            }
            let batch = left.min(SCANS_PER_CHANGE);
            let start = Instant::now();
            for _ in 0..batch {
                scan.scan(&mut self.image, self.now);
                self.now += CYCLE;
            }
            spent += start.elapsed();
            left -= batch;
        }
        spent.as_secs_f64() * 1e9 / to_f64(scans)
    }
}

fn to_f64(count: u64) -> f64 {
    #[expect(clippy::cast_precision_loss, reason = "a count of scans")]
    let count = count as f64;
    count
}
