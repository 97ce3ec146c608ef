//! How long a scan takes, compiled and interpreted, with a tenth of the inputs changing between scans.

#[path = "support/workload.rs"]
mod workload;

use std::hint::black_box;
use std::time::{Duration, Instant};

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;
use rung::engine::interp::{Interpreter, Textbook};
use rung::engine::jit::Jit;
use rung::opt;
use rung_runtime::Scan;
use workload::workload;

fn scans(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("scan");
    for rungs in [18, 1451, 20_000_u32] {
        let program = opt::optimise(workload(rungs));
        let bytes = &program.layout.inputs()[0].bytes;
        let inputs = bytes.start as usize..bytes.end as usize;
        let jit = Jit::compile(&program).expect("code for this machine");
        group.throughput(Throughput::Elements(u64::from(rungs)));
        let engines: [(&str, Box<dyn Scan>); 3] = [
            ("jit", Box::new(jit)),
            ("interpreter", Box::new(Interpreter::new(&program))),
            ("textbook", Box::new(Textbook::new(&program))),
        ];
        for (name, mut engine) in engines {
            let mut image = program.layout.initial_image();
            let mut rng = Pcg64::seed_from_u64(1);
            let mut now = 0;
            group.bench_function(format!("{name}/{rungs}"), |bencher| {
                bencher.iter_custom(|iterations| {
                    let mut spent = Duration::ZERO;
                    // Eight scans for each change of inputs, so that reading the clock does not count.
                    for _ in 0..iterations.div_ceil(8) {
                        for _ in 0..inputs.len().div_ceil(10) {
                            image[rng.random_range(inputs.clone())] ^= 1;
                        }
                        let begin = Instant::now();
                        for _ in 0..8 {
                            now += 1_000_000;
                            engine.scan(black_box(&mut image), now);
                        }
                        spent += begin.elapsed();
                    }
                    spent.mul_f64(iterations as f64 / (8 * iterations.div_ceil(8)) as f64)
                });
            });
        }
    }
    group.finish();
}

criterion_group!(benches, scans);
criterion_main!(benches);
