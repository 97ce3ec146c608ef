//! Step tables: what a block must do, scan by scan, as data in `tests/blocks/*.csv`.
//!
//! A row is one scan: its time, EN, the inputs, the outputs that must hold after it, and the rule that it pins. An
//! empty input keeps its last value; one that is empty in a whole case is not wired at all. Nothing here must know
//! what a block does.

use rung::elementary::{Elementary, Value};
use rung::ladder::library::{Pin, StandardBlock};
use rung::ladder::{Circuit, Program, VariableClass, Wire};

use super::drawing;

/// One row.
#[derive(Clone, Debug)]
pub(crate) struct Step {
    /// The scan's time in nanoseconds.
    pub now: i64,
    /// EN.
    pub enabled: bool,
    /// One value for each input.
    pub inputs: Vec<Value>,
    /// One value for each output, after the scan.
    pub outputs: Vec<Value>,
    /// The rule that it pins, with the place of the row.
    pub rule: String,
}

/// Rows from one power-up.
#[derive(Clone, Debug)]
pub(crate) struct Case {
    /// The block.
    pub block: StandardBlock,
    /// Its rows.
    pub steps: Vec<Step>,
    /// For each input whether any row says something about it.
    pub wired: Vec<bool>,
}

/// The tables of all blocks, each with those that follow it.
const TABLES: &[(&[StandardBlock], &str)] = {
    use StandardBlock as B;
    &[
        (&[B::Ton], include_str!("../blocks/ton.csv")),
        (&[B::Tof], include_str!("../blocks/tof.csv")),
        (&[B::Tp], include_str!("../blocks/tp.csv")),
        (&[B::Tonr], include_str!("../blocks/tonr.csv")),
        (&[B::Ctu, B::CtuInt, B::CtuDint, B::CtuLint, B::CtuUdint, B::CtuUlint], include_str!("../blocks/ctu.csv")),
        (&[B::Ctd, B::CtdInt, B::CtdDint, B::CtdLint, B::CtdUdint, B::CtdUlint], include_str!("../blocks/ctd.csv")),
        (
            &[B::Ctud, B::CtudInt, B::CtudDint, B::CtudLint, B::CtudUdint, B::CtudUlint],
            include_str!("../blocks/ctud.csv"),
        ),
        (&[B::RTrig], include_str!("../blocks/r_trig.csv")),
        (&[B::FTrig], include_str!("../blocks/f_trig.csv")),
        (&[B::Sr], include_str!("../blocks/sr.csv")),
        (&[B::Sema], include_str!("../blocks/sema.csv")),
        (&[B::Integral], include_str!("../blocks/integral.csv")),
        (&[B::Derivative], include_str!("../blocks/derivative.csv")),
        (&[B::Pid], include_str!("../blocks/pid.csv")),
        (&[B::Ramp], include_str!("../blocks/ramp.csv")),
        (&[B::Hysteresis], include_str!("../blocks/hysteresis.csv")),
        (&[B::Rs], include_str!("../blocks/rs.csv")),
    ]
};

/// The cases of all tables.
pub(crate) fn all_cases() -> impl Iterator<Item = Case> {
    TABLES.iter().flat_map(|(blocks, table)| blocks.iter().flat_map(|block| cases(*block, table)))
}

/// The cases of a table whose numbers a block can hold: a table for several types may have some for a few only.
///
/// # Panics
/// When the table is not one for that block.
fn cases(block: StandardBlock, table: &str) -> Vec<Case> {
    let mut reader = csv::ReaderBuilder::new().comment(Some(b'#')).from_reader(table.as_bytes());
    let expected = ["case", "time_ms", "EN"].into_iter().chain(names(block.inputs())).chain(names(block.outputs()));
    let expected: Vec<&str> = expected.chain(["rule"]).collect();
    assert_eq!(reader.headers().expect("a header").iter().collect::<Vec<_>>(), expected, "{}", block.name());
    // Whether all numbers of a case are of the block's types, beside the case.
    let mut cases: Vec<(Case, bool)> = Vec::new();
    let mut current = String::new();
    for row in reader.records() {
        let row = row.unwrap_or_else(|error| panic!("{}: {error}", block.name()));
        if row[0] != current || cases.is_empty() {
            current = row[0].to_owned();
            cases.push((Case { block, steps: Vec::new(), wired: vec![false; block.inputs().len()] }, true));
        }
        let (case, fits) = cases.last_mut().expect("one was begun");
        let (inputs, outputs) = (block.inputs(), block.outputs());
        let mut values = Vec::new();
        for (index, pin) in inputs.iter().enumerate() {
            let cell = &row[3 + index];
            let last = case.steps.last().map_or(Value::default_of(pin.ty), |step| step.inputs[index]);
            let given = if cell.is_empty() { Some(last) } else { value(pin.ty, cell) };
            *fits &= given.is_some();
            values.push(given.unwrap_or(last));
            case.wired[index] |= !cell.is_empty();
        }
        let line = row.position().map_or(0, csv::Position::line);
        let first_output = 3 + inputs.len();
        let expected = outputs.iter().zip(row.iter().skip(first_output)).map(|(pin, cell)| value(pin.ty, cell));
        let outputs: Option<Vec<Value>> = expected.collect();
        *fits &= outputs.is_some();
        case.steps.push(Step {
            now: nanoseconds(&row[1]),
            enabled: &row[2] != "0",
            inputs: values,
            outputs: outputs.unwrap_or_default(),
            rule: format!("{}, line {line}, {current}: {}", block.name(), &row[row.len() - 1]),
        });
    }
    cases.into_iter().filter_map(|(case, fits)| fits.then_some(case)).collect()
}

fn names(pins: &'static [Pin]) -> impl Iterator<Item = &'static str> {
    pins.iter().map(|pin| pin.name)
}

/// None where the cell says a number that the type does not hold.
fn value(ty: Elementary, cell: &str) -> Option<Value> {
    if ty.is_real() {
        return Value::real(ty, cell.parse().unwrap_or_else(|error| panic!("{cell}: {error}")));
    }
    let number = match (cell, ty.range()) {
        ("MIN", Some((least, _))) => least,
        ("MAX", Some((_, greatest))) => greatest,
        ("MAX-1", Some((_, greatest))) => greatest - 1,
        _ if ty == Elementary::Time => i128::from(nanoseconds(cell)),
        _ => cell.parse().unwrap_or_else(|error| panic!("{cell}: {error}")),
    };
    Value::integer(ty, number)
}

/// Milliseconds with up to six decimals.
fn nanoseconds(cell: &str) -> i64 {
    let (whole, decimals) = cell.split_once('.').unwrap_or((cell, ""));
    assert!(decimals.len() <= 6, "{cell} is finer than a nanosecond");
    format!("{whole}{decimals:0<6}").parse().unwrap_or_else(|error| panic!("{cell}: {error}"))
}

impl Case {
    /// Whether some row has EN FALSE.
    pub(crate) fn uses_enable(&self) -> bool {
        self.steps.iter().any(|step| !step.enabled)
    }

    /// A program with the block as `b`, an input variable named as the pin for each wired input, and `en`.
    ///
    /// With `enable`, the power on the block's left is `en` and so EN; without it, that power is the first input. Of a
    /// block whose first input is no BOOL it is EN in any case.
    pub(crate) fn program(&self, enable: bool) -> Program {
        let mut program = drawing::program("steps");
        program.variables.push(drawing::variable(VariableClass::Input, "en", Elementary::Bool));
        let mut arguments = Vec::new();
        let inputs = self.block.inputs();
        let enable = enable || inputs[0].ty != Elementary::Bool;
        for (index, pin) in inputs.iter().enumerate().filter(|(index, _)| *index == 0 || self.wired[*index]) {
            program.variables.push(drawing::variable(VariableClass::Input, &input(pin), pin.ty));
            if enable || index != 0 {
                let wire = if pin.ty == Elementary::Bool && index != 0 {
                    Wire::Circuit(Circuit {
                        branches: vec![drawing::branch(vec![drawing::contact(&input(pin))])],
                        span: drawing::NOWHERE,
                    })
                } else {
                    Wire::Value(drawing::read(&input(pin)))
                };
                arguments.push(drawing::argument(pin.name, wire));
            }
        }
        let power = if enable { "en".to_owned() } else { input(&inputs[0]) };
        let call = drawing::call("b", self.block, arguments);
        program.rungs.push(drawing::rung(vec![drawing::contact(&power), call]));
        program
    }

    /// What a step sets in that program: names and values.
    pub(crate) fn settings<'a>(&'a self, step: &'a Step) -> impl Iterator<Item = (String, Value)> + 'a {
        let inputs = self.block.inputs().iter().zip(&step.inputs).enumerate();
        let wired = inputs.filter(|(index, _)| *index == 0 || self.wired[*index]);
        wired.map(|(_, (pin, value))| (input(pin), *value)).chain([("en".to_owned(), Value::bool(step.enabled))])
    }

    /// What must hold after a step in that program: names and values.
    pub(crate) fn expectations<'a>(&'a self, step: &'a Step) -> impl Iterator<Item = (String, Value)> + 'a {
        self.block.outputs().iter().zip(&step.outputs).map(|(pin, value)| (format!("b.{}", pin.name), *value))
    }
}

/// The variable that an input is wired to.
fn input(pin: &Pin) -> String {
    format!("i_{}", pin.name)
}
