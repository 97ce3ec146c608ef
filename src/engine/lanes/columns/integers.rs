//! The common operations on integers, bit strings and TIME, as loops over all lanes that become vector instructions.
//!
//! The bits of a value in a column are the low bits of its register form, so that sums, differences, products and
//! bitwise operations of the two forms have the same low bits; only where signs count are they told apart.

use super::{Column, Columns, by_width};
use crate::engine::lanes::LANES;
use crate::engine::lanes::word::Word;
use crate::logic::{Binary, Compare, Unary};

/// The signed type of a width.
trait Signed {
    type Of: Ord + Copy;
    fn signed(self) -> Self::Of;
}

macro_rules! signed {
    ($($of:ty: $signed:ty),*) => {$(
        impl Signed for $of {
            type Of = $signed;
            #[inline(always)]
            fn signed(self) -> $signed {
                self.cast_signed()
            }
        }
    )*};
}
signed!(u8: i8, u16: i16, u32: i32, u64: i64);

#[inline(always)]
fn zip<T: Copy + Default>(a: &[T; LANES], b: &[T; LANES], each: impl Fn(T, T) -> T) -> [T; LANES] {
    let mut made = [T::default(); LANES];
    for lane in 0..LANES {
        made[lane] = each(a[lane], b[lane]);
    }
    made
}

#[inline(always)]
fn question<T: Copy>(a: &[T; LANES], b: &[T; LANES], each: impl Fn(T, T) -> bool) -> Word {
    let mut bytes = [0; LANES];
    for lane in 0..LANES {
        bytes[lane] = u8::from(each(a[lane], b[lane]));
    }
    Word::of_bytes(&bytes)
}

#[inline(always)]
fn compared<T: Ord + Copy>(op: Compare, a: &[T; LANES], b: &[T; LANES]) -> Word {
    match op {
        Compare::Equal => question(a, b, |a, b| a == b),
        Compare::NotEqual => question(a, b, |a, b| a != b),
        Compare::Less => question(a, b, |a, b| a < b),
        Compare::LessOrEqual => question(a, b, |a, b| a <= b),
        Compare::Greater => question(a, b, |a, b| a > b),
        Compare::GreaterOrEqual => question(a, b, |a, b| a >= b),
    }
}

impl Columns {
    pub(super) fn integer_unary(&mut self, op: Unary, to: Column, a: Column) {
        by_width!(self, to.ty, |of: T| {
            let mut made: [T; LANES] = of[a.index as usize];
            match op {
                Unary::Not => made.iter_mut().for_each(|value| *value = !*value),
                Unary::Negate => made.iter_mut().for_each(|value| *value = value.wrapping_neg()),
                Unary::Absolute | Unary::SquareRoot => unreachable!("done lane by lane"),
            }
            of[to.index as usize] = made;
        });
    }

    pub(super) fn integer_binary(&mut self, op: Binary, to: Column, a: Column, b: Column) {
        let signed = to.ty.is_signed();
        by_width!(self, to.ty, |of: T| {
            let (a, b) = (&of[a.index as usize], &of[b.index as usize]);
            let made: [T; LANES] = match op {
                Binary::And => zip(a, b, |a, b| a & b),
                Binary::Or => zip(a, b, |a, b| a | b),
                Binary::Xor => zip(a, b, |a, b| a ^ b),
                Binary::Add => zip(a, b, T::wrapping_add),
                Binary::Subtract => zip(a, b, T::wrapping_sub),
                Binary::Multiply => zip(a, b, T::wrapping_mul),
                Binary::Minimum if signed => zip(a, b, |a, b| if a.signed() < b.signed() { a } else { b }),
                Binary::Minimum => zip(a, b, |a, b| if a < b { a } else { b }),
                Binary::Maximum if signed => zip(a, b, |a, b| if a.signed() < b.signed() { b } else { a }),
                Binary::Maximum => zip(a, b, |a, b| if a < b { b } else { a }),
                Binary::Divide
                | Binary::Remainder
                | Binary::ShiftLeft
                | Binary::ShiftRight
                | Binary::RotateLeft
                | Binary::RotateRight => unreachable!("done lane by lane"),
            };
            of[to.index as usize] = made;
        });
    }

    pub(super) fn integer_compare(&self, op: Compare, a: Column, b: Column) -> Word {
        /// Two columns of one width, compared with their signs or without.
        #[inline(always)]
        fn of<T: Ord + Copy + Signed>(op: Compare, signed: bool, a: &[T; LANES], b: &[T; LANES]) -> Word {
            if signed { compared(op, &a.map(T::signed), &b.map(T::signed)) } else { compared(op, a, b) }
        }
        let (signed, left, right) = (a.ty.is_signed(), a.index as usize, b.index as usize);
        match a.ty.size() {
            1 => of(op, signed, &self.one[left], &self.one[right]),
            2 => of(op, signed, &self.two[left], &self.two[right]),
            4 => of(op, signed, &self.four[left], &self.four[right]),
            _ => of(op, signed, &self.eight[left], &self.eight[right]),
        }
    }

    /// Between integers, bit strings and TIME: the low bits, extended by the sign of the type that they come from.
    pub(super) fn integer_convert(&mut self, to: Column, from: Column) {
        let mut wide = [0; LANES];
        let signed = from.ty.is_signed();
        by_width!(self, from.ty, |of: T| {
            let values: &[T; LANES] = &of[from.index as usize];
            #[expect(clippy::allow_attributes, reason = "the lint below fires for the widest only")]
            #[allow(clippy::useless_conversion, reason = "one text for all widths")]
            if signed {
                for lane in 0..LANES {
                    wide[lane] = i64::from(values[lane].signed()).cast_unsigned();
                }
            } else {
                for lane in 0..LANES {
                    wide[lane] = u64::from(values[lane]);
                }
            }
        });
        by_width!(self, to.ty, |of: T| {
            let values: &mut [T; LANES] = &mut of[to.index as usize];
            for lane in 0..LANES {
                #[expect(clippy::allow_attributes, reason = "the lint below fires for the narrow widths only")]
                #[allow(clippy::cast_possible_truncation, reason = "the low bits are the value")]
                let narrow = wide[lane] as T;
                values[lane] = narrow;
            }
        });
    }
}
