//! One program in every format gives one trace; and what is written in a format is read again as the same program.

use rung::check::check;
use rung::frontend::{self, native, plcopen};
use rung::ladder::Program;
use rung::source::Source;

use crate::corpus::{WRITERS, comes_back};
use crate::support::random_program::random_iec_program;
use crate::support::rig::checked;
use crate::support::same_trace::same_trace;
use crate::support::shrink;

/// The PLCopen and the OpenPLC file are drawn as their editors save them, and not by Rung.
const FORMATS: [(&str, &str); 4] = [
    ("native text", include_str!("one_program/station.rung")),
    ("PLCopen XML", include_str!("one_program/station.xml")),
    ("OpenPLC Editor 4", include_str!("one_program/station.ld")),
    ("Structured Text", include_str!("one_program/station.st")),
];

fn read(name: &str, text: &str) -> Program {
    let parsed = frontend::parse(&Source::new(name, text));
    assert_eq!(parsed.diagnostics, [], "{name}");
    parsed.program
}

#[test]
fn one_program_in_every_format_gives_one_trace() {
    let programs = FORMATS.map(|(name, text)| (name, checked(&read(name, text)).expect("it is sound")));
    for (name, other) in &programs[1..] {
        for seed in 0..5 {
            assert_eq!(same_trace(&programs[0].1, other, seed, 1000, |_| true), Ok(()), "{name}");
            assert_eq!(same_trace(other, &programs[0].1, seed, 1000, |_| true), Ok(()), "{name}");
        }
    }
}

#[test]
fn each_format_of_one_program_comes_back_from_every_other() {
    for (name, text) in FORMATS {
        let program = read(name, text);
        let checked = checked(&program).expect("it is sound");
        for (format, write) in WRITERS {
            assert_eq!(comes_back(&program, &checked, write), Ok(()), "{name} as {format}");
        }
    }
}

/// The seeds; `RUNG_FIRST_SEED=17 RUNG_SEEDS=1` looks at one again.
fn seeds() -> std::ops::Range<u64> {
    let number = |name, otherwise| match std::env::var(name) {
        Ok(text) => text.parse().unwrap_or_else(|error| panic!("{name}: {error}")),
        Err(_) => otherwise,
    };
    let first = number("RUNG_FIRST_SEED", 0);
    first..first + number("RUNG_SEEDS", 1000)
}

#[test]
fn a_random_program_comes_back_from_plcopen() {
    let mut compared = 0;
    let is_written = |program: &Program| {
        // One with a name that other tools have not comes back under another.
        plcopen::print(program).is_ok_and(|text| !text.contains("<documentation>"))
    };
    let differs = |program: &Program| {
        let drawn = checked(program).ok()?;
        comes_back(program, &drawn, plcopen::print).err()
    };
    for seed in seeds() {
        let program = random_iec_program(seed);
        if !is_written(&program) {
            continue;
        }
        if differs(&program).is_some() {
            let small = shrink::smallest(&program, |smaller| is_written(smaller) && differs(smaller).is_some());
            panic!("seed {seed}: {}\n{}", differs(&small).unwrap_or_default(), native::print(&small));
        }
        compared += 1;
    }
    assert!(std::env::var("RUNG_SEEDS").is_ok() || compared >= 140, "only {compared} programs could be written");
}

#[test]
fn rungs_are_drawn_and_only_what_ld_has_not_is_structured_text() {
    let bodies = |rungs: &str| {
        let text = format!("program p\ninput a, b\noutput c, d\nvar n : INT\nvar t : TON\n{rungs}");
        let program = read("drawn", &text);
        assert!(check(&program).0.is_some(), "{rungs}");
        let written = plcopen::print(&program).expect("it can be written");
        (written.matches("<LD>").count(), written.matches("<ST>").count())
    };
    let drawn = [
        "rung\n [ a | /b ] ^a (c) (S d)",
        "rung\n a t(PT := T#1s) (c)\nrung\n b {n > 3} (d)",
        "rung\n a {n := n + 1} {n > 3} (c)",
        "rung\n a [ (c) | b (d) ]",
        "rung\n a ADD(IN1 := n, IN2 := 1, OUT => n) (c)",
        "rung\n a >n>\n| >n> b (c)\n| >n> (d)",
        "rung\n a >> last\nrung\n b (c)\nrung last\n b (d)",
    ];
    for rungs in drawn {
        assert_eq!(bodies(rungs), (1, 0), "{rungs}");
    }
    assert_eq!(bodies("rung\n a {IF b THEN n := 1; END_IF;} (c)"), (0, 1));
}
