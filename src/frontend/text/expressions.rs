//! Expressions in IEC 61131-3 syntax, and the steps of a reference.

use super::MAXIMUM_DEPTH;
use super::literals;
use super::parser::{Parse, Parser};
use super::token::{Keyword, Kind};
use crate::diagnostic::{Code, Diagnostic};
use crate::ladder::{
    BinaryOperator, Expression, ExpressionKind, FunctionArgument, Literal, Name, Reference, Root, Step, UnaryOperator,
};
use crate::source::Span;

/// An expression with the height of its tree, which is bounded as the nesting is: a long sum is as high as it is
/// long.
struct Tree {
    expression: Expression,
    height: usize,
}

const fn operator(kind: Kind) -> Option<BinaryOperator> {
    Some(match kind {
        Kind::Keyword(Keyword::Or) => BinaryOperator::Or,
        Kind::Keyword(Keyword::Xor) => BinaryOperator::Xor,
        Kind::Keyword(Keyword::And) | Kind::Ampersand => BinaryOperator::And,
        Kind::Equal => BinaryOperator::Equal,
        Kind::NotEqual => BinaryOperator::NotEqual,
        Kind::Less => BinaryOperator::Less,
        Kind::LessOrEqual => BinaryOperator::LessOrEqual,
        Kind::Greater => BinaryOperator::Greater,
        Kind::GreaterOrEqual => BinaryOperator::GreaterOrEqual,
        Kind::Plus => BinaryOperator::Add,
        Kind::Minus => BinaryOperator::Subtract,
        Kind::Star => BinaryOperator::Multiply,
        Kind::Slash => BinaryOperator::Divide,
        Kind::Keyword(Keyword::Mod) => BinaryOperator::Modulo,
        _ => return None,
    })
}

impl Parser<'_> {
    pub(super) fn expression(&mut self) -> Parse<Expression> {
        Ok(self.tree()?.expression)
    }

    /// Operators wait on a stack of their own until a weaker one comes, so that only parentheses recurse.
    fn tree(&mut self) -> Parse<Tree> {
        let first = self.operand()?;
        if operator(self.token.kind).is_none() {
            return Ok(first);
        }
        let mut waiting: Vec<(Tree, BinaryOperator)> = Vec::new();
        let mut last = first;
        while let Some(next) = operator(self.token.kind) {
            self.advance();
            last = self.combine(&mut waiting, last, next.precedence());
            waiting.push((last, next));
            last = self.operand()?;
        }
        Ok(self.combine(&mut waiting, last, 0))
    }

    /// Applies the waiting operators that bind at least as tightly as `precedence`.
    fn combine(&mut self, waiting: &mut Vec<(Tree, BinaryOperator)>, last: Tree, precedence: u8) -> Tree {
        let mut right = last;
        while let Some((left, operator)) = waiting.pop_if(|(_, operator)| operator.precedence() >= precedence) {
            let span = left.expression.span.to(right.expression.span);
            let height = 1 + left.height.max(right.height);
            right = if height > MAXIMUM_DEPTH {
                self.report_too_deep(span);
                left
            } else {
                let operands = (Box::new(left.expression), Box::new(right.expression));
                let kind = ExpressionKind::Binary(operator, operands.0, operands.1);
                Tree { expression: Expression { kind, span }, height }
            };
        }
        right
    }

    /// Signs and NOTs, and what they stand before.
    fn operand(&mut self) -> Parse<Tree> {
        let mut operators = Vec::new();
        loop {
            let operator = match self.token.kind {
                Kind::Keyword(Keyword::Not) => UnaryOperator::Not,
                Kind::Minus => UnaryOperator::Negate,
                _ => break,
            };
            // One too many is enough to know that there are too many.
            if operators.len() <= MAXIMUM_DEPTH {
                operators.push((operator, self.token.span));
            }
            self.advance();
        }
        let mut tree = self.primary()?;
        if tree.height + operators.len() > MAXIMUM_DEPTH {
            self.report_too_deep(tree.expression.span);
            return Ok(tree);
        }
        for (operator, span) in operators.into_iter().rev() {
            let span = span.to(tree.expression.span);
            let kind = ExpressionKind::Unary(operator, Box::new(tree.expression));
            tree = Tree { expression: Expression { kind, span }, height: tree.height + 1 };
        }
        Ok(tree)
    }

    fn primary(&mut self) -> Parse<Tree> {
        let span = self.token.span;
        let (kind, height) = match self.token.kind {
            Kind::LeftParenthesis => {
                if !self.enter()? {
                    return Ok(Tree { expression: literal(Literal::Bool(false), self.since(span.start)), height: 1 });
                }
                let mut tree = self.tree()?;
                self.close(Kind::RightParenthesis, span, "")?;
                self.leave();
                tree.expression.span = self.since(span.start);
                return Ok(tree);
            }
            Kind::Keyword(keyword @ (Keyword::True | Keyword::False)) => {
                self.advance();
                (ExpressionKind::Literal(Literal::Bool(keyword == Keyword::True)), 1)
            }
            Kind::Literal => self.literal(),
            Kind::Name | Kind::QuotedName | Kind::Address => {
                let reference = self.reference("a value")?;
                match self.token.kind {
                    Kind::LeftParenthesis if reference.steps.is_empty() => match reference.root {
                        Root::Name(function) => return self.call(function),
                        Root::Address(_) => (ExpressionKind::Read(reference), 1),
                    },
                    Kind::LeftBracket if self.touching() => {
                        let message = "arrays are kept for a later version of the language";
                        return self.give_up(Diagnostic::new(Code::UnexpectedToken, self.token.span, message));
                    }
                    _ => (ExpressionKind::Read(reference), 1),
                }
            }
            Kind::Keyword(Keyword::And | Keyword::Or | Keyword::Xor | Keyword::Mod) => {
                let function = Name::new(self.source.slice(span), span);
                self.advance();
                if self.token.kind == Kind::LeftParenthesis {
                    return self.call(function);
                }
                let message = format!("`{}` stands between two values, or before both in parentheses", function.text);
                return self.give_up(Diagnostic::new(Code::UnexpectedToken, span, message));
            }
            _ => {
                let problem = self.unexpected("a value");
                return self.give_up(match self.token.kind {
                    Kind::Text => problem.hint("texts are titles of rungs, not values"),
                    Kind::Equal | Kind::Arrow => problem.hint("the operators are < <= = <> >= >"),
                    Kind::LeftBracket => problem.hint("circuits stand at the pins of blocks, not in expressions"),
                    _ => problem,
                });
            }
        };
        Ok(Tree { expression: Expression { kind, span: self.since(span.start) }, height })
    }

    /// The arguments of a function, from the opening parenthesis on.
    fn call(&mut self, function: Name) -> Parse<Tree> {
        let (start, open) = (function.span.start, self.token.span);
        if !self.enter()? {
            return Ok(Tree { expression: literal(Literal::Bool(false), self.since(start)), height: 1 });
        }
        let mut arguments = Vec::new();
        let mut height = 0;
        if self.token.kind != Kind::RightParenthesis {
            loop {
                let (argument, argument_height) = self.function_argument()?;
                height = height.max(argument_height);
                arguments.push(argument);
                if !self.take(Kind::Comma) {
                    break;
                }
            }
        }
        self.close(Kind::RightParenthesis, open, "arguments are parted by commas")?;
        self.leave();
        let span = self.since(start);
        if height >= MAXIMUM_DEPTH {
            self.report_too_deep(span);
            return Ok(Tree { expression: literal(Literal::Bool(false), span), height: 1 });
        }
        let kind = ExpressionKind::Call { function, arguments };
        Ok(Tree { expression: Expression { kind, span }, height: height + 1 })
    }

    /// One argument and its height.
    fn function_argument(&mut self) -> Parse<(FunctionArgument, usize)> {
        let Tree { expression, height } = self.tree()?;
        if self.token.kind != Kind::Assign {
            return Ok((FunctionArgument { parameter: None, value: expression }, height));
        }
        match expression.kind {
            ExpressionKind::Read(Reference { root: Root::Name(parameter), steps, .. }) if steps.is_empty() => {
                self.advance();
                let Tree { expression: value, height } = self.tree()?;
                Ok((FunctionArgument { parameter: Some(parameter), value }, height))
            }
            _ => {
                let message = "the name of a parameter stands before `:=`";
                self.give_up(Diagnostic::new(Code::UnexpectedToken, expression.span, message))
            }
        }
    }

    /// The literal that is the current token. One that cannot be read is reported, and zero put in its place.
    fn literal(&mut self) -> (ExpressionKind, usize) {
        let span = self.token.span;
        let (negative, value) = literals::literal(self.source.slice(span)).unwrap_or_else(|problem| {
            self.report_literal(Code::BadLiteral, span, problem);
            (false, Literal::Integer { value: 0, base: 10, ty: None })
        });
        self.advance();
        if negative {
            (ExpressionKind::Unary(UnaryOperator::Negate, Box::new(literal(value, span))), 2)
        } else {
            (ExpressionKind::Literal(value), 1)
        }
    }

    /// The members and bits behind what a reference starts with.
    pub(super) fn steps_from(&mut self, root: Root, start: Span) -> Parse<Reference> {
        let mut steps = Vec::new();
        while self.take(Kind::Dot) {
            let span = self.token.span;
            if self.token.kind == Kind::Literal {
                let bit = self.source.slice(span).parse::<u8>().unwrap_or_else(|_| {
                    let message = "the number of a bit is at most 63";
                    self.report(Diagnostic::new(Code::BadLiteral, span, message));
                    0
                });
                steps.push(Step::Bit(bit, span));
                self.advance();
            } else {
                steps.push(Step::Member(self.name("a member or the number of a bit")?));
            }
        }
        Ok(Reference { root, steps, span: self.since(start.start) })
    }
}

fn literal(value: Literal, span: Span) -> Expression {
    Expression { kind: ExpressionKind::Literal(value), span }
}
