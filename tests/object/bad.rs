//! What `rung build` refuses: a coded error with a hint, and no file.

use std::path::Path;
use std::process::Command;

const PLAIN: &str = "program lamp\ninput switch\noutput lamp\nrung r10\n  switch (lamp)\n";
const REAL: &str = "program tank\ninput level : REAL\noutput full\nrung r10\n  {level * 2.0 > 10.0} (full)\n";

fn refused(program: &str, arguments: &[&str]) -> (String, bool) {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let (file, object) = (folder.path().join("plant.rung"), folder.path().join("plant.o"));
    std::fs::write(&file, program).expect("a program");
    let output = Command::new(env!("CARGO_BIN_EXE_rung"))
        .arg("build")
        .args([&file, Path::new("-o"), &object])
        .args(arguments)
        .output()
        .expect("the command runs");
    let entries = std::fs::read_dir(folder.path()).expect("the folder").count();
    assert!(entries == 1 || output.status.success(), "something was left: {arguments:?}");
    (String::from_utf8(output.stderr).expect("text"), object.exists())
}

#[test]
fn what_cannot_be_built_is_refused_with_a_code_and_a_hint_and_leaves_no_file() {
    let mut cases: Vec<(&str, &[&str], &str)> = vec![
        (PLAIN, &["--target", "z80-unknown-none"], "R0903"),
        (PLAIN, &["--target", "riscv32imac-unknown-none-elf"], "R0903"),
        (PLAIN, &["--prefix", "2nd"], "R0906"),
        (PLAIN, &["--prefix", "pümpe"], "R0906"),
        (PLAIN, &["--isa", "no-such-feature"], "R0904"),
    ];
    if cfg!(feature = "all-targets") {
        cases.extend::<[(&str, &[&str], &str); 4]>([
            (PLAIN, &["--target", "riscv64-unknown-elf", "--isa", "rv64iac"], "R0904"),
            (PLAIN, &["--target", "riscv64-unknown-elf", "--isa", "rv64imac", "--abi", "lp64d"], "R0904"),
            (PLAIN, &["--target", "riscv64-unknown-elf", "--isa", "rv32im"], "R0904"),
            (REAL, &["--target", "riscv64-unknown-elf", "--isa", "rv64imac"], "R0905"),
        ]);
    }
    for (program, arguments, code) in cases {
        let (message, is_there) = refused(program, arguments);
        assert!(message.starts_with(&format!("error[{code}]: ")), "{arguments:?}: {message}");
        assert!(message.contains("\n  = hint: "), "{arguments:?}: {message}");
        assert!(!is_there, "{arguments:?}");
    }
}

#[test]
fn an_output_that_cannot_be_written_is_refused() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let file = folder.path().join("plant.rung");
    std::fs::write(&file, PLAIN).expect("a program");
    let output = Command::new(env!("CARGO_BIN_EXE_rung"))
        .arg("build")
        .args([&file, Path::new("-o"), &folder.path().join("none/plant.o")])
        .output()
        .expect("the command runs");
    assert!(String::from_utf8_lossy(&output.stderr).starts_with("error[R0104]: "), "{output:?}");
}

#[test]
fn reals_that_are_only_moved_need_no_floating_point() {
    let moved = "program tank\ninput level : REAL\noutput shown : REAL\nrung r10\n  TRUE {shown := level}\n";
    if cfg!(feature = "all-targets") {
        let (message, is_there) = refused(moved, &["--target", "riscv64-unknown-elf", "--isa", "rv64imac"]);
        assert!(is_there, "{message}");
    }
}
