//! Elements of a branch: contacts, coils, blocks, braces and parallels.

use super::parser::{Parse, Parser};
use super::token::{Keyword, Kind};
use crate::diagnostic::{Code, Diagnostic};
use crate::ladder::{
    Address, Area, Argument, BlockCall, CoilKind, ContactKind, Element, ElementKind, Expression, ExpressionKind,
    Literal, Name, Reference, Root, Width, Wire,
};
use crate::source::Span;

const COIL_HINT: &str = "a coil stands in parentheses: (name), or with S, R, P, N or / before the name";

/// What stands in for an address that cannot be read.
pub(super) fn placeholder_address(span: Span) -> Address {
    Address { area: Area::Memory, width: Width::Bit, numbers: vec![0], span }
}

impl Parser<'_> {
    /// One element; `None` if it is too deep and was skipped.
    pub(super) fn element(&mut self) -> Parse<Option<Element>> {
        let start = self.token.span.start;
        self.anchor(start);
        let kind = match self.token.kind {
            Kind::LeftBracket => match self.bracketed_circuit()? {
                Some(circuit) => ElementKind::Parallel(circuit),
                None => return Ok(None),
            },
            Kind::LeftParenthesis => self.coil()?,
            Kind::LeftBrace => self.braces()?,
            Kind::Jump => self.jump()?,
            Kind::Name | Kind::QuotedName => self.contact_or_block()?,
            _ => self.contact()?,
        };
        Ok(Some(Element { kind, span: self.since(start) }))
    }

    fn contact(&mut self) -> Parse<ElementKind> {
        let rising = self.take(Kind::Caret);
        let negated = self.take(Kind::Slash);
        let kind = match (rising, negated) {
            (false, false) => ContactKind::Open,
            (false, true) => ContactKind::Closed,
            (true, false) => ContactKind::Rising,
            (true, true) => ContactKind::Falling,
        };
        let span = self.token.span;
        let operand = match self.token.kind {
            Kind::Keyword(keyword @ (Keyword::True | Keyword::False)) => {
                self.advance();
                let value = Literal::Bool(keyword == Keyword::True);
                Expression { kind: ExpressionKind::Literal(value), span }
            }
            Kind::Name | Kind::QuotedName | Kind::Address => self.contact_operand()?,
            _ => return self.no_element(span),
        };
        Ok(ElementKind::Contact { kind, operand })
    }

    fn contact_operand(&mut self) -> Parse<Expression> {
        let reference = self.reference("a variable")?;
        self.no_index()?;
        Ok(Expression { span: reference.span, kind: ExpressionKind::Read(reference) })
    }

    /// `name[` will be an index one day, and must not be a contact and a parallel until then.
    fn no_index(&mut self) -> Parse<()> {
        if self.token.kind == Kind::LeftBracket && self.touching() {
            let problem = Diagnostic::new(Code::UnexpectedToken, self.token.span, "`[` touches the name before it");
            return self.give_up(problem.hint("put a space before the bracket of a parallel"));
        }
        Ok(())
    }

    fn no_element(&mut self, span: Span) -> Parse<ElementKind> {
        let problem = self.unexpected("an element");
        let hint = match self.token.kind {
            Kind::Assign => "an assignment stands in braces: {name := value}",
            Kind::Equal | Kind::NotEqual | Kind::Less | Kind::LessOrEqual | Kind::GreaterOrEqual => {
                "a comparison stands in braces: {a > b}"
            }
            Kind::Literal | Kind::Plus | Kind::Minus | Kind::Star | Kind::Keyword(Keyword::Mod) => {
                "a value or a formula stands in braces, or at the pin of a block"
            }
            Kind::Slash => "a comment starts with --",
            Kind::Keyword(Keyword::And) | Kind::Ampersand => "contacts in series stand side by side: a b",
            Kind::Keyword(Keyword::Or) => "contacts in parallel stand in brackets: [ a | b ]",
            Kind::Keyword(Keyword::Not) => "a closed contact is written /name",
            Kind::Keyword(Keyword::Xor) => "operators stand in braces: {a XOR b}",
            Kind::Text => "a rung has one title, before its circuit",
            Kind::Dot => "a member follows its variable: delay.Q",
            _ => "an element is a contact, a coil in parentheses, a block, braces, or a parallel in brackets",
        };
        self.give_up(Diagnostic { span, ..problem }.hint(hint))
    }

    fn coil(&mut self) -> Parse<ElementKind> {
        let open = self.token.span;
        self.advance();
        let (kind, target) = self.coil_inside()?;
        self.close(Kind::RightParenthesis, open, COIL_HINT)?;
        Ok(ElementKind::Coil { kind, target })
    }

    fn coil_inside(&mut self) -> Parse<(CoilKind, Reference)> {
        const EXPECTED: &str = "the coil's variable";
        if self.take(Kind::Slash) {
            return Ok((CoilKind::Negated, self.reference(EXPECTED)?));
        }
        if self.token.kind == Kind::Address {
            return Ok((CoilKind::Plain, self.reference(EXPECTED)?));
        }
        if matches!(self.token.kind, Kind::Star | Kind::Caret | Kind::LeftParenthesis) {
            let problem = self.unexpected(EXPECTED);
            let comment = self.token.kind == Kind::Star;
            return self.give_up(problem.hint(if comment { "a comment starts with --" } else { COIL_HINT }));
        }
        // Alone, such a letter is the name of a variable, and in back quotes always.
        let letter = match self.source.slice(self.token.span) {
            "S" | "s" => Some(CoilKind::Set),
            "R" | "r" => Some(CoilKind::Reset),
            "P" | "p" => Some(CoilKind::Rising),
            "N" | "n" => Some(CoilKind::Falling),
            _ => None,
        };
        let name = self.name(EXPECTED)?;
        match letter {
            Some(kind) if self.token.kind.is_name() || self.token.kind == Kind::Address => {
                Ok((kind, self.reference(EXPECTED)?))
            }
            _ => Ok((CoilKind::Plain, self.steps(name)?)),
        }
    }

    fn braces(&mut self) -> Parse<ElementKind> {
        let open = self.token.span;
        self.advance();
        let expression = self.expression()?;
        let kind = if self.token.kind == Kind::Assign {
            let ExpressionKind::Read(target) = expression.kind else {
                let problem =
                    Diagnostic::new(Code::UnexpectedToken, expression.span, "only a variable can be assigned to");
                return self.give_up(problem.hint("to compare, write ="));
            };
            self.advance();
            ElementKind::Assignment { target, value: self.expression()? }
        } else {
            ElementKind::Condition(expression)
        };
        self.close(Kind::RightBrace, open, "braces hold one expression or one assignment")?;
        Ok(kind)
    }

    /// `>> name`, `>> return`
    fn jump(&mut self) -> Parse<ElementKind> {
        self.advance();
        if self.at_word("return") {
            self.advance();
            return Ok(ElementKind::Return);
        }
        Ok(ElementKind::Jump { target: self.name("the name of a rung, or `return`")? })
    }

    /// What starts with a name: a block if a `:` or a touching `(` follows, else a contact.
    fn contact_or_block(&mut self) -> Parse<ElementKind> {
        let name = self.name("a variable")?;
        match self.token.kind {
            Kind::Colon => {
                self.advance();
                let type_name = self.name("the block's type")?;
                if self.token.kind != Kind::LeftParenthesis {
                    let problem = self.unexpected("`(`");
                    return self.give_up(problem.hint("a block is called with parentheses: t1:TON(PT := T#5s)"));
                }
                if !self.touching() {
                    // What was meant is plain, so that this is said and reading goes on.
                    let message = "the parenthesis of a block touches its type";
                    let problem = Diagnostic::new(Code::UnexpectedToken, self.token.span, message);
                    self.report(problem.hint("a parenthesis behind white space is a coil"));
                }
                self.block(name, Some(type_name))
            }
            Kind::LeftParenthesis if self.touching() => self.block(name, None),
            _ => {
                let reference = self.steps(name)?;
                self.no_index()?;
                let operand = Expression { span: reference.span, kind: ExpressionKind::Read(reference) };
                Ok(ElementKind::Contact { kind: ContactKind::Open, operand })
            }
        }
    }

    fn block(&mut self, instance: Name, type_name: Option<Name>) -> Parse<ElementKind> {
        let open = self.token.span;
        self.advance();
        let mut arguments = Vec::new();
        if self.token.kind != Kind::RightParenthesis {
            loop {
                if let Some(argument) = self.argument()? {
                    arguments.push(argument);
                }
                if !self.take(Kind::Comma) {
                    break;
                }
            }
        }
        self.close(Kind::RightParenthesis, open, "arguments are parted by commas")?;
        let power_output = if self.take(Kind::Dot) { Some(self.name("an output of the block")?) } else { None };
        self.anchor(self.end - 1);
        let instance = Reference::of_name(instance);
        Ok(ElementKind::Block(BlockCall { instance, type_name, arguments, power_output }))
    }

    /// One argument; `None` if its circuit is too deep and was skipped.
    fn argument(&mut self) -> Parse<Option<Argument>> {
        let start = self.token.span.start;
        self.anchor(start);
        let hint = "an argument names its pin: PT := T#5s, R := [ a b ], CV => count";
        if !self.token.kind.is_name() && !matches!(self.token.kind, Kind::Keyword(_)) {
            let problem = self.unexpected("the name of a pin").hint(hint);
            return self.give_up(problem);
        }
        let pin = self.name("the name of a pin")?;
        let wire = if self.take(Kind::Arrow) {
            Wire::Output(self.reference("the variable that takes the output")?)
        } else if self.take(Kind::Assign) {
            if self.token.kind == Kind::LeftBracket {
                match self.bracketed_circuit()? {
                    Some(circuit) => Wire::Circuit(circuit),
                    None => return Ok(None),
                }
            } else {
                Wire::Value(self.expression()?)
            }
        } else {
            let problem = self.unexpected("`:=` or `=>`").hint(hint);
            return self.give_up(problem);
        };
        Ok(Some(Argument { pin, wire, span: self.since(start) }))
    }

    /// A name or an address, with its members and bits.
    pub(super) fn reference(&mut self, expected: &str) -> Parse<Reference> {
        if self.token.kind == Kind::Address {
            let address = self.address();
            let start = address.span;
            return self.steps_from(Root::Address(address), start);
        }
        let name = self.name(expected)?;
        self.steps(name)
    }

    fn steps(&mut self, name: Name) -> Parse<Reference> {
        let start = name.span;
        self.steps_from(Root::Name(name), start)
    }
}
