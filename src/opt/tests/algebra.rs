//! Boolean algebra.

use super::{after, program};
use crate::logic::{Builder, SlotId, ValueId};
use crate::opt::optimise;

#[test]
fn algebra_inverts_once() {
    let text = after(
        "algebra",
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
fn algebra_leaves_alone_what_has_another_use() {
    let text = after(
        "algebra",
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

/// What a tree over the contacts `a` to `d` becomes whose value goes to `e`.
fn tree(make: fn(&mut Builder, [ValueId; 4]) -> ValueId) -> String {
    let mut program = program(&[|_, _| {}]);
    let mut logic = Builder::new("p", program.layout.clone());
    let contacts = [0, 1, 2, 3].map(|place| logic.load(SlotId(place)));
    let value = make(&mut logic, contacts);
    logic.store(SlotId(4), value);
    logic.end_section(program.origins.remove(0));
    super::print(&super::pass("sweep", super::pass("algebra", logic.finish())))
}

#[test]
fn what_others_say_already_is_absorbed() {
    let a_alone = "v0 = a; e := v0";
    let either = |logic: &mut Builder, [a, b, ..]: [ValueId; 4]| {
        let both = logic.and(a, b);
        logic.or(a, both)
    };
    assert_eq!(tree(either), a_alone);
    let both = |logic: &mut Builder, [a, b, ..]: [ValueId; 4]| {
        let either = logic.or(a, b);
        logic.and(a, either)
    };
    assert_eq!(tree(both), a_alone);
    let without_the_inverse = |logic: &mut Builder, [a, b, ..]: [ValueId; 4]| {
        let not_a = logic.not(a);
        let second = logic.and(not_a, b);
        logic.or(a, second)
    };
    assert_eq!(tree(without_the_inverse), "v0 = a; v1 = b; v2 = or v0 v1; e := v2");
    let longer = |logic: &mut Builder, [a, b, c, _]: [ValueId; 4]| {
        let short = logic.and(a, b);
        let again = logic.and(b, a);
        let long = logic.and(again, c);
        logic.or(short, long)
    };
    assert_eq!(tree(longer), "v0 = a; v1 = b; v2 = and v0 v1; e := v2");
}

#[test]
fn what_cannot_be_is_constant() {
    let never = |logic: &mut Builder, [a, b, ..]: [ValueId; 4]| {
        let not_a = logic.not(a);
        let both = logic.and(a, b);
        logic.and(both, not_a)
    };
    assert_eq!(tree(never), "v0 = 0; e := v0");
    let always = |logic: &mut Builder, [a, b, ..]: [ValueId; 4]| {
        let not_a = logic.not(a);
        let either = logic.or(a, b);
        logic.or(either, not_a)
    };
    assert_eq!(tree(always), "v0 = 1; e := v0");
}

#[test]
fn a_common_factor_is_taken_out() {
    let sums = |logic: &mut Builder, [a, b, c, d]: [ValueId; 4]| {
        let first = logic.and(a, b);
        let second = logic.and(c, a);
        let third = logic.and(a, d);
        let either = logic.or(first, second);
        logic.or(either, third)
    };
    assert_eq!(tree(sums), "v0 = a; v1 = b; v2 = c; v3 = d; v4 = or v1 v2; v5 = or v4 v3; v6 = and v5 v0; e := v6");
    let products = |logic: &mut Builder, [a, b, c, _]: [ValueId; 4]| {
        let first = logic.or(a, b);
        let second = logic.or(a, c);
        logic.and(first, second)
    };
    assert_eq!(tree(products), "v0 = a; v1 = b; v2 = c; v3 = and v1 v2; v4 = or v3 v0; e := v4");
}

#[test]
fn an_inversion_is_put_where_the_next_instruction_takes_it() {
    // Not: an inversion of `b`, an OR, an AND.
    let within = |logic: &mut Builder, [a, b, c, _]: [ValueId; 4]| {
        let not_b = logic.not(b);
        let either = logic.or(a, not_b);
        logic.and(either, c)
    };
    assert_eq!(
        tree(within),
        "v0 = a; v1 = b; v2 = c; v3 = not v0; v4 = and v1 v3; v5 = not v4; v6 = and v2 v5; e := v6"
    );
    let nothing_holds = |logic: &mut Builder, [a, b, ..]: [ValueId; 4]| {
        let (not_a, not_b) = (logic.not(a), logic.not(b));
        logic.and(not_a, not_b)
    };
    assert_eq!(tree(nothing_holds), "v0 = a; v1 = b; v2 = or v0 v1; v3 = not v2; e := v3");
}

#[test]
fn equal_trees_of_a_section_are_one() {
    let text = after(
        "algebra",
        &[|logic, s| {
            let [a, b, c] = [0, 1, 2].map(|place| logic.load(s[place]));
            let first = logic.and(a, b);
            let power = logic.and(first, c);
            logic.store(s[3], power);
            let second = logic.and(c, a);
            let again = logic.and(b, second);
            logic.store(s[4], again);
        }],
    );
    assert_eq!(text, "v0 = a; v1 = b; v2 = c; v3 = and v0 v1; v4 = and v3 v2; d := v4; e := v4");
}

#[test]
fn trees_that_alternate_ten_thousand_times_are_taken_apart_piece_by_piece() {
    let program = program(&[|logic, s| {
        let mut power = logic.load(s[0]);
        for _ in 0..10_000 {
            let (b, c) = (logic.load(s[1]), logic.load(s[2]));
            power = logic.and(power, b);
            power = logic.or(power, c);
        }
        logic.store(s[3], power);
    }]);
    assert!(super::pass("algebra", program).instructions.len() < 60_000);
}
