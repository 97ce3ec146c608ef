//! Instructions of a scan on a soft-core: a synthetic program as an object of Rung, as emitted C compiled by gcc, and
//! interpreted, on RISC-V under QEMU, which counts them (`-icount`, `minstret`).
//!
//! `cargo bench --bench softcore` prints the tables of `docs/softcore.md`, for 18 rungs with 3 timers and for 1451 with
//! 246; `cargo test --benches` only shows on the small one that all of it works. Every way to run a program must leave
//! the same image as the interpreter on this machine. It needs the Debian packages gcc-riscv64-unknown-elf and
//! qemu-system-misc.

#![expect(clippy::print_stdout, reason = "the table is what it is for")]

#[path = "support/softcore/textbook.rs"]
mod textbook;

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::fs;
use std::path::Path;
use std::process::Command;

use rung::engine::interp::{Interpreter, Stream};
use rung::frontend::native;
use rung::generate::{Options, generate};
use rung::logic::Program;
use rung::source::Source;
use rung::{check, lower, opt};
use rung_runtime::Scan;
use tempfile::TempDir;

/// Scans that are counted.
const SCANS: i64 = 100;

/// "FPGA Implementations of Ladder Diagrams", Table 1: worst-case cycles of a MicroBlaze for 18 rungs and 3 timers.
const PAPER_INTERPRETED: f64 = 12819.0;
const PAPER_COMPILED: f64 = 891.0;

fn main() {
    let measures = std::env::args().any(|argument| argument == "--bench");
    let sizes: &[(u32, u32)] = if measures { &[(18, 3), (1451, 246)] } else { &[(18, 3)] };
    for (rungs, timers) in sizes {
        Subject::new(*rungs, *timers).table();
    }
}

/// Where a program runs.
#[derive(Clone, Copy)]
struct Core {
    folder: &'static str,
    isa: &'static str,
    abi: &'static str,
}

const RV64: Core = Core { folder: "rv64", isa: "rv64imac", abi: "lp64" };
const RV64_WITH_BITS: Core = Core { folder: "rv64", isa: "rv64gc_zba_zbb_zbs", abi: "lp64d" };
const RV32: Core = Core { folder: "rv32", isa: "rv32imac", abi: "ilp32" };

/// How it runs there.
#[derive(Clone, Copy)]
enum Way {
    Object,
    /// With an option of gcc.
    C(&'static str),
    /// By the stream of Rung's own interpreter.
    Gates,
    /// One operation after the other.
    Textbook,
}

/// What was counted.
struct Count {
    least: u64,
    mean: f64,
    greatest: u64,
    code: u64,
    /// Bytes that an interpreter reads: its stream and the constants.
    data: usize,
}

/// A program that is measured.
struct Subject {
    rungs: u32,
    timers: u32,
    folder: TempDir,
    program: Program,
    /// A hash of the image after all scans.
    hash: u64,
}

impl Subject {
    fn new(rungs: u32, timers: u32) -> Self {
        let program = generate(&Options { rungs, timers, ..Options::default() }).expect("options that fit");
        let folder = TempDir::new().expect("a temporary folder");
        fs::write(folder.path().join("ladder.rung"), native::print(&program)).expect("a writable folder");
        let checked = check::check(&program).0.expect("a generated program has no errors");
        let program = lower::lower(&checked, &Source::new("synthetic", ""), None).expect("a small image");
        let program = opt::optimise(program);
        let hash = expected(&program);
        Self { rungs, timers, folder, program, hash }
    }

    fn table(&self) {
        let Self { rungs, timers, .. } = self;
        println!("{rungs} rungs, {timers} timers: instructions of a scan, of {SCANS} under random inputs");
        println!(
            "{:<44} {:>9} {:>9} {:>8} {:>8} {:>7} {:>8}",
            "", "mean", "greatest", "ratio", "code B", "B/rung", "data B"
        );
        let compiled = [
            (RV64, Way::Object),
            (RV64, Way::C("-O0")),
            (RV64, Way::C("-O2")),
            (RV64, Way::C("-Os")),
            (RV64_WITH_BITS, Way::Object),
            (RV64_WITH_BITS, Way::C("-O2")),
        ];
        let mut object = 0.0;
        for (core, way) in compiled {
            let count = self.count(core, way);
            if matches!(way, Way::Object) {
                object = count.mean;
            }
            self.row(core, way, &count, object);
        }
        for (core, compiled) in [(RV64, Way::Object), (RV32, Way::C("-O2"))] {
            println!("\ninterpreted, beside compiled");
            let base = self.count(core, compiled);
            self.row(core, compiled, &base, base.mean);
            for way in [Way::Gates, Way::Textbook] {
                self.row(core, way, &self.count(core, way), base.mean);
            }
        }
        let ratio = PAPER_INTERPRETED / PAPER_COMPILED;
        println!(
            "the paper, 18 rungs and 3 timers, in cycles of a MicroBlaze: {PAPER_INTERPRETED} : {PAPER_COMPILED} = {ratio:.1}\n"
        );
    }

    fn row(&self, core: Core, way: Way, count: &Count, base: f64) {
        let name = match way {
            Way::Object => format!("Rung's object, {}", core.isa),
            Way::C(option) => format!("Rung's C, gcc {option}, {}", core.isa),
            Way::Gates => format!("gates and steps, interpreter in C, {}", core.isa),
            Way::Textbook => format!("bytecode, textbook interpreter in C, {}", core.isa),
        };
        let Count { mean, greatest, code, data, .. } = count;
        let per_rung = match way {
            Way::Object | Way::C(_) => *code as f64,
            Way::Gates | Way::Textbook => *data as f64,
        } / f64::from(self.rungs);
        println!("{name:<44} {mean:>9.1} {greatest:>9} {:>8.2} {code:>8} {per_rung:>7.1} {data:>8}", mean / base);
        assert!(count.least <= *greatest);
    }

    /// Builds firmware, runs it and reads what it counted.
    fn count(&self, core: Core, way: Way) -> Count {
        let folder = TempDir::new().expect("a temporary folder");
        let path = |name: &str| folder.path().join(name);
        let root = Path::new(env!("CARGO_MANIFEST_DIR"));
        let support = root.join("benches/support/softcore");
        fs::copy(support.join("measure.c"), path("measure.c")).expect("a writable folder");
        fs::write(path("measure.h"), self.measure_header()).expect("a writable folder");
        let (option, data) = match way {
            Way::Object => {
                let isa = ["--target", "riscv64-unknown-none-elf", "--isa", core.isa, "--abi", core.abi];
                self.build(&isa, &path("program.o"));
                ("-O2", 0)
            }
            Way::C(option) => {
                self.build(&["--emit", "c"], &path("program.c"));
                (option, 0)
            }
            Way::Gates => {
                let stream = Interpreter::new(&self.program).stream().expect("a program that a stream can hold");
                fs::copy(support.join("gates.c"), path("program.c")).expect("a writable folder");
                ("-O2", write_stream(&stream, folder.path()))
            }
            Way::Textbook => {
                fs::copy(support.join("textbook.c"), path("program.c")).expect("a writable folder");
                ("-O2", write_stream(&textbook::stream(&self.program), folder.path()))
            }
        };
        // gcc 12 does not know the multilib of an ISA with bit manipulation, and the linker does not mind.
        let mut make = Command::new("timeout");
        make.args(["600", "make", "-s", "-C"]).arg(root.join("examples/softcore").join(core.folder));
        make.arg(format!("BUILD={}", folder.path().display())).arg(format!("ISA={}", core.isa));
        make.arg(format!("ABI={}", core.abi)).arg(format!("OPT={option}"));
        let mut parts = vec![path("program.o")];
        if matches!(way, Way::Gates | Way::Textbook) {
            parts.push(path("stream.o"));
        }
        let parts: Vec<String> = parts.iter().map(|part| part.display().to_string()).collect();
        make.arg(format!("PARTS={}", parts.join(" ")));
        let printed = output(make.args(["QEMU_FLAGS=-icount shift=0", "run-measure"]));
        let numbers: Vec<u64> = printed.split_whitespace().map(|word| word.parse().expect("a number")).collect();
        let [least, sum, greatest, hash] = numbers[..] else { panic!("the firmware printed {printed}") };
        assert_eq!(hash, self.hash, "another image than the interpreter's");
        Count { least, mean: sum as f64 / SCANS as f64, greatest, code: code_bytes(&path("program.o")), data }
    }

    fn build(&self, arguments: &[&str], to: &Path) {
        let mut command = Command::new(env!("CARGO_BIN_EXE_rung"));
        output(command.arg("build").arg(self.folder.path().join("ladder.rung")).args(arguments).arg("-o").arg(to));
    }

    fn measure_header(&self) -> String {
        let [inputs] = self.program.layout.inputs() else { panic!("one run of inputs") };
        let (start, end) = (inputs.bools.start, inputs.bools.end);
        let size = self.program.layout.size();
        format!(
            "#define SCANS {SCANS}u\n#define INPUTS_START {start}u\n#define INPUTS_END {end}u\n#define LAYOUT_SIZE {size}u\n"
        )
    }
}

/// The hash of the image after all scans, by the interpreter on this machine, with the inputs of `measure.c`.
fn expected(program: &Program) -> u64 {
    let mut interpreter = Interpreter::new(program);
    let mut image = program.layout.initial_image();
    let inputs = program.layout.inputs()[0].bools.clone();
    let mut random = 1_u32;
    for scan in 0..SCANS {
        for input in inputs.clone() {
            random ^= random << 13;
            random ^= random >> 17;
            random ^= random << 5;
            image[input as usize] ^= u8::from(random.is_multiple_of(10));
        }
        interpreter.scan(&mut image, scan * 10_000_000);
    }
    image.iter().fold(0xCBF2_9CE4_8422_2325, |hash, byte| (hash ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01B3))
}

/// Writes a stream as C, with a header; gives how many bytes it has, with the constants.
fn write_stream(stream: &Stream, folder: &Path) -> usize {
    let header = format!("#define CELLS {}\n#define NOW {}\n", stream.cells.len(), stream.now);
    let declared = "extern const uint16_t stream[];\nextern const uint8_t first_cells[CELLS];\n";
    fs::write(folder.join("stream.h"), header + declared).expect("a writable folder");
    // Apart from the interpreter, which gcc would otherwise fold together with it.
    let mut c = String::from("#include <stdint.h>\n#include \"stream.h\"\nconst uint16_t stream[] = {");
    stream.words.iter().for_each(|word| write!(c, "{word},").expect("a string takes all"));
    c.push_str("};\nconst uint8_t first_cells[CELLS] = {");
    stream.cells.iter().for_each(|byte| write!(c, "{byte},").expect("a string takes all"));
    c.push_str("};\n");
    fs::write(folder.join("stream.c"), c).expect("a writable folder");
    2 * stream.words.len() + stream.cells.len() - usize::from(stream.now) - 8
}

/// Bytes of the functions that a scan runs: all but those of the interface that it does not call. Two names of one
/// function count once.
fn code_bytes(object: &Path) -> u64 {
    let others = ["ladder_init", "ladder_save", "ladder_tick", "ladder_cycle", "normalise"];
    let listed = output(Command::new("riscv64-unknown-elf-nm").args(["-S", "--defined-only"]).arg(object));
    let functions = listed.lines().filter_map(|line| {
        let [address, size, kind, name] = line.split_whitespace().collect::<Vec<_>>()[..] else { return None };
        let counts = kind.eq_ignore_ascii_case("t") && !others.contains(&name);
        counts.then(|| (address.to_owned(), u64::from_str_radix(size, 16).expect("a size")))
    });
    functions.collect::<BTreeMap<_, _>>().values().sum()
}

fn output(command: &mut Command) -> String {
    let output = command.output().unwrap_or_else(|error| panic!("{command:?}: {error}"));
    assert!(output.status.success(), "{command:?}: {}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8_lossy(&output.stdout).into_owned()
}
