//! Calls of blocks: the instance, its type, and what is wired to its pins.

use super::function_box::{Boxable, Boxed};
use super::model::{Call, Callee, Circuit, Input, Output, Place, Type, Wire};
use super::network::{Power, Walk};
use super::pins::{Pin, Pins, Target};
use super::register::is_constant;
use super::{Checker, types};
use crate::diagnostic::{Code, Diagnostic};
use crate::elementary::Elementary;
use crate::ladder::library::{StandardBlock, Takes};
use crate::ladder::{self, BlockCall, Name};
use crate::source::Span;

/// The wires of a call, sorted by what they are for.
#[derive(Default)]
pub(super) struct Wired {
    pub(super) enable: Option<Wire>,
    pub(super) inputs: Vec<Input>,
    pub(super) references: Vec<(usize, Place)>,
    pub(super) outputs: Vec<(Output, Place)>,
    /// The pins that are wired, each with the first place.
    seen: Vec<(String, Span)>,
}

/// What a call calls.
struct Called {
    pins: Pins,
    /// None where the instance has a fault, which was reported.
    callee: Option<Callee>,
}

impl Checker<'_> {
    /// A call; `in_circuit` if there is power on its left. Calls nest in circuits at pins, so that what is not needed while the
    /// arguments are checked has functions of its own.
    pub(super) fn call(&mut self, call: &BlockCall, span: Span, in_circuit: bool, walk: &mut Walk) -> Option<Boxed> {
        if let Some(Boxable::Standard(function)) = self.boxed_function(call) {
            return self.standard_box(function, call, walk);
        }
        let Some(called) = self.called_block(call, span, walk) else {
            self.arguments_of_unknown(call, walk);
            return None;
        };
        let wired = self.arguments(&called.pins, call, walk);
        self.finish_call(call, span, in_circuit, called, wired)
    }

    /// What is called, as far as it can be made out.
    fn called_block(&mut self, call: &BlockCall, span: Span, walk: &mut Walk) -> Option<Box<Called>> {
        if let Some(Boxable::User(unit)) = self.boxed_function(call) {
            return Some(Box::new(Called { pins: self.pins_of_unit(unit), callee: Some(Callee::UserFunction(unit)) }));
        }
        let named = call.type_name.as_ref().and_then(|name| self.block_named(name));
        let instance = self.instance(call);
        let declared = instance.as_ref().and_then(|(place, ty)| self.instance_type(place, *ty, call, named));
        if let Some((place, _)) = &instance {
            self.note_call(place, span, walk);
        }
        let ty = declared.or(named)?;
        let pins = match ty {
            Type::Block(block) => Pins::of_block(block),
            Type::Unit(unit) => self.pins_of_unit(unit),
            _ => return None,
        };
        // Without a declaration, or with another one, the call was reported.
        let callee = instance.filter(|_| declared == Some(ty)).and_then(|(place, _)| match ty {
            Type::Unit(unit) => Some(Callee::Unit(unit, place)),
            Type::Block(block) => Some(Callee::Standard(block, place)),
            _ => None,
        });
        Some(Box::new(Called { pins, callee }))
    }

    fn arguments(&mut self, pins: &Pins, call: &BlockCall, walk: &mut Walk) -> Box<Wired> {
        let mut wired = Box::default();
        for (place, argument) in call.arguments.iter().enumerate() {
            self.argument(pins, (place, argument), &mut wired, walk);
        }
        wired
    }

    #[expect(clippy::boxed_local, reason = "calls nest, and what is boxed takes no room in each frame")]
    fn finish_call(
        &mut self,
        call: &BlockCall,
        span: Span,
        in_circuit: bool,
        called: Box<Called>,
        wired: Box<Wired>,
    ) -> Option<Boxed> {
        let Called { pins, callee } = *called;
        let Wired { enable, inputs, references, outputs, seen } = *wired;
        self.check_missing(&pins, &seen, call);
        let is_wired = |pin: &Pin| seen.iter().any(|(name, _)| *name == ladder::key(&pin.name));
        let is_bool = |pin: &&Pin| pin.ty == Type::Elementary(Elementary::Bool);
        let is_function = matches!(callee, Some(Callee::UserFunction(_)));
        let first = pins.inputs.iter().filter(|pin| pin.takes == Takes::Value).find(is_bool);
        let power_input = first.filter(|pin| in_circuit && !is_function && !is_wired(pin)).map(|pin| pin.place);
        let power_output = match &call.power_output {
            Some(name) => self.power_output(&pins, name)?,
            None if is_function => Output::Eno,
            None => pins.outputs.iter().find(is_bool).map_or(Output::Eno, |pin| Output::Pin(pin.place)),
        };
        let callee = callee?;
        if let Callee::Unit(unit, _) | Callee::UserFunction(unit) = callee {
            self.note_unit_call(unit, span);
        }
        if !is_function && self.in_function() {
            let message = format!("a function remembers nothing, and {} does", types::with_article(&pins.name));
            let problem = Diagnostic::new(Code::NoMemoryHere, span, message);
            self.report.push(problem.hint("declare a function block instead, which has instances"));
            return None;
        }
        if let Callee::Standard(block, _) = callee
            && !self.check_registers_of(block, call, &inputs, &references)
        {
            return None;
        }
        if let Callee::Standard(block, instance) = &callee {
            self.check_same_constants(*block, instance, &inputs, span);
        }
        let call = Call { callee, enable, power_input, inputs, references, outputs, power_output };
        Some(Boxed::Call(Box::new(call)))
    }

    /// The place that is called.
    fn instance(&mut self, call: &BlockCall) -> Option<(Place, Type)> {
        if let Some(name) = call.instance.as_name() {
            self.lookup(name, || {
                Some(match StandardBlock::from_name(&name.text) {
                    Some(block) => format!("write the instance before the type, as in `name:{}(…)`", block.name()),
                    None => format!("declare the instance by its use, as in `{}:TON(PT := T#1s)`", name.text),
                })
            })?;
        }
        let (place, ty) = self.place(&call.instance)?;
        self.check_chosen(&place, call.instance.span)?;
        Some((place, ty))
    }

    /// Whether it is known which instance is meant; else that is reported.
    fn check_chosen(&mut self, place: &Place, span: Span) -> Option<()> {
        if is_constant(place) {
            return Some(());
        }
        let message = "an instance cannot be chosen while the program runs";
        let problem = Diagnostic::new(Code::NotConstant, span, message);
        self.report.push(problem.hint("its index must be a constant; write a call for each"));
        None
    }

    /// The block type of that name.
    fn block_named(&mut self, name: &Name) -> Option<Type> {
        let (ty, _) = self.type_named(name)?;
        if matches!(ty, Type::Block(_) | Type::Unit(_)) {
            return Some(ty);
        }
        let message = format!("{} is a data type, not a block", self.type_name(ty));
        self.report.push(Diagnostic::new(Code::TypeMismatch, name.span, message));
        None
    }

    /// The block that an instance is of, which must be the one that the call names.
    fn instance_type(&mut self, place: &Place, ty: Type, call: &BlockCall, named: Option<Type>) -> Option<Type> {
        let is_block = matches!(ty, Type::Block(_) | Type::Unit(_));
        if is_block && named.is_none_or(|named| named == ty) {
            return Some(ty);
        }
        let instance = self.source_of(&call.instance);
        let article = types::with_article(&self.type_name(ty));
        let (message, span) = if is_block {
            let span = call.type_name.as_ref().map_or(call.instance.span, |name| name.span);
            (format!("`{instance}` is {article} elsewhere"), span)
        } else {
            (format!("`{instance}` is {article}, not a block instance"), call.instance.span)
        };
        let declared = self.scope.entry(place.variable).variable.span;
        self.report.push(Diagnostic::new(Code::TypeMismatch, span, message).related(declared, "declared here"));
        None
    }

    /// What is wrong in the arguments whatever the block.
    pub(super) fn arguments_of_unknown(&mut self, call: &BlockCall, walk: &mut Walk) {
        for argument in &call.arguments {
            match &argument.wire {
                ladder::Wire::Value(value) => drop(self.operand(value)),
                ladder::Wire::Circuit(circuit) => drop(self.pin_circuit(circuit, walk)),
                ladder::Wire::Output(target) => drop(self.written(target)),
            }
        }
    }

    /// Sorts in what is wired by one argument.
    fn argument(
        &mut self,
        pins: &Pins,
        (place, argument): (usize, &ladder::Argument),
        wired: &mut Wired,
        walk: &mut Walk,
    ) {
        let target = self.target(pins, (place, argument), &mut wired.seen);
        match (&argument.wire, target) {
            (ladder::Wire::Output(reference), target) => self.output_argument(target, reference, wired),
            (wire, Some(Target::Enable)) => wired.enable = self.wire(wire, Type::Elementary(Elementary::Bool), walk),
            (wire, Some(Target::Input(pin))) if pin.takes == Takes::Reference => {
                wired.references.extend(self.reference_pin(pin, wire, walk).map(|place| (pin.place, place)));
            }
            (wire, Some(Target::Input(pin))) => {
                let wire = self.wire(wire, pin.ty, walk).filter(|wire| self.check_constant(pin, wire, argument.span));
                wired.inputs.extend(wire.map(|wire| Input { pin: pin.place, wire }));
            }
            (ladder::Wire::Value(value), _) => drop(self.operand(value)),
            (ladder::Wire::Circuit(circuit), _) => drop(self.pin_circuit(circuit, walk)),
        }
    }

    fn output_argument(&mut self, target: Option<Target<'_>>, reference: &ladder::Reference, wired: &mut Wired) {
        match target {
            Some(Target::Output(pin)) => {
                wired.outputs.extend(self.output(pin, reference).map(|place| (Output::Pin(pin.place), place)));
            }
            Some(Target::Enabled) => {
                let ty = Type::Elementary(Elementary::Bool);
                let eno = Pin { name: "ENO".to_owned(), ty, range: None, takes: Takes::Value, place: 0 };
                wired.outputs.extend(self.output(&eno, reference).map(|place| (Output::Eno, place)));
            }
            _ => drop(self.written(reference)),
        }
    }

    /// What is wired to an input of a type.
    fn wire(&mut self, wire: &ladder::Wire, ty: Type, walk: &mut Walk) -> Option<Wire> {
        match (wire, ty) {
            (ladder::Wire::Value(value), Type::Elementary(ty)) => self.value(value, ty).map(Wire::Value),
            (ladder::Wire::Value(value), _) => {
                self.by_reference_only(ty, value.span);
                None
            }
            (ladder::Wire::Circuit(circuit), _) => {
                let checked = self.pin_circuit(circuit, walk);
                self.takes_circuit(ty, circuit.span).then_some(Wire::Circuit(checked))
            }
            (ladder::Wire::Output(_), _) => None,
        }
    }

    /// Whether a pin takes a circuit.
    fn takes_circuit(&mut self, ty: Type, span: Span) -> bool {
        let takes = ty == Type::Elementary(Elementary::Bool);
        if !takes {
            let article = types::with_article(&self.type_name(ty));
            let message = format!("a circuit gives a BOOL, and the pin takes {article}");
            let problem = Diagnostic::new(Code::TypeMismatch, span, message);
            self.report.push(problem.hint("wire an expression, without brackets"));
        }
        takes
    }

    /// Whether a pin takes what is wired to it as far as it is a constant, or has to be one.
    fn check_constant(&mut self, pin: &Pin, wire: &Wire, span: Span) -> bool {
        let constant = match wire {
            Wire::Value(value) => value.constant(),
            Wire::Circuit(_) => None,
        };
        let Some(value) = constant.and_then(|value| value.as_integer()) else {
            if pin.takes == Takes::Constant {
                let message = format!("`{}` takes a constant", pin.name);
                self.report.push(Diagnostic::new(Code::NotConstant, span, message));
            }
            return pin.takes != Takes::Constant;
        };
        let Some((least, greatest)) = pin.range else { return true };
        let fits = (i128::from(least)..=i128::from(greatest)).contains(&value);
        if !fits {
            let message = format!("`{}` takes {least} to {greatest}, and this is {value}", pin.name);
            self.report.push(Diagnostic::new(Code::OutOfRange, span, message));
        }
        fits
    }

    /// The variable that a reference stands for.
    fn reference_pin(&mut self, pin: &Pin, wire: &ladder::Wire, walk: &mut Walk) -> Option<Place> {
        match wire {
            ladder::Wire::Value(value) => self.by_reference(&pin.name, pin.ty, value),
            ladder::Wire::Circuit(circuit) => {
                self.pin_circuit(circuit, walk);
                self.no_variable(&pin.name, circuit.span);
                None
            }
            ladder::Wire::Output(_) => None,
        }
    }

    /// The variable that something of a type by this name stands for.
    pub(super) fn by_reference(&mut self, name: &str, wanted: Type, value: &ladder::Expression) -> Option<Place> {
        let ladder::ExpressionKind::Read(reference) = &value.kind else {
            self.operand(value);
            self.no_variable(name, value.span);
            return None;
        };
        let (place, ty) = self.written(reference)?;
        if ty != wanted || place.bit.is_some() {
            let [wants, found] = [wanted, ty].map(|ty| types::with_article(&self.type_name(ty)));
            let found = if place.bit.is_some() { "a single bit".to_owned() } else { found };
            let message = format!("`{name}` takes {wants}, and this is {found}");
            self.report.push(Diagnostic::new(Code::TypeMismatch, value.span, message));
            return None;
        }
        if self.types.holds_instance(ty) {
            self.check_chosen(&place, value.span)?;
        }
        Some(place)
    }

    fn no_variable(&mut self, name: &str, span: Span) {
        let message = format!("`{name}` takes a variable, not a value");
        self.report.push(Diagnostic::new(Code::TypeMismatch, span, message));
    }

    /// Reports a whole array, structure or instance at a pin that takes values.
    pub(super) fn by_reference_only(&mut self, ty: Type, span: Span) {
        let message = format!("{} is handed over by reference only", types::with_article(&self.type_name(ty)));
        self.report.push(Diagnostic::new(Code::TypeMismatch, span, message).hint("declare the pin as `inout`"));
    }

    pub(super) fn pin_circuit(&mut self, circuit: &ladder::Circuit, walk: &mut Walk) -> Circuit {
        let around = std::mem::replace(&mut walk.in_pin, true);
        let loops = std::mem::take(&mut self.loops);
        let (checked, _) = self.circuit(circuit, Power::Maybe, walk);
        walk.in_pin = around;
        self.loops = loops;
        checked
    }

    /// Where an output goes.
    fn output(&mut self, pin: &Pin, target: &ladder::Reference) -> Option<Place> {
        let (place, ty) = self.write(target)?;
        if Type::Elementary(ty) != pin.ty {
            self.wrong_target(&pin.name, pin.ty, Type::Elementary(ty), target.span);
            return None;
        }
        Some(place)
    }

    /// Reports an output that goes to a variable of another type.
    pub(super) fn wrong_target(&mut self, output: &str, gives: Type, takes: Type, span: Span) {
        let [given, taken] = [gives, takes].map(|ty| types::with_article(&self.type_name(ty)));
        let problem =
            Diagnostic::new(Code::TypeMismatch, span, format!("`{output}` gives {given}, and this is {taken}"));
        self.report.push(
            problem.hint(format!(
                "an output goes to a variable of its own type; declare one of {}",
                self.type_name(gives)
            )),
        );
    }

    /// A reference in words, for messages.
    fn source_of(&self, reference: &ladder::Reference) -> String {
        match (reference.as_name(), &reference.root) {
            (Some(name), _) => name.text.to_string(),
            (None, ladder::Root::Name(name)) => format!("{}…", name.text),
            (None, ladder::Root::Address(address)) => address.to_string(),
        }
    }
}
