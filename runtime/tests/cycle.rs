//! The scan cycle, on a field, a clock and a scan that the test makes.

use std::cell::{Cell, RefCell};
use std::num::NonZeroU32;
use std::ops::Range;
use std::slice;

use rung_runtime::{
    BadRegions, Clock, Cycle, Extent, Fault, FieldIo, Inputs, Outputs, Regions, Scan, ScanLoop, Stopped, TickCounter,
};

const WATCHDOG: u64 = 1_000;

/// Everything that happens, in order, and what is to go wrong.
#[derive(Default)]
struct Bench {
    events: RefCell<Vec<String>>,
    nanoseconds: Cell<u64>,
    input: Cell<u8>,
    fails: Cell<&'static str>,
    scan_takes: Cell<u64>,
    output_takes: Cell<u64>,
    distrusted: Cell<bool>,
}

impl Bench {
    fn note(&self, event: impl Into<String>) {
        self.events.borrow_mut().push(event.into());
    }

    fn events(&self) -> Vec<String> {
        self.events.take()
    }

    fn outcome(&self, step: &'static str) -> Result<(), &'static str> {
        if self.fails.get().contains(step) { Err(step) } else { Ok(()) }
    }
}

struct Field<'b>(&'b Bench);

impl FieldIo for Field<'_> {
    type Error = &'static str;

    fn copy_in(&mut self, mut inputs: Inputs<'_>) -> Result<(), &'static str> {
        self.0.note("in");
        for (_, bytes) in inputs.runs() {
            bytes.fill(self.0.input.get());
        }
        self.0.outcome("in")
    }

    fn copy_out(&mut self, outputs: Outputs<'_>) -> Result<(), &'static str> {
        self.0.note(format!("out {:?}", outputs.runs().collect::<Vec<_>>()));
        self.0.nanoseconds.set(self.0.nanoseconds.get() + self.0.output_takes.get());
        self.0.outcome("out")
    }

    fn outputs_off(&mut self) -> Result<(), &'static str> {
        self.0.note("off");
        self.0.outcome("off")
    }
}

/// The sum of all inputs to the output at byte 4, during which two ticks pass.
struct Sum<'b>(&'b Bench, &'b TickCounter);

impl Scan for Sum<'_> {
    fn scan(&mut self, image: &mut [u8], now: i64) {
        self.1.advance(2);
        self.0.note(format!("scan {now} {:?}", &image[..4]));
        self.0.nanoseconds.set(self.0.nanoseconds.get() + self.0.scan_takes.get());
        image[4] = image[..4].iter().fold(0, |sum, byte| sum.wrapping_add(*byte));
        image[5] = 0xEE;
    }

    fn trusted(&self) -> bool {
        !self.0.distrusted.get()
    }
}

struct FakeClock<'b>(&'b Bench);

impl Clock for FakeClock<'_> {
    fn nanoseconds(&self) -> u64 {
        self.0.nanoseconds.get()
    }
}

fn inputs() -> Vec<Extent> {
    vec![Extent { bytes: 0..2, bools: 0..1 }, Extent { bytes: 3..4, bools: 3..4 }]
}

const OUTPUTS: Range<u32> = 4..5;

/// Runs `test` with a scan loop over an image of 8 bytes; byte 2 is no input, byte 5 no output.
fn with_scan_loop(
    test: impl FnOnce(&Bench, &TickCounter, &mut ScanLoop<'_, Sum<'_>, Field<'_>, &TickCounter, FakeClock<'_>>),
) -> Vec<String> {
    let (bench, counter) = (Bench::default(), TickCounter::new(NonZeroU32::new(1_000).expect("not zero")));
    let (inputs, mut image) = (inputs(), [9; 8]);
    let regions = Regions::new(&inputs, slice::from_ref(&OUTPUTS), &[], 8).expect("sound regions");
    let (scan, clock) = (Sum(&bench, &counter), FakeClock(&bench));
    let mut scan_loop = ScanLoop::new(scan, Field(&bench), &counter, clock, WATCHDOG, regions, &mut image);
    test(&bench, &counter, &mut scan_loop);
    drop(scan_loop);
    bench.events()
}

#[test]
fn inputs_come_before_the_scan_and_outputs_after_it_and_time_stands_still_within() {
    let events = with_scan_loop(|bench, counter, scan_loop| {
        bench.input.set(2);
        bench.scan_takes.set(30);
        bench.output_takes.set(4);
        assert_eq!(scan_loop.cycle(), Ok(Cycle { now: 0, took: 34 }));
        counter.tick();
        bench.input.set(0);
        assert_eq!(scan_loop.cycle(), Ok(Cycle { now: 3_000, took: 34 }));
        assert_eq!(scan_loop.stop(), Ok(()));
    });
    // BOOLs are 1 where the field said 2; the INT-like byte and what is no input are left as they are.
    let expected =
        ["in", "scan 0 [1, 2, 9, 1]", "out [(4, [13])]", "in", "scan 3000 [0, 0, 9, 0]", "out [(4, [9])]", "off"];
    assert_eq!(events, expected);
}

#[test]
fn a_field_that_fails_puts_the_outputs_off_and_nothing_runs_after() {
    for (fails, fault, steps) in [
        ("in", Fault::Input("in"), vec!["in", "off"]),
        ("out", Fault::Output("out"), vec!["in", "scan 0 [0, 0, 9, 0]", "out [(4, [9])]", "off"]),
    ] {
        let events = with_scan_loop(|bench, _, scan_loop| {
            bench.fails.set(fails);
            assert_eq!(scan_loop.cycle(), Err(Stopped { fault, outputs_off: Ok(()) }));
            bench.fails.set("");
            assert_eq!(scan_loop.cycle(), Err(Stopped { fault: Fault::AlreadyStopped, outputs_off: Ok(()) }));
        });
        assert_eq!(events, steps);
    }
}

#[test]
fn outputs_that_cannot_be_put_off_are_told() {
    with_scan_loop(|bench, _, scan_loop| {
        bench.fails.set("out, off");
        let stopped = Stopped { fault: Fault::Output("out"), outputs_off: Err("off") };
        assert_eq!(scan_loop.cycle(), Err(stopped));
    });
}

#[test]
fn a_scan_past_the_watchdog_never_reaches_the_field() {
    let events = with_scan_loop(|bench, _, scan_loop| {
        bench.scan_takes.set(WATCHDOG);
        assert_eq!(scan_loop.cycle(), Ok(Cycle { now: 0, took: WATCHDOG }));
        bench.scan_takes.set(WATCHDOG + 1);
        let fault = Fault::Watchdog { took: WATCHDOG + 1, limit: WATCHDOG };
        assert_eq!(scan_loop.cycle(), Err(Stopped { fault, outputs_off: Ok(()) }));
    });
    assert_eq!(events[3..], ["in", "scan 2000 [0, 0, 9, 0]", "off"]);
}

#[test]
fn a_copy_out_past_the_watchdog_puts_the_outputs_off() {
    let events = with_scan_loop(|bench, _, scan_loop| {
        bench.output_takes.set(WATCHDOG + 5);
        let fault = Fault::Watchdog { took: WATCHDOG + 5, limit: WATCHDOG };
        assert_eq!(scan_loop.cycle(), Err(Stopped { fault, outputs_off: Ok(()) }));
    });
    assert_eq!(events.last().map(String::as_str), Some("off"));
}

#[test]
fn a_scan_that_distrusts_itself_never_reaches_the_field() {
    let events = with_scan_loop(|bench, _, scan_loop| {
        bench.distrusted.set(true);
        assert_eq!(scan_loop.cycle(), Err(Stopped { fault: Fault::Distrusted, outputs_off: Ok(()) }));
    });
    assert_eq!(events, ["in", "scan 0 [0, 0, 9, 0]", "off"]);
}

#[test]
fn a_scan_loop_that_is_dropped_puts_the_outputs_off() {
    assert_eq!(with_scan_loop(|_, _, _| ()), ["off"]);
}

#[test]
fn regions_that_overlap_or_reach_outside_are_refused() {
    let extent = |bytes: Range<u32>, bools: Range<u32>| Extent { bytes, bools };
    let refused = |inputs: &[Extent], outputs: &[Range<u32>]| Regions::new(inputs, outputs, &[], 8) == Err(BadRegions);
    assert!(!refused(&[extent(0..2, 0..2), extent(2..8, 4..4)], &[2..3, 3..8]));
    assert!(refused(&[extent(0..2, 0..3)], &[]));
    assert!(refused(&[extent(1..2, 0..1)], &[]));
    assert!(refused(&[extent(0..2, 0..0), extent(1..3, 1..1)], &[]));
    assert!(refused(&[extent(0..9, 0..0)], &[]));
    assert!(refused(&[], &[2..3, 0..1]));
    #[expect(clippy::reversed_empty_ranges, reason = "that is the point")]
    let reversed = 3..2;
    assert!(refused(&[], &[reversed]));
}
