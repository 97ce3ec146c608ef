//! Executing instructions one after another, each as [`evaluate`] defines it.
//!
//! This is what a program means: the checker of the passes runs on it, and the textbook interpreter where it has no step of
//! its own. It must stay without any trick, so that a reader believes it.

use std::ops::Range;

use super::image::{read, write};
use super::{Array, Instruction, Layout, Op, ValueId, evaluate};
use crate::elementary::{Elementary, Value};

/// What instructions need to know of an image to be executed.
#[derive(Clone, Debug)]
pub struct Executor {
    /// Offset and type of each slot.
    slots: Vec<(u32, Elementary)>,
    arrays: Vec<Array>,
}

impl Executor {
    /// One for images of a layout.
    pub fn new(layout: &Layout) -> Self {
        let slots = layout.slots().iter().map(|slot| (slot.offset, slot.ty)).collect();
        Self { slots, arrays: layout.arrays().to_vec() }
    }

    /// Executes a range of a verified program's instructions. `values` has the result of each, in register form.
    ///
    /// # Panics
    /// When the program was not verified, `values` is shorter than the instructions or the image than the layout.
    pub fn execute(
        &self,
        instructions: &[Instruction],
        range: Range<usize>,
        values: &mut [u64],
        image: &mut [u8],
        now: i64,
    ) {
        let Self { slots, arrays } = self;
        for index in range {
            let instruction = &instructions[index];
            let (ty, of) = (instruction.ty, |value: ValueId| values[value.index()]);
            let ty_of = |value: ValueId| instructions[value.index()].ty;
            values[index] = match instruction.op {
                Op::Constant(bits) => bits,
                Op::Now => now.cast_unsigned(),
                Op::Load(slot) => {
                    let (offset, ty) = slots[slot.index()];
                    read(image, offset, ty).bits()
                }
                Op::Store(slot, a) => {
                    let (offset, ty) = slots[slot.index()];
                    write(image, offset, Value::from_bits(ty, of(a)));
                    continue;
                }
                Op::LoadIndexed(array, index) => {
                    let Array { first, count } = arrays[array.index()];
                    evaluate::element(count, of(index)).map_or(0, |element| {
                        let (offset, ty) = slots[first.index() + element as usize];
                        read(image, offset, ty).bits()
                    })
                }
                Op::StoreIndexed(array, index, a) => {
                    let Array { first, count } = arrays[array.index()];
                    if let Some(element) = evaluate::element(count, of(index)) {
                        let (offset, ty) = slots[first.index() + element as usize];
                        write(image, offset, Value::from_bits(ty, of(a)));
                    }
                    continue;
                }
                Op::CopyArray(to, from, condition) => {
                    if of(condition) != 0 {
                        for (to, from) in arrays[to.index()].indices().zip(arrays[from.index()].indices()) {
                            let ((to, _), (from, ty)) = (slots[to], slots[from]);
                            let value = read(image, from, ty);
                            write(image, to, value);
                        }
                    }
                    continue;
                }
                Op::Unary(op, a) => evaluate::unary(op, ty, of(a)),
                Op::Binary(op, a, b) => evaluate::binary(op, ty, of(a), of(b)),
                Op::Compare(op, a, b) => u64::from(evaluate::compare(op, ty_of(a), of(a), of(b))),
                Op::Select(condition, a, b) => of(if of(condition) != 0 { a } else { b }),
                Op::Convert(a) => evaluate::convert(ty_of(a), ty, of(a)),
                Op::Reinterpret(a) => evaluate::reinterpret(ty, of(a)),
                Op::Call(helper, a, b) => evaluate::call(helper, ty, of(a), b.map(of)),
            };
        }
    }
}
