//! Compiled code against the textbook interpreter, and what its instructions are.

use rung_runtime::Scan;

use super::{CompileError, Jit, host_isa};
use crate::elementary::{Elementary, Value};
use crate::engine::clif::{BRANCHING, Compiler};
use crate::engine::disassemble;
use crate::engine::interp::{Interpreter, Textbook};
use crate::logic::{Area, Binary, Builder, LayoutBuilder, Op, Origin, Program, Slot, Task, random};
use crate::opt;

fn compile(program: &Program) -> Jit {
    Jit::compile(program).unwrap_or_else(|error| panic!("{}: {error}", program.name))
}

/// Code as RISC-V gets it, masks in place of selects, for this machine.
fn compile_as_for_riscv64(program: &Program) -> Jit {
    let isa = host_isa().expect("a host with a back end");
    let mut compiler = Compiler::new(program, &*isa).written_for_riscv64();
    let chunks: Result<Vec<_>, _> = program.chunks().into_iter().map(|sections| compiler.chunk(sections)).collect();
    let chunks = chunks.unwrap_or_else(|error| panic!("{}: {error}", program.name));
    Jit::install(program, chunks).expect("executable memory")
}

fn agrees(program: &Program, mut jit: Jit, seed: u64) {
    let mut textbook = Textbook::new(program);
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
        let program = random::program(seed);
        agrees(&program, compile(&program), seed);
    }
}

#[test]
fn code_as_for_a_target_without_selects_computes_the_same() {
    for seed in 2000..2300 {
        let program = random::program(seed);
        agrees(&program, compile_as_for_riscv64(&program), seed);
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
                    let helper = line.calls && chunk.calls_helpers;
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
    program.tasks = vec![Task::always(0)];
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
    let mut program = random::program(3);
    // So that it is the code that refuses.
    program.tasks = vec![Task::always(program.tasks[program.tasks.len() - 1].end)];
    compile(&program).scan(&mut [0; 3], 0);
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

#[test]
fn a_chunk_that_needs_too_many_values_at_one_time_is_refused_at_once() {
    let spread = |values: i64| {
        let mut layout = LayoutBuilder::new();
        let (ty, initial) = (Elementary::Time, Value::time(0));
        let slot = Slot { name: "least".into(), ty, offset: 0, area: Area::Memory, retain: false, initial, line: 0 };
        let least = layout.slot(slot);
        let mut logic = Builder::new("spread", layout.finish(None).expect("a small image"));
        let now = logic.now();
        // All are alive at once: the first is used last.
        let live: Vec<_> = (0..values)
            .map(|value| {
                let value = logic.constant(Value::time(value));
                logic.binary(Binary::Subtract, now, value)
            })
            .collect();
        let all = live.into_iter().rev().reduce(|a, b| logic.binary(Binary::Minimum, a, b)).expect("some");
        logic.store(least, all);
        logic.end_section(Origin { label: "r".into(), line: 1 });
        logic.finish()
    };
    let small = spread(1000);
    let mut image = small.layout.initial_image();
    compile(&small).scan(&mut image, 5000);
    assert_eq!(small.layout.slots()[0].read(&image), Value::time(4001));
    match Jit::compile(&spread(40_000)) {
        Err(CompileError::Chunk { sections, reason }) => {
            assert_eq!(sections, 0..1);
            assert_eq!(reason, "40000 values are needed at one time, and at most 4096 may be");
        }
        other => panic!("{other:?}"),
    }
}

/// A program of three tasks, which each count their runs: every 10 ns, every 25 ns, and always.
fn counting() -> Program {
    let mut layout = LayoutBuilder::new();
    let mut slot = |name: &str, ty| {
        let (name, initial) = (name.to_owned(), Value::default_of(ty));
        layout.slot(Slot { name: name.into(), ty, offset: 0, area: Area::State, retain: false, initial, line: 0 })
    };
    let runs = ["fast", "slow", "always"].map(|name| slot(name, Elementary::Lint));
    let due = ["#task fast", "#task slow"].map(|name| slot(name, Elementary::Time));
    let mut logic = Builder::new("counting", layout.finish(None).expect("a small image"));
    let tasks = [("fast", Some(10), Some(due[0])), ("slow", Some(25), Some(due[1])), ("", None, None)];
    for (runs, (name, interval, due)) in runs.into_iter().zip(tasks) {
        let (before, one) = (logic.load(runs), logic.constant(Value::from_bits(Elementary::Lint, 1)));
        let after = logic.binary(Binary::Add, before, one);
        logic.store(runs, after);
        logic.end_section(Origin { label: "r".into(), line: 1 });
        logic.end_task(name, interval, due);
    }
    logic.finish()
}

#[test]
fn every_engine_runs_the_tasks_that_are_due_and_no_other() {
    let program = counting();
    let optimised = opt::optimise(program.clone());
    let engines: [Box<dyn Scan>; 4] = [
        Box::new(Textbook::new(&program)),
        Box::new(Interpreter::new(&program)),
        Box::new(compile(&program)),
        Box::new(compile(&optimised)),
    ];
    // By the time of each round: how often each task has run after it, and when the two are due next.
    let rounds = [
        (-5, [0, 0, 1, 0, 0]),
        (0, [1, 1, 2, 10, 25]),
        (9, [1, 1, 3, 10, 25]),
        (10, [2, 1, 4, 20, 25]),
        (10, [2, 1, 5, 20, 25]),
        (47, [3, 2, 6, 50, 50]),
        (50, [4, 3, 7, 60, 75]),
        (i64::MAX, [5, 4, 8, i64::MAX, i64::MAX]),
    ];
    for mut engine in engines {
        let mut image = program.layout.initial_image();
        for (now, expected) in rounds {
            engine.scan(&mut image, now);
            let found: Vec<i64> =
                program.layout.slots().iter().map(|slot| slot.read(&image).bits().cast_signed()).collect();
            assert_eq!(found, expected, "at {now}");
        }
    }
}

/// A program that copies an array of `count` elements to the one behind it while its first slot is TRUE, and its type.
fn copying(ty: Elementary, count: u32) -> Program {
    let mut layout = LayoutBuilder::new();
    let mut slot = |name: String, ty| {
        let (area, initial) = (Area::Memory, Value::default_of(ty));
        layout.slot(Slot { name: name.into(), ty, offset: 0, area, retain: false, initial, line: 0 })
    };
    let condition = slot("condition".into(), Elementary::Bool);
    let [from, to] =
        ["from", "to"].map(|name| (0..count).map(|at| slot(format!("{name}[{at}]"), ty)).collect::<Vec<_>>());
    slot("behind".into(), ty);
    let [from, to] = [from, to].map(|slots| layout.array(slots[0], count));
    let mut logic = Builder::new("copying", layout.finish(None).expect("a small image"));
    let condition = logic.load(condition);
    logic.copy_array(to, from, Some(condition));
    logic.end_section(Origin { label: "r".into(), line: 1 });
    logic.finish()
}

#[test]
fn a_copy_moves_all_of_an_array_or_nothing_whatever_its_size() {
    for ty in [Elementary::Bool, Elementary::Int, Elementary::Real, Elementary::Time] {
        for bytes in [8, 16, 24, 32, 40, 56, 120, 1016, 1024, 1032, 4000] {
            let count = bytes / ty.size() + u32::from(ty == Elementary::Bool);
            let program = copying(ty, count);
            let mut engines: [Box<dyn Scan>; 4] = [
                Box::new(Textbook::new(&program)),
                Box::new(Interpreter::new(&program)),
                Box::new(compile(&program)),
                Box::new(compile_as_for_riscv64(&program)),
            ];
            for copies in [false, true] {
                let mut image = random::image(&program.layout, u64::from(bytes));
                let slots = program.layout.slots();
                slots[0].write(&mut image, Value::bool(copies));
                let mut expected = image.clone();
                for element in 1..=count as usize {
                    if copies {
                        slots[element + count as usize].write(&mut expected, slots[element].read(&image));
                    }
                }
                for engine in &mut engines {
                    let mut actual = image.clone();
                    engine.scan(&mut actual, 0);
                    assert_eq!(actual, expected, "{ty}, {count} elements, {copies}");
                }
            }
        }
    }
}

#[test]
#[cfg(target_arch = "x86_64")]
fn a_copy_is_two_moves_for_16_bytes_or_a_call() {
    let target = host_isa().expect("a host with a back end").triple().clone();
    let lines = |count| {
        let jit = compile(&copying(Elementary::Int, count));
        let chunk = &jit.chunks()[0];
        disassemble::lines(&chunk.code[..chunk.instruction_bytes], &target).expect("a decoder for the host")
    };
    let short = lines(100);
    let (moves, rest): (Vec<_>, Vec<_>) = short.iter().partition(|line| line.text.contains("xmm"));
    assert_eq!(moves.len(), 24, "{short:#?}");
    assert!(rest.len() < 20 && !short.iter().any(|line| line.jumps), "{short:#?}");
    let long = lines(1000);
    assert!(long.len() < 30 && long.iter().filter(|line| line.calls).count() == 1, "{long:#?}");
}

/// Indices at which something could go wrong: the ends of an array, of its bytes, and of all integers.
fn extreme_indices(count: i64) -> Vec<i64> {
    let mut indices: Vec<i64> = (-2..count + 3).collect();
    for power in [8, 16, 31, 32, 33, 60, 61, 62] {
        let edge = 1_i64 << power;
        indices.extend([edge - 1, edge, edge + 1, -edge, count - edge, edge + count - 1]);
    }
    indices.extend([i64::MIN, i64::MIN + 1, i64::MAX, i64::MAX - 1]);
    indices
}

#[test]
fn no_index_reaches_beyond_its_array() {
    const COUNT: u32 = 5;
    for ty in Elementary::ALL {
        let filled = Value::from_bits(ty, 0x4142_4344_4546_4748 | 1);
        let mut layout = LayoutBuilder::new();
        let mut slot = |name: String, ty| {
            let (area, initial) = (Area::Memory, Value::default_of(ty));
            layout.slot(Slot { name: name.into(), ty, offset: 0, area, retain: false, initial, line: 0 })
        };
        let (index, before) = (slot("index".into(), Elementary::Lint), slot("before".into(), ty));
        let elements: Vec<_> = (0..COUNT).map(|element| slot(format!("a[{element}]"), ty)).collect();
        let (found, wanted) = (slot("found".into(), ty), slot("wanted".into(), ty));
        let array = layout.array(elements[0], COUNT);
        let mut logic = Builder::new("array", layout.finish(None).expect("a small image"));
        let at = logic.load(index);
        let element = logic.load_indexed(array, at);
        logic.store(found, element);
        let value = logic.load(wanted);
        logic.store_indexed(array, at, value);
        logic.end_section(Origin { label: "r".into(), line: 1 });
        let program = logic.finish();
        let layout = &program.layout;
        let mut engines: [Box<dyn Scan>; 3] = [
            Box::new(Textbook::new(&program)),
            Box::new(Interpreter::new(&program)),
            Box::new(compile(&opt::optimise(program.clone()))),
        ];
        for number in extreme_indices(i64::from(COUNT)) {
            let mut image = vec![0; layout.size() as usize];
            let bits = number.cast_unsigned();
            layout.slot(index).write(&mut image, Value::from_bits(Elementary::Lint, bits));
            elements.iter().chain([&before]).for_each(|slot| layout.slot(*slot).write(&mut image, filled));
            let mut expected = image.clone();
            if let Some(element) = elements.get(usize::try_from(number).unwrap_or(usize::MAX)) {
                layout.slot(found).write(&mut expected, filled);
                layout.slot(*element).write(&mut expected, Value::default_of(ty));
            }
            for engine in &mut engines {
                let mut actual = image.clone();
                engine.scan(&mut actual, 0);
                assert_eq!(actual, expected, "{ty}, index {number}");
            }
        }
    }
}
