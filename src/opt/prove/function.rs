//! Functions that are not taken apart: products, quotients, whatever computes with REALs, elements of long arrays.
//!
//! Of them it is known only that equal operands give equal results. On sample images they are computed, so that what they
//! feed has the values there that it has in a scan.

use super::graph::Literal;
use super::word::Word;
use crate::elementary::Elementary;
use crate::logic::{Binary, Compare, Helper, Unary, evaluate};

/// A function.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub(super) enum Function {
    /// The product of two signed numbers of any width, of which the low 64 bits can be had.
    Product,
    /// The quotient of two numbers without a sign, cut; by zero it is 0.
    Quotient,
    Unary(Unary, Elementary),
    Binary(Binary, Elementary),
    Compare(Compare, Elementary),
    /// From a REAL or LREAL.
    Convert(Elementary, Elementary),
    /// From a signed number of any width.
    ToReal(Elementary),
    Call(Helper, Elementary),
    /// An element of an array with these contents, by their number.
    Element(u32),
}

/// A function with its operands.
#[derive(Clone, PartialEq, Eq, Hash, Debug)]
pub(super) struct Application {
    pub(super) function: Function,
    pub(super) operands: Vec<Word>,
}

impl Application {
    /// The same as it is written for comparison.
    pub(super) fn new(function: Function, mut operands: Vec<Word>) -> Self {
        if function.commutes() {
            operands.sort_unstable();
        }
        Self { function, operands }
    }

    /// The low bits of the result, if the operands are known and so is what it is of them.
    pub(super) fn constant(&self) -> Option<u64> {
        let known = self.operands.iter().flatten().all(|bit| bit.as_constant().is_some());
        let is_told = !matches!(self.function, Function::Element(_));
        (known && is_told).then(|| self.samples(|bit| if bit == Literal::TRUE { u64::MAX } else { 0 })[0])
    }

    /// The result on 64 samples, given the values of a literal on them.
    pub(super) fn samples(&self, value: impl Fn(Literal) -> u64) -> [u64; 64] {
        let operands: Vec<(usize, Vec<u64>)> =
            self.operands.iter().map(|word| (word.len(), word.iter().map(|bit| value(*bit)).collect())).collect();
        std::array::from_fn(|lane| {
            let of = |place: usize| {
                operands.get(place).map_or((0, 0), |(width, bits)| {
                    let number = bits
                        .iter()
                        .enumerate()
                        .fold(0u128, |number, (bit, lanes)| number | u128::from(lanes >> lane & 1) << bit);
                    (*width, number)
                })
            };
            self.function.evaluate(of(0), of(1), self.operands.len())
        })
    }
}

impl Function {
    fn commutes(self) -> bool {
        match self {
            Self::Product => true,
            Self::Binary(op, _) => matches!(op, Binary::Add | Binary::Multiply),
            Self::Compare(op, _) => matches!(op, Compare::Equal | Compare::NotEqual),
            Self::Quotient
            | Self::Unary(..)
            | Self::Convert(..)
            | Self::ToReal(_)
            | Self::Call(..)
            | Self::Element(_) => false,
        }
    }

    /// The bits of the result for operands of so many bits.
    fn evaluate(self, a: (usize, u128), b: (usize, u128), operands: usize) -> u64 {
        match self {
            Self::Product => low(signed(a).wrapping_mul(signed(b))),
            Self::Quotient => low(a.1.checked_div(b.1).unwrap_or(0).cast_signed()),
            Self::Unary(op, ty) => evaluate::unary(op, ty, low(a.1.cast_signed())),
            Self::Binary(op, ty) => evaluate::binary(op, ty, low(a.1.cast_signed()), low(b.1.cast_signed())),
            Self::Compare(op, ty) => {
                u64::from(evaluate::compare(op, ty, low(a.1.cast_signed()), low(b.1.cast_signed())))
            }
            Self::Convert(from, to) => evaluate::convert(from, to, low(a.1.cast_signed())),
            Self::ToReal(to) => {
                // The longest is a ULINT with a sign: by way of that where it is none of the signed ones.
                let (number, least) = (signed(a), i128::from(i64::MIN));
                let from = if number >= least && number <= -1 { Elementary::Lint } else { Elementary::Ulint };
                evaluate::convert(from, to, low(number))
            }
            Self::Call(helper, ty) => {
                let b = (operands > 1).then(|| low(b.1.cast_signed()));
                evaluate::call(helper, ty, low(a.1.cast_signed()), b)
            }
            // Any number, but always the same one.
            Self::Element(contents) => {
                let mixed = (low(a.1.cast_signed()) ^ u64::from(contents) << 40).wrapping_mul(0x9E37_79B9_7F4A_7C15);
                mixed ^ mixed >> 29
            }
        }
    }
}

/// The low 64 bits.
fn low(number: i128) -> u64 {
    #[expect(clippy::cast_possible_truncation, reason = "the low bits are wanted")]
    let low = number.cast_unsigned() as u64;
    low
}

/// The number of a signed word.
fn signed((width, bits): (usize, u128)) -> i128 {
    let unused = 128 - u32::try_from(width.clamp(1, 128)).unwrap_or(128);
    (bits << unused).cast_signed() >> unused
}
