//! The machine code of every example and of random programs, decoded: a straight line.
//!
//! On this machine's target no operation that ladders use may branch but those of `clif::BRANCHING`; where that
//! lists some, branches are counted against the instructions that may make them. Calls of helpers are none.

use rung::engine::clif::BRANCHING;
use rung::engine::disassemble;
use rung::engine::jit::{Jit, host_isa};
use rung::ladder::Program;
use rung::logic::{Binary, Op};
use rung::source::Source;
use rung::{frontend, logic, lower, opt};

use crate::examples::{examples, source};
use crate::support::random_program::random_program;
use crate::support::rig::checked;

/// Random programs that are decoded.
const PROGRAMS: u64 = 150;

#[test]
fn the_code_of_every_example_is_a_straight_line() {
    for path in examples() {
        let parsed = frontend::parse(&source(&path));
        is_straight(&parsed.program, &path.display().to_string());
    }
}

#[test]
fn the_code_of_random_programs_is_a_straight_line() {
    for seed in 0..PROGRAMS {
        is_straight(&random_program(seed), &format!("seed {seed}"));
    }
}

fn is_straight(program: &Program, name: &str) {
    let checked = checked(program).unwrap_or_else(|problems| panic!("{name}: {problems}"));
    let plain = lower::lower(&checked, &Source::new("drawn", ""), None).expect("a small image");
    for program in [&plain, &opt::optimise(plain.clone())] {
        let target = host_isa().expect("a back end for this machine").triple().clone();
        let jit = Jit::compile(program).expect("code for this machine");
        let mut jumps = Vec::new();
        for chunk in jit.chunks() {
            let code = &chunk.code[..chunk.instruction_bytes];
            let lines = disassemble::lines(code, &target).expect("a disassembler for this machine");
            let decoded: usize = lines.iter().map(|line| line.bytes.len()).sum();
            assert_eq!(decoded, code.len(), "{name}: not all of the code could be decoded");
            let jump = lines.into_iter().filter(|line| line.jumps && !(line.calls && chunk.calls_helpers));
            jumps.extend(jump.map(|line| line.text));
        }
        let may = if cfg!(target_arch = "x86_64") { 0 } else { BRANCHING.len() * divisions(program) };
        assert!(jumps.len() <= may, "{name}: {jumps:?}");
    }
}

/// Integer divisions, the only operations that ladders use and that branch on some target.
fn divisions(program: &logic::Program) -> usize {
    let divides = |op| matches!(op, Op::Binary(Binary::Divide | Binary::Remainder, ..));
    program.instructions.iter().filter(|instruction| divides(instruction.op)).count()
}
