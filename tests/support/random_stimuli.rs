//! Random times and inputs for a program, such that timers run out and edges come.

use rung::check::{Checked, VariableId};
use rung::elementary::{Elementary, Value};
use rung::ladder::VariableClass;
use rung::logic::Layout;

use super::dice::Dice;

const MILLISECOND: i64 = 1_000_000;

/// What happens before the scans of a program, one after the other.
pub(crate) struct Stimuli {
    dice: Dice,
    now: i64,
    inputs: Vec<Input>,
}

struct Input {
    name: String,
    ty: Elementary,
    /// How many times in a hundred scans it gets a new value.
    percent: usize,
    value: Value,
}

impl Stimuli {
    /// The stimuli of a seed for a program, of which everything that can be observed is given with its value.
    pub(crate) fn new(seed: u64, checked: &Checked, observed: &[(String, Value)]) -> Self {
        let mut dice = Dice::new(seed, 2);
        let inputs = inputs(checked)
            .into_iter()
            .flat_map(|input| observed.iter().filter(move |(name, _)| is_in(name, &input)).cloned());
        let inputs = inputs.map(|(name, value)| {
            // Some flicker, some stay long enough for a timer.
            let percent = *dice.pick(&[50, 20, 8, 3]);
            Input { name, ty: value.ty(), percent, value }
        });
        let inputs = inputs.collect();
        // A controller that has been running for ages must still add times right.
        let now = *dice.pick(&[0, 0, 1, 3_600_000 * MILLISECOND, 1 << 62]);
        Self { dice, now, inputs }
    }

    /// The time of the next scan and the inputs that change before it.
    pub(crate) fn next(&mut self) -> (i64, Vec<(String, Value)>) {
        let now = self.now;
        let dice = &mut self.dice;
        let odd = i64::try_from(dice.below(3_000_001)).expect("it is small");
        self.now += match dice.below(12) {
            0 => 0,
            1 => 1,
            2 => MILLISECOND - 1,
            3 => odd,
            4 => 50 * MILLISECOND,
            5 => 100 * MILLISECOND,
            6 if dice.percent(30) => 1000 * MILLISECOND,
            6 | 7 => 10 * MILLISECOND,
            8 | 9 => 5 * MILLISECOND,
            _ => MILLISECOND,
        };
        let mut changes = Vec::new();
        for input in &mut self.inputs {
            if dice.percent(input.percent) {
                input.value = value(dice, input.ty, input.value);
                changes.push((input.name.clone(), input.value));
            }
        }
        (now, changes)
    }
}

/// Everything that can be observed in a layout, with what it starts with.
pub(crate) fn observed(layout: &Layout) -> Vec<(String, Value)> {
    layout.observed().iter().map(|one| (one.name.to_string(), layout.slot(one.slot).initial)).collect()
}

/// The names of the variables that are inputs, global ones first.
fn inputs(checked: &Checked) -> Vec<String> {
    let is_input = |id: &VariableId| checked.variable(*id).class == VariableClass::Input;
    let mut names: Vec<String> =
        checked.globals().filter(is_input).map(|id| checked.variable(id).name.to_string()).collect();
    for program in checked.programs() {
        for id in checked.unit(program.unit).variables().filter(is_input) {
            let name = &checked.variable(id).name;
            names.push(match checked.programs().len() {
                1 => name.to_string(),
                _ => format!("{}.{name}", program.name),
            });
        }
    }
    names
}

/// Whether something observed is a variable or a part of it.
fn is_in(name: &str, variable: &str) -> bool {
    name.strip_prefix(variable).is_some_and(|rest| rest.is_empty() || rest.starts_with(['.', '[']))
}

/// The next value of an input: mostly small, sometimes any.
fn value(dice: &mut Dice, ty: Elementary, last: Value) -> Value {
    let small = dice.below(6) as u64;
    match ty {
        Elementary::Bool => Value::bool(!last.is_true()),
        Elementary::Time if dice.percent(95) => Value::time(small.cast_signed() * 10 * MILLISECOND),
        Elementary::Real | Elementary::Lreal if dice.percent(80) => {
            let number = f64::from(u32::try_from(small).expect("it is small")) * 0.75 - 1.5;
            Value::real(ty, number).expect("it is a REAL or LREAL")
        }
        _ if ty.is_real() || dice.percent(15) => Value::from_bits(ty, dice.bits()),
        _ => Value::from_bits(ty, small.wrapping_sub(u64::from(dice.percent(20)) * 3)),
    }
}
