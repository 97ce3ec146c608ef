//! C compilers on a program: compiling what Rung writes, and running it in a process of its own beside the engines.
//!
//! A compiler that is not installed is left out, one that takes too long is stopped. Nothing is measured before the image
//! after some scans is that of Rung's own engines.

use std::fs;
use std::io::{Read, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};
use std::time::{Duration, Instant};

use object::{Object, ObjectSection, SectionKind};
use tempfile::TempDir;

use super::plant::{CYCLE, Plant, SCANS_PER_CHANGE};
use super::{Engine, to_f64};
use crate::cli::Failure;
use crate::diagnostic::Code;
use crate::emit::c;
use crate::interface::Interface;
use crate::logic::Program;

/// What `docs/c.md` tells people to compile with.
const OPTIONS: [&str; 5] = ["-std=c99", "-O2", "-ffreestanding", "-ffp-contract=off", "-c"];
/// Rungs of a function of plain equations: what gcc compiles to the fastest code in acceptable time.
const RUNGS_A_FUNCTION: usize = 64;
/// Scans of which the instructions are counted.
const COUNTED_SCANS: u64 = 64;

/// What became of a compiler.
pub(super) enum Outcome {
    /// It is not installed.
    Missing,
    /// It was stopped after this time.
    TooSlow(Duration),
    Compiled(Compiled),
}

/// A program that a compiler compiled.
pub(super) struct Compiled {
    folder: TempDir,
    pub(super) compile: Duration,
    pub(super) code_bytes: usize,
    /// What the process starts with: the image and the inputs.
    start: Vec<u8>,
    size: usize,
}

/// Compiles a program as an engine says: `optimised` for the C that Rung emits, `lowered` for equations, which are left to the
/// compiler.
///
/// # Errors
/// When the program cannot be C, or the compiler or linker refuses it.
pub(super) fn compile(
    engine: Engine,
    lowered: &Program,
    optimised: &Program,
    patience: Duration,
) -> Result<Outcome, Failure> {
    let Some(compiler) = engine.compiler().filter(|compiler| is_installed(compiler)) else {
        return Ok(Outcome::Missing);
    };
    let interface = Interface::new("ladder", CYCLE).map_err(|error| fails(&error.to_string()))?;
    let text = match engine {
        Engine::GccEquations | Engine::ClangEquations => c::equations(lowered, &interface, RUNGS_A_FUNCTION),
        Engine::GccWhole => c::equations(lowered, &interface, usize::MAX),
        _ => c::emit(optimised, &interface),
    };
    let text = text.map_err(|problems| {
        let first = problems.first().map_or("", |problem| problem.message.as_str());
        Failure::hinted(Code::NotACName, first, "rename it, or leave the C compilers out by --engine")
    })?;
    let folder = tempfile::tempdir().map_err(|error| fails(&format!("no temporary folder: {error}")))?;
    let path = |name: &str| folder.path().join(name);
    let write = |name: &str, text: &str| fs::write(path(name), text).map_err(|error| fails(&error.to_string()));
    write("ladder.c", &text)?;
    write("harness.c", include_str!("harness.c"))?;
    let start = Instant::now();
    let mut command = Command::new(compiler);
    command.current_dir(folder.path()).args(OPTIONS).args(["-o", "ladder.o", "ladder.c"]);
    if !finishes(&mut command, patience)? {
        return Ok(Outcome::TooSlow(patience));
    }
    let compile = start.elapsed();
    let code_bytes = code_bytes(&path("ladder.o"))?;
    let constants = [format!("-DCYCLE={CYCLE}"), format!("-DCHANGE={SCANS_PER_CHANGE}u")];
    let mut link = Command::new(compiler);
    link.current_dir(folder.path()).args(["-std=c99", "-O2"]).args(constants);
    link.args(["-o", "harness", "harness.c", "ladder.o"]);
    finishes(&mut link, Duration::MAX)?;
    let plant = Plant::new(lowered);
    Ok(Outcome::Compiled(Compiled { compile, code_bytes, start: plant.start(), size: plant.image().len(), folder }))
}

fn is_installed(compiler: &str) -> bool {
    let version = Command::new(compiler).arg("--version").stdout(Stdio::null()).stderr(Stdio::null()).status();
    version.is_ok_and(|status| status.success())
}

fn fails(message: &str) -> Failure {
    Failure::new(Code::CompilerFails, message)
}

/// Runs a command; false where it was stopped because it took too long.
fn finishes(command: &mut Command, patience: Duration) -> Result<bool, Failure> {
    let name = command.get_program().display().to_string();
    let cannot = |error: std::io::Error| fails(&format!("{name} cannot be run: {error}"));
    let said = tempfile::tempfile().map_err(cannot)?;
    let errors = said.try_clone().map_err(cannot)?;
    let mut child = command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(errors).spawn().map_err(cannot)?;
    let start = Instant::now();
    let status = loop {
        if let Some(status) = child.try_wait().map_err(cannot)? {
            break status;
        }
        if start.elapsed() > patience {
            child.kill().and_then(|()| child.wait()).map_err(cannot)?;
            return Ok(false);
        }
        // Short beside what a compiler takes to start.
        std::thread::sleep(Duration::from_millis(1));
    };
    if status.success() {
        return Ok(true);
    }
    Err(fails(&format!("{name} does not compile what Rung wrote, {status}: {}", text_of(said))))
}

/// What was written to a file, as far as it is worth showing.
fn text_of(mut file: fs::File) -> String {
    use std::io::Seek;
    let mut text = Vec::new();
    let read = file.rewind().and_then(|()| file.take(2000).read_to_end(&mut text));
    if read.is_ok() { String::from_utf8_lossy(&text).into_owned() } else { String::new() }
}

/// Bytes of machine code in an object.
fn code_bytes(path: &Path) -> Result<usize, Failure> {
    let bytes = fs::read(path).map_err(|error| fails(&error.to_string()))?;
    let object = object::File::parse(bytes.as_slice()).map_err(|error| fails(&error.to_string()))?;
    let code = object.sections().filter(|section| section.kind() == SectionKind::Text);
    Ok(code.map(|section| usize::try_from(section.size()).unwrap_or(usize::MAX)).sum())
}

impl Compiled {
    fn program(&self) -> PathBuf {
        self.folder.path().join("harness")
    }

    /// The program in a new process.
    ///
    /// # Errors
    /// When it does not start.
    pub(super) fn process(&self) -> Result<Process, Failure> {
        let child = Command::new(self.program()).stdin(Stdio::piped()).stdout(Stdio::piped()).spawn();
        let mut child = child.map_err(|error| fails(&error.to_string()))?;
        let (Some(input), Some(output)) = (child.stdin.take(), child.stdout.take()) else {
            return Err(fails("a program without a standard input"));
        };
        let mut process = Process { child, input, output };
        process.input.write_all(&self.start).map_err(|error| fails(&error.to_string()))?;
        Ok(process)
    }

    /// The image after so many scans.
    ///
    /// # Errors
    /// When the program does not run.
    pub(super) fn image_after(&self, scans: u64) -> Result<Vec<u8>, Failure> {
        let mut process = self.process()?;
        process.run(scans)?;
        process.image(self.size)
    }

    /// Instructions of a scan, counted by callgrind on average over some; `None` where that is not installed.
    pub(super) fn instructions(&self) -> Option<f64> {
        let mut commands = self.start.clone();
        commands.extend(COUNTED_SCANS.to_ne_bytes());
        let file = self.folder.path().join("commands");
        fs::write(&file, commands).ok()?;
        let count = Command::new("valgrind")
            .current_dir(self.folder.path())
            .args(["--tool=callgrind", "--toggle-collect=ladder_scan", "--callgrind-out-file=/dev/null"])
            .arg(self.program())
            .stdin(fs::File::open(file).ok()?)
            .stdout(Stdio::null())
            .output()
            .ok()?;
        let said = String::from_utf8_lossy(&count.stderr);
        let counted = said.lines().find_map(|line| line.split_once("Collected :"))?.1;
        Some(counted.trim().parse::<f64>().ok()? / to_f64(COUNTED_SCANS))
    }
}

/// A running program.
pub(super) struct Process {
    child: Child,
    input: ChildStdin,
    output: ChildStdout,
}

impl Process {
    /// Runs scans, at least one; gives nanoseconds a scan.
    ///
    /// # Errors
    /// When the program has ended, which only a wrong one does.
    pub(super) fn run(&mut self, scans: u64) -> Result<f64, Failure> {
        let mut spent = [0; 8];
        let done = self.input.write_all(&scans.to_ne_bytes()).and_then(|()| self.output.read_exact(&mut spent));
        done.map_err(|error| fails(&format!("the compiled program ended: {error}")))?;
        Ok(to_f64(u64::from_ne_bytes(spent)) / to_f64(scans))
    }

    fn image(&mut self, size: usize) -> Result<Vec<u8>, Failure> {
        let mut image = vec![0; size];
        let done = self.input.write_all(&0u64.to_ne_bytes()).and_then(|()| self.output.read_exact(&mut image));
        done.map_err(|error| fails(&format!("the compiled program ended: {error}")))?;
        Ok(image)
    }
}

impl Drop for Process {
    fn drop(&mut self) {
        // It ends with its input, too; that it has ended already is no error.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}
