//! Initial values: constants for what is elementary, and lists for what has parts. It must never make more values than the type
//! has elements, whatever a repetition says.

use thin_vec::ThinVec;

use super::model::{Initial, PinId, Step, Type, VariableId};
use super::type_table::single_values;
use super::{Checker, types};
use crate::diagnostic::{Code, Diagnostic};
use crate::elementary::{Elementary, Value};
use crate::ladder::{self, ArrayItem, Expression, ExpressionKind, MemberValue, VariableClass};
use crate::source::Span;

impl Checker<'_> {
    /// What a declaration starts with, which names a type or else is a BOOL.
    pub(super) fn declared_initial(
        &mut self,
        declared: &ladder::Variable,
        initial: &Expression,
        ty: Type,
    ) -> Option<Initial> {
        if declared.ty.is_some() {
            return self.initial(initial, ty);
        }
        let operand = self.operand(initial)?;
        let name = &declared.name.text;
        if let Some(other) = operand.other_than_bool() {
            let message = format!("without a type `{name}` is a BOOL, and this is not");
            let problem = Diagnostic::new(Code::TypeMismatch, initial.span, message);
            self.report.push(problem.hint(format!("write its type, as in `{name} : {other}`")));
            return None;
        }
        let value = self.coerce(operand, Elementary::Bool, initial.span)?.constant();
        self.constant_initial(value, initial.span)
    }

    /// What something of a type starts with. `None`: that was reported.
    pub(super) fn initial(&mut self, initial: &Expression, ty: Type) -> Option<Initial> {
        match (&initial.kind, ty) {
            (_, Type::Elementary(ty)) => {
                let value = self.value(initial, ty)?.constant();
                self.constant_initial(value, initial.span)
            }
            (ExpressionKind::Array(items), Type::Array(array)) => {
                let array = &self.types.arrays[array.index()];
                let (count, element) = (array.count() as usize, array.element);
                self.note_initial(count as u64, initial.span)?;
                let mut elements = ThinVec::new();
                self.elements(items, element, count, &mut elements, initial.span)?;
                elements.resize(count, Initial::Default);
                Some(Initial::Elements(elements))
            }
            (ExpressionKind::Structure(members), Type::Structure(_) | Type::Block(_) | Type::Unit(_)) => {
                self.members(members, ty).map(Initial::Members)
            }
            _ => {
                let example = match ty {
                    Type::Array(_) => "[1, 2, 8(0)]",
                    _ => "(x := 1, y := 2)",
                };
                let message = format!("this is no initial value for {}", types::with_article(&self.type_name(ty)));
                let problem = Diagnostic::new(Code::TypeMismatch, initial.span, message);
                self.report.push(problem.hint(format!("write it as `{example}`")));
                None
            }
        }
    }

    fn constant_initial(&mut self, value: Option<Value>, span: Span) -> Option<Initial> {
        if value.is_none() {
            let problem = Diagnostic::new(Code::NotConstant, span, "an initial value must be a constant");
            self.report.push(problem.hint("write a literal, or name what `const` declares"));
        }
        value.map(Initial::Value)
    }

    /// The elements that a list is for, at most `count`. A list within a list is for as many as it has.
    fn elements(
        &mut self,
        items: &[ArrayItem],
        element: Type,
        count: usize,
        elements: &mut ThinVec<Initial>,
        span: Span,
    ) -> Option<()> {
        for item in items {
            let repeat = match &item.repeat {
                None => 1,
                Some(repeat) => {
                    let times = self.bound(repeat)?;
                    if times < 0 {
                        let message = "a value cannot stand for fewer than no elements";
                        self.report.push(Diagnostic::new(Code::OutOfRange, repeat.span, message));
                        return None;
                    }
                    usize::try_from(times).unwrap_or(usize::MAX)
                }
            };
            let start = elements.len();
            match &item.value {
                None => elements.push(Initial::Default),
                Some(Expression { kind: ExpressionKind::Array(inner), span }) if !matches!(element, Type::Array(_)) => {
                    self.elements(inner, element, count, elements, *span)?;
                }
                Some(value) => elements.push(self.initial(value, element)?),
            }
            let one: Vec<Initial> = elements.drain(start..).collect();
            if one.len().checked_mul(repeat).is_none_or(|more| more > count.saturating_sub(elements.len())) {
                let message = format!("there are more values here than the {count} elements of the array");
                self.report.push(Diagnostic::new(Code::OutOfRange, span, message));
                return None;
            }
            let values = one.iter().map(single_values).fold(0, u64::saturating_add);
            if repeat > 1 && values > one.len() as u64 {
                self.note_initial(values.saturating_mul(repeat as u64), span)?;
            }
            for _ in 0..repeat {
                elements.extend_from_slice(&one);
            }
        }
        Some(())
    }

    fn members(&mut self, members: &[MemberValue], ty: Type) -> Option<ThinVec<(Step, Initial)>> {
        let mut found: ThinVec<(Step, Initial)> = ThinVec::with_capacity(members.len());
        let mut whole = true;
        for member in members {
            let Some((step, ty)) = self.initial_member(ty, &member.member.text) else {
                let message = format!("{} has no `{}`", types::with_article(&self.type_name(ty)), member.member.text);
                self.report.push(Diagnostic::new(Code::UnknownMember, member.member.span, message));
                whole = false;
                continue;
            };
            if let Step::Variable(variable) = step
                && !self.may_start_otherwise(variable)
            {
                let message = format!("`{}` is not remembered by an instance", member.member.text);
                let problem = Diagnostic::new(Code::NotWritable, member.member.span, message);
                self.report.push(problem.hint("only what an instance keeps can start with a value of its own"));
                whole = false;
            }
            if found.iter().any(|(other, _)| *other == step) {
                let message = format!("`{}` is given twice", member.member.text);
                self.report.push(Diagnostic::new(Code::DuplicateClause, member.member.span, message));
                whole = false;
            }
            match self.initial(&member.value, ty) {
                Some(initial) => found.push((step, initial)),
                None => whole = false,
            }
        }
        whole.then_some(found)
    }

    /// Whether a variable of a function block may start with another value in one instance than its declaration says.
    fn may_start_otherwise(&self, variable: VariableId) -> bool {
        let class = self.scope.entry(variable).variable.class;
        matches!(class, VariableClass::Input | VariableClass::Output | VariableClass::Memory)
    }

    /// The member of that name that an initial value can be for.
    fn initial_member(&self, ty: Type, name: &str) -> Option<(Step, Type)> {
        match ty {
            Type::Structure(structure) => {
                let place = self.types.field(structure, name)?;
                Some((Step::Field(place), self.types.structures[structure.index()].fields[place].ty))
            }
            Type::Block(block) => {
                let (pin, pins) = match block.output(name) {
                    Some(pin) => (PinId::Output(pin), block.outputs()[pin]),
                    None => block.input(name).map(|pin| (PinId::Input(pin), block.inputs()[pin]))?,
                };
                Some((Step::Pin(pin), Type::Elementary(pins.ty)))
            }
            Type::Unit(unit) => {
                let variable = self.scope.find_in(unit, name)?;
                Some((Step::Variable(variable), self.scope.entry(variable).variable.ty))
            }
            Type::Elementary(_) | Type::Array(_) => None,
        }
    }
}
