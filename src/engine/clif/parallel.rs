//! All chunks of a program, compiled side by side on all cores. The code does not depend on how many there are.

use std::ops::Range;
use std::sync::atomic::{AtomicUsize, Ordering};

use super::{Chunk, CompileError, Compiler};
use crate::engine::target::{Target, first_beyond};
use crate::logic::Program;

/// The code of every chunk of a verified program, in order.
///
/// # Errors
/// The error of the first chunk that has one; or that the program computes with reals and the target cannot.
pub fn compile(program: &Program, target: &Target) -> Result<Vec<Chunk>, CompileError> {
    compile_some(program, &program.chunks(), target)
}

/// The code of some of the chunks of a verified program, in the order in which they are given.
///
/// # Errors
/// As of [`compile`].
pub fn compile_some(program: &Program, chunks: &[Range<usize>], target: &Target) -> Result<Vec<Chunk>, CompileError> {
    if let Some(section) = first_beyond(program, target.floats()) {
        return Err(CompileError::NeedsFpu { target: target.to_string(), section });
    }
    let workers = std::thread::available_parallelism().map_or(1, usize::from).min(chunks.len());
    let next = AtomicUsize::new(0);
    let work = || {
        let mut compiler = Compiler::new(program, &**target.isa());
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
