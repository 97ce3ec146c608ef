//! How late does a timer fire in real time? A TON of 100 ms is run at a cycle of 1 ms, again and again; from the
//! moment at which it is due to the moment at which its output is out, the time is measured.
//!
//! `cargo run --release --example lateness -- 20` takes 20 seconds.

use std::num::NonZeroU32;
use std::sync::atomic::AtomicBool;

use rung::engine::jit::Jit;
use rung::source::Source;
use rung_runtime::host::{
    Driver, Heartbeat, Histogram, MonotonicClock, Pace, Panel, PanelIo, Role, Statistics, TickThread, lock_memory,
    schedule_this_thread,
};
use rung_runtime::{Clock, Extent, Regions, ScanLoop};

/// In the scan after it fired, the timer is reset; in the one after that it starts again.
const PROGRAM: &str = "program lateness\noutput fired\nrung r1\n  /fired delay:TON(PT := T#100ms) (fired)\n";
const PRESET: u64 = 100_000_000;
const MILLISECOND: NonZeroU32 = NonZeroU32::new(1_000_000).expect("not zero");
const EVERY_TICK: NonZeroU32 = NonZeroU32::MIN;

#[expect(clippy::print_stdout, reason = "a command of its own")]
fn main() -> Result<(), Box<dyn std::error::Error>> {
    let seconds: u64 = std::env::args().nth(1).map_or(Ok(10), |text| text.parse())?;
    let source = Source::new("lateness", PROGRAM);
    let (checked, _) = rung::check::check(&rung::frontend::parse(&source).program);
    let checked = checked.ok_or("the program has an error")?;
    let program = rung::lower::lower(&checked, &source, None).map_err(|_| "the image is too large")?;
    let program = rung::opt::optimise(program);
    let layout = &program.layout;
    let fired = layout.observed().iter().find(|observed| observed.name == "fired").ok_or("no output")?;
    let fired = layout.slot(fired.slot);

    let inputs: Vec<Extent> =
        layout.inputs().iter().map(|run| Extent { bytes: run.bytes.clone(), bools: run.bools.clone() }).collect();
    let regions = Regions::new(&inputs, layout.outputs(), layout.retained(), layout.size()).map_err(|_| "regions")?;
    let mut image = layout.initial_image();
    let field = PanelIo::new(Panel::new(&regions, &image));
    let (engine, clock) = (Jit::compile(&program)?, MonotonicClock);
    let (statistics, heartbeat, stop) = (Statistics::default(), Heartbeat::default(), AtomicBool::new(false));
    let lateness = Histogram::default();

    let ticks = TickThread::start(MILLISECOND)?;
    println!("tick thread {}, scan thread {}", ticks.scheduling(), schedule_this_thread(Role::Scan));
    println!("locked memory {}", lock_memory());
    let watchdog = u64::MAX;
    let mut scan_loop = ScanLoop::new(engine, field, &ticks, clock, watchdog, regions, &mut image);
    // The scan loop's time 0, which may be some ticks after the thread's.
    let raw = scan_loop.ticks().raw(0);
    let origin = ticks.moment(raw);
    let driver = Driver {
        cycle: EVERY_TICK,
        ends_at: Some(seconds * 1000),
        watchdog,
        heartbeat: &heartbeat,
        statistics: &statistics,
        stop: &stop,
    };
    let (mut before, mut started) = (false, Some(0));
    let end = driver.run(&mut scan_loop, |image, cycle| {
        let out = clock.nanoseconds();
        let now = cycle.now.unsigned_abs();
        let fires = fired.read(image).is_true();
        if fires && let Some(start) = started.take() {
            lateness.record(out.saturating_sub(origin + start + PRESET));
        } else if !fires && !before {
            started.get_or_insert(now);
        }
        before = fires;
    });
    println!("{end:?} after {} cycles, {} skipped", statistics.cycles(), statistics.skipped());
    let line = |name: &str, histogram: &Histogram| {
        let quantiles = histogram.quantiles();
        let [p50, p99, max] = [quantiles.p50, quantiles.p99, quantiles.max].map(|time| time / 1000);
        println!("{name:<28} {p50:>8} {p99:>8} {max:>8}");
    };
    println!("{:<28} {:>8} {:>8} {:>8}", "microseconds", "p50", "p99", "max");
    line("a 100 ms TON fires late by", &lateness);
    line("a cycle begins late by", &statistics.lateness);
    line("a cycle takes", &statistics.scan);
    Ok(())
}
