//! `rung sim` and `rung build` as a person starts them: files, streams, exit codes and messages.

use std::ffi::OsStr;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use tempfile::TempDir;

/// A lamp that follows a switch after 20 ms, and a count of its switchings.
const PROGRAM: &str = "program lamp

input  switch
output lamp
var    times : INT

rung r10
  switch delay:TON(PT := T#20ms) (lamp)

rung r20
  ^lamp {times := times + 1}
";

const STIMULI: &str = "time_ms,switch\n15,TRUE\n60,0\n";

/// A folder with the program and its stimuli.
struct Folder(TempDir);

impl Folder {
    fn new() -> Self {
        let folder = Self(TempDir::new().expect("a temporary folder"));
        folder.write("lamp.rung", PROGRAM);
        folder.write("lamp.csv", STIMULI);
        folder
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn write(&self, name: &str, text: &str) {
        fs::write(self.path(name), text).expect("a writable folder");
    }

    fn read(&self, name: &str) -> String {
        fs::read_to_string(self.path(name)).expect("a file that was written")
    }

    fn names(&self) -> Vec<String> {
        let entries = fs::read_dir(self.0.path()).expect("a readable folder");
        let mut names: Vec<String> =
            entries.map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned()).collect();
        names.sort();
        names
    }

    /// Runs the command in this folder.
    fn rung<A: AsRef<OsStr>>(&self, arguments: impl IntoIterator<Item = A>) -> Output {
        let mut command = Command::new(env!("CARGO_BIN_EXE_rung"));
        command.current_dir(self.0.path()).args(arguments).output().expect("the command starts")
    }

    /// Runs the command, which must succeed and say nothing else, and gives its standard output.
    fn stdout(&self, line: &str) -> String {
        let output = self.rung(line.split(' '));
        assert_eq!(text(&output.stderr), "", "{line}");
        assert!(output.status.success(), "{line}");
        text(&output.stdout)
    }

    /// Runs the command, which must fail with exit code 1, and gives what it said.
    fn stderr(&self, line: &str) -> String {
        let output = self.rung(line.split(' '));
        assert_eq!(output.status.code(), Some(1), "{line}");
        text(&output.stderr)
    }
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).expect("UTF-8")
}

const TRACE: &str = "time_ms,switch,lamp,times,delay.Q,delay.ET
0,0,0,0,0,0
10,0,0,0,0,0
20,1,0,0,0,0
30,1,0,0,0,10
40,1,1,1,1,20
50,1,1,1,1,20
60,0,0,1,0,0
70,0,0,1,0,0
";

#[test]
fn every_engine_writes_the_same_trace_to_the_standard_output() {
    let folder = Folder::new();
    for engine in ["jit", "interp", "both"] {
        let line = format!("sim lamp.rung --stimuli lamp.csv --scans 8 --engine {engine}");
        assert_eq!(folder.stdout(&line), TRACE, "{engine}");
    }
    assert_eq!(folder.stdout("sim lamp.rung --stimuli lamp.csv --for 80ms --trace -"), TRACE);
}

#[test]
fn a_run_lasts_a_second_after_the_last_stimulus_or_a_hundred_scans() {
    let folder = Folder::new();
    let last = |line: &str| folder.stdout(line).lines().last().map(|row| row.split(',').next().map(str::to_owned));
    assert_eq!(last("sim lamp.rung --stimuli lamp.csv"), Some(Some("1050".to_owned())));
    assert_eq!(last("sim lamp.rung"), Some(Some("990".to_owned())));
    assert_eq!(last("sim lamp.rung --cycle 0.25ms"), Some(Some("24.75".to_owned())));
    assert_eq!(last("sim lamp.rung --scans 0"), Some(Some("time_ms".to_owned())));
}

#[test]
fn several_traces_are_written_and_signals_selected() {
    let folder = Folder::new();
    let out = folder.stdout(
        "sim lamp.rung --stimuli lamp.csv --scans 8 --signals lamp,DELAY --trace a.csv --trace b.vcd --trace c.svg",
    );
    assert_eq!(out, "");
    assert_eq!(folder.names(), ["a.csv", "b.vcd", "c.svg", "lamp.csv", "lamp.rung"]);
    assert!(folder.read("a.csv").starts_with("time_ms,lamp,delay.Q,delay.ET\n0,0,0,0\n"));
    let waves = folder.read("b.vcd");
    assert!(waves.starts_with("$timescale 1 ns $end\n$scope module lamp $end\n"), "{waves}");
    assert!(waves.ends_with("#60000000\n0!\n0\"\nr0.0 #\n#70000000\n"), "{waves}");
    assert!(folder.read("c.svg").ends_with("</svg>\n"));
}

#[test]
fn bad_stimuli_are_said_with_their_lines_and_nothing_is_written() {
    let folder = Folder::new();
    folder.write("bad.csv", "time_ms,switch,dial\n5,2,0\n3,1,0\n");
    let said = folder.stderr("sim lamp.rung --stimuli bad.csv --trace out.csv");
    for part in ["error[R0701]", "bad.csv:1:16", "`dial`", "bad.csv:2:3", "bad.csv:3:1", "goes back"] {
        assert!(said.contains(part), "{part} is missing in\n{said}");
    }
    assert_eq!(folder.names(), ["bad.csv", "lamp.csv", "lamp.rung"]);

    fs::write(folder.path("bytes.csv"), b"time_ms\n\xFF\0").expect("written");
    assert!(folder.stderr("sim lamp.rung --stimuli bytes.csv").contains("error[R0101]"));
    assert!(folder.stderr("sim lamp.rung --stimuli none.csv").contains("error[R0103]"));
}

#[test]
fn what_cannot_be_traced_is_refused() {
    let folder = Folder::new();
    assert!(folder.stderr("sim lamp.rung --trace out.txt").contains(".csv, .vcd or .svg"));
    assert!(folder.stderr("sim lamp.rung --trace a.csv --trace a.csv").contains("written twice"));
    assert!(folder.stderr("sim lamp.rung --signals lamb").contains("`lamb`"));
    assert!(folder.stderr("sim lamp.rung --trace none/out.csv").contains("error[R0104]"));
    assert!(folder.stderr("sim lamp.rung --cycle 1h --scans 9999999999").contains("end of time"));
    assert_eq!(folder.names(), ["lamp.csv", "lamp.rung"]);
}

#[test]
fn a_wrong_command_line_has_exit_code_2() {
    let folder = Folder::new();
    for line in ["sim", "sim lamp.rung --cycle 10", "sim lamp.rung --scans 1 --for 1s", "build lamp.rung --emit wasm"] {
        assert_eq!(folder.rung(line.split(' ')).status.code(), Some(2), "{line}");
    }
}

#[test]
fn an_earlier_trace_is_replaced_whole() {
    let folder = Folder::new();
    folder.write("out.csv", &"x".repeat(100_000));
    assert_eq!(folder.stdout("sim lamp.rung --stimuli lamp.csv --scans 8 --trace out.csv"), "");
    assert_eq!(folder.read("out.csv"), TRACE);
}

#[cfg(unix)]
#[test]
fn an_interrupted_run_leaves_no_file() {
    let folder = Folder::new();
    let mut command = Command::new(env!("CARGO_BIN_EXE_rung"));
    command.current_dir(folder.0.path()).args(["sim", "lamp.rung", "--scans", "900000000", "--trace", "out.csv"]);
    let mut child = command.spawn().expect("the command starts");
    // The temporary file is there before the first scan.
    while folder.names().len() == 2 {
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    let kill = Command::new("kill").args(["-INT", &child.id().to_string()]).status().expect("kill runs");
    assert!(kill.success());
    assert_eq!(child.wait().expect("a child").code(), Some(130));
    assert_eq!(folder.names(), ["lamp.csv", "lamp.rung"]);
}

#[test]
fn files_are_written_also_where_nobody_reads_the_standard_output() {
    let folder = Folder::new();
    let (reader, writer) = std::io::pipe().expect("a pipe");
    drop(reader);
    let mut command = Command::new(env!("CARGO_BIN_EXE_rung"));
    command.current_dir(folder.0.path()).args(["sim", "lamp.rung", "--scans", "9000", "--trace", "-"]);
    let status = command.args(["--trace", "out.csv"]).stdout(writer).status().expect("the command runs");
    assert_eq!(status.code(), Some(0));
    assert_eq!(folder.read("out.csv").lines().count(), 9001);
}

#[test]
fn a_replay_is_run_and_one_of_another_program_refused() {
    let folder = Folder::new();
    let map = folder.stdout("build lamp.rung --map -");
    let (_, hash) = map.split_once("\"layout\": \"").expect("the hash in the map");
    let hash = &hash[..16];
    let source_hash = rung::replay::source_hash(&rung::source::Source::new("lamp.rung", PROGRAM));
    let replay = |hash: &str| {
        let order = if cfg!(target_endian = "little") { "little" } else { "big" };
        let scans: Vec<String> = [(0, "00"), (5, "01"), (30, "01"), (31, "00")]
            .iter()
            .map(|(ms, inputs)| format!("{{\"now\": {}, \"inputs\": \"{inputs}\"}}", ms * 1_000_000))
            .collect();
        format!(
            "{{\"format\": \"rung-replay-1\", \"program\": \"lamp.rung\", \"source_hash\": \"{source_hash:016x}\", \
             \"layout_hash\": \"{hash}\", \"byte_order\": \"{order}\", \"start_image\": null, \"scans\": [{}]}}",
            scans.join(", ")
        )
    };
    folder.write("replay.json", &replay(hash));
    let expected =
        "time_ms,switch,lamp,times,delay.Q,delay.ET\n0,0,0,0,0,0\n5,1,0,0,0,0\n30,1,1,1,1,20\n31,0,0,1,0,0\n";
    for engine in ["jit", "interp", "both"] {
        assert_eq!(folder.stdout(&format!("sim lamp.rung --replay replay.json --engine {engine}")), expected);
    }
    assert_eq!(folder.stdout("sim lamp.rung --replay replay.json --trace a.svg"), "");

    // A comment changes the text, not what the replay runs over; that is told and no more.
    folder.write("lamp.rung", &format!("{PROGRAM}\n-- changed\n"));
    let output = folder.rung(["sim", "lamp.rung", "--replay", "replay.json"]);
    assert_eq!(text(&output.stdout), expected);
    let told = "note: the program's text has changed since replay.json was recorded from lamp.rung\n";
    assert_eq!(text(&output.stderr), told);

    folder.write("other.json", &replay("0123456789abcdef"));
    assert!(folder.stderr("sim lamp.rung --replay other.json").contains("error[R0703]"));
    assert!(folder.stderr("sim lamp.rung --replay lamp.csv").contains("error[R0703]"));
}

#[test]
fn a_file_that_cannot_be_written_is_called_as_it_was_asked_for() {
    let said = Folder::new().stderr("sim lamp.rung --trace nowhere/trace.csv");
    assert!(said.contains("nowhere/trace.csv cannot be written"), "{said}");
    assert!(!said.contains(".tmp"), "{said}");
}

#[test]
fn build_writes_logic_intermediate_form_assembly_and_map() {
    let folder = Folder::new();
    let logic = folder.stdout("build lamp.rung");
    assert!(logic.starts_with("program \"lamp\"\n"), "{logic}");
    assert_eq!(folder.stdout("build lamp.rung --emit logic"), logic);
    assert_ne!(folder.stdout("build lamp.rung --after lower"), logic);
    assert!(folder.stdout("build lamp.rung --emit clif").contains("function "));
    assert!(folder.stdout("build lamp.rung --emit asm").contains("r20"));

    assert_eq!(folder.stdout("build lamp.rung --emit logic -o lamp.logic --map lamp.json"), "");
    assert_eq!(folder.read("lamp.logic"), logic);
    assert!(folder.read("lamp.json").contains("\"delay.ET\""));
    assert!(folder.stderr("build lamp.rung --after polish").contains("lower"));
    assert!(folder.stderr("build lamp.rung --previous-map lamp.csv").contains("error[R0702]"));
}

#[test]
fn with_an_earlier_map_every_variable_stays_where_it_was() {
    let folder = Folder::new();
    folder.stdout("build lamp.rung --map lamp.json");
    folder.stdout("build lamp.rung --previous-map lamp.json --map again.json");
    assert_eq!(folder.read("again.json"), folder.read("lamp.json"));
    let edited =
        PROGRAM.replace("input  switch", "input  bell, switch").replace("  switch delay", "  switch /bell delay");
    folder.write("edited.rung", &edited);
    folder.stdout("build edited.rung --previous-map lamp.json --map edited.json");
    let offsets = |name: &str| -> Vec<(String, u64)> {
        let map: serde_json::Value = serde_json::from_str(&folder.read(name)).expect("JSON");
        let slots = map["slots"].as_array().expect("slots");
        slots.iter().map(|slot| (slot["name"].to_string(), slot["offset"].as_u64().expect("an offset"))).collect()
    };
    let after = offsets("edited.json");
    let before = offsets("lamp.json");
    assert_eq!(after.len(), before.len() + 1);
    assert!(before.iter().all(|slot| after.contains(slot)), "{before:?} {after:?}");
}

/// The programs of `examples/`.
fn examples() -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples");
    let entries = fs::read_dir(folder).expect("the examples").map(|entry| entry.expect("an entry").path());
    let mut programs: Vec<PathBuf> = entries.filter(|path| path.extension() == Some(OsStr::new("rung"))).collect();
    programs.sort();
    assert!(!programs.is_empty());
    programs
}

#[test]
fn every_example_runs_alike_on_both_engines_and_its_trace_is_the_same_each_time() {
    let folder = Folder::new();
    for program in examples() {
        let stimuli = program.with_extension("stimuli.csv");
        let run = |engine: &str, traces: [&str; 3]| {
            let [csv, vcd, svg] = traces;
            let fixed = ["--cycle", "10ms", "--engine", engine, "--trace", csv, "--trace", vcd, "--trace", svg];
            let arguments = [OsStr::new("sim"), program.as_os_str(), OsStr::new("--stimuli"), stimuli.as_os_str()];
            let output = folder.rung(arguments.into_iter().chain(fixed.iter().map(OsStr::new)));
            assert!(output.status.success(), "{}: {}", program.display(), text(&output.stderr));
            traces.map(|name| folder.read(name))
        };
        let compiled = run("jit", ["a.csv", "a.vcd", "a.svg"]);
        assert!(compiled == run("interp", ["b.csv", "b.vcd", "b.svg"]), "{}", program.display());
        assert!(compiled == run("both", ["a.csv", "a.vcd", "a.svg"]), "{}", program.display());
    }
}
