//! The page: the program's name, what it declares, and unit by unit its declarations and the rungs below each other with
//! their titles and comments.

use super::grid::Grid;
use super::network::networks;
use super::place::picture;
use super::shape::Picture;
use super::symbol::{InstanceTypes, Limits};
use super::{label, overview};
use crate::ladder::{Comment, Program, Rung, Unit, Variable, VariableClass};

/// The columns of the declarations.
const HEADINGS: [&str; 6] = ["class", "name", "type", "address", "initial", "retain"];
/// The widest that a column of the declarations may be.
const WIDEST_COLUMN: usize = 48;
/// The narrowest that one may become to make room: no heading is wider.
const NARROWEST_COLUMN: usize = 7;
/// Columns between the columns of the declarations.
const GAP: usize = 2;
/// Columns that lines of prose may take whatever the width of the rungs.
const READABLE: usize = 76;
/// Columns of a rung that a cell cannot have: rails, boundaries and the marks where the rung is folded.
const MARGINS: usize = 8;

/// A program laid out.
pub(super) struct Page {
    /// The program's name, cut to the width.
    pub(super) title: String,
    /// Types, tasks, and what else stands outside the units, line by line.
    pub(super) overview: Vec<String>,
    /// The variables that all units see.
    pub(super) globals: Table,
    pub(super) units: Vec<UnitPicture>,
}

/// One unit laid out.
pub(super) struct UnitPicture {
    /// What it is and its name, cut to the width; empty where the title of the page says it.
    pub(super) heading: String,
    pub(super) declarations: Table,
    pub(super) rungs: Vec<RungPicture>,
}

/// The declarations. Columns that say nothing are left out.
pub(super) struct Table {
    /// Where each column starts, in columns.
    pub(super) starts: Vec<usize>,
    /// The headings, then one row a declaration; no rows for no declarations. Where there is no room for columns,
    /// one column of lines without a heading.
    pub(super) rows: Vec<Vec<String>>,
}

/// One rung laid out.
pub(super) struct RungPicture {
    /// The comments that stand before it, line by line.
    pub(super) comments: Vec<String>,
    /// Its name and title, line by line.
    pub(super) heading: Vec<String>,
    /// Whether it runs.
    pub(super) enabled: bool,
    /// The drawing, or what to say where it would be out of proportion.
    pub(super) picture: Result<Picture, String>,
}

impl Page {
    /// Lays out a program for so many columns.
    pub(super) fn of(program: &Program, width: usize) -> Self {
        let limits = Limits::within(width.saturating_sub(MARGINS));
        let networks = |unit: &Unit| -> Vec<Vec<Grid>> {
            let types = InstanceTypes::of(program, unit);
            let grid = |net| Grid::new(net, width);
            unit.rungs
                .iter()
                .map(|rung| networks(&rung.circuit, &types, limits).into_iter().map(grid).collect())
                .collect()
        };
        let grids: Vec<Vec<Vec<Grid>>> = program.units.iter().map(networks).collect();
        // All right rails stand in one column, but for rungs with an element too wide for the page.
        let fitting = grids.iter().flatten().flatten().map(Grid::total_columns).filter(|columns| *columns <= width);
        let columns = fitting.max().unwrap_or(0);
        // Prose is not drawn out far beyond the rungs.
        let prose = columns.max(READABLE).min(width);
        let overview: Vec<String> = overview::lines(program).iter().flat_map(|line| label::wrap(line, prose)).collect();
        let globals = Table::of(&program.globals, Some("global"), width);
        let mut units: Vec<UnitPicture> = program
            .units
            .iter()
            .zip(grids)
            .map(|(unit, grids)| unit_picture(program, unit, grids, Columns { width, rails: columns, prose }))
            .collect();
        let mut title = label::cut_end(&format!("program {}", program.name.text), width);
        if let [only] = units.as_mut_slice()
            && overview.is_empty()
            && globals.rows.is_empty()
        {
            title = std::mem::take(&mut only.heading);
        }
        Self { title, overview, globals, units }
    }
}

/// How wide things are.
#[derive(Clone, Copy)]
struct Columns {
    width: usize,
    rails: usize,
    prose: usize,
}

fn unit_picture(program: &Program, unit: &Unit, grids: Vec<Vec<Grid>>, columns: Columns) -> UnitPicture {
    let mut comments = Comments { rest: &program.comments, from: declarations_end(unit) };
    let rungs = unit
        .rungs
        .iter()
        .zip(grids)
        .enumerate()
        .map(|(index, (rung, grids))| RungPicture {
            comments: comments.before(rung).flat_map(|comment| label::wrap(&comment.text, columns.prose - 3)).collect(),
            heading: heading(rung, index, columns.prose),
            enabled: rung.enabled,
            picture: picture(grids, columns.rails).ok_or_else(|| label::cut_end("(too large to draw)", columns.width)),
        })
        .collect();
    let heading = label::cut_end(&overview::unit(unit), columns.width);
    UnitPicture { heading, declarations: Table::of(&unit.variables, None, columns.width), rungs }
}

fn heading(rung: &Rung, index: usize, width: usize) -> Vec<String> {
    let mut heading = match &rung.name {
        Some(name) => label::cut_name(&name.text, width),
        None => format!("rung {}", index + 1),
    };
    if !rung.enabled {
        heading.push_str(" (off)");
    }
    if let Some(title) = &rung.title {
        heading.push_str("  ");
        heading.push_str(title);
    }
    label::wrap(&heading, width)
}

/// Where the declarations end, as far as they stand before the first rung.
fn declarations_end(unit: &Unit) -> u32 {
    let first = unit.rungs.first().map_or(u32::MAX, |rung| rung.span.start);
    let ends = unit.variables.iter().map(|variable| variable.span.end).chain([unit.name.span.end]);
    ends.filter(|end| *end <= first).max().unwrap_or(0)
}

/// Hands out the comments that stand on lines of their own before each rung, each once.
struct Comments<'a> {
    rest: &'a [Comment],
    from: u32,
}

impl<'a> Comments<'a> {
    fn before(&mut self, rung: &Rung) -> impl Iterator<Item = &'a Comment> + use<'a> {
        let count = self.rest.iter().take_while(|comment| comment.span.end <= rung.span.start).count();
        let (before, rest) = self.rest.split_at(count);
        let from = self.from;
        (self.rest, self.from) = (rest, rung.span.end);
        before.iter().filter(move |comment| comment.own_line && comment.span.start >= from)
    }
}

impl Table {
    /// A table of variables, all of one class in words or each of its own.
    fn of(variables: &[Variable], class: Option<&str>, width: usize) -> Self {
        if variables.is_empty() {
            return Self { starts: Vec::new(), rows: Vec::new() };
        }
        let mut rows: Vec<[String; 6]> = variables.iter().map(|variable| row(variable, class)).collect();
        let says_something: Vec<usize> =
            (0..HEADINGS.len()).filter(|column| rows.iter().any(|row| !row[*column].is_empty())).collect();
        rows.insert(0, HEADINGS.map(str::to_owned));

        let widest = |column: &usize| rows.iter().map(|row| label::width(&row[*column])).max().unwrap_or(0);
        let mut widths: Vec<usize> = says_something.iter().map(widest).collect();
        let gaps = GAP * widths.len();
        while widths.iter().sum::<usize>() + gaps > width {
            match widths.iter_mut().max() {
                Some(widest) if *widest > NARROWEST_COLUMN => *widest -= 1,
                _ => return Self::without_columns(&rows[1..], width),
            }
        }
        let mut starts = Vec::new();
        let mut next = GAP;
        for columns in &widths {
            starts.push(next);
            next += columns + GAP;
        }
        let cut = |row: [String; 6]| -> Vec<String> {
            let cells = says_something.iter().zip(&widths);
            cells.map(|(column, width)| label::cut_name(&row[*column], *width)).collect()
        };
        Self { starts, rows: rows.into_iter().map(cut).collect() }
    }

    /// The declarations as lines, for a width that has no room for columns.
    fn without_columns(rows: &[[String; 6]], width: usize) -> Self {
        let words = |row: &[String; 6]| row.iter().filter(|cell| !cell.is_empty()).cloned().collect::<Vec<_>>();
        let lines = rows.iter().flat_map(|row| label::wrap(&words(row).join(" "), width - GAP));
        Self { starts: vec![GAP], rows: lines.map(|line| vec![line]).collect() }
    }
}

fn row(variable: &Variable, class: Option<&str>) -> [String; 6] {
    let own = match variable.class {
        VariableClass::Input => "input",
        VariableClass::Output => "output",
        VariableClass::Memory => "var",
        VariableClass::Constant => "const",
        VariableClass::InOut => "inout",
        VariableClass::Temporary => "temp",
    };
    [
        class.filter(|_| variable.class == VariableClass::Memory).unwrap_or(own).to_owned(),
        label::cut_name(&variable.name.text, WIDEST_COLUMN),
        variable.ty.as_ref().map_or_else(|| "BOOL".to_owned(), |ty| label::type_reference(ty, WIDEST_COLUMN)),
        variable.address.as_ref().map_or_else(String::new, ToString::to_string),
        variable.initial.as_ref().map_or_else(String::new, |value| label::expression(value, WIDEST_COLUMN)),
        if variable.retain { "retain" } else { "" }.to_owned(),
    ]
}
