//! The op table: every primitive operation, its spelling in text and the types it works on.
//!
//! Back ends match these enumerations without a catch-all arm, so that a new operation does not compile until
//! every engine has it. A function block must never appear here.

use std::fmt;
use std::ops::Range;

use super::{ArrayId, Layout, SlotId};
use crate::elementary::Elementary;

/// A value: the place of the instruction that defines it in its program.
#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Debug)]
pub struct ValueId(pub u32);

impl ValueId {
    /// The place as an index.
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

impl fmt::Display for ValueId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "v{}", self.0)
    }
}

/// One instruction: an operation and the type of its result.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub struct Instruction {
    /// The type of the result; of a store or copy, which has none, the type that it stores.
    pub ty: Elementary,
    /// What it does.
    pub op: Op,
}

/// A primitive operation. All are total: no operand makes one fail, see [`evaluate`](super::evaluate).
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum Op {
    /// A constant, in register form (see [`Value`](crate::elementary::Value)).
    Constant(u64),
    /// The controller's time, latched once a scan: nanoseconds since its start, a TIME.
    Now,
    /// The value of a slot.
    Load(SlotId),
    /// Sets a slot.
    Store(SlotId, ValueId),
    /// One operand, of the result's type.
    Unary(Unary, ValueId),
    /// Two operands of the result's type; the amount of a shift or rotation is a UDINT instead.
    Binary(Binary, ValueId, ValueId),
    /// A BOOL from two operands of one type.
    Compare(Compare, ValueId, ValueId),
    /// The second operand while the first, a BOOL, is TRUE, else the third.
    Select(ValueId, ValueId, ValueId),
    /// The operand, of any type, as the result's type.
    Convert(ValueId),
    /// The operand's bits as the result's type, which is as wide.
    Reinterpret(ValueId),
    /// A pure function of one or two operands of the result's type; the second is there where it takes two.
    Call(Helper, ValueId, Option<ValueId>),
    /// The value of an array's element, counted from 0 by a LINT; where there is none, the type's default.
    LoadIndexed(ArrayId, ValueId),
    /// Sets an array's element, counted from 0 by a LINT, to a value; where there is none, nothing.
    StoreIndexed(ArrayId, ValueId, ValueId),
    /// Sets every element of the first array to that of the second, of the same type and count, while a BOOL is TRUE. The
    /// arrays are the same, or share no slot.
    CopyArray(ArrayId, ArrayId, ValueId),
}

impl Op {
    /// Whether it has a result, which stores and copies have not.
    pub fn has_value(self) -> bool {
        !matches!(self, Self::Store(..) | Self::StoreIndexed(..) | Self::CopyArray(..))
    }

    /// The slots that it may set, side by side; `None` where it sets none.
    pub fn stores(self, layout: &Layout) -> Option<Range<SlotId>> {
        match self {
            Self::Store(slot, _) => Some(slot..SlotId(slot.0.saturating_add(1))),
            Self::StoreIndexed(array, ..) | Self::CopyArray(array, ..) => Some(layout.array(array).slots()),
            Self::Constant(_)
            | Self::Now
            | Self::Load(_)
            | Self::Unary(..)
            | Self::Binary(..)
            | Self::Compare(..)
            | Self::Select(..)
            | Self::Convert(_)
            | Self::Reinterpret(_)
            | Self::Call(..)
            | Self::LoadIndexed(..) => None,
        }
    }

    /// The operands, in order.
    pub fn operands(self) -> impl Iterator<Item = ValueId> {
        let operands = match self {
            Self::Constant(_) | Self::Now | Self::Load(_) => [None, None, None],
            Self::Store(_, a)
            | Self::Unary(_, a)
            | Self::Convert(a)
            | Self::Reinterpret(a)
            | Self::LoadIndexed(_, a)
            | Self::CopyArray(_, _, a) => [Some(a), None, None],
            Self::Binary(_, a, b) | Self::Compare(_, a, b) | Self::StoreIndexed(_, a, b) => [Some(a), Some(b), None],
            Self::Select(a, b, c) => [Some(a), Some(b), Some(c)],
            Self::Call(_, a, b) => [Some(a), b, None],
        };
        operands.into_iter().flatten()
    }

    /// The same operation with each operand replaced.
    #[must_use]
    pub fn map_operands(self, mut map: impl FnMut(ValueId) -> ValueId) -> Self {
        match self {
            Self::Constant(_) | Self::Now | Self::Load(_) => self,
            Self::Store(slot, a) => Self::Store(slot, map(a)),
            Self::Unary(op, a) => Self::Unary(op, map(a)),
            Self::Binary(op, a, b) => Self::Binary(op, map(a), map(b)),
            Self::Compare(op, a, b) => Self::Compare(op, map(a), map(b)),
            Self::Select(a, b, c) => Self::Select(map(a), map(b), map(c)),
            Self::Convert(a) => Self::Convert(map(a)),
            Self::Reinterpret(a) => Self::Reinterpret(map(a)),
            Self::Call(helper, a, b) => Self::Call(helper, map(a), b.map(map)),
            Self::LoadIndexed(array, a) => Self::LoadIndexed(array, map(a)),
            Self::StoreIndexed(array, a, b) => Self::StoreIndexed(array, map(a), map(b)),
            Self::CopyArray(to, from, a) => Self::CopyArray(to, from, map(a)),
        }
    }
}

/// The types that an operation works on.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Domain {
    /// BOOL, BYTE, WORD, DWORD, LWORD.
    Bits,
    /// The bit strings but BOOL.
    WideBits,
    /// The integers and TIME.
    Integers,
    /// REAL and LREAL.
    Reals,
    /// The integers, TIME, REAL and LREAL.
    Numbers,
    /// Every type.
    Any,
}

impl Domain {
    /// Whether it holds a type.
    pub const fn contains(self, ty: Elementary) -> bool {
        let integer = ty.is_integer() || matches!(ty, Elementary::Time);
        match self {
            Self::Bits => ty.is_bit_string(),
            Self::WideBits => ty.is_bit_string() && !matches!(ty, Elementary::Bool),
            Self::Integers => integer,
            Self::Reals => ty.is_real(),
            Self::Numbers => integer || ty.is_real(),
            Self::Any => true,
        }
    }
}

macro_rules! operations {
    ($(#[$outer:meta])* $name:ident { $($(#[$doc:meta])* $variant:ident $mnemonic:literal $domain:ident,)* }) => {
        $(#[$outer])*
        #[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
        pub enum $name {
            $($(#[$doc])* $variant,)*
        }

        impl $name {
            /// Every one, in the order of the table.
            pub const ALL: &'static [Self] = &[$(Self::$variant,)*];

            /// How it is spelled in text.
            pub const fn mnemonic(self) -> &'static str {
                match self { $(Self::$variant => $mnemonic,)* }
            }

            /// The types of its (first) operand.
            pub const fn domain(self) -> Domain {
                match self { $(Self::$variant => Domain::$domain,)* }
            }

            /// The one spelled so.
            pub fn from_mnemonic(text: &str) -> Option<Self> {
                Self::ALL.iter().copied().find(|op| op.mnemonic() == text)
            }
        }
    };
}

operations! {
    /// Operations on one operand.
    Unary {
        /// Every bit inverted.
        Not "not" Bits,
        /// Zero minus the operand; the least signed integer stays itself.
        Negate "neg" Numbers,
        /// The magnitude; the least signed integer stays itself.
        Absolute "abs" Numbers,
        /// The square root, rounded to nearest; NaN below zero.
        SquareRoot "sqrt" Reals,
    }
}

operations! {
    /// Operations on two operands.
    Binary {
        /// Bitwise and.
        And "and" Bits,
        /// Bitwise or.
        Or "or" Bits,
        /// Bitwise exclusive or.
        Xor "xor" Bits,
        /// Sum; integers wrap around.
        Add "add" Numbers,
        /// Difference; integers wrap around.
        Subtract "sub" Numbers,
        /// Product; integers wrap around.
        Multiply "mul" Numbers,
        /// Quotient, of integers cut towards zero. An integer divided by zero is 0, the least by -1 is itself.
        Divide "div" Numbers,
        /// What the integer quotient leaves, with the sign of the dividend. Divided by zero it is 0.
        Remainder "rem" Integers,
        /// The lesser integer.
        Minimum "min" Integers,
        /// The greater integer.
        Maximum "max" Integers,
        /// Bits moved up, zeros in; by the width or more: 0. The amount is a UDINT.
        ShiftLeft "shl" WideBits,
        /// Bits moved down, zeros in; by the width or more: 0. The amount is a UDINT.
        ShiftRight "shr" WideBits,
        /// Bits moved up, around the end, by the amount modulo the width. The amount is a UDINT.
        RotateLeft "rol" WideBits,
        /// Bits moved down, around the end, by the amount modulo the width. The amount is a UDINT.
        RotateRight "ror" WideBits,
    }
}

impl Binary {
    /// Whether the second operand is an amount, a UDINT, rather than of the result's type.
    pub const fn takes_amount(self) -> bool {
        matches!(self, Self::ShiftLeft | Self::ShiftRight | Self::RotateLeft | Self::RotateRight)
    }
}

operations! {
    /// Comparisons. With a NaN among the operands only `ne` holds.
    Compare {
        /// Equal.
        Equal "eq" Any,
        /// Not equal.
        NotEqual "ne" Any,
        /// Less.
        Less "lt" Any,
        /// Less or equal.
        LessOrEqual "le" Any,
        /// Greater.
        Greater "gt" Any,
        /// Greater or equal.
        GreaterOrEqual "ge" Any,
    }
}

operations! {
    /// Functions too large for a few instructions: compiled code calls them, all engines the same ones. Of a REAL they
    /// are computed in LREAL and rounded once. An LREAL is right to about a unit in the last place, the same bits
    /// everywhere.
    Helper {
        /// The natural logarithm; minus infinity of zero, NaN below.
        Ln "ln" Reals,
        /// The logarithm to base 10; minus infinity of zero, NaN below.
        Log10 "log" Reals,
        /// e to the power of the operand.
        Exp "exp" Reals,
        /// The sine of an angle in radians; NaN of an infinity.
        Sin "sin" Reals,
        /// The cosine of an angle in radians; NaN of an infinity.
        Cos "cos" Reals,
        /// The tangent of an angle in radians; NaN of an infinity.
        Tan "tan" Reals,
        /// The angle from -pi/2 to pi/2 with this sine; NaN outside -1 to 1.
        Asin "asin" Reals,
        /// The angle from 0 to pi with this cosine; NaN outside -1 to 1.
        Acos "acos" Reals,
        /// The angle from -pi/2 to pi/2 with this tangent.
        Atan "atan" Reals,
        /// The first operand to the power of the second: 1 whenever that is 0 or the first is 1, even with a NaN; NaN
        /// of a negative number to a power that is not whole.
        Power "pow" Reals,
    }
}

impl Helper {
    /// Whether it takes a second operand.
    pub const fn takes_two(self) -> bool {
        matches!(self, Self::Power)
    }
}
