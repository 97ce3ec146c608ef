//! `rung run`: a program in real time, on a simulated panel.

pub(super) mod difference;
mod elements;
mod engine;
mod machine;
mod plain;
mod points;
pub(super) mod time;
mod view;

use std::io::IsTerminal;
use std::num::NonZeroU32;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

use rung_runtime::host::{End, Histogram, Statistics};
use rung_runtime::{Fault, Stopped};

use super::{Failure, Missing, duration, load_checked, print, report, tasks};
use crate::check::Checked;
use crate::diagnostic::Code;
use crate::elementary::Value;
use crate::load::Loaded;
use crate::logic::Program;
use crate::logic::image::Slot;
use crate::lower::lower;
use crate::opt::optimise;
use crate::source::Source;
use engine::{Engine, Kind};
use machine::{Lost, Machine, Outcome, Timing};
use points::Points;

/// Cycles that a scan may take by default, and the least time that it then may take in any case: a shorter
/// one would trip on a busy machine.
const WATCHDOG_CYCLES: i64 = 10;
const LEAST_DEFAULT_WATCHDOG: i64 = 100_000_000;

/// The shortest tick, 50 us: below, waking takes longer than the tick. The longest cycle is an hour.
const SHORTEST_TICK: i64 = 50_000;
const LONGEST_CYCLE: i64 = 3_600_000_000_000;

/// Runs a program in real time on a simulated panel, until Ctrl-C
#[derive(Debug, clap::Args)]
pub(super) struct Arguments {
    /// The program; `-` is the standard input
    file: PathBuf,
    #[command(flatten)]
    missing: Missing,
    /// Time from one scan to the next, a multiple of the tick [default: what the tasks' intervals have in common, or 10ms]
    #[arg(long, value_parser = duration::parse, value_name = "TIME")]
    cycle: Option<i64>,
    /// Period of the tick interrupt, which is the grain of all times
    #[arg(long, value_parser = duration::parse, default_value = "1ms", value_name = "TIME")]
    tick: i64,
    /// Which engine runs it
    #[arg(long, value_enum, default_value = "jit")]
    engine: Kind,
    /// Leave out scans that would change nothing: the results are the same, but a scan's time then depends on the plant
    #[arg(long)]
    elide: bool,
    /// End after this time
    #[arg(long = "for", value_parser = duration::parse, value_name = "TIME")]
    length: Option<i64>,
    /// A cycle that takes longer stops the program; 10 cycles, but at least 100 ms, unless given
    #[arg(long, value_parser = duration::parse, value_name = "TIME")]
    watchdog: Option<i64>,
    /// Print plain lines also on a terminal
    #[arg(long)]
    plain: bool,
    /// Set an input at the start, as `start=1`
    #[arg(long, value_name = "NAME=VALUE")]
    set: Vec<String>,
    /// Where to leave a replay when the engines differ; beside the program, as `.replay.json`, unless given
    #[arg(long, value_name = "FILE")]
    replay: Option<PathBuf>,
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let (Loaded { source, .. }, checked) = load_checked(&arguments.file, arguments.missing)?;
    let began = Instant::now();
    let lowered = lower(&checked, &source, None)
        .map_err(|_| Failure::new(Code::ImageTooLarge, "the process image would be larger than 1 GiB"))?;
    let program = optimise(lowered);
    let cycle = arguments.cycle.unwrap_or_else(|| tasks::cycle(&program));
    let timing = timing(arguments, cycle)?;
    report(&tasks::notes(&program, cycle));
    let make = if arguments.elide { Engine::elided } else { Engine::new };
    let engine =
        make(arguments.engine, &program).map_err(|error| Failure::new(Code::CannotCompile, error.to_string()))?;
    let compiled_in = u64::try_from(began.elapsed().as_nanos()).unwrap_or(u64::MAX);
    let points = Points::new(&checked, &program.layout);
    let inputs = initial_inputs(&arguments.set, &points)?;
    print(&description(arguments, &checked, &program, &engine, cycle, compiled_in))?;

    let stop = Arc::new(AtomicBool::new(false));
    let asked = Arc::clone(&stop);
    ctrlc::set_handler(move || asked.store(true, Ordering::Relaxed))
        .map_err(|error| Failure::new(Code::CannotStart, format!("Ctrl-C cannot be caught: {error}")))?;
    let terminal = std::io::stdout().is_terminal() && std::io::stdin().is_terminal();
    let live = !arguments.plain && terminal && !view::in_background();
    let told = if live { Vec::new() } else { points.told() };
    let machine = Machine::start(engine, &program.layout, &inputs, timing, &told, stop)
        .map_err(|error| Failure::new(Code::CannotStart, error.to_string()))?;
    let watched = print(&format!("  {}\n", machine.scheduling)).and_then(|()| {
        if live {
            view::watch(
                &machine,
                &points,
                &view::Title { program: &program.name, engine: arguments.engine.name(), cycle },
            )
        } else {
            plain::watch(&machine, &told)
        }
    });

    // Whoever watched may have gone, but the outputs are to be off before anything else.
    machine.shared.stop.store(true, Ordering::Relaxed);
    let shared = Arc::clone(&machine.shared);
    let outcome = machine.finish();
    let fault = outcome.as_ref().is_ok_and(|outcome| points.is_faulty(&outcome.image));
    let left_out = outcome.as_ref().ok().and_then(|outcome| outcome.engine.left_out());
    let summary = summary(&shared.statistics, timing.watchdog, &program, left_out, fault);
    let watched = watched.and_then(|()| print(&summary));
    // A fault is told in any case, also where nobody reads the standard output any more.
    match outcome {
        Err(Lost::Hung) => {
            let limit = time::rounded(timing.watchdog);
            let message = format!("no sign of life for {limit}: the field or the scan hangs; the outputs are off");
            Err(Failure::new(Code::Stopped, message))
        }
        Err(Lost::Panicked) => Err(Failure::new(Code::Stopped, "the scan panicked; the outputs are off")),
        Ok(outcome) => ended(outcome, arguments, &source, &program).and(watched),
    }
}

/// Ticks from what was asked for.
fn timing(arguments: &Arguments, cycle: i64) -> Result<Timing, Failure> {
    let bad = |message: String| Failure::new(Code::BadTiming, message);
    let tick = arguments.tick;
    if cycle % tick != 0 {
        let (cycle, tick) = (time::exact(cycle), time::exact(tick));
        return Err(bad(format!("the cycle, {cycle}, is no multiple of the tick, {tick}")));
    }
    let count = |number: i64| u32::try_from(number).ok().and_then(NonZeroU32::new);
    let within = tick >= SHORTEST_TICK && cycle <= LONGEST_CYCLE;
    let (Some(tick), Some(ticks), true) = (count(tick), count(cycle / tick), within) else {
        return Err(bad("a tick may have from 50us to 4s, a cycle up to an hour".to_owned()));
    };
    Ok(Timing {
        tick,
        cycle: ticks,
        ends_at: arguments.length.map(|length| length.unsigned_abs().div_ceil(u64::from(tick.get()))),
        watchdog: arguments.watchdog.unwrap_or((cycle * WATCHDOG_CYCLES).max(LEAST_DEFAULT_WATCHDOG)).unsigned_abs(),
    })
}

/// The inputs that `--set` names.
fn initial_inputs(set: &[String], points: &Points) -> Result<Vec<(Slot, Value)>, Failure> {
    let one = |text: &String| {
        let (name, value) = text
            .split_once('=')
            .ok_or_else(|| Failure::new(Code::BadLiteral, format!("{text:?} is not NAME=VALUE")))?;
        let input = points
            .input(name.trim())
            .ok_or_else(|| Failure::new(Code::UndeclaredName, format!("there is no input {:?}", name.trim())))?;
        let ty = input.slot.ty;
        let value = points::read(ty, value.trim())
            .ok_or_else(|| Failure::new(Code::OutOfRange, format!("{:?} is no value of {ty}", value.trim())))?;
        Ok((input.slot.clone(), value))
    };
    set.iter().map(one).collect()
}

/// What was loaded and compiled.
fn description(
    arguments: &Arguments,
    checked: &Checked,
    program: &Program,
    engine: &Engine,
    cycle: i64,
    compiled_in: u64,
) -> String {
    let counts = elements::count(checked);
    let rungs: usize = checked.units().iter().map(|unit| unit.rungs.len()).sum();
    let code = engine
        .code_bytes()
        .map_or_else(String::new, |bytes| format!(", {bytes} bytes of code ({} a rung)", bytes.div_ceil(rungs.max(1))));
    let boxes = if counts.boxes == 0 { String::new() } else { format!(", {} boxes", counts.boxes) };
    let tasks = tasks::listed(program).map_or_else(String::new, |tasks| format!("  tasks {tasks}\n"));
    format!(
        "{}: {rungs} rungs, {} contacts, {} coils, {} blocks{boxes}\n  image {} bytes, {} instructions of logic{code}, \
         compiled in {}\n  engine {}, cycle {}, tick {}\n{tasks}",
        checked.name(),
        counts.contacts,
        counts.coils,
        counts.blocks,
        program.layout.size(),
        program.instructions.len(),
        time::rounded(compiled_in),
        arguments.engine.name(),
        time::exact(cycle),
        time::exact(arguments.tick),
    )
}

/// The figures of a whole run.
fn summary(statistics: &Statistics, watchdog: u64, program: &Program, left_out: Option<u64>, fault: bool) -> String {
    let left_out = left_out.map_or_else(String::new, |scans| format!(", {scans} scans left out"));
    let tasks = tasks::listed(program).map_or_else(String::new, |tasks| format!("  tasks     {tasks}\n"));
    let fault = if fault { format!("  fault     {}\n", tasks::FAULT) } else { String::new() };
    let line =
        |name: &str, histogram: &Histogram| format!("  {name:<9} {} (p50 / p99 / max)\n", plain::quantiles(histogram));
    format!(
        "ended after {} cycles, {} overruns, {} skipped{left_out}\n{}{}  {:<9} {}\n{tasks}{fault}",
        statistics.cycles(),
        statistics.overruns(),
        statistics.skipped(),
        line("scan", &statistics.scan),
        line("lateness", &statistics.lateness),
        "watchdog",
        time::rounded(watchdog),
    )
}

/// What is to be said of a run that ended.
fn ended(outcome: Outcome<Engine>, arguments: &Arguments, source: &Source, program: &Program) -> Result<(), Failure> {
    let fault = match outcome.end {
        End::Asked(Ok(())) => return Ok(()),
        End::NoHeartbeat => {
            return Err(Failure::new(
                Code::Stopped,
                "a cycle did not come in time for the watchdog; the outputs are off",
            ));
        }
        End::Stopped(Stopped { fault, outputs_off: Ok(()) }) => fault,
    };
    match fault {
        Fault::Watchdog { took, limit } => {
            let (took, limit) = (time::rounded(took), time::rounded(limit));
            let message = format!("a cycle took {took}, longer than the watchdog's {limit}; the outputs are off");
            Err(Failure::new(Code::Stopped, message))
        }
        Fault::Distrusted => {
            let Some((difference, replay)) = outcome.engine.difference(program) else {
                return Err(Failure::new(Code::EnginesDiffer, "the engines differ; the outputs are off"));
            };
            let path = arguments.replay.clone().unwrap_or_else(|| default_replay(&arguments.file));
            Err(difference::leave(&difference, replay, (&arguments.file, source), &path)?)
        }
        Fault::AlreadyStopped => Err(Failure::new(Code::Stopped, "the controller had stopped before")),
    }
}

/// Where a replay of this program is left.
fn default_replay(program: &Path) -> PathBuf {
    if program == Path::new("-") { PathBuf::from("stdin.replay.json") } else { program.with_extension("replay.json") }
}
