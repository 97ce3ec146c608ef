//! A scan allocates nothing, on any engine.
#![expect(unsafe_code, reason = "counting allocations takes an allocator of one's own")]

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use std::num::NonZeroU32;

use rung::engine::both::Both;
use rung::engine::interp::{Interpreter, Textbook};
use rung::engine::jit::Jit;
use rung::replay::Recorder;
use rung::source::Source;
use rung_runtime::host::{MonotonicClock, Panel, PanelIo, Statistics};
use rung_runtime::{Extent, Regions, Scan, ScanLoop, TickCounter};

/// Counts this thread's allocations.
struct Counting;

thread_local! {
    static COUNT: Cell<usize> = const { Cell::new(0) };
}

fn count() {
    // A thread that ends may allocate after its storage is gone; nobody counts there.
    let _ = COUNT.try_with(|count| count.set(count.get() + 1));
}

// SAFETY: every call is passed on to the system's allocator unchanged.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        count();
        // SAFETY: the caller's promise is passed on.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        // SAFETY: the caller's promise is passed on.
        unsafe { System.dealloc(pointer, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// Allocations that a closure makes.
fn allocations(run: impl FnOnce()) -> usize {
    let before = COUNT.get();
    run();
    COUNT.get() - before
}

#[test]
fn the_counter_counts() {
    // Nobody looks at what a box holds that is thrown away: without the black box there would be none.
    assert_eq!(allocations(|| drop(std::hint::black_box(Box::new(7)))), 1);
}

#[test]
fn a_scan_allocates_nothing() {
    let source = Source::new("interlocking18.rung", include_str!("../examples/interlocking18.rung"));
    let parsed = rung::frontend::parse(&source);
    let checked = rung::check::check(&parsed.program).0.expect("a sound example");
    let program = rung::opt::optimise(rung::lower::lower(&checked, &source, None).expect("a small image"));
    let engines: [Box<dyn Scan>; 3] = [
        Box::new(Interpreter::new(&program)),
        Box::new(Textbook::new(&program)),
        Box::new(Jit::compile(&program).expect("code for this machine")),
    ];
    for mut engine in engines {
        let mut image = program.layout.initial_image();
        let made = allocations(|| {
            for scan in 0..100 {
                engine.scan(&mut image, scan * 1_000_000);
            }
        });
        assert_eq!(made, 0);
    }
}

#[test]
fn a_cycle_and_its_measurement_allocate_nothing() {
    let source = Source::new("start_stop.rung", include_str!("../examples/start_stop.rung"));
    let checked = rung::check::check(&rung::frontend::parse(&source).program).0.expect("a sound example");
    let program = rung::lower::lower(&checked, &source, None).expect("a small image");
    let layout = &program.layout;
    let extent = |run: &rung::logic::image::Extent| Extent { bytes: run.bytes.clone(), bools: run.bools.clone() };
    let inputs: Vec<Extent> = layout.inputs().iter().map(extent).collect();
    let regions = Regions::new(&inputs, layout.outputs(), layout.retained(), layout.size()).expect("sound regions");
    let mut image = layout.initial_image();
    let field = PanelIo::new(Panel::new(&regions, &image));
    let both = Both::new(Interpreter::new(&program), Interpreter::new(&program), layout);
    let scan = Recorder::new(both, layout);
    let counter = TickCounter::new(NonZeroU32::MIN);
    let mut scan_loop = ScanLoop::new(scan, field, &counter, MonotonicClock, u64::MAX, regions, &mut image);
    let statistics = Statistics::default();
    let made = allocations(|| {
        // More scans than the recorder keeps.
        for _ in 0..10_000 {
            let cycle = scan_loop.cycle().expect("nothing is wrong");
            statistics.scan.record(cycle.took);
            counter.tick();
        }
    });
    assert_eq!(made, 0);
}
