//! A program as one file of C: portable C99, freestanding, for every compiler and core that Cranelift has no code for.
//!
//! The functions are those of an object file of the same program, and compute the same to the bit. A scan is a straight
//! line without a data-dependent branch, written to be read: each rung's comment stands above it, and variables have
//! their names. No recursion, no dynamic memory, no library, and nothing that C leaves undefined, whatever the data.

mod body;
mod equations;
mod expression;
mod frame;
mod helper;
mod library;
mod operation;

use std::fmt::Write;

use super::header::{INCLUDES, declarations, head};
use super::names;
use super::notes::{Notes, comment};
use super::structure::Structure;
use crate::diagnostic::Diagnostic;
use crate::interface::Interface;
use crate::logic::{Program, verify};
use crate::source::Span;
use body::{Body, Places};
pub use equations::equations;
use library::Library;

/// A verified program as C.
///
/// # Errors
/// [`Code::NotACName`](crate::diagnostic::Code::NotACName) for every name that C cannot spell.
pub fn emit(program: &Program, interface: &Interface) -> Result<String, Vec<Diagnostic>> {
    emit_with(program, interface, &Notes::default())
}

/// A verified program as C, with comments from its source.
///
/// # Errors
/// As [`emit`].
pub fn emit_with(program: &Program, interface: &Interface, notes: &Notes) -> Result<String, Vec<Diagnostic>> {
    debug_assert_eq!(verify(program), Ok(()), "emitters take verified programs only");
    names::validate(program, interface, &|_, _| Span::default())?;
    let mut structure = Structure::new(program);
    let (definition, clock) = structure.text(interface, notes);
    let mut library = Library::default();
    let chunks = chunks(program, &structure, notes, interface.prefix());
    let frame = frame::frame(program, &structure, interface, &clock, &chunks);
    chunks.iter().for_each(|chunk| library.take_calls(&chunk.text));
    let helpers: String = helper::definitions(&chunks.iter().map(|chunk| chunk.text.as_str()).collect::<String>());
    library.take_calls(&helpers);
    library.take_calls(&frame);

    let mut text = head(program, notes, "the program as C");
    text.push_str(GUIDE);
    let _ = write!(text, "\n{INCLUDES}");
    if uses_reals(program) {
        text.push_str(REALS);
    }
    let _ = write!(text, "\n{definition}\n{}", declarations(interface));
    if chunks.iter().any(|chunk| chunk.text.contains("_APART ")) {
        text.push_str(&APART.replace("@P", interface.prefix()));
    }
    text.push_str(&library.text());
    text.push_str(&helpers);
    for chunk in &chunks {
        text.push_str(&chunk.text);
    }
    text.push_str(&frame);
    Ok(text)
}

/// The function of a chunk.
struct Chunk {
    /// Where its sections start.
    start: usize,
    /// How it is called, but for the pointer to the image.
    name: String,
    uses_now: bool,
    text: String,
}

/// The functions of all chunks that do anything.
fn chunks(program: &Program, structure: &Structure<'_>, notes: &Notes, prefix: &str) -> Vec<Chunk> {
    let sections: Vec<_> = program
        .chunks()
        .into_iter()
        .filter(|sections| !program.instruction_range(sections.clone()).is_empty())
        .collect();
    let apart = if sections.len() > 1 { format!("{prefix}_APART ") } else { String::new() };
    let chunk = |(number, sections): (usize, std::ops::Range<usize>)| {
        let mut body = Body::new(program, Places::Image(structure), program.instruction_range(sections.clone()));
        for section in sections.clone() {
            body.heading(&heading(program, section, notes));
            for place in program.section_range(section) {
                body.instruction(place);
            }
        }
        let (body, name) = (body.finish(), format!("rungs_{}", number + 1));
        let uses_now = reads_now(&body);
        let now = if uses_now { ", const int64_t now" } else { "" };
        let text = format!("\nstatic {apart}void {name}({prefix}_image_t *const image{now})\n{{\n{body}}}\n");
        let is_empty = !body.contains("image->");
        (!is_empty).then_some(Chunk { start: sections.start, name, uses_now, text })
    };
    sections.into_iter().enumerate().filter_map(chunk).collect()
}

/// Whether statements read the time, which is no member.
fn reads_now(body: &str) -> bool {
    let is_part = |character: char| character.is_ascii_alphanumeric() || "_>".contains(character);
    let code = body.lines().filter(|line| !line.trim_start().starts_with("/*"));
    code.flat_map(|line| line.split(|character| !is_part(character))).any(|word| word == "now")
}

/// The comment above a rung.
fn heading(program: &Program, section: usize, notes: &Notes) -> String {
    let origin = &program.origins[program.sections[section].origin as usize];
    let mut heading = format!("/* {}", comment(&origin.label));
    if let Some(title) = notes.titles.get(&origin.line) {
        let _ = write!(heading, ": {}", comment(title));
    }
    if origin.line > 0 {
        let _ = write!(heading, " (line {})", origin.line);
    }
    heading + " */"
}

fn uses_reals(program: &Program) -> bool {
    program.instructions.iter().any(|instruction| instruction.ty.is_real())
}

const GUIDE: &str = "
/*
 * Freestanding C99: compile it with
 *
 *     cc -std=c99 -O2 -ffreestanding -ffp-contract=off -c
 *
 * and link it with the rest of the firmware. The scan is a straight line without data-dependent branches; every
 * operation is defined for all operands. Conversions to signed types of fewer bits keep the low bits.
 */
";

const REALS: &str = "
/* Each operation on real numbers is rounded once, to its own type: not fused, not in a wider type, not reordered. */
#if defined(__clang__)
#pragma STDC FP_CONTRACT OFF
#endif
#if defined(__FLT_EVAL_METHOD__)
#if (__FLT_EVAL_METHOD__ != 0) && (__FLT_EVAL_METHOD__ != 16)
#error \"compile with arithmetic in the operands' own types, such as -msse2 -mfpmath=sse\"
#endif
#endif
#if defined(__FAST_MATH__)
#error \"compile without -ffast-math\"
#endif
";

const APART: &str = "
/* Functions of so many rungs each: in one they would take a compiler minutes. */
#if defined(__GNUC__)
#define @P_APART __attribute__((noinline))
#else
#define @P_APART
#endif
";
