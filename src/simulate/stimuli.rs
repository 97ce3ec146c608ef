//! Stimuli: a CSV table of what is set when.
//!
//! The header is `time_ms,name,name,…`; each row sets its variables before the first scan at or after its time, and
//! an empty cell leaves one as it was. Reading must never stop at the first error, and never panic: any text gives
//! stimuli or diagnostics.

use std::collections::{HashMap, HashSet};

use csv::{ReaderBuilder, StringRecord, Trim};

use super::decimal::{Milliseconds, parse_milliseconds};
use crate::diagnostic::{Code, Diagnostic};
use crate::elementary::{Elementary, Value};
use crate::logic::{Layout, SlotId};
use crate::source::{Source, Span};
use crate::trace::Spelled;

/// The name of the first column.
const TIME_COLUMN: &str = "time_ms";

/// Diagnostics before reading stops.
const MOST_DIAGNOSTICS: usize = 100;

/// What is set when, in order of time.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct Stimuli {
    /// The time of each row, and where its settings end.
    ends: Vec<(i64, usize)>,
    settings: Vec<Setting>,
}

/// One variable and the value that it gets.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Setting {
    /// Where the variable is.
    pub slot: SlotId,
    /// What it gets, of its type.
    pub value: Value,
}

/// What is set at one time.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Row<'a> {
    /// Nanoseconds since the start, 0 or more; never less than in the row before.
    pub time: i64,
    /// In the order of the columns.
    pub settings: &'a [Setting],
}

impl Stimuli {
    /// One row, from 0; `None` past the last.
    pub fn row(&self, index: usize) -> Option<Row<'_>> {
        let (time, end) = *self.ends.get(index)?;
        let start = index.checked_sub(1).map_or(0, |before| self.ends[before].1);
        Some(Row { time, settings: &self.settings[start..end] })
    }

    /// The rows, in order.
    pub fn rows(&self) -> impl DoubleEndedIterator<Item = Row<'_>> {
        (0..self.ends.len()).filter_map(|index| self.row(index))
    }

    /// Stimuli of settings at times in nanoseconds, 0 or more; those of one time stay in the order given.
    pub fn of(settings: impl IntoIterator<Item = (i64, Setting)>) -> Self {
        let mut settings: Vec<(i64, Setting)> = settings.into_iter().collect();
        settings.sort_by_key(|(time, _)| *time);
        let mut stimuli = Self::default();
        for (time, setting) in settings {
            let end = stimuli.settings.len();
            stimuli.settings.push(setting);
            match stimuli.ends.last_mut() {
                Some((last, last_end)) if *last == time => *last_end = end + 1,
                _ => stimuli.ends.push((time, end + 1)),
            }
        }
        stimuli
    }

    /// The table that [`Stimuli::parse`] reads as these stimuli for the same image. A row for each time, and more for a
    /// time at which a variable is set more than once.
    pub fn to_csv(&self, layout: &Layout) -> String {
        let mut columns: Vec<SlotId> = self.settings.iter().map(|setting| setting.slot).collect();
        columns.sort_unstable();
        columns.dedup();
        let name = |slot: &SlotId| {
            let observed = layout.observed().iter().find(|observed| observed.slot == *slot);
            observed.map_or(String::new(), |observed| observed.name.to_string())
        };
        let places: HashMap<SlotId, usize> = columns.iter().copied().zip(1..).collect();
        let mut table = csv::Writer::from_writer(Vec::new());
        let header = std::iter::once(TIME_COLUMN.to_owned()).chain(columns.iter().map(name));
        // Writing to a vector does not fail.
        let _ = table.write_record(header);
        for row in self.rows() {
            let empty = || {
                let mut cells = vec![String::new(); columns.len() + 1];
                cells[0] = Milliseconds(row.time).to_string();
                cells
            };
            let mut cells = empty();
            for setting in row.settings {
                if !cells[places[&setting.slot]].is_empty() {
                    let _ = table.write_record(std::mem::replace(&mut cells, empty()));
                }
                cells[places[&setting.slot]] = Spelled(setting.value).to_string();
            }
            let _ = table.write_record(cells);
        }
        String::from_utf8(table.into_inner().unwrap_or_default()).unwrap_or_default()
    }

    /// Reads stimuli for an image. Columns are the names of [`Layout::observed`], in any case and order.
    ///
    /// # Errors
    /// Everything that is wrong, each at its cell; after a hundred findings the rest is not read.
    pub fn parse(source: &Source, layout: &Layout) -> Result<Self, Vec<Diagnostic>> {
        let mut reading = Reading { source, diagnostics: Vec::new(), stimuli: Self::default() };
        reading.read(layout);
        if reading.diagnostics.is_empty() { Ok(reading.stimuli) } else { Err(reading.diagnostics) }
    }
}

/// A column that is good: which cell it is, and what it sets.
struct Column<'a> {
    cell: usize,
    name: &'a str,
    slot: SlotId,
    ty: Elementary,
}

struct Reading<'a> {
    source: &'a Source,
    diagnostics: Vec<Diagnostic>,
    stimuli: Stimuli,
}

impl Reading<'_> {
    fn read(&mut self, layout: &Layout) {
        let mut reader = ReaderBuilder::new()
            .has_headers(false)
            .flexible(true)
            .trim(Trim::All)
            .from_reader(self.source.text().as_bytes());
        let mut header = StringRecord::new();
        // Reading can fail on bytes that are not UTF-8 only, and a source has none.
        if !matches!(reader.read_record(&mut header), Ok(true)) {
            let problem = Diagnostic::new(Code::BadStimuli, Span::default(), "this file is empty")
                .hint(format!("stimuli start with the line `{TIME_COLUMN},name,name,…`"));
            self.diagnostics.push(problem);
            return;
        }
        let columns = self.header(&header, layout);
        let mut record = StringRecord::new();
        let mut last_time = 0;
        while self.diagnostics.len() < MOST_DIAGNOSTICS && matches!(reader.read_record(&mut record), Ok(true)) {
            // A line of blanks.
            if record.len() == 1 && record[0].is_empty() {
                continue;
            }
            self.row(&record, header.len(), &columns, &mut last_time);
        }
        if self.diagnostics.len() >= MOST_DIAGNOSTICS {
            let at = Span::new(self.source.text().len(), self.source.text().len());
            self.diagnostics.push(Diagnostic::new(Code::TooManyDiagnostics, at, "the rest was not read"));
        }
    }

    fn header<'l>(&mut self, header: &StringRecord, layout: &'l Layout) -> Vec<Column<'l>> {
        if &header[0] != TIME_COLUMN {
            self.problem(header, 0, format!("the first column must be `{TIME_COLUMN}`"));
        }
        let mut slots = HashMap::new();
        for observed in layout.observed() {
            slots.entry(observed.name.to_lowercase()).or_insert((observed.name.as_str(), observed.slot));
        }
        let mut seen = HashSet::new();
        let mut columns = Vec::new();
        for (cell, text) in header.iter().enumerate().skip(1) {
            if self.diagnostics.len() >= MOST_DIAGNOSTICS {
                break;
            }
            match slots.get(text.to_lowercase().as_str()) {
                None => {
                    let span = self.cell_span(header, cell);
                    let problem = format!("the program has no variable `{text}`");
                    let hint = "the header of `rung sim`'s trace lists what can be set";
                    self.diagnostics.push(Diagnostic::new(Code::BadStimuli, span, problem).hint(hint));
                }
                Some((name, _)) if !seen.insert(*name) => {
                    self.problem(header, cell, format!("there is a column `{name}` already"));
                }
                Some((name, slot)) => {
                    columns.push(Column { cell, name, slot: *slot, ty: layout.slot(*slot).ty });
                }
            }
        }
        columns
    }

    fn row(&mut self, record: &StringRecord, cells: usize, columns: &[Column<'_>], last_time: &mut i64) {
        if record.len() != cells {
            let problem = format!("this row has {} cells, and the header has {cells}", record.len());
            self.problem(record, record.len().min(cells + 1) - 1, problem);
        }
        match parse_milliseconds(&record[0]) {
            Err(error) => {
                self.problem(record, 0, format!("`{}` is no time in milliseconds: {error}", &record[0]));
            }
            Ok(time) if time < 0 => {
                self.problem(record, 0, "this time is before the first scan's, which is 0");
            }
            Ok(time) if time < *last_time => {
                self.problem(record, 0, "this time goes back behind that of the row before");
            }
            Ok(time) => *last_time = time,
        }
        for column in columns {
            let Some(text) = record.get(column.cell).filter(|text| !text.is_empty()) else { continue };
            match parse_value(column.ty, text) {
                Ok(value) => self.stimuli.settings.push(Setting { slot: column.slot, value }),
                Err(expected) => {
                    let problem = format!("`{text}` cannot be set: `{}` takes {expected}", column.name);
                    self.problem(record, column.cell, problem);
                }
            }
        }
        self.stimuli.ends.push((*last_time, self.stimuli.settings.len()));
    }

    fn problem(&mut self, record: &StringRecord, cell: usize, message: impl Into<String>) {
        let span = self.cell_span(record, cell);
        self.diagnostics.push(Diagnostic::new(Code::BadStimuli, span, message));
    }

    fn cell_span(&self, record: &StringRecord, cell: usize) -> Span {
        let start = record.position().map_or(0, |position| usize::try_from(position.byte()).unwrap_or(usize::MAX));
        cell_span(self.source.text(), start, cell)
    }
}

/// A value as it is written in a cell, or what would be one.
fn parse_value(ty: Elementary, text: &str) -> Result<Value, String> {
    let value = match ty {
        Elementary::Bool => match text {
            "0" => Some(Value::bool(false)),
            "1" => Some(Value::bool(true)),
            _ if text.eq_ignore_ascii_case("FALSE") => Some(Value::bool(false)),
            _ if text.eq_ignore_ascii_case("TRUE") => Some(Value::bool(true)),
            _ => None,
        },
        Elementary::Time => parse_milliseconds(text).ok().map(Value::time),
        // Read as the type that it is: by way of an LREAL, a REAL would be rounded twice.
        Elementary::Real => text
            .parse::<f32>()
            .ok()
            .filter(|value| value.is_finite() || names_no_number(text))
            .map(|value| Value::from_bits(ty, u64::from(value.to_bits()))),
        Elementary::Lreal => text
            .parse::<f64>()
            .ok()
            .filter(|value| value.is_finite() || names_no_number(text))
            .map(|value| Value::from_bits(ty, value.to_bits())),
        _ => text.parse::<i128>().ok().and_then(|value| Value::integer(ty, value)),
    };
    value.ok_or_else(|| match (ty, ty.range()) {
        (Elementary::Bool, _) => "0, 1, FALSE or TRUE".to_owned(),
        (Elementary::Time, _) => "milliseconds, with at most 6 decimals".to_owned(),
        (_, Some((least, greatest))) => format!("an integer from {least} to {greatest}"),
        (_, None) => format!("a number in the range of {ty}"),
    })
}

/// Whether infinity or NaN was asked for by name, and not by a number out of range.
fn names_no_number(text: &str) -> bool {
    !text.bytes().any(|byte| byte.is_ascii_digit())
}

/// Where a cell of the record that starts at `start` stands, without the blanks around it; past the last cell the
/// end of the record. Line breaks before the record are no part of it.
fn cell_span(text: &str, start: usize, cell: usize) -> Span {
    let bytes = text.as_bytes();
    let mut at = start.min(bytes.len());
    while bytes.get(at).is_some_and(|byte| matches!(byte, b'\r' | b'\n')) {
        at += 1;
    }
    let (mut from, mut index, mut quoted) = (at, 0, false);
    while let Some(byte) = bytes.get(at) {
        match byte {
            // A quote has a meaning at a cell's start only, and then ends the cell's text or, doubled, is part of it.
            b'"' if quoted || at == from || bytes[at - 1] == b'"' => quoted = !quoted,
            b',' if !quoted => {
                if index == cell {
                    break;
                }
                index += 1;
                from = at + 1;
            }
            b'\r' | b'\n' if !quoted => break,
            _ => {}
        }
        at += 1;
    }
    let blank = |byte: &u8| byte.is_ascii_whitespace();
    while from < at && blank(&bytes[from]) {
        from += 1;
    }
    while at > from && blank(&bytes[at - 1]) {
        at -= 1;
    }
    Span::new(from, at)
}
