//! A header for firmware: the structure of the image, its offsets asserted, and the functions of the interface.
//!
//! It stands in every translation unit of C and C++ that uses the program, beside those of other programs, and must define
//! nothing: of an object file and of emitted C it is the same.

use std::fmt::Write;

use super::notes::{Notes, comment};
use super::structure::Structure;
use super::{names, structure};
use crate::diagnostic::Diagnostic;
use crate::interface::Interface;
use crate::logic::Program;
use crate::source::Span;

/// The header of a verified program.
///
/// # Errors
/// [`Code::NotACName`](crate::diagnostic::Code::NotACName) for every name that C cannot spell.
pub fn emit(program: &Program, interface: &Interface) -> Result<String, Vec<Diagnostic>> {
    emit_with(program, interface, &Notes::default())
}

/// The same with comments from the source.
///
/// # Errors
/// As [`emit`].
pub fn emit_with(program: &Program, interface: &Interface, notes: &Notes) -> Result<String, Vec<Diagnostic>> {
    names::validate(program, interface, &|_, _| Span::default())?;
    let prefix = interface.prefix();
    let (structure, _) = Structure::new(program).text(interface, notes);
    let mut text = head(program, notes, "the interface to firmware");
    let _ = write!(
        text,
        "\n#ifndef {prefix}_RUNG_H\n#define {prefix}_RUNG_H\n\n{INCLUDES}\n#ifdef __cplusplus\nextern \"C\" {{\n\
         #endif\n\n{structure}\n{}\n#ifdef __cplusplus\n}}\n#endif\n\n#endif\n",
        declarations(interface)
    );
    Ok(text)
}

/// What emitted C and a header include: both headers are there without a library, too.
pub(super) const INCLUDES: &str = "#include <stddef.h>\n#include <stdint.h>\n";

/// The comment that opens a file.
pub(super) fn head(program: &Program, notes: &Notes, what: &str) -> String {
    let mut text =
        format!("/*\n * {}: {what}.\n *\n * Written by rung {}", comment(&program.name), env!("CARGO_PKG_VERSION"));
    if !notes.source.is_empty() {
        let _ = write!(text, " from {}", comment(&notes.source));
    }
    text.push_str("; do not edit.\n */\n");
    text
}

/// The declarations of all that a built program exports.
pub(super) fn declarations(interface: &Interface) -> String {
    TEMPLATE.replace("@P", interface.prefix()).replace("@TICK", &structure::nanoseconds(interface.tick()))
}

const TEMPLATE: &str = r"/* One image, ready-made; several are fine, each a structure of its own. @P_init comes first. */
extern @P_image_t @P_image;

/* The bytes of an image. */
extern const uint32_t @P_image_size;

/* The first byte of an image that is retained, and how many bytes are; 0 and 0 if none. */
extern const uint32_t @P_retain_offset;
extern const uint32_t @P_retain_size;

/* Names the layout: retained bytes are only good for the layout that they were saved from. */
extern const uint64_t @P_layout_hash;

/* The version of this interface: 1. */
extern const uint32_t @P_abi_version;

/* Gives every variable its initial value, and the retained ones what @P_save wrote, unless that is NULL. */
void @P_init(void *image, const void *retained);

/* Writes the @P_retain_size bytes that are retained. */
void @P_save(const void *image, void *retained);

/* One scan at a time in nanoseconds since the start; BOOLs must be 0 or 1. */
void @P_scan(void *image, int64_t now);

/* To be called by the timer interrupt, every @TICK. */
void @P_tick(void);

/* One scan at the time that the ticks since @P_init tell; makes BOOLs of the inputs 0 or 1 first. */
void @P_cycle(void *image);
";
