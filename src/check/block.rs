//! Calls of blocks: the instance, its type, and what is wired to its pins.

use super::model::{Call, Circuit, Input, PinId, Place, Type, VariableId, Wire};
use super::network::{Power, Walk};
use super::place::list;
use super::{Checker, types};
use crate::diagnostic::{Code, Diagnostic};
use crate::elementary::Elementary;
use crate::ladder::library::StandardBlock;
use crate::ladder::{self, BlockCall, Name};
use crate::source::Span;

impl Checker<'_> {
    pub(super) fn call(&mut self, call: &BlockCall, span: Span, walk: &mut Walk) -> Option<Call> {
        let named = call.type_name.as_ref().map(|name| self.block_named(name));
        let instance = self.lookup(&call.instance, || {
            Some(format!("declare the instance by its use, as in `{}:TON(PT := T#1s)`", call.instance.text))
        });
        let declared = instance.and_then(|id| self.instance_type(id, call, named.flatten()));
        if let Some(id) = instance {
            self.note_call(id, span, walk);
        }
        let Some(block) = declared.or(named.flatten()) else {
            self.arguments_of_unknown(call, walk);
            return None;
        };
        let mut inputs = Vec::new();
        let mut outputs = Vec::new();
        let mut wired: Vec<(PinId, Span)> = Vec::new();
        for argument in &call.arguments {
            let pin = self.pin(block, argument, &mut wired);
            match &argument.wire {
                ladder::Wire::Output(target) => outputs.extend(self.output(block, pin, target)),
                wire => inputs.extend(self.input(block, pin, wire, walk)),
            }
        }
        let first = block.inputs().iter().position(|pin| pin.ty == Elementary::Bool);
        let power_input = first.filter(|pin| !wired.iter().any(|(wired, _)| *wired == PinId::Input(*pin)));
        let power_output = match &call.power_output {
            Some(name) => Some(self.power_output(block, name)?),
            None => block.outputs().iter().position(|pin| pin.ty == Elementary::Bool),
        };
        // Without a declaration, or with another one, the call was reported.
        Some(Call {
            instance: instance.filter(|_| declared == Some(block))?,
            block,
            power_input,
            inputs,
            outputs,
            power_output,
        })
    }

    /// The block type of that name.
    fn block_named(&mut self, name: &Name) -> Option<StandardBlock> {
        match self.type_named(name)? {
            Type::Block(block) => Some(block),
            Type::Elementary(ty) => {
                let message = format!("{ty} is a data type, not a block");
                self.report.push(Diagnostic::new(Code::TypeMismatch, name.span, message));
                None
            }
        }
    }

    /// The block that an instance is of, which must be the one that the call names.
    fn instance_type(
        &mut self,
        id: VariableId,
        call: &BlockCall,
        named: Option<StandardBlock>,
    ) -> Option<StandardBlock> {
        let variable = &self.scope.entry(id).variable;
        let (message, span) = match (variable.ty, named) {
            (Type::Block(block), named) if named.is_none_or(|named| named == block) => return Some(block),
            (Type::Block(block), _) => {
                let span = call.type_name.as_ref().map_or(call.instance.span, |name| name.span);
                let article = types::with_article(block.name());
                (format!("`{}` is {article} elsewhere", call.instance.text), span)
            }
            (Type::Elementary(ty), _) => {
                let article = types::with_article(ty.name());
                (format!("`{}` is {article}, not a block instance", call.instance.text), call.instance.span)
            }
        };
        let problem = Diagnostic::new(Code::TypeMismatch, span, message).related(variable.span, "declared here");
        self.report.push(problem);
        None
    }

    /// What is wrong in the arguments whatever the block.
    fn arguments_of_unknown(&mut self, call: &BlockCall, walk: &mut Walk) {
        for argument in &call.arguments {
            match &argument.wire {
                ladder::Wire::Value(value) => drop(self.operand(value)),
                ladder::Wire::Circuit(circuit) => drop(self.pin_circuit(circuit, walk)),
                ladder::Wire::Output(target) => drop(self.write(target)),
            }
        }
    }

    /// The pin that an argument is wired to.
    fn pin(
        &mut self,
        block: StandardBlock,
        argument: &ladder::Argument,
        wired: &mut Vec<(PinId, Span)>,
    ) -> Option<PinId> {
        let name = &argument.pin.text;
        let (input, output) = (block.input(name).map(PinId::Input), block.output(name).map(PinId::Output));
        let is_output = matches!(argument.wire, ladder::Wire::Output(_));
        let (pin, other) = if is_output { (output, input) } else { (input, output) };
        let Some(pin) = pin else {
            let (what, pins) = if is_output { ("output", block.outputs()) } else { ("input", block.inputs()) };
            let message = format!("{} has no {what} `{name}`", block.name());
            let hint = match other {
                Some(_) if is_output => format!("`{name}` is an input: write `{name} := value`"),
                Some(_) => format!("`{name}` is an output: write `{name} => variable`"),
                None => format!("its {what}s are {}", list(pins)),
            };
            self.report.push(Diagnostic::new(Code::UnknownPin, argument.pin.span, message).hint(hint));
            return None;
        };
        if let Some((_, first)) = wired.iter().find(|(wired, _)| *wired == pin) {
            let problem = Diagnostic::new(Code::DuplicatePin, argument.pin.span, format!("`{name}` is wired twice"));
            self.report.push(problem.related(*first, "wired first here"));
        } else {
            wired.push((pin, argument.span));
        }
        Some(pin)
    }

    fn input(
        &mut self,
        block: StandardBlock,
        pin: Option<PinId>,
        wire: &ladder::Wire,
        walk: &mut Walk,
    ) -> Option<Input> {
        let pin = match pin {
            Some(PinId::Input(pin)) => Some((pin, block.inputs()[pin].ty)),
            _ => None,
        };
        let wire = match (wire, pin) {
            (ladder::Wire::Value(value), Some((_, ty))) => Wire::Value(self.value(value, ty)?),
            (ladder::Wire::Value(value), None) => return self.operand(value).and(None),
            (ladder::Wire::Circuit(circuit), _) => {
                let checked = self.pin_circuit(circuit, walk);
                let (_, ty) = pin?;
                if ty != Elementary::Bool {
                    let message =
                        format!("a circuit gives a BOOL, and the pin takes {}", types::with_article(ty.name()));
                    let problem = Diagnostic::new(Code::TypeMismatch, circuit.span, message);
                    self.report.push(problem.hint("wire an expression, without brackets"));
                    return None;
                }
                Wire::Circuit(checked)
            }
            (ladder::Wire::Output(_), _) => return None,
        };
        pin.map(|(pin, _)| Input { pin, wire })
    }

    fn pin_circuit(&mut self, circuit: &ladder::Circuit, walk: &mut Walk) -> Circuit {
        let around = std::mem::replace(&mut walk.in_pin, true);
        let (checked, _) = self.circuit(circuit, Power::Maybe, walk);
        walk.in_pin = around;
        checked
    }

    fn output(
        &mut self,
        block: StandardBlock,
        pin: Option<PinId>,
        target: &ladder::Reference,
    ) -> Option<(usize, Place)> {
        let (place, ty) = self.write(target)?;
        let Some(PinId::Output(pin)) = pin else { return None };
        let output = block.outputs()[pin];
        if ty != output.ty {
            let [gives, takes] = [output.ty, ty].map(|ty| types::with_article(ty.name()));
            let message = format!("`{}` gives {gives}, and this is {takes}", output.name);
            let problem = Diagnostic::new(Code::TypeMismatch, target.span, message);
            self.report.push(
                problem.hint(format!("an output goes to a variable of its own type; declare one of {}", output.ty)),
            );
            return None;
        }
        Some((pin, place))
    }

    fn power_output(&mut self, block: StandardBlock, name: &Name) -> Option<usize> {
        let bools = || block.outputs().iter().filter(|pin| pin.ty == Elementary::Bool).copied().collect::<Vec<_>>();
        let problem = match block.output(&name.text) {
            Some(pin) if block.outputs()[pin].ty == Elementary::Bool => return Some(pin),
            Some(pin) => {
                let article = types::with_article(block.outputs()[pin].ty.name());
                Diagnostic::new(Code::PowerNotTaken, name.span, format!("`{}` is {article}, not power", name.text))
                    .hint(format!("power on the right comes from one of {}", list(&bools())))
            }
            None => {
                Diagnostic::new(Code::UnknownPin, name.span, format!("{} has no output `{}`", block.name(), name.text))
                    .hint(format!("power on the right comes from one of {}", list(&bools())))
            }
        };
        self.report.push(problem);
        None
    }
}
