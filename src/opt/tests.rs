//! Each pass before and after. That they change no image is tested with an engine, in `tests/passes.rs`.

use super::{PASSES, optimise};
use crate::elementary::{Elementary, Value};
use crate::logic::{Area, ArrayId, Binary, Builder, Compare, LayoutBuilder, Op, Origin, Program, Slot, SlotId};

/// A program over BOOLs `a` to `e` and an INT `n`, made by `sections`, one after another.
fn program(sections: &[fn(&mut Builder, &[SlotId])]) -> Program {
    let mut layout = LayoutBuilder::new();
    let mut slot = |name: &str, ty| {
        let (name, initial) = (name.to_owned(), Value::default_of(ty));
        layout.slot(Slot { name, ty, offset: 0, area: Area::Memory, retain: false, initial, line: 0 })
    };
    let mut slots: Vec<SlotId> = ["a", "b", "c", "d", "e"].map(|name| slot(name, Elementary::Bool)).to_vec();
    slots.push(slot("n", Elementary::Int));
    let mut logic = Builder::new("p", layout.finish(None).expect("a small image"));
    for section in sections {
        section(&mut logic, &slots);
        logic.end_section(Origin { label: "r".into(), line: 1 });
    }
    logic.finish()
}

fn pass(name: &str, program: Program) -> Program {
    let pass = PASSES.iter().find(|pass| pass.name == name).expect("a pass of that name");
    (pass.run)(program)
}

/// The instructions after a pass and the sweep.
fn after(name: &str, sections: &[fn(&mut Builder, &[SlotId])]) -> String {
    print(&pass("sweep", pass(name, program(sections))))
}

/// One instruction after another, slots by name and values by place.
fn print(program: &Program) -> String {
    let name = |slot: SlotId| program.layout.slot(slot).name.clone();
    let mut out = Vec::new();
    for (index, instruction) in program.instructions.iter().enumerate() {
        out.push(match instruction.op {
            Op::Constant(bits) => format!("v{index} = {bits}"),
            Op::Now => format!("v{index} = now"),
            Op::Load(slot) => format!("v{index} = {}", name(slot)),
            Op::Store(slot, a) => format!("{} := {a}", name(slot)),
            Op::LoadIndexed(array, place) => format!("v{index} = {array}[{place}]"),
            Op::StoreIndexed(array, place, a) => format!("{array}[{place}] := {a}"),
            Op::CopyArray(to, from, condition) => format!("{to} := {from} while {condition}"),
            Op::Unary(op, a) => format!("v{index} = {} {a}", op.mnemonic()),
            Op::Binary(op, a, b) => format!("v{index} = {} {a} {b}", op.mnemonic()),
            Op::Compare(op, a, b) => format!("v{index} = {} {a} {b}", op.mnemonic()),
            Op::Select(c, a, b) => format!("v{index} = select {c} {a} {b}"),
            Op::Convert(a) => format!("v{index} = {}({a})", instruction.ty),
            Op::Reinterpret(a) => format!("v{index} = {}'({a})", instruction.ty),
            Op::Call(helper, ..) => {
                let operands: Vec<String> = instruction.op.operands().map(|operand| operand.to_string()).collect();
                format!("v{index} = {} {}", helper.mnemonic(), operands.join(" "))
            }
        });
    }
    out.join("; ")
}

#[test]
fn forward_uses_what_was_stored_or_loaded() {
    let text = after(
        "forward",
        &[|logic, s| {
            let (first, again) = (logic.load(s[0]), logic.load(s[0]));
            let both = logic.and(first, again);
            logic.store(s[1], both);
            let stored = logic.load(s[1]);
            logic.store(s[2], stored);
        }],
    );
    assert_eq!(text, "v0 = a; v1 = and v0 v0; b := v1; c := v1");
}

#[test]
fn forward_reloads_what_was_loaded_in_another_section_and_what_was_stored_far_away() {
    fn copy(logic: &mut Builder, s: &[SlotId]) {
        let value = logic.load(s[0]);
        logic.store(s[1], value);
    }
    fn read(logic: &mut Builder, s: &[SlotId]) {
        let value = logic.load(s[1]);
        logic.store(s[2], value);
    }
    fn nothing(_: &mut Builder, _: &[SlotId]) {}
    assert_eq!(after("forward", &[copy, copy]), "v0 = a; b := v0; v2 = a; b := v2");
    assert_eq!(after("forward", &[copy, read]), "v0 = a; b := v0; c := v0");
    let mut far: Vec<fn(&mut Builder, &[SlotId])> = vec![copy];
    far.extend([nothing as fn(&mut Builder, &[SlotId]); 6]);
    far.push(read);
    assert_eq!(after("forward", &far), "v0 = a; b := v0; v2 = b; c := v2");
}

#[test]
fn nothing_is_forwarded_into_another_chunk_even_behind_an_empty_section() {
    let mut program = program(&[
        |logic, s| {
            let value = logic.load(s[0]);
            logic.store(s[1], value);
        },
        |_, _| {},
        |logic, s| {
            let value = logic.load(s[1]);
            logic.store(s[2], value);
        },
    ]);
    program.sections[1].starts_chunk = true;
    assert_eq!(print(&pass("forward", program)), "v0 = a; b := v0; v2 = b; c := v2");
}

#[test]
fn simplify_drops_neutral_operands_and_double_inversions() {
    let text = after(
        "simplify",
        &[|logic, s| {
            let rail = logic.bool(true);
            let contact = logic.load(s[0]);
            let inverse = logic.not(contact);
            let again = logic.not(inverse);
            let power = logic.and(rail, again);
            let none = logic.bool(false);
            let power = logic.or(none, power);
            let same = logic.and(power, power);
            logic.store(s[1], same);
        }],
    );
    assert_eq!(text, "v0 = a; b := v0");
}

#[test]
fn simplify_makes_selects_of_constants_joins() {
    let text = after(
        "simplify",
        &[|logic, s| {
            let (condition, old) = (logic.load(s[0]), logic.load(s[1]));
            let (on, off) = (logic.bool(true), logic.bool(false));
            let set = logic.select(condition, on, old);
            logic.store(s[1], set);
            let reset = logic.select(condition, off, old);
            logic.store(s[2], reset);
        }],
    );
    assert_eq!(text, "v0 = a; v1 = b; v2 = or v0 v1; b := v2; v4 = not v0; v5 = and v4 v1; c := v5");
}

#[test]
fn simplify_computes_constants_and_turns_comparisons_round() {
    let text = after(
        "simplify",
        &[|logic, s| {
            let two = logic.constant(Value::from_bits(Elementary::Int, 2));
            let four = logic.binary(Binary::Multiply, two, two);
            let count = logic.load(s[5]);
            let less = logic.compare(Compare::Less, count, four);
            let not_less = logic.not(less);
            logic.store(s[0], not_less);
        }],
    );
    assert_eq!(text, "v0 = 4; v1 = n; v2 = ge v1 v0; a := v2");
}

#[test]
fn simplify_turns_no_comparison_of_reals_round_for_a_nan_is_neither_less_nor_not_less() {
    let text = after(
        "simplify",
        &[|logic, s| {
            let count = logic.load(s[5]);
            let real = logic.convert(count, Elementary::Real);
            let less = logic.compare(Compare::Less, real, real);
            let not_less = logic.not(less);
            logic.store(s[0], not_less);
        }],
    );
    assert_eq!(text, "v0 = n; v1 = REAL(v0); v2 = lt v1 v1; v3 = not v2; a := v3");
}

#[test]
fn gather_inverts_once() {
    let text = after(
        "gather",
        &[|logic, s| {
            let loads: Vec<_> = s[..4].iter().map(|slot| logic.load(*slot)).collect();
            let (not_b, not_d) = (logic.not(loads[1]), logic.not(loads[3]));
            let power = logic.and(loads[0], not_b);
            let power = logic.and(power, loads[2]);
            let power = logic.and(power, not_d);
            logic.store(s[4], power);
        }],
    );
    assert_eq!(
        text,
        "v0 = a; v1 = b; v2 = c; v3 = d; v4 = or v1 v3; v5 = not v4; v6 = and v0 v5; v7 = and v6 v2; e := v7"
    );
}

#[test]
fn gather_leaves_alone_what_has_another_use() {
    let text = after(
        "gather",
        &[|logic, s| {
            let (a, b, c) = (logic.load(s[0]), logic.load(s[1]), logic.load(s[2]));
            let part = logic.and(a, b);
            logic.store(s[3], part);
            let not_c = logic.not(c);
            let power = logic.and(part, not_c);
            logic.store(s[4], power);
        }],
    );
    assert_eq!(text, "v0 = a; v1 = b; v2 = c; v3 = and v0 v1; d := v3; v5 = not v2; v6 = and v3 v5; e := v6");
}

#[test]
fn sweep_removes_unused_values_and_stores_that_nobody_sees() {
    let text = print(&pass(
        "sweep",
        program(&[
            |logic, s| {
                let (a, b) = (logic.load(s[0]), logic.load(s[1]));
                logic.and(a, b);
                logic.store(s[2], a);
                logic.store(s[2], b);
                logic.store(s[3], a);
                let read = logic.load(s[3]);
                logic.store(s[3], b);
                logic.store(s[4], read);
            },
            |logic, s| {
                let a = logic.load(s[0]);
                logic.store(s[2], a);
            },
        ]),
    ));
    assert_eq!(text, "v0 = a; v1 = b; c := v1; d := v0; v4 = d; d := v1; e := v4; v7 = a; c := v7");
}

#[test]
fn a_tree_of_a_hundred_thousand_contacts_is_gathered() {
    let program = program(&[|logic, s| {
        let mut power = logic.load(s[0]);
        for _ in 0..100_000 {
            let contact = logic.load(s[1]);
            let open = logic.not(contact);
            power = logic.and(power, open);
        }
        logic.store(s[2], power);
    }]);
    assert!(optimise(program).instructions.len() < 400_000);
}

/// A program over arrays `x` and `y` of three INTs, INTs `n` and `m`, and a LINT `i`, of one section.
fn over_arrays(section: impl Fn(&mut Builder, [ArrayId; 2], &[SlotId])) -> Program {
    let mut layout = LayoutBuilder::new();
    let mut slot = |name: &str, ty| {
        let (name, initial) = (name.to_owned(), Value::default_of(ty));
        layout.slot(Slot { name, ty, offset: 0, area: Area::Memory, retain: false, initial, line: 0 })
    };
    let names = ["x[0]", "x[1]", "x[2]", "y[0]", "y[1]", "y[2]", "n", "m"];
    let mut slots = names.map(|name| slot(name, Elementary::Int)).to_vec();
    slots.push(slot("i", Elementary::Lint));
    let arrays = [slots[0], slots[3]].map(|first| layout.array(first, 3));
    let mut logic = Builder::new("p", layout.finish(None).expect("a small image"));
    section(&mut logic, arrays, &slots);
    logic.end_section(Origin { label: "r".into(), line: 1 });
    logic.finish()
}

fn lint(value: i64) -> Value {
    Value::from_bits(Elementary::Lint, value.cast_unsigned())
}

#[test]
fn fold_makes_an_element_with_a_constant_index_its_slot() {
    let program = over_arrays(|logic, [x, y], s| {
        let (one, two) = (logic.constant(lint(1)), logic.constant(lint(2)));
        let last = logic.binary(Binary::Subtract, two, one);
        let element = logic.load_indexed(x, last);
        logic.store_indexed(y, two, element);
        let beyond = logic.binary(Binary::Add, two, one);
        let none = logic.load_indexed(x, beyond);
        logic.store(s[6], none);
        logic.store_indexed(y, beyond, element);
        let below = logic.binary(Binary::Subtract, one, two);
        logic.store_indexed(y, below, element);
    });
    assert_eq!(print(&pass("sweep", pass("fold", program))), "v0 = x[1]; y[2] := v0; v2 = 0; n := v2");
}

#[test]
fn an_index_that_is_constant_only_after_forwarding_is_found_too() {
    let program = over_arrays(|logic, [x, _], s| {
        let two = logic.constant(lint(2));
        logic.store(s[8], two);
        let (index, value) = (logic.load(s[8]), logic.load(s[6]));
        logic.store_indexed(x, index, value);
    });
    assert_eq!(print(&optimise(program)), "v0 = 2; i := v0; v2 = n; x[2] := v2");
}

#[test]
fn fold_drops_copies_that_change_nothing() {
    let program = over_arrays(|logic, [x, y], s| {
        let (never, always) = (logic.bool(false), logic.bool(true));
        logic.copy_array(x, y, Some(never));
        logic.copy_array(x, x, Some(always));
        let index = logic.load(s[8]);
        let zero = logic.constant(lint(0));
        let sometimes = logic.compare(Compare::Less, index, zero);
        logic.copy_array(x, x, Some(sometimes));
        logic.copy_array(x, y, Some(always));
        logic.copy_array(y, x, Some(sometimes));
    });
    let expected = "v0 = 1; v1 = i; v2 = 0; v3 = lt v1 v2; a0 := a1 while v0; a1 := a0 while v3";
    assert_eq!(print(&pass("sweep", pass("fold", program))), expected);
}

#[test]
fn an_indexed_store_and_a_copy_change_only_their_arrays_and_a_copy_sees_all_of_the_other() {
    let program = over_arrays(|logic, [x, y], s| {
        let (n, m, index) = (logic.load(s[6]), logic.load(s[7]), logic.load(s[8]));
        // Seen by the copy, though it is overwritten after.
        logic.store(s[3], n);
        logic.copy_array(x, y, None);
        logic.store(s[3], m);
        logic.store_indexed(x, index, n);
        let (same, other) = (logic.load(s[3]), logic.load(s[0]));
        logic.store(s[4], same);
        logic.store(s[5], other);
    });
    assert_eq!(
        print(&pass("sweep", pass("forward", program))),
        "v0 = n; v1 = m; v2 = i; y[0] := v0; v4 = 1; a0 := a1 while v4; y[0] := v1; a0[v2] := v0; v8 = x[0]; y[1] := v1; y[2] := v8"
    );
}

#[test]
fn an_indexed_store_may_change_every_element_and_an_indexed_load_sees_all() {
    let mut layout = LayoutBuilder::new();
    let mut slot = |name: &str, ty| {
        let (name, initial) = (name.to_owned(), Value::default_of(ty));
        layout.slot(Slot { name, ty, offset: 0, area: Area::Memory, retain: false, initial, line: 0 })
    };
    let (first, second) = (slot("x", Elementary::Int), slot("y", Elementary::Int));
    let (other, index) = (slot("z", Elementary::Int), slot("i", Elementary::Lint));
    let array = layout.array(first, 2);
    let mut logic = Builder::new("p", layout.finish(None).expect("a small image"));
    let (at, value) = (logic.load(index), logic.load(other));
    logic.store(second, value);
    logic.store_indexed(array, at, value);
    let again = logic.load(second);
    logic.store(first, again);
    let element = logic.load_indexed(array, at);
    logic.store(first, value);
    logic.store(other, element);
    logic.end_section(Origin { label: "r".into(), line: 1 });
    let text = print(&pass("sweep", pass("forward", logic.finish())));
    let expected = "v0 = i; v1 = z; y := v1; a0[v0] := v1; v4 = y; x := v4; v6 = a0[v0]; x := v1; z := v6";
    assert_eq!(text, expected);
}
