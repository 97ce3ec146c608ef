//! Places the groups of a network on a grid of cells and rows, and folds a grid that is too wide into strips.
//!
//! Every element takes one cell, and all cells of one number are equally wide, so that a grid can be cut between
//! any two cells through nothing but wires. The places between cells are *boundaries*; boundary `b` is left of
//! cell `b`. A boundary has two sides: branches join on its left, `2 * b`, and split on its right, `2 * b + 1`.
//! Most boundaries are one column wide, and the sides fall together; where a grid is cut or stretched they do not.

use super::network::{Group, Line, Part};
use super::symbol::Symbol;

/// Columns that a strip needs at its right beyond its last boundary: an arrow, a number, and the rail.
const LEAVING: usize = 3;
/// The column of the first boundary of a strip that wires return to: behind the rail, a number and an arrow.
pub(super) const RETURNED: usize = 3;
/// The least columns of a cell, that of a plain wire.
const LEAST_COLUMNS: usize = 3;

/// A network on its grid.
pub(super) struct Grid {
    /// Symbols with their cell and row.
    pub(super) symbols: Vec<(usize, usize, Symbol)>,
    /// Wires from one side of a boundary to one of the same or a later boundary, in order of their rows wherever
    /// a line is drawn down through the grid.
    pub(super) wires: Vec<GridWire>,
    /// Vertical wires.
    pub(super) verticals: Vec<GridVertical>,
    /// The row of the network's own left side.
    pub(super) entry: usize,
    /// Whether it ends at the right rail.
    pub(super) joins_right: bool,
    /// For each cell, the column of the boundary at its left.
    pub(super) left: Vec<usize>,
    /// For each cell, the column of the boundary at its right.
    pub(super) right: Vec<usize>,
    /// For each cell, its columns without the boundaries; a stretched last cell has more before its right boundary.
    pub(super) columns: Vec<usize>,
    /// For each cell, its strip.
    pub(super) strip: Vec<usize>,
    /// The first of the cells that belong beside the right rail.
    tail: usize,
}

/// A wire along a row.
pub(super) struct GridWire {
    pub(super) row: usize,
    /// A side of a boundary.
    pub(super) from: usize,
    /// A side of a boundary, at or behind `from`.
    pub(super) to: usize,
}

/// A wire from row to row at a side of a boundary.
pub(super) struct GridVertical {
    pub(super) side: usize,
    pub(super) top: usize,
    pub(super) bottom: usize,
}

impl Grid {
    /// Places a network, folded so that its strips take at most `width` columns, but at least one cell each.
    pub(super) fn new(network: Group, width: usize) -> Self {
        let cells = network.cells;
        let joins_right = network.lines.iter().any(|line| line.joins_right);
        let mut grid = Self {
            symbols: Vec::new(),
            wires: Vec::new(),
            verticals: Vec::new(),
            entry: network.above,
            joins_right,
            left: Vec::new(),
            right: Vec::new(),
            columns: vec![LEAST_COLUMNS; cells],
            strip: Vec::new(),
            tail: cells - tail_cells(&network).unwrap_or(0),
        };
        let row = network.above;
        grid.group(network, 0, row, cells);
        grid.fold(width);
        grid
    }

    fn group(&mut self, group: Group, cell: usize, row: usize, cells: usize) {
        let (mut splits, mut joins) = (row, row);
        let mut line_row = row;
        for (index, line) in group.lines.into_iter().enumerate() {
            if index > 0 {
                line_row += line.above;
            }
            if line.joins_left {
                splits = line_row;
            }
            if line.joins_right {
                joins = line_row;
            }
            let below = line.below;
            self.line(line, cell, line_row, cells);
            line_row += below + 1;
        }
        for (side, bottom) in [(2 * cell + 1, splits), (2 * (cell + cells), joins)] {
            if bottom > row {
                self.verticals.push(GridVertical { side, top: row, bottom });
            }
        }
    }

    fn line(&mut self, line: Line, cell: usize, row: usize, cells: usize) {
        let end = cell + cells;
        let tail_cells: usize = line.parts[line.tail..].iter().map(Part::cells).sum();
        let mut at = cell;
        let mut wired_to = 2 * cell + 1;
        for (index, part) in line.parts.into_iter().enumerate() {
            let start = if index == line.tail { end - tail_cells } else { at };
            if index > 0 || line.joins_left {
                self.wire(row, wired_to, 2 * start + 1);
            }
            at = start + part.cells();
            wired_to = 2 * at;
            match part {
                Part::Symbol(symbol) => self.symbols.push((start, row, symbol)),
                Part::Group(group) => {
                    let cells = group.cells;
                    self.group(group, start, row, cells);
                }
            }
        }
        if line.joins_right {
            self.wire(row, wired_to, 2 * end);
        }
    }

    fn wire(&mut self, row: usize, from: usize, to: usize) {
        if from < to {
            self.wires.push(GridWire { row, from, to });
        }
    }

    /// Gives every cell its columns and its strip.
    fn fold(&mut self, width: usize) {
        for (cell, _, symbol) in &self.symbols {
            self.columns[*cell] = self.columns[*cell].max(symbol.columns);
        }
        let last = self.columns.len() - 1;
        let (mut left, mut strip) = (0, 0);
        for (cell, columns) in self.columns.iter().enumerate() {
            let needed = left + columns + 2 + if cell < last { LEAVING } else { 0 };
            if needed > width && cell > 0 {
                left = RETURNED;
                strip += 1;
            }
            self.left.push(left);
            left += columns + 1;
            self.right.push(left);
            self.strip.push(strip);
        }
    }

    /// The strip that a side of a boundary is in.
    pub(super) fn strip_at(&self, side: usize) -> usize {
        self.strip[side_cell(side)]
    }

    /// The column of a side of a boundary.
    pub(super) fn column_at(&self, side: usize) -> usize {
        let columns = if side % 2 == 1 { &self.left } else { &self.right };
        columns[side_cell(side)]
    }

    /// How many strips there are.
    pub(super) fn strips(&self) -> usize {
        self.strip.last().map_or(0, |last| last + 1)
    }

    /// How many columns the widest strip takes, rails included.
    pub(super) fn total_columns(&self) -> usize {
        let last = self.strips().saturating_sub(1);
        let ends = self.right.iter().zip(&self.strip);
        ends.map(|(right, strip)| right + if *strip < last { LEAVING } else { 0 } + 1).max().unwrap_or(0)
    }

    /// Moves what belongs at the right rail there, the rail being at that column.
    pub(super) fn stretch(&mut self, rail: usize) {
        let Some(end) = self.right.last().copied() else { return };
        if !self.joins_right || end >= rail {
            return;
        }
        let cells = self.right.len();
        let first = self.strip.partition_point(|strip| *strip + 1 < self.strips());
        let tail = self.tail.max(first).min(cells);
        for left in &mut self.left[tail..] {
            *left += rail - end;
        }
        for right in &mut self.right[tail.min(cells - 1)..] {
            *right += rail - end;
        }
    }
}

/// The cell whose side a side of a boundary is: the one at its right for a split, at its left for a join.
fn side_cell(side: usize) -> usize {
    if side % 2 == 1 { side / 2 } else { (side / 2).saturating_sub(1) }
}

/// How many cells at the right end of a group hold outputs: those of the first line that ends with some.
fn tail_cells(group: &Group) -> Option<usize> {
    group.lines.iter().filter(|line| line.joins_right).find_map(|line| match line.parts[line.tail..] {
        [] => match line.parts.last() {
            Some(Part::Group(last)) => tail_cells(last),
            _ => None,
        },
        ref tail => Some(tail.iter().map(Part::cells).sum()),
    })
}
