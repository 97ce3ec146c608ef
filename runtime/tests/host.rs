//! The driver in virtual time, and the panel. Needs the feature `host`.
#![cfg(feature = "host")]

use std::cell::Cell;
use std::num::NonZeroU32;
use std::slice;
use std::sync::atomic::{AtomicBool, Ordering};

use rung_runtime::host::{Driver, End, Heartbeat, Pace, Panel, PanelIo, Quantiles, Statistics};
use rung_runtime::{Clock, Extent, Fault, FieldIo, Regions, Scan, ScanLoop, Stopped, TickCounter, TickSource};

const PERIOD: NonZeroU32 = NonZeroU32::new(1_000_000).expect("not zero");

/// A machine in virtual time: waiting takes until the awaited tick and a little more, scans take what they are told.
struct Machine {
    counter: TickCounter,
    nanoseconds: Cell<u64>,
    late: Cell<u64>,
}

impl Machine {
    fn new() -> Self {
        Self { counter: TickCounter::new(PERIOD), nanoseconds: Cell::new(0), late: Cell::new(0) }
    }

    fn pass(&self, nanoseconds: u64) {
        let (before, after) = (self.nanoseconds.get(), self.nanoseconds.get() + nanoseconds);
        self.nanoseconds.set(after);
        let ticks = after / 1_000_000 - before / 1_000_000;
        self.counter.advance(u32::try_from(ticks).expect("few"));
    }
}

#[derive(Clone, Copy)]
struct Of<'m>(&'m Machine);

impl Clock for Of<'_> {
    fn nanoseconds(&self) -> u64 {
        self.0.nanoseconds.get()
    }
}

impl TickSource for Of<'_> {
    fn period(&self) -> NonZeroU32 {
        PERIOD
    }

    fn ticks(&self) -> u32 {
        self.0.counter.ticks()
    }
}

impl Pace for Of<'_> {
    fn wait(&self, tick: u32) {
        let until = self.moment(tick) + self.0.late.get();
        self.0.pass(until.saturating_sub(self.nanoseconds()));
    }

    fn moment(&self, tick: u32) -> u64 {
        u64::from(tick) * 1_000_000
    }
}

/// Takes its time, which is different in one of its scans, and notes what `now` it saw.
struct Slow<'m> {
    machine: &'m Machine,
    usual: u64,
    once: (i64, u64),
}

impl Scan for Slow<'_> {
    fn scan(&mut self, image: &mut [u8], now: i64) {
        self.machine.pass(if now == self.once.0 { self.once.1 } else { self.usual });
        image[1] = image[0];
    }
}

struct Outcome<E> {
    end: End<E>,
    times: Vec<i64>,
    statistics: Statistics,
    off: bool,
}

/// 10 ms cycles for 100 ms, with a watchdog of 50 ms.
fn run(machine: &Machine, usual: u64, once: (i64, u64)) -> Outcome<<PanelIo as FieldIo>::Error> {
    let inputs = [Extent { bytes: 0..1, bools: 0..1 }];
    let regions = Regions::new(&inputs, slice::from_ref(&(1..2)), &[], 8).expect("sound regions");
    let mut image = [0; 8];
    let panel = Panel::new(&regions, &image);
    let (statistics, heartbeat, stop) = (Statistics::default(), Heartbeat::default(), AtomicBool::new(false));
    let scan = Slow { machine, usual, once };
    let field = PanelIo::new(panel.clone());
    let mut scan_loop = ScanLoop::new(scan, field, Of(machine), Of(machine), 50_000_000, regions, &mut image);
    let driver = Driver {
        cycle: NonZeroU32::new(10).expect("not zero"),
        ends_at: Some(100),
        watchdog: 50_000_000,
        heartbeat: &heartbeat,
        statistics: &statistics,
        stop: &stop,
    };
    let mut times = Vec::new();
    let end = driver.run(&mut scan_loop, |_, cycle| times.push(cycle.now / 1_000_000));
    Outcome { end, times, statistics, off: panel.is_off() }
}

#[test]
fn cycles_run_on_schedule_and_end_on_time_with_outputs_off() {
    let machine = Machine::new();
    machine.late.set(70_000);
    let outcome = run(&machine, 1_000, (-1, 0));
    assert_eq!(outcome.end, End::Asked(Ok(())));
    assert_eq!(outcome.times, [0, 10, 20, 30, 40, 50, 60, 70, 80, 90]);
    assert!(outcome.off);
    let statistics = outcome.statistics;
    assert_eq!((statistics.cycles(), statistics.overruns(), statistics.skipped()), (10, 0, 0));
    assert_eq!(statistics.scan.quantiles(), Quantiles { p50: 1_000, p99: 1_000, max: 1_000 });
    assert_eq!(statistics.lateness.quantiles().max, 70_000);
}

#[test]
fn a_long_scan_skips_cycles_and_those_after_are_on_schedule_again() {
    let outcome = run(&Machine::new(), 1_000, (20_000_000, 33_000_000));
    assert_eq!(outcome.times, [0, 10, 20, 53, 60, 70, 80, 90]);
    let statistics = outcome.statistics;
    // The long one, and the one at 53 which was due at 50 after 30 and 40 were skipped.
    assert_eq!((statistics.cycles(), statistics.overruns(), statistics.skipped()), (8, 2, 2));
    assert_eq!(statistics.lateness.quantiles().max, 3_001_000 - 1_000);
    assert_eq!(statistics.scan.quantiles().max, 33_000_000);
}

#[test]
fn a_scan_past_the_watchdog_ends_the_run_with_outputs_off() {
    let outcome = run(&Machine::new(), 1_000, (30_000_000, 50_000_001));
    let fault = Fault::Watchdog { took: 50_000_001, limit: 50_000_000 };
    assert_eq!(outcome.end, End::Stopped(Stopped { fault, outputs_off: Ok(()) }));
    assert_eq!(outcome.times, [0, 10, 20]);
    assert!(outcome.off);
}

#[test]
fn a_run_ends_on_time_also_between_cycles_and_when_it_is_asked_to() {
    let machine = Machine::new();
    let inputs: [Extent; 0] = [];
    let regions = Regions::new(&inputs, &[], &[], 8).expect("sound regions");
    let (statistics, heartbeat, stop) = (Statistics::default(), Heartbeat::default(), AtomicBool::new(false));
    let mut driver = Driver {
        cycle: NonZeroU32::new(40).expect("not zero"),
        ends_at: Some(50),
        watchdog: 50_000_000,
        heartbeat: &heartbeat,
        statistics: &statistics,
        stop: &stop,
    };
    for (ends_at, expected) in [(Some(50), vec![0, 40]), (Some(0), vec![]), (None, vec![0, 40, 80])] {
        driver.ends_at = ends_at;
        let mut image = [0; 8];
        let field = PanelIo::new(Panel::new(&regions, &image));
        let scan = Slow { machine: &machine, usual: 0, once: (-1, 0) };
        let mut scan_loop = ScanLoop::new(scan, field, Of(&machine), Of(&machine), 1_000, regions, &mut image);
        let mut times = Vec::new();
        let end = driver.run(&mut scan_loop, |_, cycle| {
            times.push(cycle.now / 1_000_000);
            stop.store(times.len() == 3, Ordering::Relaxed);
        });
        assert_eq!((end, times), (End::Asked(Ok(())), expected));
    }
    assert_eq!(machine.nanoseconds.get(), 130_000_000, "50 ms, nothing, and 80 ms");
}

#[test]
fn a_panel_carries_what_is_set_in_and_what_is_computed_out_until_it_is_off() {
    let machine = Machine::new();
    let inputs = [Extent { bytes: 0..1, bools: 0..1 }];
    let regions = Regions::new(&inputs, slice::from_ref(&(1..2)), &[], 8).expect("sound regions");
    let mut image = [1, 0, 0, 0, 0, 0, 0, 0];
    let panel = Panel::new(&regions, &image);
    let scan = Slow { machine: &machine, usual: 0, once: (-1, 0) };
    let field = PanelIo::new(panel.clone());
    let mut scan_loop = ScanLoop::new(scan, field, Of(&machine), Of(&machine), 1_000, regions, &mut image);
    let mut shown = [7];
    for byte in [None, Some(0), Some(1)] {
        if let Some(byte) = byte {
            assert!(panel.set(0, &[byte]));
        }
        scan_loop.cycle().expect("nothing is wrong");
        assert!(panel.output(1, &mut shown));
        assert_eq!(shown, [byte.unwrap_or(1)]);
    }
    // Once off, nothing that still comes out turns an output on again.
    panel.outputs_off();
    scan_loop.cycle().expect("nothing is wrong");
    assert!(panel.output(1, &mut shown));
    assert_eq!(shown, [0]);
    assert!(panel.input(0, &mut shown));
    assert_eq!(shown, [1]);
    // An output cannot be set, nor what is not there.
    assert!(!panel.set(1, &[1]) && !panel.set(0, &[1, 1]) && !panel.set(u32::MAX, &[1]));
    assert!(!panel.output(0, &mut shown));
}
