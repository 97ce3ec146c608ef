//! What is said and left when two engines differ.

use std::path::Path;

use super::super::{Failure, write_whole};
use super::{points, time};
use crate::diagnostic::Code;
use crate::engine::both::Difference;
use crate::replay::{Replay, source_hash};
use crate::source::Source;

/// Leaves the replay of a difference, and gives the error that says what differs.
///
/// # Errors
/// When the replay cannot be written.
pub(super) fn leave(
    difference: &Difference,
    mut replay: Replay,
    program: (&Path, &Source),
    path: &Path,
) -> Result<Failure, Failure> {
    let now = replay.scans.last().map_or(0, |scan| scan.now);
    let reason = described(difference, now);
    replay.program = program.0.display().to_string();
    replay.source_hash = source_hash(program.1);
    replay.reason.clone_from(&reason);
    write_whole(path, replay.to_json().as_bytes())?;
    let message = format!(
        "the engines differ; the outputs are off\n  {reason}\n  to run it again: rung sim {} --engine both --replay {}",
        program.0.display(),
        path.display()
    );
    Ok(Failure::new(Code::EnginesDiffer, message))
}

/// The variable, its values, the rung that writes it and the time of the scan.
pub(in crate::cli) fn described(difference: &Difference, now: i64) -> String {
    let bytes = format!("{:02x?} interpreted, {:02x?} compiled", difference.bytes.0, difference.bytes.1);
    let values = match difference.values.map(|(first, second)| (points::shown(first), points::shown(second))) {
        Some((first, second)) if first != second => format!("{first} interpreted, {second} compiled"),
        // A BOOL that is neither 0 nor 1, a NaN of another kind: only the bytes tell.
        _ => bytes,
    };
    let rung = difference.rung.as_ref();
    let rung = rung.map_or_else(String::new, |(label, line)| format!(", written by {label} in line {line}"));
    let others = match difference.others {
        0 => String::new(),
        others => format!(" (and {others} more)"),
    };
    format!("{}: {values}{rung}{others}, after the scan at {}", difference.name, time::exact(now))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::both::Both;
    use crate::engine::interp::Interpreter;
    use crate::logic::Slot;
    use crate::replay::Recorder;
    use rung_runtime::Scan;

    /// An interpreter that computes one output wrongly in the seventh scan.
    struct Faulty {
        engine: Interpreter,
        wrong: Slot,
        scans: u32,
    }

    impl Scan for Faulty {
        fn scan(&mut self, image: &mut [u8], now: i64) {
            self.engine.scan(image, now);
            self.scans += 1;
            if self.scans == 7 {
                let value = self.wrong.read(image);
                self.wrong.write(image, crate::elementary::Value::bool(!value.is_true()));
            }
        }
    }

    #[test]
    fn a_difference_is_explained_and_its_replay_leads_there_again() {
        let text = "program p\ninput go\noutput q\nrung first\n  /go (q)\nrung second\n  q t:TON(PT := T#1s)\n";
        let source = Source::new("p.rung", text);
        let (checked, problems) = crate::check::check(&crate::frontend::parse(&source).program);
        let checked = checked.unwrap_or_else(|| panic!("{problems:?}"));
        let program = crate::lower::lower(&checked, &source, None).expect("a small image");
        let layout = &program.layout;
        let q = layout.slots().iter().find(|slot| slot.name == "q").expect("the output").clone();
        let faulty = Faulty { engine: Interpreter::new(&program), wrong: q, scans: 0 };
        let mut engine = Recorder::new(Both::new(Interpreter::new(&program), faulty, layout), layout);
        let mut image = layout.initial_image();
        for now in 0..20 {
            image[0] = u8::from(now % 2 == 1);
            engine.scan(&mut image, now * 10_000_000);
            if !engine.trusted() {
                break;
            }
        }
        let difference = engine.recorded().difference(&program).expect("a difference");
        let replay = engine.replay(String::new(), 0, layout, String::new());

        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("p.replay.json");
        let failure = leave(&difference, replay, (Path::new("p.rung"), &source), &path).expect("it is written");
        let Failure::Error(said) = failure else { panic!("{failure:?}") };
        let reason = "q: 1 interpreted, 0 compiled, written by first in line 4, after the scan at 60ms";
        assert!(said.starts_with("error[R0902]: the engines differ; the outputs are off\n"), "{said}");
        assert!(said.contains(reason), "{said}");

        let written = Source::new("r", std::fs::read_to_string(&path).expect("the replay"));
        let replay = Replay::parse(&written).expect("a replay");
        assert_eq!(replay.check(layout), Ok(()));
        assert_eq!((replay.program.as_str(), replay.source_hash), ("p.rung", source_hash(&source)));
        assert_eq!((replay.reason.as_str(), replay.scans.len()), (reason, 7));
        let (mut again, mut interpreter) = (replay.first_image(layout), Interpreter::new(&program));
        for scan in &replay.scans {
            scan.copy_in(layout, &mut again);
            interpreter.scan(&mut again, scan.now);
        }
        assert_eq!(again, image, "the image that the interpreter had at the difference");
    }
}
