//! Timers whose preset is a constant are computed in a shorter way. It must be taken only where nobody can tell: with one
//! call, a preset that nobody else sets, and a clock that goes on.

use rung::check;
use rung::elementary::Value;
use rung::frontend;
use rung::source::Source;

use crate::support::rig::Rig;

/// Runs a program with inputs `a` and `b` on the evaluator and every engine, at times in tenths of a second.
fn agree(text: &str, a: &str, b: &str, times: impl Iterator<Item = i64>) {
    let source = Source::new("presets.rung", format!("program presets\ninput a, b\noutput x, y\n{text}"));
    let parsed = frontend::parse(&source);
    assert_eq!(parsed.diagnostics, [], "{text}");
    let (checked, problems) = check::check(&parsed.program);
    let checked = checked.unwrap_or_else(|| panic!("{problems:?}"));
    let mut rig = Rig::new(&checked).expect("engines for a small program");
    for (scan, (now, (a, b))) in times.zip(a.bytes().zip(b.bytes())).enumerate() {
        rig.set("a", Value::bool(a == b'1'));
        rig.set("b", Value::bool(b == b'1'));
        rig.scan(now * 100_000_000).unwrap_or_else(|difference| panic!("{text}, scan {scan}: {difference:?}"));
    }
}

const TIMERS: [&str; 4] = ["TON", "TOF", "TP", "TONR"];
const A: &str = "0110111111000000111111110110111111111000010101011111110000000011";
const B: &str = "0000111100110011110000111111111100000111101010101110000111100111";

#[test]
fn with_every_constant_preset_a_timer_is_what_it_is_with_a_variable() {
    for timer in TIMERS {
        for preset in ["T#0s", "T#100ms", "T#300ms", "-T#1s", "T#1ns"] {
            agree(&format!("rung\n a t:{timer}(PT := {preset}) (x)"), A, B, 0..);
            // Left out in some scans, also while it times.
            agree(&format!("rung\n a {{x := TRUE}} t:{timer}(EN := b, PT := {preset}) (y)"), A, B, 0..);
            agree(&format!("rung\n b >> on\nrung\n a t:{timer}(PT := {preset}) (x)\nrung on\n b (y)"), A, B, 0..);
        }
    }
}

#[test]
fn a_timer_with_two_calls_has_two_presets() {
    for timer in TIMERS {
        agree(
            &format!(
                "var t : {timer}\nrung\n b >> other\nrung\n a t(PT := T#200ms) (x)\nrung other\n a t(PT := T#700ms) (y)"
            ),
            A,
            B,
            0..,
        );
    }
}

#[test]
fn a_preset_that_someone_else_sets_is_no_constant() {
    for timer in TIMERS {
        agree(&format!("var t : {timer}\nrung\n a t(PT := T#300ms) (x)\nrung\n b {{t.PT := T#600ms}} (y)"), A, B, 0..);
        agree(
            &format!("var d : TIME := T#300ms\nrung\n a t:{timer}(PT := d) (x)\nrung\n b {{d := T#800ms}} (y)"),
            A,
            B,
            0..,
        );
    }
}

#[test]
fn a_retained_timer_may_have_run_last_under_a_clock_that_was_further_on() {
    for timer in TIMERS {
        // The power goes at the twelfth scan and the controller's time starts anew.
        let times = (1000..1012).chain(0..);
        agree(&format!("var t : {timer} retain\nrung\n a t(PT := T#300ms) (x)"), A, B, times);
    }
}
