//! The native text, `.rung`: for people to write, review and diff. `docs/native-text.md` is its reference.
//!
//! [`parse`] reads it and [`print()`] writes its one canonical form; parse, print, parse is the identity but for
//! spans. Syntax only: nothing here may look a name up, know a block or judge a type.

mod declarations;
mod elements;
mod parser;
pub(super) mod print;
mod rungs;
mod units;

pub use print::print;

pub use super::text::{MAXIMUM_DEPTH, MOST_DIAGNOSTICS, MOST_TOKENS};

use super::Parsed;
use crate::source::Source;

/// Reads native text. After a syntax error it goes on at the next declaration or rung, and the program holds the
/// others.
pub fn parse(source: &Source) -> Parsed {
    parser::Parser::new(source, MOST_TOKENS).program()
}
