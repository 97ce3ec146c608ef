//! Constants.

use super::{lint, over_arrays, pass, print};
use crate::logic::{Binary, Compare};

#[test]
fn fold_makes_an_element_with_a_constant_index_its_slot() {
    let program = over_arrays(|logic, [x, y], s| {
        let (one, two) = (logic.constant(lint(1)), logic.constant(lint(2)));
        let last = logic.binary(Binary::Subtract, two, one);
        let element = logic.load_indexed(x, last);
        logic.store_indexed(y, two, element);
        let beyond = logic.binary(Binary::Add, two, one);
        let none = logic.load_indexed(x, beyond);
        logic.store(s[6], none);
        logic.store_indexed(y, beyond, element);
        let below = logic.binary(Binary::Subtract, one, two);
        logic.store_indexed(y, below, element);
    });
    assert_eq!(print(&pass("sweep", pass("fold", program))), "v0 = x[1]; y[2] := v0; v2 = 0; n := v2");
}

#[test]
fn fold_drops_copies_that_change_nothing() {
    let program = over_arrays(|logic, [x, y], s| {
        let (never, always) = (logic.bool(false), logic.bool(true));
        logic.copy_array(x, y, Some(never));
        logic.copy_array(x, x, Some(always));
        let index = logic.load(s[8]);
        let zero = logic.constant(lint(0));
        let sometimes = logic.compare(Compare::Less, index, zero);
        logic.copy_array(x, x, Some(sometimes));
        logic.copy_array(x, y, Some(always));
        logic.copy_array(y, x, Some(sometimes));
    });
    let expected = "v0 = 1; v1 = i; v2 = 0; v3 = lt v1 v2; a0 := a1 while v0; a1 := a0 while v3";
    assert_eq!(print(&pass("sweep", pass("fold", program))), expected);
}
