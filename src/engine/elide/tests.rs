//! Elided scans against the same scans run: nothing may tell them apart.

use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;
use rung_runtime::Scan;

use super::Elided;
use crate::engine::interp::{Interpreter, Textbook};
use crate::logic::{Layout, Program, random};
use crate::source::Source;
use crate::{check, frontend, lower, opt};

fn elided(program: &Program) -> Elided<Interpreter> {
    Elided::new(Interpreter::new(program), program)
}

fn logic(text: &str) -> Program {
    let source = Source::new("test", text);
    let parsed = frontend::parse(&source);
    let (checked, found) = check::check(&parsed.program);
    let checked = checked.unwrap_or_else(|| panic!("{:?} {found:?}", parsed.diagnostics));
    lower::lower(&checked, &source, None).expect("a small image")
}

fn write(layout: &Layout, name: &str, value: bool, image: &mut [u8]) {
    let observed = layout.observed().iter().find(|observed| observed.name == name).expect("a variable");
    image[layout.slot(observed.slot).offset as usize] = u8::from(value);
}

/// Runs a program with and without elision on inputs and variables that change now and then; gives how many scans were
/// left out.
fn agrees(program: &Program, seed: u64, scans: u64) -> u64 {
    let layout = &program.layout;
    let mut rng = Pcg64::seed_from_u64(seed);
    let (mut plain, mut elided) = (Textbook::new(program), elided(program));
    let mut expected = random::image(layout, seed);
    let mut actual = expected.clone();
    let mut now = 0i64;
    for scan in 0..scans {
        let other = random::image(layout, seed ^ scan << 40);
        let (inputs, all) = (rng.random_bool(0.1), rng.random_bool(0.05));
        for (index, slot) in layout.slots().iter().enumerate() {
            let is_input = layout.inputs().iter().any(|run| run.bytes.contains(&slot.offset));
            let is_due = program.tasks.iter().any(|task| task.due.is_some_and(|due| due.index() == index));
            if !is_due && (is_input && inputs || all) && rng.random_bool(0.3) {
                let range = slot.offset as usize..(slot.offset + slot.ty.size()) as usize;
                expected[range.clone()].copy_from_slice(&other[range.clone()]);
                actual[range.clone()].copy_from_slice(&other[range]);
            }
        }
        now = if rng.random_bool(0.1) { random::now(seed + scan) } else { now.wrapping_add(rng.random_range(0..10)) };
        plain.scan(&mut expected, now);
        if all {
            elided.scan(&mut actual, now)
        } else {
            elided.scan_inputs(&mut actual, now)
        }
        for observed in layout.observed() {
            let slot = layout.slot(observed.slot);
            let (expected, actual) = (slot.read(&expected).bits(), slot.read(&actual).bits());
            assert_eq!(expected, actual, "{} in scan {scan} of seed {seed}:\n{program:#?}", observed.name);
        }
        if rng.random_bool(0.3) {
            elided.settle(&mut actual);
            assert_eq!(expected, actual, "the whole image in scan {scan} of seed {seed}");
        }
    }
    elided.left_out()
}

#[test]
fn what_is_left_out_changes_nothing_in_random_programs() {
    let mut left_out = 0;
    for seed in 0..600 {
        let program = random::program(seed);
        left_out += agrees(&program, seed, 40);
        left_out += agrees(&opt::optimise(program), seed, 40);
    }
    assert!(left_out > 500, "only {left_out} scans were left out, which tests little");
}

#[test]
fn a_timer_that_runs_keeps_its_program_awake_and_no_other_does() {
    let timers = ["TON", "TOF", "TP"];
    for kind in timers {
        let text = format!("program p\ninput a\noutput q\nrung r\n  a t:{kind}(PT := T#50ms) (q)\n");
        let program = opt::optimise(logic(&text));
        let mut elided = elided(&program);
        let mut image = program.layout.initial_image();
        let mut ran = Vec::new();
        for scan in 0..40 {
            write(&program.layout, "a", (10..20).contains(&scan) && kind != "TP" || scan == 10, &mut image);
            let before = elided.left_out();
            elided.scan_inputs(&mut image, scan * 10_000_000);
            ran.push(elided.left_out() == before);
        }
        assert!(ran[0] && ran[10], "{kind}: {ran:?}");
        assert!(!ran[5] && !ran[9] && !ran[39], "an idle timer is left alone, {kind}: {ran:?}");
        let timing = if kind == "TOF" { 21..=25 } else { 11..=15 };
        assert!(timing.clone().all(|scan| ran[scan]), "a timer that times is run, {kind}: {ran:?}");
        assert!(!ran[timing.end() + 3], "{kind}: {ran:?}");
    }
}

#[test]
fn a_periodic_task_runs_when_it_is_due() {
    let program = logic(
        "task slow(interval := 100ms, priority := 1)\n\
         program p with slow\nvar n : INT\nrung r\n  {n := n + 1}\n\
         program q\ninput a\noutput b\nrung s\n  a (b)\n",
    );
    let mut elided = elided(&program);
    let mut image = program.layout.initial_image();
    let counted = program.layout.observed().iter().find(|observed| observed.name.ends_with('n')).expect("the counter");
    for scan in 0..100 {
        elided.scan_inputs(&mut image, scan * 10_000_000);
        let count = program.layout.slot(counted.slot).read(&image).bits();
        assert_eq!(count, 1 + scan.cast_unsigned() / 10, "scan {scan}");
    }
    assert_eq!(
        elided.left_out(),
        80,
        "all but those in which it is due, and one after each that finds nothing changed"
    );
}
