//! `rung::Controller`: what a host program does with a ladder program, and what it is told where it cannot.

use std::num::NonZeroU32;
use std::time::Duration;

use proptest::prelude::*;
use rung::elementary::{Elementary, Value};
use rung::logic::Area;
use rung::simulate::{Schedule, Simulation, Stimuli};
use rung::source::Source;
use rung::{Controller, Engine, Error, Retained, Settings};
use rung_runtime::host::{MonotonicClock, Panel, PanelIo};
use rung_runtime::{Regions, TickCounter};

/// One of everything that has a type of its own.
const PROGRAM: &str = "program mixed
input  switch
input  level   : INT
input  ratio   : REAL
input  wait    : TIME
output lamp
output Speed   : DINT
output share   : LREAL
var    hours   : UDINT retain
var    latched : BOOL retain
var    mask    : WORD := 16#F0F0
var    store   : array [1..3] of INT

rung r10
  switch delay:TON(PT := wait) (lamp)

rung r20
  {Speed := INT_TO_DINT(level) * 2}

rung r30
  {share := REAL_TO_LREAL(ratio) / 3.0}

rung r40
  ^lamp {hours := hours + 1} (S latched)

rung r50
  {store[level] := 7}
";

const ENGINES: [Engine; 2] = [Engine::Jit, Engine::Interpreter];

fn load(text: &str, engine: Engine) -> Controller {
    let settings = Settings { engine, ..Settings::default() };
    Controller::load_with("mixed.rung", text.as_bytes(), settings).expect("a sound program")
}

fn milliseconds(count: u64) -> Duration {
    Duration::from_millis(count)
}

#[test]
fn a_program_is_driven_by_name_on_either_engine() -> Result<(), Error> {
    for engine in ENGINES {
        let mut controller = load(PROGRAM, engine);
        assert_eq!(controller.name(), "mixed");
        controller.write("switch", true)?;
        controller.write("level", 2)?;
        controller.write("ratio", 1.5f32)?;
        controller.write("wait", milliseconds(20))?;
        controller.scan(milliseconds(0));
        controller.scan(milliseconds(10));
        assert!(!controller.read::<bool>("lamp")?);
        controller.scan(milliseconds(20));
        assert!(controller.read::<bool>("lamp")?);
        assert_eq!(controller.read::<i32>("Speed")?, 4);
        assert_eq!(controller.read::<f64>("share")?, 0.5);
        assert_eq!(controller.read::<Duration>("delay.ET")?, milliseconds(20));
        assert_eq!(controller.read::<u64>("hours")?, 1);
        assert_eq!(controller.read::<u16>("mask")?, 0xF0F0);
        assert_eq!(controller.read::<i8>("store[2]")?, 7);
        assert_eq!(controller.read::<Value>("level")?, Value::integer(Elementary::Int, 2).expect("in range"));
        assert_eq!(controller.now(), milliseconds(20));
        assert!(!controller.is_faulty());
        controller.write("level", 4)?;
        controller.scan(milliseconds(30));
        assert!(controller.is_faulty());
    }
    Ok(())
}

#[test]
fn names_are_found_in_any_case_and_told_as_the_program_spells_them() {
    let controller = load(PROGRAM, Engine::Interpreter);
    for name in ["Speed", "speed", "SPEED"] {
        assert_eq!(controller.variable(name).map(|variable| variable.name()).ok(), Some("Speed"));
    }
    assert_eq!(controller.variable("DELAY.et").map(|variable| variable.name()).ok(), Some("delay.ET"));
}

#[test]
fn variables_are_listed_in_order_with_what_they_are() {
    let controller = load(PROGRAM, Engine::Interpreter);
    let listed: Vec<_> =
        controller.variables().map(|of| (of.name(), of.ty(), of.area(), of.is_retained(), of.line())).collect();
    let expected = [
        ("switch", Elementary::Bool, Area::Input, false, 2),
        ("level", Elementary::Int, Area::Input, false, 3),
        ("ratio", Elementary::Real, Area::Input, false, 4),
        ("wait", Elementary::Time, Area::Input, false, 5),
        ("lamp", Elementary::Bool, Area::Output, false, 6),
        ("Speed", Elementary::Dint, Area::Output, false, 7),
        ("share", Elementary::Lreal, Area::Output, false, 8),
        ("hours", Elementary::Udint, Area::Memory, true, 9),
        ("latched", Elementary::Bool, Area::Memory, true, 10),
        ("mask", Elementary::Word, Area::Memory, false, 11),
        ("store[1]", Elementary::Int, Area::Memory, false, 12),
        ("store[2]", Elementary::Int, Area::Memory, false, 12),
        ("store[3]", Elementary::Int, Area::Memory, false, 12),
    ];
    assert_eq!(listed[..expected.len()], expected);
    assert!(listed[expected.len()..].iter().any(|(name, ..)| *name == "delay.Q"), "{listed:?}");
    let mask = controller.variable("mask").expect("it is declared");
    assert_eq!((mask.initial().bits(), mask.initial().ty()), (0xF0F0, Elementary::Word));
}

#[test]
fn what_a_variable_does_not_take_or_give_is_a_typed_error_and_changes_nothing() {
    let mut controller = load(PROGRAM, Engine::Interpreter);
    let before = controller.image().to_vec();
    let message = |result: Result<(), Error>| result.map_err(|error| error.to_string()).unwrap_err();

    assert!(matches!(controller.write("level", 40_000), Err(Error::NotTaken { ty: Elementary::Int, .. })));
    assert_eq!(message(controller.write("LEVEL", 40_000)), "`level` is of type INT and cannot be set to 40000");
    assert_eq!(message(controller.write("switch", 1)), "`switch` is of type BOOL and cannot be set to 1");
    assert_eq!(message(controller.write("ratio", 1e300)), "`ratio` is of type REAL and cannot be set to 1e300");
    assert!(matches!(controller.write("wait", Duration::MAX), Err(Error::NotTaken { .. })));
    assert!(matches!(controller.write("level", Value::bool(true)), Err(Error::NotTaken { .. })));

    assert!(matches!(controller.read::<bool>("level"), Err(Error::NotGiven { .. })));
    assert_eq!(message(controller.read::<i8>("mask").map(|_| ())), "`mask`: WORD#61680 cannot be had as i8");

    assert_eq!(message(controller.write("levle", 1)), "the program has no variable `levle`; is it `level`?");
    assert_eq!(message(controller.read::<bool>("").map(|_| ())), "the program has no variable ``");
    assert!(matches!(controller.variable("delay"), Err(Error::NoVariable { nearest: None, .. })));
    assert_eq!(controller.image(), before);
}

#[test]
fn a_program_with_errors_is_refused_with_its_findings() {
    let text = "program p\ninput a\noutput b\nrung r10\n  a /c (b)\n";
    let Err(Error::Program(findings)) = Controller::load("p.rung", text.as_bytes()) else { panic!("it was loaded") };
    assert_eq!(findings.diagnostics.len(), 1);
    let shown = findings.to_string();
    for part in ["R0301", "p.rung:5:6", "a /c (b)"] {
        assert!(shown.contains(part), "{shown} lacks {part}");
    }
    let Err(Error::Program(findings)) = Controller::load("p.rung", b"\xFF\xFEx") else { panic!("it was loaded") };
    assert!(findings.to_string().contains("R0101"), "{findings}");
}

#[test]
fn an_image_that_is_too_large_is_refused() {
    let text = "program p\nvar a : array [0..9999999] of array [0..99] of LREAL\nrung r10\n  {a[0][0] := 1.0}\n";
    let Err(Error::Program(findings)) = Controller::load("p.rung", text.as_bytes()) else { panic!("it was loaded") };
    assert!(rung::diagnostic::any_error(&findings.diagnostics), "{findings}");
}

#[test]
fn warnings_are_kept() {
    let controller = load("program p\ninput a, unused\noutput b\nrung r10\n  a (b)\n", Engine::Interpreter);
    assert!(controller.warnings().to_string().contains("R0303"), "{}", controller.warnings());
}

#[test]
fn every_format_is_read_by_its_content() -> Result<(), Error> {
    let text = "PROGRAM p\nVAR_INPUT a : BOOL; END_VAR\nVAR_OUTPUT b : BOOL; END_VAR\nb := NOT a;\nEND_PROGRAM\n";
    let mut controller = load(text, Engine::Interpreter);
    controller.scan(Duration::ZERO);
    assert!(controller.read::<bool>("b")?);
    Ok(())
}

#[test]
fn time_never_goes_back_and_never_overflows() -> Result<(), Error> {
    let mut controller = load(PROGRAM, Engine::Jit);
    controller.write("switch", true)?;
    controller.write("wait", milliseconds(20))?;
    controller.scan(milliseconds(100));
    controller.scan(milliseconds(10));
    assert_eq!(controller.now(), milliseconds(100));
    assert_eq!(controller.read::<Duration>("delay.ET")?, Duration::ZERO);
    controller.scan(Duration::MAX);
    assert_eq!(controller.now(), Duration::from_nanos(i64::MAX.unsigned_abs()));
    assert!(controller.read::<bool>("lamp")?);
    Ok(())
}

#[test]
fn retained_variables_come_back_and_nothing_else_does() -> Result<(), Error> {
    let mut controller = load(PROGRAM, Engine::Jit);
    controller.write("hours", 12)?;
    controller.write("latched", true)?;
    controller.write("mask", 1)?;
    let kept = controller.retained();
    assert_eq!(kept.bytes.len(), 4 + 4, "a BOOL, three bytes of padding, a UDINT");

    let mut next = load(PROGRAM, Engine::Interpreter);
    next.restore(&Retained::from_bytes(&kept.to_bytes()).expect("more than a hash"))?;
    assert_eq!(next.read::<u32>("hours")?, 12);
    assert!(next.read::<bool>("latched")?);
    assert_eq!(next.read::<u16>("mask")?, 0xF0F0);

    controller.scan(milliseconds(500));
    controller.restart();
    assert_eq!((controller.now(), controller.image()), (Duration::ZERO, next.image()));
    Ok(())
}

#[test]
fn a_retained_bool_that_is_neither_0_nor_1_becomes_1() -> Result<(), Error> {
    let mut controller = load(PROGRAM, Engine::Jit);
    let mut kept = controller.retained();
    kept.bytes.fill(0xFF);
    controller.restore(&kept)?;
    let offset = controller.variable("latched")?.offset() as usize;
    assert_eq!(controller.image()[offset], 1);
    assert_eq!(controller.read::<u32>("hours")?, u32::MAX);
    Ok(())
}

#[test]
fn retained_bytes_of_another_program_are_refused() {
    let mut controller = load(PROGRAM, Engine::Interpreter);
    let before = controller.image().to_vec();
    let edited = load(&PROGRAM.replace("hours", "days"), Engine::Interpreter);
    assert!(matches!(controller.restore(&edited.retained()), Err(Error::OtherLayout { .. })));
    let mut kept = controller.retained();
    kept.bytes.pop();
    assert!(matches!(controller.restore(&kept), Err(Error::RetainedSize { expected: 8, found: 7 })));
    kept.bytes.clear();
    assert!(matches!(controller.restore(&kept), Err(Error::RetainedSize { expected: 8, found: 0 })));
    assert_eq!(controller.image(), before);
    assert_eq!(Retained::from_bytes(&[0; 7]), None);
}

#[test]
fn an_edited_program_takes_over_in_the_middle_of_a_timer() -> Result<(), Error> {
    for engine in ENGINES {
        let mut controller = load(PROGRAM, engine);
        controller.write("switch", true)?;
        controller.write("wait", milliseconds(30))?;
        controller.write("hours", 5)?;
        controller.scan(milliseconds(0));
        controller.scan(milliseconds(20));
        let edited =
            PROGRAM.replace("output lamp", "output spare : INT := 9\noutput lamp").replace("hours + 1", "hours + 10");
        let edited = edited.replace("WORD := 16#F0F0", "DWORD := 3");
        controller.swap("edited.rung", edited.as_bytes())?;
        assert_eq!(controller.read::<i16>("spare")?, 9);
        assert_eq!(controller.read::<u32>("mask")?, 3, "it is of another type now");
        assert_eq!(controller.now(), milliseconds(20));
        controller.scan(milliseconds(30));
        assert!(controller.read::<bool>("lamp")?, "the timer went on");
        assert_eq!(controller.read::<u32>("hours")?, 15);
        // As if it had been loaded: what is retained now comes back to the edited program.
        load(&edited, engine).restore(&controller.retained())?;
    }
    Ok(())
}

#[test]
fn an_edited_program_with_errors_leaves_the_one_that_runs() -> Result<(), Error> {
    let mut controller = load(PROGRAM, Engine::Jit);
    controller.write("level", 21)?;
    let refused =
        controller.swap("edited.rung", PROGRAM.replace("level", "lever").replacen("lever", "level", 1).as_bytes());
    assert!(matches!(refused, Err(Error::Program(_))));
    controller.scan(Duration::ZERO);
    assert_eq!(controller.read::<i32>("Speed")?, 42);
    Ok(())
}

#[test]
fn a_scan_loop_over_a_controller_runs_it_on_a_field() -> Result<(), Error> {
    let mut controller = load("program p\ninput a\noutput b\nrung r10\n  a (b)\n", Engine::Jit);
    let layout = controller.layout();
    let inputs: Vec<_> = layout.inputs().iter().map(|run| (run.bytes.clone(), run.bools.clone())).collect();
    let inputs: Vec<_> = inputs.into_iter().map(|(bytes, bools)| rung_runtime::Extent { bytes, bools }).collect();
    let (outputs, size) = (layout.outputs().to_vec(), layout.size());
    let regions = Regions::new(&inputs, &outputs, &[], size).expect("sound regions");
    let panel = Panel::new(&regions, controller.image());
    let at = controller.variable("a")?.offset();
    assert!(panel.set(at, &[0xFF]));

    let ticks = TickCounter::new(NonZeroU32::new(1_000_000).expect("not zero"));
    let field = PanelIo::new(std::sync::Arc::clone(&panel));
    let mut scan_loop = controller.scan_loop(field, &ticks, MonotonicClock, Duration::from_secs(60));
    assert_eq!(scan_loop.cycle().map(|cycle| cycle.now).ok(), Some(0));
    ticks.advance(7);
    assert_eq!(scan_loop.cycle().map(|cycle| cycle.now).ok(), Some(7_000_000));
    drop(scan_loop);
    assert!(panel.is_off());
    assert!(controller.read::<bool>("a")?);
    assert!(controller.read::<bool>("b")?);
    Ok(())
}

#[test]
fn a_controller_can_be_handed_to_a_thread() {
    let mut controller = load(PROGRAM, Engine::Jit);
    let thread = std::thread::spawn(move || {
        controller.scan(Duration::ZERO);
        controller
    });
    assert!(thread.join().is_ok());
}

/// The stimuli of an example, set by name before each scan, leave the image that a simulation leaves.
#[test]
fn a_controller_computes_what_a_simulation_does() -> Result<(), Error> {
    let text = include_str!("../../examples/pump_station.rung");
    let table = Source::new("stimuli", include_str!("../../examples/pump_station.stimuli.csv"));
    for engine in ENGINES {
        let mut controller = load(text, engine);
        let source = Source::new("pump_station.rung", text);
        let checked = rung::check::check(&rung::frontend::parse(&source).program).0.expect("a sound example");
        let program = rung::opt::optimise(rung::lower::lower(&checked, &source, None).expect("a small image"));
        let stimuli = Stimuli::parse(&table, &program.layout).expect("sound stimuli");
        let schedule = Schedule::covering(10_000_000, &stimuli).expect("a cycle");
        let mut simulation = Simulation::new(&program.layout, &stimuli, schedule);
        let mut interpreter = rung::engine::interp::Interpreter::new(&program);
        let mut row = 0;
        while let Some(now) = simulation.step(&mut interpreter) {
            while let Some(due) = stimuli.row(row).filter(|due| due.time <= now) {
                for setting in due.settings {
                    let name = program.layout.slot(setting.slot).name.clone();
                    controller.write(&name, setting.value)?;
                }
                row += 1;
            }
            controller.scan(Duration::from_nanos(now.unsigned_abs()));
            assert_eq!(controller.image(), simulation.image(), "at {now} ns");
        }
    }
    Ok(())
}

proptest! {
    #[test]
    fn no_name_panics(name: String, written: i64) {
        let mut controller = load(PROGRAM, Engine::Interpreter);
        let declared = controller.variable(&name).is_ok();
        prop_assert_eq!(controller.read::<Value>(&name).is_ok(), declared);
        prop_assert!(declared || controller.write(&name, written).is_err());
    }

    #[test]
    fn no_bytes_panic(bytes: Vec<u8>) {
        let settings = Settings { engine: Engine::Interpreter, ..Settings::default() };
        if let Err(error) = Controller::load_with("x", &bytes, settings) {
            prop_assert!(!error.to_string().is_empty());
        }
        let mut controller = load(PROGRAM, Engine::Interpreter);
        if let Some(retained) = Retained::from_bytes(&bytes) {
            prop_assert!(controller.restore(&retained).is_err());
        }
    }
}
