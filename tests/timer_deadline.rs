//! A timer on a manual tick: when it fires, to the tick, whatever the cycle.

use std::num::NonZeroU32;

use rung::engine::interp::Interpreter;
use rung::engine::jit::Jit;
use rung::logic::Program;
use rung::source::Source;
use rung_runtime::host::{Panel, PanelIo};
use rung_runtime::{Clock, Extent, Regions, Scan, ScanLoop, TickCounter};

const MILLISECOND: NonZeroU32 = NonZeroU32::new(1_000_000).expect("not zero");

/// No time passes in a scan.
struct StandingClock;

impl Clock for StandingClock {
    fn nanoseconds(&self) -> u64 {
        0
    }
}

fn program() -> Program {
    let source = Source::new("p", "program p\ninput go\noutput q\nrung r1\n  go t:TON(PT := T#100ms) (q)\n");
    let (checked, problems) = rung::check::check(&rung::frontend::parse(&source).program);
    let checked = checked.unwrap_or_else(|| panic!("{problems:?}"));
    rung::opt::optimise(rung::lower::lower(&checked, &source, None).expect("a small image"))
}

/// The time from the scan that first sees the input to the one that sets the output, in ms, and when that was.
fn fires_after(program: &Program, engine: impl Scan, counter: &TickCounter, cycle: u32) -> (i64, i64) {
    let layout = &program.layout;
    let inputs: Vec<Extent> =
        layout.inputs().iter().map(|run| Extent { bytes: run.bytes.clone(), bools: run.bools.clone() }).collect();
    let regions = Regions::new(&inputs, layout.outputs(), layout.retained(), layout.size()).expect("sound regions");
    let mut image = layout.initial_image();
    let panel = Panel::new(&regions, &image);
    let slot = |name: &str| {
        let observed = layout.observed().iter().find(|observed| observed.name == name).expect("a variable");
        layout.slot(observed.slot).offset
    };
    let field = PanelIo::new(panel.clone());
    let mut scan_loop = ScanLoop::new(engine, field, counter, StandingClock, 1, regions, &mut image);
    let mut start = None;
    loop {
        let now = scan_loop.cycle().expect("nothing is wrong").now / 1_000_000;
        let mut out = [0];
        panel.output(slot("q"), &mut out);
        match start {
            // For a while the input is off.
            None if now >= 50 => {
                panel.set(slot("go"), &[1]);
                start = Some(now + i64::from(cycle));
            }
            Some(start) if out[0] == 1 => return (now - start, now),
            _ => assert_eq!(out[0], 0),
        }
        counter.advance(cycle);
    }
}

#[test]
fn a_timer_fires_with_the_first_scan_at_or_after_its_preset() {
    let program = program();
    for cycle in [1, 2, 7, 10, 30, 99, 100, 101, 250] {
        let late = fires_after(&program, Interpreter::new(&program), &TickCounter::new(MILLISECOND), cycle).0 - 100;
        assert!((0..i64::from(cycle)).contains(&late), "cycle {cycle} ms: {late} ms late");
        let jit = Jit::compile(&program).expect("compiled");
        let compiled = fires_after(&program, jit, &TickCounter::new(MILLISECOND), cycle);
        assert_eq!(compiled.0 - 100, late);
    }
    let exact = fires_after(&program, Interpreter::new(&program), &TickCounter::new(MILLISECOND), 1);
    assert_eq!(exact, (100, 151), "at a cycle of one tick, to the tick");
}

#[test]
fn a_timer_runs_over_the_end_of_the_tick_counter() {
    let program = program();
    let counter = TickCounter::starting_at(MILLISECOND, u32::MAX - 100);
    assert_eq!(fires_after(&program, Interpreter::new(&program), &counter, 1), (100, 151));
}
