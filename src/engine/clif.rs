//! One chunk of logic to one Cranelift function and its machine code, for any target.
//!
//! Pure: nothing is installed, linked or run here. A function takes all its pointers as arguments, so that its code
//! has no relocation and can be put anywhere, compiled in parallel and replaced while others run:
//!
//! ```text
//! extern "C" fn(base0: *mut u8, now: i64, base1: *mut u8, …)     each base: image + Chunk::bases[i]
//! ```
//!
//! A chunk that [calls helpers](Chunk::calls_helpers) takes one argument more, behind the last base: a pointer to the
//! table of them: [`HELPERS`](super::helpers::HELPERS), and one at [`COPY`](super::helpers::COPY).
//!
//! Code is straight line: it must never branch on data, but for the operations in [`BRANCHING`]. Helpers do, and take
//! a time that depends on their operands. It computes exactly what [`evaluate`](crate::logic::evaluate) says, with
//! every value in integer registers; BOOL is the low byte of 8 or 32 bits, of which the others mean nothing.

mod array;
mod content;
mod integer;
mod lower;
mod parallel;
mod place;
mod real;
#[cfg(all(test, feature = "all-targets"))]
mod targets;
#[cfg(test)]
mod tests;

use std::fmt;
use std::ops::Range;

use cranelift_codegen::control::ControlPlane;
use cranelift_codegen::ir::{AbiParam, Function, Signature, UserFuncName, types};
use cranelift_codegen::isa::{CallConv, TargetIsa};
use cranelift_codegen::settings::{self, Configurable, SetError};
use cranelift_codegen::{CodegenResult, CompiledCode, Context};
use cranelift_frontend::FunctionBuilderContext;
use target_lexicon::Architecture;

use crate::diagnostic::Code;
use crate::logic::{Binary, Op, Program, verify};
use lower::Built;

pub(super) use array::copy_is_called;
pub(super) use content::Comparison;
pub use parallel::{compile, compile_some};

/// Pointers into the image that each chunk is given, so that most offsets from one of them are short. With the time
/// they fill the six registers for arguments of x86-64; with eight of them code is 2 bytes a rung shorter, but has
/// more instructions and runs no faster.
pub const BASES: usize = 5;

/// Values of a chunk that may wait for their use at one time. Cranelift's time grows with the square of their number,
/// and the stack by 8 bytes with each, which the code does not probe. A rung of people has some ten.
pub const ALIVE: usize = 4096;

/// Bytes of an array up to which a copy is moves one after another; a longer one is a call of a helper.
pub const MOVED: u32 = 1024;

/// Why there is no code.
#[derive(Debug)]
pub enum CompileError {
    /// Cranelift, as it was built, has no back end for this machine, or refuses a setting.
    NoBackEnd(String),
    /// The program computes with reals that the target has no registers for.
    NeedsFpu {
        /// The target.
        target: String,
        /// The first section that does.
        section: usize,
    },
    /// Cranelift refused a chunk, as one with too many values for it.
    Chunk {
        /// The sections of the chunk.
        sections: Range<usize>,
        /// What Cranelift says, or which limit of ours is passed.
        reason: String,
    },
    /// The object cannot be written.
    Object(String),
    /// Code or image are beyond the reach of the target's calls and addresses; the message says by how much.
    TooLarge(String),
    /// No executable memory was to be had.
    Memory(std::io::Error),
}

impl fmt::Display for CompileError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoBackEnd(reason) => write!(f, "no code generator for this machine: {reason}"),
            Self::NeedsFpu { target, section } => {
                write!(f, "section {section} computes with reals, and {target} has no floating point for them")
            }
            Self::Chunk { sections, reason } => {
                write!(f, "sections {} to {} cannot be compiled: {reason}", sections.start, sections.end)
            }
            Self::Object(reason) => write!(f, "no object can be written: {reason}"),
            Self::TooLarge(reason) => f.write_str(reason),
            Self::Memory(error) => write!(f, "no executable memory: {error}"),
        }
    }
}

impl std::error::Error for CompileError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            Self::Memory(error) => Some(error),
            Self::NoBackEnd(_) | Self::NeedsFpu { .. } | Self::Chunk { .. } | Self::Object(_) | Self::TooLarge(_) => {
                None
            }
        }
    }
}

impl CompileError {
    /// The code of the error.
    pub fn code(&self) -> Code {
        match self {
            Self::NeedsFpu { .. } => Code::NeedsFpu,
            Self::TooLarge(_) => Code::TooLargeForTarget,
            Self::NoBackEnd(_) | Self::Chunk { .. } | Self::Object(_) | Self::Memory(_) => Code::CannotCompile,
        }
    }
}

/// An operation whose machine code holds a conditional branch on some targets.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Branching {
    /// The operation.
    pub op: Binary,
    /// The architectures, as their triples name them.
    pub architectures: &'static [&'static str],
    /// Why.
    pub reason: &'static str,
}

/// Every operation that is not straight line everywhere; all others are, and x86-64 has none of these. A call of a
/// helper is no branch of the chunk, but the helper branches.
pub const BRANCHING: &[Branching] = &[
    Branching {
        op: Binary::Divide,
        architectures: &["aarch64", "riscv64"],
        reason: "Cranelift tests a divisor that is not constant for zero; the branch is never taken",
    },
    Branching {
        op: Binary::Remainder,
        architectures: &["aarch64", "riscv64"],
        reason: "Cranelift tests a divisor that is not constant for zero; the branch is never taken",
    },
];

/// The machine code of a chunk.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Chunk {
    /// The sections that it was made from.
    pub sections: Range<usize>,
    /// The code, without relocations: instructions, then the constants that they read.
    pub code: Vec<u8>,
    /// Bytes of `code` that are instructions.
    pub instruction_bytes: usize,
    /// What its first byte must be aligned to, a power of two.
    pub alignment: u32,
    /// Offsets into the image, in bytes, of the pointers that it takes.
    pub bases: [u32; BASES],
    /// How many of those pointers the code looks at, the first ones.
    pub used_bases: usize,
    /// Whether it takes a pointer to the table of helpers, behind the last base.
    pub calls_helpers: bool,
    /// Where in the code a section's instructions begin, in the order of the code: `(offset, section)`. A section
    /// without code of its own is left out.
    pub marks: Vec<(u32, usize)>,
}

/// The settings that made the fastest code and the quickest compile; they hold for every target. Chunks hold no address
/// of anything; whether other functions find theirs in a table that the linker makes can be chosen.
///
/// # Errors
/// When this Cranelift knows one of them no longer.
pub fn flags(addresses_by_table: bool) -> Result<settings::Flags, SetError> {
    let mut builder = settings::builder();
    // `speed` makes larger code here and undoes the sinking of loads; the passes over logic do its work.
    builder.set("opt_level", "none")?;
    builder.set("regalloc_algorithm", "backtracking")?;
    builder.set("enable_verifier", if cfg!(debug_assertions) { "true" } else { "false" })?;
    builder.set("is_pic", if addresses_by_table { "true" } else { "false" })?;
    builder.set("unwind_info", "false")?;
    builder.set("enable_probestack", "false")?;
    builder.set("machine_code_cfg_info", "false")?;
    Ok(settings::Flags::new(builder))
}

/// Compiles chunks one after another, keeping Cranelift's memory between them.
pub struct Compiler<'a> {
    program: &'a Program,
    isa: &'a dyn TargetIsa,
    target: Target,
    context: Context,
    builder_context: FunctionBuilderContext,
}

impl fmt::Debug for Compiler<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Compiler({}, {})", self.program.name, self.isa.triple())
    }
}

impl<'a> Compiler<'a> {
    /// A compiler of a verified program for a target.
    pub fn new(program: &'a Program, isa: &'a dyn TargetIsa) -> Self {
        debug_assert_eq!(verify(program), Ok(()), "engines take verified programs only");
        let (context, builder_context) = (Context::new(), FunctionBuilderContext::new());
        Self { program, isa, target: Target::of(isa), context, builder_context }
    }

    /// The same, but with code written as for RISC-V, so that what only that target gets can be run in tests here.
    #[cfg(test)]
    pub(in crate::engine) fn written_for_riscv64(self) -> Self {
        Self { target: Target::RISCV64, ..self }
    }

    /// Compiles one of the program's [chunks](Program::chunks).
    ///
    /// # Errors
    /// [`CompileError::Chunk`] when Cranelift's limits or [`ALIVE`] are passed.
    pub fn chunk(&mut self, sections: Range<usize>) -> Result<Chunk, CompileError> {
        let Built { bases, used_bases, alive } = self.build(sections.clone());
        let refused = |reason: String| CompileError::Chunk { sections: sections.clone(), reason };
        if alive > ALIVE {
            return Err(refused(format!("{alive} values are needed at one time, and at most {ALIVE} may be")));
        }
        let compiled = generate(&mut self.context, self.isa).map_err(|error| refused(error.to_string()))?;
        if !compiled.buffer.relocs().is_empty() {
            return Err(refused("the code refers to something outside of itself".to_owned()));
        }
        let mut marks: Vec<(u32, usize)> = Vec::new();
        let mut instruction_bytes = 0;
        for location in compiled.buffer.get_srclocs_sorted() {
            instruction_bytes = location.end as usize;
            let Some(section) = section_at(location.loc) else { continue };
            if marks.last().is_none_or(|(_, last)| *last != section) {
                marks.push((location.start, section));
            }
        }
        let alignment = self.isa.function_alignment().minimum.max(compiled.buffer.alignment);
        let code = compiled.code_buffer().to_vec();
        let calls_helpers = calls_helpers(self.program, sections.clone());
        Ok(Chunk { sections, code, instruction_bytes, alignment, bases, used_bases, calls_helpers, marks })
    }

    /// Makes the function of a chunk in `self.context`.
    fn build(&mut self, sections: Range<usize>) -> Built {
        self.context.clear();
        let name = UserFuncName::user(0, u32::try_from(sections.start).unwrap_or(u32::MAX));
        self.context.func =
            Function::with_name_signature(name, signature(self.isa, calls_helpers(self.program, sections.clone())));
        lower::chunk(self.program, sections, self.isa, self.target, &mut self.context.func, &mut self.builder_context)
    }
}

/// What [`Context::compile`] does without optimisation, but that block parameters with one source stay: see
/// `Lowering::settled`.
pub(super) fn generate(context: &mut Context, isa: &dyn TargetIsa) -> CodegenResult<CompiledCode> {
    context.verify_if(isa)?;
    context.compute_cfg();
    context.compute_domtree();
    context.func.dfg.resolve_all_aliases();
    let Context { func, domtree, .. } = context;
    let stencil = isa.compile_function(func, domtree, &mut Default::default(), false, &mut ControlPlane::default())?;
    Ok(stencil.apply_params(&func.params))
}

/// Whether a chunk needs the table of helpers.
fn calls_helpers(program: &Program, sections: Range<usize>) -> bool {
    let mut instructions = sections.flat_map(|section| &program.instructions[program.section_range(section)]);
    instructions.any(|instruction| match instruction.op {
        Op::Call(..) => true,
        Op::CopyArray(to, ..) => copy_is_called(program, to),
        _ => false,
    })
}

/// What a chunk's function takes.
fn signature(isa: &dyn TargetIsa, calls_helpers: bool) -> Signature {
    let mut signature = Signature::new(CallConv::triple_default(isa.triple()));
    let pointer = AbiParam::new(isa.pointer_type());
    signature.params.push(pointer);
    signature.params.push(AbiParam::new(types::I64));
    signature.params.extend(std::iter::repeat_n(pointer, BASES - 1 + usize::from(calls_helpers)));
    signature
}

/// Source locations carry the section, counted from 1 since 0 may stand for none.
fn location_of(section: usize) -> cranelift_codegen::ir::SourceLoc {
    cranelift_codegen::ir::SourceLoc::new(u32::try_from(section + 1).unwrap_or(u32::MAX - 1))
}

fn section_at(location: cranelift_codegen::ir::SourceLoc) -> Option<usize> {
    if location.is_default() { None } else { (location.bits() as usize).checked_sub(1) }
}

/// The Cranelift functions of all chunks as text, each section headed by its label.
pub fn text(program: &Program, isa: &dyn TargetIsa) -> String {
    let mut compiler = Compiler::new(program, isa);
    let mut out = String::new();
    for sections in program.chunks() {
        let Built { bases, .. } = compiler.build(sections.clone());
        out.push_str(&format!(
            "; sections {} to {}, bases at image + {bases:?}\n",
            sections.start,
            sections.end.saturating_sub(1)
        ));
        let mut last = None;
        for line in compiler.context.func.display().to_string().lines() {
            // A line with a source location starts with it: `@0001`, in hexadecimal.
            let tag = line.split_whitespace().next().and_then(|word| word.strip_prefix('@'));
            let section = tag.and_then(|tag| usize::from_str_radix(tag, 16).ok()).and_then(|tag| tag.checked_sub(1));
            if section.is_some() && section != last {
                last = section;
                out.push_str(&heading(program, section.unwrap_or_default(), ";"));
            }
            out.push_str(line);
            out.push('\n');
        }
        out.push('\n');
    }
    out
}

/// The line that announces a section in a listing. Control characters of a label are left out.
pub(crate) fn heading(program: &Program, section: usize, comment: &str) -> String {
    let Some(origin) = program.sections.get(section).and_then(|s| program.origins.get(s.origin as usize)) else {
        return String::new();
    };
    let label: String = origin.label.chars().filter(|c| !c.is_control()).collect();
    format!("{comment} {label} (line {})\n", origin.line)
}

/// What of a target decides how code is written.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
struct Target {
    /// Whether the low byte of a 4-byte load at any address is the byte there, and the load can be part of AND and OR.
    wide_loads: bool,
    /// Whether a select becomes a branch, so that masks are wanted.
    select_branches: bool,
    /// Whether rotations are made of shifts: Cranelift's would branch, or be no shorter.
    rotates_by_shifts: bool,
    /// Whether a BOOL is held in 64 bits, all of which count, so that a mask is one instruction away. Else it is the low
    /// byte of what holds it.
    whole_bools: bool,
    /// Bits of a constant, with its sign, that fit into the instruction that uses it, or into one more.
    short_constant: u32,
    /// Whether 16 bytes can be moved at a time.
    wide_moves: bool,
    /// How far below and above a pointer an access is short.
    below: u32,
    above: u32,
}

impl Target {
    const RISCV64: Self = Self {
        wide_loads: false,
        select_branches: true,
        rotates_by_shifts: true,
        whole_bools: true,
        short_constant: 12,
        wide_moves: false,
        below: 2048,
        above: 2047,
    };

    const OTHER: Self = Self {
        wide_loads: false,
        select_branches: false,
        rotates_by_shifts: false,
        whole_bools: false,
        short_constant: 17,
        wide_moves: false,
        below: 0,
        above: 4095,
    };

    fn of(isa: &dyn TargetIsa) -> Self {
        let has = |name: &str| isa.isa_flags().iter().any(|flag| flag.name == name && flag.as_bool() == Some(true));
        match isa.triple().architecture {
            Architecture::X86_64 => {
                Self { wide_loads: true, wide_moves: true, short_constant: 64, below: 128, above: 127, ..Self::OTHER }
            }
            Architecture::Riscv64(_) => Self { select_branches: !has("has_zicond"), ..Self::RISCV64 },
            Architecture::Aarch64(_) => Self { wide_moves: true, ..Self::OTHER },
            _ => Self::OTHER,
        }
    }

    /// Whether a constant takes instructions of its own, so that it is worth to be kept in a register.
    fn is_long(&self, bits: u64) -> bool {
        let least = 1i64.checked_shl(self.short_constant - 1).unwrap_or(0);
        self.short_constant < 64 && !(-least..least).contains(&bits.cast_signed())
    }
}
