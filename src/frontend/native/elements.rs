//! Elements of a branch: contacts, coils, blocks, braces and parallels.

use super::parser::Parser;
use crate::diagnostic::{Code, Diagnostic};
use crate::frontend::text::token::{Keyword, Kind, Token};
use crate::frontend::text::{Braces, Parse, Reader};
use crate::ladder::{
    Argument, BlockCall, CoilKind, ContactKind, Element, ElementKind, Expression, ExpressionKind, Literal, Name,
    Reference, Root, Step, Wire,
};

const COIL_HINT: &str = "a coil stands in parentheses: (name), or with S, R, P, N or / before the name";

const LONE: &str = "braces hold one expression, one assignment, or statements with a semicolon behind each";

/// Whether a keyword names a function too.
const fn is_function(keyword: Keyword) -> bool {
    matches!(keyword, Keyword::And | Keyword::Or | Keyword::Xor | Keyword::Not | Keyword::Mod)
}

/// Whether something of this name can be called: an instance does not end with a bit.
fn can_be_called(reference: &Reference) -> bool {
    matches!(reference.root, Root::Name(_)) && !matches!(reference.steps.last(), Some(Step::Bit(..)))
}

fn read(reference: Reference) -> Expression {
    Expression { span: reference.span, kind: ExpressionKind::Read(reference) }
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
            Kind::Keyword(keyword) if is_function(keyword) => self.function_box()?,
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
            _ => {
                let found = self.token;
                return self.no_element(found);
            }
        };
        Ok(ElementKind::Contact { kind, operand })
    }

    fn contact_operand(&mut self) -> Parse<Expression> {
        Ok(read(self.reference_in_circuit("a variable")?))
    }

    /// The complaint that no element starts with this token.
    fn no_element(&mut self, found: Token) -> Parse<ElementKind> {
        let problem = self.unexpected_token(found, "an element");
        let hint = match found.kind {
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
            Kind::Semicolon => "nothing ends with a semicolon here",
            Kind::Keyword(Keyword::If | Keyword::Case | Keyword::For | Keyword::Exit | Keyword::Return) => {
                "statements stand in braces: {IF a THEN b := 1; END_IF;}"
            }
            Kind::Text => "a rung has one title, before its circuit",
            Kind::Dot => "a member follows its variable: delay.Q",
            _ => "an element is a contact, a coil in parentheses, a block, braces, or a parallel in brackets",
        };
        self.give_up(problem.hint(hint))
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
            _ => Ok((CoilKind::Plain, self.reference_from(name)?)),
        }
    }

    fn braces(&mut self) -> Parse<ElementKind> {
        let open = self.token.span;
        self.advance();
        let (kind, hint) = match Reader::braces(self)? {
            Braces::Condition(condition) => (ElementKind::Condition(condition), LONE),
            Braces::Assignment { target, value } => (ElementKind::Assignment { target, value: Box::new(value) }, LONE),
            Braces::Statements(statements) => {
                self.anchor_here();
                (ElementKind::Statements(statements), "braces hold statements, each with a semicolon behind it")
            }
        };
        self.close(Kind::RightBrace, open, hint)?;
        Ok(kind)
    }

    /// `>> name`, `>> return`
    fn jump(&mut self) -> Parse<ElementKind> {
        self.advance();
        if self.take(Kind::Keyword(Keyword::Return)) {
            return Ok(ElementKind::Return);
        }
        Ok(ElementKind::Jump { target: self.name("the name of a rung, or `return`")? })
    }

    /// What starts with a name: a block if a `:` or a touching `(` follows, else a contact.
    fn contact_or_block(&mut self) -> Parse<ElementKind> {
        let reference = self.reference_in_circuit("a variable")?;
        match self.token.kind {
            Kind::Colon if reference.steps.is_empty() => {
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
                self.block(reference, Some(type_name))
            }
            Kind::LeftParenthesis if self.touching() && can_be_called(&reference) => self.block(reference, None),
            _ => Ok(ElementKind::Contact { kind: ContactKind::Open, operand: read(reference) }),
        }
    }

    /// A function that is named like an operator: `AND(IN1 := a, IN2 := b)`.
    fn function_box(&mut self) -> Parse<ElementKind> {
        let word = self.token;
        self.advance();
        if self.token.kind != Kind::LeftParenthesis || !self.touching() {
            return self.no_element(word);
        }
        let function = Name::new(self.source.slice(word.span), word.span);
        self.block(Reference::of_name(function), None)
    }

    fn block(&mut self, instance: Reference, type_name: Option<Name>) -> Parse<ElementKind> {
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
        let closed = self.end - 1;
        self.anchor(closed);
        Ok(ElementKind::Block(Box::new(BlockCall { instance, type_name, arguments, power_output })))
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
}
