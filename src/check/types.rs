//! Which types go with which: widening without loss, the types of operators, and advice where they do not fit.

use crate::elementary::Elementary::{self, Dint, Int, Lreal, Real, Sint, Udint, Uint, Usint};
use crate::ladder::{BinaryOperator, UnaryOperator};

/// Whether every value of a type is also one of another, wider type, so that the conversion need not be written.
pub(super) fn widens(from: Elementary, to: Elementary) -> bool {
    if from.is_integer() && to.is_integer() {
        // Unsigned to signed takes one bit more, and the next wider type has it.
        from.bits() < to.bits() && (to.is_signed() || !from.is_signed())
    } else if from.is_integer() {
        match to {
            Real => matches!(from, Sint | Int | Usint | Uint),
            Lreal => matches!(from, Sint | Int | Dint | Usint | Uint | Udint),
            _ => false,
        }
    } else if from.is_bit_string() {
        to.is_bit_string() && from != Elementary::Bool && from.bits() < to.bits()
    } else {
        from == Real && to == Lreal
    }
}

/// The one of two types that both widen to, if there is one.
pub(super) fn common(a: Elementary, b: Elementary) -> Option<Elementary> {
    if a == b || widens(b, a) { Some(a) } else { widens(a, b).then_some(b) }
}

/// The real type that an unadorned real literal takes beside an operand of a type, if any.
pub(super) fn real_beside(ty: Elementary) -> Option<Elementary> {
    [Real, Lreal].into_iter().find(|real| ty == *real || widens(ty, *real))
}

/// The types that an operator takes: in words, and whether one of them is.
pub(super) type Domain = (&'static str, fn(Elementary) -> bool);

/// The types of the operands of an operator on two of them.
pub(super) fn binary_domain(op: BinaryOperator) -> Domain {
    use BinaryOperator::{Add, And, Divide, Modulo, Multiply, Or, Subtract, Xor};
    match op {
        And | Or | Xor => ("BOOL and bit strings", Elementary::is_bit_string),
        Add | Subtract => ("numbers and TIME", |ty| ty.is_integer() || ty.is_real() || ty == Elementary::Time),
        Multiply | Divide => ("numbers", |ty| ty.is_integer() || ty.is_real()),
        Modulo => ("integers and TIME", |ty| ty.is_integer() || ty == Elementary::Time),
        _ => ("all types", |_| true),
    }
}

/// The types of the operand of an operator on one.
pub(super) fn unary_domain(op: UnaryOperator) -> Domain {
    match op {
        UnaryOperator::Not => ("BOOL and bit strings", Elementary::is_bit_string),
        UnaryOperator::Negate => ("signed numbers and TIME", |ty| ty.is_signed() || ty.is_real()),
    }
}

/// A type's name, or other words, with its indefinite article.
pub(super) fn with_article(words: &str) -> String {
    // Those that are spelled out begin with a vowel's sound.
    let vowel = matches!(words, "INT" | "INTEGRAL" | "LINT" | "LREAL" | "LWORD" | "R_TRIG" | "F_TRIG" | "SR" | "RS");
    format!("{} {words}", if vowel || words.starts_with(['a', 'e', 'i', 'o']) { "an" } else { "a" })
}

/// What to do where a value of one type stands and another was expected.
pub(super) fn advice(from: Elementary, to: Elementary) -> String {
    if to == Elementary::Bool {
        "compare it with something to get a BOOL, as in `{x > 0}`".to_owned()
    } else if widens(to, from) {
        format!("{to} does not hold every {from}; declare what is written as {from}, or write `{from}_TO_{to}(…)`")
    } else {
        format!("only widening without loss is implied, and {from} to {to} is not that; write `{from}_TO_{to}(…)`")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn widening_loses_no_value() {
        for from in Elementary::ALL {
            for to in Elementary::ALL {
                if let (Some(inner), Some(outer)) = (from.range(), to.range())
                    && widens(from, to)
                {
                    assert!(outer.0 <= inner.0 && inner.1 <= outer.1, "{from} {to}");
                }
                assert!(!(widens(from, to) && widens(to, from)), "{from} {to}");
            }
        }
    }

    #[test]
    fn exactly_these_types_widen() {
        let targets = |from| Elementary::ALL.into_iter().filter(|to| widens(from, *to)).collect::<Vec<_>>();
        use Elementary::{Bool, Byte, Dword, Lint, Lword, Time, Ulint, Word};
        assert_eq!(targets(Sint), [Int, Dint, Lint, Real, Lreal]);
        assert_eq!(targets(Uint), [Dint, Lint, Udint, Ulint, Real, Lreal]);
        assert_eq!(targets(Udint), [Lint, Ulint, Lreal]);
        assert_eq!(targets(Byte), [Word, Dword, Lword]);
        assert_eq!(targets(Real), [Lreal]);
        for alone in [Bool, Lint, Ulint, Lword, Lreal, Time] {
            assert_eq!(targets(alone), [], "{alone}");
        }
    }
}
