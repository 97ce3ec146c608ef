//! What a placed picture consists of: the one thing that layout makes and renderers read.
//!
//! Places are in columns and rows of one terminal character, from 0 at the top left. A wire ends at the middle or
//! at a side of a character, so that its ends are counted in halves: `2 * column` is the left side of a column,
//! `2 * column + 1` its middle.

/// A placed rung, from rail to rail.
pub(super) struct Picture {
    /// Width, rails included.
    pub(super) columns: usize,
    /// Height.
    pub(super) rows: usize,
    pub(super) shapes: Vec<Shape>,
}

/// Which part of a text keeps its place when a renderer's letters are wider or narrower than columns.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Align {
    Left,
    Middle,
    Right,
}

/// What a text is.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Role {
    /// The name of a variable, or an expression.
    Name,
    /// The name of a block's instance.
    Instance,
    /// The type of a block.
    Type,
    /// The name of a pin.
    Pin,
    /// What is wired to a pin.
    Wired,
}

/// One thing of a picture.
pub(super) enum Shape {
    /// A power rail over rows `top..bottom`.
    Rail { x: usize, top: usize, bottom: usize },
    /// A wire in a row; its ends are in halves.
    Horizontal { y: usize, from: usize, to: usize },
    /// A wire in the middle of a column, from the middle of one row to that of another.
    Vertical { x: usize, top: usize, bottom: usize },
    /// A contact's frame and mark, three columns from `x`.
    Contact { x: usize, y: usize, mark: char },
    /// A coil's frame and mark, three columns from `x`.
    Coil { x: usize, y: usize, mark: char },
    /// A frame through the middles of its outermost characters.
    Frame { x: usize, y: usize, columns: usize, rows: usize },
    /// A text from column `x`. A renderer whose letters have another width puts its left end, middle or right end
    /// at `anchor`, in halves.
    Text { x: usize, y: usize, text: String, anchor: usize, align: Align, role: Role },
    /// The connector of a node, `>name>`.
    Node { x: usize, y: usize, columns: usize, text: String },
    /// Two columns where a wire leaves a strip: an arrow and a number from 0.
    Leaves { x: usize, y: usize, number: usize },
    /// Two columns where a wire comes back in the next strip: the number and an arrow.
    Returns { x: usize, y: usize, number: usize },
}
