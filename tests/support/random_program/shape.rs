//! Random types: arrays, structures, enumerations and other names, what they start with, and what can be named in them.

use rung::elementary::Elementary;
use rung::ladder::{
    ArrayItem, BinaryOperator, Dimension, Expression, ExpressionKind, Field, MemberValue, Reference, Root, Step,
    TypeDeclaration, TypeKind, TypeReference, VariableClass,
};

use super::{Entry, Generator, Purpose, Whole};
use crate::support::drawing::{self, NOWHERE};

/// What a type is made of. Two that are equal are one type.
#[derive(Clone, PartialEq, Debug)]
pub(super) enum Shape {
    Value(Elementary),
    Array(Vec<Bounds>, Box<Shape>),
    Structure(String, Vec<(String, Shape)>),
}

/// One dimension of an array.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) struct Bounds {
    pub(super) first: i64,
    pub(super) count: u32,
}

/// One step from a variable to what is in it.
#[derive(Clone, PartialEq)]
pub(super) enum Way {
    Member(String),
    /// An element, whichever.
    Element(Vec<Bounds>),
    /// An element that only constants choose: a computed index would declare hundreds.
    Register(u32),
}

impl Generator {
    /// Declares types, of which later ones may hold earlier ones.
    pub(super) fn declare_types(&mut self) {
        if self.dice.percent(30) {
            let four = Some(drawing::integer(4));
            let values = [("red", None), ("green", four), ("blue", None)];
            let values = values.map(|(value, number)| (drawing::name(value), number)).to_vec();
            let initial = self.dice.percent(50).then(|| drawing::name("green"));
            self.declare_type("colour", TypeKind::Enumeration { base: None, values, initial });
            self.value_types.push((Elementary::Int, "colour".to_owned()));
        }
        if self.dice.percent(20) {
            let initial = self.dice.percent(50).then(|| drawing::integer(3));
            self.declare_type("speed", TypeKind::Alias { ty: named("DINT"), initial });
            self.value_types.push((Elementary::Dint, "speed".to_owned()));
        }
        if self.dice.percent(25) {
            let shape = self.array_of_values();
            let ty = self.type_reference(&shape);
            let initial = self.dice.percent(50).then(|| self.initial_of(&shape));
            self.declare_type("row", TypeKind::Alias { ty, initial });
            self.named_arrays.push((shape, "row".to_owned()));
        }
        for name in ["point", "cell"] {
            if self.dice.percent(40) {
                self.declare_structure(name);
            }
        }
    }

    fn declare_structure(&mut self, name: &str) {
        let mut members = Vec::new();
        let mut fields = Vec::new();
        for number in 0..self.dice.between(1, 4) {
            let shape = match self.dice.below(4) {
                0 => self.array_of_values(),
                1 if !self.structures.is_empty() => self.dice.pick(&self.structures).clone(),
                _ => Shape::Value(*self.dice.pick(&Elementary::ALL)),
            };
            let initial = self.dice.percent(40).then(|| self.initial_of(&shape));
            let text = format!("x{number}");
            fields.push(Field { name: drawing::name(&text), ty: self.type_reference(&shape), initial });
            members.push((text, shape));
        }
        self.declare_type(name, TypeKind::Structure(fields));
        self.structures.push(Shape::Structure(name.to_owned(), members));
    }

    fn declare_type(&mut self, name: &str, kind: TypeKind) {
        self.program.types.push(TypeDeclaration { name: drawing::name(name), kind, span: NOWHERE });
    }

    fn array_of_values(&mut self) -> Shape {
        let ty = *self.dice.pick(&Elementary::ALL);
        self.array_of(Shape::Value(ty))
    }

    /// A small array, seldom of more than one dimension, with bounds on either side of zero.
    fn array_of(&mut self, element: Shape) -> Shape {
        let dimensions = *self.dice.pick(&[1, 1, 1, 2, 3]);
        let most = if dimensions == 1 { 5 } else { 2 };
        let bounds = (0..dimensions).map(|_| self.bounds(most)).collect();
        Shape::Array(bounds, Box::new(element))
    }

    pub(super) fn bounds(&mut self, most: usize) -> Bounds {
        let count = u32::try_from(self.dice.between(1, most)).expect("it is small");
        Bounds { first: *self.dice.pick(&[0, 0, 1, -1, -2]), count }
    }

    /// An array or structure for a variable.
    pub(super) fn some_shape(&mut self) -> Shape {
        let structure = (!self.structures.is_empty()).then(|| self.dice.pick(&self.structures).clone());
        let named = (!self.named_arrays.is_empty()).then(|| self.dice.pick(&self.named_arrays).0.clone());
        match (self.dice.below(5), structure, named) {
            (0, Some(structure), _) => structure,
            (1 | 2, Some(structure), _) => self.array_of(structure),
            (3, _, Some(named)) => self.array_of(named),
            _ => self.array_of_values(),
        }
    }

    /// The type as a declaration names it.
    pub(super) fn type_reference(&mut self, shape: &Shape) -> TypeReference {
        match shape {
            Shape::Value(ty) => named(ty.name()),
            Shape::Structure(name, _) => named(name),
            Shape::Array(bounds, element) => {
                let alias = self.named_arrays.iter().find(|(named, _)| named == shape).map(|(_, name)| name.clone());
                if let Some(name) = alias.filter(|_| self.dice.percent(50)) {
                    return named(&name);
                }
                let dimension = |bounds: &Bounds| Dimension {
                    first: drawing::integer(bounds.first.into()),
                    last: drawing::integer(i128::from(bounds.first) + i128::from(bounds.count) - 1),
                };
                let dimensions = bounds.iter().map(dimension).collect();
                let element = match &**element {
                    Shape::Array(..) => {
                        let inner = self.named_arrays.iter().find(|(named, _)| *named == **element);
                        named(&inner.expect("only arrays with a name are elements").1.clone())
                    }
                    element => self.type_reference(element),
                };
                TypeReference { dimensions, ..element }
            }
        }
    }

    /// What a variable starts with.
    pub(super) fn initial_of(&mut self, shape: &Shape) -> Expression {
        match shape {
            Shape::Value(ty) => self.initial_value(*ty),
            Shape::Array(bounds, element) => {
                let mut left: u32 = bounds.iter().map(|bounds| bounds.count).product();
                let mut items = Vec::new();
                while left > 0 && !(items.len() > 1 && self.dice.percent(30)) {
                    let times = self.dice.between(1, left.min(3) as usize);
                    let repeat = (times > 1 || self.dice.percent(10)).then(|| drawing::integer(times as i128));
                    let empty = repeat.is_some() && self.dice.percent(15);
                    let value = (!empty).then(|| self.initial_of(element));
                    items.push(ArrayItem { repeat, value });
                    left -= u32::try_from(times).expect("it is small");
                }
                drawing::expression(ExpressionKind::Array(items))
            }
            Shape::Structure(_, members) => {
                let skipped = self.dice.below(members.len() + 1);
                let given = members.iter().enumerate().filter(|(place, _)| *place != skipped);
                let values = given.map(|(_, (member, shape))| MemberValue {
                    member: drawing::name(member),
                    value: self.initial_of(shape),
                });
                let values: Vec<MemberValue> = values.collect();
                if values.is_empty() {
                    let (member, shape) = &members[0];
                    let value = MemberValue { member: drawing::name(member), value: self.initial_of(shape) };
                    return drawing::expression(ExpressionKind::Structure(vec![value]));
                }
                drawing::expression(ExpressionKind::Structure(values))
            }
        }
    }

    /// Lets everything in something be named from here on.
    pub(super) fn spread(&mut self, root: &Root, way: &[Way], shape: &Shape, class: VariableClass) {
        let further = |step| [way, &[step]].concat();
        match shape {
            Shape::Value(ty) => self.scope.push(Entry { root: root.clone(), way: way.to_vec(), ty: *ty, class }),
            Shape::Array(bounds, element) => {
                self.wholes.push(Whole { root: root.clone(), way: way.to_vec(), shape: shape.clone(), class });
                self.spread(root, &further(Way::Element(bounds.clone())), element, class);
            }
            Shape::Structure(_, members) => {
                self.wholes.push(Whole { root: root.clone(), way: way.to_vec(), shape: shape.clone(), class });
                for (member, shape) in members {
                    self.spread(root, &further(Way::Member(member.clone())), shape, class);
                }
            }
        }
    }

    /// A reference along a way. Names come in another case now and then.
    pub(super) fn refer(&mut self, root: &Root, way: &[Way]) -> Reference {
        let root = match root {
            Root::Name(name) if self.dice.percent(10) => Root::Name(drawing::name(&name.text.to_uppercase())),
            root => root.clone(),
        };
        let steps = way.iter().map(|way| match way {
            Way::Member(member) => Step::Member(drawing::name(member)),
            Way::Element(bounds) => Step::Index(bounds.iter().map(|bounds| self.index(*bounds)).collect(), NOWHERE),
            Way::Register(count) => {
                let bounds = Bounds { first: 0, count: *count };
                Step::Index(vec![self.constant_index(bounds)], NOWHERE)
            }
        });
        let steps = steps.collect();
        Reference { root, steps, span: NOWHERE }
    }

    /// An index: a constant between the bounds, or computed, and then anything.
    fn index(&mut self, bounds: Bounds) -> Expression {
        use Elementary::{Dint, Int, Lint, Sint, Udint, Uint, Usint};
        let types = [Int, Int, Int, Sint, Dint, Lint, Usint, Uint, Udint];
        let is_fixed = self.fixed_indices || (self.in_index && self.dice.percent(70));
        if is_fixed || self.dice.percent(40) {
            return self.constant_index(bounds);
        }
        let ty = *self.dice.pick(&types);
        let around = std::mem::replace(&mut self.in_index, true);
        let place = self.place(ty, Purpose::ReadVariable).map(|place| drawing::expression(ExpressionKind::Read(place)));
        self.in_index = around;
        match place {
            None => self.constant_index(bounds),
            Some(place) if self.dice.percent(70) => place,
            Some(place) => {
                use BinaryOperator::{Add, Modulo, Multiply, Subtract};
                let operator = *self.dice.pick(&[Add, Subtract, Multiply, Modulo]);
                let number = drawing::integer(self.dice.between(1, 3) as i128);
                drawing::expression(ExpressionKind::Binary(operator, Box::new(place), Box::new(number)))
            }
        }
    }

    pub(super) fn constant_index(&mut self, bounds: Bounds) -> Expression {
        let place = i128::try_from(self.dice.below(bounds.count as usize)).expect("it is small");
        drawing::integer(i128::from(bounds.first) + place)
    }
}

fn named(name: &str) -> TypeReference {
    TypeReference::of_name(drawing::name(name))
}
