//! What a rung costs both interpreters: `cargo bench --bench interp`.
//!
//! Random rungs, each of one to three branches of one to five contacts, an on-delay timer to every sixth, references
//! uniform over all variables; a tenth of the inputs flips every scan.

use std::hint::black_box;

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;
use rung::elementary::{Elementary, Value};
use rung::engine::interp::{Interpreter, Textbook};
use rung::logic::image::LayoutBuilder;
use rung::logic::{Area, Binary, Builder, Compare, Origin, Program, Slot, SlotId, verify};
use rung_runtime::Scan;

/// Rungs with their timers, in logic.
fn program(rungs: u32, seed: u64) -> Program {
    let mut rng = Pcg64::seed_from_u64(seed);
    let mut layout = LayoutBuilder::new();
    let mut slot = |name: String, ty, area| {
        layout.slot(Slot { name, ty, offset: 0, area, retain: false, initial: Value::default_of(ty), line: 0 })
    };
    let inputs = (rungs / 2).max(4);
    let mut readable: Vec<SlotId> =
        (0..inputs).map(|index| slot(format!("i{index}"), Elementary::Bool, Area::Input)).collect();
    let coils: Vec<SlotId> = (0..rungs)
        .map(|index| {
            slot(format!("c{index}"), Elementary::Bool, if index % 4 == 0 { Area::Output } else { Area::Memory })
        })
        .collect();
    let timers: Vec<[SlotId; 4]> = (0..rungs / 6)
        .map(|index| {
            [
                slot(format!("t{index}.running"), Elementary::Bool, Area::State),
                slot(format!("t{index}.Q"), Elementary::Bool, Area::State),
                slot(format!("t{index}.start"), Elementary::Time, Area::State),
                slot(format!("t{index}.ET"), Elementary::Time, Area::State),
            ]
        })
        .collect();
    readable.extend(&coils);
    readable.extend(timers.iter().map(|timer| timer[1]));
    let layout = layout.finish(None).expect("the image is small");
    let mut builder = Builder::new("synthetic", layout);
    for (index, coil) in coils.into_iter().enumerate() {
        let mut power = builder.bool(false);
        for _ in 0..rng.random_range(1..=3) {
            let mut branch = builder.bool(true);
            for _ in 0..rng.random_range(1..=5) {
                let mut contact = builder.load(readable[rng.random_range(0..readable.len())]);
                if rng.random_bool(0.3) {
                    contact = builder.not(contact);
                }
                branch = builder.and(branch, contact);
            }
            power = builder.or(power, branch);
        }
        if index % 6 == 5 {
            let [running, done, start, elapsed] = timers[index / 6];
            let preset = builder.constant(Value::time(rng.random_range(1..1000) * 1_000_000));
            let (now, was_running, started) = (builder.now(), builder.load(running), builder.load(start));
            let zero = builder.constant(Value::time(0));
            let begun = builder.select(was_running, started, now);
            let since = builder.binary(Binary::Subtract, now, begun);
            let limited = builder.binary(Binary::Minimum, since, preset);
            let shown = builder.select(power, limited, zero);
            let over = builder.compare(Compare::GreaterOrEqual, since, preset);
            let output = builder.and(power, over);
            builder.store(start, begun);
            builder.store(running, power);
            builder.store(elapsed, shown);
            builder.store(done, output);
            power = output;
        }
        builder.store(coil, power);
        builder.end_section(Origin { label: format!("r{index}"), line: 0 });
    }
    let program = builder.finish();
    assert_eq!(verify(&program), Ok(()));
    program
}

fn scans(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("scan");
    for rungs in [18, 1451, 20_000] {
        let program = program(rungs, 1);
        let mut interpreter = Interpreter::new(&program);
        group.throughput(Throughput::Elements(u64::from(rungs)));
        group.bench_function(BenchmarkId::new("textbook", rungs), |bencher| {
            let (mut textbook, mut plant) = (Textbook::new(&program), Plant::new(&program));
            bencher.iter(|| plant.scan(&mut textbook));
        });
        group.bench_function(BenchmarkId::new("compact", rungs), |bencher| {
            let mut plant = Plant::new(&program);
            bencher.iter(|| plant.scan(&mut interpreter));
        });
        group.bench_function(BenchmarkId::new("translate", rungs), |bencher| {
            bencher.iter(|| black_box(Interpreter::new(&program)).code_bytes());
        });
    }
    group.finish();
}

/// An image whose inputs change.
struct Plant {
    image: Vec<u8>,
    inputs: usize,
    at: usize,
    now: i64,
}

impl Plant {
    fn new(program: &Program) -> Self {
        let inputs = program.layout.inputs()[0].bools.end as usize;
        Self { image: program.layout.initial_image(), inputs, at: 0, now: 0 }
    }

    fn scan(&mut self, engine: &mut impl Scan) {
        for _ in 0..self.inputs.div_ceil(10) {
            // A stride that meets all inputs in an order without a pattern.
            self.at = (self.at + 7919) % self.inputs;
            self.image[self.at] ^= 1;
        }
        self.now += 10_000_000;
        engine.scan(black_box(&mut self.image), self.now);
    }
}

criterion_group!(benches, scans);
criterion_main!(benches);
