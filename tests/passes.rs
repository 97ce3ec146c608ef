//! The passes over logic change no image, whatever the program: against the textbook interpreter.

use rung::engine::interp::Textbook;
use rung::logic::random;
use rung::opt::PASSES;
use rung_runtime::Scan;

#[test]
fn every_pass_keeps_image_sections_and_chunks() {
    for seed in 0..400 {
        let original = random::program(seed);
        let mut passed = original.clone();
        for pass in PASSES {
            passed = (pass.run)(passed);
            assert_eq!((&passed.layout, &passed.origins), (&original.layout, &original.origins));
            assert_eq!(passed.chunks(), original.chunks(), "{}", pass.name);
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
