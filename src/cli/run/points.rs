//! What a person sees and sets while a program runs: its inputs, outputs, variables and blocks by name.

use super::{duration, elements, time};
use crate::check::{Callee, Checked, Element, ExpressionKind, Input, Place, Type, Wire};
use crate::elementary::{Elementary, Value, f32_of};
use crate::ladder::library::StandardBlock;
use crate::logic::Layout;
use crate::logic::image::{Area, Slot};

/// The keys that inputs get, in order; `q` and `x` are kept free.
const KEYS: &str = "123456789abcdefghijklmnoprstuvwyz";

/// A variable.
#[derive(Clone, Debug)]
pub(super) struct Point {
    pub name: String,
    pub slot: Slot,
    /// The key that toggles or selects it, if it is an input.
    pub key: Option<char>,
}

/// A block instance.
#[derive(Clone, Debug)]
pub(super) struct Block {
    pub name: String,
    pub kind: StandardBlock,
    /// The BOOL outputs.
    pub powers: Vec<Point>,
    /// What it has reached, its first number: ET, CV or XOUT.
    pub reached: Option<Point>,
    /// What that is to reach: the PT of an ET, the PV of a CV.
    pub preset: Option<Preset>,
}

/// Where a preset comes from.
#[derive(Clone, Debug)]
pub(super) enum Preset {
    /// It is always the same.
    Constant(Value),
    /// It is in the image.
    Slot(Slot),
}

impl Preset {
    pub(super) fn value(&self, image: &[u8]) -> Value {
        match self {
            Self::Constant(value) => *value,
            Self::Slot(slot) => slot.read(image),
        }
    }
}

/// All of them.
#[derive(Clone, Debug, Default)]
pub(super) struct Points {
    pub inputs: Vec<Point>,
    pub outputs: Vec<Point>,
    pub variables: Vec<Point>,
    pub blocks: Vec<Block>,
    /// What is TRUE once an index was out of range.
    pub fault: Option<Slot>,
}

impl Points {
    pub(super) fn new(checked: &Checked, layout: &Layout) -> Self {
        let fault = layout.fault().map(|slot| layout.slot(slot).clone());
        let mut points = Self { fault, ..Self::default() };
        let mut keys = KEYS.chars();
        for observed in layout.observed() {
            let slot = layout.slot(observed.slot).clone();
            let mut point = Point { name: observed.name.to_string(), slot, key: None };
            match point.slot.area {
                Area::Input => {
                    point.key = keys.next();
                    points.inputs.push(point);
                }
                Area::Output => points.outputs.push(point),
                Area::Memory => points.variables.push(point),
                Area::State => {}
            }
        }
        let presets = presets(checked, layout);
        for (variable, preset) in checked.variables().iter().zip(presets) {
            if let Type::Block(kind) = variable.ty {
                points.blocks.push(Block::new(&variable.name, kind, preset, layout));
            }
        }
        points
    }

    /// The input of that name, in any case.
    pub(super) fn input(&self, name: &str) -> Option<&Point> {
        self.inputs.iter().find(|input| input.name.eq_ignore_ascii_case(name))
    }

    /// Whether an index was out of range.
    pub(super) fn is_faulty(&self, image: &[u8]) -> bool {
        self.fault.as_ref().is_some_and(|slot| slot.read(image).is_true())
    }

    /// What is told of in plain lines: the outputs and the blocks' powers, and first that an index was out of range.
    pub(super) fn told(&self) -> Vec<Point> {
        let powers = self.blocks.iter().flat_map(|block| &block.powers);
        let fault = self.fault.iter().map(|slot| Point { name: slot.name.to_string(), slot: slot.clone(), key: None });
        fault.chain(self.outputs.iter().chain(powers).cloned()).collect()
    }
}

/// What the preset of each block instance is wired to, where that is a constant or a variable.
fn presets(checked: &Checked, layout: &Layout) -> Vec<Option<Preset>> {
    let mut presets = vec![None; checked.variables().len()];
    elements::visit(checked, |element| {
        let Element::Call(call) = element else { return };
        let Callee::Standard(block, instance) = &call.callee else { return };
        let preset = [("ET", "PT"), ("CV", "PV")]
            .iter()
            .find_map(|(reached, preset)| block.output(reached).and_then(|_| block.input(preset)));
        let wired = call.inputs.iter().find(|input| Some(input.pin) == preset);
        let Some(Input { wire: Wire::Value(expression), .. }) = wired else { return };
        presets[instance.variable.index()] = match &expression.kind {
            ExpressionKind::Constant(value) => Some(Preset::Constant(*value)),
            ExpressionKind::Read(Place { variable, path, bit: None }) if path.is_empty() => {
                slot(layout, &checked.variable(*variable).name).map(Preset::Slot)
            }
            _ => None,
        };
    });
    presets
}

/// The slot of an observed name.
fn slot(layout: &Layout, name: &str) -> Option<Slot> {
    layout.observed().iter().find(|observed| observed.name == name).map(|observed| layout.slot(observed.slot).clone())
}

impl Block {
    fn new(name: &str, kind: StandardBlock, preset: Option<Preset>, layout: &Layout) -> Self {
        let outputs = kind.outputs().iter().filter_map(|pin| {
            let name = format!("{name}.{}", pin.name);
            slot(layout, &name).map(|slot| Point { name, slot, key: None })
        });
        let (powers, numbers): (Vec<_>, Vec<_>) = outputs.partition(|output| output.slot.ty == Elementary::Bool);
        Self { name: name.to_owned(), kind, powers, reached: numbers.into_iter().next(), preset }
    }
}

/// A value as a person reads it: `0`, `-12`, `T#1.5s`, `0.1`.
pub(super) fn shown(value: Value) -> String {
    match value.ty() {
        Elementary::Time => time::literal(value.bits().cast_signed()),
        Elementary::Real => format!("{:?}", f32_of(value.bits())),
        Elementary::Lreal => format!("{:?}", f64::from_bits(value.bits())),
        _ => value.as_integer().unwrap_or_default().to_string(),
    }
}

/// A value as a person writes it: `0`, `1`, `TRUE`, `FALSE`, `-12`, `16#FF`, `T#1.5s` or `1.5s`, `0.1`.
pub(super) fn read(ty: Elementary, text: &str) -> Option<Value> {
    let upper = text.to_ascii_uppercase();
    match ty {
        Elementary::Bool if upper == "TRUE" => Some(Value::bool(true)),
        Elementary::Bool if upper == "FALSE" => Some(Value::bool(false)),
        Elementary::Real | Elementary::Lreal => {
            text.parse::<f64>().ok().filter(|value| value.is_finite()).and_then(|value| Value::real(ty, value))
        }
        Elementary::Time => {
            let text = text.get(..2).filter(|start| start.eq_ignore_ascii_case("t#")).map_or(text, |_| &text[2..]);
            let (negative, magnitude) = text.strip_prefix('-').map_or((false, text), |rest| (true, rest));
            let nanoseconds = if magnitude == "0" || magnitude.eq_ignore_ascii_case("0s") {
                0
            } else {
                duration::parse(&magnitude.to_ascii_lowercase()).ok()?
            };
            Some(Value::time(if negative { -nanoseconds } else { nanoseconds }))
        }
        _ => {
            let number = match upper.split_once('#') {
                Some((base, digits)) => {
                    let base = base.parse().ok().filter(|base| [2, 8, 16].contains(base))?;
                    i128::from_str_radix(digits, base).ok()?
                }
                None => text.parse().ok()?,
            };
            Value::integer(ty, number)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_read_as_they_are_shown() {
        for (ty, text) in [
            (Elementary::Bool, "1"),
            (Elementary::Int, "-32768"),
            (Elementary::Lword, "18446744073709551615"),
            (Elementary::Real, "0.1"),
            (Elementary::Lreal, "1e300"),
            (Elementary::Time, "T#1.5s"),
            (Elementary::Time, "T#-250ms"),
            (Elementary::Time, "T#0s"),
        ] {
            assert_eq!(read(ty, text).map(shown).as_deref(), Some(text));
        }
        assert_eq!(read(Elementary::Bool, "true"), Some(Value::bool(true)));
        assert_eq!(read(Elementary::Byte, "16#fF").map(Value::bits), Some(255));
    }

    #[test]
    fn what_does_not_fit_the_type_is_refused() {
        for (ty, text) in [
            (Elementary::Bool, "2"),
            (Elementary::Bool, ""),
            (Elementary::Int, "32768"),
            (Elementary::Uint, "-1"),
            (Elementary::Byte, "16#"),
            (Elementary::Byte, "16#100"),
            (Elementary::Byte, "99#1"),
            (Elementary::Real, "NaN"),
            (Elementary::Time, "5"),
            (Elementary::Time, "é"),
        ] {
            assert_eq!(read(ty, text), None, "{ty} {text}");
        }
    }
}
