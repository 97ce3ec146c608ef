//! Values that are wider than they need be.

use super::after;
use crate::elementary::{Elementary, Value};
use crate::logic::{Binary, Compare};

#[test]
fn a_sum_whose_upper_bits_are_dropped_is_computed_without_them() {
    let text = after(
        "narrow",
        &[|logic, s| {
            let n = logic.load(s[5]);
            let wide = logic.convert(n, Elementary::Dint);
            let seven = logic.constant(Value::from_bits(Elementary::Dint, 7));
            let sum = logic.binary(Binary::Add, wide, seven);
            let back = logic.convert(sum, Elementary::Int);
            logic.store(s[5], back);
        }],
    );
    assert_eq!(text, "v0 = n; v1 = 7; v2 = add v0 v1; n := v2");
}

#[test]
fn a_quotient_and_a_constant_that_is_too_large_stay_wide() {
    let text = after(
        "narrow",
        &[|logic, s| {
            let n = logic.load(s[5]);
            let wide = logic.convert(n, Elementary::Dint);
            let large = logic.constant(Value::from_bits(Elementary::Dint, 70_000));
            let quotient = logic.binary(Binary::Divide, wide, large);
            let back = logic.convert(quotient, Elementary::Int);
            logic.store(s[5], back);
            let less = logic.compare(Compare::Less, wide, large);
            logic.store(s[0], less);
        }],
    );
    assert_eq!(
        text,
        "v0 = n; v1 = DINT(v0); v2 = 70000; v3 = div v1 v2; v4 = INT(v3); n := v4; v6 = lt v1 v2; a := v6"
    );
}

#[test]
fn comparisons_of_widened_values_compare_what_was_widened() {
    let text = after(
        "narrow",
        &[|logic, s| {
            let n = logic.load(s[5]);
            let wide = logic.convert(n, Elementary::Lint);
            let ten = logic.constant(Value::from_bits(Elementary::Lint, 10));
            let less = logic.compare(Compare::Less, wide, ten);
            logic.store(s[0], less);
        }],
    );
    assert_eq!(text, "v0 = n; v1 = 10; v2 = lt v0 v1; a := v2");
}

#[test]
fn a_conversion_that_wraps_around_is_no_widening() {
    let text = after(
        "narrow",
        &[|logic, s| {
            // -1 as an UINT is 65535, which is above 10; as INT it is not.
            let n = logic.load(s[5]);
            let other = logic.convert(n, Elementary::Uint);
            let ten = logic.constant(Value::from_bits(Elementary::Uint, 10));
            let less = logic.compare(Compare::Less, other, ten);
            logic.store(s[0], less);
            let byte = logic.convert(n, Elementary::Byte);
            let any = logic.convert(byte, Elementary::Bool);
            logic.store(s[1], any);
        }],
    );
    assert_eq!(text, "v0 = n; v1 = UINT(v0); v2 = 10; v3 = lt v1 v2; a := v3; v5 = BYTE(v0); v6 = BOOL(v5); b := v6");
}

#[test]
fn conversions_there_and_back_go() {
    let text = after(
        "narrow",
        &[|logic, s| {
            let n = logic.load(s[5]);
            let wide = logic.convert(n, Elementary::Lword);
            let back = logic.convert(wide, Elementary::Int);
            logic.store(s[5], back);
        }],
    );
    assert_eq!(text, "v0 = n; n := v0");
}
