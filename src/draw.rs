//! Drawing ladders.
use crate::ladder::Program;

/// How to draw as text.
#[derive(Clone, Copy, Debug)]
pub struct TextOptions {
    /// Columns.
    pub width: usize,
}

/// The ladder as text.
pub fn text(_program: &Program, _options: &TextOptions) -> String {
    unimplemented!()
}

/// The ladder as a picture.
pub fn svg(_program: &Program) -> String {
    unimplemented!()
}
