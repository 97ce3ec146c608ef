//! e to a power: x = k ln 2 + r, so that e^x = 2^k e^r with a small r, whose e^r is a quotient of polynomials.

use std::f64::consts::LOG2_E;

use super::{Arithmetic, polynomial, scaled, whole};

/// ln 2, of which the upper part times any exponent is exact.
const LN_2: [f64; 2] = [6.931_471_803_691_238e-1, 1.908_214_929_270_587_7e-10];

/// r coth(r/2) is 2 plus this polynomial of r^2 times r^2.
pub(super) const QUOTIENT: [f64; 5] = [
    1.666_666_666_666_660_2e-1,
    -2.777_777_777_701_559_3e-3,
    6.613_756_321_437_934e-5,
    -1.653_390_220_546_525_2e-6,
    4.138_136_797_057_238_5e-8,
];

/// e to the power of `x`.
#[inline(always)]
pub fn exp<A: Arithmetic>(m: A, x: A::Real) -> A::Real {
    // Beyond these the result is 0 or infinite all the same. A NaN stays one, and makes the result one.
    let x = m.choose(m.less(x, m.real(-750.0)), m.real(-750.0), x);
    let x = m.choose(m.less(m.real(750.0), x), m.real(750.0), x);
    let (turns, exponent) = whole(m, x * LOG2_E);
    let (high, low) = (x - turns * LN_2[0], turns * LN_2[1]);
    let r = high - low;
    let square = r * r;
    let c = r - square * polynomial(m, square, &QUOTIENT);
    let power = m.real(1.0) - ((low - (r * c) / (m.real(2.0) - c)) - high);
    scaled(m, power, exponent)
}
