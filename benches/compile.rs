//! How long the passes and the compiler take, and how large the code is.
#![expect(clippy::print_stderr, reason = "sizes are reported beside the times")]

#[path = "support/workload.rs"]
mod workload;

use std::hint::black_box;

use criterion::{BatchSize, Criterion, Throughput, criterion_group, criterion_main};
use rung::engine::disassemble;
use rung::engine::jit::{Jit, host_isa};
use rung::opt;
use workload::workload;

fn compiles(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("compile");
    group.sample_size(10);
    let target = host_isa().expect("a host with a back end").triple().clone();
    for rungs in [18, 1451, 20_000_u32] {
        let program = workload(rungs);
        group.throughput(Throughput::Elements(u64::from(rungs)));
        group.bench_function(format!("optimise/{rungs}"), |bencher| {
            bencher.iter_batched(|| program.clone(), opt::optimise, BatchSize::LargeInput);
        });
        let optimised = opt::optimise(program);
        group.bench_function(format!("jit/{rungs}"), |bencher| {
            bencher.iter(|| Jit::compile(black_box(&optimised)).expect("code for this machine"));
        });
        let jit = Jit::compile(&optimised).expect("code for this machine");
        let instructions: usize = jit
            .chunks()
            .iter()
            .map(|chunk| {
                disassemble::lines(&chunk.code[..chunk.instruction_bytes], &target).map_or(0, |lines| lines.len())
            })
            .sum();
        let each = |count: usize| count as f64 / rungs as f64;
        let bytes = jit.code_bytes();
        eprintln!("{rungs} rungs: {:.1} bytes and {:.2} instructions a rung", each(bytes), each(instructions));
    }
    group.finish();
}

criterion_group!(benches, compiles);
criterion_main!(benches);
