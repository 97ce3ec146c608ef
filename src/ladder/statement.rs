//! Structured text as written: what stands in braces, and the bodies of units that are written in it.

use super::{BlockCall, Expression, Reference};
use crate::source::Span;

/// One statement.
#[derive(Clone, PartialEq, Debug)]
pub struct Statement {
    /// What it is.
    pub kind: StatementKind,
    /// Where.
    pub span: Span,
}

/// What a statement is (IEC 61131-3, 7.3.3). WHILE and REPEAT are none: a scan is a straight line.
#[derive(Clone, PartialEq, Debug)]
pub enum StatementKind {
    /// `x := 1;`
    Assignment {
        /// What it writes.
        target: Reference,
        /// The value.
        value: Expression,
    },
    /// `t1(IN := a, Q => b);`: no power feeds an input, so that what is not wired keeps its value.
    Call(BlockCall),
    /// `IF a THEN … ELSIF b THEN … ELSE … END_IF`
    If {
        /// The conditions in order, each with what it is for; at least one.
        branches: Vec<ConditionalBranch>,
        /// What is done if none holds.
        otherwise: Vec<Statement>,
    },
    /// `CASE x OF 1, 3..5: … ELSE … END_CASE`
    Case {
        /// What is compared: an integer or a value of an enumeration.
        selector: Expression,
        /// In order; the first that matches is done.
        branches: Vec<CaseBranch>,
        /// What is done if none matches.
        otherwise: Vec<Statement>,
    },
    /// `FOR i := 0 TO 9 BY 1 DO … END_FOR`: the bounds are constant, and it is done so many times.
    For {
        /// The variable that counts.
        variable: Reference,
        /// Its first value.
        first: Expression,
        /// The value that it does not pass.
        last: Expression,
        /// What is added each time; else 1.
        step: Option<Expression>,
        /// What is repeated.
        body: Vec<Statement>,
    },
    /// Leaves the innermost FOR.
    Exit,
    /// Leaves the unit.
    Return,
}

/// One condition and what is done if it is the first that holds.
#[derive(Clone, PartialEq, Debug)]
pub struct ConditionalBranch {
    /// A BOOL.
    pub condition: Expression,
    /// What is done.
    pub body: Vec<Statement>,
}

/// The labels of a CASE and what is done if one of them matches.
#[derive(Clone, PartialEq, Debug)]
pub struct CaseBranch {
    /// At least one.
    pub labels: Vec<CaseLabel>,
    /// What is done.
    pub body: Vec<Statement>,
}

/// One label of a CASE; constant.
#[derive(Clone, PartialEq, Debug)]
pub struct CaseLabel {
    /// The value, or the first of a range.
    pub first: Expression,
    /// The last of a range.
    pub last: Option<Expression>,
}
