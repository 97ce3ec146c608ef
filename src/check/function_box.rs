//! Boxes of standard functions: calls in a rung, or as a statement, that stand for themselves rather than in an
//! expression. The types are those that an expression's call chooses; but nothing is folded, and no function becomes an
//! operator, since a box has an ENO that tells whether it failed.

use std::collections::BTreeMap;

use super::constant;
use super::expression::{Operand, constant as constant_expression};
use super::function::Actual;
use super::model::{self, Branch, Call, Callee, Circuit, Input, Output, Place, Statement, Type, UnitId, Wire};
use super::network::Walk;
use super::report::clipped;
use super::{Checker, types};
use crate::diagnostic::{Code, Diagnostic};
use crate::elementary::{Elementary, Value};
use crate::ladder::functions::{Function, StandardFunction};
use crate::ladder::{self, Argument, BlockCall, ExpressionKind, Name, Origin, Reference};
use crate::source::Span;

/// The most inputs of a box that are filled in where a drawing leaves them open.
const MOST_OPEN: usize = 256;

/// What a box of a function comes to.
pub(super) enum Boxed {
    Call(Box<Call>),
    /// MOVE of a whole array or structure.
    Copy(Box<Copied>),
}

/// A MOVE of a whole array or structure.
pub(super) struct Copied {
    enable: Option<Wire>,
    target: Place,
    source: Place,
    /// Where ENO goes.
    enabled: Option<Place>,
}

/// What is wired to a box, sorted by what it is for.
#[derive(Default)]
struct Wired {
    enable: Option<Wire>,
    /// The inputs by their places.
    inputs: BTreeMap<usize, Given>,
    /// Where each output goes, its type and its place in the source.
    outputs: Vec<(Output, Place, Type, Span)>,
    /// What is wired already, and where.
    seen: Vec<(Pin, Span)>,
    /// Whether something is wrong with a wire, which was reported.
    faulty: bool,
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Pin {
    Enable,
    Enabled,
    Input(usize),
    Output,
}

enum Given {
    Operand(Operand, Span),
    Circuit(Circuit, Span),
    /// All of an array or structure.
    Whole(Place, Type),
}

impl Boxed {
    /// As an element of a rung.
    pub(super) fn element(self) -> model::Element {
        match self {
            Self::Call(call) => model::Element::Call(call),
            Self::Copy(copied) => {
                let Copied { enable, target, source, enabled } = *copied;
                let mut elements: Vec<model::Element> = match enable {
                    Some(Wire::Value(condition)) => vec![model::Element::Condition(condition)],
                    _ => Vec::new(),
                };
                elements.push(model::Element::Statements(vec![Statement::Copy { target, source, done: None }]));
                let coil = |target| model::Element::Coil { kind: ladder::CoilKind::Plain, target };
                elements.extend(enabled.map(coil));
                model::Element::Parallel(Circuit {
                    branches: Box::new([Branch { from: None, elements: elements.into(), to: None }]),
                })
            }
        }
    }

    /// As a statement.
    pub(super) fn statement(self) -> Statement {
        match self {
            Self::Call(call) => Statement::Call(*call),
            Self::Copy(copied) => {
                let Copied { enable, target, source, enabled } = *copied;
                let copy = Statement::Copy { target, source, done: enabled.clone() };
                let Some(Wire::Value(condition)) = enable else { return copy };
                let value = constant_expression(Value::bool(false));
                let otherwise = enabled.map(|target| Statement::Assignment { target, value });
                Statement::If { branches: vec![(condition, vec![copy])], otherwise: otherwise.into_iter().collect() }
            }
        }
    }
}

/// What a name that no variable has is the function of.
pub(super) enum Boxable {
    Standard(Function),
    User(UnitId),
}

impl Checker<'_> {
    /// The function that a call names, unless what it names is a variable.
    pub(super) fn boxed_function(&self, call: &BlockCall) -> Option<Boxable> {
        let name =
            call.instance.as_name().filter(|name| call.type_name.is_none() && self.scope.find(name).is_none())?;
        match self.function_unit(name) {
            Some(unit) => Some(Boxable::User(unit)),
            None => Function::from_name(&name.text).map(Boxable::Standard),
        }
    }

    /// A box of a standard function.
    pub(super) fn standard_box(&mut self, function: Function, call: &BlockCall, walk: &mut Walk) -> Option<Boxed> {
        let name = call.instance.as_name()?;
        let mut wired = Box::<Wired>::default();
        for (place, argument) in call.arguments.iter().enumerate() {
            self.box_argument(function, name, (place, argument), &mut wired, walk);
        }
        self.finish_box(function, name, call, wired)
    }

    fn box_argument(
        &mut self,
        function: Function,
        name: &Name,
        (place, argument): (usize, &Argument),
        wired: &mut Wired,
        walk: &mut Walk,
    ) {
        let pin = self.box_pin(function, name, (place, argument), wired);
        wired.faulty |= pin.is_none();
        match &argument.wire {
            ladder::Wire::Value(value) => self.box_value(function, pin, value, wired),
            ladder::Wire::Circuit(circuit) => {
                let checked = self.pin_circuit(circuit, walk);
                match pin {
                    Some(Pin::Enable) => wired.enable = Some(Wire::Circuit(checked)),
                    Some(Pin::Input(place)) => {
                        wired.inputs.insert(place, Given::Circuit(checked, circuit.span));
                    }
                    _ => {}
                }
            }
            ladder::Wire::Output(target) => self.box_output(pin, target, wired),
        }
    }

    fn box_value(&mut self, function: Function, pin: Option<Pin>, value: &ladder::Expression, wired: &mut Wired) {
        let Some(Pin::Input(place)) = pin else {
            let enable = match pin {
                Some(_) => self.value(value, Elementary::Bool).map(Wire::Value),
                None => self.operand(value).and(None),
            };
            wired.faulty |= enable.is_none();
            wired.enable = enable.or(wired.enable.take());
            return;
        };
        let given = match &value.kind {
            ExpressionKind::Read(reference)
                if function == Function::Standard(StandardFunction::Move) && self.may_be_whole(reference) =>
            {
                match self.place(reference) {
                    Some((source, ty @ (Type::Array(_) | Type::Structure(_)))) => Some(Given::Whole(source, ty)),
                    Some(_) => self.operand(value).map(|operand| Given::Operand(operand, value.span)),
                    None => None,
                }
            }
            _ => self.operand(value).map(|operand| Given::Operand(operand, value.span)),
        };
        match given {
            Some(given) => drop(wired.inputs.insert(place, given)),
            None => wired.faulty = true,
        }
    }

    /// Whether a reference starts at something that is no single value.
    fn may_be_whole(&self, reference: &Reference) -> bool {
        match &reference.root {
            ladder::Root::Name(name) => {
                self.scope.find(name).is_some_and(|id| !matches!(self.scope.entry(id).variable.ty, Type::Elementary(_)))
            }
            ladder::Root::Address(_) => false,
        }
    }

    fn box_output(&mut self, pin: Option<Pin>, target: &Reference, wired: &mut Wired) {
        let Some((place, ty)) = self.written(target) else {
            wired.faulty = true;
            return;
        };
        let output = match pin {
            Some(Pin::Enabled) => Output::Eno,
            _ => Output::Pin(0),
        };
        if output == Output::Eno && ty != Type::Elementary(Elementary::Bool) {
            wired.faulty = true;
            self.wrong_target("ENO", Type::Elementary(Elementary::Bool), ty, target.span);
        } else {
            wired.outputs.push((output, place, ty, target.span));
        }
    }

    /// The pin of a function that an argument is wired to: without a name the one at its place.
    fn box_pin(
        &mut self,
        function: Function,
        name: &Name,
        (place, argument): (usize, &Argument),
        wired: &mut Wired,
    ) -> Option<Pin> {
        let text = &argument.pin.text;
        let is = |other: &str| text.eq_ignore_ascii_case(other);
        let is_output = matches!(argument.wire, ladder::Wire::Output(_));
        let pin = match function {
            _ if is_output && (is("OUT") || is(&name.text)) => Some(Pin::Output),
            _ if is_output => is("ENO").then_some(Pin::Enabled),
            Function::Standard(function) if text.is_empty() => function.parameter(place).map(|_| Pin::Input(place)),
            Function::Standard(function) => function.place(text).map(Pin::Input),
            _ if text.is_empty() => (place == 0).then_some(Pin::Input(0)),
            Function::Convert { .. } | Function::Truncate { .. } => is("IN").then_some(Pin::Input(0)),
        };
        let pin = pin.or((!is_output && is("EN")).then_some(Pin::Enable));
        let Some(pin) = pin else {
            let what = if is_output { "output" } else { "input" };
            let message = if text.is_empty() {
                format!("{} has no {} inputs", name.text, place + 1)
            } else {
                format!("{} has no {what} `{}`", name.text, clipped(text))
            };
            let hint = if is_output {
                "its outputs are `OUT` and `ENO`".to_owned()
            } else {
                format!("its parameters are {}", signature(name, function))
            };
            self.report.push(Diagnostic::new(Code::UnknownPin, argument.pin.span, message).hint(hint));
            return None;
        };
        if let Some((_, first)) = wired.seen.iter().find(|(other, _)| *other == pin) {
            let problem = Diagnostic::new(Code::DuplicatePin, argument.pin.span, format!("`{text}` is wired twice"));
            self.report.push(problem.related(*first, "wired first here"));
            return None;
        }
        wired.seen.push((pin, argument.span));
        Some(pin)
    }

    fn finish_box(&mut self, function: Function, name: &Name, call: &BlockCall, wired: Box<Wired>) -> Option<Boxed> {
        let chosen = match &call.power_output {
            None => Some(Output::Eno),
            Some(output) => self.box_power(name, output),
        };
        let mut wired = wired;
        if wired.faulty {
            return None;
        }
        if let Some(Given::Whole(..)) = wired.inputs.get(&0) {
            return self.whole_move(call, *wired);
        }
        let mut actuals = self.box_actuals(function, name, &mut wired.inputs)?;
        let result = wired.outputs.iter().find_map(|(output, _, ty, _)| match (output, ty) {
            (Output::Pin(_), Type::Elementary(ty)) => Some(*ty),
            _ => None,
        });
        // What MOVE moves may be widened, as what is assigned may.
        if let (Function::Standard(StandardFunction::Move), Some(to), [actual]) =
            (function, result, actuals.as_mut_slice())
            && let Some(Operand::Typed(model::Expression { ty: from, .. })) = &actual.operand
            && types::widens(*from, to)
            && let Some(operand) = actual.operand.take()
        {
            actual.operand = Some(Operand::Typed(self.coerce(operand, to, actual.span)?));
        }
        let (function, operands, ty) = self.typed_call(function, name, actuals, result)?;
        if let (Function::Standard(StandardFunction::Divide | StandardFunction::Modulo), [_, (divisor, span)]) =
            (function, operands.as_slice())
            && divisor.constant().is_some_and(constant::is_zero)
        {
            self.divided_by_zero(ty.is_real(), *span);
        }
        let mut circuits = wired.inputs;
        let inputs = operands.into_iter().enumerate().map(|(pin, (value, _))| {
            let wire = match circuits.remove(&pin) {
                Some(Given::Circuit(circuit, _)) => Wire::Circuit(circuit),
                _ => Wire::Value(value),
            };
            Input { pin, wire }
        });
        let inputs = inputs.collect();
        let mut whole = true;
        for (output, _, target, span) in &wired.outputs {
            if *output != Output::Eno && *target != Type::Elementary(ty) {
                self.wrong_target("OUT", Type::Elementary(ty), *target, *span);
                whole = false;
            }
        }
        let power_output = chosen?;
        if power_output != Output::Eno && ty != Elementary::Bool {
            let span = call.power_output.as_ref().map_or(name.span, |output| output.span);
            let message = format!("`OUT` is {}, not power", types::with_article(ty.name()));
            let problem = Diagnostic::new(Code::PowerNotTaken, span, message);
            self.report.push(problem.hint("without a choice the power on the right is ENO"));
            return None;
        }
        let outputs = wired.outputs.into_iter().map(|(output, place, ..)| (output, place)).collect();
        let callee = Callee::Function(function, ty);
        let (enable, references) = (wired.enable, Vec::new());
        let call = Call { callee, enable, power_input: None, inputs, references, outputs, power_output };
        whole.then(|| Boxed::Call(Box::new(call)))
    }

    /// The inputs in order; those that a drawing leaves open are filled in.
    fn box_actuals(
        &mut self,
        function: Function,
        name: &Name,
        inputs: &mut BTreeMap<usize, Given>,
    ) -> Option<Vec<Actual>> {
        let least = match function {
            Function::Standard(function) => function.parameters().len(),
            Function::Convert { .. } | Function::Truncate { .. } => 1,
        };
        let count = inputs.last_key_value().map_or(0, |(last, _)| last.saturating_add(1)).max(least);
        let open = count - inputs.len();
        if open > 0 && (self.program.origin == Origin::Native || count > MOST_OPEN) {
            let message = if open == 1 { "an input is".to_owned() } else { format!("{open} inputs are") };
            let message = format!("{message} not wired, and {} needs all", name.text);
            let problem = Diagnostic::new(Code::WrongArguments, name.span, message);
            self.report.push(problem.hint(format!("its parameters are {}", signature(name, function))));
            return None;
        }
        let mut actuals = Vec::with_capacity(count);
        for place in 0..count {
            let none = || Actual { operand: None, span: name.span };
            // A circuit stays where it is; its type is that of any BOOL.
            let circuit = match inputs.get(&place) {
                Some(Given::Circuit(_, span)) => Some(*span),
                _ => None,
            };
            actuals.push(match circuit {
                Some(span) => Actual { operand: Some(Operand::Typed(constant_expression(Value::bool(false)))), span },
                None => match inputs.remove(&place) {
                    Some(Given::Operand(operand, span)) => Actual { operand: Some(operand), span },
                    _ => none(),
                },
            });
        }
        Some(actuals)
    }

    /// The power on the right that a box's call chooses.
    fn box_power(&mut self, name: &Name, output: &Name) -> Option<Output> {
        if output.text.eq_ignore_ascii_case("ENO") {
            return Some(Output::Eno);
        } else if output.text.eq_ignore_ascii_case("OUT") || output.key() == name.key() {
            return Some(Output::Pin(0));
        }
        let message = format!("{} has no output `{}`", name.text, clipped(&output.text));
        let problem = Diagnostic::new(Code::UnknownPin, output.span, message);
        self.report.push(problem.hint("its outputs are `OUT` and `ENO`"));
        None
    }

    /// A MOVE of a whole array or structure.
    fn whole_move(&mut self, call: &BlockCall, mut wired: Wired) -> Option<Boxed> {
        let Some(Given::Whole(source, ty)) = wired.inputs.remove(&0) else { return None };
        let (mut target, mut enabled) = (None, None);
        for (output, place, found, span) in wired.outputs {
            if output == Output::Eno {
                enabled = Some(place);
            } else if found == ty {
                target = Some(place);
            } else {
                self.wrong_target("OUT", ty, found, span);
                return None;
            }
        }
        let (problem, hint) = if self.types.holds_instance(ty) {
            ("what holds block instances cannot be copied", "copy its members one by one")
        } else if matches!(wired.enable, Some(Wire::Circuit(_))) {
            ("MOVE of an array or structure takes no circuit at EN", "wire a variable, or use the power on its left")
        } else if let Some(output) =
            call.power_output.as_ref().filter(|output| !output.text.eq_ignore_ascii_case("ENO"))
        {
            let message = format!("`{}` is {}, not power", output.text, types::with_article(&self.type_name(ty)));
            self.report.push(Diagnostic::new(Code::PowerNotTaken, output.span, message));
            return None;
        } else if let Some(target) = target {
            self.weigh_copy(ty, [&source, &target], call.instance.span);
            return Some(Boxed::Copy(Box::new(Copied { enable: wired.enable, target, source, enabled })));
        } else {
            ("MOVE of an array or structure needs a place to go to", "wire `OUT`")
        };
        self.report.push(Diagnostic::new(Code::WrongArguments, call.instance.span, problem).hint(hint));
        None
    }
}

/// The parameters of a function as a call has them.
pub(super) fn signature(name: &Name, function: Function) -> String {
    let (listed, more): (Vec<&str>, bool) = match function {
        Function::Standard(function) => {
            (function.parameters().iter().map(|parameter| parameter.name).collect(), function.is_extensible())
        }
        Function::Convert { .. } | Function::Truncate { .. } => (vec!["IN"], false),
    };
    format!("{}({}{})", name.text, listed.join(", "), if more { ", …" } else { "" })
}
