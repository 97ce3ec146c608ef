//! The textbook interpreter: one instruction after another, by one `match`, over an array of registers.
//!
//! It is what an interpreter is usually made like, and made well: operands are decoded once, constants wait in their
//! registers, and the operations that ladders consist of have an arm each; all others are the [`Executor`]'s. It must stay
//! without any other trick, so that a reader believes it, and a speed-up measured over it is one over the usual interpreter.

use std::ops::Range;

use rung_runtime::Scan;

use crate::elementary::{Elementary, Value};
use crate::logic::execute::Executor;
use crate::logic::image::{read, write};
use crate::logic::{Binary, Compare, Instruction, Op, Program, Turn, Unary, ValueId, verify};

/// A program, interpreted instruction by instruction.
#[derive(Clone, Debug)]
pub struct Textbook {
    /// Each task: when it is due, and its steps.
    tasks: Vec<(Turn, Range<usize>)>,
    steps: Vec<Step>,
    /// What the steps are made of that are computed by their definition.
    instructions: Vec<Instruction>,
    executor: Executor,
    /// The result of each instruction, in register form.
    registers: Vec<u64>,
}

/// An instruction with its operands at hand: registers, and offsets into the image.
#[derive(Clone, Copy, Debug)]
enum Step {
    Now {
        to: u32,
    },
    LoadBool {
        to: u32,
        from: u32,
    },
    LoadWide {
        to: u32,
        from: u32,
    },
    Load {
        to: u32,
        from: u32,
        ty: Elementary,
    },
    StoreBool {
        to: u32,
        a: u32,
    },
    StoreWide {
        to: u32,
        a: u32,
    },
    Store {
        to: u32,
        a: u32,
        ty: Elementary,
    },
    NotBool {
        to: u32,
        a: u32,
    },
    And {
        to: u32,
        a: u32,
        b: u32,
    },
    Or {
        to: u32,
        a: u32,
        b: u32,
    },
    Xor {
        to: u32,
        a: u32,
        b: u32,
    },
    Select {
        to: u32,
        condition: u32,
        a: u32,
        b: u32,
    },
    /// On signed integers of 64 bits, as the four behind it.
    Add {
        to: u32,
        a: u32,
        b: u32,
    },
    Subtract {
        to: u32,
        a: u32,
        b: u32,
    },
    Minimum {
        to: u32,
        a: u32,
        b: u32,
    },
    Maximum {
        to: u32,
        a: u32,
        b: u32,
    },
    /// On whatever has no fraction.
    Equal {
        to: u32,
        a: u32,
        b: u32,
    },
    NotEqual {
        to: u32,
        a: u32,
        b: u32,
    },
    /// On signed integers.
    Less {
        to: u32,
        a: u32,
        b: u32,
    },
    LessOrEqual {
        to: u32,
        a: u32,
        b: u32,
    },
    /// Anything else: the instruction in this place.
    Other {
        place: u32,
    },
}

impl Step {
    /// The step for the instruction in a place; `None` for a constant, which waits in its register.
    fn of(program: &Program, place: usize) -> Option<Self> {
        let Instruction { ty, op } = program.instructions[place];
        let to = u32::try_from(place).unwrap_or(u32::MAX);
        let ty_of = |value: ValueId| program.instructions[value.index()].ty;
        let is_wide = |ty| matches!(ty, Elementary::Lint | Elementary::Time);
        let step = match op {
            Op::Constant(_) => return None,
            Op::Now => Self::Now { to },
            Op::Load(slot) => {
                let from = program.layout.slot(slot).offset;
                match ty {
                    Elementary::Bool => Self::LoadBool { to, from },
                    _ if ty.size() == 8 => Self::LoadWide { to, from },
                    _ => Self::Load { to, from, ty },
                }
            }
            Op::Store(slot, a) => {
                let (to, a) = (program.layout.slot(slot).offset, a.0);
                match ty {
                    Elementary::Bool => Self::StoreBool { to, a },
                    _ if ty.size() == 8 => Self::StoreWide { to, a },
                    _ => Self::Store { to, a, ty },
                }
            }
            Op::Unary(Unary::Not, a) if ty == Elementary::Bool => Self::NotBool { to, a: a.0 },
            Op::Binary(Binary::And, ValueId(a), ValueId(b)) => Self::And { to, a, b },
            Op::Binary(Binary::Or, ValueId(a), ValueId(b)) => Self::Or { to, a, b },
            Op::Binary(Binary::Xor, ValueId(a), ValueId(b)) => Self::Xor { to, a, b },
            Op::Binary(Binary::Add, ValueId(a), ValueId(b)) if is_wide(ty) => Self::Add { to, a, b },
            Op::Binary(Binary::Subtract, ValueId(a), ValueId(b)) if is_wide(ty) => Self::Subtract { to, a, b },
            Op::Binary(Binary::Minimum, ValueId(a), ValueId(b)) if is_wide(ty) => Self::Minimum { to, a, b },
            Op::Binary(Binary::Maximum, ValueId(a), ValueId(b)) if is_wide(ty) => Self::Maximum { to, a, b },
            Op::Compare(op, first @ ValueId(a), ValueId(b)) => match op {
                Compare::Equal if !ty_of(first).is_real() => Self::Equal { to, a, b },
                Compare::NotEqual if !ty_of(first).is_real() => Self::NotEqual { to, a, b },
                Compare::Less if ty_of(first).is_signed() => Self::Less { to, a, b },
                Compare::LessOrEqual if ty_of(first).is_signed() => Self::LessOrEqual { to, a, b },
                Compare::Greater if ty_of(first).is_signed() => Self::Less { to, a: b, b: a },
                Compare::GreaterOrEqual if ty_of(first).is_signed() => Self::LessOrEqual { to, a: b, b: a },
                Compare::Equal
                | Compare::NotEqual
                | Compare::Less
                | Compare::LessOrEqual
                | Compare::Greater
                | Compare::GreaterOrEqual => Self::Other { place: to },
            },
            Op::Select(ValueId(condition), ValueId(a), ValueId(b)) => Self::Select { to, condition, a, b },
            Op::Unary(..)
            | Op::Binary(..)
            | Op::Convert(_)
            | Op::Reinterpret(_)
            | Op::Call(..)
            | Op::LoadIndexed(..)
            | Op::StoreIndexed(..)
            | Op::CopyArray(..) => Self::Other { place: to },
        };
        Some(step)
    }
}

impl Textbook {
    /// Makes ready to interpret a verified program.
    pub fn new(program: &Program) -> Self {
        debug_assert_eq!(verify(program), Ok(()), "engines take verified programs only");
        let mut steps = Vec::new();
        let tasks = (0..program.tasks.len())
            .map(|task| {
                let start = steps.len();
                let range = program.instruction_range(program.task_range(task));
                steps.extend(range.filter_map(|place| Step::of(program, place)));
                (Turn::of(&program.tasks[task], &program.layout), start..steps.len())
            })
            .collect();
        let constant = |instruction: &Instruction| if let Op::Constant(bits) = instruction.op { bits } else { 0 };
        Self {
            tasks,
            steps,
            instructions: program.instructions.clone(),
            executor: Executor::new(&program.layout),
            registers: program.instructions.iter().map(constant).collect(),
        }
    }

    /// Executes some steps.
    fn execute(&mut self, range: Range<usize>, image: &mut [u8], now: i64) {
        for index in range {
            let registers = &mut self.registers[..];
            let of = |register: u32| registers[register as usize];
            let signed = |register: u32| of(register).cast_signed();
            let (to, value) = match self.steps[index] {
                Step::Now { to } => (to, now.cast_unsigned()),
                Step::LoadBool { to, from } => (to, u64::from(image[from as usize] != 0)),
                Step::LoadWide { to, from } => (to, u64::from_ne_bytes(*wide(image, from))),
                Step::Load { to, from, ty } => (to, read(image, from, ty).bits()),
                Step::StoreBool { to, a } => {
                    image[to as usize] = of(a).to_le_bytes()[0];
                    continue;
                }
                Step::StoreWide { to, a } => {
                    *wide(image, to) = of(a).to_ne_bytes();
                    continue;
                }
                Step::Store { to, a, ty } => {
                    write(image, to, Value::from_bits(ty, of(a)));
                    continue;
                }
                Step::NotBool { to, a } => (to, of(a) ^ 1),
                Step::And { to, a, b } => (to, of(a) & of(b)),
                Step::Or { to, a, b } => (to, of(a) | of(b)),
                Step::Xor { to, a, b } => (to, of(a) ^ of(b)),
                Step::Select { to, condition, a, b } => (to, if of(condition) != 0 { of(a) } else { of(b) }),
                Step::Add { to, a, b } => (to, of(a).wrapping_add(of(b))),
                Step::Subtract { to, a, b } => (to, of(a).wrapping_sub(of(b))),
                Step::Minimum { to, a, b } => (to, signed(a).min(signed(b)).cast_unsigned()),
                Step::Maximum { to, a, b } => (to, signed(a).max(signed(b)).cast_unsigned()),
                Step::Equal { to, a, b } => (to, u64::from(of(a) == of(b))),
                Step::NotEqual { to, a, b } => (to, u64::from(of(a) != of(b))),
                Step::Less { to, a, b } => (to, u64::from(signed(a) < signed(b))),
                Step::LessOrEqual { to, a, b } => (to, u64::from(signed(a) <= signed(b))),
                Step::Other { place } => {
                    let place = place as usize;
                    self.executor.execute(&self.instructions, place..place + 1, registers, image, now);
                    continue;
                }
            };
            registers[to as usize] = value;
        }
    }
}

/// The eight bytes at an offset.
#[inline(always)]
fn wide(image: &mut [u8], offset: u32) -> &mut [u8; 8] {
    let at = offset as usize;
    (&mut image[at..at + 8]).try_into().unwrap_or_else(|_| unreachable!("eight bytes are eight"))
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
