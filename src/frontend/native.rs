//! The native text, `.rung`: for people to write, review and diff. `docs/native-text.md` is its reference.
//!
//! [`parse`] reads it and [`print()`] writes its one canonical form; parse, print, parse is the identity but for
//! spans. Syntax only: nothing here may look a name up, know a block or judge a type.

mod declarations;
mod elements;
mod expressions;
mod lexer;
pub(super) mod literals;
mod parser;
mod print;
mod rungs;
mod token;

pub use print::print;

use super::Parsed;
use crate::source::Source;

/// How deep circuits, parentheses and expressions may nest. A limit, so that no text can exhaust the stack of
/// whatever walks the program.
pub const MAXIMUM_DEPTH: usize = 128;

/// How many words, signs and comments a file may have, those copied to the names of one declaration included. Each makes
/// at most some hundred bytes of a program, so that no file takes more than a few gigabytes.
pub const MOST_TOKENS: usize = 1 << 22;

/// How many diagnostics one run gives before it stops reading.
pub const MOST_DIAGNOSTICS: usize = 200;

/// Reads native text. After a syntax error it goes on at the next declaration or rung, and the program holds the
/// others.
pub fn parse(source: &Source) -> Parsed {
    parser::Parser::new(source, MOST_TOKENS).program()
}
