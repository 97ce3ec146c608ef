//! All chunks of a program, compiled side by side on all cores. The code does not depend on how many there are.

use std::ops::Range;

use super::{Chunk, CompileError, Compiler};
use crate::engine::target::{Target, first_beyond};
use crate::logic::Program;
use crate::parallel;

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
    let start = || Compiler::new(program, &**target.isa());
    let work = |compiler: &mut Compiler<'_>, index: usize| compiler.chunk(chunks[index].clone());
    parallel::each(chunks.len(), start, work).into_iter().collect()
}
