//! The checker.

use super::program;
use crate::logic::{Binary, Op, Unary, random};
use crate::opt::check::difference;

#[test]
fn a_difference_is_named_by_the_rung_that_stores_it() {
    let mut before = program(&[
        |logic, s| {
            let (a, b) = (logic.load(s[0]), logic.load(s[1]));
            let both = logic.and(a, b);
            logic.store(s[2], both);
        },
        |logic, s| {
            let (a, b) = (logic.load(s[0]), logic.load(s[1]));
            let both = logic.and(a, b);
            logic.store(s[3], both);
        },
    ]);
    (before.origins[1].label, before.origins[1].line) = ("wrong".into(), 7);
    assert_eq!(difference(&before, &before, 8), None);
    let mut after = before.clone();
    for instruction in after.instructions.iter_mut().skip(4) {
        if let Op::Binary(_, a, b) = instruction.op {
            instruction.op = Op::Binary(Binary::Or, a, b);
        }
    }
    let found = difference(&before, &after, 8).expect("they differ where one of `a` and `b` is TRUE");
    assert_eq!(found.origin.as_ref().map(|origin| origin.label.as_str()), Some("wrong"));
    assert_eq!(found.to_string(), format!("`d` of `wrong` (line 7), on the random image {}", found.seed));
}

#[test]
fn a_change_of_any_operation_of_random_programs_that_is_seen_is_found() {
    let mut found = 0;
    for seed in 0..60 {
        let before = random::program(seed);
        let mut after = before.clone();
        for instruction in &mut after.instructions {
            if let Op::Binary(Binary::And, a, _) = instruction.op {
                instruction.op = Op::Unary(Unary::Not, a);
            }
        }
        found += usize::from(difference(&before, &after, 8).is_some());
    }
    assert!(found > 10, "only {found}");
}
