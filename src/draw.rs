//! Draws ladder programs: in characters for a terminal, and as an SVG picture.
//!
//! A program is drawn as it stands, checked or not, with errors or without. One layout places everything on a
//! grid of characters, and two renderers read what it made, so that both pictures show the same. Drawing is pure:
//! it must do no I/O, and never panic, whatever the program holds.
//!
//! The way of a rung: `network` makes nested groups of sized `symbol`s, `grid` gives them cells and folds them to
//! the width, `place` makes `shape`s of them; `page` puts the rungs below each other under the declarations, and
//! `text` or `svg` renders the page.

mod grid;
mod label;
mod network;
mod overview;
mod page;
mod place;
mod shape;
mod statements;
mod svg;
mod symbol;
mod text;

use crate::ladder::Program;

/// The narrowest text picture, in columns; a smaller width counts as this.
pub const MINIMUM_WIDTH: usize = 20;
/// The widest text picture, in columns; a greater width counts as this.
pub const MAXIMUM_WIDTH: usize = 1000;
/// The columns of an SVG picture: a landscape page at a readable size.
const SVG_WIDTH: usize = 110;

/// How to draw for a terminal.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct TextOptions {
    /// The columns that a line may take, from [`MINIMUM_WIDTH`] to [`MAXIMUM_WIDTH`]. Only a rung with a block that is
    /// wider by itself takes more, which none is from 40 columns on.
    pub width: usize,
}

impl Default for TextOptions {
    /// 100 columns.
    fn default() -> Self {
        Self { width: 100 }
    }
}

/// Draws a program with box-drawing characters. Every line ends with a line feed and none with a blank.
pub fn text(program: &Program, options: &TextOptions) -> String {
    text::render(&page::Page::of(program, options.width.clamp(MINIMUM_WIDTH, MAXIMUM_WIDTH)))
}

/// Draws a program as an SVG document. The same program always gives the same bytes.
pub fn svg(program: &Program) -> String {
    svg::render(&page::Page::of(program, SVG_WIDTH))
}
