//! `rung build`: a program as logic, as Cranelift's intermediate form or as assembly, and the map of its image.

use std::path::{Path, PathBuf};

use clap::ValueEnum;

use super::{Failure, Missing, load_checked, read_source, write_whole};
use crate::diagnostic::Code;
use crate::engine::jit::{Jit, host_isa};
use crate::engine::{clif, disassemble};
use crate::logic::image::EarlierLayout;
use crate::logic::{self, Program, map};
use crate::lower::lower;
use crate::opt::PASSES;

/// The stage before any pass, for `--after`.
const LOWER: &str = "lower";

/// Compiles a program and writes what became of it
#[derive(Debug, clap::Args)]
pub(super) struct Arguments {
    /// The program; `-` is the standard input
    file: PathBuf,
    #[command(flatten)]
    missing: Missing,
    /// What to write [default: logic, unless only a map is asked for]
    #[arg(long, value_enum)]
    emit: Option<Emit>,
    /// Where to write it; `-` is the standard output
    #[arg(short, long, value_name = "FILE", default_value = "-")]
    output: PathBuf,
    /// Stop after this pass; `lower` is before the first one, and an unknown one lists them
    #[arg(long, value_name = "PASS")]
    after: Option<String>,
    /// Write the map of the process image, in JSON
    #[arg(long, value_name = "FILE.json")]
    map: Option<PathBuf>,
    /// The map of an earlier build: what it places stays in its place
    #[arg(long, value_name = "FILE.json")]
    previous_map: Option<PathBuf>,
}

#[derive(Clone, Copy, PartialEq, Eq, Debug, ValueEnum)]
enum Emit {
    /// The logic IR, as text
    Logic,
    /// Cranelift's intermediate form for this machine
    Clif,
    /// This machine's code, disassembled
    Asm,
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let passes = passes_until(arguments.after.as_deref())?;
    let (loaded, checked) = load_checked(&arguments.file, arguments.missing)?;
    let earlier = arguments.previous_map.as_deref().map(read_map).transpose()?;
    let program = lower(&checked, &loaded.source, earlier.as_ref())
        .map_err(|_| Failure::new(Code::ImageTooLarge, "the process image is too large"))?;
    let program = PASSES[..passes].iter().fold(program, |program, pass| (pass.run)(program));
    // All texts are made before the first is written.
    let emit = arguments.emit.or(arguments.map.is_none().then_some(Emit::Logic));
    let text = emit.map(|emit| emitted(emit, &program)).transpose()?;
    if let Some(path) = &arguments.map {
        write_whole(path, map::write_map(&program, loaded.source.name()).as_bytes())?;
    }
    text.map_or(Ok(()), |text| write_whole(&arguments.output, text.as_bytes()))
}

/// How many passes run.
fn passes_until(after: Option<&str>) -> Result<usize, Failure> {
    let Some(after) = after else { return Ok(PASSES.len()) };
    if after == LOWER {
        return Ok(0);
    }
    PASSES.iter().position(|pass| pass.name == after).map(|index| index + 1).ok_or_else(|| {
        let names: Vec<&str> = std::iter::once(LOWER).chain(PASSES.iter().map(|pass| pass.name)).collect();
        Failure::new(Code::UndeclaredName, format!("there is no pass `{after}`, but {}", names.join(", ")))
    })
}

fn read_map(path: &Path) -> Result<EarlierLayout, Failure> {
    let source = read_source(path)?;
    map::read_map(&source).map_err(|problem| Failure::diagnostics(&source, &[problem]))
}

fn emitted(emit: Emit, program: &Program) -> Result<String, Failure> {
    let refused = |reason: String| Failure::new(Code::CannotCompile, reason);
    match emit {
        Emit::Logic => Ok(logic::print(program)),
        Emit::Clif => {
            let isa = host_isa().map_err(|error| refused(error.to_string()))?;
            Ok(clif::text(program, &*isa))
        }
        Emit::Asm => {
            let isa = host_isa().map_err(|error| refused(error.to_string()))?;
            let jit = Jit::compile(program).map_err(|error| refused(error.to_string()))?;
            disassemble::listing(program, jit.chunks(), isa.triple()).map_err(refused)
        }
    }
}
