//! The code of objects, decoded: what branches, and what is not there.
#![cfg(feature = "all-targets")]

use super::*;
use crate::engine::disassemble;
use crate::logic::random;

const TARGETS: &[(&str, Option<&str>)] = &[
    ("x86_64-unknown-linux-gnu", None),
    ("aarch64-unknown-linux-gnu", None),
    ("riscv64-unknown-elf", Some("rv64gc")),
    ("riscv64-unknown-elf", Some("rv64gc_zba_zbb_zbs_zicond")),
];

fn jumps(function: &Function, target: &Target) -> (usize, usize) {
    let lines = disassemble::lines(&function.code[..function.instruction_bytes], target.triple()).expect("a decoder");
    let bytes: usize = lines.iter().map(|line| line.bytes.len()).sum();
    assert_eq!(bytes, function.instruction_bytes, "{target}, {}: not all of it could be decoded", function.name);
    let calls = lines.iter().filter(|line| line.calls).count();
    (lines.iter().filter(|line| line.jumps).count() - calls, calls)
}

#[test]
fn around_the_rungs_nothing_branches_but_for_tasks_with_an_interval() {
    let interface = Interface::default();
    let mut with_interval = 0;
    for (triple, isa) in TARGETS {
        let target = Target::new(triple, *isa, None).expect("a target");
        for seed in 0..40 {
            let program = random::program(seed);
            let object = assemble(&program, &interface, &target).expect("an object");
            let intervals = program.tasks.iter().filter(|task| task.interval.is_some()).count();
            for function in &object.functions {
                let (branches, calls) = jumps(function, &target);
                match function.role {
                    Role::Tick => assert_eq!((branches, calls), (0, 0), "{target}, seed {seed}"),
                    Role::Cycle => assert!(branches == 0 && calls <= 1, "{target}, seed {seed}: {branches} {calls}"),
                    // One to leave a task out, and on some targets one to go on behind it.
                    Role::Round => assert!(branches <= 2 * intervals, "{target}, seed {seed}: {branches}"),
                    Role::Image | Role::Helper => {}
                }
            }
            with_interval += intervals;
        }
    }
    assert!(with_interval > 20, "only {with_interval} tasks with an interval were seen");
}

#[test]
fn without_d_an_object_holds_no_floating_point() {
    let target = Target::new("riscv64-unknown-elf", Some("rv64imac"), None).expect("a target");
    let (mut built, mut refused) = (0, 0);
    for seed in 0..60 {
        match assemble(&random::program(seed), &Interface::default(), &target) {
            Ok(object) => {
                built += 1;
                let chunks = object.chunks.iter().map(|chunk| &chunk.code[..chunk.instruction_bytes]);
                let functions = object.functions.iter().map(|function| &function.code[..function.instruction_bytes]);
                for code in chunks.chain(functions) {
                    for line in disassemble::lines(code, target.triple()).expect("a decoder") {
                        assert!(!line.text.starts_with(['f']) || line.text.starts_with("fence"), "{}", line.text);
                        assert!(!line.text.starts_with("c.f"), "{}", line.text);
                    }
                }
            }
            Err(CompileError::NeedsFpu { .. }) => refused += 1,
            Err(other) => panic!("seed {seed}: {other}"),
        }
    }
    assert!(built > 5 && refused > 5, "{built} built and {refused} refused");
}

#[test]
fn a_program_of_one_chunk_is_scanned_without_a_call_in_between() {
    let target = Target::new("riscv64-unknown-elf", None, None).expect("a target");
    let (mut alone, mut called) = (0, 0);
    for seed in 0..150 {
        let program = random::program(seed);
        let object = assemble(&program, &Interface::default(), &target).expect("an object");
        let plain = program.tasks.iter().all(|task| task.interval.is_none());
        let is_alone = match object.chunks.as_slice() {
            [chunk] => plain && program.tasks.len() == 1 && !chunk.calls_helpers,
            _ => false,
        };
        assert_eq!(object.functions.iter().any(|function| function.role == Role::Round), !is_alone, "seed {seed}");
        alone += usize::from(is_alone);
        called += usize::from(!is_alone);
    }
    assert!(alone > 0 && called > 0, "{alone} alone and {called} called");
}
