//! The JIT: every chunk of a program compiled for this machine, and those of the tasks that are due called in order.
//!
//! Code generation is [`clif`]'s; here it is installed and called, and nothing else.

mod edited;
mod memory;
pub(super) mod segments;
#[cfg(test)]
mod tests;

use std::io;
use std::ops::Range;

use cranelift_codegen::isa::OwnedTargetIsa;
use rung_runtime::Scan;

pub use super::clif::CompileError;
use super::clif::{self, Chunk};
use super::target::Target;
use crate::logic::{Program, Turn};
pub use edited::{Edited, Update};
use memory::{Call, Code};

/// Cranelift's code generator for this machine, with all that its processor offers.
///
/// # Errors
/// [`CompileError::NoBackEnd`] when Cranelift was built without one.
pub fn host_isa() -> Result<OwnedTargetIsa, CompileError> {
    host().map(|target| target.isa().clone())
}

fn host() -> Result<Target, CompileError> {
    Target::host().map_err(|refused| CompileError::NoBackEnd(refused.message))
}

/// A compiled program.
#[derive(Debug)]
pub struct Jit {
    /// Each task: when it is due, and its chunks.
    tasks: Vec<(Turn, Range<usize>)>,
    /// Whether all tasks are due in every scan.
    always: bool,
    chunks: Vec<Chunk>,
    code: Code,
}

impl Jit {
    /// Compiles every chunk of a verified program for this machine, on all its cores. The code does not depend on
    /// how many there are.
    ///
    /// # Errors
    /// When there is no back end for this machine, a chunk passes Cranelift's limits, or memory is refused.
    pub fn compile(program: &Program) -> Result<Self, CompileError> {
        let chunks = clif::compile(program, &host()?)?;
        Self::install(program, chunks).map_err(CompileError::Memory)
    }

    /// Makes a program's chunks ready to run.
    fn install(program: &Program, chunks: Vec<Chunk>) -> io::Result<Self> {
        let calls = Call::install(&chunks)?;
        Ok(Self::of(program, chunks, calls))
    }

    /// The same of chunks that are installed.
    fn of(program: &Program, chunks: Vec<Chunk>, calls: Vec<Call>) -> Self {
        let code = Code::new(calls, program.layout.size() as usize);
        let before = |section: usize| chunks.partition_point(|chunk| chunk.sections.start < section);
        let tasks = (0..program.tasks.len())
            .map(|task| {
                let sections = program.task_range(task);
                (Turn::of(&program.tasks[task], &program.layout), before(sections.start)..before(sections.end))
            })
            .collect();
        let always = program.tasks.iter().all(|task| task.interval.is_none());
        Self { tasks, always, chunks, code }
    }

    /// Runs the tasks that are due. It is apart from [`Scan::scan`], which otherwise would save registers for it in every scan.
    #[inline(never)]
    fn run_due(&self, image: &mut [u8], now: i64) {
        for (turn, chunks) in &self.tasks {
            if turn.take(image, now) {
                self.code.run(chunks.clone(), image, now);
            }
        }
    }

    /// Bytes of machine code, padding between chunks not counted.
    pub fn code_bytes(&self) -> usize {
        self.chunks.iter().map(|chunk| chunk.code.len()).sum()
    }

    /// The chunks, in order, with their code.
    pub fn chunks(&self) -> &[Chunk] {
        &self.chunks
    }
}

impl Scan for Jit {
    fn scan(&mut self, image: &mut [u8], now: i64) {
        if self.always { self.code.run_all(image, now) } else { self.run_due(image, now) }
    }
}
