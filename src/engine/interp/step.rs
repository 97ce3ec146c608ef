//! Steps: the operations that are not boolean, with cells as operands.
//!
//! Those that timers are made of have a kind of their own, on 64 bits; the others are computed by `evaluate`.

use crate::elementary::{Elementary, Value};
use crate::logic::image::{read, write};
use crate::logic::{Binary, Compare, Helper, Instruction, Op, Unary, evaluate};

/// Sets a cell to what an operation makes of others, after some gates.
#[derive(Clone, Copy, Debug)]
pub(super) struct Step {
    /// The gates to execute between the step before and this one.
    pub(super) gates_before: u32,
    pub(super) target: u32,
    /// The operands; those that the kind has not are unused.
    pub(super) operands: [u32; 3],
    pub(super) kind: Kind,
}

/// What a step computes. The kinds with a width move bits and fit every type of that size.
#[derive(Clone, Copy, Debug)]
pub(super) enum Kind {
    Copy8,
    Copy16,
    Copy32,
    Copy64,
    Select8,
    Select16,
    Select32,
    Select64,
    Add64,
    Subtract64,
    Minimum64,
    Maximum64,
    Less64,
    LessOrEqual64,
    Equal64,
    NotEqual64,
    Unary(Unary, Elementary),
    Binary(Binary, Elementary),
    Compare(Compare, Elementary),
    Convert(Elementary, Elementary),
    Call(Helper, Elementary),
    /// The operands are the index, the first element and how many there are.
    LoadIndexed(Elementary),
    /// The operands are the index, the value and how many elements there are; the target is the first of them.
    StoreIndexed(Elementary),
    /// The operands are the condition, the first byte to copy and how many there are; the target is the first to set.
    CopyArray,
}

impl Kind {
    /// The step for an instruction whose first operand has type `of`, and whether its first two operands change places;
    /// `None` for what makes no step or is made into one elsewhere.
    pub(super) fn of(instruction: Instruction, of: Elementary) -> Option<(Self, bool)> {
        let wide = matches!(of, Elementary::Lint | Elementary::Time);
        let kind = match instruction.op {
            Op::Constant(_)
            | Op::Now
            | Op::Load(_)
            | Op::Store(..)
            | Op::Reinterpret(_)
            | Op::LoadIndexed(..)
            | Op::StoreIndexed(..)
            | Op::CopyArray(..) => return None,
            Op::Select(..) => match instruction.ty.size() {
                1 => Self::Select8,
                2 => Self::Select16,
                4 => Self::Select32,
                _ => Self::Select64,
            },
            Op::Binary(Binary::Add, ..) if wide => Self::Add64,
            Op::Binary(Binary::Subtract, ..) if wide => Self::Subtract64,
            Op::Binary(Binary::Minimum, ..) if wide => Self::Minimum64,
            Op::Binary(Binary::Maximum, ..) if wide => Self::Maximum64,
            Op::Compare(op, ..) if wide => match op {
                Compare::Equal => Self::Equal64,
                Compare::NotEqual => Self::NotEqual64,
                Compare::Less => Self::Less64,
                Compare::LessOrEqual => Self::LessOrEqual64,
                Compare::Greater => return Some((Self::Less64, true)),
                Compare::GreaterOrEqual => return Some((Self::LessOrEqual64, true)),
            },
            Op::Unary(op, _) => Self::Unary(op, of),
            Op::Binary(op, ..) => Self::Binary(op, of),
            Op::Compare(op, ..) => Self::Compare(op, of),
            Op::Convert(_) => Self::Convert(of, instruction.ty),
            Op::Call(helper, ..) => Self::Call(helper, of),
        };
        Some((kind, false))
    }

    /// The step that copies a value.
    pub(super) fn copy(ty: Elementary) -> Self {
        match ty.size() {
            1 => Self::Copy8,
            2 => Self::Copy16,
            4 => Self::Copy32,
            _ => Self::Copy64,
        }
    }
}

impl Step {
    #[inline(always)]
    pub(super) fn execute(&self, cells: &mut [u8]) {
        let [a, b, c] = self.operands;
        match self.kind {
            Kind::Copy8 => self.put(cells, get::<1>(cells, a)),
            Kind::Copy16 => self.put(cells, get::<2>(cells, a)),
            Kind::Copy32 => self.put(cells, get::<4>(cells, a)),
            Kind::Copy64 => self.put(cells, get::<8>(cells, a)),
            Kind::Select8 => self.put(cells, select::<1>(cells, a, b, c)),
            Kind::Select16 => self.put(cells, select::<2>(cells, a, b, c)),
            Kind::Select32 => self.put(cells, select::<4>(cells, a, b, c)),
            Kind::Select64 => self.put(cells, select::<8>(cells, a, b, c)),
            Kind::Add64 => self.put(cells, signed(cells, a).wrapping_add(signed(cells, b)).to_ne_bytes()),
            Kind::Subtract64 => self.put(cells, signed(cells, a).wrapping_sub(signed(cells, b)).to_ne_bytes()),
            Kind::Minimum64 => self.put(cells, signed(cells, a).min(signed(cells, b)).to_ne_bytes()),
            Kind::Maximum64 => self.put(cells, signed(cells, a).max(signed(cells, b)).to_ne_bytes()),
            Kind::Less64 => self.put(cells, [u8::from(signed(cells, a) < signed(cells, b))]),
            Kind::LessOrEqual64 => self.put(cells, [u8::from(signed(cells, a) <= signed(cells, b))]),
            Kind::Equal64 => self.put(cells, [u8::from(signed(cells, a) == signed(cells, b))]),
            Kind::NotEqual64 => self.put(cells, [u8::from(signed(cells, a) != signed(cells, b))]),
            Kind::Unary(..) | Kind::Binary(..) | Kind::Compare(..) | Kind::Convert(..) | Kind::Call(..) => {
                self.evaluate(cells);
            }
            Kind::LoadIndexed(..) | Kind::StoreIndexed(..) => self.access(cells),
            Kind::CopyArray => self.copy(cells),
        }
    }

    /// The operations that are computed by their definition.
    #[inline(never)]
    fn evaluate(&self, cells: &mut [u8]) {
        let [a, b, _] = self.operands;
        let (ty, bits) = match self.kind {
            Kind::Unary(op, ty) => (ty, evaluate::unary(op, ty, read(cells, a, ty).bits())),
            Kind::Binary(op, ty) => {
                let amount = if op.takes_amount() { Elementary::Udint } else { ty };
                (ty, evaluate::binary(op, ty, read(cells, a, ty).bits(), read(cells, b, amount).bits()))
            }
            Kind::Compare(op, ty) => {
                let holds = evaluate::compare(op, ty, read(cells, a, ty).bits(), read(cells, b, ty).bits());
                (Elementary::Bool, u64::from(holds))
            }
            Kind::Convert(from, to) => (to, evaluate::convert(from, to, read(cells, a, from).bits())),
            Kind::Call(helper, ty) => {
                let second = helper.takes_two().then(|| read(cells, b, ty).bits());
                (ty, evaluate::call(helper, ty, read(cells, a, ty).bits(), second))
            }
            _ => return,
        };
        write(cells, self.target, Value::from_bits(ty, bits));
    }

    /// Loads or stores an element of an array.
    #[inline(never)]
    fn access(&self, cells: &mut [u8]) {
        let [index, b, count] = self.operands;
        let element = evaluate::element(count, signed(cells, index).cast_unsigned());
        match self.kind {
            Kind::LoadIndexed(ty) => {
                let value = element.map_or(Value::default_of(ty), |element| read(cells, b + element * ty.size(), ty));
                write(cells, self.target, value);
            }
            Kind::StoreIndexed(ty) => {
                if let Some(element) = element {
                    write(cells, self.target + element * ty.size(), read(cells, b, ty));
                }
            }
            _ => {}
        }
    }

    /// Copies a whole array, or none of it.
    #[inline(never)]
    fn copy(&self, cells: &mut [u8]) {
        let [condition, from, count] = self.operands.map(|operand| operand as usize);
        if cells[condition] != 0 {
            cells.copy_within(from..from + count, self.target as usize);
        }
    }

    fn put<const N: usize>(&self, cells: &mut [u8], bytes: [u8; N]) {
        let at = self.target as usize;
        cells[at..at + N].copy_from_slice(&bytes);
    }
}

#[inline(always)]
fn get<const N: usize>(cells: &[u8], cell: u32) -> [u8; N] {
    let (mut bytes, at) = ([0; N], cell as usize);
    bytes.copy_from_slice(&cells[at..at + N]);
    bytes
}

#[inline(always)]
fn signed(cells: &[u8], cell: u32) -> i64 {
    i64::from_ne_bytes(get(cells, cell))
}

/// `a` or `b` as a BOOL cell says, without a branch.
#[inline(always)]
fn select<const N: usize>(cells: &[u8], condition: u32, a: u32, b: u32) -> [u8; N] {
    let wide = |cell| {
        let mut bytes = [0; 8];
        bytes[..N].copy_from_slice(&get::<N>(cells, cell));
        u64::from_ne_bytes(bytes)
    };
    let mask = 0u64.wrapping_sub(u64::from(cells[condition as usize]));
    let chosen = (wide(a) & mask | wide(b) & !mask).to_ne_bytes();
    let mut bytes = [0; N];
    bytes.copy_from_slice(&chosen[..N]);
    bytes
}
