//! Places: the way from a variable through structures, arrays and instances to what is read or written.
//!
//! Each computed index is checked against its own dimension, so that none leads into another element by accident. One that
//! is out of range is noted, for the element whose place it is in.

use super::Lowering;
use super::allocate::first_at_address;
use super::cell::{Cell, Pick};
use super::storage::{Cells, Storage};
use crate::check::{ArrayType, Dimension, Index, PinId, Place, Step, Type, VariableId};
use crate::elementary::{Elementary, Value};
use crate::logic::{Binary, Compare, SlotId, ValueId};

/// Where a path has led to.
#[derive(Clone, Copy)]
pub(super) struct Part<'a> {
    pub(super) node: Node<'a>,
    pub(super) ty: Type,
    pub(super) pick: Pick,
    bit: Option<u8>,
    /// Whose own it is: of how many functions that are called within each other the last; 0 where it is no function's. What
    /// writes it in a function called further within is under the guards of those calls.
    pub(super) home: usize,
}

/// What lies there.
#[derive(Clone, Copy)]
pub(super) enum Node<'a> {
    Storage(&'a Storage),
    Pin(Cells),
}

/// A value, or a bit of one.
#[derive(Clone, Copy)]
pub(super) struct Spot {
    pub(super) cell: Cell,
    bit: Option<u8>,
    /// As [`Part::home`].
    pub(super) home: usize,
}

impl<'a> Part<'a> {
    /// A whole variable.
    pub(super) fn new(storage: &'a Storage, ty: Type, pick: Pick) -> Self {
        Self { node: Node::Storage(storage), ty, pick, bit: None, home: 0 }
    }

    /// The same as the own of a function that is called within others, that one counted.
    pub(super) fn of_function(self, home: usize) -> Self {
        Self { home, ..self }
    }

    /// A pin of it.
    pub(super) fn pin(self, cells: Cells) -> Self {
        Self { node: Node::Pin(cells), ..self }
    }

    /// A part of it.
    pub(super) fn inner(self, storage: &'a Storage, ty: Type) -> Self {
        Self { node: Node::Storage(storage), ty, ..self }
    }

    /// The value that it is, if it is one.
    pub(super) fn value(self) -> Option<Spot> {
        let cells = match self.node {
            Node::Pin(cells) => cells,
            Node::Storage(Storage::Value(cells)) => *cells,
            Node::Storage(_) => return None,
        };
        Some(Spot { cell: Cell { cells, pick: self.pick }, bit: self.bit, home: self.home })
    }

    /// The value that it is.
    pub(super) fn spot(self) -> Spot {
        self.value().unwrap_or_else(|| unreachable!("checking lets only values be read and written"))
    }
}

impl Spot {
    /// The slot of a value that is no part of an array.
    pub(super) fn slot(self) -> Option<SlotId> {
        (self.cell.cells.array.is_none() && self.bit.is_none()).then(|| self.cell.cells.slot(0))
    }
}

impl<'a> Lowering<'a> {
    /// Where a place is.
    pub(super) fn part(&mut self, place: &Place) -> Part<'a> {
        let whole = self.variable(place.variable);
        let part = place.path.iter().fold(whole, |part, step| self.step(part, step));
        Part { bit: place.bit.or(part.bit), ..part }
    }

    /// Where the value of a place is.
    pub(super) fn spot(&mut self, place: &Place) -> Spot {
        self.part(place).spot()
    }

    /// All of a variable that the unit can name.
    pub(super) fn variable(&self, id: VariableId) -> Part<'a> {
        if let Some((_, part)) = self.unit.references.iter().find(|(reference, _)| *reference == id) {
            return *part;
        }
        let own =
            self.unit.frame.get(id).map(|storage| {
                (storage, self.unit.pick, if self.unit.is_function { self.guard.functions() } else { 0 })
            });
        let elsewhere = || self.elsewhere(id).map(|storage| (storage, Pick::Constant(0), 0));
        let Some((storage, pick, home)) = own.or_else(elsewhere) else {
            unreachable!("checking lets a unit name its own variables and the global ones")
        };
        Part { home, ..Part::new(storage, self.checked.variable(id).ty, pick) }
    }

    /// What is global: so declared, or at an address.
    pub(super) fn elsewhere(&self, id: VariableId) -> Option<&'a Storage> {
        let slots = self.slots;
        slots.globals.get(id).or_else(|| slots.located.get(&first_at_address(self.checked, id)))
    }

    fn step(&mut self, part: Part<'a>, step: &Step) -> Part<'a> {
        let Node::Storage(storage) = part.node else { unreachable!("a pin has no parts") };
        match (step, part.ty, storage) {
            (Step::Field(field), Type::Structure(structure), Storage::Structure(members)) => {
                part.inner(&members[*field], self.checked.structure(structure).fields[*field].ty)
            }
            (Step::Pin(pin), Type::Block(block), Storage::Block(cells)) => {
                let (cells, ty) = match *pin {
                    PinId::Input(pin) => (cells.inputs[pin], block.inputs()[pin].ty),
                    PinId::Output(pin) => (Some(cells.outputs[pin]), block.outputs()[pin].ty),
                };
                let Some(cells) = cells else { unreachable!("a pin that is named has a slot") };
                Part { ty: Type::Elementary(ty), ..part.pin(cells) }
            }
            (Step::Variable(id), Type::Unit(_), Storage::Unit(frame)) => match frame.get(*id) {
                Some(storage) => part.inner(storage, self.checked.variable(*id).ty),
                None => self.variable(*id),
            },
            (Step::Element(indices), Type::Array(array), Storage::Array(elements)) => {
                let array = self.checked.array(array);
                let pick = self.pick(part.pick, array, indices);
                Part { pick, ..part.inner(elements, array.element) }
            }
            _ => unreachable!("checking makes only paths that their types have"),
        }
    }

    /// Which element of the runs an array's element is.
    fn pick(&mut self, outer: Pick, array: &ArrayType, indices: &[Index]) -> Pick {
        let offsets: Vec<Offset> = (indices.iter().zip(&array.dimensions))
            .map(|(index, dimension)| match index {
                Index::Constant(offset) => Offset::Known(*offset),
                Index::Computed(expression) => match self.known(expression) {
                    Some(index) => Offset::of(index, dimension),
                    None => Offset::Computed(self.expression(expression)),
                },
            })
            .collect();
        let known = offsets.iter().zip(&array.dimensions).try_fold(0, |number, (offset, dimension)| match offset {
            Offset::Known(offset) => Some(number * dimension.count + offset),
            Offset::Outside | Offset::Computed(_) => None,
        });
        match known {
            Some(number) => outer.inside(&mut self.logic, array.count(), number),
            None => self.computed_pick(outer, array, &offsets),
        }
    }

    fn computed_pick(&mut self, outer: Pick, array: &ArrayType, offsets: &[Offset]) -> Pick {
        let mut number = self.lint(0);
        let mut valid = self.logic.bool(true);
        for (offset, dimension) in offsets.iter().zip(&array.dimensions) {
            let (offset, inside) = match *offset {
                Offset::Known(offset) => (self.lint(i64::from(offset)), None),
                Offset::Outside => (self.lint(0), Some(self.logic.bool(false))),
                Offset::Computed(index) => {
                    let first = self.lint(dimension.first);
                    let last = self.lint(dimension.first.saturating_add(i64::from(dimension.count) - 1));
                    let above = self.logic.compare(Compare::GreaterOrEqual, index, first);
                    let below = self.logic.compare(Compare::LessOrEqual, index, last);
                    let inside = self.logic.and(above, below);
                    (self.logic.binary(Binary::Subtract, index, first), Some(inside))
                }
            };
            let count = self.lint(i64::from(dimension.count));
            number = self.logic.binary(Binary::Multiply, number, count);
            number = self.logic.binary(Binary::Add, number, offset);
            if let Some(inside) = inside {
                valid = self.logic.and(valid, inside);
            }
        }
        self.note_index(valid);
        outer.inside_computed(&mut self.logic, array.count(), number, valid)
    }

    fn lint(&mut self, number: i64) -> ValueId {
        self.logic.constant(Value::from_bits(Elementary::Lint, number.cast_unsigned()))
    }

    /// What a place holds.
    pub(super) fn read(&mut self, place: &Place) -> ValueId {
        let spot = self.spot(place);
        self.load(spot)
    }

    /// What is there.
    pub(super) fn load(&mut self, spot: Spot) -> ValueId {
        let whole = spot.cell.load(&mut self.logic);
        match spot.bit {
            None => whole,
            Some(bit) => {
                let mask = self.mask(whole, bit);
                let masked = self.logic.and(whole, mask);
                let zero = self.logic.constant(Value::default_of(self.logic.ty(whole)));
                self.logic.compare(Compare::NotEqual, masked, zero)
            }
        }
    }

    /// Sets what is there where it is executed, under a condition if there is one.
    pub(super) fn store(&mut self, spot: Spot, value: ValueId, condition: Option<ValueId>) {
        let value = match spot.bit {
            None => value,
            Some(bit) => {
                let whole = spot.cell.load(&mut self.logic);
                let mask = self.mask(whole, bit);
                let with = self.logic.or(whole, mask);
                let other_bits = self.logic.not(mask);
                let without = self.logic.and(whole, other_bits);
                self.logic.select(value, with, without)
            }
        };
        let condition = self.reaching(spot.home, condition);
        spot.cell.store(&mut self.logic, condition, value);
        self.forget(spot.cell.cells);
    }

    /// One bit, in the type of a bit string.
    fn mask(&mut self, whole: ValueId, bit: u8) -> ValueId {
        let ty = self.logic.ty(whole);
        self.logic.constant(Value::from_bits(ty, 1 << bit))
    }
}

/// The place of an index in its dimension, from 0.
#[derive(Clone, Copy)]
enum Offset {
    Known(u32),
    /// Known, and not in the dimension.
    Outside,
    /// The index itself, a LINT, not yet counted from 0.
    Computed(ValueId),
}

impl Offset {
    fn of(index: i128, dimension: &Dimension) -> Self {
        let offset = u32::try_from(index - i128::from(dimension.first)).ok();
        offset.filter(|offset| *offset < dimension.count).map_or(Self::Outside, Self::Known)
    }
}
