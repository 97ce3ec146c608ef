//! The standard functions of IEC 61131-3 (6.6.2.5): names, parameters and types.
//!
//! One entry a function, and its rule in one function of `lower`; nothing else must know what parameters a function has.
//! What each computes is said in `docs/functions.md`.

use std::sync::LazyLock;

use crate::elementary::Elementary::{self, Bool, Time};

/// A class of types, one of which a call chooses for all parameters that have it.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Class {
    /// Every type.
    Any,
    /// The integers, REAL and LREAL (ANY_NUM).
    Number,
    /// Those and TIME (ANY_MAGNITUDE).
    Magnitude,
    /// The integers (ANY_INT).
    Integer,
    /// Those and TIME.
    Countable,
    /// REAL and LREAL (ANY_REAL).
    Real,
    /// BOOL and the bit strings (ANY_BIT).
    Bits,
    /// The bit strings but BOOL.
    WideBits,
}

impl Class {
    /// Whether it holds a type.
    pub const fn contains(self, ty: Elementary) -> bool {
        let number = ty.is_integer() || ty.is_real();
        match self {
            Self::Any => true,
            Self::Number => number,
            Self::Magnitude => number || matches!(ty, Time),
            Self::Integer => ty.is_integer(),
            Self::Countable => ty.is_integer() || matches!(ty, Time),
            Self::Real => ty.is_real(),
            Self::Bits => ty.is_bit_string(),
            Self::WideBits => ty.is_bit_string() && !matches!(ty, Bool),
        }
    }

    /// What it holds, in words.
    pub const fn describe(self) -> &'static str {
        match self {
            Self::Any => "all types",
            Self::Number => "numbers",
            Self::Magnitude => "numbers and TIME",
            Self::Integer => "integers",
            Self::Countable => "integers and TIME",
            Self::Real => "REAL and LREAL",
            Self::Bits => "BOOL and bit strings",
            Self::WideBits => "BYTE, WORD, DWORD and LWORD",
        }
    }
}

/// The type of a parameter.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum ParameterType {
    /// The type that the call chooses out of the function's class.
    Generic,
    /// One type, or what widens to it.
    Exactly(Elementary),
    /// A type of its own out of a class.
    Own(Class),
    /// A number beside an operand of another type: what widens to LINT becomes one, REAL becomes LREAL.
    Scale,
}

/// One parameter.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Parameter {
    /// Its name, as the standard spells it.
    pub name: &'static str,
    /// Its type.
    pub ty: ParameterType,
}

/// The type of a result.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum ResultType {
    /// The type that the call chose.
    Generic,
    /// One type.
    Exactly(Elementary),
}

macro_rules! parameter_type {
    (T) => {
        ParameterType::Generic
    };
    (Number) => {
        ParameterType::Scale
    };
    (Integer) => {
        ParameterType::Own(Class::Integer)
    };
    ($ty:ident) => {
        ParameterType::Exactly(Elementary::$ty)
    };
}

macro_rules! result_type {
    (T) => {
        ResultType::Generic
    };
    ($ty:ident) => {
        ResultType::Exactly(Elementary::$ty)
    };
}

macro_rules! extensible {
    () => {
        false
    };
    (more) => {
        true
    };
}

macro_rules! functions {
    ($($(#[$doc:meta])* $variant:ident $name:literal $class:ident ($($parameter:literal: $ty:ident),*) $($more:ident)? -> $result:ident;)*) => {
        /// A standard function with one entry in the table; the conversions are no such.
        #[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
        pub enum StandardFunction {
            $($(#[$doc])* $variant,)*
        }

        impl StandardFunction {
            /// Every one, in the order of the table.
            pub const ALL: &'static [Self] = &[$(Self::$variant,)*];

            /// Its name, as the standard spells it.
            pub const fn name(self) -> &'static str {
                match self { $(Self::$variant => $name,)* }
            }

            /// The class out of which a call chooses the one type of its generic parameters.
            pub const fn class(self) -> Class {
                match self { $(Self::$variant => Class::$class,)* }
            }

            /// Its parameters, in order.
            pub const fn parameters(self) -> &'static [Parameter] {
                match self {
                    $(Self::$variant => const {
                        &[$(Parameter { name: $parameter, ty: parameter_type!($ty) },)*]
                    },)*
                }
            }

            /// Whether more parameters like the last may follow, with the numbers that follow its number.
            pub const fn is_extensible(self) -> bool {
                match self { $(Self::$variant => extensible!($($more)?),)* }
            }

            /// The type of its result.
            pub const fn result(self) -> ResultType {
                match self { $(Self::$variant => result_type!($result),)* }
            }
        }
    };
}

functions! {
    /// The magnitude.
    Absolute "ABS" Number ("IN": T) -> T;
    /// The square root.
    SquareRoot "SQRT" Real ("IN": T) -> T;
    /// The natural logarithm.
    Ln "LN" Real ("IN": T) -> T;
    /// The logarithm to base 10.
    Log "LOG" Real ("IN": T) -> T;
    /// e to a power.
    Exp "EXP" Real ("IN": T) -> T;
    /// The sine of an angle in radians.
    Sin "SIN" Real ("IN": T) -> T;
    /// The cosine.
    Cos "COS" Real ("IN": T) -> T;
    /// The tangent.
    Tan "TAN" Real ("IN": T) -> T;
    /// The angle with this sine.
    Asin "ASIN" Real ("IN": T) -> T;
    /// The angle with this cosine.
    Acos "ACOS" Real ("IN": T) -> T;
    /// The angle with this tangent.
    Atan "ATAN" Real ("IN": T) -> T;
    /// A number to a power.
    Power "EXPT" Real ("IN1": T, "IN2": Number) -> T;
    /// The sum.
    Add "ADD" Magnitude ("IN1": T, "IN2": T) more -> T;
    /// The product.
    Multiply "MUL" Number ("IN1": T, "IN2": T) more -> T;
    /// The difference.
    Subtract "SUB" Magnitude ("IN1": T, "IN2": T) -> T;
    /// The quotient.
    Divide "DIV" Number ("IN1": T, "IN2": T) -> T;
    /// What the integer quotient leaves.
    Modulo "MOD" Countable ("IN1": T, "IN2": T) -> T;
    /// The value itself.
    Move "MOVE" Any ("IN": T) -> T;
    /// Bits moved up.
    ShiftLeft "SHL" WideBits ("IN": T, "N": Integer) -> T;
    /// Bits moved down.
    ShiftRight "SHR" WideBits ("IN": T, "N": Integer) -> T;
    /// Bits moved up, around the end.
    RotateLeft "ROL" WideBits ("IN": T, "N": Integer) -> T;
    /// Bits moved down, around the end.
    RotateRight "ROR" WideBits ("IN": T, "N": Integer) -> T;
    /// Bitwise and.
    And "AND" Bits ("IN1": T, "IN2": T) more -> T;
    /// Bitwise or.
    Or "OR" Bits ("IN1": T, "IN2": T) more -> T;
    /// Bitwise exclusive or.
    Xor "XOR" Bits ("IN1": T, "IN2": T) more -> T;
    /// Every bit inverted.
    Not "NOT" Bits ("IN": T) -> T;
    /// One of two.
    Select "SEL" Any ("G": Bool, "IN0": T, "IN1": T) -> T;
    /// The greatest.
    Maximum "MAX" Any ("IN1": T, "IN2": T) more -> T;
    /// The least.
    Minimum "MIN" Any ("IN1": T, "IN2": T) more -> T;
    /// A value held between two others.
    Limit "LIMIT" Any ("MN": T, "IN": T, "MX": T) -> T;
    /// One of many.
    Multiplex "MUX" Any ("K": Integer, "IN0": T, "IN1": T) more -> T;
    /// A falling sequence.
    Greater "GT" Any ("IN1": T, "IN2": T) more -> Bool;
    /// A sequence that does not rise.
    GreaterOrEqual "GE" Any ("IN1": T, "IN2": T) more -> Bool;
    /// All equal.
    Equal "EQ" Any ("IN1": T, "IN2": T) more -> Bool;
    /// A sequence that does not fall.
    LessOrEqual "LE" Any ("IN1": T, "IN2": T) more -> Bool;
    /// A rising sequence.
    Less "LT" Any ("IN1": T, "IN2": T) more -> Bool;
    /// Not equal.
    NotEqual "NE" Any ("IN1": T, "IN2": T) -> Bool;
    /// The sum of durations.
    AddTime "ADD_TIME" Any ("IN1": Time, "IN2": Time) -> Time;
    /// The difference of durations.
    SubtractTime "SUB_TIME" Any ("IN1": Time, "IN2": Time) -> Time;
    /// A multiple of a duration.
    MultiplyTime "MUL_TIME" Any ("IN1": Time, "IN2": Number) -> Time;
    /// A part of a duration.
    DivideTime "DIV_TIME" Any ("IN1": Time, "IN2": Number) -> Time;
}

impl StandardFunction {
    /// The function for a TIME as its first operand, where that is another.
    pub const fn of_time(self) -> Option<Self> {
        match self {
            Self::Multiply => Some(Self::MultiplyTime),
            Self::Divide => Some(Self::DivideTime),
            _ => None,
        }
    }

    /// Whether it divides its first operand by its second.
    pub const fn divides(self) -> bool {
        matches!(self, Self::Divide | Self::Modulo | Self::DivideTime)
    }

    /// The parameter at a place among the arguments of a call without names.
    pub fn parameter(self, place: usize) -> Option<Parameter> {
        let parameters = self.parameters();
        parameters.get(place).or_else(|| parameters.last().filter(|_| self.is_extensible())).copied()
    }

    /// The place of a parameter by its name in any case.
    pub fn place(self, name: &str) -> Option<usize> {
        let parameters = self.parameters();
        let listed = parameters.iter().position(|parameter| parameter.name.eq_ignore_ascii_case(name));
        listed.or_else(|| {
            // IN2 is followed by IN3: a number without a sign or zeros before it.
            let last = parameters.last().filter(|_| self.is_extensible())?.name;
            let first_extra = last.strip_prefix("IN")?.parse::<usize>().ok()? + 1;
            let digits = name.get(2..).filter(|_| name[..2].eq_ignore_ascii_case("IN"))?;
            let number = digits.parse::<usize>().ok().filter(|number| number.to_string() == digits)?;
            (parameters.len()).checked_add(number.checked_sub(first_extra)?)
        })
    }
}

/// A function by its name.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Function {
    /// One of the table.
    Standard(StandardFunction),
    /// `INT_TO_REAL`, and `TO_REAL` for an operand of any type: one parameter, `IN`.
    Convert {
        /// The type of the operand, where the name says it.
        from: Option<Elementary>,
        /// The type of the result.
        to: Elementary,
    },
    /// `TRUNC`, `TRUNC_INT`, `REAL_TRUNC_INT`: a real number cut towards zero; one parameter, `IN`.
    Truncate {
        /// The type of the operand, where the name says it: REAL or LREAL.
        from: Option<Elementary>,
        /// The type of the result, an integer, where the name says it.
        to: Option<Elementary>,
    },
}

impl Function {
    /// The function of that name, in any case.
    pub fn from_name(name: &str) -> Option<Self> {
        let standard = StandardFunction::ALL.iter().find(|function| function.name().eq_ignore_ascii_case(name));
        if let Some(function) = standard {
            return Some(Self::Standard(*function));
        }
        let parts: Vec<String> = name.split('_').take(4).map(str::to_ascii_uppercase).collect();
        let parts: Vec<&str> = parts.iter().map(String::as_str).collect();
        let ty = Elementary::from_name;
        match *parts.as_slice() {
            ["MULTIME"] => Some(Self::Standard(StandardFunction::MultiplyTime)),
            ["DIVTIME"] => Some(Self::Standard(StandardFunction::DivideTime)),
            ["TO", to] => Some(Self::Convert { from: None, to: ty(to)? }),
            [from, "TO", to] => Some(Self::Convert { from: Some(ty(from)?), to: ty(to)? }),
            ["TRUNC"] => Some(Self::Truncate { from: None, to: None }),
            ["TRUNC", to] => Some(Self::Truncate { from: None, to: Some(ty(to).filter(|to| to.is_integer())?) }),
            [from, "TRUNC", to] => Some(Self::Truncate {
                from: Some(ty(from).filter(|from| from.is_real())?),
                to: Some(ty(to).filter(|to| to.is_integer())?),
            }),
            _ => None,
        }
    }

    /// Every name, for suggestions.
    pub fn names() -> &'static [String] {
        static NAMES: LazyLock<Vec<String>> = LazyLock::new(|| {
            let mut names: Vec<String> =
                StandardFunction::ALL.iter().map(|function| function.name().to_owned()).collect();
            names.push("TRUNC".to_owned());
            for to in Elementary::ALL {
                names.push(format!("TO_{to}"));
                names.extend(Elementary::ALL.iter().filter(|from| **from != to).map(|from| format!("{from}_TO_{to}")));
                if to.is_integer() {
                    names.extend([format!("TRUNC_{to}"), format!("REAL_TRUNC_{to}"), format!("LREAL_TRUNC_{to}")]);
                }
            }
            names
        });
        &NAMES
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_name_names_a_function_in_any_case() {
        for name in Function::names() {
            let function = Function::from_name(name);
            assert!(function.is_some(), "{name}");
            assert_eq!(Function::from_name(&name.to_lowercase()), function, "{name}");
        }
        assert_eq!(Function::names().len(), 41 + 1 + 16 * 16 + 8 * 3);
        for name in ["", "_", "INT_TO", "TO_", "TO_STRING", "INT_TO_REAL_TO_INT", "INT_TRUNC_INT", "TRUNC_REAL", "é"] {
            assert_eq!(Function::from_name(name), None, "{name}");
        }
    }

    #[test]
    fn names_of_further_parameters_count_on() {
        assert_eq!(StandardFunction::Multiplex.place("k"), Some(0));
        assert_eq!(StandardFunction::Multiplex.place("in1"), Some(2));
        assert_eq!(StandardFunction::Multiplex.place("IN7"), Some(8));
        assert_eq!(StandardFunction::Add.place("IN3"), Some(2));
        for name in ["IN0", "IN03", "IN+3", "IN", "I", "é", "iné", "IN18446744073709551615", "G"] {
            let place = StandardFunction::Add.place(name);
            assert!(place.is_none_or(|place| place > 1_000), "{name} is at {place:?}");
        }
        assert_eq!(StandardFunction::Subtract.place("IN3"), None);
    }
}
