//! `docs/bad-input.md` is true: every line of its tables is run on every engine and in the evaluator. The lines are read from
//! the page, so that neither can say what the other does not.

#[path = "support"]
mod support {
    #![allow(dead_code, reason = "this test uses a part of the support only")]
    pub(crate) mod drawing;
    pub(crate) mod oracle;
    pub(crate) mod rig;
    pub(crate) mod script;
    pub(crate) mod step_table;
}

use std::path::Path;

use rung::elementary::{Elementary, Value};

use support::rig::Rig;
use support::script::checked_text;

/// What becomes of bad input: the sections of the page, each with the least lines that it has.
const SECTIONS: [(&str, usize); 10] = [
    ("Division by zero", 13),
    ("Overflow", 15),
    ("Shifts and bits", 7),
    ("NaN and infinities", 20),
    ("Powers", 6),
    ("Conversions that do not fit", 12),
    ("Selection", 5),
    ("Index out of range", 17),
    ("Presets and places out of a register", 6),
    ("Negative times", 5),
];

fn page() -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/bad-input.md");
    std::fs::read_to_string(path).expect("the page about bad input")
}

/// One line of a table.
struct Line<'p> {
    what: &'p str,
    variables: &'p str,
    rung: &'p str,
    /// Names with their values.
    after: Vec<(&'p str, &'p str)>,
}

fn lines(section: &str) -> Vec<Line<'_>> {
    let rows = section.lines().filter(|line| line.starts_with("| ")).skip(1);
    rows.map(|row| {
        let cells: Vec<&str> = row.trim_matches('|').split('|').map(|cell| cell.trim().trim_matches('`')).collect();
        let [what, variables, rung, after] = cells[..] else { panic!("a line has four cells: {row}") };
        let after = after.split(", ").map(|pair| pair.split_once(" = ").unwrap_or_else(|| panic!("{row}"))).collect();
        Line { what, variables, rung, after }
    })
    .collect()
}

/// The program of a line, with the types and functions that the page gives for all.
fn program(line: &Line, common: &str) -> String {
    let mut text = format!("{common}program bad\noutput q\n");
    for variables in line.variables.split("; ") {
        text += &format!("var {variables}\n");
    }
    format!("{text}rung\n  {}\n", line.rung)
}

/// The value as the page writes it.
fn shown(value: Value) -> String {
    match (value.ty(), value.as_integer(), value.as_real()) {
        (Elementary::Time, Some(nanoseconds), _) if nanoseconds % 1_000_000_000 == 0 => {
            format!("T#{}s", nanoseconds / 1_000_000_000)
        }
        (Elementary::Time, Some(nanoseconds), _) => format!("T#{nanoseconds}ns"),
        (_, Some(number), _) => number.to_string(),
        (_, None, real) => real.expect("it is no integer").to_string(),
    }
}

/// A number of the page without its base.
fn plain(cell: &str) -> String {
    let hexadecimal = cell.strip_prefix("16#").and_then(|digits| i128::from_str_radix(digits, 16).ok());
    hexadecimal.map_or_else(|| cell.to_owned(), |number| number.to_string())
}

#[test]
fn every_line_of_the_page_is_what_every_engine_does() {
    let page = page();
    let common = page.split("```text\n").nth(1).and_then(|rest| rest.split("```").next()).expect("what is common");
    let mut wrong = Vec::new();
    for section in page.split("\n## ").skip(1) {
        for line in lines(section) {
            let text = program(&line, common);
            let checked = checked_text(&text);
            let mut rig = Rig::new(&checked).unwrap_or_else(|problem| panic!("{text}\n{problem}"));
            for now in [0, 10_000_000, 20_000_000] {
                rig.scan(now).unwrap_or_else(|difference| panic!("{}: {difference:?}\n{text}", line.what));
            }
            // Where the page is silent there is no fault.
            let silent = line.after.iter().all(|(name, _)| *name != "#fault");
            let expected = line.after.iter().copied().chain(silent.then_some(("#fault", "0")));
            for (name, expected) in expected {
                let is = match name {
                    "#fault" => u8::from(rig.oracle.fault()).to_string(),
                    name => shown(rig.oracle.get(name)),
                };
                if is != plain(expected) {
                    wrong.push(format!("{}: {name} = {is}, not {expected}", line.what));
                }
            }
        }
    }
    assert_eq!(wrong, Vec::<String>::new());
}

#[test]
fn the_page_has_a_table_for_each_kind_of_bad_input() {
    let page = page();
    let sections: Vec<(&str, usize)> = page
        .split("\n## ")
        .skip(1)
        .map(|section| (section.lines().next().expect("a heading"), lines(section).len()))
        .collect();
    assert_eq!(sections, SECTIONS);
}
