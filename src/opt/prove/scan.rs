//! Executing a part of a program on what is not known: every slot and the time are variables.
//!
//! Each operation means here what [`evaluate`](crate::logic::evaluate) says, bit by bit; the tests hold each against that
//! on samples. Where one value can be written in several ways, the way is taken in which the passes' rewriting comes out
//! the same: a quotient is one of magnitudes, a shifted product by a reciprocal is the quotient that it stands for.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;
use std::rc::Rc;

use super::function::Function;
use super::graph::Literal;
use super::judge::Method;
use super::space::{Held, Space};
use super::word::{
    self, Word, as_constant, constant, extended, rotated_left, rotated_right, shifted_left, shifted_right,
};
use crate::elementary::Elementary;
use crate::logic::{Array, ArrayId, Binary, Compare, Instruction, Op, Program, SlotId, Unary, ValueId, evaluate};

/// Elements up to which an array that is read by an index is taken apart.
const MOST_ELEMENTS: u32 = 64;

/// What sections left: by slot that they stored, what that holds, and what it took to know that what it is made of is what
/// the first program has.
pub(super) type Stored = BTreeMap<SlotId, (Held, Method)>;

/// Which of two programs is executed.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Turn {
    First,
    Second,
}

/// Executes sections whose values come from within them; `None` where that becomes too large.
pub(super) fn execute(space: &mut Space<'_>, program: &Program, sections: Range<usize>, turn: Turn) -> Option<Stored> {
    let range = program.instruction_range(sections.clone());
    let mut scan = Scan {
        space,
        program,
        start: range.start,
        values: Vec::with_capacity(range.len()),
        took: Vec::new(),
        stored: Stored::new(),
    };
    for section in sections {
        for index in program.section_range(section) {
            if scan.space.graph.is_full() {
                return None;
            }
            let instruction = program.instructions[index];
            let mut took = scan.taken(instruction.op);
            let value = scan.instruction(instruction);
            if let ([bit], Elementary::Bool) = (&*value, instruction.ty) {
                match turn {
                    Turn::First => scan.space.note(*bit, section),
                    Turn::Second => scan.space.meet(*bit, section),
                }
            }
            took = took.max(scan.space.took());
            scan.note_taken(instruction.op, took);
            scan.values.push(value);
            scan.took.push(took);
        }
    }
    Some(scan.stored)
}

struct Scan<'s, 'a> {
    space: &'s mut Space<'a>,
    program: &'s Program,
    /// The first instruction that is executed.
    start: usize,
    /// By instruction; of a store it is nothing.
    values: Vec<Rc<[Literal]>>,
    /// By instruction: what the proofs took of all that it is made of.
    took: Vec<Method>,
    stored: Stored,
}

impl Scan<'_, '_> {
    fn of(&self, value: ValueId) -> Rc<[Literal]> {
        Rc::clone(&self.values[value.index() - self.start])
    }

    fn ty(&self, value: ValueId) -> Elementary {
        self.program.instructions[value.index()].ty
    }

    fn held(&mut self, slot: SlotId) -> Held {
        match self.stored.get(&slot) {
            Some((held, _)) => *held,
            None => self.space.initially(slot),
        }
    }

    fn store(&mut self, slot: SlotId, held: Held) {
        self.stored.entry(slot).or_insert((held, Method::Structure)).0 = held;
    }

    /// What the proofs took of the values and slots that an operation uses.
    fn taken(&self, op: Op) -> Method {
        let slots = match op {
            Op::Load(slot) => slot..SlotId(slot.0 + 1),
            Op::LoadIndexed(array, _) | Op::CopyArray(_, array, _) => self.array(array).slots(),
            Op::Constant(_)
            | Op::Now
            | Op::Store(..)
            | Op::Unary(..)
            | Op::Binary(..)
            | Op::Compare(..)
            | Op::Select(..)
            | Op::Convert(_)
            | Op::Reinterpret(_)
            | Op::Call(..)
            | Op::StoreIndexed(..) => SlotId(0)..SlotId(0),
        };
        let loaded = self.stored.range(slots).map(|(_, (_, took))| *took);
        let operands = op.operands().map(|operand| self.took[operand.index() - self.start]);
        loaded.chain(operands).max().unwrap_or(Method::Structure)
    }

    /// Notes it of the slots that an operation sets; of elements only some of which it sets, the greater of both.
    fn note_taken(&mut self, op: Op, took: Method) {
        let sets_all = matches!(op, Op::Store(..));
        let Some(slots) = op.stores(&self.program.layout) else { return };
        for (_, (_, of_slot)) in self.stored.range_mut(slots) {
            *of_slot = if sets_all { took } else { took.max(*of_slot) };
        }
    }

    fn array(&self, array: ArrayId) -> Array {
        self.program.layout.array(array)
    }

    fn instruction(&mut self, Instruction { ty, op }: Instruction) -> Rc<[Literal]> {
        let width = ty.bits() as usize;
        match op {
            Op::Constant(bits) => constant(bits, width).into(),
            Op::Now => self.space.now().into(),
            Op::Load(slot) => {
                let held = self.held(slot);
                self.space.bits(held)
            }
            Op::Store(slot, a) => {
                let held = self.space.holding(&self.of(a));
                self.store(slot, held);
                Rc::default()
            }
            Op::LoadIndexed(array, index) => self.element(self.array(array), &self.of(index), width).into(),
            Op::StoreIndexed(array, index, a) => {
                let (index, value) = (self.of(index), self.space.holding(&self.of(a)));
                let Array { first, count } = self.array(array);
                let elements = match as_constant(&index) {
                    None => 0..count,
                    Some(index) => evaluate::element(count, index).map_or(0..0, |element| element..element + 1),
                };
                for element in elements {
                    let slot = SlotId(first.0 + element);
                    let before = self.held(slot);
                    let after = self.space.set_where(&index, element, value, before);
                    self.store(slot, after);
                }
                Rc::default()
            }
            Op::CopyArray(to, from, condition) => {
                let condition = self.of(condition)[0];
                let (to, from) = (self.array(to), self.array(from));
                for element in 0..to.count {
                    let [to, from] = [to, from].map(|array| SlotId(array.first.0 + element));
                    let (value, before) = (self.held(from), self.held(to));
                    let after = self.space.set_while(condition, value, before);
                    self.store(to, after);
                }
                Rc::default()
            }
            Op::Unary(op, a) => self.unary(op, ty, &self.of(a)).into(),
            Op::Binary(op, a, b) => self.binary(op, ty, &self.of(a), &self.of(b)).into(),
            Op::Compare(op, a, b) => [self.compare(op, self.ty(a), &self.of(a), &self.of(b))].into(),
            Op::Select(condition, a, b) => {
                let (condition, a, b) = (self.of(condition)[0], self.of(a), self.of(b));
                self.space.graph.select_word(condition, &a, &b).into()
            }
            Op::Convert(a) if self.ty(a) == ty => self.of(a),
            Op::Convert(a) => self.convert(self.ty(a), ty, &self.of(a)).into(),
            Op::Reinterpret(a) => self.of(a),
            Op::Call(helper, a, b) => {
                let operands = [Some(a), b].into_iter().flatten().map(|operand| self.of(operand).to_vec()).collect();
                self.space.apply(Function::Call(helper, ty), operands, width).into()
            }
        }
    }

    /// An element by an index; the default where there is none.
    fn element(&mut self, Array { first, count }: Array, index: &Rc<[Literal]>, width: usize) -> Word {
        if let Some(index) = as_constant(index) {
            return match evaluate::element(count, index) {
                Some(element) => {
                    let held = self.held(SlotId(first.0 + element));
                    self.space.bits(held).to_vec()
                }
                None => constant(0, width),
            };
        }
        if count > MOST_ELEMENTS {
            let contents = (0..count).map(|element| self.held(SlotId(first.0 + element))).collect();
            let contents = self.space.contents(contents);
            return self.space.apply(Function::Element(contents), vec![index.to_vec()], width);
        }
        let mut value = constant(0, width);
        for element in 0..count {
            let held = self.held(SlotId(first.0 + element));
            let bits = self.space.bits(held);
            let named = self.space.is_element(index, element);
            value = self.space.graph.select_word(named, &bits, &value);
        }
        value
    }

    fn unary(&mut self, op: Unary, ty: Elementary, a: &[Literal]) -> Word {
        let sign = a[a.len() - 1];
        let with_sign = |sign: Literal| a[..a.len() - 1].iter().copied().chain([sign]).collect();
        match op {
            Unary::Not => a.iter().map(|bit| !*bit).collect(),
            Unary::Negate if ty.is_real() => with_sign(!sign),
            Unary::Absolute if ty.is_real() => with_sign(Literal::FALSE),
            Unary::Negate => self.space.graph.negate(a),
            Unary::Absolute if ty.is_signed() => self.space.graph.negate_if(sign, a),
            Unary::Absolute => a.to_vec(),
            Unary::SquareRoot => self.space.apply(Function::Unary(op, ty), vec![a.to_vec()], a.len()),
        }
    }

    fn binary(&mut self, op: Binary, ty: Elementary, a: &[Literal], b: &[Literal]) -> Word {
        if ty.is_real() {
            return self.real(op, ty, a, b);
        }
        let graph = &mut self.space.graph;
        match op {
            Binary::And => graph.each(a, b, super::graph::Graph::and),
            Binary::Or => graph.each(a, b, super::graph::Graph::or),
            Binary::Xor => graph.each(a, b, super::graph::Graph::xor),
            Binary::Add => graph.add(a, b),
            Binary::Subtract => graph.subtract(a, b),
            Binary::Multiply => {
                self.product(&word::factor(a, ty.is_signed()), &word::factor(b, ty.is_signed()), a.len())
            }
            Binary::Divide => self.quotient(ty, a, b),
            Binary::Remainder => self.remainder(ty, a, b),
            Binary::Minimum | Binary::Maximum => {
                let less = self.compare(Compare::Less, ty, a, b);
                let takes_a = less.turned(op == Binary::Maximum);
                self.space.graph.select_word(takes_a, a, b)
            }
            Binary::ShiftLeft => self.shift(a, b, shifted_left),
            Binary::ShiftRight => {
                if let Some(amount) = as_constant(b)
                    && let Some(quotient) = self.quotient_of_product(a, amount)
                {
                    return quotient;
                }
                self.shift(a, b, shifted_right)
            }
            // Widths are powers of two, so that the amount counts modulo that of its low bits.
            Binary::RotateLeft => graph.moved(a, &b[..a.len().ilog2() as usize], rotated_left),
            Binary::RotateRight => graph.moved(a, &b[..a.len().ilog2() as usize], rotated_right),
        }
    }

    fn shift(&mut self, a: &[Literal], amount: &[Literal], shifted: fn(&[Literal], usize) -> Word) -> Word {
        let (low, high) = amount.split_at(a.len().ilog2() as usize);
        let graph = &mut self.space.graph;
        let (moved, all_out) = (graph.moved(a, low, shifted), graph.any(high));
        moved.into_iter().map(|bit| graph.and(bit, !all_out)).collect()
    }

    /// The low bits of the product of signed words.
    fn product(&mut self, a: &[Literal], b: &[Literal], width: usize) -> Word {
        for (word, other) in [(a, b), (b, a)] {
            let Some(number) = as_constant(&extended(word, true, 64)) else { continue };
            let magnitude = number.cast_signed().unsigned_abs();
            // Also of -2^63: what is shifted by as much as that has but one bit left.
            if magnitude == 0 {
                return constant(0, width);
            }
            if magnitude.is_power_of_two() && word.len() <= 64 {
                let shifted = shifted_left(&extended(other, true, width), magnitude.trailing_zeros() as usize);
                let negative = number.cast_signed() < 0;
                return if negative { self.space.graph.negate(&shifted) } else { shifted };
            }
        }
        self.space.apply(Function::Product, vec![a.to_vec(), b.to_vec()], width)
    }

    /// A number's magnitude without a sign, and whether it is negative.
    fn magnitude(&mut self, ty: Elementary, a: &[Literal]) -> (Word, Literal) {
        if ty.is_signed() {
            let sign = a[a.len() - 1];
            (self.space.graph.negate_if(sign, a), sign)
        } else {
            (a.to_vec(), Literal::FALSE)
        }
    }

    /// The quotient of magnitudes, as wide as the dividend; by zero it is 0.
    fn quotient_of_magnitudes(&mut self, a: &[Literal], b: &[Literal], width: usize) -> Word {
        let (a, b) = (word::unsigned(a), word::unsigned(b));
        match as_constant(&b) {
            Some(0) => constant(0, width),
            Some(divisor) if divisor.is_power_of_two() => {
                extended(&shifted_right(&a, divisor.trailing_zeros() as usize), false, width)
            }
            _ => {
                let length = a.len();
                let quotient = self.space.apply(Function::Quotient, vec![a, b], length);
                extended(&quotient, false, width)
            }
        }
    }

    fn quotient(&mut self, ty: Elementary, a: &[Literal], b: &[Literal]) -> Word {
        let ((dividend, a_below), (divisor, b_below)) = (self.magnitude(ty, a), self.magnitude(ty, b));
        if as_constant(&divisor) == Some(1) {
            return self.space.graph.negate_if(b_below, a);
        }
        let quotient = self.quotient_of_magnitudes(&dividend, &divisor, a.len());
        let negative = self.space.graph.xor(a_below, b_below);
        self.space.graph.negate_if(negative, &quotient)
    }

    fn remainder(&mut self, ty: Elementary, a: &[Literal], b: &[Literal]) -> Word {
        let ((dividend, a_below), (divisor, _)) = (self.magnitude(ty, a), self.magnitude(ty, b));
        if let Some(divisor) = as_constant(&divisor).filter(|divisor| divisor.is_power_of_two()) {
            let low = extended(&dividend[..divisor.trailing_zeros() as usize], false, a.len());
            return self.space.graph.negate_if(a_below, &low);
        }
        let quotient = self.quotient(ty, a, b);
        let signed = ty.is_signed();
        let multiple = self.product(&word::factor(&quotient, signed), &word::factor(b, signed), a.len());
        let left = self.space.graph.subtract(a, &multiple);
        let exists = self.space.graph.any(b);
        left.into_iter().map(|bit| self.space.graph.and(bit, exists)).collect()
    }

    /// `x * factor >> amount`, all of whose 64 bits are there, where that is `x / divisor` for every `x` of its width: then
    /// `factor * divisor` is `2^amount` or more by so little that the excess, `x` times, stays below the next quotient
    /// (T. Granlund, P. Montgomery: Division by Invariant Integers using Multiplication, theorem 4.2).
    fn quotient_of_product(&mut self, product: &[Literal], amount: u64) -> Option<Word> {
        if product.len() != 64 || amount >= 64 {
            return None;
        }
        let [a, b] = self.space.as_product(product)? else { return None };
        // Both are signed words, and neither may be negative.
        let ((a_sign, a), (b_sign, b)) = (a.split_last()?, b.split_last()?);
        if (*a_sign, *b_sign) != (Literal::FALSE, Literal::FALSE) {
            return None;
        }
        let (factor, x) = match (as_constant(a), as_constant(b)) {
            (Some(factor), None) => (factor, b),
            (None, Some(factor)) => (factor, a),
            _ => return None,
        };
        let (width, x) = (u32::try_from(x.len()).ok()?, x.to_vec());
        if width > 63 || factor >> (64 - width) != 0 || factor == 0 {
            return None;
        }
        let power = 1u128 << amount;
        let divisor = power.div_ceil(u128::from(factor));
        let excess = u128::from(factor) * divisor - power;
        if excess << width > power {
            return None;
        }
        let divisor = constant(u64::try_from(divisor).ok()?, 64);
        Some(self.quotient_of_magnitudes(&x, &divisor, 64))
    }

    fn real(&mut self, op: Binary, ty: Elementary, a: &[Literal], b: &[Literal]) -> Word {
        let reciprocal = as_constant(b).filter(|_| op == Binary::Divide).and_then(|bits| reciprocal(ty, bits));
        let (op, b) = match reciprocal {
            Some(bits) => (Binary::Multiply, constant(bits, b.len())),
            None => (op, b.to_vec()),
        };
        self.space.apply(Function::Binary(op, ty), vec![a.to_vec(), b], a.len())
    }

    fn compare(&mut self, op: Compare, ty: Elementary, a: &[Literal], b: &[Literal]) -> Literal {
        match op {
            Compare::NotEqual => return !self.compare(Compare::Equal, ty, a, b),
            Compare::Greater => return self.compare(Compare::Less, ty, b, a),
            Compare::GreaterOrEqual => return self.compare(Compare::LessOrEqual, ty, b, a),
            // Of REALs it is not, for there is NaN.
            Compare::LessOrEqual if !ty.is_real() => return !self.compare(Compare::Less, ty, b, a),
            Compare::Equal | Compare::Less | Compare::LessOrEqual => {}
        }
        if ty.is_real() {
            return self.space.apply(Function::Compare(op, ty), vec![a.to_vec(), b.to_vec()], 1)[0];
        }
        let (a, b) = (word::signed(a, ty.is_signed()), word::signed(b, ty.is_signed()));
        if op == Compare::Less { self.space.graph.less(&a, &b) } else { self.space.graph.equal(&a, &b) }
    }

    fn convert(&mut self, from: Elementary, to: Elementary, a: &[Literal]) -> Word {
        let width = to.bits() as usize;
        match (from.is_real(), to.is_real()) {
            _ if to == Elementary::Bool => {
                let zero = constant(0, a.len());
                vec![self.compare(Compare::NotEqual, from, a, &zero)]
            }
            (false, false) => extended(a, from.is_signed(), width),
            (false, true) => {
                let number = word::signed(a, from.is_signed());
                self.space.apply(Function::ToReal(to), vec![number], width)
            }
            (true, _) => self.space.apply(Function::Convert(from, to), vec![a.to_vec()], width),
        }
    }
}

/// The reciprocal of a power of two, where both are normal numbers: a quotient by the one is the product with the other,
/// since both round the same number.
fn reciprocal(ty: Elementary, bits: u64) -> Option<u64> {
    // Whether it is normal and its fraction is 0.
    let is_power = |bits: u64, fraction: u32, exponents: u64| {
        let exponent = bits >> fraction & exponents;
        exponent != 0 && exponent != exponents && bits & ((1 << fraction) - 1) == 0
    };
    if ty == Elementary::Real {
        let is_power = |bits: u32| is_power(u64::from(bits), 23, 0xFF);
        let number = u32::try_from(bits).ok().filter(|bits| is_power(*bits))?;
        Some(f32::from_bits(number).recip().to_bits()).filter(|bits| is_power(*bits)).map(u64::from)
    } else {
        let is_power = |bits: u64| is_power(bits, 52, 0x7FF);
        let number = Some(bits).filter(|bits| is_power(*bits))?;
        Some(f64::from_bits(number).recip().to_bits()).filter(|bits| is_power(*bits))
    }
}

/// A slot that either of two programs stored.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pair {
    pub(super) slot: SlotId,
    pub(super) before: Held,
    pub(super) after: Held,
    /// What it took so far.
    pub(super) took: Method,
}

/// What both left in the slots that either stored, in the order of the slots.
pub(super) fn pairs(space: &mut Space<'_>, before: &Stored, after: &Stored) -> Vec<Pair> {
    let slots: BTreeSet<SlotId> = before.keys().chain(after.keys()).copied().collect();
    let held = |space: &mut Space<'_>, stored: &Stored, slot: SlotId| match stored.get(&slot) {
        Some(held) => *held,
        None => (space.initially(slot), Method::Structure),
    };
    let pair = |slot: SlotId| {
        let ((before, of_before), (after, of_after)) = (held(space, before, slot), held(space, after, slot));
        Pair { slot, before, after, took: of_before.max(of_after) }
    };
    slots.into_iter().map(pair).collect()
}
