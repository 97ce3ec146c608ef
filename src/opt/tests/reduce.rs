//! Costly operations with a constant.

use super::after;
use crate::elementary::{Elementary, Value, canonical};
use crate::logic::{
    Area, Binary, Builder, Instruction, LayoutBuilder, Op, Origin, Program, Slot, evaluate, execute::Executor, verify,
};

/// `y := x op constant`, and the same the other way round, in a type.
fn program(op: Binary, ty: Elementary, constant: u64) -> Program {
    let mut layout = LayoutBuilder::new();
    let [x, y, z] = ["x", "y", "z"].map(|name| {
        let (name, initial) = (name.to_owned(), Value::default_of(ty));
        layout.slot(Slot { name: name.into(), ty, offset: 0, area: Area::Memory, retain: false, initial, line: 0 })
    });
    let mut logic = Builder::new("p", layout.finish(None).expect("a small image"));
    let operand = logic.load(x);
    let constant = logic.constant(Value::from_bits(ty, constant));
    let (first, second) = (logic.binary(op, operand, constant), logic.binary(op, constant, operand));
    logic.store(y, first);
    logic.store(z, second);
    logic.end_section(Origin { label: "r".into(), line: 1 });
    logic.finish()
}

/// Values of a type that are likely to show a mistake.
fn values(ty: Elementary, constant: u64) -> Vec<u64> {
    let mut values: Vec<u64> =
        (0..ty.bits()).flat_map(|bit| [1u64 << bit, (1 << bit) - 1, (1u64 << bit) + 1]).collect();
    for multiple in [1, 2, 3, 1000, 0x7FFF, 0xFFFF_FFFF] {
        let near = constant.wrapping_mul(multiple);
        values.extend([near, near.wrapping_add(1), near.wrapping_sub(1)]);
    }
    values.push(u64::MAX);
    if ty.bits() == 8 {
        values.extend(0..256);
    }
    let negative: Vec<u64> = values.iter().map(|value| value.wrapping_neg()).collect();
    values.into_iter().chain(negative).map(|value| canonical(ty, value)).collect()
}

#[test]
fn every_reduced_operation_computes_what_it_did() {
    let mut reduced = 0;
    let integers = Elementary::ALL.into_iter().filter(|ty| ty.is_integer() || *ty == Elementary::Time);
    for ty in integers {
        let constants = [0u64, 1, 2, 3, 4, 5, 6, 7, 8, 10, 12, 16, 25, 60, 64, 100, 127, 128, 641, 1000, 3600, 32768];
        let large = [65_535, 1_000_000, 0x7FFF_FFFF, 1 << 31, 0xFFFF_FFFF, u64::MAX / 2, 1 << 63, u64::MAX - 6];
        for constant in constants.into_iter().chain(large).flat_map(|constant| [constant, constant.wrapping_neg()]) {
            let constant = canonical(ty, constant);
            for op in [Binary::Add, Binary::Subtract, Binary::Multiply, Binary::Divide, Binary::Remainder] {
                let before = program(op, ty, constant);
                let after = super::pass("reduce", before.clone());
                assert_eq!(verify(&after), Ok(()));
                reduced += usize::from(before != after);
                let executor = Executor::new(&before.layout);
                let mut image = before.layout.initial_image();
                for value in values(ty, constant) {
                    let [x, y, z] = [0, 1, 2].map(|slot| before.layout.slots()[slot].clone());
                    x.write(&mut image, Value::from_bits(ty, value));
                    let count = after.instructions.len();
                    executor.execute(&after.instructions, 0..count, &mut vec![0; count], &mut image, 0);
                    let expected =
                        [evaluate::binary(op, ty, value, constant), evaluate::binary(op, ty, constant, value)];
                    let actual = [y.read(&image).bits(), z.read(&image).bits()];
                    assert_eq!(actual, expected, "{ty}: {} of {value:#x} and {constant:#x}", op.mnemonic());
                }
            }
        }
    }
    assert!(reduced > 800, "only {reduced}");
}

/// What is left of `n op constant`, an INT: the operations by name.
fn operations(op: Binary, ty: Elementary, constant: u64) -> Vec<&'static str> {
    let program = super::pass("sweep", super::pass("reduce", program(op, ty, constant)));
    let name = |instruction: &Instruction| match instruction.op {
        Op::Binary(op, ..) => Some(op.mnemonic()),
        _ => None,
    };
    program.instructions.iter().filter_map(name).collect()
}

#[test]
fn quotients_and_remainders_by_constants_need_no_division_but_the_wide_ones() {
    // The other quotient, of the constant by the variable, stays.
    assert_eq!(operations(Binary::Divide, Elementary::Uint, 8), ["shr", "div"]);
    assert_eq!(operations(Binary::Divide, Elementary::Dint, 10), ["mul", "shr", "div"]);
    assert_eq!(operations(Binary::Remainder, Elementary::Int, 16), ["and", "rem"]);
    assert_eq!(operations(Binary::Remainder, Elementary::Udint, 10), ["mul", "shr", "mul", "sub", "rem"]);
    assert_eq!(operations(Binary::Divide, Elementary::Lint, 10), ["div", "div"]);
    assert_eq!(operations(Binary::Divide, Elementary::Time, 1024), ["shr", "div"]);
    assert_eq!(operations(Binary::Multiply, Elementary::Dint, 4), ["shl", "shl"]);
    assert_eq!(operations(Binary::Multiply, Elementary::Int, 4), ["mul", "mul"]);
}

#[test]
fn halves_are_products_and_thirds_are_not() {
    let real = |value: f64| Value::real(Elementary::Real, value).expect("a REAL").bits();
    assert_eq!(operations(Binary::Divide, Elementary::Real, real(2.0)), ["mul", "div"]);
    assert_eq!(operations(Binary::Divide, Elementary::Real, real(-0.25)), ["mul", "div"]);
    for other in [3.0, 0.0, f64::INFINITY, 1e-45, f64::from(f32::MAX)] {
        assert_eq!(operations(Binary::Divide, Elementary::Real, real(other)), ["div", "div"]);
    }
    // Its reciprocal is a subnormal.
    assert_eq!(operations(Binary::Divide, Elementary::Real, real(2f64.powi(127))), ["div", "div"]);
    for ty in [Elementary::Real, Elementary::Lreal] {
        for divisor in [2.0, -4.0, 0.5, 2f64.powi(-126), 2f64.powi(126)] {
            let divisor = Value::real(ty, divisor).expect("it is real").bits();
            let before = program(Binary::Divide, ty, divisor);
            let after = super::pass("reduce", before.clone());
            assert_eq!(crate::opt::check::difference(&before, &after, 200), None);
        }
    }
}

#[test]
fn what_changes_nothing_goes() {
    let text = after(
        "reduce",
        &[|logic, s| {
            let n = logic.load(s[5]);
            let zero = logic.constant(Value::from_bits(Elementary::Int, 0));
            let sum = logic.binary(Binary::Add, n, zero);
            let difference = logic.binary(Binary::Subtract, sum, zero);
            let least = logic.binary(Binary::Minimum, difference, n);
            logic.store(s[5], least);
        }],
    );
    assert_eq!(text, "v0 = n; n := v0");
}
