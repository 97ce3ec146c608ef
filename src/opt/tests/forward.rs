//! Loads and stores whose value is at hand.

use super::{after, lint, over_arrays, pass, print, program};
use crate::elementary::{Elementary, Value};
use crate::logic::{Area, Builder, LayoutBuilder, Origin, Slot, SlotId};
use crate::opt::optimise;

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
fn forward_reloads_what_was_loaded_or_stored_far_away_and_drops_stores_of_what_is_there() {
    fn copy(logic: &mut Builder, s: &[SlotId]) {
        let value = logic.load(s[0]);
        logic.store(s[1], value);
    }
    fn read(logic: &mut Builder, s: &[SlotId]) {
        let value = logic.load(s[1]);
        logic.store(s[2], value);
    }
    fn load(logic: &mut Builder, s: &[SlotId]) {
        let value = logic.load(s[0]);
        logic.store(s[3], value);
    }
    fn nothing(_: &mut Builder, _: &[SlotId]) {}
    assert_eq!(after("forward", &[copy, copy]), "v0 = a; b := v0");
    assert_eq!(after("forward", &[copy, read]), "v0 = a; b := v0; c := v0");
    let mut far: Vec<fn(&mut Builder, &[SlotId])> = vec![copy];
    far.extend([nothing as fn(&mut Builder, &[SlotId]); 6]);
    far.extend([read as fn(&mut Builder, &[SlotId]), load]);
    assert_eq!(after("forward", &far), "v0 = a; b := v0; v2 = b; c := v2; v4 = a; d := v4");
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
        layout.slot(Slot { name: name.into(), ty, offset: 0, area: Area::Memory, retain: false, initial, line: 0 })
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
