//! A relocatable object of a program, for any target: the same chunks that the JIT installs, and around them the
//! functions and data of the [C interface](crate::interface).
//!
//! One lowering: what a rung computes is [`clif`]'s, and only when chunks run, how an image starts and how
//! time is latched is written here. An object must have no undefined symbol, no state but the tick counter and the
//! ready-made image, and the same bytes each time it is built. No function of it may branch on data, but for the listed
//! operations, the helpers, and the test in `P_scan` whether a task with an interval is due.

mod assembly;
mod clock;
mod helpers;
mod image;
mod reach;
mod round;
#[cfg(test)]
mod tests;

use super::clif::{self, Chunk, CompileError};
use super::target::Target;
use crate::interface::{ABI_VERSION, Interface, Symbol, image_size, retain_offset, retain_size};
use crate::logic::{Helper, Program};
use assembly::{Assembly, Contents};

/// What a function of an object is for.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Role {
    /// `P_init` or `P_save`: before and between scans.
    Image,
    /// `P_tick`.
    Tick,
    /// What `P_cycle` does before it scans.
    Cycle,
    /// What `P_scan` does beside the rungs.
    Round,
    /// A helper, or what copies long arrays.
    Helper,
}

/// The code of a function that is no chunk.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Function {
    /// Its symbol.
    pub name: String,
    /// What it is for.
    pub role: Role,
    /// The code, before relocations are applied: instructions, then the constants that they read.
    pub code: Vec<u8>,
    /// Bytes of `code` that are instructions.
    pub instruction_bytes: usize,
}

/// An object, and what it was made of.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Object {
    /// The file.
    pub bytes: Vec<u8>,
    /// The rungs' code, in order.
    pub chunks: Vec<Chunk>,
    /// The code of the helpers that are called.
    pub helpers: Vec<(Helper, Vec<Chunk>)>,
    /// All other code, in the order of the file.
    pub functions: Vec<Function>,
}

/// The object file of a verified program.
///
/// # Errors
/// When a chunk cannot be compiled, reals are computed without a floating point unit, or the code or the image is larger
/// than the target's calls and addresses reach.
pub fn build(program: &Program, interface: &Interface, target: &Target) -> Result<Vec<u8>, CompileError> {
    assemble(program, interface, target).map(|object| object.bytes)
}

/// The same, with the code that is in it.
///
/// # Errors
/// As [`build`].
pub fn assemble(program: &Program, interface: &Interface, target: &Target) -> Result<Object, CompileError> {
    let chunks = clif::compile(program, target)?;
    reach::check(target.triple(), &chunks, image_size(&program.layout))?;
    let mut assembly = Assembly::new(interface, target)?;
    data(&mut assembly, program)?;
    let counter = clock::counter(&mut assembly)?;
    let mut helpers = Vec::new();
    let table = helpers::table(&mut assembly, program, target, &chunks, &mut helpers)?;
    let round = round::write(&mut assembly, program, &chunks, table)?;
    image::write_init(&mut assembly, &program.layout, counter)?;
    image::write_save(&mut assembly, &program.layout)?;
    clock::write_tick(&mut assembly, counter)?;
    clock::write_cycle(&mut assembly, &program.layout, counter, round)?;
    let (bytes, functions) = assembly.finish(round)?;
    Ok(Object { bytes, chunks, helpers, functions })
}

/// The constants that firmware reads, and an image.
fn data(assembly: &mut Assembly<'_>, program: &Program) -> Result<(), CompileError> {
    let layout = &program.layout;
    assembly.export_data(Symbol::Image, Contents::Zeros(image_size(layout)))?;
    let words = [
        (Symbol::ImageSize, image_size(layout)),
        (Symbol::RetainOffset, retain_offset(layout)),
        (Symbol::RetainSize, retain_size(layout)),
        (Symbol::AbiVersion, ABI_VERSION),
    ];
    for (symbol, word) in words {
        assembly.export_data(symbol, Contents::Bytes(word.to_le_bytes().to_vec()))?;
    }
    assembly.export_data(Symbol::LayoutHash, Contents::Bytes(layout.hash().to_le_bytes().to_vec()))
}
