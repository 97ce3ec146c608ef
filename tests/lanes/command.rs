//! `rung sim --lanes` as a person starts it.

use std::ffi::OsStr;
use std::fs;
use std::process::{Command, Output};

use tempfile::TempDir;

/// A lamp that is to go on only while its switch is on, but is latched when the switch and the button are on together.
const PROGRAM: &str = "program lamp\n\ninput  switch, button\noutput lamp\noutput times : INT\n\nrung r10\n  \
    switch delay:TON(PT := T#20ms) (lamp)\n\nrung r20\n  ^lamp {times := times + 1}\n\nrung r30\n  \
    switch button (S lamp)\n";

struct Folder(TempDir);

impl Folder {
    fn new() -> Self {
        let folder = Self(TempDir::new().expect("a temporary folder"));
        fs::write(folder.0.path().join("lamp.rung"), PROGRAM).expect("a writable folder");
        folder
    }

    fn rung<A: AsRef<OsStr>>(&self, arguments: impl IntoIterator<Item = A>) -> Output {
        let mut command = Command::new(env!("CARGO_BIN_EXE_rung"));
        command.current_dir(self.0.path()).args(arguments).output().expect("the command starts")
    }

    fn read(&self, name: &str) -> String {
        fs::read_to_string(self.0.path().join(name)).expect("a file that was written")
    }
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

#[test]
fn lanes_are_summed_up_in_a_table_that_depends_on_the_seed_alone() {
    let folder = Folder::new();
    let run = |seed: &str| folder.rung(["sim", "lamp.rung", "--lanes", "300", "--scans", "200", "--seed", seed]);
    let (first, again, other) = (run("7"), run("7"), run("8"));
    assert!(first.status.success(), "{}", text(&first.stderr));
    assert_eq!(first.stdout, again.stdout);
    assert_ne!(first.stdout, other.stdout);
    let table = text(&first.stdout);
    let lines: Vec<&str> = table.lines().collect();
    assert!(lines[0].starts_with("variable") && lines.len() == 3, "{table}");
    assert!(lines[1].starts_with("lamp") && lines[1].contains('%') && lines[1].contains("of 300"), "{table}");
    assert!(lines[2].starts_with("times") && lines[2].contains("INT"), "{table}");
    assert!(text(&first.stderr).contains("300 plants x 200 scans"), "{}", text(&first.stderr));
}

#[test]
fn an_assertion_that_fails_is_named_with_its_lane_which_fails_alone_in_the_same_scan() {
    let folder = Folder::new();
    let asserted = ["--assert", "NOT lamp OR delay.Q"];
    let lanes = ["sim", "lamp.rung", "--lanes", "500", "--scans", "300", "--seed", "3", "--failing", "lane.csv"];
    let failed = folder.rung(lanes.iter().chain(&asserted));
    assert_eq!(failed.status.code(), Some(1));
    let message = text(&failed.stderr);
    assert!(message.contains("error[R0921]") && message.contains("NOT lamp OR delay.Q"), "{message}");
    let after = |word: &str| {
        let rest = message.split(word).nth(1).unwrap_or_default();
        rest.chars().take_while(char::is_ascii_digit).collect::<String>()
    };
    let (lane, scan, scans) = (after("in lane "), after("after scan "), after("--scans "));
    assert!(text(&failed.stdout).starts_with("variable"), "the table comes all the same");

    // That lane alone, with a trace.
    let alone = ["sim", "lamp.rung", "--seed", "3", "--lane", &lane, "--scans", &scans, "--trace", "trace.csv"];
    let alone = folder.rung(alone.iter().chain(&asserted));
    let said = text(&alone.stderr);
    assert!(said.contains("error[R0921]") && said.contains(&format!("after scan {scan},")), "{said}");
    let trace = folder.read("trace.csv");
    assert_eq!(trace.lines().count().to_string(), (scans.parse::<usize>().expect("a number") + 1).to_string());

    // The stimuli that it left do the same.
    let again = folder.rung(["sim", "lamp.rung", "--stimuli", "lane.csv", "--scans", &scans, "--trace", "again.csv"]);
    assert!(again.status.success(), "{}", text(&again.stderr));
    assert_eq!(folder.read("again.csv"), trace);
}

#[test]
fn an_assertion_that_holds_is_not_spoken_of() {
    let folder = Folder::new();
    let held = folder.rung(["sim", "lamp.rung", "--lanes", "200", "--assert", "times >= 0", "--assert", "TRUE"]);
    assert!(held.status.success(), "{}", text(&held.stderr));
    let alone = folder.rung(["sim", "lamp.rung", "--assert", "times = 0"]);
    assert!(alone.status.success(), "{}", text(&alone.stderr));
}

#[test]
fn inputs_in_the_stimuli_are_the_same_for_all_plants() {
    let folder = Folder::new();
    fs::write(folder.0.path().join("s.csv"), "time_ms,switch,button\n0,1,0\n").expect("a writable folder");
    let all = folder.rung(["sim", "lamp.rung", "--lanes", "9", "--stimuli", "s.csv", "--signals", "lamp,delay"]);
    assert!(all.status.success(), "{}", text(&all.stderr));
    let table = text(&all.stdout);
    assert_eq!(table.matches("0 of 9").count(), 3, "{table}");
    assert!(table.contains("delay.ET") && text(&all.stderr).contains("no input is random"), "{table}");
}

#[test]
fn what_cannot_be_is_refused_with_its_code() {
    let folder = Folder::new();
    for (arguments, code) in [
        (&["--lanes", "0"][..], "R0922"),
        (&["--lanes", "9999999999999"], "R0922"),
        (&["--lanes", "5", "--assert", "lamp +"], "R02"),
        (&["--lanes", "5", "--assert", "nowhere"], "R0920"),
        (&["--lanes", "5", "--signals", "nowhere"], "R0301"),
    ] {
        let refused = folder.rung(["sim", "lamp.rung"].iter().chain(arguments));
        let said = text(&refused.stderr);
        assert!(refused.status.code() == Some(1) && said.contains(&format!("error[{code}")), "{arguments:?}: {said}");
        assert_eq!(text(&refused.stdout), "");
    }
    for arguments in [
        &["--lanes", "5", "--trace", "t.csv"][..],
        &["--lanes", "5", "--engine", "interp"],
        &["--failing", "x.csv"],
        &["--lanes", "many"],
    ] {
        let refused = folder.rung(["sim", "lamp.rung"].iter().chain(arguments));
        assert_eq!(refused.status.code(), Some(2), "{arguments:?}: {}", text(&refused.stderr));
    }
}
