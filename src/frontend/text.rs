//! What the front ends of languages that are written as text share: words and signs, literals, expressions, references,
//! statements and types, with the limits and the recovery from errors. Each language has its own parser on top of
//! [`Reader`], which adds what only it has.
//!
//! Syntax only: nothing here may look a name up, know a block or judge a type.

mod expressions;
pub(crate) mod lexer;
pub(crate) mod literals;
mod reader;
mod statements;
pub(crate) mod token;
mod types;

pub(crate) use reader::{GivenUp, Parse, Reader};
pub(crate) use statements::Braces;

/// How deep circuits, parentheses, statements and expressions may nest. A limit, so that no text can exhaust the stack of
/// whatever walks the program.
pub const MAXIMUM_DEPTH: usize = 128;

/// How many words, signs and comments a file may have, those copied to the names of one declaration included. Each makes
/// at most some hundred bytes of a program, so that no file takes more than a few gigabytes.
pub const MOST_TOKENS: usize = 1 << 22;

/// How many diagnostics one run gives before it stops reading.
pub const MOST_DIAGNOSTICS: usize = 200;
