//! References: from a name or an address and what follows it to a place that is read or written.

use super::address::Extent;
use super::expression::constant as constant_expression;
use super::model::{Expression, ExpressionKind, PinId, Place, Type, VariableId};
use super::report::clipped;
use super::scope::State;
use super::{Checker, types};
use crate::diagnostic::{Code, Diagnostic};
use crate::elementary::{Elementary, Value};
use crate::ladder::library::{Pin, StandardBlock};
use crate::ladder::{Name, Origin, Reference, Root, Step, VariableClass};
use crate::source::Span;

/// Pin names as a list for people.
pub(super) fn list(pins: &[Pin]) -> String {
    pins.iter().map(|pin| format!("`{}`", pin.name)).collect::<Vec<_>>().join(", ")
}

impl Checker<'_> {
    /// The variable of a name. `None`: there is none or it is broken, and either was reported. `otherwise` says what
    /// to do if the name is not misspelt.
    pub(super) fn lookup(&mut self, name: &Name, otherwise: impl FnOnce() -> Option<String>) -> Option<VariableId> {
        let Some(id) = self.scope.find(name) else {
            if self.scope.first_unknown(name) {
                let problem =
                    Diagnostic::new(Code::UndeclaredName, name.span, format!("`{}` is not declared", name.text));
                let suggestion = self.scope.suggest(&name.text).map(|near| format!("did you mean `{near}`?"));
                let hint = match (suggestion, otherwise()) {
                    (Some(suggestion), Some(otherwise)) => Some(format!("{suggestion} Otherwise {otherwise}")),
                    (suggestion, otherwise) => suggestion.or(otherwise),
                };
                self.report.push(Diagnostic { hint, ..problem });
            }
            return None;
        };
        let entry = self.scope.entry_mut(id);
        entry.mentioned = true;
        (entry.state != State::Broken).then_some(id)
    }

    /// What a reference reads.
    pub(super) fn read(&mut self, reference: &Reference) -> Option<Expression> {
        let (place, ty) = self.place(reference)?;
        let entry = self.scope.entry(place.variable);
        if entry.variable.class != VariableClass::Constant {
            return Some(Expression { ty, kind: ExpressionKind::Read(place) });
        }
        if entry.state == State::Pending {
            let message = format!("the value of `{}` is not known yet", entry.variable.name);
            let problem = Diagnostic::new(Code::NotConstant, reference.span, message)
                .related(entry.variable.span, "declared here")
                .hint("a constant can use only those that are declared before it");
            self.report.push(problem);
            return None;
        }
        let value = entry.variable.initial;
        Some(constant_expression(match place.bit {
            Some(bit) => Value::bool(value.bits() >> bit & 1 == 1),
            None => value,
        }))
    }

    /// Where a coil, an assignment or an output writes, and the type of what it writes.
    pub(super) fn write(&mut self, reference: &Reference) -> Option<(Place, Elementary)> {
        let (place, ty) = self.place(reference)?;
        let variable = &self.scope.entry(place.variable).variable;
        let (name, declared, span) = (clipped(&variable.name), variable.span, reference.span);
        let problem = match (variable.class, place.pin) {
            (VariableClass::Constant, _) => Diagnostic::new(Code::NotWritable, span, format!("`{name}` is a constant"))
                .related(declared, "declared here"),
            (VariableClass::Input, _) => {
                let problem = match self.program.origin {
                    Origin::Native => Diagnostic::new(Code::CoilOnInput, span, format!("`{name}` is an input"))
                        .hint("an input only follows the field; write a variable of its own"),
                    Origin::Imported => Diagnostic::new(
                        Code::OverwrittenInput,
                        span,
                        format!("`{name}` is an input, and the next copy-in overwrites what is written here"),
                    ),
                };
                problem.related(declared, "declared here")
            }
            (_, Some(PinId::Output(_))) => {
                Diagnostic::new(Code::NotWritable, span, format!("only `{name}` itself writes its outputs"))
            }
            _ => return Some((place, ty)),
        };
        let stands = !problem.is_error();
        self.report.push(problem);
        stands.then_some((place, ty))
    }

    fn place(&mut self, reference: &Reference) -> Option<(Place, Elementary)> {
        let variable = match &reference.root {
            Root::Name(name) => self.lookup(name, || None)?,
            // Without an extent it was reported when the addresses were collected.
            Root::Address(address) => {
                let id = *self.scope.addresses.get(&Extent::of(address)?)?;
                let entry = self.scope.entry_mut(id);
                entry.mentioned = true;
                (entry.state != State::Broken).then_some(id)?
            }
        };
        let mut place = Place { variable, pin: None, bit: None };
        let mut steps = reference.steps.iter();
        let mut ty = match self.scope.entry(variable).variable.ty {
            Type::Elementary(ty) => ty,
            Type::Block(block) => {
                let (pin, ty) = self.member(variable, block, steps.next(), reference.span)?;
                place.pin = Some(pin);
                ty
            }
        };
        for step in steps {
            match step {
                Step::Bit(bit, span) => {
                    self.check_bit(ty, *bit, *span)?;
                    (place.bit, ty) = (Some(*bit), Elementary::Bool);
                }
                Step::Member(name) => {
                    let message =
                        format!("{} has no members, and so no `{}`", types::with_article(ty.name()), name.text);
                    self.report.push(Diagnostic::new(Code::UnknownMember, name.span, message));
                    return None;
                }
            }
        }
        Some((place, ty))
    }

    /// The pin that the step behind a block instance names.
    fn member(
        &mut self,
        instance: VariableId,
        block: StandardBlock,
        step: Option<&Step>,
        span: Span,
    ) -> Option<(PinId, Elementary)> {
        let name = &self.scope.entry(instance).variable.name;
        let (inputs, outputs) = (block.inputs(), block.outputs());
        let problem = match step {
            Some(Step::Member(member)) => {
                if let Some(pin) = block.output(&member.text) {
                    return Some((PinId::Output(pin), outputs[pin].ty));
                } else if let Some(pin) = block.input(&member.text) {
                    return Some((PinId::Input(pin), inputs[pin].ty));
                }
                let message = format!("`{name}` is {} and has no `{}`", types::with_article(block.name()), member.text);
                Diagnostic::new(Code::UnknownMember, member.span, message).hint(format!(
                    "its outputs are {}, its inputs {}",
                    list(outputs),
                    list(inputs)
                ))
            }
            Some(Step::Bit(_, span)) => {
                Diagnostic::new(Code::UnknownMember, *span, format!("`{name}` is a block instance and has no bits"))
            }
            None => {
                let message = format!("`{name}` is a block instance, not a value");
                let first = outputs.first().map_or("", |pin| pin.name);
                Diagnostic::new(Code::TypeMismatch, span, message)
                    .hint(format!("name one of its pins, as `{name}.{first}`"))
            }
        };
        self.report.push(problem);
        None
    }

    fn check_bit(&mut self, ty: Elementary, bit: u8, span: Span) -> Option<()> {
        let problem = if ty == Elementary::Bool || !ty.is_bit_string() {
            let message =
                format!("only BYTE, WORD, DWORD and LWORD have bits, and this is {}", types::with_article(ty.name()));
            Diagnostic::new(Code::TypeMismatch, span, message)
        } else if u32::from(bit) >= ty.bits() {
            Diagnostic::new(Code::OutOfRange, span, format!("{} has no bit {bit}", types::with_article(ty.name())))
                .hint(format!("its bits are 0 to {}", ty.bits() - 1))
        } else {
            return Some(());
        };
        self.report.push(problem);
        None
    }
}
