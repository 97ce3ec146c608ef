//! Files that strangers wrote, where they are there. Each is read and checked; what
//! checks runs the same on every engine, and comes back from every format that Rung writes.
//!
//! `cargo test --test agreement corpus -- --nocapture` prints the table.

use std::fmt::Write as _;
use std::path::Path;

use rung::check::{Checked, check};
use rung::diagnostic::{Code, Diagnostic, any_error};
use rung::engine::interp::Interpreter;
use rung::engine::jit::Jit;
use rung::frontend::{self, leave_out, native, plcopen, structured_text};
use rung::ladder::Program;
use rung::lower::lower;
use rung::opt;
use rung::source::Source;
use rung_runtime::Scan;

use crate::support::corpus;
use crate::support::random_stimuli::{Stimuli, observed};
use crate::support::rig::Rig;
use crate::support::same_trace::same_trace;

/// Scans on the engines, and those with the evaluator and of what was converted.
const SCANS: u64 = 1000;
const FEWER: u64 = 200;

/// Writes a program in one format.
pub(crate) type Writer = fn(&Program) -> Result<String, Vec<Diagnostic>>;

/// The formats that are written.
pub(crate) const WRITERS: [(&str, Writer); 3] =
    [("native", |program| Ok(native::print(program))), ("ST", structured_text::print), ("PLCopen", plcopen::print)];

#[test]
#[expect(clippy::print_stdout, reason = "the table is for whoever runs the test with --nocapture")]
fn files_of_the_corpus_run_alike_everywhere_and_come_back_from_every_format() {
    let Some(folder) = corpus::folder() else {
        println!("neither RUNG_CORPUS nor ../shared/corpus is a folder: the files of the corpus are not tested");
        return;
    };
    let mut files = Vec::new();
    for place in ["plcopen-ld", "openplc4-ld"] {
        let entries = std::fs::read_dir(folder.join(place)).expect("a folder of the corpus");
        files.extend(entries.map(|entry| entry.expect("a file of the corpus").path()));
    }
    files.sort();
    let mut table = String::new();
    let mut failures = String::new();
    for file in &files {
        let row = Row::of(file);
        let _ = writeln!(table, "{}", row.line);
        failures.push_str(&row.failures);
    }
    println!("{:55} {:>5}  what keeps it from running, or what was done with it\n{table}", "file", "rungs");
    assert!(failures.is_empty(), "{failures}");
}

/// What came of a file.
struct Row {
    line: String,
    failures: String,
}

impl Row {
    fn of(file: &Path) -> Self {
        let name = file.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let bytes = std::fs::read(file).expect("a file that can be read");
        let source = Source::decode(name.clone(), bytes).map_err(|undecoded| undecoded.1).expect("text");
        let mut parsed = frontend::parse(&source);
        let rungs = parsed.program.rungs().count();
        let mut said = parsed.diagnostics;
        said.extend(leave_out(&mut parsed.program));
        let (checked, more) = check(&parsed.program);
        said.extend(more);
        let mut failures = String::new();
        let (missing, errors): (Vec<&Diagnostic>, Vec<&Diagnostic>) =
            said.iter().filter(|problem| problem.is_error()).partition(|problem| problem.code == Code::NotSupported);
        let result = match checked {
            Some(checked) if errors.is_empty() => {
                let mut done: Vec<String> =
                    missing.iter().map(|problem| format!("without: {};", problem.message)).collect();
                match engines(&checked) {
                    Ok(()) => done.push("engines".to_owned()),
                    Err(problem) => failures = format!("{name}: {problem}\n"),
                }
                for (format, write) in WRITERS {
                    match comes_back(&parsed.program, &checked, write) {
                        Ok(()) => done.push(format.to_owned()),
                        Err(problem) => {
                            let _ = writeln!(failures, "{name}, {format}: {problem}");
                        }
                    }
                }
                done.join(" ")
            }
            _ => {
                let errors = missing.iter().chain(&errors).map(|problem| problem.message.clone());
                format!("error: {}", errors.collect::<Vec<_>>().join("; "))
            }
        };
        Self { line: format!("{name:55} {rungs:>5}  {result}"), failures }
    }
}

/// Compares the engines with each other, and for fewer scans with the evaluator.
fn engines(checked: &Checked) -> Result<(), String> {
    let plain = lower(checked, &Source::new("corpus", ""), None).map_err(|error| format!("{error:?}"))?;
    let optimised = opt::optimise(plain.clone());
    let mut interpreter = Interpreter::new(&plain);
    let mut jit = Jit::compile(&optimised).map_err(|error| error.to_string())?;
    let mut rig = Rig::new(checked)?;
    let mut images = [plain.layout.initial_image(), plain.layout.initial_image()];
    let mut stimuli = Stimuli::new(1, checked, &observed(&plain.layout));
    for scan in 0..SCANS {
        let (now, changes) = stimuli.next();
        for (name, value) in changes {
            let observed = plain.layout.observed().iter().find(|observed| observed.name.eq_ignore_ascii_case(&name));
            let slot = plain.layout.slot(observed.ok_or(format!("nothing is named {name}"))?.slot);
            images.iter_mut().for_each(|image| slot.write(image, value));
            rig.set(&name, value);
        }
        interpreter.scan(&mut images[0], now);
        jit.scan(&mut images[1], now);
        if images[0] != images[1] {
            return Err(format!("scan {scan}: interpreter and JIT differ"));
        }
        if scan < FEWER {
            rig.scan(now).map_err(|found| format!("scan {scan}: {} is\n{}", found.name, found.values))?;
        }
    }
    Ok(())
}

/// Writes a program, reads it again and compares.
pub(crate) fn comes_back(program: &Program, checked: &Checked, write: Writer) -> Result<(), String> {
    let said = |problems: &[Diagnostic]| {
        let errors = problems.iter().filter(|problem| problem.is_error());
        errors.map(|problem| format!("{}: {}", problem.code, problem.message)).collect::<Vec<_>>().join("; ")
    };
    let text = write(program).map_err(|problems| said(&problems))?;
    let parsed = frontend::parse(&Source::new("written", text.as_str()));
    let (again, more) = check(&parsed.program);
    match again {
        Some(again) if !any_error(&parsed.diagnostics) => same_trace(checked, &again, 2, FEWER, |_| true),
        _ => Err(format!("{}{}\n{text}", said(&parsed.diagnostics), said(&more))),
    }
}
