//! The room that a checked program takes: there are several of each in a rung, and a million rungs in a large program.

use crate::check::{Branch, Element, Expression, Place, Variable};

#[cfg(target_pointer_width = "64")]
#[test]
fn what_a_checked_program_has_most_of_is_small() {
    assert_eq!(size_of::<Place>(), 16);
    assert_eq!(size_of::<Expression>(), 32);
    assert_eq!(size_of::<Element>(), 40);
    assert_eq!(size_of::<Branch>(), 32);
    assert_eq!(size_of::<Variable>(), 72);
}
