//! What literals, addresses and titles say. The lexer has found where they end; nothing here reads tokens.

use crate::elementary::Elementary;
use crate::ladder::{Address, Area, Literal, Name, Width};
use crate::source::Span;

use super::token::{continues_name, starts_name};

/// Why a literal cannot be read, and what to write instead.
#[derive(PartialEq, Eq, Debug)]
pub(crate) struct Problem {
    pub(crate) message: String,
    pub(crate) hint: Option<&'static str>,
}

impl Problem {
    fn new(message: impl Into<String>) -> Self {
        Self { message: message.into(), hint: None }
    }

    fn hint(self, hint: &'static str) -> Self {
        Self { hint: Some(hint), ..self }
    }
}

/// A literal, and whether a minus sign stands behind its type (`INT#-5`), which is then an operator on it.
pub(crate) fn literal(text: &str, span: Span) -> Result<(bool, Literal), Problem> {
    let Some((prefix, rest)) = split_type(text) else {
        return Ok((false, number(text, None)?));
    };
    if prefix.starts_with(|first: char| first.is_ascii_digit()) {
        return Ok((false, number(text, None)?));
    }
    if let Some(value) = name(rest).filter(|_| Elementary::from_name(prefix).is_none())
        && let Some(ty) = name(prefix)
    {
        let start = span.range().start;
        let ty = Name::new(ty, Span::new(start, start + prefix.len()));
        let value = Name::new(value, Span::new(start + prefix.len() + 1, start + text.len()));
        return Ok((false, Literal::Enumerated { ty: Box::new(ty), value: Box::new(value) }));
    }
    if prefix.eq_ignore_ascii_case("T") || prefix.eq_ignore_ascii_case("TIME") {
        return Ok((false, Literal::Time(duration(rest)?)));
    }
    let Some(ty) = Elementary::from_name(prefix) else {
        return Err(Problem::new("no type of this name has literals")
            .hint("what stands before # is a base (2, 8, 16), T, or an elementary type such as INT"));
    };
    if ty == Elementary::Bool && (rest.eq_ignore_ascii_case("TRUE") || rest.eq_ignore_ascii_case("FALSE")) {
        return Ok((false, Literal::Bool(rest.eq_ignore_ascii_case("TRUE"))));
    }
    let (negative, magnitude) = signed(rest);
    Ok((negative, number(magnitude, Some(ty))?))
}

/// What stands before and behind the first `#` that is no part of a quoted name.
fn split_type(text: &str) -> Option<(&str, &str)> {
    let from = text.strip_prefix('`').and_then(|inner| inner.find('`')).map_or(0, |length| length + 1);
    let at = from + text[from..].find('#')?;
    Some((&text[..at], &text[at + 1..]))
}

/// The name that a text spells, with or without back quotes.
fn name(text: &str) -> Option<&str> {
    if let Some(quoted) = text.strip_prefix('`') {
        return quoted.strip_suffix('`').filter(|name| !name.is_empty() && !name.contains(['`', '\r']));
    }
    (text.starts_with(starts_name) && text.chars().all(continues_name)).then_some(text)
}

fn signed(text: &str) -> (bool, &str) {
    match text.strip_prefix('-') {
        Some(rest) => (true, rest),
        None => (false, text.strip_prefix('+').unwrap_or(text)),
    }
}

fn number(text: &str, ty: Option<Elementary>) -> Result<Literal, Problem> {
    let real_type = ty.is_some_and(Elementary::is_real);
    if let Some((base, digits)) = text.split_once('#') {
        if real_type {
            return Err(Problem::new("a REAL has no base"));
        }
        let base = match base {
            "2" => 2,
            "8" => 8,
            "10" => 10,
            "16" => 16,
            _ => return Err(Problem::new("a base is 2, 8, 10 or 16")),
        };
        return Ok(Literal::Integer { value: integer(digits, base)?.into(), base, ty });
    }
    if text.contains('.') || real_type {
        return match ty {
            Some(ty) if !ty.is_real() => Err(Problem::new(format!("{ty} has no fractions"))),
            _ => Ok(Literal::Real { value: real(text)?, ty }),
        };
    }
    Ok(Literal::Integer { value: integer(text, 10)?.into(), base: 10, ty })
}

/// Digits without the underscores that may stand one by one between them.
fn without_underscores(text: &str) -> Result<String, Problem> {
    if text.is_empty() {
        return Err(Problem::new("digits are missing"));
    }
    if text.starts_with('_') || text.ends_with('_') || text.contains("__") {
        return Err(Problem::new("an underscore stands between two digits"));
    }
    Ok(text.replace('_', ""))
}

fn integer(text: &str, base: u8) -> Result<u128, Problem> {
    let digits = without_underscores(text)?;
    if let Some(odd) = digits.chars().find(|digit| !digit.is_digit(base.into())) {
        let problem = Problem::new(format!("`{odd}` is not a digit in base {base}"));
        return Err(match odd.to_ascii_lowercase() {
            _ if base != 10 => problem,
            'e' => problem.hint("a real number has a point: 1.0e5"),
            'd' | 'h' | 'm' | 's' | 'u' | 'n' => problem.hint("a duration starts with T#, such as T#10ms"),
            _ => problem.hint("a name starts with a letter"),
        });
    }
    u128::from_str_radix(&digits, base.into()).map_err(|_| Problem::new("this number is too large for any type"))
}

fn real(text: &str) -> Result<f64, Problem> {
    let digits = without_underscores(text)?;
    let (mantissa, exponent) = digits.split_once(['e', 'E']).unwrap_or((&digits, "0"));
    let (whole, fraction) = mantissa.split_once('.').unwrap_or((mantissa, "0"));
    let is_digits = |part: &str| !part.is_empty() && part.bytes().all(|byte| byte.is_ascii_digit());
    if !is_digits(whole) || !is_digits(fraction) || !is_digits(signed(exponent).1) {
        return Err(Problem::new("this is not a number").hint("a real number looks like 1.5 or 1.0e-3"));
    }
    match digits.parse::<f64>() {
        Ok(value) if value.is_finite() => Ok(value),
        _ => Err(Problem::new("this number is too large for LREAL")),
    }
}

/// The units of a duration, the greatest first, in nanoseconds.
pub(crate) const UNITS: [(&str, u64); 7] = [
    ("d", 86_400_000_000_000),
    ("h", 3_600_000_000_000),
    ("m", 60_000_000_000),
    ("s", 1_000_000_000),
    ("ms", 1_000_000),
    ("us", 1_000),
    ("ns", 1),
];

/// Nanoseconds of what stands behind `T#`.
pub(crate) fn duration(text: &str) -> Result<i64, Problem> {
    let form = || Problem::new("this is not a duration").hint("a duration looks like T#1h30m, T#1.5s or T#-20ms");
    let too_large = || Problem::new("this duration is too large").hint("TIME reaches 292 years either way");
    let (negative, mut rest) = signed(text);
    let mut total: u128 = 0;
    let mut units = UNITS.iter();
    let mut fraction_seen = false;
    if rest.is_empty() {
        return Err(form());
    }
    while !rest.is_empty() {
        if fraction_seen {
            return Err(Problem::new("only the last part of a duration may have a fraction"));
        }
        let digits_end = rest.find(|c: char| c.is_ascii_alphabetic()).ok_or_else(form)?;
        let unit_end = rest[digits_end..]
            .find(|c: char| !c.is_ascii_alphabetic())
            .map_or(rest.len(), |length| digits_end + length);
        let (digits, unit) = (&rest[..digits_end], &rest[digits_end..unit_end]);
        rest = &rest[unit_end..];
        // An underscore may part the units too.
        rest = rest.strip_prefix('_').filter(|more| !more.is_empty()).unwrap_or(rest);
        let Some((_, size)) = units.find(|(name, _)| name.eq_ignore_ascii_case(unit)) else {
            let known = UNITS.iter().any(|(name, _)| name.eq_ignore_ascii_case(unit));
            let problem =
                if known { "the units of a duration stand from great to small, each once" } else { "no such unit" };
            return Err(Problem::new(problem).hint("the units are d, h, m, s, ms, us and ns"));
        };
        let (whole, fraction) = match digits.split_once('.') {
            Some((whole, fraction)) => (whole, Some(fraction)),
            None => (digits, None),
        };
        let size = u128::from(*size);
        let whole = integer(whole, 10).map_err(|_| form())?;
        total = whole.checked_mul(size).and_then(|part| total.checked_add(part)).ok_or_else(too_large)?;
        if let Some(fraction) = fraction {
            fraction_seen = true;
            let digits = without_underscores(fraction).map_err(|_| form())?;
            let digits = digits.trim_end_matches('0');
            // No unit has more than 14 digits, so that more places are less than a nanosecond.
            let places = u32::try_from(digits.len()).ok().filter(|places| *places <= 14);
            let finer = || Problem::new("a duration is a whole number of nanoseconds");
            let scale = 10u128.pow(places.ok_or_else(finer)?);
            let value = if digits.is_empty() { 0 } else { integer(digits, 10).map_err(|_| form())? };
            if value * size % scale != 0 {
                return Err(finer());
            }
            total += value * size / scale;
        }
    }
    let total = i128::try_from(total).map_err(|_| too_large())?;
    i64::try_from(if negative { -total } else { total }).map_err(|_| too_large())
}

/// An address such as `%IX0.3`.
pub(crate) fn address(text: &str, span: Span) -> Result<Address, Problem> {
    let form = || Problem::new("this is not an address").hint("an address looks like %IX0.3, %QW2 or %MD4");
    let mut letters = text.chars().skip(1).peekable();
    let area = match letters.next().map(|letter| letter.to_ascii_uppercase()) {
        Some('I') => Area::Input,
        Some('Q') => Area::Output,
        Some('M') => Area::Memory,
        _ => return Err(form()),
    };
    let width = match letters.peek().map(char::to_ascii_uppercase) {
        Some('X') => Some(Width::Bit),
        Some('B') => Some(Width::Byte),
        Some('W') => Some(Width::Word),
        Some('D') => Some(Width::Double),
        Some('L') => Some(Width::Long),
        _ => None,
    };
    let numbers = &text[if width.is_some() { 3 } else { 2 }..];
    let numbers = numbers
        .split('.')
        .map(|number| match number.parse::<u32>() {
            Ok(value) if !number.starts_with('+') => Ok(value),
            _ if !number.is_empty() && number.bytes().all(|byte| byte.is_ascii_digit()) => {
                Err(Problem::new("a number of this address is too large"))
            }
            _ => Err(form()),
        })
        .collect::<Result<Vec<u32>, Problem>>()?;
    Ok(Address { area, width: width.unwrap_or(Width::Bit), numbers, span })
}

/// A title, from between its quotes, with IEC's escapes: `$$`, `$"`, `$N` or `$L`, `$R`, `$T`, and `$` with four
/// hexadecimal digits.
pub(crate) fn title(text: &str) -> Result<String, Problem> {
    let mut title = String::with_capacity(text.len());
    let mut rest = text;
    while let Some((plain, escape)) = rest.split_once('$') {
        title.push_str(plain);
        let mut characters = escape.chars();
        let (character, length) = match characters.next() {
            Some(sign @ ('$' | '"')) => (Some(sign), 1),
            Some('N' | 'n' | 'L' | 'l') => (Some('\n'), 1),
            Some('R' | 'r') => (Some('\r'), 1),
            Some('T' | 't') => (Some('\t'), 1),
            _ => (
                escape
                    .get(..4)
                    .filter(|digits| digits.bytes().all(|byte| byte.is_ascii_hexdigit()))
                    .and_then(|digits| u32::from_str_radix(digits, 16).ok().and_then(char::from_u32)),
                4,
            ),
        };
        let Some(character) = character else {
            return Err(Problem::new("`$` starts no escape here").hint("a dollar sign is written $$"));
        };
        title.push(character);
        rest = &escape[length..];
    }
    title.push_str(rest);
    Ok(title)
}
