//! Values as Rust's own types, and back: what a program that embeds Rung reads and writes.
//!
//! A conversion must never lose anything but what rounding to REAL does: what does not fit is refused.

use std::convert::Infallible;
use std::fmt;
use std::time::Duration;

use super::{Elementary, Value};

/// A value that a Rust type does not hold.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Unfit {
    /// The value.
    pub value: Value,
    /// The Rust type that was asked for.
    pub wanted: &'static str,
}

impl fmt::Display for Unfit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:?} cannot be had as {}", self.value, self.wanted)
    }
}

impl std::error::Error for Unfit {}

/// A value is had as a [`Value`] in any case.
impl From<Infallible> for Unfit {
    fn from(never: Infallible) -> Self {
        match never {}
    }
}

mod sealed {
    pub trait Sealed {}
}

/// What a variable can be set to: `bool`, integers, `f32`, `f64`, [`Duration`] and [`Value`].
pub trait ToValue: fmt::Debug + sealed::Sealed {
    /// The value of that type, or `None` where there is none:
    ///
    /// - a `bool` for BOOL;
    /// - an integer for the IEC integers and the bit strings but BOOL, within their range;
    /// - an `f32` for REAL and LREAL, an `f64` for LREAL, and rounded to nearest for REAL where that is finite or it was
    ///   not;
    /// - a `Duration` for TIME, up to 292 years;
    /// - a `Value` for its own type.
    fn to_value(&self, ty: Elementary) -> Option<Value>;
}

/// The IEC types whose values are Rust's integers.
fn is_number(ty: Elementary) -> bool {
    ty.is_integer() || (ty.is_bit_string() && ty != Elementary::Bool)
}

macro_rules! integers {
    ($($rust:ident)+) => {
        $(
            impl sealed::Sealed for $rust {}

            impl ToValue for $rust {
                fn to_value(&self, ty: Elementary) -> Option<Value> {
                    Value::integer(ty, i128::from(*self)).filter(|_| is_number(ty))
                }
            }

            /// IEC integers and bit strings but BOOL, within the range.
            impl TryFrom<Value> for $rust {
                type Error = Unfit;

                fn try_from(value: Value) -> Result<Self, Unfit> {
                    let number = value.as_integer().filter(|_| is_number(value.ty()));
                    number.and_then(|number| Self::try_from(number).ok()).ok_or(Unfit { value, wanted: stringify!($rust) })
                }
            }
        )+
    };
}

integers! { i8 i16 i32 i64 u8 u16 u32 u64 }

impl sealed::Sealed for bool {}

impl ToValue for bool {
    fn to_value(&self, ty: Elementary) -> Option<Value> {
        (ty == Elementary::Bool).then(|| Value::bool(*self))
    }
}

/// BOOL.
impl TryFrom<Value> for bool {
    type Error = Unfit;

    fn try_from(value: Value) -> Result<Self, Unfit> {
        if value.ty() == Elementary::Bool { Ok(value.is_true()) } else { Err(Unfit { value, wanted: "bool" }) }
    }
}

impl sealed::Sealed for f32 {}

impl ToValue for f32 {
    fn to_value(&self, ty: Elementary) -> Option<Value> {
        match ty {
            // Not by way of an LREAL, which need not keep what a NaN is made of.
            Elementary::Real => Some(Value::from_bits(ty, u64::from(self.to_bits()))),
            _ => Value::real(ty, f64::from(*self)),
        }
    }
}

/// REAL.
impl TryFrom<Value> for f32 {
    type Error = Unfit;

    fn try_from(value: Value) -> Result<Self, Unfit> {
        if value.ty() == Elementary::Real {
            Ok(super::f32_of(value.bits()))
        } else {
            Err(Unfit { value, wanted: "f32" })
        }
    }
}

impl sealed::Sealed for f64 {}

impl ToValue for f64 {
    fn to_value(&self, ty: Elementary) -> Option<Value> {
        let value = Value::real(ty, *self)?;
        let overflowed = self.is_finite() && value.as_real().is_some_and(Self::is_infinite);
        (!overflowed).then_some(value)
    }
}

/// REAL and LREAL.
impl TryFrom<Value> for f64 {
    type Error = Unfit;

    fn try_from(value: Value) -> Result<Self, Unfit> {
        value.as_real().ok_or(Unfit { value, wanted: "f64" })
    }
}

impl sealed::Sealed for Duration {}

impl ToValue for Duration {
    fn to_value(&self, ty: Elementary) -> Option<Value> {
        let nanoseconds = i64::try_from(self.as_nanos()).ok()?;
        (ty == Elementary::Time).then(|| Value::time(nanoseconds))
    }
}

/// TIME that is not below 0.
impl TryFrom<Value> for Duration {
    type Error = Unfit;

    fn try_from(value: Value) -> Result<Self, Unfit> {
        let nanoseconds = value.as_integer().filter(|_| value.ty() == Elementary::Time);
        let nanoseconds = nanoseconds.and_then(|nanoseconds| u64::try_from(nanoseconds).ok());
        nanoseconds.map(Self::from_nanos).ok_or(Unfit { value, wanted: "Duration" })
    }
}

impl sealed::Sealed for Value {}

impl ToValue for Value {
    fn to_value(&self, ty: Elementary) -> Option<Value> {
        (self.ty() == ty).then_some(*self)
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// The value that something becomes in each type, in the order of the types.
    fn taken_by(given: impl ToValue) -> Vec<Elementary> {
        Elementary::ALL.into_iter().filter(|ty| given.to_value(*ty).is_some()).collect()
    }

    #[test]
    fn each_rust_type_is_taken_by_its_types_and_by_no_other() {
        use Elementary::*;
        let numbers = [Sint, Int, Dint, Lint, Usint, Uint, Udint, Ulint, Byte, Word, Dword, Lword];
        assert_eq!(taken_by(true), [Bool]);
        assert_eq!(taken_by(1i32), numbers);
        assert_eq!(taken_by(1u8), numbers);
        assert_eq!(taken_by(1.5f32), [Real, Lreal]);
        assert_eq!(taken_by(1.5f64), [Real, Lreal]);
        assert_eq!(taken_by(Duration::from_secs(1)), [Time]);
        assert_eq!(taken_by(Value::default_of(Word)), [Word]);
    }

    #[test]
    fn what_is_out_of_range_is_refused() {
        use Elementary::*;
        assert_eq!(taken_by(200), [Int, Dint, Lint, Usint, Uint, Udint, Ulint, Byte, Word, Dword, Lword]);
        assert_eq!(taken_by(-1i64), [Sint, Int, Dint, Lint]);
        assert_eq!(taken_by(u64::MAX), [Ulint, Lword]);
        assert_eq!(taken_by(1e300), [Lreal]);
        assert_eq!(taken_by(f64::INFINITY), [Real, Lreal]);
        assert_eq!(taken_by(Duration::MAX), []);
        let minus = Value::integer(Int, -1).expect("in range");
        assert_eq!(u8::try_from(minus), Err(Unfit { value: minus, wanted: "u8" }));
        assert_eq!(Duration::try_from(Value::time(-1)).unwrap_err().to_string(), "TIME#-1 cannot be had as Duration");
    }

    #[test]
    fn a_value_is_read_as_its_own_rust_types_only() {
        for ty in Elementary::ALL {
            let value = Value::default_of(ty);
            let number = is_number(ty);
            assert_eq!(bool::try_from(value).is_ok(), ty == Elementary::Bool, "{ty}");
            assert_eq!(i64::try_from(value).is_ok(), number, "{ty}");
            assert_eq!(u8::try_from(value).is_ok(), number, "{ty}");
            assert_eq!(f32::try_from(value).is_ok(), ty == Elementary::Real, "{ty}");
            assert_eq!(f64::try_from(value).is_ok(), ty.is_real(), "{ty}");
            assert_eq!(Duration::try_from(value).is_ok(), ty == Elementary::Time, "{ty}");
        }
    }

    proptest! {
        #[test]
        fn what_was_written_is_read_again(number: i64, bits: u32, wide: f64, nanoseconds in 0..=i64::MAX) {
            let back = number.to_value(Elementary::Lint).map(i64::try_from);
            prop_assert_eq!(back, Some(Ok(number)));
            let real = f32::from_bits(bits).to_value(Elementary::Real).map(f32::try_from);
            prop_assert_eq!(real.and_then(Result::ok).map(f32::to_bits), Some(bits));
            prop_assert_eq!(wide.to_value(Elementary::Lreal).map(f64::try_from), Some(Ok(wide)));
            let time = Duration::from_nanos(nanoseconds.unsigned_abs());
            prop_assert_eq!(time.to_value(Elementary::Time).map(Duration::try_from), Some(Ok(time)));
        }
    }
}
