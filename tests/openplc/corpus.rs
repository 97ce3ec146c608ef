//! Files that strangers wrote, where they are there: in the folder that `RUNG_CORPUS` names.

use std::path::PathBuf;

use crate::support::random_stimuli::Stimuli;
use crate::support::rig::{Rig, checked};
use crate::{codes, parse};
use rung::check::check;
use rung::frontend::native;
use rung::source::Source;

/// The files of one repository, with their rungs and the codes that checking gives.
const FILES: [(&str, usize, &[&str]); 9] = [
    ("exercise-01-and-logic__Main.ld", 1, &[]),
    ("exercise-03-latching-circuit__main.ld", 1, &[]),
    ("exercise-04-ton-timer__main.ld", 1, &[]),
    ("exercise-05-ctu-counter__main.ld", 1, &[]),
    ("exercise-06-rising-edge-toggle__main.ld", 1, &[]),
    ("exercise-07-master-control-switch__main.ld", 1, &[]),
    ("exercise-08-dynamic-timer-presets__main.ld", 4, &[]),
    ("exercise-09-sequential-motor-startup__main.ld", 4, &["R0507"]),
    ("exercise-10-comparison-logic__main.ld", 2, &[]),
];

#[test]
fn files_of_the_corpus_are_read_and_every_engine_computes_the_same() {
    let Some(folder) = std::env::var_os("RUNG_CORPUS").map(|folder| PathBuf::from(folder).join("openplc4-ld")) else {
        say("RUNG_CORPUS is not set: the files of the corpus are not tested");
        return;
    };
    for (file, rungs, expected) in FILES {
        let path = folder.join(format!("openplc-ladder-logic-exercises__{file}"));
        let text = std::fs::read_to_string(path).expect("the file is there and UTF-8");
        let parsed = parse(&text);
        assert_eq!(codes(&parsed.diagnostics), Vec::<String>::new(), "{file}: {:#?}", parsed.diagnostics);
        assert_eq!(parsed.program.rungs().count(), rungs, "{file}");
        assert_eq!(codes(&check(&parsed.program).1), expected, "{file}");
        let printed = native::print(&parsed.program);
        let again = rung::frontend::parse(&Source::new(file, printed.clone()));
        assert_eq!(codes(&again.diagnostics), Vec::<String>::new(), "{file}: {printed}");
        let checked = checked(&parsed.program).unwrap_or_else(|problems| panic!("{file}: {problems}"));
        let mut rig = Rig::new(&checked).unwrap_or_else(|problem| panic!("{file}: {problem}"));
        let mut stimuli = Stimuli::new(1, &checked);
        for scan in 0..1000 {
            let (now, changes) = stimuli.next();
            for (name, value) in changes {
                rig.set(&name, value);
            }
            rig.scan(now).unwrap_or_else(|difference| panic!("{file}, scan {scan}: {difference:?}"));
        }
        say(&format!("{file}: {rungs} rungs, all engines and the evaluator agree over 1000 scans"));
    }
}

/// A line for who runs the tests with `--nocapture`.
#[expect(clippy::print_stdout, reason = "it says what is not tested")]
fn say(line: &str) {
    println!("{line}");
}
