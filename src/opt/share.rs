//! What was computed already, in this section or shortly before, is not computed again.
//!
//! Values are numbered by what they are: two have one number if they come from the same operation on operands of the same
//! numbers, and a load has the number of what its slot holds. Only near, as with loads: see [`WINDOW`].
//!
//! What is cheaper to make than to keep is made again where another section wants it: constants, the time, loads and
//! inversions, which become part of the instructions that use them.

use std::collections::BTreeMap;

use rustc_hash::FxHashMap;

use super::forward::WINDOW;
use super::rewrite::{Output, Place, rewrite_raw};
use crate::elementary::Elementary;
use crate::logic::{Array, Binary, Compare, Instruction, Op, Program, SlotId, Unary, ValueId};

/// See the module.
pub(super) fn share(program: Program) -> Program {
    let mut sharing = Sharing::new(&program);
    rewrite_raw(program, |output, place| sharing.visit(output, place))
}

/// An operation on numbers of values.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
struct Key {
    ty: Elementary,
    op: Op,
    /// Of a load of some element: how often elements were stored before.
    stores: u32,
}

/// A value that was made.
#[derive(Clone, Copy)]
struct Made {
    number: ValueId,
    value: Option<ValueId>,
    section: usize,
}

struct Sharing {
    arrays: Vec<Array>,
    /// By slot: whether it is an element.
    elements: Vec<bool>,
    chunk: Option<usize>,
    /// By instruction of the program before.
    numbers: Vec<ValueId>,
    made: FxHashMap<Key, Made>,
    /// The number of what a slot holds.
    holds: BTreeMap<SlotId, ValueId>,
    /// How often elements were stored.
    stores: u32,
}

impl Sharing {
    fn new(program: &Program) -> Self {
        let mut elements = vec![false; program.layout.slots().len()];
        for array in program.layout.arrays() {
            elements[array.indices()].fill(true);
        }
        Self {
            arrays: program.layout.arrays().to_vec(),
            elements,
            chunk: None,
            numbers: Vec::with_capacity(program.instructions.len()),
            made: FxHashMap::default(),
            holds: BTreeMap::new(),
            stores: 0,
        }
    }

    fn visit(&mut self, output: &mut Output, place: Place) -> Option<ValueId> {
        if self.chunk.replace(place.chunk) != Some(place.chunk) {
            self.made.clear();
            self.holds.clear();
        }
        // Its own place, which no other value has.
        let own = ValueId(u32::try_from(place.index).unwrap_or(u32::MAX));
        self.numbers.push(own);
        let instruction = output.mapped(place.index)?;
        let Instruction { ty, op } = output.old()[place.index];
        match op {
            Op::Load(slot) => {
                self.numbers[place.index] = *self.holds.entry(slot).or_insert(own);
                output.keep(instruction)
            }
            Op::Store(slot, value) => {
                self.holds.insert(slot, self.numbers[value.index()]);
                self.stores += u32::from(self.elements[slot.index()]);
                output.keep(instruction)
            }
            Op::StoreIndexed(array, ..) | Op::CopyArray(array, ..) => {
                let slots = self.arrays[array.index()].slots();
                let changed: Vec<SlotId> = self.holds.range(slots).map(|(slot, _)| *slot).collect();
                changed.iter().for_each(|slot| {
                    self.holds.remove(slot);
                });
                self.stores += 1;
                output.keep(instruction)
            }
            Op::LoadIndexed(..) => self.shared(output, place, instruction, self.key(ty, op, self.stores)),
            Op::Constant(_)
            | Op::Now
            | Op::Unary(..)
            | Op::Binary(..)
            | Op::Compare(..)
            | Op::Select(..)
            | Op::Convert(_)
            | Op::Reinterpret(_)
            | Op::Call(..) => self.shared(output, place, instruction, self.key(ty, op, 0)),
        }
    }

    fn key(&self, ty: Elementary, op: Op, stores: u32) -> Key {
        let op = op.map_operands(|operand| self.numbers[operand.index()]);
        let ordered = |a: ValueId, b: ValueId| if a <= b { (a, b) } else { (b, a) };
        let op = match op {
            Op::Binary(op, a, b) if commutes(op) => {
                let (a, b) = ordered(a, b);
                Op::Binary(op, a, b)
            }
            Op::Compare(op @ (Compare::Equal | Compare::NotEqual), a, b) => {
                let (a, b) = ordered(a, b);
                Op::Compare(op, a, b)
            }
            op => op,
        };
        Key { ty, op, stores }
    }

    fn shared(&mut self, output: &mut Output, place: Place, instruction: Instruction, key: Key) -> Option<ValueId> {
        // A comparison is one of its operands' type, which its numbers tell.
        let before = self.made.get(&key).copied();
        if let Some(Made { number, .. }) = before {
            self.numbers[place.index] = number;
        }
        let cheap = matches!(key.op, Op::Constant(_) | Op::Now | Op::Unary(Unary::Not, _));
        let window = if cheap { 0 } else { WINDOW };
        if let Some(made) = before.filter(|made| made.section + window >= place.section && made.value.is_some()) {
            return made.value;
        }
        let value = output.keep(instruction);
        self.made.insert(key, Made { number: self.numbers[place.index], value, section: place.section });
        value
    }
}

/// Whether the operands can be exchanged.
const fn commutes(op: Binary) -> bool {
    match op {
        Binary::And | Binary::Or | Binary::Xor | Binary::Add | Binary::Multiply | Binary::Minimum | Binary::Maximum => {
            true
        }
        Binary::Subtract
        | Binary::Divide
        | Binary::Remainder
        | Binary::ShiftLeft
        | Binary::ShiftRight
        | Binary::RotateLeft
        | Binary::RotateRight => false,
    }
}
