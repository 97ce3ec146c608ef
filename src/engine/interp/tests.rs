//! The fast interpreter against the textbook one.

use rung_runtime::Scan;

use super::{Interpreter, Textbook};
use crate::logic::random;

#[test]
fn both_interpreters_agree_on_the_whole_image() {
    for seed in 0..600 {
        let program = random::program(seed);
        let (mut textbook, mut interpreter) = (Textbook::new(&program), Interpreter::new(&program));
        for round in 0..8 {
            let mut expected = random::image(&program.layout, seed ^ round << 32);
            let mut actual = expected.clone();
            // The second scan starts from what the first one left.
            for scan in 0..2 {
                let now = random::now(seed + round * 1000 + scan);
                textbook.scan(&mut expected, now);
                interpreter.scan(&mut actual, now);
                assert_eq!(expected, actual, "seed {seed}, round {round}, scan {scan}:\n{program:#?}");
            }
        }
    }
}
