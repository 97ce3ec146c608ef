//! The JIT: every chunk of a program compiled for this machine, and those of the tasks that are due called in order.
//!
//! Code generation is [`clif`]'s; here it is installed and called, and nothing else.

mod memory;
pub(super) mod segments;
#[cfg(test)]
mod tests;

use std::io;
use std::ops::Range;
use std::sync::atomic::{AtomicUsize, Ordering};

use cranelift_codegen::isa::OwnedTargetIsa;
use rung_runtime::Scan;

pub use super::clif::CompileError;
use super::clif::{self, Chunk, Compiler};
use crate::logic::{Program, Turn};
use memory::Code;

/// Cranelift's code generator for this machine, with all that its processor offers.
///
/// # Errors
/// [`CompileError::NoBackEnd`] when Cranelift was built without one.
pub fn host_isa() -> Result<OwnedTargetIsa, CompileError> {
    let builder = cranelift_native::builder().map_err(|reason| CompileError::NoBackEnd(reason.to_owned()))?;
    let flags = clif::flags().map_err(|error| CompileError::NoBackEnd(error.to_string()))?;
    builder.finish(flags).map_err(|error| CompileError::NoBackEnd(error.to_string()))
}

/// A compiled program.
#[derive(Debug)]
pub struct Jit {
    /// Each task: when it is due, and its chunks.
    tasks: Vec<(Turn, Range<usize>)>,
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
        let isa = host_isa()?;
        let chunks = compile_chunks(program, &isa)?;
        Self::install(program, chunks).map_err(CompileError::Memory)
    }

    /// Makes a program's chunks ready to run.
    fn install(program: &Program, chunks: Vec<Chunk>) -> io::Result<Self> {
        let code = Code::install(&chunks, program.layout.size() as usize)?;
        let before = |section: usize| chunks.partition_point(|chunk| chunk.sections.start < section);
        let tasks = (0..program.tasks.len())
            .map(|task| {
                let sections = program.task_range(task);
                (Turn::of(&program.tasks[task], &program.layout), before(sections.start)..before(sections.end))
            })
            .collect();
        Ok(Self { tasks, chunks, code })
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

/// The code of every chunk, in order, or the error of the first that has one.
fn compile_chunks(program: &Program, isa: &OwnedTargetIsa) -> Result<Vec<Chunk>, CompileError> {
    let chunks = program.chunks();
    let workers = std::thread::available_parallelism().map_or(1, usize::from).min(chunks.len());
    let next = AtomicUsize::new(0);
    let work = || {
        let mut compiler = Compiler::new(program, &**isa);
        let mut done = Vec::new();
        loop {
            let index = next.fetch_add(1, Ordering::Relaxed);
            let Some(sections) = chunks.get(index) else { return done };
            done.push((index, compiler.chunk(sections.clone())));
        }
    };
    let mut done: Vec<(usize, Result<Chunk, CompileError>)> = if workers <= 1 {
        work()
    } else {
        std::thread::scope(|scope| {
            let others: Vec<_> = (1..workers).map(|_| scope.spawn(work)).collect();
            let mut done = work();
            for other in others {
                match other.join() {
                    Ok(more) => done.extend(more),
                    Err(panic) => std::panic::resume_unwind(panic),
                }
            }
            done
        })
    };
    done.sort_unstable_by_key(|(index, _)| *index);
    done.into_iter().map(|(_, chunk)| chunk).collect()
}

impl Scan for Jit {
    fn scan(&mut self, image: &mut [u8], now: i64) {
        for (turn, chunks) in &self.tasks {
            if turn.take(image, now) {
                self.code.run(chunks.clone(), image, now);
            }
        }
    }
}
