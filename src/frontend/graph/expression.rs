//! IEC 61131-3 expressions as they stand in elements and attributes: operands of contacts, `inVariable`s, initial values.
//!
//! Every part gets one span, that of the element around it. Nothing here looks a name up.

use thin_vec::ThinVec;

use crate::elementary::Elementary;
use crate::frontend::text::literals;
use crate::ladder::{
    ArrayItem, BinaryOperator, Expression, ExpressionKind, FunctionArgument, Literal, MemberValue, Name, Reference,
    Root, Step, UnaryOperator,
};
use crate::source::Span;

/// How deep parentheses, indices and operators may nest.
const MOST_DEPTH: usize = 48;
/// How many operators and operands one expression may have.
const MOST_PARTS: usize = 2000;

/// Why an expression cannot be read.
#[derive(Debug, PartialEq, Eq)]
pub(in crate::frontend) enum Fault {
    /// It is none.
    Bad(String),
    /// It has something that Rung has not, of this kind.
    NotSupported(&'static str),
}

type Read<T> = Result<T, Fault>;

/// Reads an expression.
pub(in crate::frontend) fn expression(text: &str, span: Span) -> Read<Expression> {
    whole(text, span, |parser| parser.binary(0))
}

/// Reads an initial value: an expression, `[1, 2, 8(0)]`, or `(x := 1, y := 2)`.
pub(in crate::frontend) fn initial_value(text: &str, span: Span) -> Read<Expression> {
    whole(text, span, |parser| parser.value())
}

/// Reads a variable, a member, a bit or an address.
pub(in crate::frontend) fn reference(text: &str, span: Span) -> Read<Reference> {
    match expression(text, span)?.kind {
        ExpressionKind::Read(reference) => Ok(reference),
        _ => Err(Fault::Bad(format!("`{}` is no variable", clipped(text)))),
    }
}

/// Reads an address such as `%IX0.3`.
pub(in crate::frontend) fn address(text: &str, span: Span) -> Read<crate::ladder::Address> {
    if !text.starts_with('%') || text.len() < 3 || !text.is_ascii() {
        return Err(Fault::Bad(format!("`{}` is not an address", clipped(text))));
    }
    literals::address(text, span).map_err(|problem| Fault::Bad(problem.message))
}

/// A text short enough for a message.
pub(in crate::frontend) fn clipped(text: &str) -> String {
    match text.char_indices().nth(40) {
        Some((at, _)) => format!("{}…", &text[..at]),
        None => text.to_owned(),
    }
}

fn whole(text: &str, span: Span, read: impl FnOnce(&mut Parser<'_>) -> Read<Expression>) -> Read<Expression> {
    let text = text.trim();
    // Most are nothing but a name.
    if is_name(text) && !is_word(text) {
        let reference = Reference::of_name(Name::new(text, span));
        return Ok(Expression { kind: ExpressionKind::Read(reference), span });
    }
    let mut parser = Parser { text, at: 0, span, depth: 0, parts: 0 };
    let value = read(&mut parser)?;
    parser.blanks();
    if parser.at < text.len() {
        return Err(parser.bad());
    }
    Ok(value)
}

/// Whether a text is a name.
pub(in crate::frontend) fn is_name(text: &str) -> bool {
    text.starts_with(starts_name) && text.chars().all(continues_name)
}

fn starts_name(character: char) -> bool {
    character == '_' || character.is_alphabetic()
}

fn continues_name(character: char) -> bool {
    character == '_' || character.is_alphanumeric()
}

/// Whether a name means something else in an expression.
fn is_word(text: &str) -> bool {
    ["TRUE", "FALSE", "NOT", "AND", "OR", "XOR", "MOD"].iter().any(|word| text.eq_ignore_ascii_case(word))
}

struct Parser<'a> {
    text: &'a str,
    at: usize,
    span: Span,
    depth: usize,
    parts: usize,
}

impl<'a> Parser<'a> {
    fn rest(&self) -> &'a str {
        &self.text[self.at..]
    }

    fn bad(&self) -> Fault {
        Fault::Bad(format!("`{}` is no expression", clipped(self.text)))
    }

    fn blanks(&mut self) {
        loop {
            self.at = self.text.len() - self.rest().trim_start().len();
            match self.rest().strip_prefix("(*").map(|comment| comment.find("*)")) {
                Some(Some(end)) => self.at += end + 4,
                _ => return,
            }
        }
    }

    fn take(&mut self, sign: &str) -> bool {
        self.blanks();
        let found = self.rest().starts_with(sign);
        self.at += if found { sign.len() } else { 0 };
        found
    }

    fn need(&mut self, sign: &str) -> Read<()> {
        if self.take(sign) { Ok(()) } else { Err(self.bad()) }
    }

    /// The name that stands here, which is not taken.
    fn peek_name(&mut self) -> &'a str {
        self.blanks();
        let rest = self.rest();
        if !rest.starts_with(starts_name) {
            return "";
        }
        &rest[..rest.find(|c| !continues_name(c)).unwrap_or(rest.len())]
    }

    fn name(&mut self) -> Read<Name> {
        let name = self.peek_name();
        if name.is_empty() {
            return Err(self.bad());
        }
        self.at += name.len();
        Ok(Name::new(name, self.span))
    }

    fn make(&self, kind: ExpressionKind) -> Expression {
        Expression { kind, span: self.span }
    }

    fn nested<T>(&mut self, read: impl FnOnce(&mut Self) -> Read<T>) -> Read<T> {
        self.depth += 1;
        self.parts += 1;
        if self.depth > MOST_DEPTH || self.parts > MOST_PARTS {
            return Err(Fault::Bad("this expression is too long or nests too deeply".to_owned()));
        }
        let result = read(self);
        self.depth -= 1;
        result
    }

    fn operator(&mut self) -> Option<(BinaryOperator, usize)> {
        let word = self.peek_name();
        let rest = self.rest();
        let found = BinaryOperator::ALL
            .into_iter()
            .filter(|operator| match operator.symbol() {
                symbol if symbol.starts_with(starts_name) => word.eq_ignore_ascii_case(symbol),
                symbol => rest.starts_with(symbol),
            })
            .max_by_key(|operator| operator.symbol().len())
            .map(|operator| (operator, operator.symbol().len()));
        found.or_else(|| rest.starts_with('&').then_some((BinaryOperator::And, 1)))
    }

    fn binary(&mut self, least: u8) -> Read<Expression> {
        let mut left = self.nested(Self::unary)?;
        // A chain of operators is as deep as it is long.
        let before = self.depth;
        while let Some((operator, length)) = self.operator().filter(|(operator, _)| operator.precedence() > least) {
            self.at += length;
            let right = self.nested(|parser| parser.binary(operator.precedence()))?;
            self.depth += 1;
            left = self.make(ExpressionKind::Binary(operator, Box::new(left), Box::new(right)));
        }
        self.depth = before;
        Ok(left)
    }

    fn unary(&mut self) -> Read<Expression> {
        let operator = if self.peek_name().eq_ignore_ascii_case("NOT") {
            self.at += 3;
            UnaryOperator::Not
        } else if self.take("-") {
            UnaryOperator::Negate
        } else {
            self.take("+");
            return self.primary();
        };
        let operand = self.nested(Self::unary)?;
        Ok(self.make(ExpressionKind::Unary(operator, Box::new(operand))))
    }

    fn primary(&mut self) -> Read<Expression> {
        self.blanks();
        if self.take("(") {
            let inner = self.nested(|parser| parser.binary(0))?;
            self.need(")")?;
            return Ok(inner);
        }
        let rest = self.rest();
        match rest.chars().next() {
            Some('\'' | '"') => Err(Fault::NotSupported("string literal")),
            Some('%') => {
                let end =
                    rest[1..].find(|c: char| c != '.' && !c.is_ascii_alphanumeric()).map_or(rest.len(), |end| end + 1);
                let address = address(&rest[..end], self.span)?;
                self.at += end;
                let reference =
                    Reference { root: Root::Address(Box::new(address)), steps: ThinVec::new(), span: self.span };
                Ok(self.make(ExpressionKind::Read(reference)))
            }
            Some(first) if first.is_ascii_digit() => self.literal(),
            _ => self.named(),
        }
    }

    fn literal(&mut self) -> Read<Expression> {
        let rest = self.rest();
        let mut end = 0;
        let mut before = ' ';
        let real = |text: &str| text.contains('.') && !text.contains('#');
        for character in rest.chars() {
            // A sign belongs to an exponent or stands behind a type.
            let sign =
                matches!(character, '-' | '+') && (before == '#' || matches!(before, 'e' | 'E') && real(&rest[..end]));
            if !sign && !matches!(character, '.' | '#' | '_') && !character.is_alphanumeric() {
                break;
            }
            before = character;
            end += character.len_utf8();
        }
        let text = &rest[..end];
        self.at += end;
        match literals::literal(text, self.span) {
            Ok((false, literal)) => Ok(self.make(ExpressionKind::Literal(literal))),
            Ok((true, literal)) => {
                let magnitude = self.make(ExpressionKind::Literal(literal));
                Ok(self.make(ExpressionKind::Unary(UnaryOperator::Negate, Box::new(magnitude))))
            }
            Err(problem) => {
                let prefix = text.split_once('#').map(|(prefix, _)| prefix.to_ascii_uppercase());
                Err(match prefix.as_deref() {
                    Some("D" | "DATE" | "TOD" | "TIME_OF_DAY" | "DT" | "DATE_AND_TIME" | "LDATE" | "LTOD" | "LDT") => {
                        Fault::NotSupported("date or time of day")
                    }
                    Some("STRING" | "WSTRING") => Fault::NotSupported("string literal"),
                    _ => Fault::Bad(format!("`{}`: {}", clipped(text), problem.message)),
                })
            }
        }
    }

    fn named(&mut self) -> Read<Expression> {
        let start = self.at;
        let name = self.name()?;
        if self.rest().starts_with('#') {
            return self.prefixed(start, name);
        }
        for (word, value) in [("TRUE", true), ("FALSE", false)] {
            if name.text.eq_ignore_ascii_case(word) {
                return Ok(self.make(ExpressionKind::Literal(Literal::Bool(value))));
            }
        }
        if is_word(&name.text) {
            return Err(self.bad());
        }
        if self.take("(") {
            return self.call(name);
        }
        let mut steps = ThinVec::new();
        loop {
            if self.take("[") {
                let mut indices = vec![self.nested(|parser| parser.binary(0))?];
                while self.take(",") {
                    indices.push(self.nested(|parser| parser.binary(0))?);
                }
                self.need("]")?;
                steps.push(Step::Index(indices, self.span));
            } else if self.take(".") {
                self.take("%X");
                let digits = self.rest().find(|c: char| !c.is_ascii_digit()).unwrap_or(self.rest().len());
                if digits > 0 {
                    let bit = self.rest()[..digits].parse().map_err(|_| self.bad())?;
                    self.at += digits;
                    steps.push(Step::Bit(bit, self.span));
                } else {
                    steps.push(Step::Member(self.name()?));
                }
            } else {
                break;
            }
            self.parts += 1;
            if self.parts > MOST_PARTS {
                return Err(self.bad());
            }
        }
        let reference = Reference { root: Root::Name(name), steps, span: self.span };
        Ok(self.make(ExpressionKind::Read(reference)))
    }

    /// `INT#5`, `T#1s`, `colour#red`.
    fn prefixed(&mut self, start: usize, prefix: Name) -> Read<Expression> {
        let is_value = self.rest()[1..].starts_with(starts_name);
        let time = ["T", "TIME"].iter().any(|time| prefix.text.eq_ignore_ascii_case(time));
        if is_value && !time && Elementary::from_name(&prefix.text).is_none() {
            self.at += 1;
            let value = self.name()?;
            return Ok(self
                .make(ExpressionKind::Literal(Literal::Enumerated { ty: Box::new(prefix), value: Box::new(value) })));
        }
        self.at = start;
        self.literal()
    }

    fn call(&mut self, function: Name) -> Read<Expression> {
        let mut arguments = ThinVec::new();
        while !self.take(")") {
            if !arguments.is_empty() {
                self.need(",")?;
            }
            let before = self.at;
            let parameter = match self.name() {
                Ok(name) if self.take(":=") => Some(name),
                _ => {
                    self.at = before;
                    None
                }
            };
            let value = self.nested(|parser| parser.binary(0))?;
            arguments.push(FunctionArgument { parameter, value });
        }
        Ok(self.make(ExpressionKind::Call { function, arguments }))
    }

    fn value(&mut self) -> Read<Expression> {
        if self.take("[") {
            let mut items = Vec::new();
            while !self.take("]") {
                if !items.is_empty() {
                    self.need(",")?;
                }
                items.push(self.nested(Self::item)?);
            }
            return Ok(self.make(ExpressionKind::Array(items)));
        }
        self.blanks();
        let before = self.at;
        if self.take("(") && self.name().is_ok() && self.take(":=") {
            self.at = before + 1;
            let mut members = Vec::new();
            while !self.take(")") {
                if !members.is_empty() {
                    self.need(",")?;
                }
                let member = self.name()?;
                self.need(":=")?;
                members.push(MemberValue { member, value: self.nested(Self::value)? });
            }
            return Ok(self.make(ExpressionKind::Structure(members)));
        }
        self.at = before;
        self.binary(0)
    }

    fn item(&mut self) -> Read<ArrayItem> {
        let before = self.at;
        self.blanks();
        let digits = self.rest().find(|c: char| !c.is_ascii_digit()).unwrap_or(0);
        if digits > 0 {
            let repeat = self.literal();
            if let Ok(repeat) = repeat
                && self.take("(")
            {
                let value = if self.take(")") {
                    None
                } else {
                    let value = self.nested(Self::value)?;
                    self.need(")")?;
                    Some(value)
                };
                return Ok(ArrayItem { repeat: Some(repeat), value });
            }
            self.at = before;
        }
        Ok(ArrayItem { repeat: None, value: Some(self.value()?) })
    }
}
