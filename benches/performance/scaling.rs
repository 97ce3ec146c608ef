//! How each phase, the scan and the memory grow with the size of the program. Each size runs in a process of its own, so
//! that its peak of memory is its own.

use std::hint::black_box;
use std::path::Path;
use std::time::Instant;

use plotters::prelude::*;
use rung::engine::jit::Jit;
use rung::generate::{Options, generate};
use rung::source::Source;
use rung::{check, lower, opt};
use rung_runtime::Scan;
use serde::{Deserialize, Serialize};

use crate::median;

/// What a process is called with that measures one size.
pub(crate) const CHILD: &str = "--size";

/// What one size takes. Times are in milliseconds but for the scan's, memory is in KiB.
#[derive(Serialize, Deserialize)]
pub(crate) struct Size {
    pub(crate) rungs: u32,
    pub(crate) check: f64,
    pub(crate) lower: f64,
    pub(crate) optimise: f64,
    pub(crate) compile: f64,
    pub(crate) scan_nanoseconds: f64,
    pub(crate) code_bytes: usize,
    /// The most memory before anything was lowered: what the drawing itself takes.
    pub(crate) drawing: u64,
    pub(crate) peak: u64,
}

pub(crate) fn measure(rungs: u32) -> Size {
    let this = std::env::current_exe().expect("this program");
    let output = std::process::Command::new(this).args([CHILD, &rungs.to_string()]).output().expect("it runs");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice(&output.stdout).expect("what `child` writes")
}

/// Measures one size, and prints it.
#[expect(clippy::print_stdout, reason = "to the process that asked")]
pub(crate) fn child(rungs: u32) {
    let timed = |start: Instant| start.elapsed().as_secs_f64() * 1e3;
    let program = generate(&Options { rungs, timers: rungs / 6, ..Options::default() }).expect("options that fit");
    let drawing = peak();
    let start = Instant::now();
    let checked = check::check(&program).0.expect("no errors");
    let check = timed(start);
    drop(program);
    let start = Instant::now();
    let lowered = lower::lower(&checked, &Source::new("synthetic", ""), None).expect("a small image");
    let lower = timed(start);
    drop(checked);
    let start = Instant::now();
    let optimised = opt::optimise(lowered);
    let optimise = timed(start);
    let start = Instant::now();
    let mut jit = Jit::compile(&optimised).expect("code for this machine");
    let compile = timed(start);
    let peak = peak();
    let mut image = optimised.layout.initial_image();
    let inputs = &optimised.layout.inputs()[0].bytes;
    let inputs = inputs.start as usize..inputs.end as usize;
    let (mut now, mut turns) = (0, 0);
    let mut turn = |scans: usize| {
        // One input of ten changes, a different one each time.
        turns += 1;
        for input in inputs.clone().skip(turns % 10).step_by(10) {
            image[input] ^= 1;
        }
        let start = Instant::now();
        for _ in 0..scans {
            jit.scan(black_box(&mut image), now);
            now += 1_000_000;
        }
        start.elapsed().as_secs_f64() * 1e9 / scans as f64
    };
    let scans = (20_000 / rungs as usize).clamp(1, 256);
    turn(scans);
    let scan_nanoseconds = median((0..41).map(|_| turn(scans)).collect());
    let code_bytes = jit.code_bytes();
    let size = Size { rungs, check, lower, optimise, compile, scan_nanoseconds, code_bytes, drawing, peak };
    println!("{}", serde_json::to_string(&size).expect("numbers"));
}

/// The most memory that this process had so far, in KiB; 0 where the system does not tell.
fn peak() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    line.and_then(|line| line.trim().trim_end_matches(" kB").parse().ok()).unwrap_or(0)
}

/// Nanoseconds a rung, of a scan and of all that is done to compile, by size.
pub(crate) fn draw(sizes: &[Size], path: &Path) {
    let a_rung = |size: &Size, nanoseconds: f64| (f64::from(size.rungs), nanoseconds / f64::from(size.rungs));
    let scans: Vec<_> = sizes.iter().map(|size| a_rung(size, size.scan_nanoseconds)).collect();
    let compiles: Vec<_> =
        sizes.iter().map(|size| a_rung(size, (size.check + size.lower + size.optimise + size.compile) * 1e6)).collect();
    let mut text = String::new();
    {
        let area = SVGBackend::with_string(&mut text, (860, 420)).into_drawing_area();
        area.fill(&WHITE).expect("a string takes all");
        let most = sizes.iter().map(|size| f64::from(size.rungs)).fold(100.0, f64::max);
        let mut chart = ChartBuilder::on(&area)
            .caption("nanoseconds a rung, by the size of the program", ("sans-serif", 18))
            .margin(12)
            .x_label_area_size(34)
            .y_label_area_size(70)
            .build_cartesian_2d((10.0..most * 2.0).log_scale(), (0.1..1e7).log_scale())
            .expect("room for a chart");
        chart.configure_mesh().x_desc("rungs").light_line_style(TRANSPARENT).draw().expect("a mesh");
        for (name, points, colour) in
            [("to compile", compiles, RGBColor(0x8A, 0x93, 0x9E)), ("to scan", scans, RGBColor(0x1B, 0x7F, 0x5C))]
        {
            chart
                .draw_series(LineSeries::new(points, colour.stroke_width(2)).point_size(4))
                .expect("a line")
                .label(name)
                .legend(move |(x, y)| PathElement::new([(x, y), (x + 18, y)], colour.stroke_width(2)));
        }
        chart.configure_series_labels().border_style(BLACK).background_style(WHITE).draw().expect("a legend");
        area.present().expect("a string takes all");
    }
    crate::write(path, &text);
}
