//! References: from a name or an address and what follows it to a place that is read or written.

use super::address::Extent;
use super::expression::constant as constant_expression;
use super::model::{self, Dimension, Expression, ExpressionKind, Index, PinId, Place, Type, VariableId};
use super::report::clipped;
use super::scope::State;
use super::{Checker, types};
use crate::diagnostic::{Code, Diagnostic};
use crate::elementary::{Elementary, Value};
use crate::ladder::library::{Pin, Takes};
use crate::ladder::{self, Name, Origin, Reference, Root, Step, VariableClass};
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
        if let Some(name) = reference.as_name()
            && self.scope.find(name).is_none()
            && let Some(value) = self.types.value(&name.text)
        {
            if value.is_err() {
                let message = format!("several enumerations have a value `{}`", name.text);
                let problem = Diagnostic::new(Code::TypeMismatch, name.span, message);
                self.report.push(problem.hint(format!("write the type before it, as in `colour#{}`", name.text)));
            }
            return value.ok().map(constant_expression);
        }
        let (place, ty) = self.place(reference)?;
        let ty = self.elementary(ty, reference.span)?;
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
        match (&entry.variable.initial, entry.variable.ty) {
            (initial, Type::Elementary(whole)) => {
                let value = initial.value(whole);
                Some(constant_expression(match place.bit {
                    Some(bit) => Value::bool(value.bits() >> bit & 1 == 1),
                    None => value,
                }))
            }
            _ => Some(Expression { ty, kind: ExpressionKind::Read(place) }),
        }
    }

    /// Where a coil, an assignment or an output writes, and the type of what it writes.
    pub(super) fn write(&mut self, reference: &Reference) -> Option<(Place, Elementary)> {
        let (place, ty) = self.written(reference)?;
        let ty = self.elementary(ty, reference.span)?;
        Some((place, ty))
    }

    /// The same of any type.
    pub(super) fn written(&mut self, reference: &Reference) -> Option<(Place, Type)> {
        let (place, ty) = self.place(reference)?;
        let variable = &self.scope.entry(place.variable).variable;
        let (name, declared, span) = (clipped(&variable.name), variable.span, reference.span);
        let output_of = place.path.iter().any(|step| match step {
            model::Step::Pin(PinId::Output(_)) => true,
            model::Step::Variable(variable) => self.scope.entry(*variable).variable.class == VariableClass::Output,
            _ => false,
        });
        let of_field = variable.address.is_some() || self.is_program();
        let problem = match (variable.class, output_of) {
            (VariableClass::Constant, _) => Diagnostic::new(Code::NotWritable, span, format!("`{name}` is a constant"))
                .related(declared, "declared here"),
            (VariableClass::Input, _) => {
                let problem = match (self.program.origin, of_field) {
                    (Origin::Native, true) => Diagnostic::new(Code::CoilOnInput, span, format!("`{name}` is an input"))
                        .hint("an input only follows the field; write a variable of its own"),
                    (Origin::Native, false) => {
                        Diagnostic::new(Code::NotWritable, span, format!("`{name}` is an input"))
                            .hint("the caller writes it; write a variable of its own")
                    }
                    (Origin::Imported, true) => Diagnostic::new(
                        Code::OverwrittenInput,
                        span,
                        format!("`{name}` is an input, and the next copy-in overwrites what is written here"),
                    ),
                    (Origin::Imported, false) => return Some((place, ty)),
                };
                problem.related(declared, "declared here")
            }
            (_, true) => Diagnostic::new(Code::NotWritable, span, format!("only `{name}` itself writes its outputs")),
            _ => return Some((place, ty)),
        };
        let stands = !problem.is_error();
        self.report.push(problem);
        stands.then_some((place, ty))
    }

    /// A type that must be elementary.
    fn elementary(&mut self, ty: Type, span: Span) -> Option<Elementary> {
        let message = match ty {
            Type::Elementary(ty) => return Some(ty),
            Type::Block(_) | Type::Unit(_) => "this is a block instance, not a value".to_owned(),
            Type::Array(_) | Type::Structure(_) => {
                format!("this is {}, not a single value", types::with_article(&self.type_name(ty)))
            }
        };
        let problem = Diagnostic::new(Code::TypeMismatch, span, message);
        self.report.push(match ty {
            Type::Block(block) => {
                let first = block.outputs().first().map_or("", |pin| pin.name);
                problem.hint(format!("name one of its pins, as in `instance.{first}`"))
            }
            Type::Array(_) => problem.hint("name one of its elements, as in `a[1]`"),
            _ => problem.hint("name one of its members, as in `a.b`"),
        });
        None
    }

    /// The storage that a reference names.
    pub(super) fn place(&mut self, reference: &Reference) -> Option<(Place, Type)> {
        let variable = match &reference.root {
            Root::Name(name) => self.lookup(name, || None)?,
            // Without an extent it was reported when the addresses were collected.
            Root::Address(address) => {
                let Some(id) = self.scope.addresses.get(&Extent::of(address)?).copied() else {
                    // Only what rungs use is declared by use.
                    let message = "what stands at an address is not known before the program runs";
                    self.report.push(Diagnostic::new(Code::NotConstant, address.span, message));
                    return None;
                };
                let entry = self.scope.entry_mut(id);
                entry.mentioned = true;
                (entry.state != State::Broken).then_some(id)?
            }
        };
        let mut place = Place::of(variable);
        let mut ty = self.scope.entry(variable).variable.ty;
        let mut steps = reference.steps.iter().peekable();
        while let Some(step) = steps.next() {
            match (step, ty) {
                (Step::Bit(bit, span), Type::Elementary(of)) if place.bit.is_none() => {
                    self.check_bit(of, *bit, *span)?;
                    (place.bit, ty) = (Some(*bit), Type::Elementary(Elementary::Bool));
                }
                (Step::Index(indices, span), Type::Array(array)) => {
                    let dimensions = self.types.arrays[array.index()].dimensions.clone();
                    let mut all: Vec<&ladder::Expression> = indices.iter().collect();
                    // `a[1][2]` is `a[1, 2]` where both are dimensions of one array.
                    while all.len() < dimensions.len()
                        && let Some(Step::Index(more, _)) = steps.next_if(|step| matches!(step, Step::Index(..)))
                    {
                        all.extend(more);
                    }
                    place.path.push(model::Step::Element(self.indices(&all, &dimensions, *span)?));
                    ty = self.types.arrays[array.index()].element;
                }
                (Step::Member(name), ty_of) => {
                    let (step, member) = self.member(ty_of, name)?;
                    place.path.push(step);
                    ty = member;
                }
                (Step::Bit(_, span) | Step::Index(_, span), _) => {
                    let what = if matches!(step, Step::Bit(..)) { "bits" } else { "elements" };
                    let message = format!("{} has no {what}", types::with_article(&self.type_name(ty)));
                    self.report.push(Diagnostic::new(Code::UnknownMember, *span, message));
                    return None;
                }
            }
        }
        Some((place, ty))
    }

    /// Indices, one for each dimension.
    fn indices(&mut self, indices: &[&ladder::Expression], dimensions: &[Dimension], span: Span) -> Option<Vec<Index>> {
        if indices.len() != dimensions.len() {
            let message =
                format!("the array has {} dimensions, and here are {} indices", dimensions.len(), indices.len());
            self.report.push(Diagnostic::new(Code::WrongArguments, span, message));
            return None;
        }
        let mut found = Vec::with_capacity(indices.len());
        for (index, dimension) in indices.iter().zip(dimensions) {
            found.push(self.index(index, *dimension));
        }
        found.into_iter().collect()
    }

    fn index(&mut self, index: &ladder::Expression, dimension: Dimension) -> Option<Index> {
        let checked = self.value(index, Elementary::Lint)?;
        let Some(value) = checked.constant() else { return Some(Index::Computed(Box::new(checked))) };
        let value = value.as_integer()?;
        let place = u32::try_from(value - i128::from(dimension.first)).ok().filter(|place| *place < dimension.count);
        if place.is_none() {
            let last = i128::from(dimension.first) + i128::from(dimension.count) - 1;
            let problem = Diagnostic::new(Code::OutOfRange, index.span, format!("the array has no element {value}"));
            self.report.push(problem.hint(format!("its elements are {} to {last}", dimension.first)));
        }
        place.map(Index::Constant)
    }

    /// The member of that name.
    fn member(&mut self, ty: Type, name: &Name) -> Option<(model::Step, Type)> {
        let (message, hint) = match ty {
            Type::Block(block) => {
                let (inputs, outputs) = (block.inputs(), block.outputs());
                if let Some(pin) = block.output(&name.text) {
                    return Some((model::Step::Pin(PinId::Output(pin)), Type::Elementary(outputs[pin].ty)));
                }
                if let Some(pin) = block.input(&name.text).filter(|pin| inputs[*pin].takes == Takes::Value) {
                    return Some((model::Step::Pin(PinId::Input(pin)), Type::Elementary(inputs[pin].ty)));
                }
                let message = format!("{} has no `{}`", types::with_article(block.name()), name.text);
                (message, Some(format!("its outputs are {}, its inputs {}", list(outputs), list(inputs))))
            }
            Type::Unit(unit) => {
                let found = self.scope.find_in(unit, &name.text).map(|id| (id, &self.scope.entry(id).variable));
                if let Some((id, variable)) = found
                    && matches!(variable.class, VariableClass::Input | VariableClass::Output)
                {
                    return Some((model::Step::Variable(id), variable.ty));
                }
                let message =
                    format!("{} has no input or output `{}`", types::with_article(&self.type_name(ty)), name.text);
                (message, None)
            }
            Type::Structure(structure) => {
                let fields = &self.types.structures[structure.index()].fields;
                if let Some(place) = self.types.field(structure, &name.text) {
                    return Some((model::Step::Field(place), fields[place].ty));
                }
                let names: Vec<String> = fields.iter().take(8).map(|field| format!("`{}`", field.name)).collect();
                let message = format!("{} has no member `{}`", types::with_article(&self.type_name(ty)), name.text);
                (message, Some(format!("its members are {}", names.join(", "))))
            }
            Type::Elementary(_) | Type::Array(_) => (
                format!("{} has no members, and so no `{}`", types::with_article(&self.type_name(ty)), name.text),
                None,
            ),
        };
        let problem = Diagnostic::new(Code::UnknownMember, name.span, message);
        self.report.push(Diagnostic { hint, ..problem });
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
