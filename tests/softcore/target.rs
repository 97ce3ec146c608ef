//! The targets: what they need, and how `make` is started in their folders.

use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// Seconds after which a build and a run are given up: some ten times what they take on a busy machine.
const PATIENCE: &str = "400";

/// A folder of `examples/softcore`, perhaps for another ISA than it says.
#[derive(Clone, Copy)]
pub(crate) struct Target {
    pub(crate) folder: &'static str,
    /// What `rung build` gets to make an object; nothing where C is emitted.
    pub(crate) object: &'static [&'static str],
    /// What `make` gets besides.
    pub(crate) variables: &'static [&'static str],
    /// Commands and the Debian packages that they are in.
    tools: &'static [(&'static str, &'static str)],
    /// Whether an emulated clock drives it, so that no load of this machine can disturb its time.
    pub(crate) emulates_time: bool,
}

const RISCV_GCC: (&str, &str) = ("riscv64-unknown-elf-gcc", "gcc-riscv64-unknown-elf");

pub(crate) const RV64: Target = Target {
    folder: "rv64",
    object: &["--target", "riscv64-unknown-none-elf", "--isa", "rv64imac", "--abi", "lp64"],
    variables: &[],
    tools: &[RISCV_GCC, ("qemu-system-riscv64", "qemu-system-misc")],
    emulates_time: true,
};

/// With floating point, which REAL needs on this target, and the instructions that Rung makes use of.
pub(crate) const RV64_WITH_REALS: Target = Target {
    object: &["--target", "riscv64-unknown-none-elf", "--isa", "rv64gc_zba_zbb_zbs", "--abi", "lp64d"],
    variables: &["ISA=rv64gc", "ABI=lp64d"],
    ..RV64
};

pub(crate) const RV32: Target = Target {
    folder: "rv32",
    object: &[],
    variables: &[],
    tools: &[RISCV_GCC, ("qemu-system-riscv32", "qemu-system-misc")],
    emulates_time: true,
};

pub(crate) const CORTEX_M3: Target = Target {
    folder: "cortex-m3",
    tools: &[("arm-none-eabi-gcc", "gcc-arm-none-eabi"), ("qemu-system-arm", "qemu-system-arm")],
    ..RV32
};

pub(crate) const OPENRISC: Target = Target {
    folder: "openrisc",
    tools: &[("or1k-elf-gcc", "gcc-or1k-elf"), ("qemu-system-or1k", "qemu-system-misc")],
    ..RV32
};

pub(crate) const AARCH64: Target = Target {
    folder: "aarch64",
    object: &["--target", "aarch64-unknown-linux-gnu"],
    variables: &[],
    tools: &[
        ("aarch64-linux-gnu-gcc", "gcc-aarch64-linux-gnu and libc6-dev-arm64-cross"),
        ("qemu-aarch64", "qemu-user"),
    ],
    emulates_time: false,
};

pub(crate) const X86_64: Target = Target {
    folder: "x86-64",
    object: &["--target", "x86_64-unknown-linux-gnu"],
    variables: &[],
    tools: &[("x86_64-linux-gnu-gcc", "gcc (gcc-x86-64-linux-gnu on another processor)")],
    emulates_time: false,
};

impl Target {
    /// Runs `make` in the target's folder and gives what it printed.
    ///
    /// # Panics
    /// When a tool is missing, or `make` fails or takes too long.
    pub(crate) fn make<A: AsRef<OsStr>>(self, build: &Path, arguments: impl IntoIterator<Item = A>) -> String {
        for (tool, package) in self.tools.iter().chain(&[("make", "make"), ("awk", "mawk")]) {
            require(tool, package);
        }
        let mut command = Command::new("timeout");
        command.args([PATIENCE, "make", "-s", "-j2", "-C"]).arg(root().join("examples/softcore").join(self.folder));
        command.arg(format!("RUNG={}", env!("CARGO_BIN_EXE_rung"))).arg(format!("BUILD={}", build.display()));
        // A `make` around `cargo` must not tell this one what to do.
        command.env_remove("MAKEFLAGS").env_remove("MAKELEVEL");
        output(command.args(self.variables).args(arguments))
    }
}

/// The package's folder.
pub(crate) fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

/// The command `rung`, in the package's folder.
pub(crate) fn rung() -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_rung"));
    command.current_dir(root());
    command
}

/// What a command prints.
///
/// # Panics
/// When it fails.
pub(crate) fn output(command: &mut Command) -> String {
    let Output { status, stdout, stderr } = command.output().unwrap_or_else(|error| panic!("{command:?}: {error}"));
    let (stdout, stderr) = (String::from_utf8_lossy(&stdout), String::from_utf8_lossy(&stderr));
    let end = &stdout[stdout.floor_char_boundary(stdout.len().saturating_sub(2000))..];
    assert!(status.success(), "{command:?} ends with {status}\n{stderr}\n…{end}");
    stdout.into_owned()
}

/// # Panics
/// When there is no such command.
pub(crate) fn require(tool: &str, package: &str) {
    let paths = std::env::var_os("PATH").unwrap_or_default();
    let found = std::env::split_paths(&paths).any(|folder| folder.join(tool).is_file());
    assert!(found, "this test needs {tool}: install the Debian package {package}");
}
