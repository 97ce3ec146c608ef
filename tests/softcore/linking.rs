//! What an object shows to a linker, and what links with what.

use std::fs;
use std::path::Path;
use std::process::Command;

use tempfile::TempDir;

use crate::target::{AARCH64, RV64, RV64_WITH_REALS, Target, X86_64, output, require, rung};

const PROGRAM: &str = "examples/interlocking18.rung";

/// All that an object exports, without the prefix.
const EXPORTS: [&str; 11] = [
    "abi_version",
    "cycle",
    "image",
    "image_size",
    "init",
    "layout_hash",
    "retain_offset",
    "retain_size",
    "save",
    "scan",
    "tick",
];

fn build(target: Target, program: &str, prefix: &str, to: &Path) {
    let mut command = rung();
    output(command.args(["build", program, "--prefix", prefix]).args(target.object).arg("-o").arg(to));
}

/// The symbols that `nm` lists with some options.
fn symbols(object: &Path, option: &str) -> Vec<String> {
    require("riscv64-unknown-elf-nm", "binutils-riscv64-unknown-elf");
    // The symbols of an ELF file have the same form for every processor.
    let listed = output(Command::new("riscv64-unknown-elf-nm").args([option, "-j"]).arg(object));
    listed.lines().map(str::to_owned).collect()
}

#[test]
fn an_object_exports_the_interface_and_needs_nothing() {
    let folder = TempDir::new().expect("a temporary folder");
    let object = folder.path().join("ladder.o");
    for program in [PROGRAM, "examples/tank_farm.rung"] {
        for target in [RV64_WITH_REALS, AARCH64, X86_64] {
            build(target, program, "my_ladder", &object);
            assert_eq!(symbols(&object, "-u"), [""; 0], "{program} for {}", target.folder);
            let mut exported = symbols(&object, "-g");
            exported.sort();
            assert_eq!(exported, EXPORTS.map(|name| format!("my_ladder_{name}")), "{program} for {}", target.folder);
        }
    }
}

#[test]
fn two_programs_with_two_prefixes_link_into_one_firmware() {
    let folder = TempDir::new().expect("a temporary folder");
    let path = |name: &str| folder.path().join(name);
    let main = "extern void one_init(void *, const void *), two_init(void *, const void *);\n\
        extern unsigned char one_image[], two_image[];\n\
        int main(void) { one_init(one_image, 0); two_init(two_image, 0); return 0; }\n";
    for target in [RV64, RV64_WITH_REALS, AARCH64, X86_64] {
        build(target, PROGRAM, "one", &path("one.o"));
        build(target, "examples/traffic_light.rung", "two", &path("two.o"));
        fs::write(path("both.c"), main).expect("a writable folder");
        let parts = format!("PARTS={} {}", path("one.o").display(), path("two.o").display());
        target.make(folder.path(), [&parts, "run-both"]);
        for built in fs::read_dir(folder.path()).expect("the folder") {
            fs::remove_file(built.expect("an entry").path()).expect("a file that was built");
        }
    }
}

#[test]
fn an_object_links_with_the_float_abi_that_was_asked_for_and_with_no_other() {
    require("riscv64-unknown-elf-gcc", "gcc-riscv64-unknown-elf");
    let folder = TempDir::new().expect("a temporary folder");
    let path = |name: &str| folder.path().join(name);
    let abis = [(RV64, "rv64imac", "lp64"), (RV64_WITH_REALS, "rv64gc", "lp64d")];
    for (target, _, _) in abis {
        build(target, PROGRAM, "ladder", &path("ladder.o"));
        for (other, isa, abi) in abis {
            let mut link = Command::new("riscv64-unknown-elf-gcc");
            link.args([
                &format!("-march={isa}"),
                &format!("-mabi={abi}"),
                "-mcmodel=medany",
                "-nostdlib",
                "-Wl,-eladder_scan",
            ]);
            // A file of the ABI that the object must fit to.
            fs::write(path("main.c"), "int other(void) { return 0; }\n").expect("a writable folder");
            let linked = link.arg(path("main.c")).arg(path("ladder.o")).arg("-o").arg(path("a.out")).output();
            let linked = linked.expect("the compiler starts");
            let message = String::from_utf8_lossy(&linked.stderr);
            assert_eq!(linked.status.success(), target.object == other.object, "{abi}: {message}");
        }
    }
}
