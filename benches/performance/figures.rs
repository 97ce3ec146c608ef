//! Figures of which there is one each: the whole way from a file, an edit, a scan that changes nothing, the one function that
//! takes gcc longest.

use std::fmt::Write as _;
use std::hint::black_box;
use std::path::Path;
use std::time::Instant;

use rung::engine::elide::Elided;
use rung::engine::jit::{Edited, Jit};
use rung::logic::Program;
use rung::source::Source;
use rung::{check, frontend, lower, opt};
use rung_runtime::Scan;

use crate::edit::{edited_at, lowered_anew};
use crate::{Plan, generated, median, rung};

pub(crate) struct Figures {
    pub(crate) way_rungs: u32,
    /// From a PLCopen file to a trace of the first scan, the whole process, in milliseconds, and the file's bytes.
    pub(crate) first_scan: f64,
    pub(crate) file_bytes: u64,
    pub(crate) edited_rungs: u32,
    /// Compiling all, and one changed section, in milliseconds.
    pub(crate) full: f64,
    pub(crate) edit: f64,
    /// A scan that changes nothing, in nanoseconds: run; left out by whoever writes nothing but inputs, as the scan loop; and
    /// left out where anything may have been written.
    pub(crate) idle: [f64; 3],
}

pub(crate) fn measure(plan: &Plan, folder: &Path) -> Figures {
    let (first_scan, file_bytes) = first_scan(plan, folder);
    let (full, edit) = edit(plan, folder);
    let idle = idle(plan);
    Figures { way_rungs: plan.way, first_scan, file_bytes, edited_rungs: plan.edited, full, edit, idle }
}

fn first_scan(plan: &Plan, folder: &Path) -> (f64, u64) {
    let (native, xml, trace) =
        (generated(folder, plan.way, plan.way / 6), folder.join("way.xml"), folder.join("way.csv"));
    let status = rung().arg("convert").arg(native).args(["--to", "plcopen", "-o"]).arg(&xml).status();
    assert!(status.expect("the command runs").success());
    let once = || {
        let mut command = rung();
        command.arg("sim").arg(&xml).args(["--scans", "1", "--trace"]).arg(&trace);
        let start = Instant::now();
        assert!(command.status().expect("the command runs").success());
        start.elapsed().as_secs_f64() * 1e3
    };
    (median((0..plan.runs).map(|_| once()).collect()), std::fs::metadata(&xml).expect("written").len())
}

/// A program in its file, as text and lowered.
fn lowered(text: String) -> Program {
    let source = Source::new("measured", text);
    let parsed = frontend::parse(&source);
    let checked = check::check(&parsed.program).0.expect("no errors");
    lower::lower(&checked, &source, None).expect("a small image")
}

fn edit(plan: &Plan, folder: &Path) -> (f64, f64) {
    let path = generated(folder, plan.edited, plan.edited / 6);
    let lowered = lowered(std::fs::read_to_string(path).expect("written"));
    let program = opt::optimise(lowered.clone());
    let changed = edited_at(program.clone(), program.sections.len() / 2);
    let full = (0..plan.runs).map(|_| {
        let lowered = lowered.clone();
        let start = Instant::now();
        black_box(Edited::compile(opt::optimise(lowered)).expect("code for this machine"));
        start.elapsed().as_secs_f64() * 1e3
    });
    let full = median(full.collect());
    let mut edited = Edited::compile(program.clone()).expect("code for this machine");
    let edits = (0..plan.runs * 5).map(|number| {
        let next = lowered_anew(if number % 2 == 0 { &changed } else { &program });
        let start = Instant::now();
        let update = edited.update(black_box(next)).expect("code for this machine");
        let time = start.elapsed().as_secs_f64() * 1e3;
        assert!(update.compiled <= 1, "{update:?}");
        time
    });
    (full, median(edits.collect()))
}

/// A program that comes to rest: each rung reads inputs and the coils of rungs before it, and one in six has a timer.
fn at_rest(rungs: u32) -> String {
    let mut text = "program at_rest\n".to_owned();
    let names = |rungs: &mut dyn Iterator<Item = u32>, what: &str| {
        rungs.map(|rung| what.replace('#', &rung.to_string())).collect::<String>()
    };
    text.push_str(&names(&mut (0..rungs.div_ceil(3)), "input i#\n"));
    text.push_str(&names(&mut (0..rungs), "var m# : BOOL\n"));
    text.push_str(&names(&mut (0..rungs).step_by(6), "var t# : TON\n"));
    let inputs = rungs.div_ceil(3);
    for rung in 0..rungs {
        let input = |factor: u32| rung.wrapping_mul(factor) % inputs;
        let coil =
            |factor: u32| if rung == 0 { "i0".to_owned() } else { format!("m{}", rung.wrapping_mul(factor) % rung) };
        let timer = if rung % 6 == 0 { format!("t{rung}:TON(PT := T#100ms) ") } else { String::new() };
        let _ = writeln!(
            text,
            "\nrung r{rung}\n  [ i{} /{} {} | /i{} {} /{} ] {timer}(m{rung})",
            input(1),
            coil(7),
            coil(13),
            input(5),
            coil(11),
            coil(3)
        );
    }
    text
}

/// A scan of a program that is at rest, run and left out, see [`Figures::idle`]. They take turns.
fn idle(plan: &Plan) -> [f64; 3] {
    let program = opt::optimise(lowered(at_rest(plan.way)));
    let jit = || Jit::compile(&program).expect("code for this machine");
    let mut run = jit();
    let [mut by_loop, mut by_anyone] = [(); 2].map(|()| Elided::new(jit(), &program));
    let mut images = [(); 3].map(|()| program.layout.initial_image());
    let mut now = 0;
    let mut turn = |scans: i64| {
        let [image, of_loop, of_anyone] = &mut images;
        let times = now..now + scans;
        now += scans;
        let timed = |scan: &mut dyn FnMut(i64)| {
            let start = Instant::now();
            times.clone().for_each(|number| scan(number * 1_000_000));
            start.elapsed().as_secs_f64() * 1e9 / scans as f64
        };
        [
            timed(&mut |now| run.scan(black_box(image), now)),
            timed(&mut |now| by_loop.scan_inputs(black_box(of_loop), now)),
            timed(&mut |now| by_anyone.scan(black_box(of_anyone), now)),
        ]
    };
    // Until all timers have run out, and the program was found to be at rest.
    for _ in 0..40 {
        turn(100);
    }
    let times: Vec<[f64; 3]> = (0..41).map(|_| turn(100)).collect();
    for elided in [&by_loop, &by_anyone] {
        assert!(elided.left_out() >= 41 * 100, "the program is not at rest: {} scans were left out", elided.left_out());
    }
    std::array::from_fn(|which| median(times.iter().map(|times| times[which]).collect()))
}
