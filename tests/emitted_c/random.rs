//! Random logic, in which every operation occurs on every type that it takes, on every compiler.

use rung::engine::interp::Interpreter;
use rung::logic::{Program, random};
use rung::opt;
use rung_runtime::Scan;

use crate::rig::{CHECKED, CLANG, Compiler, GCC, GCC_NARROW, GCC_PLAIN, Rig, TCC};

/// Programs for each compiler, and scans of each. `RUNG_SEEDS` and `RUNG_FIRST_SEED` look at others.
const SEEDS: u64 = 24;
const SCANS: u64 = 30;

fn programs(first: u64) -> Vec<Program> {
    (first..)
        .map(random::program)
        // As they are, and as the passes leave them.
        .enumerate()
        .map(|(number, program)| if number % 2 == 0 { program } else { opt::optimise(program) })
        .take(usize::try_from(number("RUNG_SEEDS", SEEDS)).expect("few"))
        .collect()
}

/// A number from the environment.
fn number(name: &str, otherwise: u64) -> u64 {
    std::env::var(name).ok().and_then(|text| text.parse().ok()).unwrap_or(otherwise)
}

fn agrees(compiler: Compiler, first: u64) {
    let programs = programs(number("RUNG_FIRST_SEED", first));
    let mut rig = Rig::new(compiler, &programs, 1_000_000);
    for (number, program) in programs.iter().enumerate() {
        let mut interpreter = Interpreter::new(program);
        let mut image = program.layout.initial_image();
        rig.init(number, None, &image);
        for scan in 0..SCANS {
            // Now and then anything at all, else on from where it was.
            if scan % 3 == 2 {
                image = random::image(&program.layout, scan * 1000 + number as u64);
            }
            let (before, now) = (image.clone(), random::now(scan + 77 * number as u64));
            interpreter.scan(&mut image, now);
            rig.scan(number, now, &before, &image);
        }
    }
    rig.finish();
}

#[test]
fn random_logic_computes_the_same_optimised_by_gcc() {
    agrees(GCC, 0);
}

#[test]
fn random_logic_computes_the_same_as_written() {
    agrees(GCC_PLAIN, 1000);
}

#[test]
fn random_logic_computes_the_same_with_what_machines_of_32_bits_get() {
    agrees(GCC_NARROW, 2000);
}

#[test]
fn random_logic_computes_the_same_optimised_by_clang() {
    agrees(CLANG, 3000);
}

#[test]
fn random_logic_computes_the_same_on_tcc() {
    agrees(TCC, 4000);
}

#[test]
fn random_logic_does_nothing_that_c_leaves_undefined() {
    agrees(CHECKED, 5000);
}
