//! How long the JIT takes to compile a synthetic program, beside `gcc -O2` on the same equations written as plain C:
//! file-level variables, one assignment an operation, in one function and in functions of 64 rungs.
//!
//! `cargo bench --bench against_gcc` prints a table for 1451 rungs with 246 timers, medians but for the one function;
//! `cargo test --benches` only shows on a small program that all of it works.

#![expect(clippy::print_stdout, reason = "the table is what it is for")]

use std::fmt::Write as _;
use std::process::Command;
use std::time::{Duration, Instant};

use rung::engine::jit::Jit;
use rung::generate::{Options, generate};
use rung::logic::{Binary, Compare, Op, Program, Unary};
use rung::source::Source;
use rung::{check, elementary::Elementary, lower, opt};

fn main() {
    let measures = std::env::args().any(|argument| argument == "--bench");
    let (rungs, timers, runs) = if measures { (1451, 246, 3) } else { (18, 3, 1) };
    let options = Options { rungs, timers, ..Options::default() };
    let program = generate(&options).expect("options that go together");
    let checked = check::check(&program).0.expect("a generated program has no errors");
    let logic = lower::lower(&checked, &Source::new("synthetic", ""), None).expect("a small image");

    let mut code_bytes = 0;
    let jit = median(9, || {
        // From the lowered program on, as gcc starts from C: our own passes count as well.
        code_bytes = Jit::compile(&opt::optimise(logic.clone())).expect("code for this machine").code_bytes();
    });
    println!("{rungs} rungs, {timers} timers");
    println!("{:<34} {:>10} {:>8} {:>10}", "", "compile ms", "ratio", "bytes");
    println!("{:<34} {:>10.2} {:>8.1} {code_bytes:>10}", "Rung, JIT", milliseconds(jit), 1.0);
    let folder = tempfile::tempdir().expect("a temporary folder");
    // All in one function takes gcc minutes, so that once must do.
    for (name, sections, runs) in [("gcc -O2, 64 rungs a function", 64, runs), ("gcc -O2, one function", usize::MAX, 1)]
    {
        let (source, object) = (folder.path().join("ladder.c"), folder.path().join("ladder.o"));
        std::fs::write(&source, c_source(&logic, sections)).expect("a writable temporary folder");
        let time = median(runs, || {
            let status = Command::new("gcc").args(["-O2", "-c", "-o"]).arg(&object).arg(&source).status();
            assert!(status.expect("gcc, which this bench needs").success(), "gcc refuses the equations");
        });
        let bytes = std::fs::metadata(&object).expect("gcc's object").len();
        let ratio = time.as_secs_f64() / jit.as_secs_f64();
        println!("{name:<34} {:>10.2} {ratio:>8.1} {bytes:>10} (object file)", milliseconds(time));
    }
}

fn milliseconds(time: Duration) -> f64 {
    time.as_secs_f64() * 1e3
}

fn median(runs: usize, mut run: impl FnMut()) -> Duration {
    let mut times: Vec<Duration> = (0..runs)
        .map(|_| {
            let start = Instant::now();
            run();
            start.elapsed()
        })
        .collect();
    times.sort();
    times[runs / 2]
}

/// Lowered logic as C that a compiler likes best. No value of it lives beyond its section.
fn c_source(program: &Program, sections_per_function: usize) -> String {
    let mut c = String::from("#include <stdint.h>\n");
    for (number, slot) in program.layout.slots().iter().enumerate() {
        let _ = writeln!(c, "{} s{number};", c_type(slot.ty));
    }
    let mut functions = 0;
    for (number, _) in program.sections.iter().enumerate() {
        if number % sections_per_function == 0 {
            let close = if number > 0 { "}\n" } else { "" };
            let _ = writeln!(c, "{close}void scan{functions}(int64_t now) {{");
            functions += 1;
        }
        for index in program.section_range(number) {
            let instruction = program.instructions[index];
            let ty = c_type(instruction.ty);
            let _ = match instruction.op {
                Op::Store(slot, value) => writeln!(c, "s{} = {value};", slot.0),
                op => writeln!(c, "const {ty} v{index} = {};", expression(op, instruction.ty)),
            };
        }
    }
    c.push_str("}\n");
    c
}

fn c_type(ty: Elementary) -> &'static str {
    match ty {
        Elementary::Bool => "uint8_t",
        Elementary::Time => "int64_t",
        other => panic!("generated programs hold no {other}"),
    }
}

fn expression(op: Op, ty: Elementary) -> String {
    match op {
        Op::Constant(bits) => format!("{}", bits.cast_signed()),
        Op::Now => "now".to_owned(),
        Op::Load(slot) => format!("s{}", slot.0),
        Op::Unary(Unary::Not, a) if ty == Elementary::Bool => format!("{a} ^ 1"),
        Op::Binary(Binary::And, a, b) => format!("{a} & {b}"),
        Op::Binary(Binary::Or, a, b) => format!("{a} | {b}"),
        Op::Binary(Binary::Subtract, a, b) => format!("{a} - {b}"),
        Op::Compare(Compare::GreaterOrEqual, a, b) => format!("{a} >= {b}"),
        Op::Compare(Compare::Less, a, b) => format!("{a} < {b}"),
        Op::Select(condition, a, b) => format!("{condition} ? {a} : {b}"),
        other => panic!("generated programs hold no {other:?}"),
    }
}
