//! The passes over logic change no image, whatever the program: against the textbook interpreter.

use rung::engine::interp::Textbook;
use rung::logic::{random, verify};
use rung::opt::PASSES;
use rung_runtime::Scan;

/// How many programs: `RUNG_PROGRAMS` says otherwise.
fn programs(otherwise: u64) -> u64 {
    std::env::var("RUNG_PROGRAMS").ok().and_then(|number| number.parse().ok()).unwrap_or(otherwise)
}

#[test]
fn every_pass_keeps_the_image_and_only_two_change_where_sections_and_chunks_end() {
    for seed in 0..programs(400) {
        let original = random::program(seed);
        let mut passed = original.clone();
        for pass in PASSES {
            let (sections, chunks) = (passed.sections.len(), passed.chunks());
            passed = (pass.run)(passed);
            assert_eq!(verify(&passed), Ok(()), "{} of seed {seed}", pass.name);
            assert_eq!((&passed.layout, &passed.origins), (&original.layout, &original.origins));
            if !["cut", "chunk"].contains(&pass.name) {
                assert_eq!((passed.sections.len(), passed.chunks()), (sections, chunks), "{}", pass.name);
            }
            let (mut before, mut after) = (Textbook::new(&original), Textbook::new(&passed));
            let mut expected = random::image(&original.layout, seed);
            let mut actual = expected.clone();
            for scan in 0..4 {
                let now = random::now(seed + scan);
                before.scan(&mut expected, now);
                after.scan(&mut actual, now);
                assert_eq!(expected, actual, "{} of seed {seed}:\n{original:#?}\n{passed:#?}", pass.name);
            }
        }
    }
}
