//! Very long sections.

use super::{pass, program};
use crate::logic::verify;
use crate::opt::check;

#[test]
fn a_long_section_is_cut_where_no_value_crosses_and_constants_are_made_again() {
    let program = program(&[
        |logic, s| {
            let a = logic.load(s[0]);
            logic.store(s[1], a);
        },
        |logic, s| {
            let (rail, now) = (logic.bool(true), logic.now());
            let zero = logic.constant(crate::elementary::Value::time(0));
            for step in 0..3000 {
                let contact = logic.load(s[step % 4]);
                let power = logic.and(rail, contact);
                let later = logic.compare(crate::logic::Compare::Greater, now, zero);
                let power = logic.or(power, later);
                logic.store(s[(step + 1) % 4], power);
            }
        },
    ]);
    let cut = pass("cut", program.clone());
    assert_eq!(verify(&cut), Ok(()));
    assert_eq!(cut.sections.len(), 1 + 15_000 / 2050);
    assert!(cut.sections[1..].iter().all(|section| section.origin == 1));
    assert_eq!(cut.tasks[0].end as usize, cut.sections.len());
    assert_eq!(check::difference(&program, &cut, 4), None);
    let chunked = pass("chunk", cut);
    assert_eq!(verify(&chunked), Ok(()));
    assert!(chunked.chunks().len() > 3);
}

#[test]
fn what_a_value_crosses_stays_whole_and_so_does_what_is_short() {
    let crossed = program(&[|logic, s| {
        let enabled = logic.load(s[4]);
        for step in 0..3000 {
            let contact = logic.load(s[step % 4]);
            let power = logic.and(enabled, contact);
            logic.store(s[(step + 1) % 4], power);
        }
    }]);
    assert_eq!(pass("cut", crossed.clone()), crossed);
    let short = program(&[|logic, s| {
        for step in 0..1000 {
            let contact = logic.load(s[step % 4]);
            logic.store(s[(step + 1) % 4], contact);
        }
    }]);
    assert_eq!(pass("cut", short.clone()), short);
}
