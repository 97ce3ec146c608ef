//! The elementary data types of IEC 61131-3 and their values: the one vocabulary that the ladder model and
//! the logic IR share. This module must know nothing of either.

mod convert;

use std::fmt;

pub use convert::{ToValue, Unfit};

/// An elementary data type (IEC 61131-3, table 10). TIME is 64 bits of nanoseconds, signed.
#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Debug)]
#[expect(missing_docs, reason = "the standard's own names")]
pub enum Elementary {
    Bool,
    Sint,
    Int,
    Dint,
    Lint,
    Usint,
    Uint,
    Udint,
    Ulint,
    Byte,
    Word,
    Dword,
    Lword,
    Real,
    Lreal,
    Time,
}

use Elementary::{Bool, Byte, Dint, Dword, Int, Lint, Lreal, Lword, Real, Sint, Time, Udint, Uint, Ulint, Usint, Word};

impl Elementary {
    /// Every type, in the order of the standard's table.
    pub const ALL: [Self; 16] =
        [Bool, Sint, Int, Dint, Lint, Usint, Uint, Udint, Ulint, Byte, Word, Dword, Lword, Real, Lreal, Time];

    /// The standard's spelling, in capitals.
    pub const fn name(self) -> &'static str {
        match self {
            Bool => "BOOL",
            Sint => "SINT",
            Int => "INT",
            Dint => "DINT",
            Lint => "LINT",
            Usint => "USINT",
            Uint => "UINT",
            Udint => "UDINT",
            Ulint => "ULINT",
            Byte => "BYTE",
            Word => "WORD",
            Dword => "DWORD",
            Lword => "LWORD",
            Real => "REAL",
            Lreal => "LREAL",
            Time => "TIME",
        }
    }

    /// The type of that name, in any case.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|ty| ty.name().eq_ignore_ascii_case(name))
    }

    /// Bytes that a value takes in the process image, which is also its alignment: 1, 2, 4 or 8. A BOOL takes one.
    pub const fn size(self) -> u32 {
        match self {
            Bool | Sint | Usint | Byte => 1,
            Int | Uint | Word => 2,
            Dint | Udint | Dword | Real => 4,
            Lint | Ulint | Lword | Lreal | Time => 8,
        }
    }

    /// Bits that carry the value: 1 for a BOOL, else eight times [`Elementary::size`].
    pub const fn bits(self) -> u32 {
        match self {
            Bool => 1,
            _ => self.size() * 8,
        }
    }

    /// The IEC integers (ANY_INT).
    pub const fn is_integer(self) -> bool {
        matches!(self, Sint | Int | Dint | Lint | Usint | Uint | Udint | Ulint)
    }

    /// Whether values are kept sign-extended: SINT, INT, DINT, LINT and TIME.
    pub const fn is_signed(self) -> bool {
        matches!(self, Sint | Int | Dint | Lint | Time)
    }

    /// The bit strings (ANY_BIT), BOOL included.
    pub const fn is_bit_string(self) -> bool {
        matches!(self, Bool | Byte | Word | Dword | Lword)
    }

    /// The floating-point types (ANY_REAL).
    pub const fn is_real(self) -> bool {
        matches!(self, Real | Lreal)
    }

    /// Least and greatest value of anything but REAL and LREAL, for which it is `None`.
    pub const fn range(self) -> Option<(i128, i128)> {
        if self.is_real() {
            None
        } else if self.is_signed() {
            let half = 1i128 << (self.bits() - 1);
            Some((-half, half - 1))
        } else {
            Some((0, (1i128 << self.bits()) - 1))
        }
    }
}

impl fmt::Display for Elementary {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// A value of an elementary type, held as the 64 bits of its **register form**: integers and TIME extended to
/// 64 bits by their sign, unsigned types and bit strings zero-extended, BOOL as 0 or 1, REAL as its 32 IEEE
/// bits zero-extended, LREAL as its 64. The form is canonical: equal values have equal bits (but that there
/// are two zeros, and NaN is what the bits say).
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
pub struct Value {
    ty: Elementary,
    bits: u64,
}

impl Value {
    /// The value of register bits; bits outside the type's width are dropped.
    pub fn from_bits(ty: Elementary, bits: u64) -> Self {
        Self { ty, bits: canonical(ty, bits) }
    }

    /// Zero, FALSE or no time: what a variable without an initial value starts with.
    pub fn default_of(ty: Elementary) -> Self {
        Self { ty, bits: 0 }
    }

    /// FALSE or TRUE.
    pub fn bool(value: bool) -> Self {
        Self { ty: Bool, bits: u64::from(value) }
    }

    /// An integer, bit string, BOOL or TIME (nanoseconds); `None` when it is out of range or the type is REAL or LREAL.
    pub fn integer(ty: Elementary, value: i128) -> Option<Self> {
        let (least, greatest) = ty.range()?;
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "in range, so that the low 64 bits are the register form"
        )]
        (least..=greatest).contains(&value).then_some(Self { ty, bits: value as u64 })
    }

    /// A REAL (rounded to nearest) or an LREAL; `None` for another type.
    pub fn real(ty: Elementary, value: f64) -> Option<Self> {
        #[expect(clippy::cast_possible_truncation, reason = "rounding to REAL is the conversion's meaning")]
        match ty {
            Real => Some(Self { ty, bits: u64::from((value as f32).to_bits()) }),
            Lreal => Some(Self { ty, bits: value.to_bits() }),
            _ => None,
        }
    }

    /// A duration in nanoseconds.
    pub fn time(nanoseconds: i64) -> Self {
        Self { ty: Time, bits: nanoseconds.cast_unsigned() }
    }

    /// Its type.
    pub fn ty(self) -> Elementary {
        self.ty
    }

    /// Its register form.
    pub fn bits(self) -> u64 {
        self.bits
    }

    /// Whether it is anything but FALSE or zero.
    pub fn is_true(self) -> bool {
        self.bits != 0
    }

    /// The number of an integer, bit string, BOOL or TIME; `None` for REAL and LREAL.
    pub fn as_integer(self) -> Option<i128> {
        if self.ty.is_real() {
            None
        } else if self.ty.is_signed() {
            Some(i128::from(self.bits.cast_signed()))
        } else {
            Some(i128::from(self.bits))
        }
    }

    /// The number of a REAL or LREAL; `None` for another type.
    pub fn as_real(self) -> Option<f64> {
        match self.ty {
            Real => Some(f64::from(f32_of(self.bits))),
            Lreal => Some(f64::from_bits(self.bits)),
            _ => None,
        }
    }
}

impl fmt::Debug for Value {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.as_real() {
            Some(real) => write!(f, "{}#{real:?}", self.ty),
            None => write!(f, "{}#{}", self.ty, self.as_integer().unwrap_or_default()),
        }
    }
}

/// Register bits of `ty` with what lies outside its width replaced by the extension that [`Value`] describes.
pub fn canonical(ty: Elementary, bits: u64) -> u64 {
    let unused = 64 - ty.bits();
    if ty.is_signed() { (bits.cast_signed() << unused >> unused).cast_unsigned() } else { bits << unused >> unused }
}

/// The REAL that register bits hold.
pub fn f32_of(bits: u64) -> f32 {
    #[expect(clippy::cast_possible_truncation, reason = "a REAL is the low 32 bits")]
    f32::from_bits(bits as u32)
}
