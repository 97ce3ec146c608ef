//! The page of the manual.

use std::fmt::Write as _;

use crate::engines::Engines;
use crate::figures::Figures;
use crate::scaling::Size;
use crate::spread::Spread;

pub(crate) fn page(engines: &Engines, sizes: &[Size], figures: &Figures, spread: &[Spread]) -> String {
    let mut page = format!("{HEAD}\n{}\n\n## A scan\n\n```\n{}```\n\n{SCAN}", machine(), engines.table);
    ratios(&mut page, engines);
    page.push_str(SCALING);
    for size in sizes {
        let rungs = f64::from(size.rungs);
        let _ = writeln!(
            page,
            "| {} | {:.2} | {:.2} | {:.2} | {:.2} | {:.2} | {:.1} | {:.2} | {:.1} | {:.1} |",
            size.rungs,
            size.check,
            size.lower,
            size.optimise,
            size.compile,
            (size.check + size.lower + size.optimise + size.compile) * 1e3 / rungs,
            size.scan_nanoseconds,
            size.scan_nanoseconds / rungs,
            size.code_bytes as f64 / rungs,
            size.peak as f64 / rungs,
        );
    }
    let [run, by_loop, by_anyone] = figures.idle;
    let _ = write!(
        page,
        "\n![Nanoseconds a rung by the size of the program](performance/scaling.svg)\n\n## From a drawing to code\n\n\
         - From a PLCopen file of {} rungs ({:.1} MB) to the trace of its first scan, the whole process of `rung sim`: \
         **{:.0} ms**.\n\
         - After a change of one rung of {}, from the changed section to installed code: **{:.2} ms**, 1/{:.0} of the \
         {:.1} ms that passes and compiler take for all of them. Every chunk is compared; the one that differs is compiled.\n\n\
         ## When nothing happens\n\n\
         With `--elide`, a scan that changes nothing is left out. At {} rungs with timers, all of them at rest, a scan that is run takes \
         {:.1} ns, and one that the scan loop leaves out **{:.1} ns**, 1/{:.0} of it: it compares the inputs. Where anything else may \
         have been written from outside, the whole image is compared: {:.1} ns, 1/{:.0}.\n\n## Constant time\n\n{SPREAD}",
        figures.way_rungs,
        figures.file_bytes as f64 / 1e6,
        figures.first_scan,
        figures.edited_rungs,
        figures.edit,
        figures.full / figures.edit,
        figures.full,
        figures.way_rungs,
        run,
        by_loop,
        run / by_loop,
        by_anyone,
        run / by_anyone,
    );
    for spread in spread {
        let images: usize = spread.counts.values().sum();
        let counts: Vec<String> = spread.counts.iter().map(|(count, images)| format!("{count} on {images}")).collect();
        let _ = writeln!(page, "- {} rungs, {images} images: {} instructions.", spread.rungs, counts.join(", "));
    }
    page.push_str(LIMITS);
    page
}

/// What it was measured on.
fn machine() -> String {
    let cpus = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let model = cpus.lines().find_map(|line| line.strip_prefix("model name")).unwrap_or(": unknown");
    let cores = std::thread::available_parallelism().map_or(1, std::num::NonZero::get);
    let cache = |index: usize| {
        let read = |what: &str| {
            let path = format!("/sys/devices/system/cpu/cpu0/cache/index{index}/{what}");
            std::fs::read_to_string(path).ok().map(|text| text.trim().to_owned())
        };
        Some(format!("L{} {} {}", read("level")?, read("type")?.to_lowercase(), read("size")?))
    };
    let caches: Vec<String> = (0..8).map_while(cache).collect();
    let caches = if caches.is_empty() { String::new() } else { format!("; caches: {}", caches.join(", ")) };
    format!("Measured on {} with {cores} cores{caches}.", model.trim_start_matches(['\t', ' ', ':']))
}

/// Time and compile time beside the C compilers.
fn ratios(page: &mut String, engines: &Engines) {
    page.push_str("\n| rungs | beside | time of a scan | instructions | compile time |\n|---|---|---|---|---|\n");
    for rungs in [18, 1451, 20_000] {
        for engine in ["gcc-c", "gcc-equations", "clang-c", "clang-equations"] {
            let ratio = |what: &str| Some(engines.value(rungs, "jit", what)? / engines.value(rungs, engine, what)?);
            let show = |ratio: Option<f64>| ratio.map_or_else(|| "-".to_owned(), |ratio| format!("{ratio:.2}"));
            let compile =
                ratio("compile_milliseconds").map_or_else(|| "-".to_owned(), |ratio| format!("1/{:.0}", 1.0 / ratio));
            if engines.value(rungs, engine, "nanoseconds_a_scan").is_some() {
                let (time, instructions) = (show(ratio("nanoseconds_a_scan")), show(ratio("instructions_a_scan")));
                let _ = writeln!(page, "| {rungs} | {engine} | {time} | {instructions} | {compile} |");
            }
        }
    }
}

const HEAD: &str = "\
# How fast

This page is written by `cargo bench --features all-targets --bench performance`: every figure on it was measured in that
run, and no other. Times are medians of turns that the subjects take one after another, so that what else the machine does
hits all of them; on a shared machine read the ratios. `rung bench FILE` measures the same of your own program.
";

const SCAN: &str = "\
![Nanoseconds a scan of each engine](performance/scan.svg)

`jit` is Rung's own code, `interp` its interpreter, `textbook` one that takes one operation after another in a `match`.
`gcc-c` and `clang-c` are these compilers at `-O2` on the C that Rung emits, which its passes have simplified already;
`gcc-equations` and `clang-equations` get the program as it was drawn, as equations over variables at fixed addresses, 64 rungs a
function. The inputs change at random, a tenth of them every 16 scans, which counts as time of the scans; these follow each other
without a pause. Before anything is measured, all of them have left the same image. Compile time starts from the lowered program, for Rung with all of
its passes on all cores; bytes are of machine code, and for interpreters of what they have in its place. Instructions are
executed ones: static for Rung, whose code is a straight line, counted by callgrind for the others.

What is below 1 is Rung's favour:
";

const SCALING: &str = "
## From 18 to a million rungs

Synthetic programs with a timer per six rungs and contacts that refer to anything. Times are in milliseconds, one run each; a
scan is in nanoseconds, the median of 41 turns. The peak of memory is of the whole process, with the command's allocator: it makes
the drawing and checks it, drops the drawing, lowers what was checked, drops that too, runs the passes and compiles.

| rungs | check | lower | passes | compile | \u{b5}s a rung, all | scan | ns a rung | bytes a rung | KiB a rung, peak |
|---|---|---|---|---|---|---|---|---|---|
";

const SPREAD: &str = "\
Callgrind counts the instructions of single scans of the object file that `rung build` writes, on random images, on one of all 0
and one of all 1:

";

const LIMITS: &str = "
What may take longer: a loop over the elements of a long array (`docs/machine-code.md` has the bounds), the functions of the real
numbers, and a task that is not due, which is left out whole. `--elide` gives constant time up.

## What limits it

Counters that tell how many instructions a cycle finishes were not at hand; what can be read off the tables is this.

- Instructions a rung are nearly the same at all sizes, and time a rung is not: large programs wait for their code.
- At 18 rungs scans follow each other at once, and a coil that the next scan reads comes back through memory.
- Bytes a rung times rungs is the code, which a scan fetches once, beside the image. Where that passes a level of the cache, as
  told at the top of this page, nanoseconds a rung rise, though code that is too large for the second level is asked for a chunk
  before it runs, and lies in large pages where the system has them.
";
