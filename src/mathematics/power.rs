//! Powers: the logarithm to base 2 in two parts, of some 70 bits, times the exponent, and 2 to the power of that.

use std::f64::consts::LN_2;

use super::exponential::QUOTIENT;
use super::{Arithmetic, FRACTION, LEAST_NORMAL, NAN, RAISE, RAISED_BY, cut, polynomial, scaled, sign, turned, whole};

/// The logarithm to base 2 of 1.5.
const LOG_1_5: [f64; 2] = [5.849_624_872_207_642e-1, 1.350_039_202_129_749e-8];
/// ln 2 in two parts, of which the first has half of the bits.
const LN_2_PARTS: [f64; 2] = [6.931_471_824_645_996e-1, -1.904_654_299_957_768e-9];
/// 2 / (3 ln 2), to nearest, and in two parts.
const FACTOR: f64 = 9.617_966_939_259_756e-1;
const FACTOR_PARTS: [f64; 2] = [9.617_967_009_544_373e-1, -7.028_461_650_952_758e-9];
/// 3/2 (ln(a) - 2 s - 2 s^3 / 3) / s^5 as a polynomial of s^2, where s = (a - 1) / (a + 1).
const SERIES: [f64; 6] = [
    5.999_999_999_999_946e-1,
    4.285_714_285_785_502e-1,
    3.333_333_298_183_774_3e-1,
    2.727_281_238_085_34e-1,
    2.306_607_457_755_617_5e-1,
    2.069_750_178_003_384_2e-1,
];
/// sqrt(3/2) and sqrt(3), about: where the fraction is measured from 1.5, and where from 2.
const FROM_1_5: f64 = 1.224_744_871_391_589;
const FROM_2: f64 = 1.732_050_807_568_877_2;
/// A power of any other base than 1 with this exponent is 0 or infinite, as with any above.
const LARGE: f64 = 7.378_697_629_483_821e19;
/// 2 to the power of this is infinite, and to that of its negative 0.
const BEYOND: f64 = 1100.0;
/// From here on numbers are whole, and twice as far even.
const ALL_WHOLE: f64 = 4.503_599_627_370_496e15;

/// The logarithm to base 2 of a number above 0, in two parts, of which the first has half of the bits.
#[inline(always)]
fn log2<A: Arithmetic>(m: A, x: A::Real) -> (A::Real, A::Real) {
    let small = m.less(x, m.real(LEAST_NORMAL));
    let bits = m.bits(m.choose(small, x * RAISE, x));
    let fraction = m.of_bits((bits & m.word(FRACTION)) | m.word(1.0_f64.to_bits()));
    let from_2 = m.at_most(m.real(FROM_2), fraction);
    let from_1_5 = m.at_most(m.real(FROM_1_5), fraction) & !from_2;
    let bias = m.choose_word(small, m.word(1023 + RAISED_BY), m.word(1023));
    let exponent = m.number(m.down(bits, m.word(52)) - bias) + m.choose(from_2, m.real(1.0), m.real(0.0));
    let a = m.choose(from_2, fraction * 0.5, fraction);
    let from = m.choose(from_1_5, m.real(1.5), m.real(1.0));
    let from_log = LOG_1_5.map(|part| m.choose(from_1_5, m.real(part), m.real(0.0)));

    // s = (a - from) / (a + from) in two parts.
    let (above, below) = (a - from, a + from);
    let per = m.real(1.0) / below;
    let s = above * per;
    let s_high = cut(m, s);
    let below_high = cut(m, below);
    let below_low = a - (below_high - from);
    let s_low = per * ((above - s_high * below_high) - s_high * below_low);

    // ln(a) = 2/3 s (3 + s^2 + series), the bracket in two parts.
    let square = s * s;
    let series = square * square * polynomial(m, square, &SERIES) + s_low * (s_high + s);
    let square_high = s_high * s_high;
    let bracket_high = cut(m, (square_high + 3.0) + series);
    let bracket_low = series - ((bracket_high - 3.0) - square_high);
    let (u, v) = (s_high * bracket_high, s_low * bracket_high + bracket_low * s);
    let high = cut(m, u + v);
    let low = v - (high - u);
    let (log_high, log_low) = (high * FACTOR_PARTS[0], (high * FACTOR_PARTS[1] + low * FACTOR) + from_log[1]);
    let first = cut(m, ((log_high + log_low) + from_log[0]) + exponent);
    let second = log_low - (((first - exponent) - from_log[0]) - log_high);
    (first, second)
}

/// 2 to the power of a sum of two, of which the first is by far the larger.
#[inline(always)]
fn exp2<A: Arithmetic>(m: A, high: A::Real, low: A::Real) -> A::Real {
    let sum = low + high;
    let beyond = m.less(m.real(BEYOND), m.magnitude(sum));
    let end = m.choose(m.less(sum, m.real(0.0)), m.real(-BEYOND), m.real(BEYOND));
    let high = m.choose(beyond, end, high);
    let low = m.choose(beyond, m.real(0.0), low);
    let (turns, exponent) = whole(m, m.choose(beyond, end, sum));
    let high = high - turns;
    let first = cut(m, low + high);
    let u = first * LN_2_PARTS[0];
    let v = (low - (first - high)) * LN_2 + first * LN_2_PARTS[1];
    let z = u + v;
    let w = v - (z - u);
    let square = z * z;
    let c = z - square * polynomial(m, square, &QUOTIENT);
    let r = (z * c) / (c - 2.0) - (w + z * w);
    scaled(m, m.real(1.0) - (r - z), exponent)
}

/// `x` to the power of `y`.
#[inline(always)]
pub fn pow<A: Arithmetic>(m: A, x: A::Real, y: A::Real) -> A::Real {
    let (zero, one, infinity) = (m.real(0.0), m.real(1.0), m.real(f64::INFINITY));
    let (base, size) = (m.magnitude(x), m.magnitude(y));
    let (log_high, log_low) = log2(m, base);
    let held = turned(m, m.choose(m.less(size, m.real(LARGE)), size, m.real(LARGE)), sign(m, y));
    let held_high = cut(m, held);
    let value = exp2(m, held_high * log_high, (held - held_high) * log_high + held * log_low);

    // Exponents for which there is a better way; what a negative number changes comes below.
    let short = |exponent: f64, short: A::Real, value: A::Real| m.choose(m.equal(y, m.real(exponent)), short, value);
    let value = short(0.5, m.root(base), value);
    let value = short(2.0, base * base, value);
    let value = short(1.0, base, value);
    let value = short(-1.0, one / base, value);

    // Of 0 and infinity.
    let shrinks = m.less(y, zero);
    let is_zero = m.equal(base, zero);
    let edge = m.choose(is_zero ^ shrinks, zero, infinity);
    let value = m.choose(is_zero | m.equal(base, infinity), edge, value);

    // Of a negative number.
    let half = size * 0.5;
    let is_whole = m.at_most(m.real(ALL_WHOLE), size) | m.equal((size + ALL_WHOLE) - ALL_WHOLE, size);
    let half_is_whole = m.at_most(m.real(ALL_WHOLE), half) | m.equal((half + ALL_WHOLE) - ALL_WHOLE, half);
    let is_odd = is_whole & !half_is_whole;
    let value = turned(m, value, m.choose_word(is_odd, sign(m, x), m.word(0)));
    let is_none = m.less(x, zero) & m.less(base, infinity) & !is_whole;
    let is_none = is_none | !m.equal(x, x) | !m.equal(y, y);
    let value = m.choose(is_none, m.real(NAN), value);
    m.choose(m.equal(y, zero) | m.equal(x, one), one, value)
}
