//! The textbook interpreter: one instruction after another, each as `evaluate` defines it.
//!
//! Short and obviously right, it says what a program means; the other engines are tested against it. It must stay
//! without any trick, so that a reader believes it, and a speed-up measured over it is one over the usual interpreter.

use std::ops::Range;

use rung_runtime::Scan;

use crate::elementary::{Elementary, Value};
use crate::logic::image::{read, write};
use crate::logic::{Array, Instruction, Op, Program, Turn, ValueId, evaluate, verify};

/// A program, interpreted instruction by instruction.
#[derive(Clone, Debug)]
pub struct Textbook {
    /// Each task: when it is due, and its instructions.
    tasks: Vec<(Turn, Range<usize>)>,
    instructions: Vec<Instruction>,
    /// Offset and type of each slot.
    slots: Vec<(u32, Elementary)>,
    arrays: Vec<Array>,
    /// The result of each instruction, in register form.
    values: Vec<u64>,
}

impl Textbook {
    /// Makes ready to interpret a verified program.
    pub fn new(program: &Program) -> Self {
        debug_assert_eq!(verify(program), Ok(()), "engines take verified programs only");
        let tasks = (0..program.tasks.len())
            .map(|task| {
                let turn = Turn::of(&program.tasks[task], &program.layout);
                (turn, program.instruction_range(program.task_range(task)))
            })
            .collect();
        Self {
            tasks,
            instructions: program.instructions.clone(),
            slots: program.layout.slots().iter().map(|slot| (slot.offset, slot.ty)).collect(),
            arrays: program.layout.arrays().to_vec(),
            values: vec![0; program.instructions.len()],
        }
    }

    /// Executes some instructions.
    fn execute(&mut self, range: Range<usize>, image: &mut [u8], now: i64) {
        let Self { instructions, slots, arrays, values, .. } = self;
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

impl Scan for Textbook {
    fn scan(&mut self, image: &mut [u8], now: i64) {
        for task in 0..self.tasks.len() {
            let (turn, range) = self.tasks[task].clone();
            if turn.take(image, now) {
                self.execute(range, image, now);
            }
        }
    }
}
