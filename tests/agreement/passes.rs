//! No pass over the logic of a random ladder program changes what it computes, from whatever image.

use rung::engine::interp::Textbook;
use rung::logic::random;
use rung::opt::PASSES;
use rung::opt::prove::optimise_proved;
use rung::source::Source;
use rung::{logic, lower};
use rung_runtime::Scan;

use crate::support::random_program::random_program;
use crate::support::rig::checked;

/// Programs that go through every pass: 200, or as many as `RUNG_PROGRAMS` says.
fn programs() -> u64 {
    std::env::var("RUNG_PROGRAMS").ok().and_then(|number| number.parse().ok()).unwrap_or(200)
}

#[test]
fn every_pass_keeps_what_random_ladder_programs_compute() {
    for seed in 0..programs() {
        let checked = checked(&random_program(seed)).unwrap_or_else(|problems| panic!("seed {seed}: {problems}"));
        let mut before = lower::lower(&checked, &Source::new("drawn", ""), None).expect("a small image");
        for pass in PASSES {
            let after = (pass.run)(before.clone());
            assert_eq!((&after.layout, &after.origins), (&before.layout, &before.origins));
            if !["cut", "chunk"].contains(&pass.name) {
                assert_eq!(after.chunks(), before.chunks(), "{} of seed {seed}", pass.name);
            }
            let mut expected = random::image(&before.layout, seed);
            let mut actual = expected.clone();
            let (mut from, mut to) = (Textbook::new(&before), Textbook::new(&after));
            for scan in 0..4 {
                let now = random::now(seed + scan);
                from.scan(&mut expected, now);
                to.scan(&mut actual, now);
                assert_eq!(expected, actual, "{} of seed {seed}", pass.name);
            }
            before = after;
        }
    }
}

#[test]
fn the_passes_over_random_ladder_programs_are_proved_to_change_nothing() {
    let (mut proved, mut unproved) = (0, 0);
    for seed in 0..programs() / 20 {
        let checked = checked(&random_program(seed)).unwrap_or_else(|problems| panic!("seed {seed}: {problems}"));
        let program = lower::lower(&checked, &Source::new("drawn", ""), None).expect("a small image");
        let (_, report) = optimise_proved(program, PASSES).unwrap_or_else(|fault| panic!("seed {seed}: {fault:?}"));
        proved += report.proved();
        unproved += report.unproved.len();
    }
    // They compute with REALs and long arithmetic far more than a ladder does: of the first hundred, one value in nine
    // stays unproved.
    assert!(unproved * 4 <= proved, "{unproved} are unproved, {proved} are proved");
}

#[test]
fn the_text_of_the_logic_of_random_ladder_programs_reads_back_as_that_logic() {
    for seed in 0..programs() {
        let checked = checked(&random_program(seed)).unwrap_or_else(|problems| panic!("seed {seed}: {problems}"));
        let program = lower::lower(&checked, &Source::new("drawn", ""), None).expect("a small image");
        let text = logic::print(&program);
        let read = logic::parse(&Source::new("drawn.logic", text.as_str()));
        assert_eq!(read.as_ref().map_err(|problems| format!("{problems:?}")), Ok(&program), "seed {seed}\n{text}");
    }
}
