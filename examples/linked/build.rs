//! Builds the ladder and links it: `rung build` writes an object file for cargo's target and a map of its image, of which
//! this makes constants. The command is the one that the environment variable RUNG names, or `rung` on the path.

use std::path::PathBuf;
use std::process::Command;
use std::{env, fs};

const LADDER: &str = "../traffic_light.rung";
/// What the names of the object's symbols start with.
const PREFIX: &str = "light";

fn main() {
    let rung = env::var("RUNG").unwrap_or_else(|_| "rung".to_owned());
    let out = PathBuf::from(env::var("OUT_DIR").expect("cargo sets it"));
    let target = env::var("TARGET").expect("cargo sets it");
    let (object, map) = (out.join("light.o"), out.join("light.json"));
    println!("cargo::rerun-if-changed={LADDER}");
    println!("cargo::rerun-if-env-changed=RUNG");

    let status = Command::new(&rung)
        .args(["build", LADDER, "--target", &target, "--prefix", PREFIX, "--tick", "1ms"])
        .arg("--map")
        .arg(&map)
        .arg("-o")
        .arg(&object)
        .status()
        .unwrap_or_else(|error| panic!("{rung} cannot be started: {error}; set RUNG to where it is"));
    assert!(status.success(), "{rung} build has failed; it says above why");

    println!("cargo::rustc-link-arg-bins={}", object.display());
    let map = fs::read_to_string(map).expect("it was written");
    fs::write(out.join("light.rs"), constants(&map)).expect("cargo's folder can be written");
}

/// A constant for each variable's offset. The map has a line for each member, and those of a slot stand together; who has
/// `serde_json` among the dependencies will read it with that.
fn constants(map: &str) -> String {
    let member =
        |line: &str, name: &str| Some(line.trim().strip_prefix(name)?.trim_matches([':', ' ', ',', '"']).to_owned());
    let (mut name, mut text) = (String::new(), String::new());
    for line in map.lines() {
        if let Some(found) = member(line, "\"name\"") {
            name = found;
        } else if let Some(offset) = member(line, "\"offset\"")
            // States of blocks have names that are none in Rust.
            && name.chars().all(|letter| letter.is_ascii_alphanumeric() || letter == '_')
        {
            text += &format!("pub const {}: usize = {offset};\n", name.to_uppercase());
        }
    }
    text
}
