//! How long the passes and the compiler take, and how large the code is.
#![expect(clippy::print_stderr, reason = "sizes are reported beside the times")]

#[path = "support/edit.rs"]
mod edit;
#[path = "support/workload.rs"]
mod workload;

use std::hint::black_box;
use std::time::{Duration, Instant};

use criterion::{BatchSize, Criterion, Throughput, criterion_group, criterion_main};
use edit::{edited_at, lowered_anew};
use rung::engine::clif::Chunk;
use rung::engine::disassemble;
use rung::engine::jit::{Edited, Jit, host_isa};
use rung::logic::Program;
use rung::opt;
use workload::workload;

fn compiles(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("compile");
    group.sample_size(10);
    for rungs in [18, 1451, 20_000_u32] {
        let program = workload(rungs);
        group.throughput(Throughput::Elements(u64::from(rungs)));
        group.bench_function(format!("optimise/{rungs}"), |bencher| {
            bencher.iter_batched(|| program.clone(), opt::optimise, BatchSize::LargeInput);
        });
        if rungs == 1451 {
            for without in opt::PASSES {
                let program = opt::optimise_with(program.clone(), |pass| pass.name != without.name);
                eprintln!("{rungs} rungs without `{}`: {}", without.name, size(&program, rungs));
            }
        }
        let optimised = opt::optimise(program);
        group.bench_function(format!("jit/{rungs}"), |bencher| {
            bencher.iter(|| Jit::compile(black_box(&optimised)).expect("code for this machine"));
        });
        eprintln!("{rungs} rungs: {}", size(&optimised, rungs));
    }
    group.finish();
}

/// What a program is compiled to.
fn size(program: &Program, rungs: u32) -> String {
    let target = host_isa().expect("a host with a back end").triple().clone();
    let jit = Jit::compile(program).expect("code for this machine");
    let count = |chunk: &Chunk| {
        disassemble::lines(&chunk.code[..chunk.instruction_bytes], &target).map_or(0, |lines| lines.len())
    };
    let instructions: usize = jit.chunks().iter().map(count).sum();
    let each = |count: usize| count as f64 / f64::from(rungs);
    format!("{:.1} bytes and {:.2} instructions a rung", each(jit.code_bytes()), each(instructions))
}

/// Compiling one rung of many again: from the changed logic to installed code, all chunks compared.
fn edits(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("edit");
    group.sample_size(20);
    let rungs = 20_000;
    let program = opt::optimise(workload(rungs));
    let changed = edited_at(program.clone(), program.sections.len() / 2);
    group.bench_function(format!("full/{rungs}"), |bencher| {
        bencher.iter_batched(
            || program.clone(),
            |program| Edited::compile(program).expect("code for this machine"),
            BatchSize::LargeInput,
        );
    });
    let mut edited = Edited::compile(program.clone()).expect("code for this machine");
    group.bench_function(format!("one rung/{rungs}"), |bencher| {
        bencher.iter_custom(|edits| {
            let mut spent = Duration::ZERO;
            for edit in 0..edits {
                let next = lowered_anew(if edit % 2 == 0 { &changed } else { &program });
                let start = Instant::now();
                let update = edited.update(black_box(next)).expect("code for this machine");
                spent += start.elapsed();
                assert!(update.compiled <= 1, "{update:?}");
            }
            spent
        });
    });
    group.finish();
}

criterion_group!(benches, compiles, edits);
criterion_main!(benches);
