//! The functions that programs call and machines lack: logarithms, powers, angles.
//!
//! Each is written once, over an [`Arithmetic`]: as a straight line of total operations, of which every one is also an
//! operation of logic. Computed with [`Native`] it is a function on `f64`, for the constant folders, the interpreters
//! and compiled code; with the recorder in [`logic::mathematics`](crate::logic::mathematics) it becomes a program of
//! logic, from which any back end makes code of its own. Both give the same bits everywhere, since nothing here may
//! fuse, reorder or leave to a library what it computes; nor may it branch on data, loop without a constant bound, or
//! look anything up in memory.
//!
//! The methods and the coefficients are those of fdlibm (Sun Microsystems, 1993), with everything computed that it
//! branches between; angles are reduced in another way, see `angle`.

mod angle;
mod exponential;
mod inverse;
mod logarithm;
mod native;
mod power;

use std::ops::{Add, BitAnd, BitOr, BitXor, Div, Mul, Neg, Not, Sub};

pub use angle::{cos, sin, tan};
pub use exponential::exp;
pub use inverse::{acos, asin, atan};
pub use logarithm::{ln, log10};
pub use native::Native;
pub use power::pow;

/// An LREAL that can be computed with. Operations round to nearest, ties to even; constants may stand on the right.
pub trait RealNumber:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + Add<f64, Output = Self>
    + Sub<f64, Output = Self>
    + Mul<f64, Output = Self>
{
}

/// 64 bits that can be computed with, also as an integer that wraps around.
pub trait BitWord:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + BitAnd<Output = Self>
    + BitOr<Output = Self>
    + BitXor<Output = Self>
    + Not<Output = Self>
{
}

/// A truth value that can be computed with.
pub trait TruthValue:
    Copy + BitAnd<Output = Self> + BitOr<Output = Self> + BitXor<Output = Self> + Not<Output = Self>
{
}

/// A way to compute, or to write down what is to be computed. All operations are total.
///
/// The bits of a NaN that arithmetic made may be any: no result other than a NaN may depend on them, and a NaN that is a
/// result comes from arithmetic or is the canonical NaN, never from bits.
pub trait Arithmetic: Copy {
    /// LREALs.
    type Real: RealNumber;
    /// 64 bits: the LWORD, and the LINT with the same bits.
    type Word: BitWord;
    /// BOOLs.
    type Flag: TruthValue;

    /// A constant.
    fn real(self, value: f64) -> Self::Real;
    /// A constant.
    fn word(self, value: u64) -> Self::Word;
    /// The square root; NaN below zero.
    fn root(self, a: Self::Real) -> Self::Real;
    /// `a` without its sign.
    fn magnitude(self, a: Self::Real) -> Self::Real;
    /// The IEEE bits of a number.
    fn bits(self, a: Self::Real) -> Self::Word;
    /// The number with these IEEE bits.
    fn of_bits(self, a: Self::Word) -> Self::Real;
    /// A signed integer as the nearest number.
    fn number(self, a: Self::Word) -> Self::Real;
    /// Whether `a` < `b`; not so with a NaN.
    fn less(self, a: Self::Real, b: Self::Real) -> Self::Flag;
    /// Whether `a` <= `b`; not so with a NaN.
    fn at_most(self, a: Self::Real, b: Self::Real) -> Self::Flag;
    /// Whether `a` = `b`; not so with a NaN.
    fn equal(self, a: Self::Real, b: Self::Real) -> Self::Flag;
    /// Whether `a` < `b` as integers without a sign.
    fn below(self, a: Self::Word, b: Self::Word) -> Self::Flag;
    /// Whether a flag is known by now, and set: what does not count then may be left out. Nothing else may depend on it.
    fn is_known(self, a: Self::Flag) -> bool;
    /// Whether any bit is set.
    fn any(self, a: Self::Word) -> Self::Flag;
    /// `a` while the condition holds, else `b`.
    fn choose(self, condition: Self::Flag, a: Self::Real, b: Self::Real) -> Self::Real;
    /// `a` while the condition holds, else `b`.
    fn choose_word(self, condition: Self::Flag, a: Self::Word, b: Self::Word) -> Self::Word;
    /// Bits moved up, zeros in; 0 where the amount, of which the low 32 bits count, is 64 or more.
    fn up(self, a: Self::Word, amount: Self::Word) -> Self::Word;
    /// Bits moved down, zeros in; 0 where the amount, of which the low 32 bits count, is 64 or more.
    fn down(self, a: Self::Word, amount: Self::Word) -> Self::Word;
}

/// The bit of an LREAL that is its sign.
const SIGN: u64 = 1 << 63;
/// The bits of an LREAL that are its fraction.
const FRACTION: u64 = (1 << 52) - 1;
/// The least number whose fraction has all its bits.
const LEAST_NORMAL: f64 = f64::MIN_POSITIVE;
/// What makes every number above 0 that lacks bits one that has all.
const RAISE: f64 = (1_u64 << RAISED_BY) as f64;
/// The power of two that [`RAISE`] is.
const RAISED_BY: u64 = 54;
/// 1.5 times 2^52: a number of magnitude up to 2^51 added to it is rounded to a whole one, which the low bits show.
const WHOLE: f64 = 6_755_399_441_055_744.0;
/// The one NaN that arithmetic makes.
const NAN: f64 = f64::from_bits(0x7FF8_0000_0000_0000);

/// c0 + x (c1 + x (c2 + ...)).
#[inline(always)]
fn polynomial<A: Arithmetic, const N: usize>(m: A, x: A::Real, coefficients: &[f64; N]) -> A::Real {
    let mut sum = m.real(coefficients[N - 1]);
    for coefficient in coefficients[..N - 1].iter().rev() {
        sum = x * sum + *coefficient;
    }
    sum
}

/// The nearest whole number, as a number and as an integer. For magnitudes up to 2^51.
#[inline(always)]
fn whole<A: Arithmetic>(m: A, x: A::Real) -> (A::Real, A::Word) {
    let sum = x + WHOLE;
    (sum - WHOLE, m.bits(sum) - m.word(WHOLE.to_bits()))
}

/// A number without the lower half of its bits, so that products with another such number are exact.
#[inline(always)]
fn cut<A: Arithmetic>(m: A, x: A::Real) -> A::Real {
    m.of_bits(m.bits(x) & m.word(0xFFFF_FFFF_0000_0000))
}

/// `x` times 2 to the power of an integer from -2000 to 2000, for an `x` from 0.5 to 2; rounded once.
#[inline(always)]
fn scaled<A: Arithmetic>(m: A, x: A::Real, exponent: A::Word) -> A::Real {
    let power = |exponent: A::Word| m.of_bits(m.up(exponent + m.word(1023), m.word(52)));
    // In two steps, of which only the second can leave the range. Shifting down wants no sign.
    let half = m.down(exponent + m.word(4096), m.word(1)) - m.word(2048);
    x * power(half) * power(exponent - half)
}

/// Whether the lowest bit but `place` others is set.
#[inline(always)]
fn bit<A: Arithmetic>(m: A, word: A::Word, place: u32) -> A::Flag {
    m.any(word & m.word(1 << place))
}

/// The sign of `x` as a word that has no other bit.
#[inline(always)]
fn sign<A: Arithmetic>(m: A, x: A::Real) -> A::Word {
    m.bits(x) & m.word(SIGN)
}

/// `x` with its sign turned where the sign bit of a word is set, which has no other.
#[inline(always)]
fn turned<A: Arithmetic>(m: A, x: A::Real, sign: A::Word) -> A::Real {
    m.of_bits(m.bits(x) ^ sign)
}
