//! Expressions: their types, found from the operands upwards, and constants folded on the way.
//!
//! A literal without a type takes that of the operand beside it, or of the place it goes to; literals among
//! themselves are computed exactly first. Two operands of different types are widened to one of the two, where that
//! loses nothing; nothing else is converted.

use super::Checker;
use super::constant::{self, Folded, Untyped};
use super::function::Actual;
use super::model::{Expression, ExpressionKind};
use super::types;
use crate::diagnostic::{Code, Diagnostic};
use crate::elementary::{Elementary, Value};
use crate::ladder::functions::{Function, StandardFunction};
use crate::ladder::{self, BinaryOperator, Literal, Name, UnaryOperator};
use crate::source::Span;

/// An expression of which the type may still be open.
pub(super) enum Operand {
    Typed(Expression),
    Untyped(Untyped),
}

impl Operand {
    /// Its type, if that is known.
    pub(super) fn ty(&self) -> Option<Elementary> {
        match self {
            Self::Typed(expression) => Some(expression.ty),
            Self::Untyped(_) => None,
        }
    }

    /// The type that it most likely is meant to have, where a BOOL cannot be made of it.
    pub(super) fn other_than_bool(&self) -> Option<Elementary> {
        match self {
            Self::Typed(expression) => Some(expression.ty).filter(|ty| *ty != Elementary::Bool),
            Self::Untyped(Untyped::Real(_)) => Some(Elementary::Real),
            Self::Untyped(number) => number.typed(Elementary::Bool).is_none().then_some(Elementary::Int),
        }
    }
}

/// A constant as an expression.
pub(super) fn constant(value: Value) -> Expression {
    Expression { ty: value.ty(), kind: ExpressionKind::Constant(value) }
}

impl Expression {
    /// Its value, if it is a constant.
    pub(super) fn constant(&self) -> Option<Value> {
        match self.kind {
            ExpressionKind::Constant(value) => Some(value),
            _ => None,
        }
    }
}

impl Checker<'_> {
    /// An expression that must be of a type. `None`: that was reported.
    pub(super) fn value(&mut self, expression: &ladder::Expression, ty: Elementary) -> Option<Expression> {
        let operand = match &expression.kind {
            ladder::ExpressionKind::Call { function, arguments } => {
                self.weigh(1);
                self.function(function, arguments, expression.span, Some(ty))
            }
            _ => self.operand(expression),
        };
        self.coerce(operand?, ty, expression.span)
    }

    /// An expression of whatever type. `None`: something in it is wrong, and was reported.
    pub(super) fn operand(&mut self, expression: &ladder::Expression) -> Option<Operand> {
        self.weigh(1);
        match &expression.kind {
            ladder::ExpressionKind::Literal(literal) => self.literal(literal, false, expression.span),
            ladder::ExpressionKind::Read(reference) => self.read(reference).map(Operand::Typed),
            ladder::ExpressionKind::Unary(op, operand) => self.unary(*op, operand, expression.span),
            ladder::ExpressionKind::Binary(op, left, right) => self.binary(*op, left, right, expression.span),
            ladder::ExpressionKind::Call { function, arguments } => {
                self.function(function, arguments, expression.span, None)
            }
            ladder::ExpressionKind::Array(_) | ladder::ExpressionKind::Structure(_) => {
                let message = "a list of values stands in declarations only";
                self.report.push(Diagnostic::new(Code::TypeMismatch, expression.span, message));
                None
            }
        }
    }

    /// A literal, or its negative: INT#32768 does not exist, but -INT#32768 does.
    fn literal(&mut self, literal: &Literal, negative: bool, span: Span) -> Option<Operand> {
        let (number, ty) = match *literal {
            Literal::Bool(value) => return Some(Operand::Typed(constant(Value::bool(value)))),
            Literal::Time(value) => return Some(Operand::Typed(constant(Value::time(value)))),
            Literal::Enumerated { ref ty, ref value } => {
                let found = self.types.value_of(&ty.text, &value.text);
                if found.is_none() {
                    let message = format!("there is no value `{}#{}`", ty.text, value.text);
                    self.report.push(Diagnostic::new(Code::UndeclaredName, span, message));
                }
                return found.map(constant).map(Operand::Typed);
            }
            Literal::Real { value, ty } => (Untyped::Real(if negative { -value } else { value }), ty),
            Literal::Integer { value, ty, .. } => {
                let Ok(value) = i128::try_from(value.get()) else {
                    self.report.push(Diagnostic::new(Code::OutOfRange, span, "no type holds this number"));
                    return None;
                };
                (Untyped::Integer(if negative { -value } else { value }), ty)
            }
        };
        match ty {
            Some(ty) => self.number(number, ty, span).map(constant).map(Operand::Typed),
            None => Some(Operand::Untyped(number)),
        }
    }

    /// A number in a type.
    fn number(&mut self, number: Untyped, ty: Elementary, span: Span) -> Option<Value> {
        if !number.suits(ty) {
            let [wanted, found] = [ty.name(), number.describe()].map(types::with_article);
            let message = format!("{wanted} is expected here, and this is {found}");
            let hint = match (ty, number) {
                (Elementary::Time, _) => "write a duration, as in `T#1m30s`".to_owned(),
                (_, Untyped::Real(_)) => "leave the fraction out, or declare the other side as REAL".to_owned(),
                _ => "what NOT, AND, OR and XOR make of numbers is a bit string".to_owned(),
            };
            self.report.push(Diagnostic::new(Code::TypeMismatch, span, message).hint(hint));
            return None;
        }
        let value = number.typed(ty);
        if value.is_none() {
            let shown = match number {
                Untyped::Integer(value) | Untyped::Bits(value) => value.to_string(),
                Untyped::Real(value) => format!("{value:?}"),
            };
            self.report.push(out_of_range(format!("{shown} is outside the range of {ty}"), ty, span));
        }
        value
    }

    /// An operand as a value of a type.
    pub(super) fn coerce(&mut self, operand: Operand, ty: Elementary, span: Span) -> Option<Expression> {
        match operand {
            Operand::Untyped(number) => self.number(number, ty, span).map(constant),
            Operand::Typed(expression) if expression.ty == ty => Some(expression),
            Operand::Typed(expression) if types::widens(expression.ty, ty) => {
                let widened = expression.constant().and_then(|value| constant::widen(value, ty)).map(constant);
                Some(widened.unwrap_or_else(|| Expression { ty, kind: ExpressionKind::Widen(Box::new(expression)) }))
            }
            Operand::Typed(expression) => {
                let [wanted, found] = [ty, expression.ty].map(|ty| types::with_article(ty.name()));
                let message = format!("{wanted} is expected here, and this is {found}");
                let problem = Diagnostic::new(Code::TypeMismatch, span, message);
                self.report.push(problem.hint(types::advice(expression.ty, ty)));
                None
            }
        }
    }

    fn unary(&mut self, op: UnaryOperator, inner: &ladder::Expression, span: Span) -> Option<Operand> {
        let (domain, takes) = types::unary_domain(op);
        match &inner.kind {
            ladder::ExpressionKind::Literal(literal @ (Literal::Integer { .. } | Literal::Real { .. }))
                if op == UnaryOperator::Negate =>
            {
                let negative = self.literal(literal, true, span)?;
                if let Operand::Typed(Expression { ty, .. }) = negative
                    && !takes(ty)
                {
                    self.not_taken(unary_name(op), domain, ty.name(), inner.span);
                    return None;
                }
                Some(negative)
            }
            _ => {
                let operand = self.operand(inner)?;
                self.unary_of(op, operand, inner.span, span)
            }
        }
    }

    /// An operator on an operand that stands at `inner`.
    pub(super) fn unary_of(&mut self, op: UnaryOperator, operand: Operand, inner: Span, span: Span) -> Option<Operand> {
        let (domain, takes) = types::unary_domain(op);
        match operand {
            Operand::Untyped(number) => match number.unary(op) {
                Folded::Value(number) => return Some(Operand::Untyped(number)),
                Folded::Mismatch => self.not_taken(unary_name(op), domain, number.describe(), inner),
                Folded::Overflow | Folded::Bool(_) => self.overflow(None, span),
            },
            Operand::Typed(operand) if !takes(operand.ty) => {
                self.not_taken(unary_name(op), domain, operand.ty.name(), inner);
            }
            Operand::Typed(operand) => {
                let ty = operand.ty;
                let Some(value) = operand.constant() else {
                    return Some(Operand::Typed(Expression { ty, kind: ExpressionKind::Unary(op, Box::new(operand)) }));
                };
                match constant::unary(op, value) {
                    Some(value) => return Some(Operand::Typed(constant(value))),
                    None => self.overflow(Some(ty), span),
                }
            }
        }
        None
    }

    fn binary(
        &mut self,
        op: BinaryOperator,
        left: &ladder::Expression,
        right: &ladder::Expression,
        span: Span,
    ) -> Option<Operand> {
        // Both first, so that errors in both are found.
        let (a, b) = (self.operand(left), self.operand(right));
        let of_time = match op {
            BinaryOperator::Multiply => Some(StandardFunction::MultiplyTime),
            BinaryOperator::Divide => Some(StandardFunction::DivideTime),
            _ => None,
        };
        let is_duration = |operand: &Option<Operand>| operand.as_ref().and_then(Operand::ty) == Some(Elementary::Time);
        if let Some(function) = of_time.filter(|_| is_duration(&a) && !is_duration(&b)) {
            return self.of_duration(function, (a?, left.span), (b?, right.span), span);
        }
        self.binary_of(op, (a?, left.span), (b?, right.span), span)
    }

    /// A duration times or divided by a number, as MUL_TIME and DIV_TIME have it.
    fn of_duration(
        &mut self,
        function: StandardFunction,
        duration: (Operand, Span),
        number: (Operand, Span),
        span: Span,
    ) -> Option<Operand> {
        let actuals = [duration, number].map(|(operand, span)| Actual { operand: Some(operand), span });
        let name = Name::new(function.name(), span);
        let (function, operands, ty) =
            self.typed_call(Function::Standard(function), &name, actuals.into(), Some(Elementary::Time))?;
        self.called(function, operands.into_iter().map(|(operand, _)| operand).collect(), ty, span)
    }

    /// An operator on two operands, each with its place.
    pub(super) fn binary_of(
        &mut self,
        op: BinaryOperator,
        (a, left): (Operand, Span),
        (b, right): (Operand, Span),
        span: Span,
    ) -> Option<Operand> {
        let (a, b) = match (a, b) {
            (Operand::Untyped(a), Operand::Untyped(b)) => return self.exact(op, a, b, right, span),
            (Operand::Typed(a), Operand::Untyped(b)) => {
                let ty = beside(b, a.ty);
                let (a, b) = (self.coerce(Operand::Typed(a), ty, left), self.number(b, ty, right));
                (a?, constant(b?))
            }
            (Operand::Untyped(a), Operand::Typed(b)) => {
                let ty = beside(a, b.ty);
                let (a, b) = (self.number(a, ty, left), self.coerce(Operand::Typed(b), ty, right));
                (constant(a?), b?)
            }
            (Operand::Typed(a), Operand::Typed(b)) => {
                let Some(ty) = types::common(a.ty, b.ty) else {
                    let message =
                        format!("{} takes operands of one type, and these are {} and {}", op.symbol(), a.ty, b.ty);
                    let hint = "only widening without loss is implied, and neither holds every value of the other";
                    self.report.push(Diagnostic::new(Code::TypeMismatch, span, message).hint(hint));
                    return None;
                };
                let a = self.coerce(Operand::Typed(a), ty, left);
                let b = self.coerce(Operand::Typed(b), ty, right);
                (a?, b?)
            }
        };
        self.typed_binary(op, a, b, right, span).map(Operand::Typed)
    }

    /// Two operands of one type.
    fn typed_binary(
        &mut self,
        op: BinaryOperator,
        a: Expression,
        b: Expression,
        right: Span,
        span: Span,
    ) -> Option<Expression> {
        let ty = a.ty;
        let (domain, takes) = types::binary_domain(op);
        if !takes(ty) {
            self.not_taken(op.symbol(), domain, ty.name(), span);
            return None;
        }
        let constants = a.constant().zip(b.constant());
        if b.constant().is_some_and(constant::is_zero) && !(ty.is_real() && constants.is_some()) {
            self.division_by_zero(op, ty.is_real(), right);
        }
        let Some((a, b)) = constants else {
            let ty = if op.is_comparison() { Elementary::Bool } else { ty };
            return Some(Expression { ty, kind: ExpressionKind::Binary(op, Box::new(a), Box::new(b)) });
        };
        match constant::binary(op, a, b) {
            Folded::Value(value) => Some(constant(value)),
            Folded::Bool(value) => Some(constant(Value::bool(value))),
            Folded::Overflow | Folded::Mismatch => {
                self.overflow(Some(ty), span);
                None
            }
        }
    }

    /// Two numbers without a type.
    fn exact(&mut self, op: BinaryOperator, a: Untyped, b: Untyped, right: Span, span: Span) -> Option<Operand> {
        let real = [a, b].iter().any(|number| matches!(number, Untyped::Real(_)));
        if b.is_zero() && !real {
            self.division_by_zero(op, false, right);
        }
        match a.binary(op, b) {
            Folded::Value(value) => Some(Operand::Untyped(value)),
            Folded::Bool(value) => Some(Operand::Typed(constant(Value::bool(value)))),
            Folded::Overflow => {
                self.overflow(None, span);
                None
            }
            Folded::Mismatch => {
                let found = if real { Untyped::Real(0.0) } else { Untyped::Bits(0) };
                self.not_taken(op.symbol(), types::binary_domain(op).0, found.describe(), span);
                None
            }
        }
    }

    pub(super) fn not_taken(&mut self, op: &str, domain: &str, found: &str, span: Span) {
        let message = format!("{op} works on {domain}, and this is {}", types::with_article(found));
        self.report.push(Diagnostic::new(Code::TypeMismatch, span, message));
    }

    pub(super) fn overflow(&mut self, ty: Option<Elementary>, span: Span) {
        self.report.push(match ty {
            Some(ty) => out_of_range(format!("the value of this constant is outside the range of {ty}"), ty, span),
            None => Diagnostic::new(Code::OutOfRange, span, "no type holds the value of this constant"),
        });
    }

    fn division_by_zero(&mut self, op: BinaryOperator, real: bool, span: Span) {
        if matches!(op, BinaryOperator::Divide | BinaryOperator::Modulo) {
            self.divided_by_zero(real, span);
        }
    }

    pub(super) fn divided_by_zero(&mut self, real: bool, span: Span) {
        let result = if real { "infinite or not a number" } else { "always 0" };
        let message = format!("what is divided by zero here is {result}");
        self.report.push(Diagnostic::new(Code::DivisionByZero, span, message));
    }
}

fn unary_name(op: UnaryOperator) -> &'static str {
    match op {
        UnaryOperator::Not => "NOT",
        UnaryOperator::Negate => "minus",
    }
}

/// The type of a number beside an operand of a type.
fn beside(number: Untyped, ty: Elementary) -> Elementary {
    match number {
        Untyped::Real(_) => types::real_beside(ty).unwrap_or(ty),
        Untyped::Integer(_) | Untyped::Bits(_) => ty,
    }
}

fn out_of_range(message: String, ty: Elementary, span: Span) -> Diagnostic {
    let problem = Diagnostic::new(Code::OutOfRange, span, message);
    match ty.range() {
        Some((least, greatest)) => problem.hint(format!("{ty} holds {least} to {greatest}")),
        None => problem,
    }
}
