//! Expressions of C: text, with what must be known to put it into a larger one.
//!
//! Every expression is of a type of logic and stands for its value in one of three forms, so that casts are written only
//! where the next operation needs them. Nothing here may rely on a conversion that C leaves undefined.

use crate::elementary::{Elementary, Value};
use crate::emit::structure::c_type;
use crate::logic::{SlotId, literal as literal_of};

/// How tightly the text binds.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Binding {
    /// A name, a call, a member, a number without sign.
    Primary,
    /// A cast.
    Cast,
    /// `&` of these.
    And,
    /// `|` of these.
    Or,
    /// `^` of these.
    Xor,
    /// Anything else.
    Loose,
}

/// What the text's value is.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Form {
    /// The value, in its type of C.
    Exact,
    /// The value, but perhaps as an `int` or `unsigned int`, as C makes them of operands that are smaller.
    Promoted,
    /// A `uint32_t`, or for a type of 8 bytes a `uint64_t`, of which the low bits are the value's: what sums and products
    /// leave, which compute in these without overflow.
    Ring,
    /// A REAL or LREAL that, if it is no number, may have any bits of such.
    Unsettled,
}

/// An expression.
#[derive(Clone, PartialEq, Debug)]
pub(super) struct Expression {
    pub(super) text: String,
    pub(super) binding: Binding,
    pub(super) form: Form,
    /// The constant that it is.
    pub(super) constant: Option<u64>,
    /// The slots that it reads.
    pub(super) reads: Vec<SlotId>,
    /// How deep it is nested.
    pub(super) depth: u32,
}

impl Expression {
    pub(super) fn new(text: String, binding: Binding, form: Form, of: &[&Self]) -> Self {
        let mut reads: Vec<SlotId> = of.iter().flat_map(|part| part.reads.iter().copied()).collect();
        reads.sort_unstable();
        reads.dedup();
        let depth = of.iter().map(|part| part.depth).max().map_or(0, |deepest| deepest + 1);
        Self { text, binding, form, constant: None, reads, depth }
    }

    /// A name that stands for a value.
    pub(super) fn name(text: impl Into<String>) -> Self {
        Self::new(text.into(), Binding::Primary, Form::Exact, &[])
    }

    /// The content of a slot.
    pub(super) fn load(text: String, slot: SlotId) -> Self {
        Self { reads: vec![slot], ..Self::name(text) }
    }

    /// A constant of a type.
    pub(super) fn constant(ty: Elementary, bits: u64) -> Self {
        let (text, binding) = literal(Value::from_bits(ty, bits));
        Self { constant: Some(bits), ..Self::new(text, binding, Form::Exact, &[]) }
    }

    /// The text as an operand of a cast.
    pub(super) fn tight(&self) -> String {
        match self.binding {
            Binding::Primary | Binding::Cast => self.text.clone(),
            Binding::And | Binding::Or | Binding::Xor | Binding::Loose => format!("({})", self.text),
        }
    }

    /// The text as an operand of `&`, `|` or `^`.
    fn operand(&self, binding: Binding) -> String {
        if self.binding == binding { self.text.clone() } else { self.tight() }
    }

    /// `a & b`, `a | b` or `a ^ b` of two of one type of bits.
    pub(super) fn bitwise(binding: Binding, a: &Self, b: &Self, form: Form) -> Self {
        let operator = match binding {
            Binding::And => "&",
            Binding::Or => "|",
            _ => "^",
        };
        Self::new(format!("{} {operator} {}", a.operand(binding), b.operand(binding)), binding, form, &[a, b])
    }

    /// `a + b` and the like.
    pub(super) fn infix(a: &str, operator: &str, b: &str, form: Form, of: &[&Self]) -> Self {
        Self::new(format!("{a} {operator} {b}"), Binding::Loose, form, of)
    }

    /// A call.
    pub(super) fn call(function: &str, arguments: &[&Self], form: Form) -> Self {
        let texts: Vec<&str> = arguments.iter().map(|argument| argument.text.as_str()).collect();
        Self::new(format!("{function}({})", texts.join(", ")), Binding::Primary, form, arguments)
    }

    /// The same as another type of C.
    pub(super) fn cast(&self, c_type: &str, form: Form) -> Self {
        Self::new(format!("({c_type}){}", self.tight()), Binding::Cast, form, &[self])
    }

    /// The value, of type `ty`, as it may be stored or given to a function. Of a REAL that is not settled the same.
    pub(super) fn value(self, ty: Elementary) -> Self {
        match self.form {
            Form::Exact | Form::Promoted | Form::Unsettled => self,
            // What is computed in the type itself has it already.
            Form::Ring if c_type(ty) == ring(ty) => Self { form: Form::Exact, ..self },
            Form::Ring => self.cast(c_type(ty), Form::Exact),
        }
    }

    /// The value as it may be stored or given to a function, where compilers warn if they cannot see that it fits: of what
    /// `&`, `|` and `^` leave they can, but not where a cast stands within.
    pub(super) fn narrow(self, ty: Elementary) -> Self {
        let value = self.value(ty);
        let is_seen = value.form != Form::Promoted || !value.text.contains("_t)");
        if is_seen { value } else { value.exact(ty) }
    }

    /// The value in its very type.
    pub(super) fn exact(self, ty: Elementary) -> Self {
        let value = self.value(ty);
        if value.form == Form::Promoted { value.cast(c_type(ty), Form::Exact) } else { value }
    }

    /// The value, of an integer type or a bit string, as what sums are computed in.
    pub(super) fn ring(self, ty: Elementary) -> Self {
        match (self.form, self.constant) {
            (Form::Ring, _) => self,
            (_, Some(bits)) => {
                let unsigned = if ty.size() == 8 { Elementary::Ulint } else { Elementary::Udint };
                Self { form: Form::Ring, ..Self::constant(unsigned, Value::from_bits(unsigned, bits).bits()) }
            }
            _ if c_type(ty) == ring(ty) => Self { form: Form::Ring, ..self.exact(ty) },
            _ => self.cast(ring(ty), Form::Ring),
        }
    }
}

/// The type that sums of a type are computed in.
pub(super) const fn ring(ty: Elementary) -> &'static str {
    if ty.size() == 8 { "uint64_t" } else { "uint32_t" }
}

/// A constant as C writes it, exactly.
fn literal(value: Value) -> (String, Binding) {
    let (ty, bits) = (value.ty(), value.bits());
    let digits = if ty.is_real() { 0 } else { (ty.size() * 2) as usize };
    match ty {
        Elementary::Bool | Elementary::Usint | Elementary::Uint | Elementary::Udint => {
            (format!("{bits}u"), Binding::Primary)
        }
        Elementary::Byte | Elementary::Word | Elementary::Dword => (format!("0x{bits:0digits$X}u"), Binding::Primary),
        Elementary::Ulint => (format!("UINT64_C({bits})"), Binding::Primary),
        Elementary::Lword => (format!("UINT64_C(0x{bits:0digits$X})"), Binding::Primary),
        Elementary::Sint | Elementary::Int | Elementary::Dint => match bits.cast_signed() {
            number if number == i64::from(i32::MIN) => ("INT32_MIN".to_owned(), Binding::Primary),
            number if number < 0 => (number.to_string(), Binding::Loose),
            number => (number.to_string(), Binding::Primary),
        },
        Elementary::Lint => (wide(bits.cast_signed()), Binding::Primary),
        Elementary::Time if bits == 0 => (wide(0), Binding::Primary),
        Elementary::Time => (format!("{} /* {} */", wide(bits.cast_signed()), literal_of(value)), Binding::Primary),
        Elementary::Real | Elementary::Lreal => real(value),
    }
}

fn wide(number: i64) -> String {
    if number == i64::MIN { "INT64_MIN".to_owned() } else { format!("INT64_C({number})") }
}

/// A REAL or LREAL: in decimal where that is exact, so that the simplest of compilers reads it right, else in binary; what
/// is no finite number by its bits.
fn real(value: Value) -> (String, Binding) {
    let (short, suffix) = if value.ty() == Elementary::Real { (true, "f") } else { (false, "") };
    let real = value.as_real().unwrap_or_default();
    let negative = real.is_sign_negative();
    let binding = if negative { Binding::Loose } else { Binding::Primary };
    if !real.is_finite() {
        let (name, bits) = if short {
            ("real_f32", format!("0x{:08X}u", value.bits()))
        } else {
            ("real_f64", format!("UINT64_C(0x{:016X})", value.bits()))
        };
        return (format!("{name}({bits})"), Binding::Primary);
    }
    let size = real.abs();
    let sign = if negative { "-" } else { "" };
    let sixteenths = size * 16.0;
    if size < 1e9 && sixteenths.fract() == 0.0 {
        return (format!("{sign}{size:?}{suffix}"), binding);
    }
    // Every REAL is an LREAL, too.
    let bits = size.to_bits();
    let (fraction, exponent) = (bits & ((1 << 52) - 1), (bits >> 52).cast_signed() - 1023);
    let (lead, exponent) = if bits >> 52 == 0 { (0, -1022) } else { (1, exponent) };
    let fraction = format!("{fraction:013x}");
    let fraction = fraction.trim_end_matches('0');
    let point = if fraction.is_empty() { "" } else { "." };
    let shown = literal_of(value);
    (format!("{sign}0x{lead}{point}{fraction}p{exponent}{suffix} /* {shown} */"), binding)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn text(ty: Elementary, bits: u64) -> String {
        Expression::constant(ty, Value::from_bits(ty, bits).bits()).text
    }

    #[test]
    fn constants_are_written_exactly_and_no_negation_overflows() {
        let real = |value: f64| text(Elementary::Lreal, value.to_bits());
        assert_eq!(text(Elementary::Dint, 0x8000_0000), "INT32_MIN");
        assert_eq!(text(Elementary::Sint, 0x80), "-128");
        assert_eq!(text(Elementary::Lint, 1 << 63), "INT64_MIN");
        assert_eq!(text(Elementary::Time, 1_050_000_000), "INT64_C(1050000000) /* T#1050ms */");
        assert_eq!(text(Elementary::Word, 255), "0x00FFu");
        assert_eq!(text(Elementary::Real, u64::from(0.1f32.to_bits())), "0x1.99999ap-4f /* 0.1 */");
        assert_eq!(text(Elementary::Real, u64::from((-2.5f32).to_bits())), "-2.5f");
        assert_eq!(text(Elementary::Real, 0x7F80_0000), "real_f32(0x7F800000u)");
        assert_eq!(real(1e300), "0x1.7e43c8800759cp996 /* 1e300 */");
        assert_eq!(real(5e-324), "0x0.0000000000001p-1022 /* 5e-324 */");
        assert_eq!(real(-0.0), "-0.0");
        assert_eq!(real(2f64.powi(100)), "0x1p100 /* 1.2676506002282294e30 */");
    }
}
