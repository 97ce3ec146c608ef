//! `rung build`: a program as an object file, as logic, as Cranelift's intermediate form or as assembly of a target, and
//! the map of its image.

mod notes;
mod verify;

use std::path::{Path, PathBuf};

use clap::ValueEnum;

use super::{Failure, Missing, duration, load_checked, read_source, write_whole};
use crate::diagnostic::{Code, Diagnostic};
use crate::emit::{self, Notes};
use crate::engine::clif::{self, CompileError};
use crate::engine::target::{BadTarget, Target};
use crate::engine::{disassemble, object, report};
use crate::interface::{DEFAULT_PREFIX, DEFAULT_TICK, Interface};
use crate::load::Loaded;
use crate::logic::image::EarlierLayout;
use crate::logic::{self, Program, map};
use crate::lower::lower;
use crate::opt::{PASSES, Pass, optimise_by};
use crate::source::{Source, Span};

/// The stage before any pass, for `--after`.
const LOWER: &str = "lower";

/// Compiles a program and writes what became of it
#[derive(Debug, clap::Args)]
pub(super) struct Arguments {
    /// The program; `-` is the standard input
    file: PathBuf,
    #[command(flatten)]
    missing: Missing,
    /// What to write [default: obj with a target or for a file `.o`, c for a file `.c`; else logic, unless only a map, header or
    /// report is asked for]
    #[arg(long, value_enum)]
    emit: Option<Emit>,
    /// Where to write it; `-` is the standard output
    #[arg(short, long, value_name = "FILE", default_value = "-")]
    output: PathBuf,
    /// Make code for this machine [default: the one that Rung runs on]
    #[arg(long, value_name = "TRIPLE")]
    target: Option<String>,
    /// What its processor offers: an ISA string of RISC-V, such as rv64imac_zba, or features such as avx2,bmi1 or lse
    #[arg(long, value_name = "ISA")]
    isa: Option<String>,
    /// How C passes reals on RISC-V: lp64, lp64f or lp64d [default: what the ISA allows]
    #[arg(long, value_name = "ABI")]
    abi: Option<String>,
    /// What the names of all functions and data start with
    #[arg(long, value_name = "PREFIX", default_value = DEFAULT_PREFIX)]
    prefix: String,
    /// The period of the timer interrupt [default: 1ms]
    #[arg(long, value_name = "DURATION", value_parser = duration::parse)]
    tick: Option<i64>,
    /// Stop after this pass; `lower` is before the first one, and an unknown one lists them
    #[arg(long, value_name = "PASS")]
    after: Option<String>,
    /// Prove that the optimised program computes what the program says, and tell how much of it was proved
    #[arg(long)]
    verify: bool,
    /// Write a header for firmware: the structure of the image and the functions
    #[arg(long, value_name = "FILE.h")]
    header: Option<PathBuf>,
    /// Write the map of the process image, in JSON
    #[arg(long, value_name = "FILE.json")]
    map: Option<PathBuf>,
    /// Report what a scan of the object costs, rung by rung, in JSON where the file is named so [default: printed]
    #[arg(long, value_name = "FILE", num_args = 0..=1, require_equals = true, default_missing_value = "-")]
    report: Option<PathBuf>,
    /// The map of an earlier build: what it places stays in its place
    #[arg(long, value_name = "FILE.json")]
    previous_map: Option<PathBuf>,
}

#[derive(Clone, Copy, PartialEq, Eq, Debug, ValueEnum)]
enum Emit {
    /// An object file for the target, with the C interface
    Obj,
    /// The logic IR, as text
    Logic,
    /// Cranelift's intermediate form for the target
    Clif,
    /// The target's code, disassembled
    Asm,
    /// One file of C99 for any compiler, with the functions of an object file
    C,
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    build(arguments, PASSES)
}

/// The command with these passes.
fn build(arguments: &Arguments, passes: &[Pass]) -> Result<(), Failure> {
    let passes = passes_until(arguments.after.as_deref(), passes)?;
    let interface = Interface::new(&arguments.prefix, arguments.tick.unwrap_or(DEFAULT_TICK))
        .map_err(|refused| Failure::hinted(refused.code(), refused.to_string(), refused.hint()))?;
    let target = arguments.target()?;
    let (Loaded { source, program: drawing, .. }, checked) = load_checked(&arguments.file, arguments.missing)?;
    let notes = notes::of(&drawing, &source);
    drop(drawing);
    let earlier = arguments.previous_map.as_deref().map(read_map).transpose()?;
    let program = lower(&checked, &source, earlier.as_ref())
        .map_err(|_| Failure::new(Code::ImageTooLarge, "the process image is too large"))?;
    drop(checked);
    let program = if arguments.verify {
        let (program, said) = verify::optimised(program, passes, &source)?;
        super::report(&said);
        program
    } else {
        optimise_by(program, passes)
    };
    let place = |line, name: &str| place_of(&source, line, name);
    let emit = arguments.emit();
    if emit == Some(Emit::C) || arguments.header.is_some() {
        emit::validate(&program, &interface, &place).map_err(|problems| Failure::diagnostics(&source, &problems))?;
    }
    let built = Built { program: &program, interface: &interface, target: target.as_ref(), notes: &notes };
    // All outputs are made before the first is written.
    let output = emit.map(|emit| built.emitted(emit)).transpose()?;
    let header = arguments.header.as_deref().map(|path| Ok((path, built.header()?))).transpose()?;
    let costs = arguments.report.as_deref().map(|path| built.report(path)).transpose()?;
    if arguments.report.as_deref() == Some(Path::new("-")) && output.is_some() && arguments.output == Path::new("-") {
        let hint = "give the output a file with `-o`, or the report one with `--report=FILE`";
        return Err(Failure::hinted(Code::BadOptions, "output and report cannot both be printed", hint));
    }
    if let Some((path, text)) = header {
        write_whole(path, text.as_bytes())?;
    }
    if let Some(path) = &arguments.map {
        write_whole(path, map::write_map(&program, source.name()).as_bytes())?;
    }
    if let Some(output) = output {
        write_whole(&arguments.output, &output)?;
    }
    match (&arguments.report, costs) {
        (Some(path), Some(costs)) => write_whole(path, costs.as_bytes()),
        _ => Ok(()),
    }
}

impl Arguments {
    /// What to write, if anything beside what has an option of its own.
    fn emit(&self) -> Option<Emit> {
        let named = |name: &str| self.output.extension().is_some_and(|extension| extension == name);
        let beside = self.map.is_some() || self.header.is_some() || self.report.is_some();
        let printed = self.output == Path::new("-");
        match self.emit {
            // What has an option of its own is all that was asked for.
            None if printed && beside => None,
            None if named("c") => Some(Emit::C),
            None if self.target.is_some() || named("o") || named("obj") => Some(Emit::Obj),
            None => Some(Emit::Logic),
            given => given,
        }
    }

    /// The target that was asked for; `None` where nothing of it was said.
    fn target(&self) -> Result<Option<Target>, Failure> {
        let refused = |refused: BadTarget| Failure::hinted(refused.code, refused.message, refused.hint);
        let (isa, abi) = (self.isa.as_deref(), self.abi.as_deref());
        match &self.target {
            Some(triple) => Target::new(triple, isa, abi).map(Some).map_err(refused),
            None if isa.is_some() || abi.is_some() => {
                Target::new(&Target::host_triple(), isa, abi).map(Some).map_err(refused)
            }
            None => Ok(None),
        }
    }
}

/// Where a name stands in a line of the source, or else the line.
fn place_of(source: &Source, line: u32, name: &str) -> Span {
    let range = usize::try_from(line).ok().and_then(|line| source.line_range(line.checked_sub(1)?)).unwrap_or_default();
    let text = source.text().get(range.clone()).unwrap_or_default();
    let is_part = |character: char| character.is_alphanumeric() || character == '_';
    let is_word = |at: &usize| {
        !text[..*at].ends_with(is_part) && !text[at + name.len()..].starts_with(is_part) && !name.is_empty()
    };
    match text.match_indices(name).map(|(at, _)| at).find(is_word) {
        Some(at) => Span::new(range.start + at, range.start + at + name.len()),
        None => Span::new(range.start, range.start + text.trim_end().len()),
    }
}

/// What is wrong with a program that has no place in its source.
fn unplaced(problems: &[Diagnostic]) -> Failure {
    let text = |problem: &Diagnostic| match &problem.hint {
        Some(hint) => Failure::hinted(problem.code, &problem.message, hint),
        None => Failure::new(problem.code, &problem.message),
    };
    problems.first().map_or(Failure::Said, text)
}

/// The passes that run.
fn passes_until<'a>(after: Option<&str>, passes: &'a [Pass]) -> Result<&'a [Pass], Failure> {
    let Some(after) = after else { return Ok(passes) };
    if after == LOWER {
        return Ok(&[]);
    }
    passes.iter().position(|pass| pass.name == after).map(|index| &passes[..=index]).ok_or_else(|| {
        let names: Vec<&str> = std::iter::once(LOWER).chain(passes.iter().map(|pass| pass.name)).collect();
        Failure::new(Code::UndeclaredName, format!("there is no pass `{after}`, but {}", names.join(", ")))
    })
}

fn read_map(path: &Path) -> Result<EarlierLayout, Failure> {
    let source = read_source(path)?;
    map::read_map(&source).map_err(|problem| Failure::diagnostics(&source, &[problem]))
}

/// A program that is ready to be written in any form.
struct Built<'a> {
    program: &'a Program,
    interface: &'a Interface,
    /// The target that was asked for.
    target: Option<&'a Target>,
    /// What comments say.
    notes: &'a Notes,
}

impl Built<'_> {
    /// The target that was asked for, or the machine that Rung runs on with all that it has.
    fn target(&self) -> Result<Target, Failure> {
        self.target
            .cloned()
            .map_or_else(Target::host, Ok)
            .map_err(|refused| Failure::hinted(refused.code, refused.message, refused.hint))
    }

    /// The same for a file that is run elsewhere: without one that was asked for, any machine of this one's kind.
    fn object_target(&self) -> Result<Target, Failure> {
        match self.target {
            Some(target) => Ok(target.clone()),
            None => Target::new(&Target::host_triple(), None, None)
                .map_err(|refused| Failure::hinted(refused.code, refused.message, refused.hint)),
        }
    }

    /// The bytes of a form.
    fn emitted(&self, emit: Emit) -> Result<Vec<u8>, Failure> {
        match emit {
            Emit::Obj => {
                let target = self.object_target()?;
                object::build(self.program, self.interface, &target).map_err(|error| self.refused(&error))
            }
            Emit::Logic => Ok(logic::print(self.program).into_bytes()),
            Emit::C => emit::c::emit_with(self.program, self.interface, self.notes)
                .map(String::into_bytes)
                .map_err(|problems| unplaced(&problems)),
            Emit::Clif => Ok(clif::text(self.program, &**self.target()?.isa()).into_bytes()),
            Emit::Asm => {
                let target = self.target()?;
                let chunks = clif::compile(self.program, &target).map_err(|error| self.refused(&error))?;
                let listing = disassemble::listing(self.program, &chunks, target.triple());
                listing.map(String::into_bytes).map_err(|reason| Failure::new(Code::CannotCompile, reason))
            }
        }
    }

    /// What the object costs, as a table, or in JSON for a file that is named so.
    fn report(&self, path: &Path) -> Result<String, Failure> {
        let target = self.object_target()?;
        let object = object::assemble(self.program, self.interface, &target).map_err(|error| self.refused(&error))?;
        let report = report::report(self.program, &object, &target)
            .map_err(|reason| Failure::new(Code::CannotCompile, reason))?;
        let json = path.extension().is_some_and(|extension| extension == "json");
        Ok(if json { report.json() } else { report.table() })
    }

    fn header(&self) -> Result<String, Failure> {
        emit::header::emit_with(self.program, self.interface, self.notes).map_err(|problems| unplaced(&problems))
    }

    /// That there is no code, with the rung that is to blame.
    fn refused(&self, error: &CompileError) -> Failure {
        let failure = |hint: &str| Failure::hinted(error.code(), error.to_string(), hint);
        match error {
            CompileError::NeedsFpu { section, target } => {
                let section = &self.program.sections[*section];
                let origin = &self.program.origins[section.origin as usize];
                Failure::hinted(
                    error.code(),
                    format!("{} (line {}) computes with reals, and {target} cannot", origin.label, origin.line),
                    "take an `--isa` with F and D, or a C compiler with its own arithmetic: `--emit c`",
                )
            }
            CompileError::Chunk { .. } => failure("the interpreter runs it: `rung run --engine interp`"),
            CompileError::TooLarge(_) => failure("split the program in two, and build each with a prefix of its own"),
            CompileError::NoBackEnd(_) | CompileError::Object(_) | CompileError::Memory(_) => {
                Failure::new(error.code(), error.to_string())
            }
        }
    }
}
