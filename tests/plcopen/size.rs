//! A file as large as any plant's.

use std::fmt::Write;

use crate::drawing::{block, coil, contact, contact_with, locals, program, rail, value};
use crate::parse;

/// A ladder of so many rungs: four contacts, one of them in parallel, and a coil; every tenth has a timer.
fn ladder(rungs: u32) -> String {
    let mut names = String::new();
    for n in 0..rungs {
        write!(names, "v{n} ").expect("a string takes text");
    }
    let timers: String = (0..rungs.div_ceil(10)).map(|n| format!("t{n} ")).collect();
    let mut elements = vec![rail()];
    for n in 0..rungs {
        let id = 10 + n * 10;
        let name = |offset: u32| format!("v{}", (n + offset) % rungs);
        elements.push(contact(id, &name(1), "1"));
        elements.push(contact(id + 1, &name(0), "1"));
        elements.push(contact_with(id + 2, &name(7), &format!("{id} {}", id + 1), "negated='true'"));
        elements.push(contact(id + 3, &name(30), &(id + 2).to_string()));
        let mut last = (id + 3).to_string();
        if n % 10 == 0 {
            elements.push(value(id + 4, "T#100ms"));
            elements.push(block(id + 5, "TON", &format!("t{}", n / 10), &format!("IN={last} PT={}", id + 4), "Q ET"));
            last = format!("{}.Q", id + 5);
        }
        elements.push(coil(id + 6, &name(0), &last));
    }
    program(&(locals(&names, "BOOL") + &locals(&timers, "TON")), "LD", &elements)
}

#[test]
fn ten_thousand_rungs_are_read() {
    let text = ladder(10_000);
    let parsed = parse(&text);
    assert!(parsed.diagnostics.is_empty(), "{:?}", parsed.diagnostics.first());
    assert_eq!(parsed.program.rungs().count(), 10_000);
}
