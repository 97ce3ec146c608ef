//! `rung bench` as a person starts it. No figure that depends on the machine is asserted.

use std::path::Path;
use std::process::Command;

/// The rows of the table, in words.
fn bench(program: &Path, options: &[&str]) -> Vec<Vec<String>> {
    let mut command = Command::new(env!("CARGO_BIN_EXE_rung"));
    let output = command.arg("bench").arg(program).args(options).output().expect("the command runs");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let table = String::from_utf8(output.stdout).expect("UTF-8");
    table.lines().map(|row| row.split_whitespace().map(str::to_owned).collect()).collect()
}

#[test]
fn every_engine_has_a_row_and_machine_code_its_instructions() {
    let example = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/pump_station.rung");
    let rows = bench(&example, &["--scans", "3"]);
    assert_eq!(rows.len(), 4, "{rows:?}");
    for (row, engine) in rows[1..].iter().zip(["jit", "interp", "textbook"]) {
        assert_eq!(row[..3], ["pump_station", "8", engine]);
        let instructions = &row[row.len() - 1];
        assert_eq!(instructions.parse::<f64>().is_ok_and(|count| count > 0.0), engine == "jit", "{row:?}");
    }
    let rows = bench(&example, &["--scans", "1", "--engine", "interp"]);
    assert_eq!((rows.len(), rows[1][2].as_str()), (2, "interp"));
}

#[test]
fn programs_without_inputs_or_rungs_are_measured_too() {
    let folder = tempfile::tempdir().expect("a folder");
    for (name, text) in [("empty", "program empty\n"), ("blinker", "program blinker\noutput q\nrung a\n  /q (q)\n")] {
        let path = folder.path().join(format!("{name}.rung"));
        std::fs::write(&path, text).expect("written");
        for options in [&["--scans", "3"][..], &["--engine", "jit"]] {
            let rows = bench(&path, options);
            assert_eq!(rows[1][0], name);
            assert!(rows.iter().flatten().all(|cell| cell != "NaN" && cell != "inf"), "{rows:?}");
        }
    }
}
