//! Step tables: what a block must do, scan by scan, as data in `tests/blocks/*.csv`.
//!
//! A row is one scan: its time, EN, the inputs, the outputs that must hold after it, and the rule that it pins. An
//! empty input keeps its last value; one that is empty in a whole case is not wired at all. An input that takes a
//! constant has that of a case's first row. For an input `R` that takes a reference there are columns `R[0]`, `R[1]` and
//! so on, the first of [`REGISTERS`] that it stands for, and the same once more behind the outputs: what they hold
//! before the scan, where that is set, and after it; an empty one there must not have changed. Nothing here must know
//! what a block does.

use rung::elementary::{Elementary, Value};
use rung::ladder::library::{Pin, StandardBlock, Takes};
use rung::ladder::{Circuit, Expression, Literal, Program, VariableClass, Wire};
use rung::ladder::{ExpressionKind, UnaryOperator};

use super::drawing;

/// How many registers a reference stands for.
pub(crate) const REGISTERS: u32 = 32;

/// A register: the pin that refers to it, its place from there, and a value.
pub(crate) type Register = (usize, usize, Value);

/// One row.
#[derive(Clone, Debug)]
pub(crate) struct Step {
    /// The scan's time in nanoseconds.
    pub now: i64,
    /// EN.
    pub enabled: bool,
    /// One value for each input; of those that take a reference it means nothing.
    pub inputs: Vec<Value>,
    /// The registers that are set before the scan.
    pub registers: Vec<Register>,
    /// One value for each output, after the scan.
    pub outputs: Vec<Value>,
    /// The same for the registers with a column.
    pub registers_after: Vec<Register>,
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
        (&[B::Tt], include_str!("../blocks/tt.csv")),
        (&[B::Ts], include_str!("../blocks/ts.csv")),
        (&[B::Uc], include_str!("../blocks/uc.csv")),
        (&[B::Dc], include_str!("../blocks/dc.csv")),
        (&[B::Dr], include_str!("../blocks/dr.csv")),
        (&[B::Shiftl], include_str!("../blocks/shiftl.csv")),
        (&[B::Shiftr], include_str!("../blocks/shiftr.csv")),
        (&[B::Bs], include_str!("../blocks/bs.csv")),
        (&[B::Bc], include_str!("../blocks/bc.csv")),
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
    let header: Vec<String> = reader.headers().expect("a header").iter().map(str::to_owned).collect();
    let registers = register_columns(block, &header);
    let (inputs, outputs) = (block.inputs(), block.outputs());
    let cells = |pin: usize| match inputs[pin].takes {
        Takes::Reference => (registers.iter().filter(|of| of.0 == pin)).map(|of| register_name(inputs, of)).collect(),
        _ => vec![inputs[pin].name.to_owned()],
    };
    let first_output = 3 + (0..inputs.len()).flat_map(cells).count();
    let expected = ["case", "time_ms", "EN"].into_iter().map(str::to_owned).chain((0..inputs.len()).flat_map(cells));
    let expected = expected.chain(outputs.iter().map(|pin| pin.name.to_owned()));
    let expected = expected.chain(registers.iter().map(|of| register_name(inputs, of))).chain(["rule".to_owned()]);
    assert_eq!(header, expected.collect::<Vec<String>>(), "{}", block.name());
    // Whether all numbers of a case are of the block's types, beside the case.
    let mut cases: Vec<(Case, bool)> = Vec::new();
    let mut current = String::new();
    for row in reader.records() {
        let row = row.unwrap_or_else(|error| panic!("{}: {error}", block.name()));
        if row[0] != current || cases.is_empty() {
            current = row[0].to_owned();
            cases.push((Case { block, steps: Vec::new(), wired: vec![false; inputs.len()] }, true));
        }
        let (case, fits) = cases.last_mut().expect("one was begun");
        let last = case.steps.last();
        let mut column = 3;
        let mut step = Step {
            now: nanoseconds(&row[1]),
            enabled: &row[2] != "0",
            inputs: Vec::new(),
            registers: Vec::new(),
            outputs: Vec::new(),
            registers_after: Vec::new(),
            rule: String::new(),
        };
        for (index, pin) in inputs.iter().enumerate() {
            let last = last.map_or(pin.initial_value(), |step| step.inputs[index]);
            if pin.takes == Takes::Reference {
                for (_, place) in registers.iter().filter(|(pin, _)| *pin == index) {
                    if !row[column].is_empty() {
                        step.registers.push((index, *place, word(&row[column])));
                    }
                    column += 1;
                }
                case.wired[index] = true;
                step.inputs.push(last);
                continue;
            }
            let cell = &row[column];
            let given = if cell.is_empty() { Some(last) } else { value(pin.ty, cell) };
            *fits &= given.is_some();
            step.inputs.push(given.unwrap_or(last));
            case.wired[index] |= !cell.is_empty();
            column += 1;
        }
        for (pin, cell) in outputs.iter().zip(row.iter().skip(first_output)) {
            let value = value(pin.ty, cell);
            *fits &= value.is_some();
            step.outputs.push(value.unwrap_or(Value::default_of(pin.ty)));
        }
        let after = row.iter().skip(first_output + outputs.len());
        for (of @ (pin, place), cell) in registers.iter().zip(after) {
            let is_it = |register: &&Register| (register.0, register.1) == *of;
            let held = || step.registers.iter().find(is_it).or_else(|| last?.registers_after.iter().find(is_it));
            let unchanged = || held().map_or(Value::default_of(Elementary::Word), |register| register.2);
            let value = if cell.is_empty() { unchanged() } else { word(cell) };
            step.registers_after.push((*pin, *place, value));
        }
        let line = row.position().map_or(0, csv::Position::line);
        step.rule = format!("{}, line {line}, {current}: {}", block.name(), &row[row.len() - 1]);
        case.steps.push(step);
    }
    cases.into_iter().filter_map(|(case, fits)| fits.then_some(case)).collect()
}

/// The registers that a table has columns for: the place of the pin, and that of the register from there.
fn register_columns(block: StandardBlock, header: &[String]) -> Vec<(usize, usize)> {
    let mut registers = Vec::new();
    for (pin, Pin { name, takes, .. }) in block.inputs().iter().enumerate() {
        if *takes == Takes::Reference {
            let columns = header.iter().filter(|cell| cell.starts_with(&format!("{name}["))).count();
            registers.extend((0..columns / 2).map(|place| (pin, place)));
        }
    }
    registers
}

fn register_name(inputs: &[Pin], (pin, place): &(usize, usize)) -> String {
    format!("{}[{place}]", inputs[*pin].name)
}

/// A WORD, also as `16#FF`.
fn word(cell: &str) -> Value {
    value(Elementary::Word, cell).unwrap_or_else(|| panic!("{cell} is no WORD"))
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
        _ if cell.starts_with("16#") => {
            i128::from_str_radix(&cell[3..], 16).unwrap_or_else(|error| panic!("{cell}: {error}"))
        }
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
        let variables = &mut program.units[0].variables;
        variables.push(drawing::variable(VariableClass::Input, "en", Elementary::Bool));
        let mut arguments = Vec::new();
        let inputs = self.block.inputs();
        let enable = enable || inputs[0].ty != Elementary::Bool;
        for (index, pin) in inputs.iter().enumerate().filter(|(index, _)| *index == 0 || self.wired[*index]) {
            let wire = match pin.takes {
                Takes::Constant => Wire::Value(constant(self.steps[0].inputs[index])),
                Takes::Reference => {
                    variables.push(drawing::array(VariableClass::Memory, &input(pin), REGISTERS, Elementary::Word));
                    Wire::Value(drawing::read(&format!("{}[0]", input(pin))))
                }
                Takes::Value => {
                    variables.push(drawing::variable(VariableClass::Input, &input(pin), pin.ty));
                    if !enable && index == 0 {
                        continue;
                    }
                    if pin.ty == Elementary::Bool && index != 0 {
                        let branches = vec![drawing::branch(vec![drawing::contact(&input(pin))])];
                        Wire::Circuit(Circuit { branches, span: drawing::NOWHERE })
                    } else {
                        Wire::Value(drawing::read(&input(pin)))
                    }
                }
            };
            arguments.push(drawing::argument(pin.name, wire));
        }
        let power = if enable { "en".to_owned() } else { input(&inputs[0]) };
        let call = drawing::call("b", self.block, arguments);
        program.units[0].rungs.push(drawing::rung(vec![drawing::contact(&power), call]));
        program
    }

    /// What a step sets in that program: names and values.
    pub(crate) fn settings<'a>(&'a self, step: &'a Step) -> impl Iterator<Item = (String, Value)> + 'a {
        let inputs = self.block.inputs().iter().zip(&step.inputs).enumerate();
        let wired = inputs.filter(|(index, (pin, _))| pin.takes == Takes::Value && (*index == 0 || self.wired[*index]));
        let inputs = wired.map(|(_, (pin, value))| (input(pin), *value));
        inputs.chain(self.named(&step.registers)).chain([("en".to_owned(), Value::bool(step.enabled))])
    }

    /// What must hold after a step in that program: names and values.
    pub(crate) fn expectations<'a>(&'a self, step: &'a Step) -> impl Iterator<Item = (String, Value)> + 'a {
        let outputs = self.block.outputs().iter().zip(&step.outputs);
        let outputs = outputs.map(|(pin, value)| (format!("b.{}", pin.name), *value));
        outputs.chain(self.named(&step.registers_after))
    }

    fn named<'a>(&'a self, registers: &'a [Register]) -> impl Iterator<Item = (String, Value)> + 'a {
        let name = |pin: usize, place| format!("{}[{place}]", input(&self.block.inputs()[pin]));
        registers.iter().map(move |(pin, place, value)| (name(*pin, *place), *value))
    }
}

/// A literal.
fn constant(value: Value) -> Expression {
    match (value.ty(), value.as_integer()) {
        (Elementary::Bool, _) => literal(Literal::Bool(value.is_true())),
        (Elementary::Time, Some(nanoseconds)) => {
            literal(Literal::Time(i64::try_from(nanoseconds).expect("a TIME has 64 bits")))
        }
        (_, Some(number)) => drawing::integer(number),
        (_, None) => {
            let number = value.as_real().expect("it is no integer");
            let magnitude = literal(Literal::Real { value: number.abs(), ty: None });
            if number < 0.0 {
                drawing::expression(ExpressionKind::Unary(UnaryOperator::Negate, Box::new(magnitude)))
            } else {
                magnitude
            }
        }
    }
}

fn literal(literal: Literal) -> Expression {
    drawing::expression(ExpressionKind::Literal(literal))
}

/// The variable that an input is wired to.
fn input(pin: &Pin) -> String {
    format!("i_{}", pin.name)
}
