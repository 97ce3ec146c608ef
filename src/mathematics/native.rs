//! Computing with the machine's own numbers.
//!
//! Rust never fuses or reorders operations on `f64`, and the root is IEEE 754's; so these are the operations of logic,
//! but for the bits of a NaN.

use std::num::Wrapping;

use super::{Arithmetic, BitWord, RealNumber, TruthValue};

/// The arithmetic of this machine.
#[derive(Clone, Copy, Debug)]
pub struct Native;

impl RealNumber for f64 {}
impl BitWord for Wrapping<u64> {}
impl TruthValue for bool {}

impl Arithmetic for Native {
    type Real = f64;
    type Word = Wrapping<u64>;
    type Flag = bool;

    #[inline(always)]
    fn real(self, value: f64) -> f64 {
        value
    }

    #[inline(always)]
    fn word(self, value: u64) -> Wrapping<u64> {
        Wrapping(value)
    }

    #[inline(always)]
    fn root(self, a: f64) -> f64 {
        a.sqrt()
    }

    #[inline(always)]
    fn magnitude(self, a: f64) -> f64 {
        a.abs()
    }

    #[inline(always)]
    fn bits(self, a: f64) -> Wrapping<u64> {
        Wrapping(a.to_bits())
    }

    #[inline(always)]
    fn of_bits(self, a: Wrapping<u64>) -> f64 {
        f64::from_bits(a.0)
    }

    #[inline(always)]
    fn number(self, a: Wrapping<u64>) -> f64 {
        #[expect(clippy::cast_precision_loss, reason = "rounding to nearest is the meaning")]
        let number = a.0.cast_signed() as f64;
        number
    }

    #[inline(always)]
    fn less(self, a: f64, b: f64) -> bool {
        a < b
    }

    #[inline(always)]
    fn at_most(self, a: f64, b: f64) -> bool {
        a <= b
    }

    #[inline(always)]
    fn equal(self, a: f64, b: f64) -> bool {
        a == b
    }

    #[inline(always)]
    fn below(self, a: Wrapping<u64>, b: Wrapping<u64>) -> bool {
        a < b
    }

    #[inline(always)]
    fn is_known(self, a: bool) -> bool {
        a
    }

    #[inline(always)]
    fn any(self, a: Wrapping<u64>) -> bool {
        a.0 != 0
    }

    #[inline(always)]
    fn choose(self, condition: bool, a: f64, b: f64) -> f64 {
        if condition { a } else { b }
    }

    #[inline(always)]
    fn choose_word(self, condition: bool, a: Wrapping<u64>, b: Wrapping<u64>) -> Wrapping<u64> {
        if condition { a } else { b }
    }

    #[inline(always)]
    fn up(self, a: Wrapping<u64>, amount: Wrapping<u64>) -> Wrapping<u64> {
        Wrapping(a.0.checked_shl(low(amount)).unwrap_or(0))
    }

    #[inline(always)]
    fn down(self, a: Wrapping<u64>, amount: Wrapping<u64>) -> Wrapping<u64> {
        Wrapping(a.0.checked_shr(low(amount)).unwrap_or(0))
    }
}

#[expect(clippy::cast_possible_truncation, reason = "the low 32 bits are what counts")]
#[inline(always)]
fn low(amount: Wrapping<u64>) -> u32 {
    amount.0 as u32
}
