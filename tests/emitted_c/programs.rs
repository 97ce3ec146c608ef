//! Ladder programs: the examples, and random ones that together hold every block, function and statement.

use std::fs;
use std::path::Path;

use rung::engine::interp::Interpreter;
use rung::interface::Interface;
use rung::logic::{Area, Program, random};
use rung::source::{Source, Span};
use rung::{check, emit, frontend, lower, opt};
use rung_runtime::Scan;

use crate::rig::{CLANG, Compiler, GCC, Rig};
use crate::support::random_program::random_program;

fn optimised(checked: &check::Checked, source: &Source) -> Program {
    opt::optimise(lower::lower(checked, source, None).expect("it fits"))
}

pub(crate) fn examples() -> Vec<Program> {
    let mut folders = vec![Path::new(env!("CARGO_MANIFEST_DIR")).join("examples")];
    let mut paths = Vec::new();
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).expect("the examples") {
            let path = entry.expect("an entry").path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|extension| extension == "rung") {
                paths.push(path);
            }
        }
    }
    paths.sort();
    assert!(paths.len() >= 10, "{paths:?}");
    let read = |path: &std::path::PathBuf| {
        let source = Source::new("example", fs::read_to_string(path).expect("a readable example"));
        let parsed = frontend::parse(&source);
        let checked = check::check(&parsed.program).0.unwrap_or_else(|| panic!("{}", path.display()));
        optimised(&checked, &source)
    };
    paths.iter().map(read).collect()
}

/// Nanoseconds from one scan to the next, over and over.
const STEPS: [i64; 5] = [0, 1_000_000, 100_000_000, 730_000_000, 5_000_000_000];

/// Runs programs under random inputs, over times that timers take.
fn agrees(compiler: Compiler, programs: &[Program], scans: u64) {
    let mut rig = Rig::new(compiler, programs, 1_000_000);
    for (number, program) in programs.iter().enumerate() {
        let layout = &program.layout;
        let mut interpreter = Interpreter::new(program);
        let mut image = layout.initial_image();
        let mut now = 0;
        for scan in 0..scans {
            let seed = scan * 1000 + number as u64;
            let anything = random::image(layout, seed);
            for (place, slot) in layout.slots().iter().enumerate().filter(|(_, slot)| slot.area == Area::Input) {
                // Some inputs at a time, so that states last.
                if (seed / 7 + place as u64 * 5).is_multiple_of(3) {
                    slot.write(&mut image, slot.read(&anything));
                }
            }
            let before = image.clone();
            interpreter.scan(&mut image, now);
            rig.scan(number, now, &before, &image);
            now += STEPS[usize::try_from(scan).unwrap_or_default() % STEPS.len()];
        }
    }
    rig.finish();
}

#[test]
fn every_example_computes_the_same() {
    let programs = examples();
    agrees(GCC, &programs, 200);
    agrees(CLANG, &programs, 200);
}

#[test]
fn random_ladder_programs_compute_the_same() {
    let programs: Vec<Program> = (0..)
        .map(|seed| {
            let program = random_program(seed);
            let checked = check::check(&program).0.expect("random programs check");
            optimised(&checked, &Source::new("random", ""))
        })
        // Some have names that C cannot have.
        .filter(|program| emit::validate(program, &Interface::default(), &|_, _| Span::default()).is_ok())
        .take(40)
        .collect();
    agrees(GCC, &programs, 40);
}
