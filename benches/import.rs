//! How long it takes to read and check a program in each format, from the files in `benches/inputs` and what other formats the
//! project writes of them.

#[path = "support/inputs.rs"]
mod inputs;

use std::hint::black_box;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use inputs::{INPUTS, text};
use rung::frontend::{native, plcopen, structured_text};
use rung::load::Loaded;

fn imports(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("import");
    group.sample_size(10);
    for rungs in INPUTS {
        let program = Loaded::decode("input", text(rungs)).program;
        let formats = [
            ("native", native::print(&program)),
            ("plcopen", plcopen::print(&program).expect("what a drawing holds")),
            ("structured text", structured_text::print(&program).expect("what statements say")),
        ];
        for (format, text) in formats {
            group.throughput(Throughput::Bytes(text.len() as u64));
            group.bench_function(format!("{format}/{rungs}"), |bencher| {
                bencher.iter(|| {
                    let mut loaded = Loaded::decode("input", black_box(text.as_bytes()));
                    loaded.check().expect("no errors")
                });
            });
        }
    }
    group.finish();
}

criterion_group!(benches, imports);
criterion_main!(benches);
