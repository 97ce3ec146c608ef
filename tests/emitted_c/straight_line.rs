//! What compilers make of the rungs: no branch that depends on data.

use std::fs;
use std::process::Command;

use rung::elementary::Elementary;
use rung::emit;
use rung::interface::Interface;
use rung::logic::{Op, Program};

use crate::programs::examples;
use crate::rig::run;

/// A compiler with its options, what disassembles its objects, and the start of a conditional branch there.
struct Target {
    compiler: &'static str,
    options: &'static [&'static str],
    objdump: &'static str,
    /// Whether only programs of BOOL and TIME are looked at: where a machine has no instruction to choose, gcc may choose
    /// between other numbers by a branch after all.
    only_bool_and_time: bool,
    branches: &'static [&'static str],
}

const TARGETS: [Target; 4] = [
    Target { compiler: "gcc", options: &[], objdump: "objdump", only_bool_and_time: false, branches: X86 },
    Target {
        compiler: "riscv64-unknown-elf-gcc",
        options: &["-march=rv64imac", "-mabi=lp64", "-mcmodel=medany"],
        objdump: "riscv64-unknown-elf-objdump",
        only_bool_and_time: true,
        branches: RISCV,
    },
    Target {
        compiler: "riscv64-unknown-elf-gcc",
        options: &["-march=rv32imac", "-mabi=ilp32"],
        objdump: "riscv64-unknown-elf-objdump",
        only_bool_and_time: true,
        branches: RISCV,
    },
    Target {
        compiler: "arm-none-eabi-gcc",
        options: &["-mcpu=cortex-m3", "-mthumb"],
        objdump: "arm-none-eabi-objdump",
        only_bool_and_time: false,
        branches: ARM,
    },
];

const X86: &[&str] = &["ja", "jb", "jc", "je", "jg", "jl", "jn", "jo", "jp", "js"];
const RISCV: &[&str] = &["beq", "bne", "blt", "bge", "bgt", "ble"];
const ARM: &[&str] =
    &["beq", "bne", "bcs", "bcc", "bmi", "bpl", "bhi", "bls", "bge", "blt", "bgt", "ble", "cbz", "cbnz"];

/// The conditional branches in the rungs of a disassembly.
fn branches<'t>(listing: &'t str, starts: &[&str]) -> Vec<&'t str> {
    let mut of_rungs = false;
    let mut found = Vec::new();
    for line in listing.lines() {
        if let Some((_, name)) = line.strip_suffix(">:").and_then(|line| line.split_once('<')) {
            of_rungs = name.starts_with("rungs_");
        }
        let operation = line.split('\t').nth(1).unwrap_or_default();
        if of_rungs && starts.iter().any(|start| operation.starts_with(start)) {
            found.push(line);
        }
    }
    found
}

#[test]
fn compilers_make_no_branch_of_the_rungs_of_the_examples() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    // Loops over elements and calls of helpers are not of the rungs.
    let plain = |program: &Program| {
        !program
            .instructions
            .iter()
            .any(|made| matches!(made.op, Op::CopyArray(..) | Op::Call(..)) || made.ty.is_real())
    };
    let examples: Vec<Program> = examples().into_iter().filter(plain).collect();
    assert!(examples.len() >= 6, "only {} examples", examples.len());
    for (number, program) in examples.iter().enumerate() {
        let text = emit::c::emit(program, &Interface::default()).expect("names of C");
        // Inlined into the scan, they could not be told from the test whether a task is due.
        let text = text.replace("static void rungs_", "__attribute__((noinline)) static void rungs_");
        let (source, object) = (format!("p{number}.c"), format!("p{number}.o"));
        fs::write(folder.path().join(&source), text).expect("a writable folder");
        let is_simple = |ty| matches!(ty, Elementary::Bool | Elementary::Time);
        let bool_and_time = program.instructions.iter().all(|made| is_simple(made.ty));
        let targets = TARGETS.iter().filter(|target| bool_and_time || !target.only_bool_and_time);
        for Target { compiler, options, objdump, branches: starts, .. } in targets {
            let mut command = Command::new(compiler);
            command.current_dir(folder.path()).args([
                "-std=c99",
                "-O2",
                "-ffreestanding",
                "-c",
                &source,
                "-o",
                &object,
            ]);
            run(command.args(*options));
            let mut command = Command::new(objdump);
            let output = command.current_dir(folder.path()).args(["-d", "--no-show-raw-insn", &object]).output();
            let listing = String::from_utf8(output.expect("binutils").stdout).expect("text");
            assert!(listing.contains("<rungs_1>:"), "{listing}");
            assert_eq!(branches(&listing, starts), [""; 0], "{compiler} {options:?}: {}\n{listing}", program.name);
        }
    }
}

#[test]
fn a_branch_in_the_rungs_would_be_seen() {
    let listing = "0 <rungs_1>:\n   4:\tbeqz\ta5,10 <.L1>\n   6:\tadd\ta5,a5,1\n8 <ladder_scan>:\n   c:\tbnez\ta5,10\n";
    assert_eq!(branches(listing, RISCV), ["   4:\tbeqz\ta5,10 <.L1>"]);
}
