//! What nobody sees.

use super::{over_arrays, pass, print, program};

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
    assert_eq!(text, "v0 = a; v1 = b; d := v0; v3 = d; d := v1; e := v3; v6 = a; c := v6");
}

#[test]
fn only_the_last_of_a_chunks_coils_is_stored_unless_a_rung_between_reads_it() {
    let mut program = program(&[
        |logic, s| {
            let a = logic.load(s[0]);
            logic.store(s[2], a);
            logic.store(s[3], a);
        },
        |logic, s| {
            let seen = logic.load(s[3]);
            logic.store(s[4], seen);
        },
        |logic, s| {
            let b = logic.load(s[1]);
            logic.store(s[2], b);
            logic.store(s[3], b);
        },
        |logic, s| {
            let a = logic.load(s[0]);
            logic.store(s[4], a);
        },
    ]);
    // Where nobody sees what the second rung stores, nobody sees what it read either.
    assert_eq!(print(&pass("sweep", program.clone())), "v0 = b; c := v0; d := v0; v3 = a; e := v3");
    program.sections[3].starts_chunk = true;
    let text = print(&pass("sweep", program));
    assert_eq!(text, "v0 = a; d := v0; v2 = d; e := v2; v4 = b; c := v4; d := v4; v7 = a; e := v7");
}

#[test]
fn an_indexed_load_and_a_copy_see_what_was_stored() {
    let program = over_arrays(|logic, [x, y], s| {
        let (n, m, index) = (logic.load(s[6]), logic.load(s[7]), logic.load(s[8]));
        logic.store(s[0], n);
        logic.store(s[1], n);
        let element = logic.load_indexed(x, index);
        logic.store(s[0], m);
        logic.store(s[3], n);
        logic.copy_array(x, y, None);
        logic.store(s[3], m);
        logic.store(s[6], element);
    });
    let before = print(&program);
    assert_eq!(print(&pass("sweep", program)), before);
}
