//! Durations on the command line, such as `10ms`, `1.5s` or `2h`.

use crate::simulate::decimal::parse_scaled;

/// Units, the longer names first: the nanoseconds of a unit are its factor times ten to the power of its decimals.
const UNITS: [(&str, u32, i64); 6] =
    [("ns", 0, 1), ("us", 3, 1), ("ms", 6, 1), ("s", 9, 1), ("m", 9, 60), ("h", 9, 3600)];

/// Reads a duration, a decimal and its unit (`ns`, `us`, `ms`, `s`, `m` or `h`), in nanoseconds.
///
/// # Errors
/// What is wrong with it: it must be above 0 and fit into 64 bits.
pub(super) fn parse(text: &str) -> Result<i64, String> {
    let (unit, decimals, factor) = UNITS
        .into_iter()
        .find(|(unit, ..)| text.ends_with(unit))
        .ok_or("a duration has a unit: ns, us, ms, s, m or h, as in `10ms`")?;
    let number = text.strip_suffix(unit).unwrap_or(text).trim_end();
    let scaled = parse_scaled(number, decimals).map_err(|error| error.to_string())?;
    match scaled.checked_mul(factor) {
        None => Err("it is too long".to_owned()),
        Some(..=0) => Err("it must be above 0".to_owned()),
        Some(nanoseconds) => Ok(nanoseconds),
    }
}

#[cfg(test)]
mod tests {
    use super::parse;

    #[test]
    fn a_duration_is_read_exactly_in_each_unit() {
        let texts = ["7ns", "0.5us", "10ms", "1.5s", "2m", "0.25h", "10 ms"];
        let nanoseconds = [7, 500, 10_000_000, 1_500_000_000, 120_000_000_000, 900_000_000_000, 10_000_000];
        assert_eq!(texts.map(parse), nanoseconds.map(Ok));
    }

    #[test]
    fn what_is_no_duration_is_refused() {
        for text in ["", "10", "ms", "0s", "-1s", "1e3s", "0.5ns", "10min", "9223372036854775808ns", "3000000h"] {
            assert!(parse(text).is_err(), "{text}");
        }
    }
}
