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

/// The program in every format. The PLCopen file and the OpenPLC project are drawn as their editors save them, and not by Rung.
fn sources() -> [Source; 4] {
    let project = [
        ("station/project.json", include_str!("one_program/project.json")),
        ("station/pous/programs/station.ld", include_str!("one_program/station.ld")),
    ];
    [
        Source::new("native text", include_str!("one_program/station.rung")),
        Source::new("PLCopen XML", include_str!("one_program/station.xml")),
        Source::joined("OpenPLC Editor 4", project.map(|(name, text)| (name.to_owned(), text.to_owned()))),
        Source::new("Structured Text", include_str!("one_program/station.st")),
    ]
}

fn read(source: &Source) -> Program {
    let parsed = frontend::parse(source);
    assert_eq!(parsed.diagnostics, [], "{}", source.name());
    parsed.program
}

#[test]
fn one_program_in_every_format_gives_one_trace() {
    let sources = sources();
    let programs = sources.each_ref().map(|source| checked(&read(source)).expect("it is sound"));
    for (source, other) in sources.iter().zip(&programs).skip(1) {
        let name = source.name();
        for seed in 0..5 {
            assert_eq!(same_trace(&programs[0], other, seed, 1000, |_| true), Ok(()), "{name}");
            assert_eq!(same_trace(other, &programs[0], seed, 1000, |_| true), Ok(()), "{name}");
        }
    }
}

#[test]
fn each_format_of_one_program_comes_back_from_every_other() {
    for source in sources() {
        let (name, program) = (source.name(), read(&source));
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
        let program = read(&Source::new("drawn", text));
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
