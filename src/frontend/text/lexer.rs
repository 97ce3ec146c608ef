//! From text to tokens, one at a time as the parser asks, so that a large file costs no more than its program.
//! It must never fail: what has no meaning is a token of its own.

use super::token::{Dialect, Kind, Token, continues_name, keyword, starts_name};
use crate::source::Span;

/// Reads tokens from a text.
pub(crate) struct Lexer<'a> {
    text: &'a str,
    dialect: Dialect,
    at: usize,
    /// Nothing but white space was read since the last line break.
    first_on_line: bool,
    /// The last token was a `.`, so that digits are a bit's number and never the start of `3.4`.
    after_dot: bool,
}

impl<'a> Lexer<'a> {
    /// A lexer at the start of a text.
    pub(crate) fn new(text: &'a str, dialect: Dialect) -> Self {
        Self { text, dialect, at: 0, first_on_line: true, after_dot: false }
    }

    /// Leaves the rest unread: every later token is the end.
    pub(crate) fn stop(&mut self) {
        self.at = self.text.len();
    }

    /// The next token; at the end of the text, the end again and again.
    pub(crate) fn token(&mut self) -> Token {
        self.skip_blanks();
        let start = self.at;
        let first_on_line = std::mem::replace(&mut self.first_on_line, false);
        let kind = self.kind();
        self.after_dot = kind == Kind::Dot;
        Token { kind, span: Span::new(start, self.at), first_on_line }
    }

    fn rest(&self) -> &'a str {
        &self.text[self.at..]
    }

    /// The byte some way ahead; 0, which no token starts with, past the end.
    fn byte(&self, ahead: usize) -> u8 {
        self.text.as_bytes().get(self.at + ahead).copied().unwrap_or(0)
    }

    fn skip_blanks(&mut self) {
        loop {
            match self.byte(0) {
                b'\n' => {
                    self.first_on_line = true;
                    self.at += 1;
                }
                b' ' | b'\t' | b'\r' => self.at += 1,
                byte if !byte.is_ascii() => match self.rest().chars().next() {
                    Some(blank) if blank.is_whitespace() => self.at += blank.len_utf8(),
                    _ => return,
                },
                _ => return,
            }
        }
    }

    fn kind(&mut self) -> Kind {
        if self.at == self.text.len() {
            return Kind::End;
        }
        if let Some(comment) = self.comment() {
            return comment;
        }
        let (length, kind) = match (self.byte(0), self.byte(1)) {
            (b'`', _) => return self.quoted_name(),
            (b'\'', _) if self.dialect == Dialect::StructuredText => {
                return self.quoted(b'\'', Kind::Text, Kind::UnclosedText);
            }
            (b'"', _) => return self.quoted(b'"', Kind::Text, Kind::UnclosedText),
            (b'%', _) => return self.address(),
            (b'0'..=b'9', _) => return self.number(),
            (b':', b'=') => (2, Kind::Assign),
            (b'=', b'>') => (2, Kind::Arrow),
            (b'<', b'>') => (2, Kind::NotEqual),
            (b'<', b'=') => (2, Kind::LessOrEqual),
            (b'>', b'=') => (2, Kind::GreaterOrEqual),
            (b'>', b'>') => (2, Kind::Jump),
            (b'.', b'.') => (2, Kind::Range),
            (b';', _) => (1, Kind::Semicolon),
            (b'(', _) => (1, Kind::LeftParenthesis),
            (b')', _) => (1, Kind::RightParenthesis),
            (b'[', _) => (1, Kind::LeftBracket),
            (b']', _) => (1, Kind::RightBracket),
            (b'{', _) => (1, Kind::LeftBrace),
            (b'}', _) => (1, Kind::RightBrace),
            (b'|', _) => (1, Kind::Bar),
            (b'/', _) => (1, Kind::Slash),
            (b'^', _) => (1, Kind::Caret),
            (b':', _) => (1, Kind::Colon),
            (b',', _) => (1, Kind::Comma),
            (b'.', _) => (1, Kind::Dot),
            (b'=', _) => (1, Kind::Equal),
            (b'<', _) => (1, Kind::Less),
            (b'>', _) => (1, Kind::Greater),
            (b'+', _) => (1, Kind::Plus),
            (b'-', _) => (1, Kind::Minus),
            (b'*', _) => (1, Kind::Star),
            (b'&', _) => (1, Kind::Ampersand),
            _ => return self.word(),
        };
        self.at += length;
        kind
    }

    /// A comment or pragma, if one starts here. Comments in `(* *)` nest, as they may since the third edition of IEC 61131-3.
    fn comment(&mut self) -> Option<Kind> {
        let (first, second) = (self.byte(0), self.byte(1));
        match self.dialect {
            Dialect::Native if (first, second) == (b'-', b'-') => self.at = self.line_end(),
            Dialect::StructuredText => match (first, second) {
                (b'/', b'/') => self.at = self.line_end(),
                (b'(', b'*') => return Some(self.long_comment(Some("(*"), "*)")),
                (b'/', b'*') => return Some(self.long_comment(None, "*/")),
                (b'{', _) => return Some(self.long_comment(None, "}")),
                _ => return None,
            },
            Dialect::Native => return None,
        }
        Some(Kind::Comment)
    }

    fn long_comment(&mut self, opening: Option<&str>, closing: &str) -> Kind {
        let bytes = self.text.as_bytes();
        let stands = |at: usize, sign: &str| bytes.get(at..).is_some_and(|rest| rest.starts_with(sign.as_bytes()));
        let mut at = self.at + opening.map_or(1, str::len);
        let mut open = 1usize;
        while at < bytes.len() {
            if stands(at, closing) {
                at += closing.len();
                open -= 1;
                if open == 0 {
                    self.at = at;
                    return Kind::Comment;
                }
            } else if let Some(opening) = opening.filter(|opening| stands(at, opening)) {
                at += opening.len();
                open += 1;
            } else {
                at += 1;
            }
        }
        self.at = bytes.len();
        Kind::UnclosedComment
    }

    fn line_end(&self) -> usize {
        self.rest().find('\n').map_or(self.text.len(), |length| self.at + length)
    }

    /// A name in back quotes; touching a `#`, it is the type of a literal.
    fn quoted_name(&mut self) -> Kind {
        let kind = self.quoted(b'`', Kind::QuotedName, Kind::UnclosedName);
        let starts_value = self.text[self.at..].strip_prefix('#').is_some_and(|value| value.starts_with(starts_value));
        if kind == Kind::QuotedName && starts_value { self.after_type() } else { kind }
    }

    /// What stands behind the type of a literal, from the `#` on.
    fn after_type(&mut self) -> Kind {
        self.at += 1;
        let rest = self.rest();
        if rest.starts_with('`') {
            self.quoted(b'`', Kind::Literal, Kind::UnclosedName);
            return Kind::Literal;
        }
        if matches!(self.byte(0), b'+' | b'-') && self.byte(1).is_ascii_digit() {
            self.at += 1;
        } else if rest.starts_with(starts_name) {
            self.at += rest.find(|character| !continues_name(character)).unwrap_or(rest.len());
            return Kind::Literal;
        }
        self.number()
    }

    /// A quoted token. One that does not close ends with its line. In a title `$` takes the next character's
    /// meaning away.
    fn quoted(&mut self, quote: u8, closed: Kind, unclosed: Kind) -> Kind {
        let mut at = self.at + 1;
        let bytes = self.text.as_bytes();
        while let Some(&byte) = bytes.get(at) {
            match byte {
                b'\n' => break,
                b'$' if quote != b'`' && bytes.get(at + 1).is_some_and(|next| *next == quote || *next == b'$') => {
                    at += 1
                }
                _ if byte == quote => {
                    self.at = at + 1;
                    return closed;
                }
                _ => {}
            }
            at += 1;
        }
        self.at = at;
        unclosed
    }

    fn address(&mut self) -> Kind {
        self.at += 1;
        self.skip_alphanumeric();
        while self.byte(0) == b'.' && self.byte(1).is_ascii_digit() {
            self.at += 1;
            self.skip_alphanumeric();
        }
        Kind::Address
    }

    fn skip_alphanumeric(&mut self) {
        while self.byte(0).is_ascii_alphanumeric() || self.byte(0) == b'_' {
            self.at += 1;
        }
    }

    /// Whatever looks like a number, units and bases included; `literals` says what it is.
    fn number(&mut self) -> Kind {
        let mut fraction = false;
        loop {
            match self.byte(0) {
                b'e' | b'E' if fraction && matches!(self.byte(1), b'+' | b'-') && self.byte(2).is_ascii_digit() => {
                    self.at += 2;
                }
                b'0'..=b'9' | b'a'..=b'z' | b'A'..=b'Z' | b'_' | b'#' => self.at += 1,
                b'.' if self.byte(1).is_ascii_digit() && !self.after_dot => {
                    fraction = true;
                    self.at += 1;
                }
                _ => return Kind::Literal,
            }
        }
    }

    fn word(&mut self) -> Kind {
        let rest = self.rest();
        if !rest.starts_with(starts_name) {
            // Neighbours are one finding: a binary file should not give one for each byte.
            let meaningless = |character: char| {
                !(character.is_whitespace()
                    || continues_name(character)
                    || "`\"%:;=<>()[]{}|/^,.+-*&".contains(character))
            };
            let length = rest.find(|character| !meaningless(character)).unwrap_or(rest.len());
            self.at += length.max(rest.chars().next().map_or(1, char::len_utf8));
            return Kind::Unknown;
        }
        let length = rest.find(|character| !continues_name(character)).unwrap_or(rest.len());
        self.at += length;
        if self.byte(0) == b'#' {
            return self.after_type();
        }
        keyword(&rest[..length], self.dialect).map_or(Kind::Name, Kind::Keyword)
    }
}

/// Whether a value of an enumeration can start so.
fn starts_value(character: char) -> bool {
    character == '`' || starts_name(character)
}

#[cfg(test)]
mod tests {
    use super::super::token::Keyword;
    use super::*;

    fn kinds(text: &str, dialect: Dialect) -> Vec<Kind> {
        let mut lexer = Lexer::new(text, dialect);
        std::iter::repeat_with(|| lexer.token().kind).take_while(|kind| *kind != Kind::End).collect()
    }

    #[test]
    fn each_dialect_has_its_comments_texts_and_keywords() {
        let text = "(* a (* b *) c *) // d\n{e} /* f */ 'it$'s' end_var input";
        let comments = [Kind::Comment; 4];
        let rest = [Kind::Text, Kind::Keyword(Keyword::EndVar), Kind::Name];
        assert_eq!(kinds(text, Dialect::StructuredText), [&comments[..], &rest].concat());
        assert_eq!(kinds("(* a (* b *)", Dialect::StructuredText), [Kind::UnclosedComment]);
        let native = [Kind::Comment, Kind::Keyword(Keyword::Input), Kind::Name, Kind::Slash, Kind::Slash];
        assert_eq!(kinds("-- a\ninput end_var //", Dialect::Native), native);
    }

    #[test]
    fn values_of_enumerations_and_ranges_are_told_from_numbers() {
        let text = "colour#red `my type`#`light red` größe#mod 0..9 w.3..5";
        let expected = [
            [Kind::Literal; 3].as_slice(),
            &[Kind::Literal, Kind::Range, Kind::Literal],
            &[Kind::Name, Kind::Dot, Kind::Literal, Kind::Range, Kind::Literal],
        ];
        assert_eq!(kinds(text, Dialect::Native), expected.concat());
    }
}
