//! Jumps: what they leave out keeps what it held, on every engine and in the evaluator.

use rung::elementary::Value;
use rung::frontend;
use rung::source::Source;

use crate::support::rig::{Rig, checked};

/// The values of a name after scans a second apart, while `a` and `b` follow two lists of 0 and 1.
fn trace(rungs: &str, watched: &str, a: &str, b: &str) -> Vec<Value> {
    let text = format!("program p\ninput a, b\noutput x, y\nvar n, m, k, count : INT\n{rungs}");
    let parsed = frontend::parse(&Source::new("jumps.rung", text.as_str()));
    assert_eq!(parsed.diagnostics, [], "{text}");
    let checked = checked(&parsed.program).unwrap_or_else(|problems| panic!("{problems}"));
    let mut rig = Rig::new(&checked).unwrap();
    let scans = a.bytes().zip(b.bytes()).zip(0..);
    scans
        .map(|((a, b), scan)| {
            rig.set("a", Value::bool(a == b'1'));
            rig.set("b", Value::bool(b == b'1'));
            let same = rig.scan(scan * 1_000_000_000);
            same.unwrap_or_else(|difference| panic!("scan {scan}: {difference:?}\n{text}"));
            rig.oracle.get(watched)
        })
        .collect()
}

/// The same of a BOOL, as 0 and 1.
fn bits(rungs: &str, watched: &str, a: &str, b: &str) -> String {
    trace(rungs, watched, a, b).iter().map(|value| if value.is_true() { '1' } else { '0' }).collect()
}

/// The same of an INT.
fn numbers(rungs: &str, watched: &str, a: &str, b: &str) -> Vec<i128> {
    trace(rungs, watched, a, b).iter().map(|value| value.as_integer().unwrap()).collect()
}

/// How often each scan ran three assignments, as digits: `a` and `b` are off and off, on and off, off and on, on and on.
fn runs(rungs: &str) -> [String; 3] {
    ["n", "m", "k"].map(|counter| {
        let counts = numbers(rungs, counter, "00101", "00011");
        counts.windows(2).map(|pair| (pair[1] - pair[0]).to_string()).collect()
    })
}

#[test]
fn coils_and_assignments_between_a_jump_and_its_rung_hold() {
    let rungs = "rung\n a >> r30\nrung\n b (x)\nrung r30\n b (y)";
    assert_eq!(bits(rungs, "x", "0011001", "0101010"), "0111011");
    assert_eq!(bits(rungs, "y", "0011001", "0101010"), "0101010");
    let rungs = "rung\n a >> r30\nrung\n b (/x) (N y)\nrung r30\n b {n := n + 1}";
    assert_eq!(bits(rungs, "x", "1101", "0001"), "0011");
    assert_eq!(bits(rungs, "y", "1101", "0001"), "0011");
}

#[test]
fn a_timer_that_is_left_out_counts_the_time_that_passes() {
    let timer = |preset: &str| format!("rung\n a >> r30\nrung\n b t:TON(PT := {preset}) (x)\nrung r30\n b (y)");
    assert_eq!(bits(&timer("T#3s"), "x", "0111011", "1111111"), "0000111");
    let elapsed: Vec<i128> =
        trace(&timer("T#9s"), "t.ET", "0011010", "1111111").iter().map(|value| value.as_integer().unwrap()).collect();
    assert_eq!(elapsed.iter().map(|time| time / 1_000_000_000).collect::<Vec<_>>(), [0, 1, 1, 1, 4, 4, 6]);
    let pulse = "rung\n a >> r30\nrung\n b t:TP(PT := T#2s) (x)\nrung r30\n b (y)";
    assert_eq!(bits(pulse, "x", "0111000", "1111111"), "1111000");
}

#[test]
fn an_edge_in_a_rung_that_is_left_out_is_seen_when_it_runs_again() {
    let rungs = "rung\n a >> r30\nrung\n ^b (x)\nrung r30\n b (y)";
    assert_eq!(bits(rungs, "x", "0110000", "0011110"), "0001000");
    // What comes and goes meanwhile nobody sees.
    assert_eq!(bits(rungs, "x", "0111000", "0010000"), "0000000");
    let of_coil = "rung\n a >> r30\nrung\n b (P x)\nrung r30\n b (y)";
    assert_eq!(bits(of_coil, "x", "0110000", "0011110"), "0001000");
}

#[test]
fn a_block_that_is_left_out_holds_its_outputs_and_what_they_are_wired_to() {
    let counter = "rung\n a >> r30\nrung\n b c:CTU(PV := 2, CV => count) (x)\nrung r30\n b (y)";
    assert_eq!(numbers(counter, "count", "0001100", "0101011"), [0, 1, 1, 1, 1, 2, 2]);
    let with_enable = "rung\n a >> r30\nrung\n b c:CTU(CU := [ ^b ], PV := 9, CV => count) (x)\nrung r30\n b (y)";
    assert_eq!(numbers(with_enable, "count", "0000100", "0110111"), [0, 1, 1, 1, 1, 2, 2]);
    let input = "rung\n a >> r30\nrung\n b c:CTU(PV := 2)\nrung r30\n {c.CU AND c.PV = 2} (y)";
    assert_eq!(bits(input, "y", "0010100", "0101010"), "0111110");
}

#[test]
fn a_jump_leaves_out_the_later_elements_and_branches_of_its_own_rung() {
    let rungs = "rung\n [ {n := n + 1} | a >> r20 | {m := m + 1} ] {k := k + 1}\nrung r20\n b (y)";
    assert_eq!(runs(rungs), ["1111", "1010", "1010"]);
    let from_node = "rung\n a >x>\n| >x> >> r20\n| {n := n + 1}\n| >x> {m := m + 1}\nrung r20\n b (y)";
    assert_eq!(runs(from_node), ["1010", "0000", "0000"]);
}

#[test]
fn a_jump_that_is_not_taken_gives_no_power() {
    assert_eq!(bits("rung\n [ b | a >> r20 ] (x)\nrung r20\n b (y)", "x", "0001", "0101"), "0100");
}

#[test]
fn jumps_that_cross_and_jumps_inside_one_another_end_at_their_own_rungs() {
    let rungs = |first: &str, second: &str| {
        format!(
            "rung\n a >> {first}\nrung\n [ b >> {second} | {{n := n + 1}} ]\nrung r30\n {{m := m + 1}}\n\
             rung r40\n {{k := k + 1}}\nrung r50\n b (y)"
        )
    };
    assert_eq!(runs(&rungs("r30", "r40")), ["1000", "1101", "1111"]);
    assert_eq!(runs(&rungs("r40", "r30")), ["1000", "1010", "1111"]);
    assert_eq!(runs(&rungs("r40", "r40")), ["1000", "1000", "1111"]);
    assert_eq!(runs(&rungs("r30", "r50")), ["1000", "1101", "1101"]);
}

#[test]
fn of_two_jumps_with_power_the_first_is_taken() {
    let rungs = "rung\n a >> r30\n| b >> r40\nrung\n {n := n + 1}\nrung r30\n {m := m + 1}\nrung r40\n {k := k + 1}";
    assert_eq!(runs(rungs), ["1000", "1101", "1111"]);
}

#[test]
fn return_ends_the_scan() {
    let rungs = "rung\n {n := n + 1} [ a >> return | {m := m + 1} ]\nrung\n {k := k + 1}";
    assert_eq!(runs(rungs), ["1111", "1010", "1010"]);
    let jumped_over = "rung\n b >> last\nrung\n a >> return\nrung\n {n := n + 1}\nrung last\n {m := m + 1}";
    assert_eq!(runs(jumped_over), ["1000", "1011", "0000"]);
}

#[test]
fn a_jump_to_a_rung_that_is_off_goes_on_at_the_next_that_runs() {
    let rungs = "rung\n a >> r20\nrung\n {n := n + 1}\nrung off r20\n {m := m + 1}\nrung r30\n {k := k + 1}";
    assert_eq!(runs(rungs), ["1010", "0000", "1111"]);
    let at_the_end = "rung\n a >> r20\nrung\n {n := n + 1}\nrung off r20\n {m := m + 1}";
    assert_eq!(runs(at_the_end), ["1010", "0000", "0000"]);
}

#[test]
fn a_jump_leads_over_any_number_of_rungs() {
    let between = "rung\n {n := n + 1}\n".repeat(300);
    let rungs = format!("rung\n a >> far\n{between}rung far\n {{m := m + 1}}\n{between}");
    assert_eq!(numbers(&rungs, "n", "0110", "0000"), [600, 900, 1200, 1800]);
    assert_eq!(numbers(&rungs, "m", "0110", "0000"), [1, 2, 3, 4]);
}
