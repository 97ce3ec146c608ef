//! Exact decimals: times are written in milliseconds with a fraction, and must never pass through a float.

use std::fmt;

/// Why a text is no decimal of the wanted kind.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum DecimalError {
    /// It is not written as digits, with a `-` before and a fraction after them at most.
    NotANumber,
    /// Its fraction is finer than the unit that it is counted in.
    TooFine,
    /// It does not fit into 64 bits.
    OutOfRange,
}

impl fmt::Display for DecimalError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::NotANumber => "it is not a decimal number",
            Self::TooFine => "it is finer than a nanosecond",
            Self::OutOfRange => "it is too large",
        })
    }
}

/// Decimals of a millisecond, down to the nanosecond.
const MILLISECOND_DECIMALS: u32 = 6;

/// Reads a decimal and gives it in units of 10^-`decimals`: `1.5` with 3 decimals is 1500.
///
/// # Errors
/// [`DecimalError`]. A sign `+`, an exponent and a point without digits on both sides are no decimal.
pub fn parse_scaled(text: &str, decimals: u32) -> Result<i64, DecimalError> {
    let (negative, magnitude) = text.strip_prefix('-').map_or((false, text), |rest| (true, rest));
    let (whole, fraction) = match magnitude.split_once('.') {
        Some((_, "")) => return Err(DecimalError::NotANumber),
        Some(parts) => parts,
        None => (magnitude, ""),
    };
    let all_digits = |digits: &str| digits.bytes().all(|byte| byte.is_ascii_digit());
    if whole.is_empty() || !all_digits(whole) || !all_digits(fraction) {
        return Err(DecimalError::NotANumber);
    }
    let fraction = fraction.trim_end_matches('0');
    let missing = usize::try_from(decimals)
        .ok()
        .and_then(|decimals| decimals.checked_sub(fraction.len()))
        .ok_or(DecimalError::TooFine)?;
    // Counted downwards, since the least number has no positive counterpart.
    let digits = whole.bytes().chain(fraction.bytes()).chain(std::iter::repeat_n(b'0', missing));
    let below_zero = digits
        .map(|digit| i64::from(digit - b'0'))
        .try_fold(0i64, |sum, digit| sum.checked_mul(10)?.checked_sub(digit))
        .ok_or(DecimalError::OutOfRange)?;
    if negative { Ok(below_zero) } else { below_zero.checked_neg().ok_or(DecimalError::OutOfRange) }
}

/// Reads milliseconds, such as `1500`, `0.25` or `-3`, as nanoseconds.
///
/// # Errors
/// [`DecimalError`]
pub fn parse_milliseconds(text: &str) -> Result<i64, DecimalError> {
    parse_scaled(text, MILLISECOND_DECIMALS)
}

/// Nanoseconds, displayed as milliseconds with as many decimals as they need, at most 6.
/// [`parse_milliseconds`] reads them back.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Milliseconds(pub i64);

impl fmt::Display for Milliseconds {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        Scaled(self.0, MILLISECOND_DECIMALS).fmt(f)
    }
}

/// A number in units of 10 to the power of minus the second field, at most 18, displayed with as many decimals as it
/// needs: the inverse of [`parse_scaled`].
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Scaled(pub i64, pub u32);

impl fmt::Display for Scaled {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (magnitude, one) = (self.0.unsigned_abs(), 10u64.pow(self.1));
        let sign = if self.0 < 0 { "-" } else { "" };
        let (whole, mut fraction, mut width) = (magnitude / one, magnitude % one, self.1 as usize);
        if fraction == 0 {
            return write!(f, "{sign}{whole}");
        }
        while fraction.is_multiple_of(10) {
            fraction /= 10;
            width -= 1;
        }
        write!(f, "{sign}{whole}.{fraction:0width$}")
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn milliseconds_are_read_to_the_nanosecond() {
        for (text, nanoseconds) in [
            ("0", 0),
            ("-0", 0),
            ("1500", 1_500_000_000),
            ("0.25", 250_000),
            ("-3", -3_000_000),
            ("0.000001", 1),
            ("0.1000000000000", 100_000),
            ("9223372036854.775807", i64::MAX),
            ("-9223372036854.775808", i64::MIN),
        ] {
            assert_eq!(parse_milliseconds(text), Ok(nanoseconds), "{text}");
        }
    }

    #[test]
    fn what_is_no_decimal_is_refused_with_its_reason() {
        for text in ["", "-", ".", ".5", "5.", "+5", "1e3", "1 ", "--1", "1.2.3", "0x10", "١", "1_000"] {
            assert_eq!(parse_milliseconds(text), Err(DecimalError::NotANumber), "{text}");
        }
        assert_eq!(parse_milliseconds("0.0000001"), Err(DecimalError::TooFine));
        for text in ["9223372036854.775808", "-9223372036854.775809", &"9".repeat(100)] {
            assert_eq!(parse_milliseconds(text), Err(DecimalError::OutOfRange), "{text}");
        }
    }

    proptest! {
        #[test]
        fn every_time_is_printed_so_that_it_reads_back(nanoseconds: i64) {
            let text = Milliseconds(nanoseconds).to_string();
            prop_assert_eq!(parse_milliseconds(&text), Ok(nanoseconds));
            prop_assert!(!text.contains('.') || !text.ends_with(['0', '.']), "{}", text);
        }

        #[test]
        fn any_text_is_read_or_refused(text: String, decimals in 0u32..30) {
            let _ = parse_scaled(&text, decimals);
        }
    }

    #[test]
    fn the_ends_of_the_range_are_printed_exactly() {
        let texts = [i64::MIN, -1, 0, 250_000, i64::MAX].map(|time| Milliseconds(time).to_string());
        assert_eq!(texts, ["-9223372036854.775808", "-0.000001", "0", "0.25", "9223372036854.775807"]);
    }
}
