//! The types of a program: those that it declares, and the arrays that declarations name. A declared type is resolved when
//! it is first named, so that the order of declarations does not matter; one that holds itself has no size and is an
//! error.

use std::collections::{HashMap, HashSet};

use thin_vec::thin_vec;

use super::model::{ArrayType, ArrayTypeId, Dimension, Field, Initial, Structure, StructureId, Type, UnitId};
use super::spelling::{self, Budget};
use super::{Checker, types};
use crate::diagnostic::{Code, Diagnostic};
use crate::elementary::{Elementary, Value};
use crate::ladder::library::StandardBlock;
use crate::ladder::{self, Name, TypeKind, TypeReference, UnitKind, key};
use crate::source::Span;

/// The most elements that one array may have, and the most values that all arrays, structures and instances of a program may
/// have together.
pub const MOST_ELEMENTS: u32 = 1 << 20;

/// How deep types may nest in each other.
const MAXIMUM_NESTING: u32 = 64;

/// The most single initial values that the declarations of a program may come to.
const MOST_INITIAL_VALUES: u64 = 4 << 20;

/// Every type that is no elementary one and no standard block.
#[derive(Default)]
pub(super) struct TypeTable {
    /// What each name that the program declares as a type or function block stands for.
    named: HashMap<String, Named>,
    pub(super) arrays: Vec<ArrayType>,
    ids: HashMap<ArrayType, ArrayTypeId>,
    pub(super) structures: Vec<Structure>,
    /// The members of each structure by their names.
    fields: Vec<HashMap<String, usize>>,
    array_facts: Vec<Facts>,
    structure_facts: Vec<Facts>,
    /// The declared types that are being resolved.
    open: u32,
    /// The function blocks that something names as a type.
    pub(super) named_units: HashSet<UnitId>,
    /// How many single initial values were made so far.
    initial_values: u64,
    /// The values of enumerations, by their names: of which type, and which number. Several enumerations may share a name.
    values: HashMap<String, Vec<(String, Value)>>,
}

/// A type and what a variable of it starts with.
pub(super) type Typed = (Type, Initial);

/// What is known of a type from its parts.
#[derive(Clone, Copy, Default)]
struct Facts {
    /// How deep types nest in it.
    depth: u32,
    /// Its values, those of one member in all elements counted as one.
    runs: u64,
    /// All of its values.
    values: u64,
    /// Whether it is a block instance, or holds one.
    holds_instance: bool,
}

enum Named {
    /// The declaration at that place.
    Declared(usize),
    /// It is being resolved: who names it now holds itself.
    Open,
    Known(Typed),
    Broken,
}

impl TypeTable {
    /// The value of an enumeration, by its own name alone; `Err` where several types have one of that name.
    pub(super) fn value(&self, name: &str) -> Option<Result<Value, ()>> {
        match self.values.get(&key(name))?.as_slice() {
            [(_, value)] => Some(Ok(*value)),
            _ => Some(Err(())),
        }
    }

    fn facts(&self, ty: Type) -> Facts {
        match ty {
            Type::Elementary(_) => Facts { depth: 0, runs: 1, values: 1, holds_instance: false },
            Type::Block(_) | Type::Unit(_) => Facts { depth: 0, runs: 1, values: 1, holds_instance: true },
            Type::Array(array) => self.array_facts[array.index()],
            Type::Structure(structure) => self.structure_facts[structure.index()],
        }
    }

    /// Whether a type is that of a block instance, or holds one.
    pub(super) fn holds_instance(&self, ty: Type) -> bool {
        self.facts(ty).holds_instance
    }

    /// How many values a type has, those of one member in all elements of an array counted as one.
    pub(super) fn runs(&self, ty: Type) -> u64 {
        self.facts(ty).runs
    }

    /// How many values a type has, an instance counted as one.
    pub(super) fn values(&self, ty: Type) -> u64 {
        self.facts(ty).values
    }

    /// The member of that name of a structure.
    pub(super) fn field(&self, structure: StructureId, name: &str) -> Option<usize> {
        self.fields[structure.index()].get(&key(name)).copied()
    }

    /// The value of that name of an enumeration.
    pub(super) fn value_of(&self, ty: &str, name: &str) -> Option<Value> {
        let ty = key(ty);
        self.values.get(&key(name))?.iter().find(|(of, _)| *of == ty).map(|(_, value)| *value)
    }
}

impl Checker<'_> {
    /// Notes the names of all types and function blocks.
    pub(super) fn declare_types(&mut self) {
        let program = self.program;
        for (index, declared) in program.types.iter().enumerate() {
            self.declare_type(&declared.name, Named::Declared(index));
        }
        for (index, unit) in (0..).zip(&program.units) {
            if unit.kind == UnitKind::FunctionBlock {
                self.declare_type(&unit.name, Named::Known((Type::Unit(UnitId(index)), Initial::Default)));
            }
        }
    }

    fn declare_type(&mut self, name: &Name, named: Named) {
        let taken = Elementary::from_name(&name.text).is_some() || StandardBlock::from_name(&name.text).is_some();
        if taken || self.types.named.contains_key(&name.key()) {
            let message = format!("there is a type `{}` already", name.text);
            self.report.push(Diagnostic::new(Code::DuplicateName, name.span, message));
        } else {
            self.types.named.insert(name.key(), named);
        }
    }

    /// Whether a function block has the name of a type, which was reported.
    pub(super) fn is_type_twice(&self, name: &Name) -> bool {
        let is_own = |unit: &ladder::Unit| unit.name.span == name.span;
        match self.types.named.get(&name.key()) {
            Some(Named::Known((Type::Unit(unit), _))) => !is_own(&self.program.units[unit.index()]),
            _ => true,
        }
    }

    /// Resolves the declared types that nothing named, too, so that their faults are found.
    pub(super) fn resolve_types(&mut self) {
        for declared in &self.program.types {
            self.type_named(&declared.name);
        }
    }

    /// The type that a declaration names, and what it starts with.
    pub(super) fn resolve(&mut self, reference: &TypeReference) -> Option<Typed> {
        let (element, initial) = self.type_named(&reference.name)?;
        if reference.dimensions.is_empty() {
            return Some((element, initial));
        }
        let mut dimensions = Vec::with_capacity(reference.dimensions.len());
        for dimension in &reference.dimensions {
            dimensions.push(self.dimension(dimension, reference.span));
        }
        let dimensions = dimensions.into_iter().collect::<Option<Vec<_>>>()?;
        let count = dimensions.iter().try_fold(1u32, |count, dimension| count.checked_mul(dimension.count));
        let Some(count) = count.filter(|count| *count <= MOST_ELEMENTS) else {
            let message = format!("this array has more than {MOST_ELEMENTS} elements");
            self.report.push(Diagnostic::new(Code::TooManyElements, reference.span, message));
            return None;
        };
        let initial = match initial {
            Initial::Default => Initial::Default,
            initial => {
                self.note_initial(u64::from(count).saturating_mul(single_values(&initial)), reference.span)?;
                Initial::Elements(thin_vec![initial; count as usize])
            }
        };
        let array = self.array(ArrayType { dimensions, element });
        self.check_nesting(Type::Array(array), reference.span)?;
        Some((Type::Array(array), initial))
    }

    /// Notes initial values that are to be made; none if there are too many.
    pub(super) fn note_initial(&mut self, values: u64, span: Span) -> Option<()> {
        let before = self.types.initial_values;
        self.types.initial_values = before.saturating_add(values);
        if self.types.initial_values <= MOST_INITIAL_VALUES {
            return Some(());
        }
        if before <= MOST_INITIAL_VALUES {
            let message = format!("initial values come to more than {MOST_INITIAL_VALUES} from here on");
            let problem = Diagnostic::new(Code::TooManyElements, span, message);
            self.report.push(problem.hint("let arrays start with what their type says, or make them smaller"));
        }
        None
    }

    /// Reports a type that is nested too deeply; none if it is.
    fn check_nesting(&mut self, ty: Type, span: Span) -> Option<()> {
        let fits = self.types.facts(ty).depth <= MAXIMUM_NESTING;
        if !fits {
            self.types_too_deep(span);
        }
        fits.then_some(())
    }

    fn types_too_deep(&mut self, span: Span) {
        let message = format!("types are nested more than {MAXIMUM_NESTING} deep here");
        let problem = Diagnostic::new(Code::TooDeep, span, message);
        self.report.push(problem.hint("put members side by side instead of into each other"));
    }

    /// An array type; those that are alike are one.
    pub(super) fn array(&mut self, array: ArrayType) -> ArrayTypeId {
        let next = ArrayTypeId(u32::try_from(self.types.arrays.len()).unwrap_or(u32::MAX));
        let id = *self.types.ids.entry(array.clone()).or_insert(next);
        if id == next {
            let element = self.types.facts(array.element);
            let values = element.values.saturating_mul(u64::from(array.count()));
            self.types.array_facts.push(Facts { depth: element.depth + 1, values, ..element });
            self.types.arrays.push(array);
        }
        id
    }

    fn dimension(&mut self, dimension: &ladder::Dimension, span: Span) -> Option<Dimension> {
        let (first, last) = (self.bound(&dimension.first), self.bound(&dimension.last));
        let (first, last) = (first?, last?);
        let count = last.checked_sub(first).and_then(|distance| distance.checked_add(1));
        match count.map(u32::try_from) {
            Some(Ok(count)) if count > 0 && count <= MOST_ELEMENTS => Some(Dimension { first, count }),
            _ if last < first => {
                let message = format!("the last index, {last}, lies before the first, {first}");
                self.report.push(Diagnostic::new(Code::OutOfRange, span, message));
                None
            }
            _ => {
                let message = format!("this array has more than {MOST_ELEMENTS} elements");
                self.report.push(Diagnostic::new(Code::TooManyElements, span, message));
                None
            }
        }
    }

    /// A constant integer that a declaration needs.
    pub(super) fn bound(&mut self, expression: &ladder::Expression) -> Option<i64> {
        if !self.collect_initial(expression) {
            return None;
        }
        let value = self.value(expression, Elementary::Lint)?;
        let Some(value) = value.constant() else {
            let problem = Diagnostic::new(Code::NotConstant, expression.span, "this must be a constant");
            self.report.push(problem.hint("write a literal, or name what `const` declares"));
            return None;
        };
        value.as_integer().and_then(|value| i64::try_from(value).ok())
    }

    /// The type of that name, and what it starts with.
    pub(super) fn type_named(&mut self, name: &Name) -> Option<Typed> {
        if let Some(ty) = Elementary::from_name(&name.text) {
            return Some((Type::Elementary(ty), Initial::Default));
        }
        if let Some(block) = StandardBlock::from_name(&name.text) {
            return Some((Type::Block(block), Initial::Default));
        }
        let index = match self.types.named.get(&name.key()) {
            Some(Named::Known((ty, initial))) => {
                let (ty, values) = (*ty, single_values(initial));
                if let Type::Unit(unit) = ty {
                    self.types.named_units.insert(unit);
                }
                if values > 1 {
                    self.note_initial(values, name.span)?;
                }
                return match self.types.named.get(&name.key()) {
                    Some(Named::Known((_, initial))) => Some((ty, initial.clone())),
                    _ => None,
                };
            }
            Some(Named::Broken) => return None,
            Some(Named::Open) => {
                let message = format!("`{}` holds itself, and so has no size", name.text);
                self.report.push(Diagnostic::new(Code::RecursiveUnit, name.span, message));
                return None;
            }
            Some(Named::Declared(index)) => *index,
            None => {
                self.unknown_type(name);
                return None;
            }
        };
        if self.types.open > MAXIMUM_NESTING {
            self.types_too_deep(name.span);
            return None;
        }
        self.types.named.insert(name.key(), Named::Open);
        self.types.open += 1;
        let resolved = self.declared_type(&self.program.types[index]);
        self.types.open -= 1;
        let named = resolved.clone().map_or(Named::Broken, Named::Known);
        self.types.named.insert(name.key(), named);
        resolved
    }

    /// The block type of that name, if there is one.
    pub(super) fn block_type(&self, name: &Name) -> Option<Type> {
        let own = || match self.types.named.get(&name.key()) {
            Some(Named::Known((ty @ Type::Unit(_), _))) => Some(*ty),
            _ => None,
        };
        StandardBlock::from_name(&name.text).map(Type::Block).or_else(own)
    }

    /// A type's name for messages.
    pub(super) fn type_name(&self, ty: Type) -> String {
        match ty {
            Type::Elementary(ty) => ty.name().to_owned(),
            Type::Block(block) => block.name().to_owned(),
            Type::Unit(unit) => self.program.units[unit.index()].name.text.to_string(),
            Type::Structure(structure) => self.types.structures[structure.index()].name.to_string(),
            Type::Array(array) => {
                let array = &self.types.arrays[array.index()];
                let bounds = array.dimensions.iter().map(|dimension| {
                    let last = i128::from(dimension.first) + i128::from(dimension.count) - 1;
                    format!("{}..{last}", dimension.first)
                });
                let bounds: Vec<String> = bounds.collect();
                format!("array [{}] of {}", bounds.join(", "), self.type_name(array.element))
            }
        }
    }

    fn unknown_type(&mut self, name: &Name) {
        let own = self.program.types.iter().map(|ty| ty.name.text.as_str());
        let blocks = self.program.units.iter().filter(|unit| unit.kind == UnitKind::FunctionBlock);
        let names = Elementary::ALL.iter().map(|ty| ty.name()).chain(StandardBlock::ALL.iter().map(|ty| ty.name()));
        let names = names.chain(own).chain(blocks.map(|unit| unit.name.text.as_str()));
        let near = spelling::nearest(&name.text, names, &mut Budget::default());
        let hint = near.map(|near| format!("did you mean `{near}`?"));
        let problem = Diagnostic::new(Code::UnknownType, name.span, format!("there is no type `{}`", name.text));
        self.report.push(Diagnostic { hint, ..problem });
    }

    fn declared_type(&mut self, declared: &ladder::TypeDeclaration) -> Option<Typed> {
        match &declared.kind {
            TypeKind::Alias { ty, initial } => {
                let (ty, default) = self.resolve(ty)?;
                let initial = match initial {
                    Some(initial) => self.initial(initial, ty)?,
                    None => default,
                };
                Some((ty, initial))
            }
            TypeKind::Structure(fields) => self.structure(&declared.name, fields),
            TypeKind::Enumeration { base, values, initial } => {
                self.enumeration(&declared.name, base.as_ref(), values, initial.as_ref())
            }
        }
    }

    fn structure(&mut self, name: &Name, declared: &[ladder::Field]) -> Option<Typed> {
        let mut fields: Vec<Field> = Vec::with_capacity(declared.len());
        let mut places = HashMap::with_capacity(declared.len());
        let mut names = HashSet::with_capacity(declared.len());
        let mut facts = Facts::default();
        let mut whole = true;
        for field in declared {
            if !names.insert(field.name.key()) {
                let message = format!("`{}` has two members `{}`", name.text, field.name.text);
                self.report.push(Diagnostic::new(Code::DuplicateName, field.name.span, message));
            }
            let typed = self.resolve(&field.ty).and_then(|(ty, default)| match &field.initial {
                Some(initial) => self.initial(initial, ty).map(|initial| (ty, initial)),
                None => Some((ty, default)),
            });
            match typed {
                Some((ty, initial)) => {
                    let of_field = self.types.facts(ty);
                    facts.depth = facts.depth.max(of_field.depth + 1);
                    facts.runs = facts.runs.saturating_add(of_field.runs);
                    facts.values = facts.values.saturating_add(of_field.values);
                    facts.holds_instance |= of_field.holds_instance;
                    places.insert(field.name.key(), fields.len());
                    fields.push(Field { name: field.name.text.clone(), ty, initial });
                }
                None => whole = false,
            }
        }
        if declared.is_empty() {
            let message = format!("the structure `{}` has no members", name.text);
            self.report.push(Diagnostic::new(Code::UnknownType, name.span, message));
            whole = false;
        }
        let id = StructureId(u32::try_from(self.types.structures.len()).unwrap_or(u32::MAX));
        self.types.structures.push(Structure { name: name.text.clone(), fields });
        self.types.fields.push(places);
        self.types.structure_facts.push(facts);
        self.check_nesting(Type::Structure(id), name.span)?;
        whole.then_some((Type::Structure(id), Initial::Default))
    }

    fn enumeration(
        &mut self,
        name: &Name,
        base: Option<&Name>,
        values: &[(Name, Option<ladder::Expression>)],
        initial: Option<&Name>,
    ) -> Option<Typed> {
        let ty = match base {
            None => Elementary::Int,
            Some(base) => match self.type_named(base)?.0 {
                Type::Elementary(ty) if ty.is_integer() => ty,
                _ => {
                    let message = format!("an enumeration is held by an integer, and `{}` is none", base.text);
                    self.report.push(Diagnostic::new(Code::TypeMismatch, base.span, message));
                    return None;
                }
            },
        };
        let mut next: Option<i128> = Some(0);
        let mut first = None;
        for (value_name, written) in values {
            let number = match written {
                Some(written) => self.bound(written).map(i128::from),
                None => next,
            };
            let value = number.and_then(|number| Value::integer(ty, number));
            next = number.and_then(|number| number.checked_add(1));
            let Some(value) = value else {
                let message = format!("the value of `{}` is outside the range of {ty}", value_name.text);
                self.report.push(Diagnostic::new(Code::OutOfRange, value_name.span, message));
                continue;
            };
            first = first.or(Some(value));
            let of_name = self.types.values.entry(value_name.key()).or_default();
            if of_name.iter().any(|(of, _)| *of == name.key()) {
                let message = format!("`{}` has two values `{}`", name.text, value_name.text);
                self.report.push(Diagnostic::new(Code::DuplicateName, value_name.span, message));
            } else {
                of_name.push((name.key(), value));
            }
        }
        let start = match initial {
            None => first,
            Some(initial) => {
                let found = self.types.value_of(&name.text, &initial.text);
                if found.is_none() {
                    let message = format!("{} has no value `{}`", types::with_article(&name.text), initial.text);
                    self.report.push(Diagnostic::new(Code::UnknownMember, initial.span, message));
                }
                found
            }
        };
        Some((Type::Elementary(ty), Initial::Value(start?)))
    }
}

/// How many single values an initial value has.
pub(super) fn single_values(initial: &Initial) -> u64 {
    match initial {
        Initial::Default | Initial::Value(_) => 1,
        Initial::Elements(elements) => elements.iter().map(single_values).fold(1, u64::saturating_add),
        Initial::Members(members) => members.iter().map(|(_, value)| single_values(value)).fold(1, u64::saturating_add),
    }
}
