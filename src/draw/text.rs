//! Renders a page in characters. Wires are kept as the sides of a character that they touch, so that every join
//! comes out right whatever meets in it.

use super::label;
use super::page::{Page, RungPicture, Table};
use super::shape::{Picture, Shape};

const LEFT: u8 = 1;
const RIGHT: u8 = 2;
const UP: u8 = 4;
const DOWN: u8 = 8;
const RAIL: u8 = 16;

/// The characters of light wires, by the sides that they touch.
const WIRES: [char; 16] = [' ', '╴', '╶', '─', '╵', '┘', '└', '┴', '╷', '┐', '┌', '┬', '│', '┤', '├', '┼'];
/// The characters of a rail, by the sides at which wires touch it.
const RAILS: [char; 4] = ['┃', '┨', '┠', '╂'];
/// The numbers of folded wires; more than these begin again.
const NUMBERS: &str = "①②③④⑤⑥⑦⑧⑨⑩⑪⑫⑬⑭⑮⑯⑰⑱⑲⑳ⒶⒷⒸⒹⒺⒻⒼⒽⒾⒿⓀⓁⓂⓃⓄⓅⓆⓇⓈⓉⓊⓋⓌⓍⓎⓏ";

/// The page as lines.
pub(super) fn render(page: &Page) -> String {
    let mut out = String::new();
    line(&mut out, &page.title);
    if !page.overview.is_empty() {
        line(&mut out, "");
    }
    page.overview.iter().for_each(|text| line(&mut out, text));
    table(&mut out, &page.globals);
    for unit in &page.units {
        if !unit.heading.is_empty() {
            line(&mut out, "");
            line(&mut out, &unit.heading);
        }
        table(&mut out, &unit.declarations);
        unit.rungs.iter().for_each(|picture| rung(&mut out, picture));
    }
    out
}

fn line(out: &mut String, text: &str) {
    out.push_str(text.trim_end());
    out.push('\n');
}

fn rung(out: &mut String, rung: &RungPicture) {
    line(out, "");
    heading(out, rung);
    match &rung.picture {
        Ok(picture) => Canvas::of(picture).write(out),
        Err(note) => line(out, note),
    }
}

fn heading(out: &mut String, rung: &RungPicture) {
    for comment in &rung.comments {
        line(out, &format!("-- {comment}"));
    }
    for heading in &rung.heading {
        line(out, heading);
    }
}

fn table(out: &mut String, table: &Table) {
    if !table.rows.is_empty() {
        line(out, "");
    }
    for row in &table.rows {
        let mut text = String::new();
        for (start, cell) in table.starts.iter().zip(row) {
            let blanks = start.saturating_sub(label::width(&text));
            text.extend(std::iter::repeat_n(' ', blanks));
            text.push_str(cell);
        }
        line(out, &text);
    }
}

/// A picture in characters.
struct Canvas<'a> {
    columns: usize,
    /// The sides that wires touch, row after row.
    sides: Vec<u8>,
    /// The texts of each row.
    texts: Vec<Vec<(usize, std::borrow::Cow<'a, str>)>>,
}

impl<'a> Canvas<'a> {
    fn of(picture: &'a Picture) -> Self {
        let mut canvas = Self {
            columns: picture.columns,
            sides: vec![0; picture.columns * picture.rows],
            texts: vec![Vec::new(); picture.rows],
        };
        for shape in &picture.shapes {
            canvas.shape(shape);
        }
        canvas
    }

    fn shape(&mut self, shape: &'a Shape) {
        match shape {
            Shape::Rail { x, top, bottom } => (*top..*bottom).for_each(|y| self.touch(*x, y, RAIL)),
            Shape::Horizontal { y, from, to } => self.horizontal(*y, *from, *to),
            Shape::Vertical { x, top, bottom } => self.vertical(*x, *top, *bottom),
            Shape::Contact { x, y, mark } => self.text(*x, *y, format!("┤{mark}├")),
            Shape::Coil { x, y, mark } => self.text(*x, *y, format!("({mark})")),
            Shape::Frame { x, y, columns, rows } => {
                let (right, bottom) = (x + columns - 1, y + rows - 1);
                for row in [*y, bottom] {
                    self.horizontal(row, 2 * x + 1, 2 * right + 1);
                }
                for column in [*x, right] {
                    self.vertical(column, *y, bottom);
                }
            }
            Shape::Text { x, y, text, .. } | Shape::Node { x, y, text, .. } => self.text(*x, *y, text.as_str()),
            Shape::Leaves { x, y, number } => self.text(*x, *y, format!("→{}", numeral(*number))),
            Shape::Returns { x, y, number } => self.text(*x, *y, format!("{}→", numeral(*number))),
        }
    }

    fn touch(&mut self, x: usize, y: usize, sides: u8) {
        if let Some(character) = self.sides.get_mut(y * self.columns + x) {
            *character |= sides;
        }
    }

    fn horizontal(&mut self, y: usize, from: usize, to: usize) {
        for half in from..to {
            self.touch(half / 2, y, if half % 2 == 0 { LEFT } else { RIGHT });
        }
    }

    fn vertical(&mut self, x: usize, top: usize, bottom: usize) {
        for y in top..bottom {
            self.touch(x, y, DOWN);
            self.touch(x, y + 1, UP);
        }
    }

    fn text(&mut self, x: usize, y: usize, text: impl Into<std::borrow::Cow<'a, str>>) {
        if let Some(row) = self.texts.get_mut(y) {
            row.push((x, text.into()));
        }
    }

    fn write(mut self, out: &mut String) {
        for (sides, texts) in self.sides.chunks(self.columns.max(1)).zip(&mut self.texts) {
            texts.sort_by_key(|(x, _)| *x);
            let mut row = String::new();
            let mut x = 0;
            for (start, text) in texts {
                row.extend(sides[x.min(sides.len())..(*start).clamp(x, sides.len())].iter().map(wire));
                row.push_str(text);
                x = (*start).max(x) + label::width(text);
            }
            row.extend(sides[x.min(sides.len())..].iter().map(wire));
            line(out, &row);
        }
    }
}

fn wire(sides: &u8) -> char {
    if sides & RAIL == 0 { WIRES[usize::from(sides & 15)] } else { RAILS[usize::from(sides & 3)] }
}

fn numeral(number: usize) -> char {
    let count = NUMBERS.chars().count();
    NUMBERS.chars().nth(number % count).unwrap_or('①')
}
