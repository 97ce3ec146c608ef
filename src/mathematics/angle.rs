//! Sine, cosine and tangent.
//!
//! An angle is reduced to a number of right angles and a rest, exactly as far as that matters: its 53 bits are multiplied as
//! an integer with those bits of 2/pi that neither give whole turns nor are too small to count (Payne and Hanek, 1983). So a
//! huge angle is as good as a small one, and takes as long.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};

use super::{Arithmetic, FRACTION, NAN, SIGN, bit, cut, polynomial, sign, turned};

/// The bits of 2/pi behind the point, after 64 zeros.
const TWO_PER_PI: [u64; 20] = [
    0x0000_0000_0000_0000,
    0xA2F9_836E_4E44_1529,
    0xFC27_57D1_F534_DDC0,
    0xDB62_9599_3C43_9041,
    0xFE51_63AB_DEBB_C561,
    0xB724_6E3A_424D_D2E0,
    0x0649_2EEA_09D1_921C,
    0xFE1D_EB1C_B129_A73E,
    0xE882_35F5_2EBB_4484,
    0xE99C_7026_B45F_7E41,
    0x3991_D639_8353_39F4,
    0x9C84_5F8B_BDF9_283B,
    0x1FF8_97FF_DE05_980F,
    0xEF2F_118B_5A0A_6D1F,
    0x6D36_7ECF_27CB_09B7,
    0x4F46_3F66_9E5F_EA2D,
    0x7527_BAC7_EBE5_F17B,
    0x3D07_39F7_8A52_92EA,
    0x6BFB_5FB1_1F8D_5D08,
    0x5603_3046_FC7B_6BAB,
];
/// The exponent, with its bias, of an LREAL for which the bits that count start at the first of the table: those before would
/// give multiples of four right angles.
const FIRST_EXPONENT: u64 = 1013;
/// pi/2 and pi/4.
const HALF_PI: [f64; 2] = [FRAC_PI_2, 6.123_233_995_736_766e-17];
const QUARTER_PI: [f64; 2] = [FRAC_PI_4, 3.061_616_997_868_383e-17];
/// pi/2 in two parts of at most 27 bits each, which together are the first of [`HALF_PI`].
const HALF_PI_PARTS: [f64; 2] = [1.570_796_310_901_641_8, 1.589_325_471_229_585_7e-8];

/// An angle from 0 on.
struct Reduced<A: Arithmetic> {
    /// How many right angles it is, to the nearest; the two lowest bits count.
    right_angles: A::Word,
    /// The magnitude of the rest, in radians, from 0 to pi/4, in two parts.
    high: A::Real,
    low: A::Real,
    /// The sign of the rest.
    sign: A::Word,
}

#[inline(always)]
fn reduced<A: Arithmetic>(m: A, size: A::Real) -> Reduced<A> {
    let large = m.at_most(m.real(QUARTER_PI[0]), size);
    if m.is_known(!large) {
        return Reduced { right_angles: m.word(0), high: size, low: m.real(0.0), sign: m.word(0) };
    }
    let bits = m.bits(size);
    let integer = (bits & m.word(FRACTION)) | m.word(FRACTION + 1);
    let position = m.down(bits, m.word(52)) - m.word(FIRST_EXPONENT);
    let (right_angles, rest) = multiplied(m, integer, window(m, position));
    // The magnitude of the rest; a complement is one less, of 2^128.
    let mask = m.word(0) - m.down(rest[0], m.word(63));
    let (high, low) = radians(m, rest.map(|word| word ^ mask));
    let negative = mask & m.word(SIGN);
    Reduced {
        right_angles: m.choose_word(large, right_angles, m.word(0)),
        high: m.choose(large, high, size),
        low: m.choose(large, low, m.real(0.0)),
        sign: m.choose_word(large, negative, m.word(0)),
    }
}

/// 192 bits of the table from a position on, the highest first. Any position is allowed, but only up to 1087 it counts.
#[inline(always)]
fn window<A: Arithmetic>(m: A, position: A::Word) -> [A::Word; 3] {
    // Four words from that on which the upper bits of the position name: by each of these bits in turn, the highest first,
    // all words move by its weight or stay. At every step only so many count as the steps behind it can reach.
    let mut words = TWO_PER_PI.map(|word| m.word(word));
    for (place, count) in [(10, 19), (9, 11), (8, 7), (7, 5), (6, 4)] {
        let moves = bit(m, position, place);
        let by = 1 << (place - 6);
        for index in 0..count {
            if index + by < words.len() {
                words[index] = m.choose_word(moves, words[index + by], words[index]);
            }
        }
    }
    let within = position & m.word(63);
    let rest = m.word(63) - within;
    [0, 1, 2].map(|index| m.up(words[index], within) | m.down(m.down(words[index + 1], m.word(1)), rest))
}

/// The 128 bits of a product of a word and one below 2^53, the upper half first.
#[inline(always)]
fn product<A: Arithmetic>(m: A, a: A::Word, b: A::Word) -> [A::Word; 2] {
    let half = m.word(32);
    let low = |word: A::Word| word & m.word(0xFFFF_FFFF);
    let (a_high, a_low) = (m.down(a, half), low(a));
    let (b_high, b_low) = (m.down(b, half), low(b));
    let middle = m.down(a_low * b_low, half) + low(a_high * b_low) + a_low * b_high;
    [a_high * b_high + m.down(a_high * b_low, half) + m.down(middle, half), a * b]
}

/// The right angles, to the nearest, and what is left, a signed fraction of one, in 128 bits.
#[inline(always)]
fn multiplied<A: Arithmetic>(m: A, integer: A::Word, window: [A::Word; 3]) -> (A::Word, [A::Word; 2]) {
    // Of the lowest 64 bits only what they carry upwards counts: the rest is at least some 2^-62 of a right angle.
    let [carried, _] = product(m, window[2], integer);
    let [upper, lower] = product(m, window[1], integer);
    let low = lower + carried;
    let carry = m.choose_word(m.below(low, lower), m.word(1), m.word(0));
    let high = window[0] * integer + upper + carry;
    let right_angles = m.down(high + m.word(1 << 61), m.word(62));
    let two = m.word(2);
    (right_angles, [m.up(high, two) | m.down(low, m.word(62)), m.up(low, two)])
}

/// A fraction of a right angle in radians, in two parts.
#[inline(always)]
fn radians<A: Arithmetic>(m: A, fraction: [A::Word; 2]) -> (A::Real, A::Real) {
    // Four numbers that are exact, added from the least on, and what each sum loses.
    let upper = |word: A::Word| m.number(m.down(word, m.word(32)));
    let lower = |word: A::Word| m.number(word & m.word(0xFFFF_FFFF));
    let power = |exponent: i32| 2.0_f64.powi(exponent);
    let sum = |large: A::Real, small: A::Real| {
        let sum = large + small;
        (sum, small - (sum - large))
    };
    let (third, lost_3) = sum(upper(fraction[1]) * power(-96), lower(fraction[1]) * power(-128));
    let (second, lost_2) = sum(lower(fraction[0]) * power(-64), third);
    let (first, lost_1) = sum(upper(fraction[0]) * power(-32), second);
    let (high, low) = sum(first, lost_1 + (lost_2 + lost_3));

    // Times pi/2: the product of the upper parts without loss, all others rounded.
    let rounded = high * HALF_PI[0];
    let high_cut = cut(m, high);
    let high_rest = high - high_cut;
    let lost = (((high_cut * HALF_PI_PARTS[0] - rounded) + high_cut * HALF_PI_PARTS[1]) + high_rest * HALF_PI_PARTS[0])
        + high_rest * HALF_PI_PARTS[1];
    sum(rounded, lost + (high * HALF_PI[1] + low * HALF_PI[0]))
}

const SINE: [f64; 5] = [
    8.333_333_333_322_49e-3,
    -1.984_126_982_985_795e-4,
    2.755_731_370_707_006_8e-6,
    -2.505_076_025_340_686_3e-8,
    1.589_690_995_211_55e-10,
];
const SINE_THIRD: f64 = -1.666_666_666_666_663_2e-1;
const COSINE: [f64; 6] = [
    4.166_666_666_666_66e-2,
    -1.388_888_888_887_411e-3,
    2.480_158_728_947_673e-5,
    -2.755_731_435_139_066_3e-7,
    2.087_572_321_298_175e-9,
    -1.135_964_755_778_819_5e-11,
];

/// The sine of an angle in two parts, from 0 to pi/4.
#[inline(always)]
fn short_sine<A: Arithmetic>(m: A, x: A::Real, low: A::Real) -> A::Real {
    let square = x * x;
    let cube = square * x;
    let series = polynomial(m, square, &SINE);
    x - ((square * (low * 0.5 - cube * series) - low) - cube * SINE_THIRD)
}

/// The cosine of an angle in two parts, from 0 to pi/4.
#[inline(always)]
fn short_cosine<A: Arithmetic>(m: A, x: A::Real, low: A::Real) -> A::Real {
    let square = x * x;
    let series = square * polynomial(m, square, &COSINE);
    let half = square * 0.5;
    let first = m.real(1.0) - half;
    first + (((m.real(1.0) - first) - half) + (square * series - x * low))
}

/// (tan x - x - x^3 / 3) / x^5 is the first polynomial of x^4, plus x^2 times the second.
const TANGENT_THIRD: f64 = 3.333_333_333_333_341e-1;
const TANGENT_EVEN: [f64; 6] = [
    1.333_333_333_332_012_4e-1,
    2.186_948_829_485_954_2e-2,
    3.592_079_107_591_312_4e-3,
    5.880_412_408_202_641e-4,
    7.817_944_429_395_571e-5,
    -1.855_863_748_552_754_6e-5,
];
const TANGENT_ODD: [f64; 6] = [
    5.396_825_397_622_605e-2,
    8.863_239_823_599_3e-3,
    1.456_209_454_325_290_3e-3,
    2.464_631_348_184_699e-4,
    7.140_724_913_826_082e-5,
    2.590_730_518_636_337e-5,
];
/// From here on the tangent is computed from that of pi/4 less the angle.
const NEAR_QUARTER: f64 = f64::from_bits(0x3FE5_9428_0000_0000);

/// The tangent of an angle in two parts, from 0 to pi/4; or else -1 divided by it.
#[inline(always)]
fn short_tangent<A: Arithmetic>(m: A, x: A::Real, low: A::Real, inverse: A::Flag) -> A::Real {
    let near = m.at_most(m.real(NEAR_QUARTER), x);
    let complement = (m.real(QUARTER_PI[0]) - x) + (m.real(QUARTER_PI[1]) - low);
    let (x, low) = (m.choose(near, complement, x), m.choose(near, m.real(0.0), low));
    let square = x * x;
    let fourth = square * square;
    let series = polynomial(m, fourth, &TANGENT_EVEN) + square * polynomial(m, fourth, &TANGENT_ODD);
    let cube = square * x;
    let rest = (low + square * (cube * series + low)) + cube * TANGENT_THIRD;
    let tangent = x + rest;

    let one = m.choose(inverse, m.real(-1.0), m.real(1.0));
    let difference = x + (rest - tangent * tangent / (tangent + one));
    let of_complement = one - (difference + difference);

    // To more bits than one division gives.
    let tangent_high = cut(m, tangent);
    let tangent_low = rest - (tangent_high - x);
    let quotient = m.real(-1.0) / tangent;
    let high = cut(m, quotient);
    let inverted = high + quotient * ((high * tangent_high + 1.0) + high * tangent_low);
    m.choose(near, of_complement, m.choose(inverse, inverted, tangent))
}

/// The value where `size` is finite, else NaN.
#[inline(always)]
fn if_finite<A: Arithmetic>(m: A, size: A::Real, value: A::Real) -> A::Real {
    m.choose(m.less(size, m.real(f64::INFINITY)), value, m.real(NAN))
}

/// The sine of `x`, in radians.
#[inline(always)]
pub fn sin<A: Arithmetic>(m: A, x: A::Real) -> A::Real {
    let size = m.magnitude(x);
    let angle = reduced(m, size);
    let odd = bit(m, angle.right_angles, 0);
    let value = m.choose(odd, short_cosine(m, angle.high, angle.low), short_sine(m, angle.high, angle.low));
    let half_turn = m.up(angle.right_angles & m.word(2), m.word(62));
    let sign = sign(m, x) ^ half_turn ^ m.choose_word(odd, m.word(0), angle.sign);
    if_finite(m, size, turned(m, value, sign))
}

/// The cosine of `x`, in radians.
#[inline(always)]
pub fn cos<A: Arithmetic>(m: A, x: A::Real) -> A::Real {
    let size = m.magnitude(x);
    let angle = reduced(m, size);
    let odd = bit(m, angle.right_angles, 0);
    let value = m.choose(odd, short_sine(m, angle.high, angle.low), short_cosine(m, angle.high, angle.low));
    let half_turn = m.up((angle.right_angles + m.word(1)) & m.word(2), m.word(62));
    let sign = half_turn ^ m.choose_word(odd, angle.sign, m.word(0));
    if_finite(m, size, turned(m, value, sign))
}

/// The tangent of `x`, in radians.
#[inline(always)]
pub fn tan<A: Arithmetic>(m: A, x: A::Real) -> A::Real {
    let size = m.magnitude(x);
    let angle = reduced(m, size);
    let odd = bit(m, angle.right_angles, 0);
    let value = short_tangent(m, angle.high, angle.low, odd);
    if_finite(m, size, turned(m, value, sign(m, x) ^ angle.sign))
}
