//! Logarithms, powers and angles: how near they come to another library's, and that the programs of logic that are recorded
//! from them give the same bits as they do, on every engine.

use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;
use rung::elementary::{Elementary, Value};
use rung::engine::interp::{Interpreter, Textbook};
use rung::engine::jit::Jit;
use rung::logic::{Helper, Op, Program, SlotId, evaluate, mathematics, verify};
use rung::opt;
use rung_runtime::Scan;

/// Arguments at which something changes: signs, ends of ranges, whole and odd numbers, bounds between methods, angles near
/// which sines and tangents vanish.
fn special() -> Vec<f64> {
    use std::f64::consts::{E, FRAC_PI_2, FRAC_PI_4, LN_2, PI, SQRT_2};
    let sizes = [
        0.0,
        f64::from_bits(1),
        f64::from_bits(0xF_FFFF_FFFF_FFFF),
        f64::MIN_POSITIVE,
        1e-300,
        1e-20,
        f64::EPSILON,
        1e-8,
        0.1,
        0.25,
        1.0 / 3.0,
        0.4375,
        0.5,
        0.6744,
        0.6875,
        1.0 / SQRT_2,
        FRAC_PI_4,
        0.975,
        1.0,
        1.1875,
        1.224_744_871_391_589,
        SQRT_2,
        1.5,
        FRAC_PI_2,
        1.75_f64.sqrt(),
        3.0_f64.sqrt(),
        2.0,
        2.4375,
        E,
        3.0,
        PI,
        LN_2,
        5.0,
        10.0,
        20.0 * PI,
        355.0,
        700.0,
        709.782_712_893_384,
        745.133_219_101_941_1,
        746.0,
        1000.0,
        1e4,
        1023.0,
        1024.0,
        1074.0,
        1075.0,
        65_535.0,
        1e7,
        1e15,
        1e22,
        2.0_f64.powi(31),
        2.0_f64.powi(52) - 0.5,
        2.0_f64.powi(52) + 1.0,
        2.0_f64.powi(53) - 1.0,
        2.0_f64.powi(53),
        2.0_f64.powi(54),
        2.0_f64.powi(66),
        // The double nearest to a multiple of pi/2, relative to its size.
        6_381_956_970_095_103.0 * 2.0_f64.powi(797),
        1e300,
        f64::MAX,
        f64::INFINITY,
        f64::NAN,
    ];
    sizes.into_iter().flat_map(|size| [size.next_down(), size, size.next_up()]).flat_map(|size| [size, -size]).collect()
}

/// Arguments of which many lie where a helper does the most: of all magnitudes, of those of angles, and from -1 to 1.
fn random(rng: &mut Pcg64) -> f64 {
    match rng.random_range(0..8) {
        0 => f64::from_bits(rng.random()),
        1 => rng.random_range(-1.0..1.0),
        2 => rng.random_range(-800.0..800.0),
        // The neighbours of a multiple of pi/4.
        3 => {
            let near = f64::from(rng.random_range(-4000..4000)) * std::f64::consts::FRAC_PI_4;
            f64::from_bits(near.to_bits().wrapping_add(rng.random_range(0..64)))
        }
        4 => 1.0 + rng.random_range(-1.0..1.0) * 2.0_f64.powi(-rng.random_range(0..53)),
        5 => f64::from(rng.random_range(-100..100)),
        _ => {
            let size = (1.0 + rng.random::<f64>()) * 2.0_f64.powi(rng.random_range(-40..40));
            if rng.random_bool(0.5) { size } else { -size }
        }
    }
}

/// A second operand for a first one, such that the power is often neither 0 nor infinite.
fn exponent(rng: &mut Pcg64, base: f64) -> f64 {
    let log = base.abs().log2().abs();
    if rng.random_bool(0.7) && log > 0.0 && log.is_finite() {
        let exponent = rng.random_range(-1075.0..1025.0) / log;
        if rng.random_bool(0.2) { exponent.round() } else { exponent }
    } else {
        random(rng)
    }
}

/// Pairs of operands: the special ones with each other, and random ones.
fn operands(helper: Helper, count: usize) -> Vec<(f64, f64)> {
    let special = special();
    let mut all: Vec<(f64, f64)> = if helper.takes_two() {
        special.iter().flat_map(|a| special.iter().map(|b| (*a, *b))).collect()
    } else {
        special.iter().map(|a| (*a, 0.0)).collect()
    };
    let mut rng = Pcg64::seed_from_u64(helper as u64);
    all.extend((0..count).map(|_| {
        let a = random(&mut rng);
        // A power of a negative number is one of its magnitude, or none.
        let a = if helper.takes_two() && rng.random_bool(0.8) { a.abs() } else { a };
        (a, if helper.takes_two() { exponent(&mut rng, a) } else { 0.0 })
    }));
    all
}

fn reference(helper: Helper, a: f64, b: f64) -> f64 {
    match helper {
        Helper::Ln => libm::log(a),
        Helper::Log10 => libm::log10(a),
        Helper::Exp => libm::exp(a),
        Helper::Sin => libm::sin(a),
        Helper::Cos => libm::cos(a),
        Helper::Tan => libm::tan(a),
        Helper::Asin => libm::asin(a),
        Helper::Acos => libm::acos(a),
        Helper::Atan => libm::atan(a),
        Helper::Power => libm::pow(a, b),
    }
}

/// How many LREALs lie between two: 0 of equal ones, the most where one is a NaN and the other is not. The two zeros are 1
/// apart, infinity is as far from the greatest number as that from the next.
fn distance(a: f64, b: f64) -> u64 {
    let place = |x: f64| {
        let bits = x.to_bits().cast_signed();
        i128::from(if bits < 0 { -1 - (bits & i64::MAX) } else { bits })
    };
    match (a.is_nan(), b.is_nan()) {
        (true, true) => 0,
        (false, false) => u64::try_from((place(a) - place(b)).unsigned_abs()).unwrap_or(u64::MAX),
        _ => u64::MAX,
    }
}

#[test]
#[expect(clippy::print_stdout, reason = "the documented accuracy is what this prints")]
fn results_are_a_unit_in_the_last_place_from_those_of_another_library() {
    for helper in Helper::ALL {
        let operands = operands(*helper, 120_000);
        let (mut most, mut differ) = (0, 0_u32);
        for (a, b) in &operands {
            let (ours, theirs) = (evaluate::helper(*helper, *a, *b), reference(*helper, *a, *b));
            // For exponents from 2^31 on the other one takes a short cut, see below.
            if helper.takes_two() && b.abs() > 2.0_f64.powi(31) && ours.is_finite() && ours != 0.0 {
                assert!((ours / theirs - 1.0).abs() < 1e-9, "{a:?} to the {b:?} is {ours:?}, elsewhere {theirs:?}");
                continue;
            }
            let distance = distance(ours, theirs);
            differ += u32::from(distance > 0);
            most = most.max(distance);
            assert!(distance <= 1, "{} {a:?} {b:?} is {ours:?}, elsewhere {theirs:?}", helper.mnemonic());
        }
        let share = f64::from(differ) / operands.len() as f64 * 100.0;
        println!(
            "{:>5}: {} arguments, {most} units in the last place at most, {share:.2} % differ",
            helper.mnemonic(),
            operands.len(),
        );
    }
}

#[test]
fn small_exponents_are_products_quotients_and_roots() {
    let mut rng = Pcg64::seed_from_u64(5);
    for x in special().into_iter().chain((0..2000).map(|_| random(&mut rng))) {
        let power =
            |exponent| evaluate::call(Helper::Power, Elementary::Lreal, x.to_bits(), Some(f64::to_bits(exponent)));
        let same =
            |bits, expected: f64| f64::from_bits(bits).is_nan() && expected.is_nan() || bits == expected.to_bits();
        assert!(same(power(1.0), x), "{x:?}");
        assert!(same(power(2.0), x * x), "{x:?}");
        assert!(same(power(-1.0), 1.0 / x), "{x:?}");
        let root = if x == f64::NEG_INFINITY { f64::INFINITY } else { (x + 0.0).sqrt() };
        assert!(same(power(0.5), root), "{x:?}");
    }
}

/// Results that were computed with 300 bits.
#[test]
fn powers_with_large_exponents_are_right() {
    let cases = [
        (1.0000002095572926, -2816986148.066565, 4.239478168163207e-257),
        (1.000000055795379, -2262047684.0, 1.5378353760916323e-55),
        (1.0000000039051713, -41271761913.0, 1.0076861948788545e-70),
        (1.0000000001231673, -4506110115291.0, 9.210854586427503e-242),
        (1.0000000000104312, -29833965243239.0, 7.008844136311173e-136),
        (1.0000000000007054, 556000418084519.0, 2.188209867485151e+170),
        (1.000000000000032, 4902390211786585.0, 1.1916186041579555e+68),
    ];
    for (base, exponent, expected) in cases {
        let power = evaluate::helper(Helper::Power, base, exponent);
        assert!(distance(power, expected) <= 1, "{base:?} to the {exponent:?} is {power:?}");
    }
}

#[test]
fn powers_of_ten_have_whole_logarithms() {
    for exponent in 0..=22_u8 {
        let power = format!("1e{exponent}").parse().unwrap();
        assert_eq!(evaluate::helper(Helper::Log10, power, 0.0), f64::from(exponent));
    }
}

#[test]
fn functions_that_only_rise_do_so_where_their_method_changes() {
    let rising = [Helper::Ln, Helper::Log10, Helper::Exp, Helper::Asin, Helper::Atan];
    for helper in rising {
        for start in special().into_iter().filter(|start| start.is_finite()) {
            let mut x = (0..50).fold(start, |x, _| x.next_down());
            let mut before = evaluate::helper(helper, x, 0.0);
            for _ in 0..100 {
                x = x.next_up();
                let now = evaluate::helper(helper, x, 0.0);
                assert!(before.is_nan() || now.is_nan() || before <= now, "{} falls at {x:?}", helper.mnemonic());
                before = now;
            }
        }
    }
}

fn run(engine: &mut dyn Scan, program: &Program, a: f64, b: f64) -> u64 {
    let mut image = program.layout.initial_image();
    let slot = |id: SlotId| program.layout.slot(id);
    let lreal = |value: f64| Value::from_bits(Elementary::Lreal, value.to_bits());
    slot(mathematics::FIRST).write(&mut image, lreal(a));
    slot(mathematics::SECOND).write(&mut image, lreal(b));
    engine.scan(&mut image, 0);
    slot(mathematics::RESULT).read(&image).bits()
}

#[test]
fn recorded_programs_give_the_same_bits_on_every_engine() {
    for helper in Helper::ALL {
        let program = mathematics::program(*helper);
        assert_eq!(verify(&program), Ok(()), "{}", helper.mnemonic());
        let optimised = opt::optimise(program.clone());
        let mut engines: Vec<(&str, Box<dyn Scan>)> = vec![
            ("textbook", Box::new(Textbook::new(&program))),
            ("interp", Box::new(Interpreter::new(&program))),
            ("interp, optimised", Box::new(Interpreter::new(&optimised))),
            ("jit", Box::new(Jit::compile(&program).unwrap())),
            ("jit, optimised", Box::new(Jit::compile(&optimised).unwrap())),
        ];
        let all = operands(*helper, 3000);
        // Of all pairs of special operands some.
        let step = if helper.takes_two() { 17 } else { 1 };
        for (a, b) in all.iter().step_by(step) {
            let second = helper.takes_two().then(|| b.to_bits());
            let expected = evaluate::call(*helper, Elementary::Lreal, a.to_bits(), second);
            for (name, engine) in &mut engines {
                let found = run(engine.as_mut(), &program, *a, *b);
                assert_eq!(found, expected, "{} {a:?} {b:?} by {name}", helper.mnemonic());
            }
        }
    }
}

#[test]
#[expect(clippy::print_stdout, reason = "the documented sizes are what this prints")]
fn recorded_programs_are_one_section_without_a_call_and_nothing_idle() {
    for helper in Helper::ALL {
        let program = mathematics::program(*helper);
        assert_eq!((program.sections.len(), program.chunks().len(), program.tasks.len()), (1, 1, 1));
        let mut used = vec![false; program.instructions.len()];
        for operand in program.instructions.iter().flat_map(|instruction| instruction.op.operands()) {
            used[operand.index()] = true;
        }
        let (mut constants, mut operations) = (0, 0);
        for (index, instruction) in program.instructions.iter().enumerate() {
            assert!(used[index] || !instruction.op.has_value(), "{} v{index} is idle", helper.mnemonic());
            match instruction.op {
                Op::Call(..) | Op::LoadIndexed(..) | Op::StoreIndexed(..) | Op::CopyArray(..) | Op::Now => {
                    panic!("{} has {:?}", helper.mnemonic(), instruction.op)
                }
                Op::Constant(_) | Op::Reinterpret(_) => constants += 1,
                _ => operations += 1,
            }
        }
        let compiled = Jit::compile(&program).unwrap();
        println!(
            "{:>5}: {operations} operations, {constants} constants and reinterpretations, {} bytes of code",
            helper.mnemonic(),
            compiled.code_bytes(),
        );
    }
}
