//! The fast interpreter against the textbook one, and what its translation comes to.

use rung_runtime::Scan;

use super::{Interpreter, Textbook};
use crate::elementary::{Elementary, Value};
use crate::logic::{
    Area, Binary, Builder, CHUNK_SECTIONS, Compare, LayoutBuilder, Origin, Program, Slot, SlotId, ValueId, random,
};

#[test]
fn both_interpreters_agree_on_the_whole_image() {
    for seed in 0..600 {
        let program = random::program(seed);
        let (mut textbook, mut interpreter) = (Textbook::new(&program), Interpreter::new(&program));
        for round in 0..8 {
            let mut expected = random::image(&program.layout, seed ^ round << 32);
            let mut actual = expected.clone();
            // The second scan starts from what the first one left.
            for scan in 0..2 {
                let now = random::now(seed + round * 1000 + scan);
                textbook.scan(&mut expected, now);
                interpreter.scan(&mut actual, now);
                assert_eq!(expected, actual, "seed {seed}, round {round}, scan {scan}");
            }
        }
    }
}

/// One section over slots of these types, which is given their ids.
fn program(types: &[Elementary], section: impl Fn(&mut Builder, &[SlotId])) -> Program {
    let mut layout = LayoutBuilder::new();
    let slots: Vec<SlotId> = (0..)
        .zip(types)
        .map(|(line, ty)| {
            let (name, initial) = (format!("x{line}"), Value::default_of(*ty));
            layout.slot(Slot {
                name: name.into(),
                ty: *ty,
                offset: 0,
                area: Area::Memory,
                retain: false,
                initial,
                line,
            })
        })
        .collect();
    let mut builder = Builder::new("p", layout.finish(None).unwrap());
    section(&mut builder, &slots);
    builder.end_section(Origin { label: "r".into(), line: 1 });
    builder.finish()
}

/// How many gates and steps a program becomes, after a check that it still means the same from some images.
fn gates_and_steps(program: &Program) -> (usize, usize) {
    let (mut textbook, mut interpreter) = (Textbook::new(program), Interpreter::new(program));
    for seed in 0..64 {
        let mut expected = random::image(&program.layout, seed);
        let mut actual = expected.clone();
        textbook.scan(&mut expected, 5);
        interpreter.scan(&mut actual, 5);
        assert_eq!(expected, actual, "seed {seed}");
    }
    (interpreter.gates.len(), interpreter.steps.len())
}

#[test]
fn a_rung_of_few_contacts_is_one_gate() {
    let seal_in = program(&[Elementary::Bool; 4], |builder, slots| {
        let [start, pump, stop, low] = [0, 1, 2, 3].map(|index| builder.load(slots[index]));
        let (open, sealed) = (builder.not(stop), builder.or(start, pump));
        let held = builder.and(sealed, open);
        let power = builder.and(held, low);
        builder.store(slots[1], power);
    });
    assert_eq!(gates_and_steps(&seal_in), (1, 0));
}

#[test]
fn contacts_beyond_a_gates_inputs_chain_gates() {
    let series = program(&[Elementary::Bool; 11], |builder, slots| {
        let contacts: Vec<ValueId> = slots[..10].iter().map(|slot| builder.load(*slot)).collect();
        let power = contacts.into_iter().reduce(|left, right| builder.and(left, right)).unwrap();
        builder.store(slots[10], power);
    });
    assert_eq!(gates_and_steps(&series), (3, 0));
}

#[test]
fn a_result_goes_straight_to_the_slot_that_gets_it_later() {
    let count = program(&[Elementary::Time, Elementary::Time, Elementary::Bool], |builder, slots| {
        let (total, limit) = (builder.load(slots[0]), builder.load(slots[1]));
        let more = builder.binary(Binary::Add, total, limit);
        let over = builder.compare(Compare::Greater, more, limit);
        builder.store(slots[0], more);
        builder.store(slots[2], over);
    });
    assert_eq!(gates_and_steps(&count), (0, 2));
}

#[test]
fn what_was_loaded_before_a_store_stays_as_it_was() {
    let swap = program(&[Elementary::Lint, Elementary::Lint, Elementary::Bool, Elementary::Bool], |builder, slots| {
        let values: Vec<ValueId> = slots.iter().map(|slot| builder.load(*slot)).collect();
        for (slot, value) in slots.iter().zip([1, 0, 3, 2]) {
            builder.store(*slot, values[value]);
        }
    });
    assert_eq!(gates_and_steps(&swap), (3, 3));
}

#[test]
fn a_store_of_what_the_slot_holds_costs_nothing() {
    let program = program(&[Elementary::Bool, Elementary::Real], |builder, slots| {
        for slot in slots {
            let value = builder.load(*slot);
            builder.store(*slot, value);
        }
    });
    assert_eq!(gates_and_steps(&program), (0, 0));
}

#[test]
fn a_constant_is_the_same_where_something_wider_lay_before() {
    let types = [Elementary::Lint, Elementary::Lint, Elementary::Int, Elementary::Int];
    let program = program(&types, |builder, slots| {
        let [wide, other] = [0, 1].map(|index| builder.load(slots[index]));
        let sum = builder.binary(Binary::Add, wide, other);
        let chosen = builder.binary(Binary::Subtract, sum, wide);
        builder.store(slots[0], chosen);
        builder.end_section(Origin { label: "wide".into(), line: 1 });
        // The next chunk uses the same cells.
        for _ in 1..CHUNK_SECTIONS {
            builder.end_section(Origin { label: "empty".into(), line: 1 });
        }
        let [a, b] = [2, 3].map(|index| builder.load(slots[index]));
        let holds = builder.bool(true);
        let first = builder.select(holds, a, b);
        builder.store(slots[3], first);
    });
    assert_eq!(gates_and_steps(&program).0, 1);
}

#[test]
fn bytes_that_are_no_slot_stay_as_they_are() {
    let program = program(&[Elementary::Bool, Elementary::Lint], |builder, slots| {
        let value = builder.bool(true);
        builder.store(slots[0], value);
    });
    let mut image = vec![0xAA; program.layout.size() as usize + 5];
    image[0] = 0;
    let mut expected = image.clone();
    expected[0] = 1;
    Interpreter::new(&program).scan(&mut image, 0);
    assert_eq!(image, expected);
}

#[test]
fn a_constant_is_itself_whatever_lay_in_its_cell_before() {
    let mut program = program(&[Elementary::Bool, Elementary::Lint, Elementary::Lint], |builder, slots| {
        // Leaves bytes that are no BOOLs where the next chunk computes.
        let number = builder.load(slots[1]);
        let sum = builder.binary(Binary::Add, number, number);
        let twice = builder.binary(Binary::Add, sum, sum);
        builder.store(slots[1], twice);
        builder.end_section(Origin { label: "first".into(), line: 1 });
        let truth = builder.bool(true);
        let one = builder.convert(truth, Elementary::Lint);
        builder.store(slots[2], one);
    });
    program.sections[1].starts_chunk = true;
    gates_and_steps(&program);
}
