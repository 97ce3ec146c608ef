//! The native text, `.rung`.
use super::Parsed;
use crate::source::Source;
/// Reads native text.
pub fn parse(_source: &Source) -> Parsed {
    unimplemented!()
}
/// Prints native text.
pub fn print(_program: &crate::ladder::Program) -> String {
    String::new()
}
