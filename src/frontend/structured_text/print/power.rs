//! The power at a point of a rung, as an expression that is not computed yet.

use crate::frontend::uses::{self, Use};
use crate::ladder::functions::Function;
use crate::ladder::{BinaryOperator, Expression, ExpressionKind, Literal, Name, Reference, Root, Step, UnaryOperator};
use crate::source::Span;

/// Expressions do not get higher than this: our reader, and others, bound them.
pub(super) const HIGHEST: usize = 60;

/// Power.
#[derive(Clone)]
pub(super) enum Power {
    Never,
    Always,
    While(Expression),
}

impl Power {
    /// What a BOOL variable says.
    pub(super) fn of_variable(name: &str) -> Self {
        Self::While(read(name, &[]))
    }

    /// What a BOOL expression says.
    pub(super) fn of(expression: Expression) -> Self {
        match expression.kind {
            ExpressionKind::Literal(Literal::Bool(true)) => Self::Always,
            ExpressionKind::Literal(Literal::Bool(false)) => Self::Never,
            _ => Self::While(expression),
        }
    }

    pub(super) fn and(self, other: Self) -> Self {
        match (self, other) {
            (Self::Never, _) | (_, Self::Never) => Self::Never,
            (Self::Always, power) | (power, Self::Always) => power,
            (Self::While(left), Self::While(right)) => Self::While(binary(BinaryOperator::And, left, right)),
        }
    }

    pub(super) fn or(self, other: Self) -> Self {
        match (self, other) {
            (Self::Always, _) | (_, Self::Always) => Self::Always,
            (Self::Never, power) | (power, Self::Never) => power,
            (Self::While(left), Self::While(right)) => Self::While(binary(BinaryOperator::Or, left, right)),
        }
    }

    pub(super) fn negated(self) -> Self {
        match self {
            Self::Never => Self::Always,
            Self::Always => Self::Never,
            Self::While(operand) => {
                let kind = ExpressionKind::Unary(UnaryOperator::Not, Box::new(operand));
                Self::While(Expression { kind, span: Span::default() })
            }
        }
    }

    pub(super) fn expression(&self) -> Expression {
        let literal = |value| Expression { kind: ExpressionKind::Literal(Literal::Bool(value)), span: Span::default() };
        match self {
            Self::Never => literal(false),
            Self::Always => literal(true),
            Self::While(expression) => expression.clone(),
        }
    }

    pub(super) fn height(&self) -> usize {
        match self {
            Self::While(expression) => height(expression),
            _ => 0,
        }
    }

    /// Whether it is one name.
    pub(super) fn is_name(&self) -> bool {
        match self {
            Self::While(expression) => {
                matches!(&expression.kind, ExpressionKind::Read(read) if read.as_name().is_some())
            }
            _ => true,
        }
    }
}

/// What may change at once.
pub(super) enum Change<'a> {
    /// What a name stands for, and nothing else.
    Name(&'a str),
    /// Anything.
    All,
}

/// Whether a power is another after a change. `is_simple` says whether the variable of a key shares its storage with no other;
/// `is_own` whether only this program's writer changes it.
pub(super) fn depends(
    power: &Power,
    change: &Change<'_>,
    is_simple: &dyn Fn(&str) -> bool,
    is_own: &dyn Fn(&str) -> bool,
) -> bool {
    let Power::While(expression) = power else { return false };
    let mut found = false;
    uses::expression(expression, &mut |mentioned| {
        found |= match (mentioned, change) {
            (Use::Function(name), _) => Function::from_name(&name.text).is_none(),
            (Use::Block(..), _) => true,
            (Use::Reference(_), change) => match (uses::root_key(mentioned), change) {
                (None, _) => true,
                (Some(key), Change::Name(changed)) => key == *changed || !(is_own(&key) || is_simple(&key)),
                (Some(key), Change::All) => !is_own(&key),
            },
        };
    });
    found
}

/// `name.member`
pub(super) fn read(name: &str, members: &[&str]) -> Expression {
    let named = |text: &str| Name::new(text, Span::default());
    let steps = members.iter().map(|member| Step::Member(named(member))).collect();
    let reference = Reference { root: Root::Name(named(name)), steps, span: Span::default() };
    Expression { kind: ExpressionKind::Read(reference), span: Span::default() }
}

fn binary(operator: BinaryOperator, left: Expression, right: Expression) -> Expression {
    Expression { kind: ExpressionKind::Binary(operator, Box::new(left), Box::new(right)), span: Span::default() }
}

fn height(expression: &Expression) -> usize {
    1 + match &expression.kind {
        ExpressionKind::Literal(_) => 0,
        ExpressionKind::Read(reference) => {
            let indices = reference.steps.iter().map(|step| match step {
                Step::Index(indices, _) => indices.iter().map(height).max().unwrap_or(0),
                _ => 0,
            });
            indices.max().unwrap_or(0)
        }
        ExpressionKind::Unary(_, operand) => height(operand),
        ExpressionKind::Binary(_, left, right) => height(left).max(height(right)),
        ExpressionKind::Call { arguments, .. } => {
            arguments.iter().map(|argument| height(&argument.value)).max().unwrap_or(0)
        }
        ExpressionKind::Array(items) => {
            items.iter().flat_map(|item| item.repeat.iter().chain(&item.value)).map(height).max().unwrap_or(0)
        }
        ExpressionKind::Structure(members) => members.iter().map(|member| height(&member.value)).max().unwrap_or(0),
    }
}
