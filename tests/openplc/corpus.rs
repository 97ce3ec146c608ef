//! Files that strangers wrote, where they are there: in the folder that `RUNG_CORPUS` names.

use std::path::PathBuf;

use crate::support::random_stimuli::{Stimuli, observed};
use crate::{codes, parse};
use rung::check::check;
use rung::engine::interp::Interpreter;
use rung::engine::jit::Jit;
use rung::frontend::native;
use rung::source::Source;
use rung::{lower, opt};
use rung_runtime::Scan;

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
        let (checked, found) = check(&parsed.program);
        assert_eq!(codes(&found), expected, "{file}");
        let checked = checked.expect("it has no error");
        let printed = native::print(&parsed.program);
        let again = rung::frontend::parse(&Source::new(file, printed.clone()));
        assert_eq!(codes(&again.diagnostics), Vec::<String>::new(), "{file}: {printed}");
        let logic = lower::lower(&checked, &Source::new(file, text), None).expect("a small image");
        let optimised = opt::optimise(logic.clone());
        let mut engines: [Box<dyn Scan>; 2] =
            [Box::new(Interpreter::new(&logic)), Box::new(Jit::compile(&optimised).expect("it compiles"))];
        let mut images = [logic.layout.initial_image(), logic.layout.initial_image()];
        let mut stimuli = Stimuli::new(1, &checked, &observed(&logic.layout));
        for scan in 0..1000 {
            let (now, changes) = stimuli.next();
            for (name, value) in changes {
                let observed =
                    logic.layout.observed().iter().find(|observed| observed.name.eq_ignore_ascii_case(&name));
                let slot = logic.layout.slot(observed.expect("inputs are observed").slot);
                images.iter_mut().for_each(|image| slot.write(image, value));
            }
            engines.iter_mut().zip(&mut images).for_each(|(engine, image)| engine.scan(image, now));
            assert_eq!(images[0], images[1], "{file}, scan {scan}");
        }
        say(&format!("{file}: {rungs} rungs; interpreter and JIT agree over 1000 scans"));
    }
}

/// A line for who runs the tests with `--nocapture`.
#[expect(clippy::print_stdout, reason = "it says what is not tested")]
fn say(line: &str) {
    println!("{line}");
}
