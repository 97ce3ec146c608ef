//! The angles with a given sine, cosine or tangent.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};

use super::{Arithmetic, NAN, cut, polynomial, sign, turned};

/// pi/2, pi/4.
const HALF_PI: [f64; 2] = [FRAC_PI_2, 6.123_233_995_736_766e-17];
const QUARTER_PI: f64 = FRAC_PI_4;

/// (asin x - x) / x is the quotient of these polynomials of x^2, the first times x^2, for x up to 0.5.
const ABOVE: [f64; 6] = [
    1.666_666_666_666_666_6e-1,
    -3.255_658_186_224_009e-1,
    2.012_125_321_348_629_3e-1,
    -4.005_553_450_067_941e-2,
    7.915_349_942_898_145e-4,
    3.479_331_075_960_212e-5,
];
const BELOW: [f64; 5] =
    [1.0, -2.403_394_911_734_414, 2.020_945_760_233_505_7, -6.882_839_716_054_533e-1, 7.703_815_055_590_194e-2];

/// What asin and acos share, of a magnitude from 0 to 1.
struct Arc<A: Arithmetic> {
    /// Whether the magnitude is below 0.5.
    small: A::Flag,
    /// (asin y - y) / y, where y is the magnitude or else the root.
    rest: A::Real,
    /// The sine of half the angle beside the right one, and its upper half of bits.
    root: A::Real,
    cut: A::Real,
    /// Root less its upper half, to more bits.
    low: A::Real,
}

#[inline(always)]
fn arc<A: Arithmetic>(m: A, size: A::Real) -> Arc<A> {
    let small = m.less(size, m.real(0.5));
    let square = m.choose(small, size * size, (m.real(1.0) - size) * 0.5);
    let rest = square * polynomial(m, square, &ABOVE) / polynomial(m, square, &BELOW);
    let root = m.root(square);
    let cut = cut(m, root);
    // Where the root is 0, so is what it is divided by; nowhere else do 1e-300 change it.
    let low = (square - cut * cut) / ((root + cut) + 1e-300);
    Arc { small, rest, root, cut, low }
}

/// The angle from -pi/2 to pi/2 with the sine `x`.
#[inline(always)]
pub fn asin<A: Arithmetic>(m: A, x: A::Real) -> A::Real {
    let size = m.magnitude(x);
    let Arc { small, rest, root, cut, low } = arc(m, size);
    let low_angle = size + size * rest;
    // pi/2 less twice the asin of the root; near 1, where that is small, in one part.
    let once = root + root * rest;
    let near_one = m.real(HALF_PI[0]) - ((once + once) - HALF_PI[1]);
    let twice = root + root;
    let part = twice * rest - (m.real(HALF_PI[1]) - (low + low));
    let others = m.real(QUARTER_PI) - (part - (m.real(QUARTER_PI) - (cut + cut)));
    let high_angle = m.choose(m.less(m.real(0.975), size), near_one, others);
    let value = turned(m, m.choose(small, low_angle, high_angle), sign(m, x));
    m.choose(m.at_most(size, m.real(1.0)), value, m.real(NAN))
}

/// The angle from 0 to pi with the cosine `x`.
#[inline(always)]
pub fn acos<A: Arithmetic>(m: A, x: A::Real) -> A::Real {
    let size = m.magnitude(x);
    let Arc { small, rest, root, cut, low } = arc(m, size);
    let middle = m.real(HALF_PI[0]) - (x - (m.real(HALF_PI[1]) - x * rest));
    let left = m.real(HALF_PI[0]) - (root + (rest * root - HALF_PI[1]));
    let right = cut + (rest * root + low);
    let outer = m.choose(m.less(x, m.real(0.0)), left, right);
    let value = m.choose(small, middle, outer + outer);
    m.choose(m.at_most(size, m.real(1.0)), value, m.real(NAN))
}

/// Where atan changes its way, and the angle that it takes off beyond, to two parts.
const BOUNDS: [f64; 4] = [0.4375, 0.6875, 1.1875, 2.4375];
const HIGH: [f64; 4] = [4.636_476_090_008_061e-1, FRAC_PI_4, 9.827_937_232_473_29e-1, FRAC_PI_2];
const LOW: [f64; 4] =
    [2.269_877_745_296_168_7e-17, 3.061_616_997_868_383e-17, 1.390_331_103_123_099_8e-17, 6.123_233_995_736_766e-17];
/// (t - atan t) / t is t^2 times the first polynomial of t^4, plus t^4 times the second.
const ODD: [f64; 6] = [
    3.333_333_333_333_293e-1,
    1.428_571_427_250_346_6e-1,
    9.090_887_133_436_507e-2,
    6.661_073_137_387_531e-2,
    4.976_877_994_615_932_4e-2,
    1.628_582_011_536_578_2e-2,
];
const EVEN: [f64; 5] = [
    -1.999_999_999_987_648_3e-1,
    -1.111_111_040_546_235_6e-1,
    -7.691_876_205_044_83e-2,
    -5.833_570_133_790_573_5e-2,
    -3.653_157_274_421_691_6e-2,
];

/// The angle from -pi/2 to pi/2 with the tangent `x`.
#[inline(always)]
pub fn atan<A: Arithmetic>(m: A, x: A::Real) -> A::Real {
    let size = m.magnitude(x);
    // The tangent of what is left of the angle: of none, of atan 0.5, atan 1, atan 1.5, a right one.
    let below = BOUNDS.map(|bound| m.less(size, m.real(bound)));
    let by_range = |values: [A::Real; 5]| {
        let [nearest @ .., mut chosen] = values;
        for (value, below) in nearest.into_iter().zip(below).rev() {
            chosen = m.choose(below, value, chosen);
        }
        chosen
    };
    let one = m.real(1.0);
    let above = by_range([size, (size + size) - 1.0, size - 1.0, size - 1.5, m.real(-1.0)]);
    let under = by_range([one, size + 2.0, size + 1.0, size * 1.5 + 1.0, size]);
    let t = above / under;
    let square = t * t;
    let fourth = square * square;
    let series = square * polynomial(m, fourth, &ODD) + fourth * polynomial(m, fourth, &EVEN);
    let angles = |of: [f64; 4]| by_range([m.real(0.0), m.real(of[0]), m.real(of[1]), m.real(of[2]), m.real(of[3])]);
    let value = angles(HIGH) - ((t * series - angles(LOW)) - t);
    m.choose(m.equal(x, x), turned(m, value, sign(m, x)), m.real(NAN))
}
