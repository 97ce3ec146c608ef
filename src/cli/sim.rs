//! `rung sim`: a program in virtual time.

mod lanes;

use std::ffi::OsStr;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use clap::ValueEnum;
use rung_runtime::Scan;

use super::run::{difference, time};
use super::{Failure, Missing, WholeFile, cannot_write, duration, load_checked, read_source, report, tasks};
use crate::diagnostic::Code;
use crate::engine::both::Difference;
use crate::engine::elide::Elided;
use crate::engine::interp::Interpreter;
use crate::engine::jit::Jit;
use crate::load::Loaded;
use crate::logic::{Layout, Program};
use crate::lower::lower;
use crate::opt::optimise;
use crate::replay::{Replay, source_hash};
use crate::simulate::{Schedule, Simulation, Stimuli, assertion};
use crate::source::Source;
use crate::trace::{CsvTrace, Period, Signal, SvgTrace, Trace, VcdTrace};

/// Runs a program in virtual time and writes what its variables did
///
/// Scan k, from 0, happens at time k x cycle. The same files give the same bytes, on every engine.
#[derive(Debug, clap::Args)]
pub(super) struct Arguments {
    /// The program; `-` is the standard input
    file: PathBuf,
    #[command(flatten)]
    missing: Missing,
    /// A CSV table of what is set when: `time_ms,name,name,…`
    #[arg(long, value_name = "FILE.csv")]
    stimuli: Option<PathBuf>,
    /// Time from one scan to the next [default: what the tasks' intervals have in common, or 10ms]
    #[arg(long, value_parser = duration::parse)]
    cycle: Option<i64>,
    /// Run so many scans [default: until a second after the last stimulus, or 100 scans without stimuli]
    #[arg(long, conflicts_with = "duration")]
    scans: Option<u64>,
    /// Run all scans before this time
    #[arg(long = "for", value_name = "DURATION", value_parser = duration::parse)]
    duration: Option<i64>,
    /// What runs the scans; `both` compares the whole image after each and stops at a difference
    #[arg(long, value_enum, default_value = "jit")]
    engine: Engine,
    /// Leave out scans that would change nothing: the trace is the same
    #[arg(long)]
    elide: bool,
    /// Write a trace: a table (`.csv`), waves (`.vcd`), a timing diagram (`.svg`), or a table on the standard output
    /// (`-`, which is the default)
    #[arg(long, value_name = "FILE")]
    trace: Vec<PathBuf>,
    /// Trace these variables only; a program, instance, array or structure stands for all in it
    #[arg(long, value_name = "NAME,…", value_delimiter = ',')]
    signals: Option<Vec<String>>,
    /// Run the scans of a replay file, which `rung run --engine both` leaves at a difference
    #[arg(long, value_name = "FILE", conflicts_with_all = ["stimuli", "cycle", "scans", "duration"])]
    replay: Option<PathBuf>,
    #[command(flatten)]
    many: lanes::Plants,
}

#[derive(Clone, Copy, PartialEq, Eq, Debug, ValueEnum)]
enum Engine {
    /// Compiled to machine code
    Jit,
    /// Interpreted
    Interp,
    /// Both, side by side
    Both,
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let (Loaded { source, .. }, checked) = load_checked(&arguments.file, arguments.missing)?;
    let mut program = lower(&checked, &source, None)
        .map_err(|_| Failure::new(Code::ImageTooLarge, "the process image is too large"))?;
    drop(checked);
    // The image as a replay and its layout's hash know it.
    let plain = program.layout.clone();
    let assertions = (arguments.many.assertions.iter())
        .map(|text| {
            let holds = assertion::assert(&mut program, text)
                .map_err(|refused| Failure::diagnostics(&refused.0, &refused.1))?;
            Ok(lanes::Assertion { text: text.clone(), holds })
        })
        .collect::<Result<Vec<_>, Failure>>()?;
    let program = optimise(program);
    let signals = match &arguments.signals {
        None => Signal::all(&program.layout),
        Some(names) => Signal::select(&program.layout, names)
            .map_err(|name| Failure::new(Code::UndeclaredName, format!("there is no variable `{name}` to trace")))?,
    };
    let course = Course::read(arguments, &source, &program, &plain)?;
    if let (Some(lanes), Course::Stimulated(stimuli, schedule)) = (arguments.many.lanes, &course) {
        let stop = catch_interrupts()?;
        let run = lanes::Run {
            file: &arguments.file,
            arguments: &arguments.many,
            program: &program,
            signals: arguments.signals.as_deref(),
            schedule: *schedule,
            stimuli,
            assertions: &assertions,
            stop: &stop,
        };
        return run.run(lanes);
    }
    // Made before the outputs, so that what cannot be compiled leaves nothing.
    let mut engines = Engines::new(arguments.engine, arguments.elide, &program)?;
    let paths = trace_paths(&arguments.trace)?;
    // Where it would end the process at once, a temporary file would be left beside each output.
    let stop = catch_interrupts()?;
    let mut files = paths.iter().map(|(path, _)| WholeFile::create(path)).collect::<Result<Vec<_>, _>>()?;
    let mut outputs = Vec::new();
    for ((path, format), file) in paths.iter().zip(&mut files) {
        let trace = format.start(&program.name, signals.clone(), course.period(), file);
        match trace.map_err(|error| cannot_write(path, &error)) {
            // The others are still to be written.
            Err(Failure::Closed) if paths.len() > 1 => {}
            trace => outputs.push((*path, trace?)),
        }
    }

    let mut simulation = course.start(&program.layout);
    let mut beside = course.start(&program.layout);
    let (mut scan, mut failed) = (0u64, None);
    while let Some(now) = simulation.step(&mut *engines.first) {
        if stop.load(Ordering::Relaxed) {
            return Err(Failure::Interrupted);
        }
        if let Some(second) = &mut engines.second {
            beside.step(&mut **second);
            if let Some(difference) = Difference::between(&program, simulation.image(), beside.image()) {
                let found = difference::described(&difference, now);
                return Err(Failure::new(Code::EnginesDiffer, format!("the engines differ\n  {found}")));
            }
        }
        if failed.is_none() {
            let fails = |one: &&lanes::Assertion| !program.layout.slot(one.holds).read(simulation.image()).is_true();
            failed = assertions.iter().find(fails).map(|assertion| (assertion, scan, now));
        }
        scan += 1;
        let mut closed = false;
        for (path, trace) in &mut outputs {
            match trace.record(now, simulation.image()).map_err(|error| cannot_write(path, &error)) {
                Err(Failure::Closed) => closed = true,
                result => result?,
            }
        }
        // That nobody reads the standard output any more is no reason to leave the files unwritten.
        if closed {
            outputs.retain(|(path, _)| *path != Path::new("-"));
            if outputs.is_empty() {
                return Err(Failure::Closed);
            }
        }
    }
    if program.layout.fault().is_some_and(|slot| program.layout.slot(slot).read(simulation.image()).is_true()) {
        report(&format!("note: {}\n", tasks::FAULT));
    }
    for (path, mut trace) in outputs {
        unless_closed(trace.finish().map_err(|error| cannot_write(path, &error)))?;
    }
    files.into_iter().try_for_each(|file| unless_closed(file.finish()))?;
    match failed {
        None => Ok(()),
        Some((assertion, scan, now)) => {
            let (text, now) = (&assertion.text, time::exact(now));
            let message = format!("the assertion `{text}` does not hold after scan {scan}, at {now}");
            Err(Failure::new(Code::AssertionFails, message))
        }
    }
}

/// What is TRUE once Ctrl-C was pressed, which then ends nothing by itself.
fn catch_interrupts() -> Result<Arc<AtomicBool>, Failure> {
    let stop = Arc::new(AtomicBool::new(false));
    let asked = Arc::clone(&stop);
    ctrlc::set_handler(move || asked.store(true, Ordering::Relaxed))
        .map_err(|error| Failure::new(Code::CannotStart, format!("Ctrl-C cannot be caught: {error}")))?;
    Ok(stop)
}

/// A result in which a closed standard output is none.
fn unless_closed(result: Result<(), Failure>) -> Result<(), Failure> {
    match result {
        Err(Failure::Closed) => Ok(()),
        result => result,
    }
}

/// A format of traces.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Format {
    Csv,
    Vcd,
    Svg,
}

impl Format {
    fn start<'w>(
        self,
        program: &str,
        signals: Vec<Signal>,
        period: Period,
        file: &'w mut WholeFile,
    ) -> io::Result<Box<dyn Trace + 'w>> {
        Ok(match self {
            Self::Csv => Box::new(CsvTrace::new(signals, file)?),
            Self::Vcd => Box::new(VcdTrace::new(program, signals, file)?),
            Self::Svg => Box::new(SvgTrace::new(program, signals, period, file)),
        })
    }
}

/// The files that are asked for, each with its format; without any the standard output.
fn trace_paths(asked: &[PathBuf]) -> Result<Vec<(&Path, Format)>, Failure> {
    if asked.is_empty() {
        return Ok(vec![(Path::new("-"), Format::Csv)]);
    }
    let mut paths: Vec<(&Path, Format)> = Vec::new();
    for path in asked {
        let extension = path.extension().and_then(OsStr::to_str).map(str::to_ascii_lowercase);
        let format = match extension.as_deref() {
            _ if path == Path::new("-") => Format::Csv,
            Some("csv") => Format::Csv,
            Some("vcd") => Format::Vcd,
            Some("svg") => Format::Svg,
            _ => {
                let message = format!("{} is no trace: its name must end in .csv, .vcd or .svg", path.display());
                return Err(Failure::new(Code::UnknownFormat, message));
            }
        };
        if paths.iter().any(|(earlier, _)| earlier == path) {
            return Err(Failure::new(Code::CannotWrite, format!("{} is to be written twice", path.display())));
        }
        paths.push((path, format));
    }
    Ok(paths)
}

/// What drives the run.
enum Course {
    Stimulated(Stimuli, Schedule),
    Replayed(Replay),
}

impl Course {
    fn read(arguments: &Arguments, drawn: &Source, program: &Program, plain: &Layout) -> Result<Self, Failure> {
        let layout = &program.layout;
        if let Some(path) = &arguments.replay {
            let source = read_source(path)?;
            let replay = Replay::parse(&source).and_then(|replay| replay.check(plain).map(|()| replay));
            let replay = replay.map_err(|problem| Failure::diagnostics(&source, &[problem]))?;
            if replay.source_hash != source_hash(drawn) {
                let (path, recorded) = (path.display(), &replay.program);
                report(&format!("note: the program's text has changed since {path} was recorded from {recorded}\n"));
            }
            return Ok(Self::Replayed(extended(replay, plain, layout)));
        }
        let stimuli = match &arguments.stimuli {
            None => Stimuli::default(),
            Some(path) => {
                let source = read_source(path)?;
                Stimuli::parse(&source, layout).map_err(|problems| Failure::diagnostics(&source, &problems))?
            }
        };
        let cycle = arguments.cycle.unwrap_or_else(|| tasks::cycle(program));
        report(&tasks::notes(program, cycle));
        let schedule = match (arguments.scans, arguments.duration) {
            (Some(scans), _) => Schedule::scans(cycle, scans),
            (None, Some(duration)) => Schedule::before(cycle, duration),
            (None, None) => Schedule::covering(cycle, &stimuli),
        };
        match schedule {
            Some(schedule) if arguments.many.random() && arguments.many.lanes.is_none() => {
                Ok(Self::Stimulated(arguments.many.stimuli_of_one(layout, schedule, &stimuli), schedule))
            }
            Some(schedule) => Ok(Self::Stimulated(stimuli, schedule)),
            None => Err(Failure::new(Code::OutOfRange, "the last scan would come after the end of time, in 292 years")),
        }
    }

    fn start<'a>(&'a self, layout: &'a Layout) -> Simulation<'a> {
        match self {
            Self::Stimulated(stimuli, schedule) => Simulation::new(layout, stimuli, *schedule),
            Self::Replayed(replay) => Simulation::replaying(layout, replay),
        }
    }

    fn period(&self) -> Period {
        match self {
            Self::Stimulated(_, schedule) => Period { start: 0, end: schedule.end(), cycle: schedule.cycle() },
            Self::Replayed(replay) => Period::of(replay.scans.iter().map(|scan| scan.now)),
        }
    }
}

/// A replay over an image that has more slots behind its own.
fn extended(mut replay: Replay, plain: &Layout, layout: &Layout) -> Replay {
    if let Some(image) = &mut replay.start_image {
        let mut whole = layout.initial_image();
        for slot in plain.slots() {
            slot.write(&mut whole, slot.read(image));
        }
        *image = whole;
    }
    replay
}

/// The engine that is traced, and the one that it is compared with.
struct Engines {
    first: Box<dyn Scan>,
    second: Option<Box<dyn Scan>>,
}

impl Engines {
    fn new(engine: Engine, elide: bool, program: &Program) -> Result<Self, Failure> {
        let compiled = || -> Result<Box<dyn Scan>, Failure> {
            let jit = Jit::compile(program).map_err(|error| Failure::new(Code::CannotCompile, error.to_string()))?;
            Ok(if elide { Box::new(Elided::new(jit, program)) } else { Box::new(jit) })
        };
        let interpreted = || -> Box<dyn Scan> {
            let interpreter = Interpreter::new(program);
            if elide { Box::new(Elided::new(interpreter, program)) } else { Box::new(interpreter) }
        };
        Ok(match engine {
            Engine::Jit => Self { first: compiled()?, second: None },
            Engine::Interp => Self { first: interpreted(), second: None },
            Engine::Both => Self { first: interpreted(), second: Some(compiled()?) },
        })
    }
}
