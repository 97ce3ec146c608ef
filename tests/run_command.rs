//! `rung run` as a person starts it, without a terminal. No figure that depends on the machine is asserted.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

fn example(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("examples").join(name)
}

fn run(file: &Path, options: &[&str]) -> Output {
    // Whole minutes for the watchdog: whether this machine is busy is not what is tested.
    let watchdog = ["--watchdog", "2m"];
    let mut command = Command::new(env!("CARGO_BIN_EXE_rung"));
    command.arg("run").arg(file).args(watchdog).args(options).output().expect("the command runs")
}

fn stdout(output: &Output) -> String {
    String::from_utf8_lossy(&output.stdout).into_owned()
}

fn stderr(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

#[test]
fn a_run_says_what_it_loaded_tells_changes_and_ends_with_a_summary() {
    for engine in ["jit", "interp", "both"] {
        let output = run(&example("start_stop.rung"), &["--for", "1s", "--engine", engine, "--set", "START=1"]);
        let text = stdout(&output);
        assert_eq!(output.status.code(), Some(0), "{text}{}", stderr(&output));
        let lines: Vec<&str> = text.lines().collect();
        assert!(lines[0].starts_with("start_stop: 3 rungs, 8 contacts, 3 coils, 0 blocks"), "{text}");
        assert_eq!(text.contains("bytes of code"), engine != "interp", "{text}");
        assert!(text.contains(&format!("engine {engine}, cycle 10ms, tick 1ms")), "{text}");
        for part in ["real-time scan thread", "locked memory"] {
            assert!(text.contains(part), "{text}");
        }
        assert!(lines.iter().any(|line| line.ends_with("s  motor = 1")), "{text}");
        let summary = text.split("\nended after ").nth(1).expect("a summary");
        for part in ["cycles", "scan", "lateness", "p50 / p99 / max", "overruns", "watchdog"] {
            assert!(summary.contains(part), "{text}");
        }
    }
}

#[test]
fn a_run_that_may_leaves_out_scans_and_says_how_many() {
    for engine in ["jit", "both"] {
        let options = ["--for", "1s", "--elide", "--engine", engine, "--set", "START=1"];
        let output = run(&example("start_stop.rung"), &options);
        let text = stdout(&output);
        assert_eq!(output.status.code(), Some(0), "{text}{}", stderr(&output));
        assert!(text.contains("s  motor = 1"), "{text}");
        let left_out = text.split(" scans left out").next().and_then(|before| before.rsplit(' ').next());
        let left_out: u64 = left_out.and_then(|count| count.parse().ok()).unwrap_or_else(|| panic!("{text}"));
        assert!(left_out > 0, "nothing changes after the start: {text}");
    }
}

#[test]
fn what_cannot_be_run_is_a_coded_error() {
    let missing = run(Path::new("there/is/no.rung"), &["--for", "1s"]);
    assert_eq!(missing.status.code(), Some(1));
    assert!(stderr(&missing).starts_with("error[R0103]"), "{}", stderr(&missing));
    for (options, code) in [
        (&["--cycle", "3ms", "--tick", "2ms"][..], "R1001"),
        (&["--cycle", "1ms", "--tick", "2ms"], "R1001"),
        (&["--cycle", "10s", "--tick", "10s"], "R1001"),
        (&["--cycle", "2h"], "R1001"),
        (&["--tick", "1ns"], "R1001"),
        (&["--set", "start"], "R0205"),
        (&["--set", "nothing=1"], "R0301"),
        (&["--set", "motor=1"], "R0301"),
        (&["--set", "start=2"], "R0402"),
    ] {
        let output = run(&example("start_stop.rung"), &[options, &["--for", "1s"]].concat());
        assert_eq!((output.status.code(), stdout(&output).as_str()), (Some(1), ""), "{options:?}");
        assert!(stderr(&output).starts_with(&format!("error[{code}]")), "{options:?}: {}", stderr(&output));
    }
}

#[test]
fn what_is_no_duration_is_a_usage_error() {
    for option in ["--cycle", "--tick", "--for"] {
        for value in ["", "10", "0ms", "1 week", "-1s", "99999999999999999999s"] {
            let output = run(&example("start_stop.rung"), &[&format!("{option}={value}")]);
            assert_eq!(output.status.code(), Some(2), "{option} {value}: {}", stderr(&output));
        }
    }
}

#[test]
fn a_cycle_past_its_watchdog_stops_the_program_with_a_coded_error() {
    let mut command = Command::new(env!("CARGO_BIN_EXE_rung"));
    // No scan takes less than a nanosecond.
    let output =
        command.arg("run").arg(example("start_stop.rung")).args(["--watchdog", "1ns", "--for", "10s"]).output();
    let output = output.expect("the command runs");
    assert_eq!(output.status.code(), Some(1));
    assert!(stderr(&output).starts_with("error[R1003]"), "{}", stderr(&output));
    assert!(stderr(&output).contains("the outputs are off"), "{}", stderr(&output));
    assert!(stdout(&output).contains("ended after"), "{}", stdout(&output));
}

#[test]
fn engines_that_agree_leave_no_replay() {
    let folder = tempfile::tempdir().expect("a folder");
    let program = folder.path().join("light.rung");
    fs::copy(example("traffic_light.rung"), &program).expect("a copy");
    let output = run(&program, &["--for", "1s", "--cycle", "2ms", "--engine", "both"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert_eq!(fs::read_dir(folder.path()).expect("a folder").count(), 1);
}
