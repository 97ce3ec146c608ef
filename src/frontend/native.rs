//! The native text, `.rung`.
use super::Parsed;
use crate::source::Source;
/// Reads native text.
pub fn parse(_source: &Source) -> Parsed {
    unimplemented!()
}

/// Prints a program in its one canonical form.
pub fn print(_program: &crate::ladder::Program) -> String {
    unimplemented!()
}
