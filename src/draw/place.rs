//! From grids to a picture: every strip's rows, and the shapes of its wires and symbols.
//!
//! It must not make a picture out of proportion to the rung: where long wires would fill pages, there is none.

use super::grid::{Grid, RETURNED};
use super::label;
use super::shape::{Align, Picture, Role, Shape};
use super::symbol::{BlockBox, FRAME, Symbol, SymbolKind};

/// A picture may take this many characters, and more in proportion to its symbols.
const AREA: usize = 500_000;
/// Characters of the picture that each symbol allows beyond [`AREA`].
const AREA_OF_SYMBOL: usize = 1000;

/// The picture of a rung's networks, one below the other, between rails; `None` where it would be out of
/// proportion. `columns` is how many it should take.
pub(super) fn picture(mut grids: Vec<Grid>, columns: usize) -> Option<Picture> {
    let columns = grids.iter().map(Grid::total_columns).max().unwrap_or(0).max(columns);
    let rail = columns.saturating_sub(1);
    let mut placer = Placer { rail, rows: 0, shapes: Vec::new() };
    let symbols: usize = grids.iter().map(|grid| grid.symbols.len()).sum();
    let mut area_left = AREA.saturating_add(symbols.saturating_mul(AREA_OF_SYMBOL));
    for grid in &mut grids {
        grid.stretch(rail);
        // Counted before they are made.
        let pieces = grid.wires.iter().map(|wire| grid.strip_at(wire.to) - grid.strip_at(wire.from) + 1);
        area_left = area_left.checked_sub(pieces.sum())?;
        let strips = Strips::of(grid, placer.rows);
        area_left = area_left.checked_sub((strips.end - placer.rows).saturating_mul(columns))?;
        placer.grid(grid, &strips);
        placer.rows = strips.end;
    }
    for x in [0, rail] {
        placer.shapes.push(Shape::Rail { x, top: 0, bottom: placer.rows });
    }
    Some(Picture { columns, rows: placer.rows, shapes: placer.shapes })
}

/// Where the rows of each strip lie in the picture. A strip has only the rows that something in it uses, so that
/// what follows a high group does not keep its height.
struct Strips {
    /// For each strip, its first row in the grid and that row's place in the picture.
    tops: Vec<(usize, usize)>,
    /// For each strip, the number of the first wire that leaves it: no number comes twice in a network.
    first_numbers: Vec<usize>,
    /// The first row below all strips.
    end: usize,
}

impl Strips {
    fn of(grid: &Grid, top: usize) -> Self {
        let mut used = vec![(usize::MAX, 0); grid.strips()];
        let mut mark = |strip: usize, first: usize, last: usize| {
            if let Some((top, bottom)) = used.get_mut(strip) {
                *top = (*top).min(first);
                *bottom = (*bottom).max(last + 1);
            }
        };
        for (cell, row, symbol) in &grid.symbols {
            mark(grid.strip[*cell], row.saturating_sub(symbol.above), row + symbol.below);
        }
        for vertical in &grid.verticals {
            mark(grid.strip_at(vertical.side), vertical.top, vertical.bottom);
        }
        let mut leaving = vec![0; grid.strips()];
        for wire in &grid.wires {
            let (first, last) = (grid.strip_at(wire.from), grid.strip_at(wire.to));
            (first..=last).for_each(|strip| mark(strip, wire.row, wire.row));
            leaving[first..last].iter_mut().for_each(|count| *count += 1);
        }
        let mut number = 0;
        let first_numbers = leaving.into_iter().map(|count| (number, number += count).0).collect();
        let mut end = top;
        let tops = used.into_iter().map(|(first, last)| {
            let place = end;
            end += last.saturating_sub(first).max(1);
            (if first == usize::MAX { 0 } else { first }, place)
        });
        Self { tops: tops.collect(), first_numbers, end }
    }

    fn place(&self, strip: usize, row: usize) -> usize {
        self.tops.get(strip).map_or(row, |(first, place)| row.saturating_sub(*first) + place)
    }
}

/// The middle of a column, in halves.
const fn middle(column: usize) -> usize {
    2 * column + 1
}

/// The columns of a cell's boundaries, and its own columns behind the left one.
#[derive(Clone, Copy)]
struct Cell {
    left: usize,
    columns: usize,
    right: usize,
}

struct Placer {
    rail: usize,
    rows: usize,
    shapes: Vec<Shape>,
}

impl Placer {
    fn grid(&mut self, grid: &mut Grid, strips: &Strips) {
        self.wire(strips.place(0, grid.entry), middle(0), middle(grid.left.first().copied().unwrap_or(0)));
        for vertical in &grid.verticals {
            let strip = grid.strip_at(vertical.side);
            self.shapes.push(Shape::Vertical {
                x: grid.column_at(vertical.side),
                top: strips.place(strip, vertical.top),
                bottom: strips.place(strip, vertical.bottom),
            });
        }
        let mut next = strips.first_numbers.clone();
        for wire in &grid.wires {
            let (first, last) = (grid.strip_at(wire.from), grid.strip_at(wire.to));
            for strip in first..=last {
                let y = strips.place(strip, wire.row);
                let mut from = middle(grid.column_at(wire.from));
                let mut to = middle(grid.column_at(wire.to));
                if strip > first {
                    self.shapes.push(Shape::Returns { x: 1, y, number: next[strip - 1] - 1 });
                    from = 2 * RETURNED;
                }
                if strip < last {
                    self.shapes.push(Shape::Leaves { x: self.rail - 2, y, number: next[strip] });
                    next[strip] += 1;
                    to = 2 * (self.rail - 2);
                }
                self.wire(y, from, to);
            }
        }
        for (cell, row, symbol) in grid.symbols.drain(..) {
            let y = strips.place(grid.strip[cell], row);
            self.symbol(
                symbol,
                Cell { left: grid.left[cell], columns: grid.columns[cell], right: grid.right[cell] },
                y,
            );
        }
    }

    fn wire(&mut self, y: usize, from: usize, to: usize) {
        if from < to {
            self.shapes.push(Shape::Horizontal { y, from, to });
        }
    }

    fn symbol(&mut self, symbol: Symbol, cell: Cell, y: usize) {
        let Cell { left, columns, right } = cell;
        let x = left + 1;
        match symbol.kind {
            SymbolKind::Contact { mark, name } => {
                let frame = self.framed(name, cell, y);
                self.shapes.push(Shape::Contact { x: frame, y, mark });
            }
            SymbolKind::Coil { mark, name } => {
                let frame = self.framed(name, cell, y);
                self.shapes.push(Shape::Coil { x: frame, y, mark });
            }
            SymbolKind::Box { lines } => {
                let width = lines.iter().map(|line| label::width(line)).max().unwrap_or(0);
                let frame = x + (columns - (width + 4)) / 2;
                self.wire(y, middle(left), middle(frame));
                self.wire(y, middle(frame + width + 3), middle(right));
                self.shapes.push(Shape::Frame { x: frame, y: y - 1, columns: width + 4, rows: lines.len().max(1) + 2 });
                if let [only] = lines.as_slice() {
                    return self.text(2 * frame + width + 4, y, only.clone(), Align::Middle, Role::Name);
                }
                for (row, line) in lines.into_iter().enumerate() {
                    let text = line.trim_start();
                    let start = frame + 2 + label::width(&line) - label::width(text);
                    self.text(2 * start, y + row, text.to_owned(), Align::Left, Role::Name);
                }
            }
            SymbolKind::NodeStart { text } => {
                let width = label::width(&text);
                self.wire(y, 2 * (x + 1 + width), middle(right));
                self.shapes.push(Shape::Node { x: x + 1, y, columns: width, text });
            }
            SymbolKind::NodeEnd { text } => {
                let width = label::width(&text);
                self.wire(y, middle(left), 2 * (x + 1));
                self.shapes.push(Shape::Node { x: x + 1, y, columns: width, text });
            }
            SymbolKind::Jump { text } => {
                self.wire(y, middle(left), 2 * (x + 1));
                self.text_at(x + 1, y, text, 2 * (x + 1), Align::Left, Role::Name);
            }
            SymbolKind::Block(block) => {
                let frame = x + (columns - symbol.columns) / 2 + block.left_columns;
                self.wire(y, middle(left), middle(frame));
                self.wire(y, middle(frame + block.box_columns - 1), middle(right));
                self.block(block, frame, y);
            }
        }
    }

    /// Draws the name above a contact or coil and the wires at both sides of its frame; returns the frame's column.
    fn framed(&mut self, name: String, cell: Cell, y: usize) -> usize {
        let Cell { left, columns, right } = cell;
        let x = left + 1;
        let frame = x + (columns - FRAME) / 2;
        self.wire(y, middle(left), middle(frame));
        self.wire(y, middle(frame + FRAME - 1), middle(right));
        // The name's own middle may lie half a column off the frame's.
        let start = x + (columns - label::width(&name)) / 2;
        self.text_at(start, y - 1, name, 2 * frame + FRAME, Align::Middle, Role::Name);
        frame
    }

    fn block(&mut self, block: BlockBox, x: usize, y: usize) {
        let (columns, rows) = (block.box_columns, block.rows());
        let centre = 2 * x + columns;
        self.shapes.push(Shape::Frame { x, y: y - 2, columns, rows: rows + 3 });
        // A function has none, nor a row for it.
        if !block.instance.is_empty() {
            self.text(centre, y - 3, block.instance, Align::Middle, Role::Instance);
        }
        self.text(centre, y - 1, block.type_name, Align::Middle, Role::Type);
        for (row, pin) in block.left.into_iter().enumerate() {
            self.text(2 * (x + 1), y + row, pin.name, Align::Left, Role::Pin);
            if !pin.wired.is_empty() {
                self.wire(y + row, 2 * (x - 1), middle(x));
                self.text(2 * (x - 1), y + row, pin.wired, Align::Right, Role::Wired);
            }
        }
        let end = x + columns - 1;
        for (row, pin) in block.right.into_iter().enumerate() {
            self.text(2 * end, y + row, pin.name, Align::Right, Role::Pin);
            if !pin.wired.is_empty() {
                self.wire(y + row, middle(end), 2 * (end + 2));
                self.text(2 * (end + 3), y + row, pin.wired, Align::Left, Role::Wired);
            }
        }
    }

    /// Writes a text with its left end, middle or right end at a place in halves.
    fn text(&mut self, anchor: usize, y: usize, text: String, align: Align, role: Role) {
        let columns = label::width(&text);
        let x = match align {
            Align::Left => anchor / 2,
            Align::Middle => anchor.saturating_sub(columns) / 2,
            Align::Right => (anchor / 2).saturating_sub(columns),
        };
        self.text_at(x, y, text, anchor, align, role);
    }

    fn text_at(&mut self, x: usize, y: usize, text: String, anchor: usize, align: Align, role: Role) {
        if !text.is_empty() {
            self.shapes.push(Shape::Text { x, y, text, anchor, align, role });
        }
    }
}
