//! The examples of the register machine: sound, in canonical form, and with the stored traces and timing diagrams on every
//! engine, byte for byte. `docs/register-machine.md` shows each diagram, and says the command that makes it.
//!
//! `BLESS=1 cargo test --test register_machine` stores them anew.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/register_machine")
}

fn rung<'a>(arguments: impl IntoIterator<Item = &'a str>) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_rung"));
    command.current_dir(folder()).args(arguments).output().expect("the command starts")
}

/// The stems of the examples' names, in order.
fn examples() -> Vec<String> {
    let entries = fs::read_dir(folder()).expect("the folder of the examples");
    let paths = entries.map(|entry| entry.expect("an entry").path());
    let programs = paths.filter(|path| path.extension().is_some_and(|extension| extension == "rung"));
    let mut stems: Vec<String> =
        programs.map(|path| path.file_stem().expect("a name").to_string_lossy().into_owned()).collect();
    stems.sort();
    assert!(stems.len() >= 8, "only {stems:?}");
    stems
}

fn manual() -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/register-machine.md");
    fs::read_to_string(path).expect("the page about the register machine")
}

/// Compares with a stored file, or stores it.
fn assert_stored(path: &Path, made: &[u8]) {
    if std::env::var_os("BLESS").is_some() {
        fs::write(path, made).expect("a writable folder");
    }
    let stored = fs::read(path).unwrap_or_default();
    assert!(stored == made, "{} is not up to date: look, then BLESS=1", path.display());
}

#[test]
fn every_example_is_sound_and_in_canonical_form() {
    for example in examples() {
        let file = format!("{example}.rung");
        for command in [&["check"][..], &["fmt", "--check"]] {
            let output = rung(command.iter().copied().chain([file.as_str()]));
            assert!(output.status.success(), "{command:?} {file}: {}", String::from_utf8_lossy(&output.stdout));
            assert_eq!(String::from_utf8_lossy(&output.stderr), "", "{command:?} {file}");
        }
    }
}

/// The commands of the manual are run as they stand there, but that the traces go elsewhere.
#[test]
fn every_example_has_its_stored_trace_and_diagram_on_every_engine() {
    let manual = manual().replace("\\\n", " ");
    let made = tempfile::tempdir().expect("a temporary folder");
    let mut left = examples();
    for command in manual.lines().filter(|line| line.starts_with("rung sim ")) {
        let words: Vec<&str> = command.split_whitespace().skip(1).collect();
        let example = words[1].strip_suffix(".rung").expect("the name of a program");
        left.retain(|other| other != example);
        let names: Vec<&str> = words.windows(2).filter(|pair| pair[0] == "--trace").map(|pair| pair[1]).collect();
        assert_eq!(names, [format!("{example}.trace.csv"), format!("{example}.svg")], "{command}");
        assert!(
            manual.contains(&format!("](../examples/register_machine/{example}.svg)")),
            "{example}.svg is not shown"
        );
        for engine in ["interp", "jit", "both"] {
            let path = |word: &str| made.path().join(word).to_str().expect("a path").to_owned();
            let words = words.iter().map(|word| if names.contains(word) { path(word) } else { (*word).to_owned() });
            let words: Vec<String> = words.chain(["--engine".to_owned(), engine.to_owned()]).collect();
            let output = rung(words.iter().map(String::as_str));
            assert!(output.status.success(), "{command}: {}", String::from_utf8_lossy(&output.stderr));
            assert_eq!(String::from_utf8_lossy(&output.stderr), "", "{command}");
            for name in &names {
                assert_stored(&folder().join(name), &fs::read(path(name)).expect("it was made"));
            }
        }
    }
    assert_eq!(left, Vec::<String>::new(), "docs/register-machine.md does not say how to run these");
}

/// The rows of the stored trace of the paper's example at which the registers changed, up to its fifth shift.
#[test]
fn the_papers_example_shifts_as_the_paper_says() {
    let trace = fs::read_to_string(folder().join("shift_left.trace.csv")).expect("the stored trace");
    let mut reader = csv::Reader::from_reader(trace.as_bytes());
    let columns = ["oreg[0]", "oreg[1]", "oreg[2]", "last_bit"];
    let header = reader.headers().expect("a header").clone();
    let places = columns.map(|name| header.iter().position(|column| column == name).expect(name));
    let mut states: Vec<[u64; 4]> = Vec::new();
    for row in reader.records() {
        let row = row.expect("a row");
        let state = places.map(|place| row[place].parse().expect("a number"));
        if states.last() != Some(&state) {
            states.push(state);
        }
    }
    let expected = [
        [0xFFFF, 0x0F0F, 0xF0F0, 0],
        [0xFFFE, 0x1E1F, 0xE1E0, 1],
        [0xFFFC, 0x3C3F, 0xC3C0, 1],
        [0xFFF8, 0x787F, 0x8780, 1],
        [0xFFF0, 0xF0FF, 0x0F00, 1],
        [0xFFE0, 0xE1FF, 0x1E01, 0],
    ];
    assert_eq!(states[..6], expected);
}
