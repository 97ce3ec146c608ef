//! The interpreters: how long one takes to make, and how long a scan takes while inputs change and while they rest.

#[path = "support/inputs.rs"]
mod inputs;

use std::hint::black_box;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use inputs::{INPUTS, text};
use rung::engine::interp::{Interpreter, Textbook};
use rung::load::Loaded;
use rung::{lower, opt};
use rung_runtime::Scan;

/// From one scan to the next, in nanoseconds.
const CYCLE: i64 = 1_000_000;

fn interpreters(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("interp");
    group.sample_size(20);
    for rungs in INPUTS {
        let mut loaded = Loaded::decode("input", text(rungs));
        let checked = loaded.check().expect("no errors");
        let program = opt::optimise(lower::lower(&checked, &loaded.source, None).expect("a small image"));
        group.throughput(Throughput::Elements(u64::from(rungs)));
        group.bench_function(format!("make/{rungs}"), |bencher| bencher.iter(|| Interpreter::new(black_box(&program))));
        let engines: [(&str, Box<dyn Scan>); 2] =
            [("gates", Box::new(Interpreter::new(&program))), ("textbook", Box::new(Textbook::new(&program)))];
        let bytes = &program.layout.inputs()[0].bytes;
        let inputs = bytes.start as usize..bytes.end as usize;
        for (name, mut engine) in engines {
            for (what, every) in [("resting", usize::MAX), ("changing", 10)] {
                let (mut image, mut now, mut turn) = (program.layout.initial_image(), 0, 0);
                group.bench_function(format!("{name}/{what}/{rungs}"), |bencher| {
                    bencher.iter(|| {
                        turn = (turn + 1) % 10;
                        for input in inputs.clone().skip(turn).step_by(every).filter(|_| every < usize::MAX) {
                            image[input] ^= 1;
                        }
                        engine.scan(black_box(&mut image), now);
                        now += CYCLE;
                    });
                });
            }
        }
    }
    group.finish();
}

criterion_group!(benches, interpreters);
criterion_main!(benches);
