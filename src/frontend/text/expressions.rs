//! Expressions in IEC 61131-3 syntax, references and initial values.

use thin_vec::ThinVec;

use super::reader::{Parse, Reader};
use super::token::{Keyword, Kind};
use super::{MAXIMUM_DEPTH, literals};
use crate::diagnostic::{Code, Diagnostic};
use crate::ladder::{
    ArrayItem, BinaryOperator, Expression, ExpressionKind, FunctionArgument, Literal, MemberValue, Name, Reference,
    Root, Step, UnaryOperator,
};
use crate::source::Span;

/// An expression with the height of its tree, which is bounded as the nesting is: a long sum is as high as it is
/// long.
pub(super) struct Tree {
    pub(super) expression: Expression,
    pub(super) height: usize,
}

/// A reference with the height of its indices.
pub(super) struct Path {
    pub(super) reference: Reference,
    pub(super) height: usize,
}

impl Path {
    /// What it reads.
    pub(super) fn read(self) -> Tree {
        let expression = Expression { span: self.reference.span, kind: ExpressionKind::Read(self.reference) };
        Tree { expression, height: self.height + 1 }
    }
}

impl Tree {
    /// What stands in for an expression that cannot be kept.
    fn placeholder(span: Span) -> Self {
        Self { expression: literal(Literal::Bool(false), span), height: 1 }
    }

    /// The name, if it is nothing more.
    pub(super) fn as_name(&self) -> Option<&Name> {
        match &self.expression.kind {
            ExpressionKind::Read(reference) => reference.as_name(),
            _ => None,
        }
    }
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

impl Reader<'_> {
    /// An expression.
    pub(crate) fn expression(&mut self) -> Parse<Expression> {
        Ok(self.tree()?.expression)
    }

    pub(super) fn tree(&mut self) -> Parse<Tree> {
        let first = self.operand()?;
        self.tree_from(first)
    }

    /// An expression of which the first operand was read. Operators wait on a stack of their own until a weaker one comes, so
    /// that only parentheses recurse.
    pub(super) fn tree_from(&mut self, first: Tree) -> Parse<Tree> {
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
    pub(super) fn operand(&mut self) -> Parse<Tree> {
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
                    return Ok(Tree::placeholder(self.since(span.start)));
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
                let path = self.path("a value")?;
                return match path.reference.as_name() {
                    Some(function) if self.token.kind == Kind::LeftParenthesis => {
                        let function = function.clone();
                        self.call(function)
                    }
                    _ => Ok(path.read()),
                };
            }
            Kind::Keyword(Keyword::And | Keyword::Or | Keyword::Xor | Keyword::Mod) => {
                let function = Name::new(self.source.slice(span), span);
                self.advance();
                if self.token.kind == Kind::LeftParenthesis {
                    return self.call(function);
                }
                return self.misplaced_operator(span);
            }
            _ => {
                let problem = self.unexpected("a value");
                return self.give_up(match self.token.kind {
                    Kind::Text => problem.hint("texts are titles of rungs, not values"),
                    Kind::Equal | Kind::Arrow => problem.hint("the operators are < <= = <> >= >"),
                    Kind::LeftBracket => problem
                        .hint("circuits stand at the pins of blocks, and values of arrays behind `:=` in declarations"),
                    Kind::Star => problem.hint("a power is written EXPT(a, b)"),
                    _ => problem,
                });
            }
        };
        Ok(Tree { expression: Expression { kind, span: self.since(span.start) }, height })
    }

    pub(super) fn misplaced_operator<T>(&mut self, span: Span) -> Parse<T> {
        let word = self.source.slice(span);
        let message = format!("`{word}` stands between two values, or before both in parentheses");
        self.give_up(Diagnostic::new(Code::UnexpectedToken, span, message))
    }

    /// The arguments of a function, from the opening parenthesis on.
    fn call(&mut self, function: Name) -> Parse<Tree> {
        let (start, open) = (function.span.start, self.token.span);
        if !self.enter()? {
            return Ok(Tree::placeholder(self.since(start)));
        }
        let mut arguments = ThinVec::new();
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
        Ok(self.around(height, ExpressionKind::Call { function, arguments }, start))
    }

    /// An expression around others, the highest of which is so high.
    pub(super) fn around(&mut self, height: usize, kind: ExpressionKind, start: u32) -> Tree {
        let span = self.since(start);
        if height >= MAXIMUM_DEPTH {
            self.report_too_deep(span);
            return Tree::placeholder(span);
        }
        Tree { expression: Expression { kind, span }, height: height + 1 }
    }

    /// One argument and its height.
    fn function_argument(&mut self) -> Parse<(FunctionArgument, usize)> {
        let tree = self.tree()?;
        if self.token.kind == Kind::Arrow {
            let problem = self.unexpected("`,` or `)`");
            return self.give_up(problem.hint("within an expression a call has no outputs beside its result"));
        }
        if self.token.kind != Kind::Assign {
            return Ok((FunctionArgument { parameter: None, value: tree.expression }, tree.height));
        }
        let Some(parameter) = tree.as_name().cloned() else {
            let message = "the name of a parameter stands before `:=`";
            return self.give_up(Diagnostic::new(Code::UnexpectedToken, tree.expression.span, message));
        };
        self.advance();
        let Tree { expression: value, height } = self.tree()?;
        Ok((FunctionArgument { parameter: Some(parameter), value }, height))
    }

    /// The literal that is the current token. One that cannot be read is reported, and zero put in its place.
    fn literal(&mut self) -> (ExpressionKind, usize) {
        let span = self.token.span;
        let (negative, value) = literals::literal(self.source.slice(span), span).unwrap_or_else(|problem| {
            self.report_literal(Code::BadLiteral, span, problem);
            (false, Literal::Integer { value: 0.into(), base: 10, ty: None })
        });
        self.advance();
        if negative {
            (ExpressionKind::Unary(UnaryOperator::Negate, Box::new(literal(value, span))), 2)
        } else {
            (ExpressionKind::Literal(value), 1)
        }
    }

    /// A name or an address, with its members, bits and indices.
    pub(crate) fn reference(&mut self, expected: &str) -> Parse<Reference> {
        Ok(self.path(expected)?.reference)
    }

    pub(super) fn path(&mut self, expected: &str) -> Parse<Path> {
        let start = self.token.span.start;
        let root = self.root(expected)?;
        self.steps_from(root, start, false)
    }

    fn root(&mut self, expected: &str) -> Parse<Root> {
        Ok(match self.token.kind {
            Kind::Address => Root::Address(Box::new(self.address())),
            _ => Root::Name(self.name(expected)?),
        })
    }

    /// A name or an address in a circuit: a bracket that does not touch it is a parallel circuit.
    pub(crate) fn reference_in_circuit(&mut self, expected: &str) -> Parse<Reference> {
        let start = self.token.span.start;
        let root = self.root(expected)?;
        Ok(self.steps_from(root, start, true)?.reference)
    }

    /// A reference of which the name was read.
    pub(crate) fn reference_from(&mut self, name: Name) -> Parse<Reference> {
        let start = name.span.start;
        Ok(self.steps_from(Root::Name(name), start, false)?.reference)
    }

    /// The members, bits and indices behind what a reference starts with.
    fn steps_from(&mut self, root: Root, start: u32, in_circuit: bool) -> Parse<Path> {
        let mut steps = ThinVec::new();
        let mut highest = 0;
        loop {
            let open = self.token.span;
            if self.token.kind == Kind::LeftBracket && (self.touching() || !in_circuit) {
                let (indices, height) = self.indices()?;
                highest = highest.max(height);
                steps.push(Step::Index(indices, self.since(open.start)));
            } else if self.take(Kind::Dot) {
                steps.push(self.member()?);
            } else {
                break;
            }
        }
        let span = self.since(start);
        if highest >= MAXIMUM_DEPTH {
            self.report_too_deep(span);
            steps.clear();
            highest = 0;
        }
        Ok(Path { reference: Reference { root, steps, span }, height: highest })
    }

    /// What stands behind a dot.
    fn member(&mut self) -> Parse<Step> {
        let span = self.token.span;
        if self.token.kind != Kind::Literal {
            return Ok(Step::Member(self.name("a member or the number of a bit")?));
        }
        let bit = self.source.slice(span).parse::<u8>().unwrap_or_else(|_| {
            self.report(Diagnostic::new(Code::BadLiteral, span, "the number of a bit is at most 63"));
            0
        });
        self.advance();
        Ok(Step::Bit(bit, span))
    }

    /// `[i, 2]`, and the height of the highest.
    fn indices(&mut self) -> Parse<(Vec<Expression>, usize)> {
        let open = self.token.span;
        let mut indices = Vec::new();
        let mut height = 0;
        if !self.enter()? {
            return Ok((indices, height));
        }
        loop {
            let index = self.tree()?;
            height = height.max(index.height);
            indices.push(index.expression);
            if !self.take(Kind::Comma) {
                break;
            }
        }
        self.close(Kind::RightBracket, open, "indices are parted by commas")?;
        self.leave();
        Ok((indices, height))
    }

    /// What a variable starts with: an expression, `[1, 2, 8(0)]` or `(x := 1, y := 2)`.
    pub(crate) fn initial_value(&mut self) -> Parse<Expression> {
        Ok(self.initial_tree()?.expression)
    }

    fn initial_tree(&mut self) -> Parse<Tree> {
        match self.token.kind {
            Kind::LeftBracket => self.array(),
            Kind::LeftParenthesis => self.structure_or_parenthesis(),
            _ => self.tree(),
        }
    }

    fn array(&mut self) -> Parse<Tree> {
        let open = self.token.span;
        if !self.enter()? {
            return Ok(Tree::placeholder(self.since(open.start)));
        }
        let mut items = Vec::new();
        let mut highest = 0;
        while items.is_empty() || self.take(Kind::Comma) {
            if items.is_empty() && self.token.kind == Kind::RightBracket {
                break;
            }
            let first = self.initial_tree()?;
            highest = highest.max(first.height);
            let repeated = self.token.kind == Kind::LeftParenthesis;
            items.push(if repeated {
                let (value, height) = self.repeated()?;
                highest = highest.max(height);
                ArrayItem { repeat: Some(first.expression), value }
            } else {
                ArrayItem { repeat: None, value: Some(first.expression) }
            });
        }
        self.close(Kind::RightBracket, open, "values are parted by commas")?;
        self.leave();
        Ok(self.around(highest, ExpressionKind::Array(items), open.start))
    }

    /// The value in `8(0)`, from the parenthesis on, and its height; there may be none.
    fn repeated(&mut self) -> Parse<(Option<Expression>, usize)> {
        let open = self.token.span;
        if !self.enter()? {
            return Ok((None, 0));
        }
        let value = if self.token.kind == Kind::RightParenthesis { None } else { Some(self.initial_tree()?) };
        self.close(Kind::RightParenthesis, open, "how many stands before the parenthesis, one value in it: 8(0)")?;
        self.leave();
        let height = value.as_ref().map_or(0, |tree| tree.height);
        Ok((value.map(|tree| tree.expression), height))
    }

    fn structure_or_parenthesis(&mut self) -> Parse<Tree> {
        let open = self.token.span;
        if !self.enter()? {
            return Ok(Tree::placeholder(self.since(open.start)));
        }
        let mut first = self.tree()?;
        let Some(mut member) = first.as_name().filter(|_| self.token.kind == Kind::Assign).cloned() else {
            self.close(Kind::RightParenthesis, open, "")?;
            self.leave();
            first.expression.span = self.since(open.start);
            return self.tree_from(first);
        };
        let mut members = Vec::new();
        let mut highest = 0;
        loop {
            if !self.take(Kind::Assign) {
                let problem = self.unexpected("`:=`");
                return self.give_up(problem.hint("a value of a structure names its members: (x := 1, y := 2)"));
            }
            let Tree { expression: value, height } = self.initial_tree()?;
            highest = highest.max(height);
            members.push(MemberValue { member, value });
            if !self.take(Kind::Comma) {
                break;
            }
            member = self.name("the name of a member")?;
        }
        self.close(Kind::RightParenthesis, open, "members are parted by commas")?;
        self.leave();
        Ok(self.around(highest, ExpressionKind::Structure(members), open.start))
    }
}

fn literal(value: Literal, span: Span) -> Expression {
    Expression { kind: ExpressionKind::Literal(value), span }
}
