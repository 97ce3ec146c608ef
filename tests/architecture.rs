//! The invariants of `ARCHITECTURE.md` that can be read off the source text.

use std::fs;
use std::path::{Path, PathBuf};

/// Every Rust file below a folder of the package, as (path from the package's root, text).
fn sources(folder: &str) -> Vec<(String, String)> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut found = Vec::new();
    let mut folders: Vec<PathBuf> = vec![root.join(folder)];
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).expect("a folder of the package") {
            let path = entry.expect("an entry").path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|extension| extension == "rs") {
                let name = path.strip_prefix(root).expect("below the root").to_string_lossy().replace('\\', "/");
                found.push((name, fs::read_to_string(&path).expect("a readable file")));
            }
        }
    }
    assert!(found.len() > 3, "{folder} has no sources: this test looks at the wrong place");
    found
}

/// The files of a folder that contain any of the words outside comments, but for those that may.
fn naming(folder: &str, words: &[&str], may: &[&str]) -> Vec<String> {
    let code = |text: &str| -> String {
        text.lines().filter(|line| !line.trim_start().starts_with("//")).collect::<Vec<_>>().join("\n")
    };
    sources(folder)
        .into_iter()
        .filter(|(name, _)| !may.iter().any(|start| name.starts_with(start)))
        .filter(|(_, text)| words.iter().any(|word| code(text).contains(word)))
        .map(|(name, _)| name)
        .collect()
}

const NONE: Vec<String> = Vec::new();

#[test]
fn logic_knows_neither_ladder_nor_engines() {
    let logic: Vec<_> = naming("src", &["crate::ladder", "crate::check", "crate::engine", "cranelift"], &[])
        .into_iter()
        .filter(|name| name.starts_with("src/logic") || name.starts_with("src/opt"))
        .collect();
    assert_eq!(logic, NONE);
}

#[test]
fn only_the_compiled_engines_name_cranelift() {
    let may = ["src/engine/clif", "src/engine/jit", "src/engine/lanes", "src/engine/object", "src/engine/target"];
    assert_eq!(naming("src", &["cranelift"], &may), NONE);
}

#[test]
fn only_the_prover_of_passes_names_the_solver() {
    assert_eq!(naming("src", &["batsat"], &["src/opt/prove/sat.rs"]), NONE);
}

#[test]
fn engines_know_no_block_and_no_ladder() {
    let engines: Vec<_> = naming("src", &["crate::ladder", "crate::check", "crate::lower"], &[])
        .into_iter()
        .filter(|name| name.starts_with("src/engine"))
        .collect();
    assert_eq!(engines, NONE);
}

#[test]
fn emitters_know_no_ladder_and_no_engine() {
    let emitters: Vec<_> = naming("src", &["crate::ladder", "crate::check", "crate::lower", "crate::engine"], &[])
        .into_iter()
        .filter(|name| name.starts_with("src/emit"))
        .collect();
    assert_eq!(emitters, NONE);
}

#[test]
fn front_ends_and_the_checker_look_only_backwards() {
    let later = ["crate::lower", "crate::logic", "crate::opt", "crate::engine"];
    let early: Vec<_> = naming("src", &later, &[])
        .into_iter()
        .filter(|name| {
            ["src/frontend", "src/ladder", "src/check", "src/draw"].iter().any(|stage| name.starts_with(stage))
        })
        .collect();
    assert_eq!(early, NONE);
}

#[test]
fn only_the_command_and_the_host_runtime_do_input_output_or_read_clocks() {
    let world =
        ["std::fs", "io::stdin", "io::stdout", "io::stderr", "Instant::now", "SystemTime", "std::net", "println!"];
    assert_eq!(naming("src", &world, &["src/cli"]), NONE);
    assert_eq!(naming("runtime/src", &world, &["runtime/src/host"]), NONE);
}

#[test]
fn unsafe_lives_only_where_the_design_allows() {
    assert_eq!(naming("src", &["unsafe {", "unsafe fn", "unsafe impl", "unsafe extern"], &["src/engine/jit"]), NONE);
    assert_eq!(
        naming(
            "runtime/src",
            &["unsafe {", "unsafe fn", "unsafe impl", "unsafe extern"],
            &["runtime/src/host", "runtime/src/linked"]
        ),
        NONE
    );
}

#[test]
fn no_file_is_over_800_lines() {
    let long: Vec<_> = ["src", "runtime/src", "tests", "benches"]
        .iter()
        .flat_map(|folder| sources(folder))
        .filter(|(_, text)| text.lines().count() > 800)
        .map(|(name, _)| name)
        .collect();
    assert_eq!(long, NONE);
}
