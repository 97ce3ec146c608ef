//! All figures of `docs/performance.md`, and the page itself.
//!
//! `cargo bench --bench performance` measures, for several minutes, and writes `docs/performance.md` with its charts; run as
//! a test it does the same on small programs into a temporary folder. Nothing is written but what was measured in that run.
#![expect(clippy::print_stderr, reason = "it takes minutes, and says what it is at")]

#[path = "../support/edit.rs"]
mod edit;
mod engines;
mod figures;
mod page;
mod scaling;
mod spread;

use std::path::{Path, PathBuf};

/// The allocator of the command, whose times and memory the page tells.
#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;

/// How much is measured.
struct Plan {
    /// Rungs and timers of the programs that every engine and compiler runs.
    sizes: &'static [(u32, u32)],
    /// Rungs of the programs of which only Rung's own figures are taken.
    scaling: &'static [u32],
    /// Rungs of the program whose whole way, edits and idle scans are measured, and of the one that is edited.
    way: u32,
    edited: u32,
    /// Images on which the executed instructions are counted.
    images: usize,
    /// Scans of exactly so many instead of as many as measuring takes.
    scans: Option<&'static str>,
    /// Runs that medians are taken of.
    runs: usize,
    /// How long a C compiler may take.
    patience: &'static str,
}

const MEASURED: Plan = Plan {
    sizes: &[(18, 3), (1451, 246), (20_000, 3333)],
    scaling: &[18, 100, 1000, 10_000, 100_000, 1_000_000],
    way: 1451,
    edited: 20_000,
    images: 1000,
    scans: None,
    runs: 9,
    patience: "10m",
};

const TRIED: Plan = Plan {
    sizes: &[(18, 3)],
    scaling: &[18, 100],
    way: 18,
    edited: 300,
    images: 3,
    scans: Some("16"),
    runs: 1,
    patience: "1m",
};

fn main() {
    let arguments: Vec<String> = std::env::args().collect();
    if let [_, command, rungs] = arguments.as_slice()
        && command == scaling::CHILD
    {
        return scaling::child(rungs.parse().expect("a number of rungs"));
    }
    let measures = arguments.iter().any(|argument| argument == "--bench");
    let plan = if measures { MEASURED } else { TRIED };
    let scratch = tempfile::tempdir().expect("a temporary folder");
    let docs = if measures { Path::new(env!("CARGO_MANIFEST_DIR")).join("docs") } else { scratch.path().join("docs") };
    std::fs::create_dir_all(docs.join("performance")).expect("a folder for the charts");

    eprintln!("engines and compilers");
    let engines = engines::measure(&plan, scratch.path(), &docs.join("performance/scan.svg"));
    eprintln!("from 18 rungs to many");
    let sizes: Vec<scaling::Size> = plan.scaling.iter().map(|rungs| scaling::measure(*rungs)).collect();
    scaling::draw(&sizes, &docs.join("performance/scaling.svg"));
    eprintln!("single figures");
    let figures = figures::measure(&plan, scratch.path());
    eprintln!("instructions on random images");
    let spread = spread::measure(&plan, scratch.path());
    write(&docs.join("performance.md"), &page::page(&engines, &sizes, &figures, &spread));
}

/// Writes a file whole.
fn write(path: &Path, text: &str) {
    let unfinished = path.with_extension("unfinished");
    std::fs::write(&unfinished, text).and_then(|()| std::fs::rename(&unfinished, path)).expect("a writable folder");
}

/// The command, as this bench was built with it.
fn rung() -> std::process::Command {
    std::process::Command::new(env!("CARGO_BIN_EXE_rung"))
}

/// A synthetic program as a file.
fn generated(folder: &Path, rungs: u32, timers: u32) -> PathBuf {
    let path = folder.join(format!("{rungs}.rung"));
    let status =
        rung().args(["gen", "--rungs", &rungs.to_string(), "--timers", &timers.to_string(), "-o"]).arg(&path).status();
    assert!(status.expect("the command runs").success());
    path
}

/// The middle one.
fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}
