//! Compiles emitted programs, many into one binary, and runs them by commands.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};

use rung::emit;
use rung::interface::{Interface, image_size, retain_size};
use rung::logic::Program;
use tempfile::TempDir;

/// What every compiler must take without a word.
pub(crate) const STRICT: [&str; 7] =
    ["-std=c99", "-Wall", "-Wextra", "-Wpedantic", "-Wconversion", "-Wshadow", "-Werror"];

/// A compiler and its options.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Compiler {
    pub(crate) name: &'static str,
    pub(crate) options: &'static [&'static str],
}

pub(crate) const GCC: Compiler = Compiler { name: "gcc", options: &["-O2", "-ffreestanding", "-ffp-contract=off"] };
pub(crate) const GCC_PLAIN: Compiler =
    Compiler { name: "gcc", options: &["-O0", "-ffreestanding", "-ffp-contract=off"] };
pub(crate) const GCC_NARROW: Compiler = Compiler {
    name: "gcc",
    // The code for machines of 32 bits, on this one.
    options: &["-O2", "-ffreestanding", "-ffp-contract=off", "-include", "narrow.h"],
};
pub(crate) const CLANG: Compiler = Compiler { name: "clang", options: &["-O2", "-ffreestanding", "-ffp-contract=off"] };
pub(crate) const TCC: Compiler = Compiler { name: "tcc", options: &[] };
pub(crate) const CHECKED: Compiler = Compiler {
    name: "gcc",
    options: &[
        "-O1",
        "-ffp-contract=off",
        "-fsanitize=undefined,address,float-cast-overflow",
        "-fno-sanitize-recover=all",
        "-fstrict-aliasing",
    ],
};

/// Runs a command of a compiler and says what it says.
///
/// # Panics
/// When it is not installed, or fails.
pub(crate) fn run(command: &mut Command) {
    let output = command.output().unwrap_or_else(|error| panic!("{command:?} is needed here and cannot run: {error}"));
    let said = format!("{}{}", String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    assert!(output.status.success() && said.is_empty(), "{command:?}\n{said}");
}

/// The prefix of a program among several.
pub(crate) fn prefix(number: usize) -> String {
    format!("p{number}")
}

/// Several programs in one binary.
pub(crate) struct Rig<'a> {
    folder: TempDir,
    programs: &'a [Program],
    commands: Vec<u8>,
    expected: Vec<(String, Vec<u8>)>,
}

impl<'a> Rig<'a> {
    /// Compiles programs; `tick` is the period of all.
    ///
    /// # Panics
    /// When one cannot be emitted, or the compiler says anything.
    pub(crate) fn new(compiler: Compiler, programs: &'a [Program], tick: i64) -> Self {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path();
        let mut table = String::new();
        let mut rows = String::new();
        let mut sources = Vec::new();
        for (number, program) in programs.iter().enumerate() {
            let interface = Interface::new(&prefix(number), tick).expect("a prefix");
            let text = emit::c::emit(program, &interface).unwrap_or_else(|problems| panic!("{problems:?}"));
            let header = emit::header::emit(program, &interface).unwrap_or_else(|problems| panic!("{problems:?}"));
            let p = prefix(number);
            fs::write(path.join(format!("{p}.c")), text).expect("a writable folder");
            fs::write(path.join(format!("{p}.h")), header).expect("a writable folder");
            sources.push(format!("{p}.c"));
            let _ = writeln!(table, "#include \"{p}.h\"");
            let _ = writeln!(
                rows,
                "    {{&{p}_image_size, &{p}_retain_size, {p}_init, {p}_save, {p}_scan, {p}_tick, {p}_cycle}},"
            );
        }
        let _ = write!(table, "static const program_t programs[] = {{\n{rows}}};\n");
        fs::write(path.join("programs.h"), table).expect("a writable folder");
        fs::write(path.join("driver.c"), include_str!("driver.c")).expect("a writable folder");
        // What makes a machine one of 32 bits for the functions that ask.
        let narrow = "#include <stdint.h>\n#undef UINTPTR_MAX\n#define UINTPTR_MAX 0xFFFFFFFFu\n";
        fs::write(path.join("narrow.h"), narrow).expect("a writable folder");
        let strict: &[&str] = if compiler.name == "tcc" { &["-std=c99", "-Wall", "-Werror"] } else { &STRICT };
        // One file a command: not every compiler takes several.
        for source in &sources {
            run(Command::new(compiler.name).current_dir(path).args(strict).args(compiler.options).args(["-c", source]));
        }
        let objects = sources.iter().map(|source| source.replace(".c", ".o"));
        let sanitize = compiler.options.iter().filter(|option| option.starts_with("-fsanitize"));
        // tcc does not say of its objects that they need no executable stack.
        let link = ["-O1", "-Wl,-z,noexecstack", "-o", "driver", "driver.c"];
        run(Command::new("gcc").current_dir(path).args(link).args(sanitize).args(objects));
        Self { folder, programs, commands: Vec::new(), expected: Vec::new() }
    }

    /// Where the files are.
    pub(crate) fn path(&self) -> &Path {
        self.folder.path()
    }

    fn command(&mut self, letter: u8, number: usize) {
        self.commands.push(letter);
        self.commands.extend(u32::try_from(number).expect("few programs").to_ne_bytes());
    }

    /// An image with its clock.
    fn image(&mut self, number: usize, image: &[u8]) {
        let whole = image_size(&self.programs[number].layout) as usize;
        assert!(image.len() <= whole);
        self.commands.extend(image);
        self.commands.resize(self.commands.len() + whole - image.len(), 0);
    }

    /// One scan, and the layout's bytes after it.
    pub(crate) fn scan(&mut self, number: usize, now: i64, image: &[u8], after: &[u8]) {
        self.command(b's', number);
        self.commands.extend(now.to_ne_bytes());
        self.image(number, image);
        self.expect(format!("a scan of {number} at {now} of {image:?}"), number, after);
    }

    /// One cycle: the image with its clock before and after.
    pub(crate) fn cycle(&mut self, number: usize, image: &[u8], after: &[u8]) {
        self.command(b'c', number);
        self.image(number, image);
        self.expect(format!("a cycle of {number}"), number, after);
    }

    /// Ticks of a program's timer.
    pub(crate) fn ticks(&mut self, number: usize, ticks: u32) {
        self.command(b't', number);
        self.commands.extend(ticks.to_ne_bytes());
    }

    /// A start, and the layout's bytes after it, or these and the clock's.
    pub(crate) fn init(&mut self, number: usize, retained: Option<&[u8]>, after: &[u8]) {
        self.command(b'i', number);
        self.commands.push(u8::from(retained.is_some()));
        self.commands.extend(retained.unwrap_or_default());
        self.expect(format!("a start of {number} with {retained:?}"), number, after);
    }

    /// What of an image is retained.
    pub(crate) fn save(&mut self, number: usize, image: &[u8], retained: &[u8]) {
        assert_eq!(retained.len(), retain_size(&self.programs[number].layout) as usize);
        self.command(b'v', number);
        self.image(number, image);
        self.expected.push((format!("a save of {number}"), retained.to_vec()));
    }

    fn expect(&mut self, what: String, number: usize, after: &[u8]) {
        let mut after = after.to_vec();
        after.resize(image_size(&self.programs[number].layout) as usize, 0);
        self.expected.push((what, after));
    }

    /// Runs all commands, and compares what they give.
    ///
    /// # Panics
    /// When anything differs.
    pub(crate) fn finish(self) {
        fs::write(self.path().join("commands"), &self.commands).expect("a writable folder");
        let commands = fs::File::open(self.path().join("commands")).expect("what was written");
        let mut driver = Command::new(self.path().join("driver"));
        let output = driver.stdin(Stdio::from(commands)).output().expect("the driver starts");
        let said = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success() && said.is_empty(), "{:?}\n{said}", output.status);
        let mut at = 0;
        for (what, expected) in &self.expected {
            let given = output.stdout.get(at..at + expected.len()).unwrap_or_default();
            if given != expected {
                let number: usize =
                    what.split(' ').find_map(|word| word.parse().ok()).expect("the number of the program");
                let program = &self.programs[number];
                let differing: Vec<String> = (program.layout.slots().iter())
                    .filter(|_| given.len() > program.layout.size() as usize)
                    .filter(|slot| slot.read(given) != slot.read(expected))
                    .map(|slot| format!("{}: {:?}, not {:?}", slot.name, slot.read(given), slot.read(expected)))
                    .collect();
                let text = fs::read_to_string(self.path().join(format!("{}.c", prefix(number)))).unwrap_or_default();
                panic!("{text}\n{}\n{differing:#?}\n{given:?}\n{expected:?}\n{what}", rung::logic::print(program));
            }
            at += expected.len();
        }
        assert_eq!(at, output.stdout.len());
    }
}
