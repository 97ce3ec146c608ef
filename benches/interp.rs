//! What a rung costs the two interpreters, and translating it for the fast one: `cargo bench --bench interp`.
//! A tenth of the inputs changes before every scan.

#[path = "support/workload.rs"]
mod workload;

use std::hint::black_box;

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use rung::engine::interp::{Interpreter, Textbook};
use rung_runtime::Scan;
use workload::{Workload, workload};

fn interpreters(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("interp");
    for rungs in [18, 1451, 20_000] {
        let Workload { program, inputs } = workload(rungs);
        group.throughput(Throughput::Elements(rungs as u64));
        let engines: [(&str, Box<dyn Scan>); 2] =
            [("textbook", Box::new(Textbook::new(&program))), ("compact", Box::new(Interpreter::new(&program)))];
        for (name, mut engine) in engines {
            let (mut image, mut now, mut at) = (program.layout.initial_image(), 0, 0);
            group.bench_function(BenchmarkId::new(name, rungs), |bencher| {
                bencher.iter(|| {
                    for _ in 0..inputs.len().div_ceil(10) {
                        // A stride that meets all inputs in an order without a pattern.
                        at = (at + 7919) % inputs.len();
                        image[inputs.start + at] ^= 1;
                    }
                    now += 10_000_000;
                    engine.scan(black_box(&mut image), now);
                });
            });
        }
        group.bench_function(BenchmarkId::new("translate", rungs), |bencher| {
            bencher.iter(|| black_box(Interpreter::new(&program)));
        });
    }
    group.finish();
}

criterion_group!(benches, interpreters);
criterion_main!(benches);
