//! Expressions as written: what stands in braces, at pins and behind `:=` in declarations.

use thin_vec::ThinVec;

use super::{Address, Name};
use crate::elementary::Elementary;
use crate::source::Span;

/// An expression in IEC 61131-3 syntax.
#[derive(Clone, PartialEq, Debug)]
pub struct Expression {
    /// What it is.
    pub kind: ExpressionKind,
    /// Where.
    pub span: Span,
}

/// What an expression is.
#[derive(Clone, PartialEq, Debug)]
pub enum ExpressionKind {
    /// A value.
    Literal(Literal),
    /// A variable, a member, a bit or an address.
    Read(Reference),
    /// One operand.
    Unary(UnaryOperator, Box<Expression>),
    /// Two operands.
    Binary(BinaryOperator, Box<Expression>, Box<Expression>),
    /// `LIMIT(0, x, 10)`: a call of a function.
    Call {
        /// Which.
        function: Name,
        /// What it gets, in the order written.
        arguments: ThinVec<FunctionArgument>,
    },
    /// `[1, 2, 8(0)]`: the initial value of an array, in order of its elements.
    Array(Vec<ArrayItem>),
    /// `(x := 1, y := 2)`: initial values of the members of a structure or block instance.
    Structure(Vec<MemberValue>),
}

/// One item of an array's initial value.
#[derive(Clone, PartialEq, Debug)]
pub struct ArrayItem {
    /// How many elements it is for, where that is written; else one.
    pub repeat: Option<Expression>,
    /// What each gets; in `8()` the type's default.
    pub value: Option<Expression>,
}

/// One member of a structure's initial value.
#[derive(Clone, PartialEq, Debug)]
pub struct MemberValue {
    /// Which.
    pub member: Name,
    /// What it gets.
    pub value: Expression,
}

/// One argument of a function.
#[derive(Clone, PartialEq, Debug)]
pub struct FunctionArgument {
    /// The parameter, where the call names it: `G := x`.
    pub parameter: Option<Name>,
    /// The value.
    pub value: Expression,
}

/// A literal. Whether a number fits its type is for `check` to say.
#[derive(Clone, PartialEq, Debug)]
pub enum Literal {
    /// `TRUE`, `FALSE`.
    Bool(bool),
    /// `12`, `16#FF`, `INT#5`.
    Integer {
        /// Its magnitude; a sign is a unary operator.
        value: Magnitude,
        /// The base in which it was written: 2, 8, 10 or 16.
        base: u8,
        /// The type before the `#`.
        ty: Option<Elementary>,
    },
    /// `1.5`, `REAL#1.0e3`.
    Real {
        /// Its value, finite.
        value: f64,
        /// The type before the `#`.
        ty: Option<Elementary>,
    },
    /// `T#1m30s`: nanoseconds, negative behind a minus sign.
    Time(i64),
    /// `colour#red`: a value of an enumeration.
    Enumerated {
        /// The type before the `#`.
        ty: Box<Name>,
        /// The value's name.
        value: Box<Name>,
    },
}

/// The magnitude of a number as written. It is as a `u128`, but aligned like other numbers: an expression that holds one
/// would take a third more room, and programs have millions.
#[derive(Clone, Copy, Default, PartialEq, Eq, Debug)]
pub struct Magnitude {
    high: u64,
    low: u64,
}

impl Magnitude {
    /// The number.
    pub const fn get(self) -> u128 {
        (self.high as u128) << 64 | self.low as u128
    }
}

impl From<u128> for Magnitude {
    #[expect(clippy::cast_possible_truncation, reason = "each half is taken")]
    fn from(number: u128) -> Self {
        Self { high: (number >> 64) as u64, low: number as u64 }
    }
}

/// Something that can be read, and perhaps written.
#[derive(Clone, PartialEq, Debug)]
pub struct Reference {
    /// Where it starts.
    pub root: Root,
    /// The way from there.
    pub steps: ThinVec<Step>,
    /// All of it.
    pub span: Span,
}

/// Where a reference starts.
#[derive(Clone, PartialEq, Debug)]
pub enum Root {
    /// A declared name.
    Name(Name),
    /// An address without a declaration.
    Address(Box<Address>),
}

/// One step of a reference.
#[derive(Clone, PartialEq, Debug)]
pub enum Step {
    /// `.name`
    Member(Name),
    /// `.3`: a bit of a bit string, from 0.
    Bit(u8, Span),
    /// `[i]`, `[i, 2]`: an element of an array, one index for each dimension.
    Index(Vec<Expression>, Span),
}

impl Reference {
    /// A reference that is a name and nothing more.
    pub fn of_name(name: Name) -> Self {
        let span = name.span;
        Self { root: Root::Name(name), steps: ThinVec::new(), span }
    }

    /// The name, if it is nothing more.
    pub fn as_name(&self) -> Option<&Name> {
        match &self.root {
            Root::Name(name) if self.steps.is_empty() => Some(name),
            _ => None,
        }
    }
}

/// Operators on one operand.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum UnaryOperator {
    /// `NOT`
    Not,
    /// `-`
    Negate,
}

/// Operators on two operands.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum BinaryOperator {
    /// `OR`
    Or,
    /// `XOR`
    Xor,
    /// `AND`, `&`
    And,
    /// `=`
    Equal,
    /// `<>`
    NotEqual,
    /// `<`
    Less,
    /// `<=`
    LessOrEqual,
    /// `>`
    Greater,
    /// `>=`
    GreaterOrEqual,
    /// `+`
    Add,
    /// `-`
    Subtract,
    /// `*`
    Multiply,
    /// `/`
    Divide,
    /// `MOD`
    Modulo,
}

impl BinaryOperator {
    /// Every operator.
    pub const ALL: [Self; 14] = [
        Self::Or,
        Self::Xor,
        Self::And,
        Self::Equal,
        Self::NotEqual,
        Self::Less,
        Self::LessOrEqual,
        Self::Greater,
        Self::GreaterOrEqual,
        Self::Add,
        Self::Subtract,
        Self::Multiply,
        Self::Divide,
        Self::Modulo,
    ];

    /// Its canonical spelling.
    pub const fn symbol(self) -> &'static str {
        match self {
            Self::Or => "OR",
            Self::Xor => "XOR",
            Self::And => "AND",
            Self::Equal => "=",
            Self::NotEqual => "<>",
            Self::Less => "<",
            Self::LessOrEqual => "<=",
            Self::Greater => ">",
            Self::GreaterOrEqual => ">=",
            Self::Add => "+",
            Self::Subtract => "-",
            Self::Multiply => "*",
            Self::Divide => "/",
            Self::Modulo => "MOD",
        }
    }

    /// How tightly it binds: a greater number binds tighter (IEC 61131-3, table 71). All associate to the left.
    pub const fn precedence(self) -> u8 {
        match self {
            Self::Or => 1,
            Self::Xor => 2,
            Self::And => 3,
            Self::Equal | Self::NotEqual => 4,
            Self::Less | Self::LessOrEqual | Self::Greater | Self::GreaterOrEqual => 5,
            Self::Add | Self::Subtract => 6,
            Self::Multiply | Self::Divide | Self::Modulo => 7,
        }
    }

    /// Whether it compares, so that its result is a BOOL whatever its operands are.
    pub const fn is_comparison(self) -> bool {
        matches!(self.precedence(), 4 | 5)
    }
}
