//! Pins of standard blocks and of units, as calls see them: which one an argument names, and which have to be wired.

use super::model::{Output, Type, UnitId, VariableId};
use super::{Checker, types};
use crate::diagnostic::{Code, Diagnostic};
use crate::elementary::Elementary;
use crate::ladder::library::{StandardBlock, Takes};
use crate::ladder::{self, BlockCall, Name};
use crate::source::Span;

/// A pin of a standard block or of a unit, as calls see it.
#[derive(Clone)]
pub(super) struct Pin {
    pub(super) name: String,
    pub(super) ty: Type,
    /// The range of its constants.
    pub(super) range: Option<(i64, i64)>,
    pub(super) takes: Takes,
    /// Its place among the references of a unit, if it is one; else among inputs or outputs.
    pub(super) place: usize,
}

/// What is called, as calls see it.
pub(super) struct Pins {
    /// The type's name.
    pub(super) name: String,
    pub(super) inputs: Vec<Pin>,
    pub(super) outputs: Vec<Pin>,
    /// Whether the first output is the result of a function.
    has_result: bool,
}

impl Pins {
    pub(super) fn of_block(block: StandardBlock) -> Self {
        let pin = |(place, pin): (usize, &ladder::library::Pin)| Pin {
            name: pin.name.to_owned(),
            ty: Type::Elementary(pin.ty),
            range: pin.range,
            takes: pin.takes,
            place,
        };
        Self {
            name: block.name().to_owned(),
            inputs: block.inputs().iter().enumerate().map(pin).collect(),
            outputs: block.outputs().iter().enumerate().map(pin).collect(),
            has_result: false,
        }
    }

    fn find<'a>(pins: &'a [Pin], name: &str) -> Option<&'a Pin> {
        let wanted = ladder::key(name);
        pins.iter().find(|pin| ladder::key(&pin.name) == wanted)
    }

    /// The output of that name; the result of a function is its `OUT`, too.
    fn output(&self, name: &str) -> Option<&Pin> {
        let result = || self.outputs.first().filter(|_| self.has_result && name.eq_ignore_ascii_case("OUT"));
        Self::find(&self.outputs, name).or_else(result)
    }

    fn list<'a>(pins: impl Iterator<Item = &'a Pin>) -> String {
        pins.map(|pin| format!("`{}`", pin.name)).collect::<Vec<_>>().join(", ")
    }
}

/// Where in a call an argument goes.
pub(super) enum Target<'a> {
    Enable,
    Enabled,
    Input(&'a Pin),
    Output(&'a Pin),
}

impl Checker<'_> {
    /// The pins of a unit, its references at the end of its inputs.
    pub(super) fn pins_of_unit(&self, unit: UnitId) -> Pins {
        let signature = &self.units[unit.index()];
        let pins = |ids: &[VariableId], takes: Takes| -> Vec<Pin> {
            let pin = |(place, id): (usize, &VariableId)| {
                let variable = &self.scope.entry(*id).variable;
                Pin { name: variable.name.to_string(), ty: variable.ty, range: None, takes, place }
            };
            ids.iter().enumerate().map(pin).collect()
        };
        let mut inputs = pins(&signature.inputs, Takes::Value);
        inputs.extend(pins(&signature.references, Takes::Reference));
        let (name, outputs) = (self.type_name(Type::Unit(unit)), pins(&signature.outputs, Takes::Value));
        Pins { name, inputs, outputs, has_result: self.has_result(unit) }
    }

    /// The pin that an argument is wired to: without a name the input at its place.
    pub(super) fn target<'a>(
        &mut self,
        pins: &'a Pins,
        (place, argument): (usize, &ladder::Argument),
        seen: &mut Vec<(String, Span)>,
    ) -> Option<Target<'a>> {
        let name = &argument.pin.text;
        let is_output = matches!(argument.wire, ladder::Wire::Output(_));
        let positional = pins.inputs.get(place).filter(|_| name.is_empty());
        let (input, output) = (positional.or_else(|| Pins::find(&pins.inputs, name)), pins.output(name));
        let found = match (is_output, input, output) {
            (false, Some(pin), _) => Target::Input(pin),
            (true, _, Some(pin)) => Target::Output(pin),
            (false, None, None) if name.eq_ignore_ascii_case("EN") => Target::Enable,
            (true, None, None) if name.eq_ignore_ascii_case("ENO") => Target::Enabled,
            (_, input, output) => {
                let (what, all) = if is_output { ("output", &pins.outputs) } else { ("input", &pins.inputs) };
                let message = if name.is_empty() {
                    format!("{} has no {} inputs", pins.name, place + 1)
                } else {
                    format!("{} has no {what} `{name}`", pins.name)
                };
                let hint = match (input, output) {
                    (Some(_), _) => format!("`{name}` is an input: write `{name} := value`"),
                    (_, Some(_)) => format!("`{name}` is an output: write `{name} => variable`"),
                    (None, None) => format!("its {what}s are {}", Pins::list(all.iter())),
                };
                self.report.push(Diagnostic::new(Code::UnknownPin, argument.pin.span, message).hint(hint));
                return None;
            }
        };
        let key = match found {
            Target::Input(pin) | Target::Output(pin) => ladder::key(&pin.name),
            Target::Enable | Target::Enabled => ladder::key(name),
        };
        if let Some((_, first)) = seen.iter().find(|(other, _)| *other == key) {
            let problem = Diagnostic::new(Code::DuplicatePin, argument.pin.span, format!("`{name}` is wired twice"));
            self.report.push(problem.related(*first, "wired first here"));
        } else {
            seen.push((key, argument.span));
        }
        Some(found)
    }

    /// Reports what has to be wired and is not.
    pub(super) fn check_missing(&mut self, pins: &Pins, seen: &[(String, Span)], call: &BlockCall) {
        for pin in pins.inputs.iter().filter(|pin| pin.takes != Takes::Value) {
            if !seen.iter().any(|(name, _)| *name == ladder::key(&pin.name)) {
                let what = if pin.takes == Takes::Constant { "a constant" } else { "a variable" };
                let message = format!("`{}` of {} has to be given {what}", pin.name, pins.name);
                self.report.push(Diagnostic::new(Code::WrongArguments, call.instance.span, message));
            }
        }
    }

    /// The output that gives the power on the right.
    pub(super) fn power_output(&mut self, pins: &Pins, name: &Name) -> Option<Output> {
        let bools = || Pins::list(pins.outputs.iter().filter(|pin| pin.ty == Type::Elementary(Elementary::Bool)));
        let problem = match pins.output(&name.text) {
            Some(pin) if pin.ty == Type::Elementary(Elementary::Bool) => return Some(Output::Pin(pin.place)),
            None if name.text.eq_ignore_ascii_case("ENO") => return Some(Output::Eno),
            Some(pin) => {
                let article = types::with_article(&self.type_name(pin.ty));
                Diagnostic::new(Code::PowerNotTaken, name.span, format!("`{}` is {article}, not power", name.text))
                    .hint(format!("power on the right comes from one of {}", bools()))
            }
            None => {
                Diagnostic::new(Code::UnknownPin, name.span, format!("{} has no output `{}`", pins.name, name.text))
                    .hint(format!("power on the right comes from one of {}", bools()))
            }
        };
        self.report.push(problem);
        None
    }
}
