use super::*;
use crate::elementary::Elementary;
use crate::logic::LayoutBuilder;
use crate::logic::image::Area;
use rung_runtime::{Fault, Stopped};

/// An input, and an output that follows it; both one byte.
fn layout() -> Layout {
    let mut builder = LayoutBuilder::new();
    for (name, area) in [("start", Area::Input), ("motor", Area::Output)] {
        let (ty, initial) = (Elementary::Bool, Value::bool(false));
        let slot = builder.slot(Slot { name: name.into(), ty, offset: 0, area, retain: false, initial, line: 0 });
        builder.observe(name, slot);
    }
    builder.finish(None).expect("a small image")
}

fn point(layout: &Layout, index: usize) -> Point {
    let slot = layout.slots()[index].clone();
    Point { name: slot.name.to_string(), slot, key: None }
}

fn timing(ends_at: Option<u64>, watchdog: u64) -> Timing {
    let of = |number| NonZeroU32::new(number).expect("not zero");
    Timing { tick: of(1_000_000), cycle: of(1), ends_at, watchdog }
}

/// A scan that follows its input, with something that goes wrong in its fifth scan.
struct Follow<W> {
    scans: u32,
    wrong: W,
}

impl<W: FnMut() -> bool> Scan for Follow<W> {
    fn scan(&mut self, image: &mut [u8], _now: i64) {
        image[1] = image[0];
        self.scans += 1;
        if self.scans == 5 && !(self.wrong)() {
            self.scans = u32::MAX;
        }
    }

    fn trusted(&self) -> bool {
        self.scans != u32::MAX
    }
}

fn start<W: FnMut() -> bool + Send + 'static>(timing: Timing, wrong: W) -> Machine<Follow<W>> {
    let layout = layout();
    let (input, told) = (layout.slots()[0].clone(), [point(&layout, 1)]);
    let scan = Follow { scans: 0, wrong };
    Machine::start(scan, &layout, &[(input, Value::bool(true))], timing, &told, Arc::default()).expect("threads")
}

const LONG: u64 = 60_000_000_000;

#[test]
fn a_run_ends_by_itself_and_has_told_what_changed() {
    let machine = start(timing(Some(20), LONG), || true);
    let changes: Vec<_> = machine.changes.iter().map(|change| (change.index, change.value)).collect();
    assert_eq!(changes, [(0, Value::bool(true))]);
    let panel = Arc::clone(&machine.shared.panel);
    let outcome = machine.finish().expect("an end");
    assert_eq!(outcome.end, End::Asked(Ok(())));
    assert!(panel.is_off() && (1..=20).contains(&outcome.engine.scans));
}

#[test]
fn a_scan_that_distrusts_itself_ends_the_run_with_outputs_off() {
    let machine = start(timing(None, LONG), || false);
    let panel = Arc::clone(&machine.shared.panel);
    let outcome = machine.finish().expect("an end");
    assert_eq!(outcome.end, End::Stopped(Stopped { fault: Fault::Distrusted, outputs_off: Ok(()) }));
    assert!(panel.is_off());
}

#[test]
fn a_scan_that_hangs_is_noticed_and_the_outputs_are_off_though_it_never_answers() {
    let (release, held) = mpsc::channel::<()>();
    let machine = start(timing(None, 20_000_000), move || held.recv().is_err());
    let shared = Arc::clone(&machine.shared);
    assert_eq!(machine.finish().err(), Some(Lost::Hung));
    assert!(shared.tripped() && shared.panel.is_off());
    drop(release);
}

#[test]
fn a_scan_that_panics_leaves_the_outputs_off() {
    let machine = start(timing(None, LONG), || panic!("this panic is part of a test"));
    let panel = Arc::clone(&machine.shared.panel);
    assert_eq!(machine.finish().err(), Some(Lost::Panicked));
    assert!(panel.is_off());
}

#[test]
fn inputs_are_set_while_it_runs_and_the_image_is_shown() {
    let machine = start(timing(None, LONG), || true);
    let (layout, mut image) = (layout(), Vec::new());
    let [start, motor] = [&layout.slots()[0], &layout.slots()[1]];
    for on in [true, false, true] {
        set(&machine.shared.panel, start, Value::bool(on));
        assert_eq!(input(&machine.shared.panel, start), Value::bool(on));
        loop {
            machine.shared.image(&mut image);
            if motor.read(&image) == Value::bool(on) {
                break;
            }
            thread::yield_now();
        }
    }
    machine.shared.stop.store(true, Ordering::Relaxed);
    assert_eq!(machine.finish().map(|outcome| outcome.end).ok(), Some(End::Asked(Ok(()))));
}
