//! What a random unit declares.

use rung::elementary::Elementary;
use rung::ladder::library::StandardBlock;
use rung::ladder::{Address, Area, Reference, Root, Step, TypeReference, Variable, VariableClass, Width};

use super::shape::{Shape, Way};
use super::{Entry, Generator, Instance, Kind};
use crate::support::drawing::{self, NOWHERE};

/// Of what class, how wide, where, and its names.
type At = (VariableClass, Width, &'static [u32], &'static [(&'static str, Elementary)]);

/// The addresses, far from each other, that a program may use, and the names under which it may declare them.
const ADDRESSES: [At; 9] = {
    use VariableClass::{Input, Memory, Output};
    [
        (Input, Width::Bit, &[1, 0], &[]),
        (Input, Width::Bit, &[2, 7], &[("at_input", Elementary::Bool)]),
        (Input, Width::Word, &[100], &[]),
        (Output, Width::Bit, &[1, 3], &[]),
        (Output, Width::Byte, &[50], &[]),
        (Memory, Width::Bit, &[1, 1], &[]),
        (Memory, Width::Word, &[300], &[("word_view", Elementary::Word), ("same_word", Elementary::Word)]),
        (Memory, Width::Double, &[500], &[("real_view", Elementary::Real), ("same_real", Elementary::Real)]),
        (Memory, Width::Long, &[700], &[("lreal_view", Elementary::Lreal)]),
    ]
};

/// The blocks of the register machine.
const MACHINE: [&str; 9] = ["TT", "TS", "UC", "DC", "DR", "SHIFTL", "SHIFTR", "BS", "BC"];

impl Generator {
    /// The variables of a program, of which the first has most.
    pub(super) fn declare(&mut self, number: usize) {
        use VariableClass::{Constant, Input, Memory, Output, Temporary};
        let is_first = number == 0;
        for (class, prefix, least, most) in [(Input, "in", 2, 5), (Output, "out", 2, 5), (Memory, "bit", 1, 4)] {
            for number in 0..self.dice.between(least, if is_first { most } else { least }) {
                self.declare_variable(class, &format!("{prefix}_{number}"), Elementary::Bool);
            }
        }
        for ty in Elementary::ALL {
            // Blocks need something to be wired to, and arrays indices.
            let common = matches!(ty, Elementary::Int | Elementary::Real | Elementary::Time);
            for (class, prefix, percent) in
                [(Memory, "m", 30), (Input, "i", 15), (Output, "o", 8), (Constant, "c", 10), (Temporary, "t", 2)]
            {
                let percent = if common { percent.max(10) + 30 } else { percent };
                if self.dice.percent(if is_first { percent } else { percent / 3 }) {
                    self.declare_variable(class, &format!("{prefix}_{}", ty.name().to_lowercase()), ty);
                }
            }
        }
        for number in 0..*self.dice.pick(&[0, 1, 1, 2]) {
            let class = *self.dice.pick(&[Memory, Memory, Memory, Output, Input, Constant, Temporary]);
            let shape = self.some_shape();
            self.declare_shape(class, &format!("parts_{number}"), &shape);
        }
        if self.dice.percent(6) {
            // Names that need back quotes, or look like something else.
            let odd = *self.dice.pick(&["Füllstand 1", "rung", "S", "T", "x.y", "END_IF", "1st"]);
            self.declare_variable(Memory, odd, Elementary::Bool);
        }
        if self.addresses && (is_first || self.dice.percent(50)) {
            self.declare_addresses();
        }
    }

    /// Instances of blocks, some of them in arrays.
    pub(super) fn declare_instances(&mut self, most: usize) {
        for number in 0..self.dice.between(1, most) {
            if !self.blocks.is_empty() && self.dice.percent(35) {
                let own = self.dice.pick(&self.blocks).clone();
                let (name, ty) = (format!("own_{number}"), own.name.clone());
                self.declare_instance(&name, &ty, &Kind::Own(own));
            } else {
                let known = |block: &StandardBlock| self.register_machine || !MACHINE.contains(&block.name());
                let blocks: Vec<StandardBlock> = StandardBlock::ALL.iter().copied().filter(known).collect();
                let block = *self.dice.pick(&blocks);
                let name = format!("{}_{number}", block.name().to_lowercase());
                self.declare_instance(&name, block.name(), &Kind::Standard(block));
            }
        }
    }

    fn declare_instance(&mut self, name: &str, ty: &str, kind: &Kind) {
        let mut reference = Reference::of_name(drawing::name(name));
        let is_array = self.dice.percent(15);
        let declared = is_array || self.dice.percent(30);
        let mut way = Vec::new();
        if declared {
            let mut variable = Variable {
                ty: Some(TypeReference::of_name(drawing::name(ty))),
                retain: self.dice.percent(30),
                ..drawing::variable(VariableClass::Memory, name, Elementary::Bool)
            };
            if is_array {
                let bounds = self.bounds(3);
                let array = Shape::Array(vec![bounds], Box::new(Shape::Value(Elementary::Bool)));
                let dimensions = self.type_reference(&array).dimensions;
                if dimensions.is_empty() {
                    // That array has a name.
                    return;
                }
                variable.ty = variable.ty.map(|ty| TypeReference { dimensions, ..ty });
                reference.steps.push(Step::Index(vec![self.constant_index(bounds)], NOWHERE));
                way.push(Way::Element(vec![bounds]));
            }
            self.unit.variables.push(variable);
        }
        let root = Root::Name(drawing::name(name));
        let outputs: Vec<(String, Shape)> = match &kind {
            Kind::Own(own) => own.outputs.clone(),
            // Those of the others are found by their instances.
            Kind::Standard(block) if is_array => {
                block.outputs().iter().map(|pin| (pin.name.to_owned(), Shape::Value(pin.ty))).collect()
            }
            Kind::Standard(_) => Vec::new(),
        };
        for (output, shape) in outputs {
            let way = [way.as_slice(), &[Way::Member(output)]].concat();
            self.spread(&root, &way, &shape, VariableClass::Input);
        }
        self.instances.push(Instance { reference, kind: kind.clone(), declared });
    }

    pub(super) fn declare_variable(&mut self, class: VariableClass, name: &str, ty: Elementary) {
        let given = if class == VariableClass::Constant { 100 } else { 40 };
        let initial = self.dice.percent(given).then(|| self.initial_value(ty));
        let other = self.value_types.iter().find(|(base, _)| *base == ty).map(|(_, name)| name.clone());
        let type_name = other.filter(|_| self.dice.percent(40)).unwrap_or_else(|| ty.name().to_owned());
        let variable = Variable {
            ty: (ty != Elementary::Bool || self.dice.percent(20))
                .then(|| TypeReference::of_name(drawing::name(&type_name))),
            initial: initial.map(Box::new),
            retain: !self.in_function
                && matches!(class, VariableClass::Output | VariableClass::Memory)
                && self.dice.percent(20),
            ..drawing::variable(class, name, ty)
        };
        self.unit.variables.push(variable);
        self.add_name(name, &Shape::Value(ty), class);
    }

    /// Lets the addresses be named, in every unit.
    pub(super) fn use_addresses(&mut self) {
        for (class, width, numbers, names) in ADDRESSES {
            if names.is_empty() || self.dice.percent(30) {
                let direct = match width {
                    Width::Bit => Elementary::Bool,
                    Width::Byte => Elementary::Byte,
                    Width::Word => Elementary::Word,
                    Width::Double => Elementary::Dword,
                    Width::Long => Elementary::Lword,
                };
                let ty = names.first().map_or(direct, |(_, ty)| *ty);
                self.scope.push(Entry {
                    root: Root::Address(Box::new(address(class, width, numbers))),
                    way: Vec::new(),
                    ty,
                    class,
                });
            }
        }
    }

    /// Declares variables at addresses, at some two.
    fn declare_addresses(&mut self) {
        for (class, width, numbers, names) in ADDRESSES {
            for (name, ty) in names {
                let address = Some(address(class, width, numbers));
                self.unit
                    .variables
                    .push(Variable { address: address.map(Box::new), ..drawing::variable(class, name, *ty) });
                self.add_name(name, &Shape::Value(*ty), class);
            }
        }
    }
}

fn address(class: VariableClass, width: Width, numbers: &[u32]) -> Address {
    let area = match class {
        VariableClass::Input => Area::Input,
        VariableClass::Output => Area::Output,
        _ => Area::Memory,
    };
    Address { area, width, numbers: numbers.to_vec(), span: NOWHERE }
}
