//! Logarithms: x = 2^k (1 + f) with 1 + f from sqrt(1/2) to sqrt(2), and ln(1 + f) by way of s = f / (2 + f), of which it is
//! 2 s + 2 s^3 / 3 + ...

use super::{Arithmetic, FRACTION, LEAST_NORMAL, NAN, RAISE, RAISED_BY, cut, polynomial};

/// ln 2, of which the upper part times any exponent is exact.
const LN_2: [f64; 2] = [6.931_471_803_691_238e-1, 1.908_214_929_270_587_7e-10];
/// 1 / ln 10.
const PER_LN_10: [f64; 2] = [4.342_944_818_781_689e-1, 2.508_294_671_164_527_5e-11];
/// log 2 to base 10.
const LOG_2: [f64; 2] = [3.010_299_956_636_117_7e-1, 3.694_239_077_158_931e-13];
/// (ln(1 + f) - 2 s) / s is s^2 times this polynomial of s^4, plus s^4 times the next.
const ODD: [f64; 4] =
    [6.666_666_666_666_735e-1, 2.857_142_874_366_239e-1, 1.818_357_216_161_805e-1, 1.479_819_860_511_658_6e-1];
const EVEN: [f64; 3] = [3.999_999_999_940_942e-1, 2.222_219_843_214_978_4e-1, 1.531_383_769_920_937_3e-1];
/// The bits of sqrt(1/2), the upper half.
const ROOT_HALF: u64 = 0x3FE6_A09E << 32;
const ONE: u64 = 0x3FF0_0000 << 32;

/// What both logarithms start with.
struct Parts<R> {
    k: R,
    f: R,
    half_square: R,
    /// ln(1 + f) - f + f^2 / 2.
    rest: R,
}

#[inline(always)]
fn parts<A: Arithmetic>(m: A, x: A::Real) -> Parts<A::Real> {
    let small = m.less(x, m.real(LEAST_NORMAL));
    let bits = m.bits(m.choose(small, x * RAISE, x));
    let shifted = bits + m.word(ONE - ROOT_HALF);
    let bias = m.choose_word(small, m.word(1023 + RAISED_BY), m.word(1023));
    let k = m.number(m.down(shifted, m.word(52)) - bias);
    let f = m.of_bits((shifted & m.word(FRACTION)) + m.word(ROOT_HALF)) - 1.0;
    let half_square = f * f * 0.5;
    let s = f / (f + 2.0);
    let square = s * s;
    let fourth = square * square;
    let series = square * polynomial(m, fourth, &ODD) + fourth * polynomial(m, fourth, &EVEN);
    Parts { k, f, half_square, rest: s * (half_square + series) }
}

/// The value where `x` is above 0 and finite; else what a logarithm is there.
#[inline(always)]
fn with_edges<A: Arithmetic>(m: A, x: A::Real, value: A::Real) -> A::Real {
    let (zero, infinity) = (m.real(0.0), m.real(f64::INFINITY));
    let value = m.choose(m.less(x, infinity), value, infinity);
    let value = m.choose(m.equal(x, zero), m.real(f64::NEG_INFINITY), value);
    m.choose(m.at_most(zero, x), value, m.real(NAN))
}

/// The natural logarithm of `x`.
#[inline(always)]
pub fn ln<A: Arithmetic>(m: A, x: A::Real) -> A::Real {
    let Parts { k, f, half_square, rest } = parts(m, x);
    let value = k * LN_2[0] - ((half_square - (rest + k * LN_2[1])) - f);
    with_edges(m, x, value)
}

/// The logarithm of `x` to base 10. Whole where that is exact.
#[inline(always)]
pub fn log10<A: Arithmetic>(m: A, x: A::Real) -> A::Real {
    let Parts { k, f, half_square, rest } = parts(m, x);
    // ln(1 + f) in two parts, so that only the last sum rounds.
    let high = cut(m, f - half_square);
    let low = ((f - high) - half_square) + rest;
    let upper = high * PER_LN_10[0];
    let lower = k * LOG_2[1] + (low + high) * PER_LN_10[1] + low * PER_LN_10[0];
    let whole = k * LOG_2[0];
    let sum = whole + upper;
    let value = (lower + ((whole - sum) + upper)) + sum;
    with_edges(m, x, value)
}
