//! `rung bench` as a person starts it. No figure that depends on the machine is asserted.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

const EVERY: [&str; 7] = ["jit", "interp", "textbook", "gcc-c", "gcc-equations", "clang-c", "clang-equations"];

fn run(options: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_rung")).arg("bench").args(options).output().expect("the command runs")
}

/// What it prints, line by line in words.
fn bench(options: &[&str]) -> Vec<Vec<String>> {
    let output = run(options);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let table = String::from_utf8(output.stdout).expect("UTF-8");
    table.lines().map(|row| row.split_whitespace().map(str::to_owned).collect()).collect()
}

fn example(name: &str) -> String {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("examples").join(name).display().to_string()
}

fn write(folder: &Path, name: &str, text: &str) -> PathBuf {
    let path = folder.join(name);
    std::fs::write(&path, text).expect("written");
    path
}

#[test]
fn every_engine_and_compiler_has_a_row_and_machine_code_its_instructions() {
    let rows = bench(&[&example("pump_station.rung"), "--scans", "3"]);
    assert_eq!(rows.len(), 1 + EVERY.len(), "gcc, clang and valgrind are needed here: {rows:?}");
    for (row, engine) in rows[1..].iter().zip(EVERY) {
        assert_eq!(row[..3], ["pump_station", "8", engine]);
        let instructions = &row[row.len() - 1];
        let interprets = ["interp", "textbook"].contains(&engine);
        assert_eq!(instructions.parse::<f64>().is_ok_and(|count| count > 0.0), !interprets, "{row:?}");
    }
    let rows = bench(&[&example("pump_station.rung"), "--scans", "1", "--engine", "interp"]);
    assert_eq!((rows.len(), rows[1][2].as_str()), (2, "interp"));
}

#[test]
fn compilers_get_arrays_reals_calls_and_tasks_and_leave_the_same_image() {
    // Nothing is measured before all have left the same image: that there are figures is what shows it.
    let folder = tempfile::tempdir().expect("a folder");
    let mut files: Vec<String> = std::fs::read_dir(Path::new(env!("CARGO_MANIFEST_DIR")).join("examples"))
        .expect("examples")
        .filter_map(|entry| Some(entry.ok()?.path()))
        .filter(|path| path.extension().is_some_and(|extension| extension == "rung"))
        .map(|path| path.display().to_string())
        .collect();
    let count = files.len();
    assert!(count >= 4);
    let json = folder.path().join("b.json").display().to_string();
    let engines = ["--engine", "jit", "--engine", "gcc-c", "--engine", "clang-equations", "--engine", "gcc-whole"];
    files.extend(["--scans", "2", "--json", &json].into_iter().chain(engines).map(str::to_owned));
    let rows = bench(&files.iter().map(String::as_str).collect::<Vec<_>>());
    assert_eq!(rows.len(), 1 + 4 * count, "{rows:?}");
    let json: serde_json::Value = serde_json::from_slice(&std::fs::read(json).expect("written")).expect("JSON");
    for program in json.as_array().expect("a list") {
        for row in program["rows"].as_array().expect("a list") {
            let known = |name: &str| row[name].as_f64().is_some_and(|value| value > 0.0);
            assert!(known("nanoseconds_a_scan") && known("compile_milliseconds") && known("code_bytes"), "{row}");
        }
    }
}

#[test]
fn the_sizes_of_the_literature_are_told_beside_its_ratio_and_drawn() {
    let folder = tempfile::tempdir().expect("a folder");
    let svg = folder.path().join("b.svg").display().to_string();
    let rows = bench(&["--paper", "--scans", "16", "--engine", "textbook", "--engine", "jit", "--svg", &svg]);
    let first: Vec<String> = rows.iter().filter_map(|row| row.first().cloned()).collect();
    assert_eq!(
        first,
        [
            "program",
            "synthetic_18",
            "synthetic_18",
            "synthetic_1451",
            "synthetic_1451",
            "interpreted",
            "Table",
            "18",
            "1451"
        ]
    );
    assert_eq!(
        rows.iter().find(|row| row.first().is_some_and(|word| word == "Table")).unwrap().last().unwrap(),
        "14.4"
    );
    let drawing = std::fs::read_to_string(svg).expect("written");
    for text in ["synthetic_18, 18 rungs", "synthetic_1451, 1451 rungs", "textbook", "jit"] {
        assert!(drawing.contains(text), "{text}");
    }
}

#[test]
fn a_compiler_that_takes_too_long_is_stopped_and_the_rest_is_measured() {
    let options = ["--patience", "1ms", "--scans", "1", "--engine", "gcc-c", "--engine", "jit"];
    let rows = bench(&[&[example("pump_station.rung").as_str()], &options[..]].concat());
    assert!(rows[1].join(" ").contains("> 1 "), "{rows:?}");
    assert_eq!(rows[2][2], "jit");
}

#[test]
fn names_that_c_has_not_are_refused_unless_the_compilers_are_left_out() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = write(folder.path(), "w.rung", "program w\ninput register\noutput q\nrung a\n  register (q)\n");
    let path = path.display().to_string();
    let refused = run(&[&path, "--scans", "1"]);
    let said = String::from_utf8_lossy(&refused.stderr);
    assert_eq!(refused.status.code(), Some(1));
    assert!(said.contains("R0911") && said.contains("--engine"), "{said}");
    assert_eq!(bench(&[&path, "--scans", "1", "--engine", "jit"]).len(), 2);
}

#[test]
fn programs_without_inputs_or_rungs_are_measured_too() {
    let folder = tempfile::tempdir().expect("a folder");
    for (name, text) in [("empty", "program empty\n"), ("blinker", "program blinker\noutput q\nrung a\n  /q (q)\n")] {
        let path = write(folder.path(), &format!("{name}.rung"), text).display().to_string();
        for options in [&["--scans", "3"][..], &["--engine", "jit"]] {
            let rows = bench(&[&[path.as_str()], options].concat());
            assert_eq!(rows[1][0], name);
            assert!(rows.iter().flatten().all(|cell| cell != "NaN" && cell != "inf"), "{rows:?}");
        }
    }
}
