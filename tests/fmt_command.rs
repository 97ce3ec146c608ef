//! `rung fmt` as a command: which files it writes, and its exit code.

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

const CANONICAL: &str = "program p\n\ninput  a\noutput o\n\nrung\n  a (o)\n";
const OTHER: &str = "program p input a output o rung\n a (o)";

fn fmt(folder: &Path, files: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_rung")).arg("fmt").args(files).current_dir(folder).output().expect("it starts")
}

#[test]
fn every_file_that_can_be_is_formatted_whatever_the_others_are() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = |name: &str| folder.path().join(name);
    fs::write(path("broken.rung"), "rung (").expect("written");
    fs::write(path("other.rung"), OTHER).expect("written");
    let done = fmt(folder.path(), &["broken.rung", "missing.rung", ".", "other.rung"]);
    assert_eq!(done.status.code(), Some(1));
    let said = String::from_utf8_lossy(&done.stderr);
    let codes: Vec<&str> = said.lines().filter_map(|line| line.get(..12).filter(|s| s.starts_with("error["))).collect();
    assert_eq!(codes, ["error[R0201]", "error[R0103]", "error[R0103]"], "{said}");
    assert_eq!(fs::read_to_string(path("broken.rung")).ok().as_deref(), Some("rung ("));
    assert_eq!(fs::read_to_string(path("other.rung")).ok().as_deref(), Some(CANONICAL));
    assert_eq!(fs::read_dir(folder.path()).expect("a folder").count(), 2, "a temporary file stays");
}

#[cfg(unix)]
#[test]
fn a_link_stays_a_link_and_its_file_is_formatted() {
    let folder = tempfile::tempdir().expect("a folder");
    let (real, link) = (folder.path().join("real.rung"), folder.path().join("link.rung"));
    fs::write(&real, OTHER).expect("written");
    std::os::unix::fs::symlink("real.rung", &link).expect("linked");
    assert_eq!(fmt(folder.path(), &["link.rung"]).status.code(), Some(0));
    assert!(link.is_symlink());
    assert_eq!(fs::read_to_string(&real).ok().as_deref(), Some(CANONICAL));
}

#[test]
fn a_file_of_another_format_is_refused_and_stays_as_it_is() {
    let folder = tempfile::tempdir().expect("a folder");
    let other = "PROGRAM p\n  VAR a : BOOL; END_VAR\n  a := NOT a;\nEND_PROGRAM\n";
    fs::write(folder.path().join("p.rung"), other).expect("written");
    let done = fmt(folder.path(), &["p.rung"]);
    assert_eq!(done.status.code(), Some(1));
    let said = String::from_utf8_lossy(&done.stderr);
    assert!(said.starts_with("error[R0108]") && said.contains("rung convert"), "{said}");
    assert_eq!(fs::read_to_string(folder.path().join("p.rung")).ok().as_deref(), Some(other));
}
