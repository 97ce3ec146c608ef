//! The example that links an object from `build.rs`: a host program and firmware without the standard library, built by
//! cargo as a reader would, offline, and run.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::{Mutex, MutexGuard, PoisonError};

const RUNG: &str = env!("CARGO_BIN_EXE_rung");

/// Builds wait for each other: they have one folder.
static BUILDING: Mutex<()> = Mutex::new(());

fn lock() -> MutexGuard<'static, ()> {
    BUILDING.lock().unwrap_or_else(PoisonError::into_inner)
}

fn folder() -> PathBuf {
    Path::new(env!("CARGO_TARGET_TMPDIR")).join("linked")
}

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// Builds both programs of the example with a command, or what cargo says.
fn build(rung: &str) -> Output {
    let mut cargo = Command::new(env!("CARGO"));
    cargo.args(["build", "--quiet", "--offline", "--locked", "--bins"]);
    cargo.current_dir(root().join("examples/linked")).arg("--target-dir").arg(folder()).env("RUNG", rung);
    cargo.output().expect("cargo starts")
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

/// The trace of the same program, stimuli and scans by the interpreter.
fn expected() -> String {
    let mut rung = Command::new(RUNG);
    rung.current_dir(root()).args(["sim", "examples/traffic_light.rung", "--engine", "interp"]);
    rung.args(["--stimuli", "examples/traffic_light.stimuli.csv", "--cycle", "100ms", "--for", "20s"]);
    let output = rung.args(["--signals", "night,red,amber,green"]).output().expect("the command starts");
    assert!(output.status.success(), "{}", text(&output.stderr));
    text(&output.stdout)
}

#[test]
fn a_linked_object_leaves_the_trace_of_the_interpreter_with_and_without_the_standard_library() {
    let _one = lock();
    let built = build(RUNG);
    assert!(built.status.success(), "{}", text(&built.stderr));
    let expected = expected();
    assert_eq!(expected.lines().count(), 201);
    for name in ["linked", "firmware"] {
        let run = Command::new(folder().join("debug").join(name)).output().expect("it was built");
        assert!(run.status.success(), "{name}: {:?} {}", run.status, text(&run.stderr));
        assert_eq!(text(&run.stdout), expected, "{name}");
    }
}

#[test]
fn a_command_that_is_not_there_is_named() {
    let _one = lock();
    let built = build("/no/such/rung");
    assert!(!built.status.success());
    let said = text(&built.stderr);
    assert!(said.contains("/no/such/rung cannot be started") && said.contains("set RUNG to where it is"), "{said}");
}
