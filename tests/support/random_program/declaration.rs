//! What a random program declares.

use rung::elementary::Elementary;
use rung::ladder::library::StandardBlock;
use rung::ladder::{Address, Area, ArrayItem, ExpressionKind, Root, TypeReference, Variable, VariableClass, Width};

use super::{Entry, Generator, Instance};
use crate::support::drawing;

/// Registers that blocks use in chains.
pub(super) const REGISTERS: &str = "registers";
/// How many there are.
pub(super) const REGISTER_COUNT: u32 = 8;

impl Generator {
    pub(super) fn declare(&mut self) {
        use VariableClass::{Constant, Input, Memory, Output};
        for (class, prefix, least, most) in [(Input, "in", 2, 5), (Output, "out", 2, 5), (Memory, "bit", 1, 4)] {
            for number in 0..self.dice.between(least, most) {
                self.declare_variable(class, &format!("{prefix}_{number}"), Elementary::Bool);
            }
        }
        for ty in Elementary::ALL {
            // Blocks need something to be wired to.
            let common = matches!(ty, Elementary::Int | Elementary::Real | Elementary::Time);
            for (class, prefix, percent) in
                [(Memory, "m", 40), (Input, "i", 15), (Output, "o", 10), (Constant, "c", 15)]
            {
                if self.dice.percent(if common { 60 } else { percent }) {
                    self.declare_variable(class, &format!("{prefix}_{}", ty.name().to_lowercase()), ty);
                }
            }
        }
        let registers = drawing::array(Memory, REGISTERS, REGISTER_COUNT, Elementary::Word);
        // Something that shifts can move.
        let pattern =
            ArrayItem { repeat: Some(drawing::integer(REGISTER_COUNT.into())), value: Some(drawing::integer(0x5A5A)) };
        let initial = Some(drawing::expression(ExpressionKind::Array(vec![pattern])));
        self.program.units[0].variables.push(Variable { initial, ..registers });
        if self.dice.percent(8) {
            // Names that need back quotes, or look like something else.
            let odd = *self.dice.pick(&["Füllstand 1", "rung", "S", "T", "x.y", "AND", "1st"]);
            self.declare_variable(Memory, odd, Elementary::Bool);
        }
        if self.dice.percent(35) {
            self.declare_addresses();
        }
        for number in 0..self.dice.between(1, 8) {
            let block = *self.dice.pick(StandardBlock::ALL);
            let declared = self.dice.percent(30);
            let name = format!("{}_{number}", block.name().to_lowercase());
            if declared {
                let variable = Variable {
                    ty: Some(TypeReference::of_name(drawing::name(block.name()))),
                    retain: self.dice.percent(30),
                    ..drawing::variable(Memory, &name, Elementary::Bool)
                };
                self.program.units[0].variables.push(variable);
            }
            self.instances.push(Instance { name, block, declared });
        }
        self.pending.clone_from(&self.instances);
    }

    fn declare_variable(&mut self, class: VariableClass, name: &str, ty: Elementary) {
        let given = if class == VariableClass::Constant { 100 } else { 40 };
        let initial = self.dice.percent(given).then(|| self.initial_value(ty));
        let variable = Variable {
            ty: (ty != Elementary::Bool || self.dice.percent(20))
                .then(|| TypeReference::of_name(drawing::name(ty.name()))),
            initial,
            retain: matches!(class, VariableClass::Output | VariableClass::Memory) && self.dice.percent(20),
            ..drawing::variable(class, name, ty)
        };
        self.program.units[0].variables.push(variable);
        self.scope.push(Entry { root: Root::Name(drawing::name(name)), ty, class });
    }

    /// Addresses far from each other, with and without declarations, two of them under two names.
    fn declare_addresses(&mut self) {
        use VariableClass::{Input, Memory, Output};
        let mut at = |class: VariableClass, width: Width, numbers: &[u32], names: &[(&str, Elementary)]| {
            let area = match class {
                Input => Area::Input,
                Output => Area::Output,
                _ => Area::Memory,
            };
            let address = Address { area, width, numbers: numbers.to_vec(), span: drawing::NOWHERE };
            for (name, ty) in names {
                let variable = Variable { address: Some(address.clone()), ..drawing::variable(class, name, *ty) };
                self.program.units[0].variables.push(variable);
                self.scope.push(Entry { root: Root::Name(drawing::name(name)), ty: *ty, class });
            }
            let undeclared = match width {
                Width::Bit => Elementary::Bool,
                Width::Byte => Elementary::Byte,
                Width::Word => Elementary::Word,
                Width::Double => Elementary::Dword,
                Width::Long => Elementary::Lword,
            };
            if names.is_empty() || self.dice.percent(30) {
                let ty = names.first().map_or(undeclared, |(_, ty)| *ty);
                self.scope.push(Entry { root: Root::Address(address), ty, class });
            }
        };
        at(Input, Width::Bit, &[1, 0], &[]);
        at(Input, Width::Bit, &[2, 7], &[("at_input", Elementary::Bool)]);
        at(Input, Width::Word, &[100], &[]);
        at(Output, Width::Bit, &[1, 3], &[]);
        at(Output, Width::Byte, &[50], &[]);
        at(Memory, Width::Bit, &[1, 1], &[]);
        at(Memory, Width::Word, &[300], &[("word_view", Elementary::Word), ("same_word", Elementary::Word)]);
        at(Memory, Width::Double, &[500], &[("real_view", Elementary::Real), ("same_real", Elementary::Real)]);
        at(Memory, Width::Long, &[700], &[("lreal_view", Elementary::Lreal)]);
    }
}
