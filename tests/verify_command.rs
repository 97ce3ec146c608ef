//! `rung build --verify` on whole programs: nothing differs, all is proved, and what is written is what is written without.

use std::path::Path;
use std::process::{Command, Output};

fn rung(arguments: &[&str]) -> Output {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    Command::new(env!("CARGO_BIN_EXE_rung")).current_dir(root).args(arguments).output().expect("the command starts")
}

/// What is said of the proof of a program, which writes the same as without one.
fn verified(program: &str, options: &[&str]) -> String {
    let with = rung(&[&["build", program, "--emit", "logic", "--verify"], options].concat());
    let without = rung(&[&["build", program, "--emit", "logic"], options].concat());
    let said = String::from_utf8_lossy(&with.stderr).into_owned();
    assert!(with.status.success() && without.status.success(), "{program}: {said}");
    assert!(with.stdout == without.stdout, "{program} is built to something else");
    said
}

/// The first two numbers of what is said: the values that are proved, and all.
fn counts(said: &str) -> (usize, usize) {
    let line = said.lines().find_map(|line| line.strip_prefix("verified: ")).unwrap_or_else(|| panic!("{said}"));
    let numbers: Vec<usize> = line.split_whitespace().filter_map(|word| word.parse().ok()).collect();
    (numbers[0], numbers[1])
}

#[test]
fn every_example_is_proved_whole() {
    let entries = std::fs::read_dir(Path::new(env!("CARGO_MANIFEST_DIR")).join("examples")).expect("the examples");
    let mut values = 0;
    for path in entries.map(|entry| entry.expect("an entry").path()) {
        if path.extension().is_some_and(|extension| extension == "rung") {
            let said = verified(&path.to_string_lossy(), &[]);
            let (proved, all) = counts(&said);
            assert_eq!(proved, all, "{}: {said}", path.display());
            values += all;
        }
    }
    assert!(values > 100, "only {values}");
}

#[test]
fn generated_programs_are_proved_whole_and_an_object_is_written() {
    let folder = tempfile::tempdir().expect("a folder");
    let (program, object) = (folder.path().join("p.rung"), folder.path().join("p.o"));
    let made = rung(&["gen", "--rungs", "600", "--timers", "80", "--seed", "7"]);
    std::fs::write(&program, made.stdout).expect("a file");
    let (program, object) = (program.to_string_lossy(), object.to_string_lossy());
    let output = rung(&["build", &program, "--verify", "-o", &object]);
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{said}");
    let (proved, all) = counts(&said);
    assert!(proved == all && all > 600, "{said}");
    assert!(Path::new(&*object).exists());
}

#[test]
fn only_the_passes_that_run_are_verified() {
    assert_eq!(counts(&verified("examples/start_stop.rung", &["--after", "lower"])), (0, 0));
    let (proved, all) = counts(&verified("examples/start_stop.rung", &["--after", "algebra"]));
    assert!(proved == all && all > 0);
}
