//! Every 64-bit target: its code is a straight line but for what [`BRANCHING`] lists, and every row of that is true.

use cranelift_codegen::isa::{self, OwnedTargetIsa};
use cranelift_codegen::settings::Configurable;
use target_lexicon::Triple;

use super::{BRANCHING, Compiler, flags};
use crate::engine::disassemble::{self, Line};
use crate::logic::{Binary, Op, Program, random};
use crate::opt;

/// Triples with what their processor offers beyond the least.
const TARGETS: &[(&str, &[&str])] = &[
    ("x86_64-unknown-linux-gnu", &[]),
    ("x86_64-unknown-linux-gnu", &["has_sse41", "has_avx", "has_avx2", "has_fma", "has_bmi1", "has_bmi2", "has_lzcnt"]),
    ("aarch64-unknown-linux-gnu", &[]),
    ("aarch64-unknown-linux-gnu", &["has_lse"]),
    ("riscv64gc-unknown-linux-gnu", &[]),
    ("riscv64gc-unknown-linux-gnu", &["has_zicond", "has_zba", "has_zbb", "has_zbs"]),
];

fn isa(triple: &str, features: &[&str]) -> OwnedTargetIsa {
    let triple: Triple = triple.parse().expect("a known triple");
    let mut builder = isa::lookup(triple).expect("a back end for every target of the table");
    features.iter().for_each(|feature| builder.enable(feature).expect("a feature of this target"));
    builder.finish(flags(false).expect("known flags")).expect("settings that fit")
}

/// Whether an operation is listed for an architecture.
fn listed(op: Binary, architecture: &str) -> bool {
    let row = BRANCHING.iter().find(|row| row.op == op);
    row.is_some_and(|row| row.architectures.iter().any(|name| architecture.starts_with(name)))
}

/// The branches in a program's code, calls of helpers left out.
fn branches(program: &Program, isa: &OwnedTargetIsa, decoded: &mut usize) -> Vec<String> {
    let mut compiler = Compiler::new(program, &**isa);
    let mut branches = Vec::new();
    for sections in program.chunks() {
        let chunk = compiler.chunk(sections).expect("code");
        let code = &chunk.code[..chunk.instruction_bytes];
        let lines = disassemble::lines(code, isa.triple()).expect("a decoder");
        let bytes: usize = lines.iter().map(|line| line.bytes.len()).sum();
        assert_eq!(bytes, code.len(), "{}, {}: not all could be decoded", isa.triple(), program.name);
        *decoded += lines.len();
        let branch = |line: &Line| line.jumps && !(line.calls && chunk.calls_helpers);
        branches.extend(lines.into_iter().filter(branch).map(|line| line.text));
    }
    branches
}

#[test]
fn the_code_of_every_target_is_a_straight_line_but_for_the_listed_operations() {
    for (triple, features) in TARGETS {
        let isa = isa(triple, features);
        let architecture = isa.triple().architecture.to_string();
        let (mut decoded, mut with_listed) = (0, 0);
        for seed in 0..150 {
            let program = random::program(seed);
            let mut others = program.clone();
            for instruction in &mut others.instructions {
                if let Op::Binary(op, a, b) = instruction.op
                    && listed(op, &architecture)
                {
                    instruction.op = Op::Binary(Binary::Multiply, a, b);
                }
            }
            for program in [opt::optimise(others.clone()), others] {
                let branches = branches(&program, &isa, &mut decoded);
                assert_eq!(branches, [""; 0], "{triple} {features:?}, seed {seed}");
            }
            with_listed += branches(&program, &isa, &mut decoded).len();
        }
        assert!(decoded > 10_000, "{triple}: only {decoded} instructions were looked at");
        let expected = [Binary::Divide, Binary::Remainder].iter().any(|op| listed(*op, &architecture));
        assert_eq!(with_listed > 0, expected, "{triple} {features:?}");
    }
}

#[test]
fn the_decoder_sees_the_branches_of_every_target() {
    let branches: &[(&str, &[u8])] = &[
        ("x86_64-unknown-linux-gnu", &[0x74, 0x02]),
        ("x86_64-unknown-linux-gnu", &[0xE8, 0, 0, 0, 0]),
        // cbz, tbz, b.eq and bl.
        ("aarch64-unknown-linux-gnu", &[0x40, 0, 0, 0xB4]),
        ("aarch64-unknown-linux-gnu", &[0x40, 0, 0, 0x36]),
        ("aarch64-unknown-linux-gnu", &[0x40, 0, 0, 0x54]),
        ("aarch64-unknown-linux-gnu", &[0x01, 0, 0, 0x94]),
        // beq, bltu, jal and c.beqz.
        ("riscv64gc-unknown-linux-gnu", &[0x63, 0x04, 0xB5, 0x00]),
        ("riscv64gc-unknown-linux-gnu", &[0x63, 0x64, 0xB5, 0x00]),
        ("riscv64gc-unknown-linux-gnu", &[0xEF, 0x00, 0x80, 0x00]),
        ("riscv64gc-unknown-linux-gnu", &[0x01, 0xC1]),
    ];
    for (triple, code) in branches {
        let lines = disassemble::lines(code, &triple.parse().expect("a known triple")).expect("a decoder");
        let jumps: Vec<bool> = lines.iter().map(|line| line.jumps).collect();
        assert_eq!(jumps, [true], "{triple} {code:02x?}: {lines:?}");
    }
}
