//! Durations as a person reads them.

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

/// A duration exactly, as the literal of a TIME: `T#1.5s`, `T#-250ms`, `T#0s`.
pub(super) fn literal(nanoseconds: i64) -> String {
    format!("T#{}", exact(nanoseconds))
}

/// A duration exactly, as it is written on the command line: `1.5s`, `-250ms`, `0s`.
pub(in crate::cli) fn exact(nanoseconds: i64) -> String {
    let (sign, magnitude) = (if nanoseconds < 0 { "-" } else { "" }, nanoseconds.unsigned_abs());
    let units = [(1_000_000_000, "s"), (1_000_000, "ms"), (1_000, "us"), (1, "ns")];
    let (unit, name) = units.into_iter().find(|(unit, _)| magnitude >= *unit).unwrap_or(units[0]);
    let places = unit.ilog10() as usize;
    let fraction = format!("{:0places$}", magnitude % unit);
    let fraction = fraction.trim_end_matches('0');
    let point = if fraction.is_empty() { "" } else { "." };
    format!("{sign}{}{point}{fraction}{name}", magnitude / unit)
}

#[cfg(test)]
mod tests {
    use super::*;

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
            assert_eq!(literal(nanoseconds), shown);
        }
    }
}
