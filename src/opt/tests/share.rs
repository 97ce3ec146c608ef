//! What was computed already.

use super::{after, over_arrays, pass, print, program};
use crate::elementary::{Elementary, Value};
use crate::logic::{Binary, Builder, SlotId};

fn rung(logic: &mut Builder, s: &[SlotId]) {
    let (a, b, c) = (logic.load(s[0]), logic.load(s[1]), logic.load(s[2]));
    let both = logic.and(a, b);
    let power = logic.and(both, c);
    logic.store(s[3], power);
}

fn same_start(logic: &mut Builder, s: &[SlotId]) {
    let (b, a) = (logic.load(s[1]), logic.load(s[0]));
    let both = logic.and(b, a);
    logic.store(s[4], both);
}

#[test]
fn what_a_rung_shortly_before_computed_is_used_again_whatever_the_order() {
    assert_eq!(
        after("share", &[rung, same_start]),
        "v0 = a; v1 = b; v2 = c; v3 = and v0 v1; v4 = and v3 v2; d := v4; e := v3"
    );
}

#[test]
fn nothing_is_shared_across_a_store_far_away_or_into_another_chunk() {
    let anew = "v0 = a; v1 = b; v2 = c; v3 = and v0 v1; v4 = and v3 v2; d := v4; ";
    fn changes(logic: &mut Builder, s: &[SlotId]) {
        let c = logic.load(s[2]);
        logic.store(s[0], c);
    }
    let behind = "v6 = c; a := v6; v8 = b; v9 = a; v10 = and v8 v9; e := v10";
    assert_eq!(after("share", &[rung, changes, same_start]), format!("{anew}{behind}"));
    fn nothing(_: &mut Builder, _: &[SlotId]) {}
    let mut far: Vec<fn(&mut Builder, &[SlotId])> = vec![rung];
    far.extend([nothing as fn(&mut Builder, &[SlotId]); 6]);
    far.push(same_start);
    let again = format!("{anew}v6 = b; v7 = a; v8 = and v6 v7; e := v8");
    assert_eq!(after("share", &far), again);
    let mut chunks = program(&[rung, same_start]);
    chunks.sections[1].starts_chunk = true;
    assert_eq!(print(&pass("sweep", pass("share", chunks))), again);
}

#[test]
fn a_store_of_what_a_slot_held_is_seen_through() {
    let text = after(
        "share",
        &[|logic, s| {
            let (a, n) = (logic.load(s[0]), logic.load(s[5]));
            let two = logic.constant(Value::from_bits(Elementary::Int, 2));
            let sum = logic.binary(Binary::Add, n, two);
            logic.store(s[5], sum);
            let again = logic.load(s[5]);
            let twice = logic.binary(Binary::Add, two, sum);
            let same = logic.binary(Binary::Add, again, two);
            let differ = logic.compare(crate::logic::Compare::NotEqual, twice, same);
            let power = logic.and(differ, a);
            logic.store(s[1], power);
        }],
    );
    assert_eq!(
        text,
        "v0 = a; v1 = n; v2 = 2; v3 = add v1 v2; n := v3; v5 = add v2 v3; v6 = ne v5 v5; v7 = and v6 v0; b := v7"
    );
}

#[test]
fn an_element_is_loaded_again_only_behind_a_store_of_one() {
    let program = over_arrays(|logic, [x, y], s| {
        let index = logic.load(s[8]);
        let (first, second) = (logic.load_indexed(x, index), logic.load_indexed(x, index));
        logic.store(s[6], first);
        logic.store(s[7], second);
        logic.store_indexed(y, index, first);
        let third = logic.load_indexed(x, index);
        logic.store(s[6], third);
    });
    assert_eq!(
        print(&pass("share", program)),
        "v0 = i; v1 = a0[v0]; n := v1; m := v1; a1[v0] := v1; v5 = a0[v0]; n := v5"
    );
}
