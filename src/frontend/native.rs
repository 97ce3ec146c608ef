//! The native text, `.rung`.
use super::Parsed;
use crate::source::Source;
/// Reads native text.
pub fn parse(_source: &Source) -> Parsed {
    unimplemented!()
}
