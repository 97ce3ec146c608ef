//! The edges of every operation, as tables.

use super::*;
use crate::elementary::Elementary::{
    Bool, Byte, Dint, Dword, Int, Lint, Lreal, Lword, Real, Sint, Time, Udint, Uint, Ulint, Usint, Word,
};
use crate::elementary::Value;

const MIN64: i128 = i64::MIN as i128;
const MAX64: i128 = i64::MAX as i128;
const MAXU64: i128 = u64::MAX as i128;

fn bits(ty: Elementary, number: i128) -> u64 {
    Value::integer(ty, number).unwrap_or_else(|| panic!("{number} is no {ty}")).bits()
}

fn real(ty: Elementary, number: f64) -> u64 {
    Value::real(ty, number).unwrap().bits()
}

fn shown(ty: Elementary, bits: u64) -> String {
    format!("{:?} ({bits:#x})", Value::from_bits(ty, bits))
}

#[test]
fn integers_wrap_around() {
    use Binary::{Add, Divide, Maximum, Minimum, Multiply, Remainder, Subtract};
    let cases = [
        (Add, Sint, 127, 1, -128),
        (Add, Usint, 255, 1, 0),
        (Add, Int, -32768, -1, 32767),
        (Add, Udint, 0xFFFF_FFFF, 2, 1),
        (Add, Lint, MAX64, 1, MIN64),
        (Add, Ulint, MAXU64, 1, 0),
        (Add, Time, MAX64, MAX64, -2),
        (Subtract, Sint, -128, 1, 127),
        (Subtract, Uint, 0, 1, 65535),
        (Subtract, Ulint, 0, 1, MAXU64),
        (Subtract, Time, MIN64, 1, MAX64),
        (Multiply, Sint, -128, -128, 0),
        (Multiply, Sint, 127, 2, -2),
        (Multiply, Dint, 65536, 65536, 0),
        (Multiply, Uint, 65535, 65535, 1),
        (Multiply, Lint, MIN64, -1, MIN64),
        (Multiply, Ulint, MAXU64, MAXU64, 1),
        (Divide, Sint, -128, -1, -128),
        (Divide, Int, -32768, -1, -32768),
        (Divide, Dint, -2_147_483_648, -1, -2_147_483_648),
        (Divide, Lint, MIN64, -1, MIN64),
        (Divide, Int, -7, 2, -3),
        (Divide, Int, 7, -2, -3),
        (Divide, Ulint, MAXU64, 2, MAX64),
        (Divide, Int, -7, 0, 0),
        (Divide, Ulint, MAXU64, 0, 0),
        (Divide, Time, MIN64, 0, 0),
        (Remainder, Int, -7, 2, -1),
        (Remainder, Int, 7, -2, 1),
        (Remainder, Sint, -128, -1, 0),
        (Remainder, Lint, MIN64, -1, 0),
        (Remainder, Lint, 5, 0, 0),
        (Remainder, Ulint, MAXU64, 10, 5),
        (Minimum, Int, -1, 1, -1),
        (Minimum, Ulint, MAXU64, 1, 1),
        (Maximum, Int, -1, 1, 1),
        (Maximum, Ulint, MAXU64, 1, MAXU64),
        (Maximum, Time, 3, 3, 3),
    ];
    for (op, ty, a, b, expected) in cases {
        let result = binary(op, ty, bits(ty, a), bits(ty, b));
        assert_eq!(result, bits(ty, expected), "{op:?} {ty} {a} {b} gives {}", shown(ty, result));
    }
}

#[test]
fn signs_and_bits_of_one_operand() {
    use Unary::{Absolute, Negate, Not};
    let cases = [
        (Negate, Sint, -128, -128),
        (Negate, Lint, MIN64, MIN64),
        (Negate, Int, 5, -5),
        (Negate, Usint, 1, 255),
        (Negate, Ulint, 1, MAXU64),
        (Absolute, Sint, -128, -128),
        (Absolute, Lint, MIN64, MIN64),
        (Absolute, Time, -5, 5),
        (Absolute, Usint, 255, 255),
        (Not, Bool, 0, 1),
        (Not, Bool, 1, 0),
        (Not, Byte, 0x0F, 0xF0),
        (Not, Dword, 0, 0xFFFF_FFFF),
        (Not, Lword, 1, MAXU64 - 1),
    ];
    for (op, ty, a, expected) in cases {
        let result = unary(op, ty, bits(ty, a));
        assert_eq!(result, bits(ty, expected), "{op:?} {ty} {a} gives {}", shown(ty, result));
    }
}

#[test]
fn shifts_lose_bits_and_rotations_do_not() {
    use Binary::{And, Or, RotateLeft, RotateRight, ShiftLeft, ShiftRight, Xor};
    let cases = [
        (ShiftLeft, Byte, 0x81, 1, 0x02),
        (ShiftLeft, Byte, 0xFF, 7, 0x80),
        (ShiftLeft, Byte, 0xFF, 8, 0),
        (ShiftLeft, Lword, 1, 63, 1 << 63),
        (ShiftLeft, Lword, 1, 64, 0),
        (ShiftLeft, Word, 1, 0xFFFF_FFFF, 0),
        (ShiftRight, Word, 0x8000, 15, 1),
        (ShiftRight, Word, 0x8000, 16, 0),
        (ShiftRight, Lword, MAXU64, 63, 1),
        (ShiftRight, Lword, MAXU64, 64, 0),
        (RotateLeft, Byte, 0x81, 1, 0x03),
        (RotateLeft, Byte, 0x81, 8, 0x81),
        (RotateLeft, Byte, 0x81, 0xFFFF_FFFF, 0xC0),
        (RotateLeft, Lword, 1 << 63, 1, 1),
        (RotateLeft, Lword, 5, 64, 5),
        (RotateRight, Word, 0x0001, 1, 0x8000),
        (RotateRight, Word, 0x1234, 4, 0x4123),
        (RotateRight, Dword, 0x1234_5678, 32, 0x1234_5678),
        (RotateRight, Lword, 1, 0, 1),
        (RotateRight, Lword, 1, 65, 1 << 63),
    ];
    for (op, ty, a, amount, expected) in cases {
        let result = binary(op, ty, bits(ty, a), bits(Udint, amount));
        assert_eq!(result, bits(ty, expected), "{op:?} {ty} {a:#x} by {amount} gives {result:#x}");
    }
    for (op, expected) in [(And, [0, 0, 0, 1]), (Or, [0, 1, 1, 1]), (Xor, [0, 1, 1, 0])] {
        let results = [(0, 0), (0, 1), (1, 0), (1, 1)].map(|(a, b)| binary(op, Bool, a, b));
        assert_eq!(results, expected, "{op:?}");
    }
}

#[test]
fn reals_follow_ieee_with_one_nan() {
    use Binary::{Add, Divide, Multiply, Subtract};
    let infinity = f64::INFINITY;
    for (ty, nan) in [(Real, u64::from(NAN32)), (Lreal, NAN64)] {
        let calculate = |op, a, b| binary(op, ty, real(ty, a), real(ty, b));
        assert_eq!(calculate(Add, 0.5, 0.25), real(ty, 0.75));
        assert_eq!(calculate(Subtract, 0.0, 0.0), 0);
        assert_eq!(calculate(Multiply, -0.0, 1.0), real(ty, -0.0));
        assert_eq!(calculate(Divide, 1.0, 0.0), real(ty, infinity));
        assert_eq!(calculate(Divide, -1.0, 0.0), real(ty, -infinity));
        assert_eq!(calculate(Divide, 0.0, 0.0), nan);
        assert_eq!(calculate(Subtract, infinity, infinity), nan);
        assert_eq!(calculate(Multiply, 0.0, infinity), nan);
        assert_eq!(calculate(Add, f64::NAN, 1.0), nan);
        // A NaN with another sign and payload becomes the one NaN, too.
        assert_eq!(binary(Add, ty, nan | 1 | sign_bit(ty), real(ty, 1.0)), nan);
        assert_eq!(unary(Unary::SquareRoot, ty, real(ty, -1.0)), nan);
        assert_eq!(unary(Unary::SquareRoot, ty, real(ty, -0.0)), real(ty, -0.0));
        assert_eq!(unary(Unary::SquareRoot, ty, real(ty, 2.25)), real(ty, 1.5));
        // Only the sign changes, whatever the payload.
        assert_eq!(unary(Unary::Negate, ty, nan | 1), nan | 1 | sign_bit(ty));
        assert_eq!(unary(Unary::Absolute, ty, nan | 1 | sign_bit(ty)), nan | 1);
        assert_eq!(unary(Unary::Negate, ty, 0), real(ty, -0.0));
    }
    // Rounded to REAL, not to LREAL: the largest REAL overflows, and a third is a REAL's.
    assert_eq!(binary(Multiply, Real, real(Real, 3e38), real(Real, 2.0)), real(Real, infinity));
    assert_eq!(binary(Divide, Real, real(Real, 1.0), real(Real, 3.0)), u64::from((1.0f32 / 3.0).to_bits()));
}

#[test]
fn comparisons_know_signs_and_nan() {
    use Compare::{Equal, Greater, GreaterOrEqual, Less, LessOrEqual, NotEqual};
    let order = [Less, LessOrEqual, Equal, GreaterOrEqual, Greater, NotEqual];
    let holds = |ty, a, b| order.map(|op| compare(op, ty, a, b));
    let (less, equal, greater) = (
        [true, true, false, false, false, true],
        [false, true, true, true, false, false],
        [false, false, false, true, true, true],
    );
    for ty in [Sint, Int, Dint, Lint, Time] {
        assert_eq!(holds(ty, bits(ty, -1), bits(ty, 1)), less, "{ty}");
        assert_eq!(holds(ty, bits(ty, -1), bits(ty, -1)), equal, "{ty}");
    }
    for ty in [Bool, Usint, Uint, Udint, Ulint, Byte, Word, Dword, Lword] {
        let greatest = ty.range().unwrap().1;
        assert_eq!(holds(ty, bits(ty, greatest), 0), greater, "{ty}");
    }
    for (ty, nan) in [(Real, u64::from(NAN32)), (Lreal, NAN64)] {
        assert_eq!(holds(ty, real(ty, -0.0), 0), equal, "{ty}");
        assert_eq!(holds(ty, real(ty, -2.0), real(ty, -1.0)), less, "{ty}");
        assert_eq!(holds(ty, nan, nan), [false, false, false, false, false, true], "{ty}");
    }
}

#[test]
fn integers_convert_by_their_low_bits() {
    let cases = [
        (Int, Sint, 300, 44),
        (Int, Sint, 200, -56),
        (Sint, Uint, -1, 65535),
        (Sint, Lint, -1, -1),
        (Sint, Lword, -1, MAXU64),
        (Usint, Sint, 255, -1),
        (Ulint, Lint, MAXU64, -1),
        (Time, Dint, 1 << 32, 0),
        (Dint, Time, -5, -5),
        (Udint, Time, 0xFFFF_FFFF, 0xFFFF_FFFF),
        (Bool, Lint, 1, 1),
        (Int, Bool, 256, 1),
        (Int, Bool, 0, 0),
        (Lword, Bool, 1 << 63, 1),
        (Byte, Byte, 255, 255),
    ];
    for (from, to, a, expected) in cases {
        let result = convert(from, to, bits(from, a));
        assert_eq!(result, bits(to, expected), "{from} {a} to {to} gives {}", shown(to, result));
    }
}

#[test]
fn reals_round_half_to_even_and_stay_in_range() {
    let cases = [
        (0.5, Int, 0),
        (1.5, Int, 2),
        (2.5, Int, 2),
        (-0.5, Int, 0),
        (-1.5, Int, -2),
        (-2.5, Int, -2),
        (2.500_001, Int, 3),
        (-0.75, Uint, 0),
        (1e10, Int, 32767),
        (-1e10, Int, -32768),
        (127.5, Sint, 127),
        (-128.5, Sint, -128),
        (255.5, Byte, 255),
        (1e30, Lint, MAX64),
        (-1e30, Lint, MIN64),
        (1e30, Ulint, MAXU64),
        (1e19, Ulint, 10_000_000_000_000_000_000),
        (1e30, Time, MAX64),
        (f64::INFINITY, Udint, 0xFFFF_FFFF),
        (f64::NEG_INFINITY, Dint, -2_147_483_648),
        (f64::NEG_INFINITY, Lword, 0),
        (f64::NAN, Lint, 0),
        (f64::NAN, Bool, 1),
        (0.25, Bool, 1),
        (-0.0, Bool, 0),
    ];
    for (a, to, expected) in cases {
        for from in [Real, Lreal] {
            // What a REAL cannot tell from its neighbours is not asked of it.
            if from == Lreal || f64::from(f32_of(real(Real, a))) == a || a.is_nan() || a.abs() > 1e29 {
                let result = convert(from, to, real(from, a));
                assert_eq!(result, bits(to, expected), "{from} {a} to {to} gives {}", shown(to, result));
            }
        }
    }
    // The neighbours of the ends of LINT and ULINT.
    assert_eq!(convert(Lreal, Lint, real(Lreal, 9_223_372_036_854_774_784.0)), 0x7FFF_FFFF_FFFF_FC00);
    assert_eq!(convert(Lreal, Ulint, real(Lreal, 18_446_744_073_709_549_568.0)), 0xFFFF_FFFF_FFFF_F800);
}

#[test]
fn integers_round_to_the_nearest_real_once() {
    assert_eq!(convert(Ulint, Lreal, u64::MAX), real(Lreal, 18_446_744_073_709_551_616.0));
    assert_eq!(convert(Lint, Lreal, bits(Lint, MIN64)), real(Lreal, -9_223_372_036_854_775_808.0));
    assert_eq!(convert(Dint, Real, bits(Dint, 16_777_217)), real(Real, 16_777_216.0));
    assert_eq!(convert(Dint, Real, bits(Dint, 16_777_219)), real(Real, 16_777_220.0));
    // Just above the middle of two REALs; by way of LREAL it would fall on the middle, and then to the even one below.
    let number = (1i128 << 60) + (1 << 36) + 1;
    assert_eq!(f32_of(convert(Lint, Real, bits(Lint, number))), 2f32.powi(60).next_up());
    assert_eq!(convert(Bool, Real, 1), real(Real, 1.0));
    assert_eq!(convert(Time, Lreal, bits(Time, -5)), real(Lreal, -5.0));
}

#[test]
fn between_reals_a_value_is_rounded_and_a_nan_is_the_one() {
    assert_eq!(convert(Lreal, Real, real(Lreal, 0.1)), u64::from(0.1f32.to_bits()));
    assert_eq!(convert(Lreal, Real, real(Lreal, 1e300)), real(Real, f64::INFINITY));
    assert_eq!(convert(Lreal, Real, real(Lreal, -1e-300)), real(Real, -0.0));
    assert_eq!(convert(Real, Lreal, real(Real, 0.1)), f64::from(0.1f32).to_bits());
    assert_eq!(convert(Real, Lreal, u64::from(NAN32) | 1 | sign_bit(Real)), NAN64);
    assert_eq!(convert(Lreal, Real, NAN64 | 1), u64::from(NAN32));
    // To its own type a value stays as it is.
    assert_eq!(convert(Lreal, Lreal, NAN64 | 1), NAN64 | 1);
}

#[test]
fn every_result_is_in_register_form() {
    let edges = [0, 1, 2, 7, 63, 64, 0x7F, 0x80, 0xFF, 0x7FFF, 0x8000, 1 << 31, 1 << 63, u64::MAX, NAN64, 0xFF80_0001];
    for ty in Elementary::ALL {
        for a in edges.map(|edge| canonical(ty, edge)) {
            let check = |what: &str, result_type, result| {
                assert_eq!(canonical(result_type, result), result, "{what} {ty} {a:#x} gives {result:#x}");
            };
            for op in Unary::ALL.iter().filter(|op| op.domain().contains(ty)) {
                check(op.mnemonic(), ty, unary(*op, ty, a));
            }
            for to in Elementary::ALL {
                check(to.name(), to, convert(ty, to, a));
            }
            for helper in Helper::ALL.iter().filter(|helper| helper.domain().contains(ty)) {
                let b = helper.takes_two().then_some(a);
                check(helper.mnemonic(), ty, call(*helper, ty, a, b));
            }
            for op in Binary::ALL.iter().filter(|op| op.domain().contains(ty)) {
                let second = if op.takes_amount() { Udint } else { ty };
                for b in edges.map(|edge| canonical(second, edge)) {
                    check(op.mnemonic(), ty, binary(*op, ty, a, b));
                }
            }
        }
    }
}

#[test]
fn helpers_have_their_edges() {
    use Helper::{Acos, Asin, Atan, Cos, Exp, Ln, Log10, Power, Sin, Tan};
    use std::f64::consts::{E, FRAC_PI_2, FRAC_PI_4, PI};
    let (nan, infinity) = (f64::NAN, f64::INFINITY);
    let one_operand = [
        (Ln, 1.0, 0.0),
        (Ln, E, 1.0),
        (Ln, 0.0, -infinity),
        (Ln, -0.0, -infinity),
        (Ln, -1.0, nan),
        (Ln, infinity, infinity),
        (Log10, 1e22, 22.0),
        (Log10, 0.0, -infinity),
        (Log10, -1.0, nan),
        (Exp, 0.0, 1.0),
        // One unit in the last place above e.
        (Exp, 1.0, E.next_up()),
        (Exp, 1e9, infinity),
        (Exp, -infinity, 0.0),
        (Sin, -0.0, -0.0),
        (Sin, FRAC_PI_2, 1.0),
        (Sin, infinity, nan),
        (Cos, 0.0, 1.0),
        (Cos, PI, -1.0),
        (Cos, -infinity, nan),
        (Tan, -0.0, -0.0),
        (Tan, infinity, nan),
        (Asin, 1.0, FRAC_PI_2),
        (Asin, 1.5, nan),
        (Acos, -1.0, PI),
        (Acos, 1.0, 0.0),
        (Acos, -1.5, nan),
        (Atan, 1.0, FRAC_PI_4),
        (Atan, -infinity, -FRAC_PI_2),
    ];
    for (helper, a, expected) in one_operand {
        let result = call(helper, Lreal, real(Lreal, a), None);
        assert_eq!(result, real(Lreal, expected), "{} {a} is {}", helper.mnemonic(), shown(Lreal, result));
        assert_eq!(call(helper, Lreal, NAN64 | 1 << 63 | 5, None), NAN64, "{} of a NaN", helper.mnemonic());
        assert_eq!(call(helper, Real, u64::from(NAN32) | 5, None), u64::from(NAN32), "{} of a NaN", helper.mnemonic());
    }
    let powers = [
        (2.0, 10.0, 1024.0),
        (2.0, -1.0, 0.5),
        (-2.0, 3.0, -8.0),
        (-8.0, 1.0 / 3.0, nan),
        (0.0, 0.0, 1.0),
        (nan, 0.0, 1.0),
        (1.0, nan, 1.0),
        (nan, 1.0, nan),
        (0.0, -1.0, infinity),
        (-0.0, -1.0, -infinity),
        (-1.0, infinity, 1.0),
        (10.0, 400.0, infinity),
        (10.0, -400.0, 0.0),
    ];
    for (a, b, expected) in powers {
        let result = call(Power, Lreal, real(Lreal, a), Some(real(Lreal, b)));
        assert_eq!(result, real(Lreal, expected), "{a} to the {b} is {}", shown(Lreal, result));
    }
}

#[test]
fn helpers_of_a_real_are_rounded_once() {
    for step in -4000..4000_i16 {
        let a = f32::from(step) * 0.003_1;
        for helper in Helper::ALL {
            let expected = real(Real, helper_of_lreals(*helper, f64::from(a)));
            let b = helper.takes_two().then(|| real(Real, 2.5));
            let result = call(*helper, Real, real(Real, f64::from(a)), b);
            assert_eq!(result, expected, "{} {a} is {}", helper.mnemonic(), shown(Real, result));
        }
    }
}

fn helper_of_lreals(helper: Helper, a: f64) -> f64 {
    let b = helper.takes_two().then(|| real(Lreal, 2.5));
    f64::from_bits(call(helper, Lreal, real(Lreal, a), b))
}

/// Stored traces hold on every machine and with every build; should a change of how the helpers are computed give other
/// bits, it shows here.
#[test]
fn helpers_give_these_very_bits() {
    let sums = Helper::ALL.iter().map(|helper| {
        let sum = (0..5000_u64).fold(0xCBF2_9CE4_8422_2325, |sum: u64, index| {
            // Angles and exponents of all sizes, and half of the time something from -1 to 1.
            let random = (index + 1).wrapping_mul(0x9E37_79B9_7F4A_7C15);
            let unit = f64::from((random >> 32) as u32) / f64::from(u32::MAX) * 2.0 - 1.0;
            let a = if index.is_multiple_of(2) { unit } else { unit * f64::from(1_u32 << (index % 31)) };
            let b = helper.takes_two().then(|| real(Lreal, unit * 9.0));
            let a = if helper.takes_two() { a.abs() } else { a };
            (sum ^ call(*helper, Lreal, real(Lreal, a), b)).wrapping_mul(0x100_0000_01B3)
        });
        (helper.mnemonic(), sum)
    });
    let expected = [
        ("ln", 3_460_641_116_761_611_071),
        ("log", 13_217_327_021_940_761_866),
        ("exp", 9_928_483_726_448_352_606),
        ("sin", 3_677_406_091_548_005_938),
        ("cos", 5_779_129_355_315_509_005),
        ("tan", 5_171_265_828_166_036_242),
        ("asin", 11_132_172_065_733_187_422),
        ("acos", 1_895_599_012_087_756_818),
        ("atan", 18_376_983_014_739_869_336),
        ("pow", 16_929_313_489_089_901_068),
    ];
    assert_eq!(sums.collect::<Vec<_>>(), expected);
}
