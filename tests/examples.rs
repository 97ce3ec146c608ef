//! Every example: sound, in canonical form, and with the stored trace on every engine, byte for byte.
//!
//! `BLESS=1 cargo test --test examples` stores the traces anew.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// The examples are simulated with this cycle, until a second after their last stimulus.
const CYCLE: &str = "100ms";

fn rung(arguments: &[&str]) -> Output {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    Command::new(env!("CARGO_BIN_EXE_rung")).current_dir(root).args(arguments).output().expect("the command starts")
}

/// The paths of the examples, from the package's root.
fn examples() -> Vec<String> {
    let entries = fs::read_dir(Path::new(env!("CARGO_MANIFEST_DIR")).join("examples")).expect("the examples");
    let paths = entries.map(|entry| entry.expect("an entry").path());
    let programs = paths.filter(|path| path.extension().is_some_and(|extension| extension == "rung"));
    let mut names: Vec<String> =
        programs.map(|path| format!("examples/{}", path.file_name().expect("a name").to_string_lossy())).collect();
    names.sort();
    assert!(names.len() >= 6, "only {names:?}");
    names
}

#[test]
fn every_example_checks_without_a_word() {
    for example in examples() {
        let output = rung(&["check", &example]);
        assert!(output.status.success());
        assert_eq!(String::from_utf8_lossy(&output.stderr), "");
    }
}

#[test]
fn every_example_is_in_canonical_form() {
    let mut arguments = vec!["fmt".to_owned(), "--check".to_owned()];
    arguments.extend(examples());
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let output = rung(&arguments);
    assert_eq!(String::from_utf8_lossy(&output.stdout), "", "`rung fmt` would change these");
    assert!(output.status.success());
}

#[test]
fn every_example_has_its_stored_trace_on_every_engine() {
    for example in examples() {
        let stem = example.strip_suffix(".rung").expect("an example's name");
        let stored = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join(format!("{stem}.trace.csv"));
        for (engine, elide) in [("interp", false), ("jit", false), ("both", false), ("both", true)] {
            let stimuli = format!("{stem}.stimuli.csv");
            let mut arguments = vec!["sim", &example, "--stimuli", &stimuli, "--cycle", CYCLE, "--engine", engine];
            arguments.extend(elide.then_some("--elide"));
            let output = rung(&arguments);
            assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
            if engine == "interp" && std::env::var_os("BLESS").is_some() {
                fs::write(&stored, &output.stdout).expect("a writable folder");
            }
            let expected = fs::read(&stored).unwrap_or_else(|error| panic!("{}: {error}", stored.display()));
            assert!(output.stdout == expected, "{example} on {engine} has another trace than {}", stored.display());
        }
    }
}
