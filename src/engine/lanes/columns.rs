//! The general path: an operation on anything but BOOLs is done on a column at a time, a value for each lane.
//!
//! Every operation of the table is here, without a catch-all, and computes what [`evaluate`] says in each lane: the
//! common ones on integers as loops that become vector instructions, all others by asking it for lane after lane.
//! A value lies in a column as it does in an image; its register form is made of that where `evaluate` wants it.

mod integers;

use super::LANES;
use super::word::Word;
use crate::elementary::{Elementary, canonical};
use crate::logic::evaluate;
use crate::logic::{Binary, Compare, Helper, Unary};

/// Which column, and the type of what is in it.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) struct Column {
    pub(super) ty: Elementary,
    /// Among those of values as wide.
    pub(super) index: u32,
}

/// Where a value of any type is.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Place {
    Word(u32),
    Column(Column),
}

/// An array: its elements are in places one after another.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) struct Elements {
    pub(super) first: Place,
    pub(super) count: u32,
}

impl Elements {
    fn element(self, index: u32) -> Place {
        match self.first {
            Place::Word(word) => Place::Word(word + index),
            Place::Column(column) => Place::Column(Column { index: column.index + index, ..column }),
        }
    }
}

/// An operation on columns, in all lanes.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) enum Step {
    Copy { to: Column, from: Column },
    Now { to: Column },
    Unary { op: Unary, to: Column, a: Column },
    Binary { op: Binary, to: Column, a: Column, b: Column },
    Compare { op: Compare, to: u32, a: Column, b: Column },
    Select { to: Column, condition: u32, a: Column, b: Column },
    Convert { to: Place, from: Place },
    Call { helper: Helper, to: Column, a: Column, b: Option<Column> },
    LoadIndexed { to: Place, from: Elements, index: Column },
    StoreIndexed { to: Elements, index: Column, from: Place },
    CopyArray { to: Elements, from: Elements, condition: u32 },
}

/// All columns of a group, by the width of their values.
#[derive(Clone, PartialEq, Debug)]
pub(super) struct Columns {
    one: Vec<[u8; LANES]>,
    two: Vec<[u16; LANES]>,
    four: Vec<[u32; LANES]>,
    eight: Vec<[u64; LANES]>,
}

/// Binds the columns of a type's width, and the type of their values, to names.
macro_rules! by_width {
    ($columns:expr, $ty:expr, |$of:ident: $T:ident| $body:expr) => {
        match $ty.size() {
            1 => {
                type $T = u8;
                let $of = &mut $columns.one;
                $body
            }
            2 => {
                type $T = u16;
                let $of = &mut $columns.two;
                $body
            }
            4 => {
                type $T = u32;
                let $of = &mut $columns.four;
                $body
            }
            _ => {
                type $T = u64;
                let $of = &mut $columns.eight;
                $body
            }
        }
    };
}
use by_width;

impl Columns {
    /// So many columns of each width, all zero.
    pub(super) fn new([one, two, four, eight]: [usize; 4]) -> Self {
        Self {
            one: vec![[0; LANES]; one],
            two: vec![[0; LANES]; two],
            four: vec![[0; LANES]; four],
            eight: vec![[0; LANES]; eight],
        }
    }

    /// The value of a lane, in register form.
    #[inline]
    pub(super) fn get(&self, column: Column, lane: usize) -> u64 {
        let index = column.index as usize;
        let bits = match column.ty.size() {
            1 => u64::from(self.one[index][lane]),
            2 => u64::from(self.two[index][lane]),
            4 => u64::from(self.four[index][lane]),
            _ => self.eight[index][lane],
        };
        canonical(column.ty, bits)
    }

    /// Sets the value of a lane; bits outside the type's width are dropped.
    #[inline]
    pub(super) fn set(&mut self, column: Column, lane: usize, bits: u64) {
        let index = column.index as usize;
        #[expect(clippy::cast_possible_truncation, reason = "the low bits are the value")]
        match column.ty.size() {
            1 => self.one[index][lane] = bits as u8,
            2 => self.two[index][lane] = bits as u16,
            4 => self.four[index][lane] = bits as u32,
            _ => self.eight[index][lane] = bits,
        }
    }

    /// Sets the value of all lanes.
    pub(super) fn fill(&mut self, column: Column, bits: u64) {
        #[expect(clippy::allow_attributes, reason = "the lint below fires for the narrow widths only")]
        #[allow(clippy::cast_possible_truncation, reason = "the low bits are the value")]
        {
            by_width!(self, column.ty, |of: T| of[column.index as usize] = [bits as T; LANES]);
        }
    }

    fn read(&self, words: &[Word], place: Place, lane: usize) -> u64 {
        match place {
            Place::Word(word) => u64::from(words[word as usize].get(lane)),
            Place::Column(column) => self.get(column, lane),
        }
    }

    fn write(&mut self, words: &mut [Word], place: Place, lane: usize, bits: u64) {
        match place {
            Place::Word(word) => words[word as usize].set(lane, bits != 0),
            Place::Column(column) => self.set(column, lane, bits),
        }
    }

    /// Executes a step in all lanes.
    pub(super) fn execute(&mut self, step: &Step, words: &mut [Word], now: i64) {
        match *step {
            Step::Copy { to, from } => {
                by_width!(self, to.ty, |of: T| {
                    let from: [T; LANES] = of[from.index as usize];
                    of[to.index as usize] = from;
                });
            }
            Step::Now { to } => self.fill(to, now.cast_unsigned()),
            Step::Unary { op, to, a } => self.unary(op, to, a),
            Step::Binary { op, to, a, b } => self.binary(op, to, a, b),
            Step::Compare { op, to, a, b } => words[to as usize] = self.compare(op, a, b),
            Step::Select { to, condition, a, b } => self.select(to, words[condition as usize], a, b),
            Step::Convert { to, from } => self.convert(words, to, from),
            Step::Call { helper, to, a, b } => {
                for lane in 0..LANES {
                    let b = b.map(|b| self.get(b, lane));
                    let bits = evaluate::call(helper, to.ty, self.get(a, lane), b);
                    self.set(to, lane, bits);
                }
            }
            Step::LoadIndexed { to, from, index } => {
                for lane in 0..LANES {
                    let element = evaluate::element(from.count, self.get(index, lane));
                    let bits = element.map_or(0, |element| self.read(words, from.element(element), lane));
                    self.write(words, to, lane, bits);
                }
            }
            Step::StoreIndexed { to, index, from } => {
                for lane in 0..LANES {
                    if let Some(element) = evaluate::element(to.count, self.get(index, lane)) {
                        let bits = self.read(words, from, lane);
                        self.write(words, to.element(element), lane, bits);
                    }
                }
            }
            Step::CopyArray { to, from, condition } => self.copy_array(words, to, from, words[condition as usize]),
        }
    }

    fn copy_array(&mut self, words: &mut [Word], to: Elements, from: Elements, condition: Word) {
        if condition.is_zero() {
            return;
        }
        for index in 0..to.count {
            match (to.element(index), from.element(index)) {
                (Place::Word(to), Place::Word(from)) => {
                    let (old, new) = (words[to as usize], words[from as usize]);
                    words[to as usize] = old & !condition | new & condition;
                }
                (Place::Column(to), Place::Column(from)) => self.select(to, condition, from, to),
                (Place::Word(_), Place::Column(_)) | (Place::Column(_), Place::Word(_)) => {
                    unreachable!("arrays of one type")
                }
            }
        }
    }

    /// Does a thing in each lane as [`evaluate`] says.
    fn each(&mut self, to: Column, bits: impl Fn(&Self, usize) -> u64) {
        for lane in 0..LANES {
            let bits = bits(self, lane);
            self.set(to, lane, bits);
        }
    }

    fn unary(&mut self, op: Unary, to: Column, a: Column) {
        match op {
            Unary::Not | Unary::Negate if !to.ty.is_real() => self.integer_unary(op, to, a),
            Unary::Not | Unary::Negate | Unary::Absolute | Unary::SquareRoot => {
                self.each(to, |columns, lane| evaluate::unary(op, to.ty, columns.get(a, lane)));
            }
        }
    }

    fn binary(&mut self, op: Binary, to: Column, a: Column, b: Column) {
        match op {
            Binary::And
            | Binary::Or
            | Binary::Xor
            | Binary::Add
            | Binary::Subtract
            | Binary::Multiply
            | Binary::Minimum
            | Binary::Maximum
                if !to.ty.is_real() =>
            {
                self.integer_binary(op, to, a, b);
            }
            Binary::And
            | Binary::Or
            | Binary::Xor
            | Binary::Add
            | Binary::Subtract
            | Binary::Multiply
            | Binary::Divide
            | Binary::Remainder
            | Binary::Minimum
            | Binary::Maximum
            | Binary::ShiftLeft
            | Binary::ShiftRight
            | Binary::RotateLeft
            | Binary::RotateRight => {
                self.each(to, |columns, lane| evaluate::binary(op, to.ty, columns.get(a, lane), columns.get(b, lane)));
            }
        }
    }

    fn compare(&self, op: Compare, a: Column, b: Column) -> Word {
        if !a.ty.is_real() {
            return self.integer_compare(op, a, b);
        }
        let mut word = Word::ZEROS;
        for lane in 0..LANES {
            word.set(lane, evaluate::compare(op, a.ty, self.get(a, lane), self.get(b, lane)));
        }
        word
    }

    fn select(&mut self, to: Column, condition: Word, a: Column, b: Column) {
        let condition = condition.bytes();
        by_width!(self, to.ty, |of: T| {
            let (a, b) = (&of[a.index as usize], &of[b.index as usize]);
            let mut chosen: [T; LANES] = [0; LANES];
            for lane in 0..LANES {
                // All ones where the condition holds: a loop without a choice becomes vector instructions.
                let mask = T::from(condition[lane]).wrapping_neg();
                chosen[lane] = b[lane] ^ (a[lane] ^ b[lane]) & mask;
            }
            of[to.index as usize] = chosen;
        });
    }

    fn convert(&mut self, words: &mut [Word], to: Place, from: Place) {
        match (to, from) {
            (Place::Column(to), Place::Column(from)) if !to.ty.is_real() && !from.ty.is_real() => {
                self.integer_convert(to, from);
            }
            (Place::Column(to), Place::Word(word)) => {
                let [zero, one] = [0, 1].map(|bits| evaluate::convert(Elementary::Bool, to.ty, bits));
                let word = words[word as usize];
                self.each(to, |_, lane| if word.get(lane) { one } else { zero });
            }
            (Place::Column(to), Place::Column(from)) => {
                self.each(to, |columns, lane| evaluate::convert(from.ty, to.ty, columns.get(from, lane)));
            }
            (Place::Word(to), Place::Column(from)) => {
                let mut word = Word::ZEROS;
                for lane in 0..LANES {
                    word.set(lane, evaluate::convert(from.ty, Elementary::Bool, self.get(from, lane)) != 0);
                }
                words[to as usize] = word;
            }
            (Place::Word(to), Place::Word(from)) => words[to as usize] = words[from as usize],
        }
    }
}
