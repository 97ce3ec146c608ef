//! Identities of logic.

use super::after;
use crate::elementary::{Elementary, Value};
use crate::logic::{Binary, Compare};

#[test]
fn simplify_drops_neutral_operands_and_double_inversions() {
    let text = after(
        "simplify",
        &[|logic, s| {
            let rail = logic.bool(true);
            let contact = logic.load(s[0]);
            let inverse = logic.not(contact);
            let again = logic.not(inverse);
            let power = logic.and(rail, again);
            let none = logic.bool(false);
            let power = logic.or(none, power);
            let same = logic.and(power, power);
            logic.store(s[1], same);
        }],
    );
    assert_eq!(text, "v0 = a; b := v0");
}

#[test]
fn simplify_makes_selects_of_constants_joins() {
    let text = after(
        "simplify",
        &[|logic, s| {
            let (condition, old) = (logic.load(s[0]), logic.load(s[1]));
            let (on, off) = (logic.bool(true), logic.bool(false));
            let set = logic.select(condition, on, old);
            logic.store(s[1], set);
            let reset = logic.select(condition, off, old);
            logic.store(s[2], reset);
        }],
    );
    assert_eq!(text, "v0 = a; v1 = b; v2 = or v0 v1; b := v2; v4 = not v0; v5 = and v4 v1; c := v5");
}

#[test]
fn simplify_computes_constants_and_turns_comparisons_round() {
    let text = after(
        "simplify",
        &[|logic, s| {
            let two = logic.constant(Value::from_bits(Elementary::Int, 2));
            let four = logic.binary(Binary::Multiply, two, two);
            let count = logic.load(s[5]);
            let less = logic.compare(Compare::Less, count, four);
            let not_less = logic.not(less);
            logic.store(s[0], not_less);
        }],
    );
    assert_eq!(text, "v0 = 4; v1 = n; v2 = ge v1 v0; a := v2");
}

#[test]
fn simplify_turns_no_comparison_of_reals_round_for_a_nan_is_neither_less_nor_not_less() {
    let text = after(
        "simplify",
        &[|logic, s| {
            let count = logic.load(s[5]);
            let real = logic.convert(count, Elementary::Real);
            let less = logic.compare(Compare::Less, real, real);
            let not_less = logic.not(less);
            logic.store(s[0], not_less);
        }],
    );
    assert_eq!(text, "v0 = n; v1 = REAL(v0); v2 = lt v1 v1; v3 = not v2; a := v3");
}

#[test]
fn simplify_compares_a_value_with_itself_and_a_bool_with_a_constant() {
    let text = after(
        "simplify",
        &[|logic, s| {
            let (n, a, on) = (logic.load(s[5]), logic.load(s[0]), logic.bool(true));
            let always = logic.compare(Compare::LessOrEqual, n, n);
            logic.store(s[1], always);
            let same = logic.compare(Compare::Equal, a, on);
            logic.store(s[2], same);
            let below = logic.compare(Compare::Less, a, on);
            logic.store(s[3], below);
            let real = logic.convert(n, Elementary::Real);
            let unless_nan = logic.compare(Compare::Equal, real, real);
            logic.store(s[4], unless_nan);
        }],
    );
    assert_eq!(
        text,
        "v0 = n; v1 = a; v2 = 1; b := v2; c := v1; v5 = not v1; d := v5; v7 = REAL(v0); v8 = eq v7 v7; e := v8"
    );
}

#[test]
fn simplify_takes_the_side_of_a_choice_that_the_same_condition_leaves() {
    let text = after(
        "simplify",
        &[|logic, s| {
            let (condition, n) = (logic.load(s[0]), logic.load(s[5]));
            let two = logic.constant(Value::from_bits(Elementary::Int, 2));
            let inner = logic.select(condition, two, n);
            let outer = logic.select(condition, inner, n);
            logic.store(s[5], outer);
        }],
    );
    assert_eq!(text, "v0 = a; v1 = n; v2 = 2; v3 = select v0 v2 v1; n := v3");
}
