//! From text to tokens, one at a time as the parser asks, so that a large file costs no more than its program.
//! It must never fail: what has no meaning is a token of its own.

use super::token::{Kind, Token, continues_name, keyword, starts_name};
use crate::source::Span;

/// Reads tokens from a text.
pub(super) struct Lexer<'a> {
    text: &'a str,
    at: usize,
    /// Nothing but white space was read since the last line break.
    first_on_line: bool,
    /// The last token was a `.`, so that digits are a bit's number and never the start of `3.4`.
    after_dot: bool,
}

impl<'a> Lexer<'a> {
    /// A lexer at the start of a text.
    pub(super) fn new(text: &'a str) -> Self {
        Self { text, at: 0, first_on_line: true, after_dot: false }
    }

    /// Leaves the rest unread: every later token is the end.
    pub(super) fn stop(&mut self) {
        self.at = self.text.len();
    }

    /// The next token; at the end of the text, the end again and again.
    pub(super) fn token(&mut self) -> Token {
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
        let (length, kind) = match (self.byte(0), self.byte(1)) {
            (b'-', b'-') => {
                self.at = self.line_end();
                return Kind::Comment;
            }
            (b'`', _) => return self.quoted(b'`', Kind::QuotedName, Kind::UnclosedName),
            (b'"', _) => return self.quoted(b'"', Kind::Text, Kind::UnclosedText),
            (b'%', _) => return self.address(),
            (b'0'..=b'9', _) => return self.number(),
            (b':', b'=') => (2, Kind::Assign),
            (b'=', b'>') => (2, Kind::Arrow),
            (b'<', b'>') => (2, Kind::NotEqual),
            (b'<', b'=') => (2, Kind::LessOrEqual),
            (b'>', b'=') => (2, Kind::GreaterOrEqual),
            (b'>', b'>') => (2, Kind::Jump),
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

    fn line_end(&self) -> usize {
        self.rest().find('\n').map_or(self.text.len(), |length| self.at + length)
    }

    /// A quoted token. One that does not close ends with its line. In a title `$` takes the next character's
    /// meaning away.
    fn quoted(&mut self, quote: u8, closed: Kind, unclosed: Kind) -> Kind {
        let mut at = self.at + 1;
        let bytes = self.text.as_bytes();
        while let Some(&byte) = bytes.get(at) {
            match byte {
                b'\n' => break,
                b'$' if quote == b'"' && matches!(bytes.get(at + 1), Some(b'"' | b'$')) => at += 1,
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
                    || "`\"%:=<>()[]{}|/^,.+-*&".contains(character))
            };
            let length = rest.find(|character| !meaningless(character)).unwrap_or(rest.len());
            self.at += length.max(rest.chars().next().map_or(1, char::len_utf8));
            return Kind::Unknown;
        }
        let length = rest.find(|character| !continues_name(character)).unwrap_or(rest.len());
        self.at += length;
        if self.byte(0) == b'#' {
            self.at += if matches!(self.byte(1), b'+' | b'-') && self.byte(2).is_ascii_digit() { 2 } else { 1 };
            return self.number();
        }
        keyword(&rest[..length]).map_or(Kind::Name, Kind::Keyword)
    }
}
