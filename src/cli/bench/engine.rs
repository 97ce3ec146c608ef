//! What is measured: Rung's engines in this process, and programs of C compilers in their own.

use std::time::{Duration, Instant};

use rung_runtime::Scan;
use target_lexicon::Triple;

use super::compiler::{Compiled, Process};
use super::plant::Plant;
use crate::cli::Failure;
use crate::diagnostic::Code;
use crate::engine::disassemble::lines;
use crate::engine::interp::{Interpreter, Textbook};
use crate::engine::jit::{Jit, host_isa};
use crate::logic::Program;
use crate::opt;

/// An engine, or a compiler and what it compiles.
#[derive(Clone, Copy, PartialEq, Eq, Debug, clap::ValueEnum)]
pub(super) enum Engine {
    /// Compiled in this process
    Jit,
    /// Interpreted, as fast as an interpreter can be
    Interp,
    /// Interpreted one operation after the other
    Textbook,
    /// gcc -O2 on the C that Rung emits
    GccC,
    /// gcc -O2 on plain equations, 64 rungs a function
    GccEquations,
    /// clang -O2 on the C that Rung emits
    ClangC,
    /// clang -O2 on plain equations, 64 rungs a function
    ClangEquations,
    /// gcc -O2 on plain equations, all rungs in one function, which takes it minutes
    GccWhole,
}

impl Engine {
    pub(super) const ALL: [Self; 8] = [
        Self::Jit,
        Self::Interp,
        Self::Textbook,
        Self::GccC,
        Self::GccEquations,
        Self::ClangC,
        Self::ClangEquations,
        Self::GccWhole,
    ];

    pub(super) const fn name(self) -> &'static str {
        match self {
            Self::Jit => "jit",
            Self::Interp => "interp",
            Self::Textbook => "textbook",
            Self::GccC => "gcc-c",
            Self::GccEquations => "gcc-equations",
            Self::ClangC => "clang-c",
            Self::ClangEquations => "clang-equations",
            Self::GccWhole => "gcc-whole",
        }
    }

    /// The command of the compiler, of those that need one.
    pub(super) const fn compiler(self) -> Option<&'static str> {
        match self {
            Self::Jit | Self::Interp | Self::Textbook => None,
            Self::GccC | Self::GccEquations | Self::GccWhole => Some("gcc"),
            Self::ClangC | Self::ClangEquations => Some("clang"),
        }
    }
}

/// What is known of an engine before it runs.
pub(super) struct Facts {
    /// From the lowered program on, passes and all.
    pub(super) compile: Duration,
    /// Bytes of machine code, or of what the engine has in its place.
    pub(super) code_bytes: usize,
    /// Machine instructions of a scan: exact, since the code is a straight line. `None` where they are not known.
    pub(super) instructions: Option<usize>,
}

/// Something that is ready to run.
pub(super) enum Subject<'p> {
    /// An engine in this process, and its plant.
    Native {
        scan: Box<dyn Scan>,
        plant: Plant<'p>,
    },
    Compiled {
        compiled: Compiled,
        process: Process,
    },
}

impl<'p> Subject<'p> {
    /// An engine of this process on a program that is lowered and not yet optimised.
    ///
    /// # Errors
    /// When it cannot be compiled.
    pub(super) fn native(engine: Engine, lowered: &'p Program) -> Result<(Self, Facts), Failure> {
        let input = lowered.clone();
        let start = Instant::now();
        let program = opt::optimise(input);
        let (scan, code_bytes, instructions, compile): (Box<dyn Scan>, _, _, _) = match engine {
            Engine::Interp => {
                let interpreter = Interpreter::new(&program);
                let (compile, bytes) = (start.elapsed(), interpreter.code_bytes());
                (Box::new(interpreter), bytes, None, compile)
            }
            Engine::Textbook => {
                let textbook = Textbook::new(&program);
                let (compile, bytes) = (start.elapsed(), size_of_val(program.instructions.as_slice()));
                (Box::new(textbook), bytes, None, compile)
            }
            _ => {
                let jit =
                    Jit::compile(&program).map_err(|error| Failure::new(Code::CannotCompile, error.to_string()))?;
                let compile = start.elapsed();
                let instructions = host_isa().ok().and_then(|isa| instructions(&jit, isa.triple()).ok());
                let bytes = jit.code_bytes();
                (Box::new(jit), bytes, instructions, compile)
            }
        };
        let subject = Self::Native { scan, plant: Plant::new(lowered) };
        Ok((subject, Facts { compile, code_bytes, instructions }))
    }

    /// A program of a C compiler.
    ///
    /// # Errors
    /// When it does not start.
    pub(super) fn compiled(compiled: Compiled) -> Result<Self, Failure> {
        let process = compiled.process()?;
        Ok(Self::Compiled { compiled, process })
    }

    /// The image after so many scans from the start, on a plant or in a process of its own.
    ///
    /// # Errors
    /// When a compiled program does not run.
    pub(super) fn image_after(&mut self, program: &Program, scans: u64) -> Result<Vec<u8>, Failure> {
        match self {
            Self::Native { scan, .. } => {
                let mut plant = Plant::new(program);
                plant.run(scan.as_mut(), scans);
                Ok(plant.image().to_vec())
            }
            Self::Compiled { compiled, .. } => compiled.image_after(scans),
        }
    }

    /// Runs scans, at least one; gives nanoseconds a scan.
    ///
    /// # Errors
    /// When a compiled program has ended.
    pub(super) fn run(&mut self, scans: u64) -> Result<f64, Failure> {
        match self {
            Self::Native { scan, plant, .. } => Ok(plant.run(scan.as_mut(), scans)),
            Self::Compiled { process, .. } => process.run(scans),
        }
    }
}

/// Machine instructions of one scan.
fn instructions(jit: &Jit, target: &Triple) -> Result<usize, String> {
    jit.chunks().iter().map(|chunk| Ok(lines(&chunk.code[..chunk.instruction_bytes], target)?.len())).sum()
}
