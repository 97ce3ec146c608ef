//! Small programs in native text with what they must do, round by round, as a table.
//!
//! The first line of a table names its columns: `ms`, the time; the variables that are set before the round; behind a
//! bar what is looked at after it, of which `#fault` is whether an index was out of range. A `.` leaves an input as it
//! is. BOOLs are 0 and 1, TIMEs milliseconds.

use rung::check::Checked;
use rung::elementary::{Elementary, Value};
use rung::frontend;
use rung::source::Source;

use super::oracle::Oracle;
use super::rig::{Rig, checked};

/// One line of a table.
struct Row<'t> {
    now: i64,
    inputs: Vec<(&'t str, &'t str)>,
    expected: Vec<(&'t str, &'t str)>,
}

/// The checked form of a text.
///
/// # Panics
/// When it has an error.
pub(crate) fn checked_text(text: &str) -> Checked {
    let source = Source::new("script.rung", text);
    let parsed = frontend::parse(&source);
    let problems = rung::diagnostic::render(&source, &parsed.diagnostics);
    assert!(parsed.diagnostics.is_empty(), "{problems}\n{text}");
    checked(&parsed.program).unwrap_or_else(|problems| panic!("{problems}\n{text}"))
}

/// Runs a program by its table: in the evaluator, and then on every engine, which must agree in everything.
///
/// # Panics
/// When they do not do what the table says.
pub(crate) fn follows(text: &str, table: &str) {
    let checked = checked_text(text);
    let rows = rows(table);
    let mut oracle = Oracle::new(&checked);
    let shown = |rows: &[Row], cells: &[Vec<String>]| -> String {
        let lines = rows.iter().zip(cells).map(|(row, cells)| {
            let cells = row.expected.iter().zip(cells).map(|((name, _), cell)| format!("{name} = {cell}"));
            format!("{} ms: {}\n", row.now / 1_000_000, cells.collect::<Vec<_>>().join(", "))
        });
        lines.collect()
    };
    let mut computed: Vec<Vec<String>> = Vec::new();
    for row in &rows {
        for (name, cell) in &row.inputs {
            let value = value(oracle.get(name).ty(), cell);
            oracle.set(name, value);
        }
        oracle.scan(row.now);
        let cells = row.expected.iter().map(|(name, _)| match *name {
            "#fault" => u8::from(oracle.fault()).to_string(),
            name => cell(oracle.get(name)),
        });
        computed.push(cells.collect());
    }
    let expected = rows.iter().map(|row| row.expected.iter().map(|(_, cell)| (*cell).to_owned()).collect());
    let expected: Vec<Vec<String>> = expected.collect();
    assert_eq!(shown(&rows, &computed), shown(&rows, &expected), "the evaluator, of\n{text}");

    let mut rig = Rig::new(&checked).unwrap_or_else(|problem| panic!("{problem}\n{text}"));
    for row in &rows {
        for (name, cell) in &row.inputs {
            let value = value(rig.oracle.get(name).ty(), cell);
            rig.set(name, value);
        }
        let same = rig.scan(row.now);
        same.unwrap_or_else(|difference| panic!("at {} ns: {difference:?}\n{text}", row.now));
    }
}

fn rows(table: &str) -> Vec<Row<'_>> {
    let mut lines = table.lines().map(str::trim).filter(|line| !line.is_empty());
    let header = lines.next().expect("a table has a header");
    let (inputs, outputs) = header.split_once('|').expect("a bar parts inputs from outputs");
    let inputs: Vec<&str> = inputs.split_whitespace().collect();
    let outputs: Vec<&str> = outputs.split_whitespace().collect();
    assert_eq!(inputs[0], "ms", "the first column is the time");
    lines
        .map(|line| {
            let (before, after) = line.split_once('|').unwrap_or_else(|| panic!("{line} has no bar"));
            let (before, after): (Vec<&str>, Vec<&str>) =
                (before.split_whitespace().collect(), after.split_whitespace().collect());
            assert_eq!((before.len(), after.len()), (inputs.len(), outputs.len()), "the cells of {line}");
            let cells = inputs.iter().copied().zip(before).skip(1);
            Row {
                now: nanoseconds(line.split_whitespace().next().expect("a time")),
                inputs: cells.filter(|(_, cell)| *cell != ".").collect(),
                expected: outputs.iter().copied().zip(after).collect(),
            }
        })
        .collect()
}

fn nanoseconds(cell: &str) -> i64 {
    cell.parse::<i64>().unwrap_or_else(|error| panic!("{cell}: {error}")) * 1_000_000
}

fn value(ty: Elementary, cell: &str) -> Value {
    let value = match ty {
        Elementary::Time => Some(Value::time(nanoseconds(cell))),
        _ if ty.is_real() => cell.parse().ok().and_then(|number| Value::real(ty, number)),
        _ => cell.parse().ok().and_then(|number| Value::integer(ty, number)),
    };
    value.unwrap_or_else(|| panic!("{cell} is no {ty}"))
}

fn cell(value: Value) -> String {
    match (value.ty(), value.as_integer(), value.as_real()) {
        (Elementary::Time, Some(nanoseconds), _) => (nanoseconds / 1_000_000).to_string(),
        (_, Some(number), _) => number.to_string(),
        (_, None, real) => real.expect("it is no integer").to_string(),
    }
}
