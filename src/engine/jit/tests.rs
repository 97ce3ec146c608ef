//! Compiled code against the textbook interpreter, and what its instructions are.

use rung_runtime::Scan;

use super::{Jit, host_isa};
use crate::elementary::{Elementary, Value};
use crate::engine::clif::BRANCHING;
use crate::engine::disassemble;
use crate::engine::interp::Textbook;
use crate::logic::{Area, Builder, LayoutBuilder, Op, Origin, Program, Slot, random};
use crate::opt;

fn compile(program: &Program) -> Jit {
    Jit::compile(program).unwrap_or_else(|error| panic!("{}: {error}", program.name))
}

fn agrees(program: &Program, seed: u64) {
    let (mut textbook, mut jit) = (Textbook::new(program), compile(program));
    for round in 0..8 {
        let mut expected = random::image(&program.layout, seed ^ round << 32);
        let mut actual = expected.clone();
        for scan in 0..2 {
            let now = random::now(seed + round * 1000 + scan);
            textbook.scan(&mut expected, now);
            jit.scan(&mut actual, now);
            for slot in program.layout.slots() {
                let (expected, actual) = (slot.read(&expected), slot.read(&actual));
                assert_eq!(
                    expected.bits(),
                    actual.bits(),
                    "{} {expected:?} {actual:?} of seed {seed}:\n{program:#?}",
                    slot.name
                );
            }
            assert_eq!(expected, actual, "padding, seed {seed}, round {round}");
        }
    }
}

#[test]
fn compiled_code_computes_what_the_textbook_does_over_the_whole_image() {
    for seed in 0..600 {
        agrees(&random::program(seed), seed);
    }
}

#[test]
fn optimised_and_compiled_it_still_does() {
    for seed in 1000..1400 {
        let program = random::program(seed);
        let optimised = opt::optimise(program.clone());
        let (mut textbook, mut jit) = (Textbook::new(&program), compile(&optimised));
        let mut expected = random::image(&program.layout, seed);
        let mut actual = expected.clone();
        for scan in 0..4 {
            let now = random::now(seed + scan);
            textbook.scan(&mut expected, now);
            jit.scan(&mut actual, now);
            assert_eq!(expected, actual, "seed {seed}, scan {scan}:\n{program:#?}");
        }
    }
}

#[test]
fn code_is_a_straight_line_but_for_the_listed_operations() {
    let target = host_isa().expect("a host with a back end").triple().clone();
    let architecture = target.architecture.to_string();
    let listed = |program: &Program| {
        program.instructions.iter().any(|instruction| match instruction.op {
            Op::Binary(op, ..) => BRANCHING.iter().any(|listed| {
                listed.op == op && listed.architectures.iter().any(|name| architecture.starts_with(name))
            }),
            _ => false,
        })
    };
    let mut decoded = 0;
    for seed in 0..300 {
        for program in [random::program(seed), opt::optimise(random::program(seed))] {
            for chunk in compile(&program).chunks() {
                let lines = disassemble::lines(&chunk.code[..chunk.instruction_bytes], &target)
                    .expect("a decoder for the host");
                let bytes: usize = lines.iter().map(|line| line.bytes.len()).sum();
                assert_eq!(bytes, chunk.instruction_bytes, "seed {seed}: bytes that are no instruction");
                assert_eq!(lines.last().map(|line| line.text.as_str()), Some("ret"), "seed {seed}: code after the end");
                decoded += lines.len();
                for line in lines {
                    let calls = ["call ", "blr ", "jalr ", "c.jalr "].iter().any(|call| line.text.starts_with(call));
                    let helper = calls && chunk.calls_helpers;
                    assert!(!line.jumps || helper || listed(&program), "seed {seed}: {}", line.text);
                }
            }
        }
    }
    assert!(decoded > 10_000, "only {decoded} instructions were looked at");
}

#[test]
fn the_same_program_gives_the_same_code_however_its_chunks_are_shared_out() {
    let program = random::program(7);
    assert_eq!(compile(&program).chunks(), compile(&program).chunks());
}

#[test]
fn a_program_without_sections_leaves_the_image_alone() {
    let mut program = random::program(3);
    program.sections.clear();
    program.instructions.clear();
    let mut jit = compile(&program);
    let mut image = random::image(&program.layout, 1);
    let before = image.clone();
    jit.scan(&mut image, 5);
    assert_eq!(image, before);
    assert_eq!(jit.code_bytes(), 0);
}

#[test]
#[should_panic(expected = "shorter than the program's layout")]
fn an_image_that_is_too_short_is_refused() {
    compile(&random::program(3)).scan(&mut [0; 3], 0);
}

#[test]
fn a_rung_of_a_hundred_thousand_contacts_compiles_and_runs() {
    let mut layout = LayoutBuilder::new();
    let mut slot = |name: &str| {
        let (ty, initial) = (Elementary::Bool, Value::bool(true));
        layout.slot(Slot { name: name.into(), ty, offset: 0, area: Area::Memory, retain: false, initial, line: 0 })
    };
    let (contact, coil) = (slot("contact"), slot("coil"));
    let mut logic = Builder::new("long", layout.finish(None).expect("a small image"));
    let mut power = logic.load(contact);
    for _ in 0..100_000 {
        // Inverted twice: neither code nor compiler may nest as deep as the rung is long.
        let inverse = logic.not(power);
        power = logic.not(inverse);
        let value = logic.load(contact);
        power = logic.and(power, value);
    }
    logic.store(coil, power);
    logic.end_section(Origin { label: "r".into(), line: 1 });
    let program = logic.finish();
    let mut image = program.layout.initial_image();
    program.layout.slot(coil).write(&mut image, Value::bool(false));
    compile(&program).scan(&mut image, 0);
    assert!(program.layout.slot(coil).read(&image).is_true());
}
