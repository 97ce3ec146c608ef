//! Renders a page as an SVG document: the same places as in characters, drawn with lines.

use svg::Document;
use svg::node::element::{Circle, Group, Line, Path, Polygon, Rectangle, Style, Text, Title};

use super::label;
use super::page::{Page, RungPicture, Table};
use super::shape::{Align, Picture, Role, Shape};

/// Units that one column is wide.
const COLUMN: usize = 9;
/// Units that one row is high.
const ROW: usize = 20;
/// Units around everything.
const MARGIN: usize = 24;
/// Units from the middle of a row down to the line that letters stand on.
const BASELINE: f64 = 4.5;
/// Units that a contact or coil reaches above and below its wire.
const REACH: f64 = 9.0;

const STYLE: &str = "\
text{font:13px ui-monospace,'DejaVu Sans Mono',Menlo,Consolas,monospace;fill:#111}\
.program{font-size:18px;font-weight:bold}\
.heading,.column{font-weight:bold}\
.comment{font-style:italic;fill:#555}\
.type{font-weight:bold}\
.pin,.wired{font-size:12px}\
.number{font-size:9px}\
.wire,.sign,.frame,.rule{fill:none;stroke:#111;stroke-width:1.5}\
.sign{stroke-width:2}\
.rule{stroke:#999;stroke-width:1}\
.rail{stroke:#111;stroke-width:3}\
.node,.fold{fill:#fff;stroke:#111;stroke-width:1.2}\
.off{opacity:.45}";

/// The page as a document.
pub(super) fn render(page: &Page) -> String {
    let mut sheet = Sheet { root: Group::new(), y: MARGIN, columns: 0 };
    sheet.line("program", &page.title);
    sheet.y += ROW / 2;
    page.overview.iter().for_each(|text| sheet.line("cell", text));
    sheet.declarations(&page.globals);
    for unit in &page.units {
        if !unit.heading.is_empty() {
            sheet.y += ROW;
            sheet.line("heading", &unit.heading);
            sheet.y += ROW / 4;
        }
        sheet.declarations(&unit.declarations);
        unit.rungs.iter().for_each(|rung| sheet.rung(rung));
    }
    let (width, height) = (sheet.columns * COLUMN + 2 * MARGIN, sheet.y + MARGIN);
    let document = Document::new()
        .set("viewBox", (0, 0, width, height))
        .set("width", width)
        .set("height", height)
        .add(Title::new(page.title.as_str()))
        .add(Style::new(STYLE))
        .add(Rectangle::new().set("width", "100%").set("height", "100%").set("fill", "#fff"))
        .add(sheet.root);
    format!("{document}\n")
}

/// What is drawn so far, from the top down.
struct Sheet {
    root: Group,
    /// Where to go on, in units.
    y: usize,
    /// The columns of the widest thing drawn.
    columns: usize,
}

impl Sheet {
    fn add(&mut self, node: impl Into<Box<dyn svg::Node>>) {
        svg::Node::append(&mut self.root, node);
    }

    /// A line of text across the page.
    fn line(&mut self, class: &str, text: &str) {
        // The program's name has letters up to half as wide again.
        let columns = label::width(text);
        self.columns = self.columns.max(if class == "program" { columns + columns / 2 } else { columns });
        let y = row_middle(0) + BASELINE + units(self.y);
        self.add(words(class, units(MARGIN), y, "start", text));
        self.y += ROW;
    }

    fn declarations(&mut self, table: &Table) {
        for (index, row) in table.rows.iter().enumerate() {
            let y = row_middle(0) + BASELINE + units(self.y);
            for (start, cell) in table.starts.iter().zip(row).filter(|(_, cell)| !cell.is_empty()) {
                self.columns = self.columns.max(start + label::width(cell));
                let class = if index == 0 { "column" } else { "cell" };
                self.add(words(class, units(MARGIN + start * COLUMN), y, "start", cell));
            }
            self.y += ROW;
        }
        if !table.rows.is_empty() {
            let y = self.y - (table.rows.len() - 1) * ROW;
            let x = MARGIN + table.starts.first().map_or(0, |start| start * COLUMN);
            let end = MARGIN + self.columns * COLUMN;
            self.add(rule(x, end, y));
        }
    }

    fn rung(&mut self, rung: &RungPicture) {
        self.y += ROW;
        for comment in &rung.comments {
            self.line("comment", comment);
        }
        for heading in &rung.heading {
            self.line("heading", heading);
        }
        match &rung.picture {
            Ok(picture) => {
                let class = if rung.enabled { "rung" } else { "rung off" };
                let place = format!("translate({MARGIN} {})", self.y + ROW / 4);
                self.add(drawing(picture).set("class", class).set("transform", place));
                self.columns = self.columns.max(picture.columns);
                self.y += picture.rows * ROW + ROW / 2;
            }
            Err(note) => self.line("comment", note),
        }
    }
}

/// A count of units, columns or rows as a coordinate.
fn units(count: usize) -> f64 {
    // Nothing that is drawn comes near 2^32.
    f64::from(u32::try_from(count).unwrap_or(u32::MAX))
}

/// Where a place in halves of columns lies.
fn half(halves: usize) -> f64 {
    units(halves * COLUMN) / 2.0
}

/// The middle of a column.
fn column_middle(column: usize) -> f64 {
    half(2 * column + 1)
}

/// The middle of a row, where its wire lies.
fn row_middle(row: usize) -> f64 {
    units(row * ROW) + units(ROW) / 2.0
}

fn rule(from: usize, to: usize, y: usize) -> Line {
    Line::new().set("class", "rule").set("x1", from).set("y1", y).set("x2", to).set("y2", y)
}

fn words(class: &str, x: f64, y: f64, anchor: &str, text: &str) -> Text {
    Text::new(text).set("class", class).set("x", x).set("y", y).set("text-anchor", anchor)
}

fn path(class: &str, data: String) -> Path {
    Path::new().set("class", class).set("d", data)
}

/// One rung's picture: its wires, all in one path, under everything else.
fn drawing(picture: &Picture) -> Group {
    let mut wires = String::new();
    for shape in &picture.shapes {
        match shape {
            Shape::Horizontal { y, from, to } => {
                wires.push_str(&format!("M{} {}H{}", half(*from), row_middle(*y), half(*to)));
            }
            Shape::Vertical { x, top, bottom } => {
                wires.push_str(&format!("M{} {}V{}", column_middle(*x), row_middle(*top), row_middle(*bottom)));
            }
            _ => {}
        }
    }
    let mut group = Group::new().add(path("wire", wires));
    for shape in &picture.shapes {
        group = draw(group, shape);
    }
    group
}

fn draw(group: Group, shape: &Shape) -> Group {
    match shape {
        Shape::Horizontal { .. } | Shape::Vertical { .. } => group,
        Shape::Rail { x, top, bottom } => group.add(
            Line::new()
                .set("class", "rail")
                .set("x1", column_middle(*x))
                .set("y1", top * ROW)
                .set("x2", column_middle(*x))
                .set("y2", bottom * ROW + ROW / 4),
        ),
        Shape::Contact { x, y, mark } => {
            let (left, right, y) = (column_middle(*x), column_middle(x + 2), row_middle(*y));
            let (top, bottom) = (y - REACH, y + REACH);
            let mut sign = format!("M{left} {top}V{bottom}M{right} {top}V{bottom}");
            if *mark == '/' {
                sign.push_str(&format!("M{left} {bottom}L{right} {top}"));
            }
            letter(group.add(path("sign", sign)), *x, y, *mark)
        }
        Shape::Coil { x, y, mark } => {
            let (left, right, y) = (column_middle(*x), column_middle(x + 2), row_middle(*y));
            let (top, bottom) = (y - REACH, y + REACH);
            // Arcs whose outermost points meet the wires.
            let (from_left, from_right) = (left + 4.0, right - 4.0);
            let mut sign = format!(
                "M{from_left} {top}A12 12 0 0 0 {from_left} {bottom}M{from_right} {top}A12 12 0 0 1 {from_right} {bottom}"
            );
            if *mark == '/' {
                sign.push_str(&format!("M{from_left} {bottom}L{from_right} {top}"));
            }
            letter(group.add(path("sign", sign)), *x, y, *mark)
        }
        Shape::Frame { x, y, columns, rows } => group.add(
            Rectangle::new()
                .set("class", "frame")
                .set("x", column_middle(*x))
                .set("y", row_middle(*y))
                .set("width", (columns - 1) * COLUMN)
                .set("height", (rows - 1) * ROW),
        ),
        Shape::Text { y, text, anchor, align, role, .. } => {
            let (class, right, down) = match role {
                Role::Name => ("name", 0.0, 0.0),
                // Down to its box, whose upper side is the middle of a row.
                Role::Instance => ("name", 0.0, units(ROW) / 4.0),
                Role::Type => ("type", 0.0, 0.0),
                Role::Pin => ("pin", 0.0, 0.0),
                // A little off its wire.
                Role::Wired => ("wired", -3.0, 0.0),
            };
            let anchor_name = match align {
                Align::Left => "start",
                Align::Middle => "middle",
                Align::Right => "end",
            };
            group.add(words(class, half(*anchor) + right, row_middle(*y) + BASELINE + down, anchor_name, text))
        }
        Shape::Node { x, y, columns, text } => {
            let (left, right, y) = (units(x * COLUMN), units((x + columns) * COLUMN), row_middle(*y));
            let (top, bottom, neck) = (y - REACH, y + REACH, right - units(COLUMN));
            let points = format!("{left},{top} {neck},{top} {right},{y} {neck},{bottom} {left},{bottom}");
            let name = text.trim_start_matches('>').trim_end_matches('>');
            let middle = f64::midpoint(left, neck);
            group.add(Polygon::new().set("class", "node").set("points", points)).add(words(
                "wired",
                middle,
                y + BASELINE,
                "middle",
                name,
            ))
        }
        Shape::Leaves { x, y, number } | Shape::Returns { x, y, number } => {
            let (x, y) = (units((x + 1) * COLUMN), row_middle(*y));
            group.add(Circle::new().set("class", "fold").set("cx", x).set("cy", y).set("r", 8)).add(words(
                "number",
                x,
                y + 3.0,
                "middle",
                &(number + 1).to_string(),
            ))
        }
    }
}

/// The letter in the middle of a contact or coil; a stroke is no letter.
fn letter(group: Group, x: usize, y: f64, mark: char) -> Group {
    if mark.is_ascii_alphabetic() {
        group.add(words("mark", column_middle(x + 1), y + BASELINE, "middle", &mark.to_string()))
    } else {
        group
    }
}
