//! Durations as a person writes and reads them.

/// Reads a duration such as `10ms`, `1.5s`, `500us`, `2m` or `100ns` as nanoseconds, from 1 up to 1000 days.
pub(super) fn parse(text: &str) -> Result<u64, String> {
    const LONGEST: u64 = 1000 * 24 * 3600 * 1_000_000_000;
    let end = text.find(|c: char| !c.is_ascii_digit() && c != '.').unwrap_or(text.len());
    let (number, unit) = text.split_at(end);
    let unit: u64 = match unit {
        "ns" => 1,
        "us" | "µs" => 1_000,
        "ms" => 1_000_000,
        "s" => 1_000_000_000,
        "m" | "min" => 60_000_000_000,
        "h" => 3_600_000_000_000,
        "" => return Err("a unit is missing: ns, us, ms, s, min or h".to_owned()),
        other => return Err(format!("{other:?} is no unit: write ns, us, ms, s, min or h")),
    };
    let (whole, fraction) = number.split_once('.').unwrap_or((number, "0"));
    let digits = |text: &str| !text.is_empty() && text.len() <= 18 && text.bytes().all(|byte| byte.is_ascii_digit());
    if !digits(whole) || !digits(fraction) {
        return Err(format!("{number:?} is no number"));
    }
    let parsed = |text: &str| text.parse::<u128>().map_err(|error| error.to_string());
    let scaled = parsed(fraction)? * u128::from(unit);
    let places = 10u128.pow(u32::try_from(fraction.len()).unwrap_or(18));
    if scaled % places != 0 {
        return Err("it is finer than a nanosecond".to_owned());
    }
    let nanoseconds = parsed(whole)? * u128::from(unit) + scaled / places;
    match u64::try_from(nanoseconds) {
        Ok(0) => Err("it must be longer than nothing".to_owned()),
        Ok(nanoseconds) if nanoseconds <= LONGEST => Ok(nanoseconds),
        _ => Err("it is longer than 1000 days".to_owned()),
    }
}

/// A duration in the unit that suits it, rounded to three digits or so: `0`, `850 ns`, `12.3 us`, `1.5 s`.
pub(super) fn rounded(nanoseconds: u64) -> String {
    let units = [(1_000_000_000, "s"), (1_000_000, "ms"), (1_000, "us")];
    let Some((unit, name)) = units.into_iter().find(|(unit, _)| nanoseconds >= *unit) else {
        return format!("{nanoseconds} ns");
    };
    // In tenths, as long as those tell something.
    if nanoseconds < 100 * unit {
        let tenths = (nanoseconds + unit / 20) / (unit / 10);
        return format!("{}.{} {name}", tenths / 10, tenths % 10);
    }
    format!("{} {name}", (nanoseconds + unit / 2) / unit)
}

/// A duration exactly, as the literal of a TIME has it: `T#1.5s`, `T#-250ms`, `T#0s`.
pub(super) fn exact(nanoseconds: i64) -> String {
    let (sign, magnitude) = (if nanoseconds < 0 { "-" } else { "" }, nanoseconds.unsigned_abs());
    let units = [(1_000_000_000, "s"), (1_000_000, "ms"), (1_000, "us"), (1, "ns")];
    let (unit, name) = units.into_iter().find(|(unit, _)| magnitude >= *unit).unwrap_or(units[0]);
    let places = unit.ilog10() as usize;
    let fraction = format!("{:0places$}", magnitude % unit);
    let fraction = fraction.trim_end_matches('0');
    let point = if fraction.is_empty() { "" } else { "." };
    format!("T#{sign}{}{point}{fraction}{name}", magnitude / unit)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn durations_are_read_exactly() {
        for (text, nanoseconds) in [
            ("10ms", 10_000_000),
            ("1.5s", 1_500_000_000),
            ("500us", 500_000),
            ("0.000000001s", 1),
            ("2min", 120_000_000_000),
            ("1000h", 3_600_000_000_000_000),
        ] {
            assert_eq!(parse(text), Ok(nanoseconds), "{text}");
        }
    }

    #[test]
    fn what_is_no_duration_is_refused() {
        let long = "9".repeat(40) + "s";
        let texts =
            ["", "ms", "10", "0s", "-1s", "1e3s", "1..5s", ".5s", "5.s", "1.5ns", "10 ms", "24001h", "1d", "1é"];
        for text in texts.into_iter().chain([long.as_str()]) {
            assert!(parse(text).is_err(), "{text}");
        }
    }

    #[test]
    fn durations_are_shown_in_the_unit_that_suits_them() {
        for (nanoseconds, shown) in [
            (0, "0 ns"),
            (999, "999 ns"),
            (12_349, "12.3 us"),
            (99_960, "100.0 us"),
            (807_400, "807 us"),
            (1_500_000_000, "1.5 s"),
        ] {
            assert_eq!(rounded(nanoseconds), shown);
        }
        for (nanoseconds, shown) in [
            (0, "T#0s"),
            (1_500_000_000, "T#1.5s"),
            (-250_000_000, "T#-250ms"),
            (61_000_000_001, "T#61.000000001s"),
            (i64::MIN, "T#-9223372036.854775808s"),
        ] {
            assert_eq!(exact(nanoseconds), shown);
        }
    }
}
