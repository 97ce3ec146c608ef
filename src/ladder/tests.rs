//! The room that a drawing takes.

use super::*;

/// There are several of each in a rung, and a million rungs in a large program.
#[cfg(target_pointer_width = "64")]
#[test]
fn what_a_drawing_has_most_of_is_small() {
    assert_eq!(size_of::<Name>(), 24);
    assert_eq!(size_of::<Reference>(), 40);
    assert_eq!(size_of::<Expression>(), 48);
    assert_eq!(size_of::<Element>(), 64);
    assert_eq!(size_of::<Branch>(), 48);
    assert_eq!(size_of::<Variable>(), 96);
}

#[test]
fn a_magnitude_is_the_number_that_it_was_made_of() {
    for number in [0, 1, u128::from(u64::MAX), u128::from(u64::MAX) + 1, u128::MAX] {
        assert_eq!(Magnitude::from(number).get(), number);
    }
}
