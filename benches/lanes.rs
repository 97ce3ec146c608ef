//! Scans of many plants at once, against those of one: nanoseconds for a scan of one lane, on one core, with a tenth of
//! the inputs of each lane changing before every scan. Making and setting the inputs is not measured.
//!
//! First a table, in which the two take turns so that whatever else the machine does hits both; then the same for
//! criterion to keep.
#![expect(clippy::print_stderr, reason = "the ratios are reported beside the times")]

#[path = "support/workload.rs"]
mod workload;

use std::hint::black_box;
use std::time::{Duration, Instant};

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;
use rung::batch::{Batch, Variable};
use rung::engine::jit::Jit;
use rung::logic::{Area, Program};
use rung::opt;
use rung_runtime::Scan;
use workload::workload;

/// Time from one scan to the next, in nanoseconds.
const CYCLE: i64 = 10_000_000;

/// Turns of which the table has the medians, and scans of a turn.
const TURNS: usize = 41;
const SCANS: u64 = 200;

/// One plant on the JIT.
struct One {
    jit: Jit,
    image: Vec<u8>,
    inputs: std::ops::Range<usize>,
    rng: Pcg64,
    now: i64,
}

impl One {
    fn new(program: &Program) -> Self {
        let bytes = &program.layout.inputs()[0].bytes;
        let (jit, image) = (Jit::compile(program).expect("code for this machine"), program.layout.initial_image());
        let inputs = bytes.start as usize..bytes.end as usize;
        Self { jit, image, inputs, rng: Pcg64::seed_from_u64(1), now: 0 }
    }

    fn run(&mut self, scans: u64) -> Duration {
        let mut spent = Duration::ZERO;
        for _ in 0..scans {
            for _ in 0..self.inputs.len().div_ceil(10) {
                self.image[self.rng.random_range(self.inputs.clone())] ^= 1;
            }
            let begin = Instant::now();
            self.jit.scan(black_box(&mut self.image), self.now);
            spent += begin.elapsed();
            self.now += CYCLE;
        }
        spent
    }
}

/// Many plants, in parts that one core runs one after the other.
struct Many {
    batch: Batch,
    inputs: Vec<Variable>,
    rng: Pcg64,
    now: i64,
}

impl Many {
    fn new(program: &Program, lanes: usize) -> Self {
        let batch = Batch::new(program, lanes).expect("a small image");
        let is_input = |slot: &usize| program.layout.slots()[*slot].area == Area::Input;
        let names = program.layout.observed().iter().filter(|observed| is_input(&observed.slot.index()));
        let inputs = names.map(|observed| batch.variable(&observed.name).expect("a variable")).collect();
        Self { batch, inputs, rng: Pcg64::seed_from_u64(1), now: 0 }
    }

    fn run(&mut self, scans: u64) -> Duration {
        let mut spent = Duration::ZERO;
        for _ in 0..scans {
            for word in 0..self.batch.words() {
                for input in &self.inputs {
                    // A tenth of the lanes: 13 of 128.
                    let flips = (0..7).fold(0u128, |less, bit| {
                        let random: u128 = self.rng.random();
                        if 13 >> bit & 1 != 0 { less | !random } else { less & !random }
                    });
                    let old = self.batch.word(word, *input).expect("a word");
                    self.batch.set_word(word, *input, old ^ flips).expect("a BOOL");
                }
            }
            let begin = Instant::now();
            for index in 0..self.batch.parts() {
                self.batch.part(index).scan(black_box(self.now));
            }
            spent += begin.elapsed();
            self.now += CYCLE;
        }
        spent
    }

    fn lanes(&self) -> u64 {
        self.batch.lanes() as u64
    }
}

fn median(mut measured: Vec<f64>) -> f64 {
    measured.sort_by(f64::total_cmp);
    measured[measured.len() / 2]
}

fn ratios() {
    eprintln!("rungs  timers  scalar ns  lanes  ns per lane and scan  ratio  ratio of minima");
    for rungs in [18, 1451, 20_000_u32] {
        let program = opt::optimise(workload(rungs));
        let scans = if rungs > 10_000 { SCANS / 10 } else { SCANS };
        for lanes in [128, 512, 2048] {
            let (mut one, mut many) = (One::new(&program), Many::new(&program, lanes));
            let (mut scalar, mut measured) = (Vec::new(), Vec::new());
            let turn = (scans * 128).div_ceil(lanes as u64).max(16);
            // Until presets are past, so that timers do all that they do.
            many.run(if rungs > 10_000 { 60 } else { 250 });
            one.run(250);
            for _ in 0..TURNS {
                scalar.push(one.run(scans).as_nanos() as f64 / scans as f64);
                let spent = many.run(turn).as_nanos() as f64;
                measured.push(spent / turn as f64 / many.lanes() as f64);
            }
            let least = |measured: &[f64]| measured.iter().copied().fold(f64::INFINITY, f64::min);
            let minima = least(&scalar) / least(&measured);
            let (scalar, each) = (median(scalar), median(measured));
            eprintln!(
                "{rungs:>5}  {:>6}  {scalar:>9.1}  {:>5}  {each:>20.2}  {:>5.1}  {minima:>15.1}",
                rungs / 6,
                many.lanes(),
                scalar / each
            );
        }
    }
}

fn scans(criterion: &mut Criterion) {
    ratios();
    let mut group = criterion.benchmark_group("lanes");
    group.sample_size(10);
    for rungs in [18, 1451, 20_000_u32] {
        let program = opt::optimise(workload(rungs));
        let (mut one, mut many) = (One::new(&program), Many::new(&program, 512));
        group.throughput(Throughput::Elements(1));
        group.bench_function(format!("scalar/{rungs}"), |bencher| bencher.iter_custom(|scans| one.run(scans)));
        group.throughput(Throughput::Elements(many.lanes()));
        group.bench_function(format!("512 lanes/{rungs}"), |bencher| bencher.iter_custom(|scans| many.run(scans)));
    }
    group.finish();
}

criterion_group!(benches, scans);
criterion_main!(benches);
