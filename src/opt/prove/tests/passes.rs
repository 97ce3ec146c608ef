//! That the passes' own rewriting is proved, and that no random program seems to differ.

use super::super::optimise_proved;
use super::program;
use crate::elementary::Elementary::{
    self, Bool, Byte, Dint, Int, Lint, Lreal, Real, Sint, Time, Udint, Uint, Ulint, Usint,
};
use crate::elementary::Value;
use crate::logic::{Binary, Builder, LayoutBuilder, Op, Origin, Slot, SlotId, random};
use crate::opt::PASSES;

/// How many programs: `RUNG_PROGRAMS` says otherwise.
fn programs(otherwise: u64) -> u64 {
    std::env::var("RUNG_PROGRAMS").ok().and_then(|number| number.parse().ok()).unwrap_or(otherwise)
}

#[test]
fn no_random_program_seems_to_differ_and_nearly_all_that_they_store_is_proved() {
    let (mut proved, mut unproved) = (0, 0);
    for seed in 0..programs(200) {
        let (_, report) =
            optimise_proved(random::program(seed), PASSES).unwrap_or_else(|fault| panic!("seed {seed}: {fault:?}"));
        proved += report.proved();
        unproved += report.unproved.len();
    }
    assert!(unproved * 50 <= proved, "{unproved} are unproved, {proved} are proved");
}

#[test]
fn quotients_and_remainders_by_constants_are_proved_whatever_becomes_of_them() {
    let types = [Sint, Int, Dint, Lint, Usint, Uint, Udint, Ulint, Time];
    for ty in types {
        for divisor in [-128, -10, -8, -3, -1, 0, 1, 2, 3, 5, 7, 10, 16, 60, 64, 100, 127] {
            let Some(divisor) = Value::integer(ty, divisor) else { continue };
            for op in [Binary::Divide, Binary::Remainder, Binary::Multiply] {
                let before = program(&[ty], ty, |logic, x| {
                    let divisor = logic.constant(divisor);
                    logic.binary(op, x[0], divisor)
                });
                let (_, report) = optimise_proved(before, PASSES).expect("no difference");
                assert_eq!(report.unproved, [], "{} {ty} by {divisor:?}", op.mnemonic());
            }
        }
    }
    for (ty, divisor) in [(Real, 2.0), (Real, -0.125), (Real, 1e-38), (Lreal, 1024.0), (Lreal, 3.0)] {
        let divisor = Value::real(ty, divisor).expect("a real");
        let before = program(&[ty], ty, |logic, x| {
            let divisor = logic.constant(divisor);
            logic.binary(Binary::Divide, x[0], divisor)
        });
        let (_, report) = optimise_proved(before, PASSES).expect("no difference");
        assert_eq!(report.unproved, [], "{ty} by {divisor:?}");
    }
}

#[test]
fn what_is_narrowed_is_proved() {
    let integers = [Sint, Int, Dint, Usint, Uint, Udint, Byte];
    for ty in integers {
        for wide in [Dint, Lint, Ulint, Time].into_iter().filter(|wide| wide.bits() > ty.bits()) {
            for op in [Binary::Add, Binary::Subtract, Binary::Multiply] {
                let before = program(&[ty, ty], ty, |logic, x| {
                    let wide = [x[0], x[1]].map(|value| logic.convert(value, wide));
                    let value = logic.binary(op, wide[0], wide[1]);
                    logic.convert(value, ty)
                });
                let (after, report) = optimise_proved(before, PASSES).expect("no difference");
                assert_eq!(report.unproved, [], "{} of {ty} by way of {wide}:\n{after:#?}", op.mnemonic());
            }
        }
    }
}

#[test]
fn arrays_are_proved_element_by_element_however_long_they_are() {
    for count in [3, 64, 65, 5000] {
        let mut layout = LayoutBuilder::new();
        let mut slot = |name: String, ty: Elementary| {
            let (area, initial) = (crate::logic::Area::Memory, Value::default_of(ty));
            layout.slot(Slot { name: name.into(), ty, offset: 0, area, retain: false, initial, line: 0 })
        };
        let elements: Vec<SlotId> = (0..count).map(|element| slot(format!("x[{element}]"), Int)).collect();
        let (index, enable, result) = (slot("i".into(), Lint), slot("e".into(), Bool), slot("y".into(), Int));
        let array = layout.array(elements[0], count);
        let mut logic = Builder::new("p", layout.finish(None).expect("an image"));
        let (at, enabled) = (logic.load(index), logic.load(enable));
        let (one, first) = (logic.constant(Value::from_bits(Lint, 1)), logic.load(elements[0]));
        let next = logic.binary(Binary::Add, at, one);
        let old = logic.load_indexed(array, next);
        let value = logic.select(enabled, first, old);
        logic.store_indexed(array, next, value);
        let constant = logic.constant(Value::from_bits(Lint, 2));
        let third = logic.load_indexed(array, constant);
        logic.store(result, third);
        logic.store_indexed(array, constant, third);
        logic.end_section(Origin { label: "r".into(), line: 1 });
        let before = logic.finish();
        let (after, report) = optimise_proved(before.clone(), PASSES).expect("no difference");
        assert_ne!(before, after, "the constant index is a slot now");
        assert_eq!((report.proved(), report.unproved.len()), (count as usize + 1, 0));
        // An index that is one off is seen, also where elements are not told apart by samples.
        let mut wrong = after.clone();
        let place = wrong.instructions.iter().rposition(|instruction| matches!(instruction.op, Op::StoreIndexed(..)));
        if let Op::StoreIndexed(array, _, value) = wrong.instructions[place.expect("a store")].op {
            let at = wrong.instructions.iter().position(|instruction| instruction.op == Op::Load(index));
            let at = crate::logic::ValueId(u32::try_from(at.expect("the index is loaded")).expect("few"));
            wrong.instructions[place.expect("a store")].op = Op::StoreIndexed(array, at, value);
        }
        assert!(super::super::compare(&before, &wrong).is_err(), "of {count} elements");
    }
}

#[test]
fn a_section_that_is_cut_is_proved_against_the_whole() {
    let mut layout = LayoutBuilder::new();
    let slots: Vec<SlotId> = (0..20)
        .map(|index| {
            let (name, initial) = (format!("x{index}"), Value::bool(false));
            let area = crate::logic::Area::Memory;
            layout.slot(Slot { name: name.into(), ty: Bool, offset: 0, area, retain: false, initial, line: 0 })
        })
        .collect();
    let mut logic = Builder::new("p", layout.finish(None).expect("a small image"));
    for length in [10, 9000, 10] {
        for place in 0..length {
            let (a, b) = (logic.load(slots[place % 20]), logic.load(slots[place * 7 % 20]));
            let value = if place % 3 == 0 { logic.or(a, b) } else { logic.and(a, b) };
            logic.store(slots[place * 3 % 20], value);
        }
        logic.end_section(Origin { label: format!("r{length}").into(), line: 1 });
    }
    let before = logic.finish();
    let (after, report) = optimise_proved(before.clone(), PASSES).expect("no difference");
    assert!(after.sections.len() > before.sections.len(), "it is cut");
    assert_eq!(report.unproved, []);
    assert!(report.proved() >= 40, "{report}");
}
