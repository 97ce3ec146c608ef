//! What all parts of the parser share: the current token, diagnostics, recovery, the depth limit and the
//! comments; and the order of a file. Its rules are in `declarations`, `rungs`, `elements` and `expressions`.

use std::path::Path;

use super::lexer::Lexer;
use super::literals::Problem;
use super::token::{Keyword, Kind, Token};
use super::{MAXIMUM_DEPTH, MOST_DIAGNOSTICS};
use crate::diagnostic::{Code, Diagnostic};
use crate::frontend::Parsed;
use crate::ladder::{Comment, Name, Origin, Program, VariableClass};
use crate::source::{Source, Span};

/// How many bytes of clauses a file may copy to the names before them, for each byte that it has. Without a limit
/// a long list of names with a long clause would take memory by the square of the file.
const COPIES_PER_BYTE: usize = 16;

/// How many bytes of clauses any file may copy.
const MOST_COPIES: usize = 256 << 20;

/// A syntax error that was reported: the declaration or rung around it is given up.
pub(super) struct GivenUp;

/// What a rule gives.
pub(super) type Parse<T> = Result<T, GivenUp>;

/// Reads a program. One token is looked at ahead, never more, and nothing is read twice.
pub(super) struct Parser<'a> {
    pub(super) source: &'a Source,
    lexer: Lexer<'a>,
    /// The token to be read next.
    pub(super) token: Token,
    /// Where the last token that was read ended.
    pub(super) end: u32,
    pub(super) program: Program,
    diagnostics: Vec<Diagnostic>,
    /// Brackets and parentheses around the current token.
    depth: usize,
    /// TooDeep was said of this declaration or rung: once is enough.
    too_deep: bool,
    /// Bytes that lists of names may still copy of the clauses behind them.
    pub(super) copies_left: usize,
    /// Tokens that may still be read or copied.
    pub(super) tokens_left: usize,
    gap: Gap,
}

/// The comments since the last anchor. Anchors are the places beside which the printer can put comments: the
/// start of every name that is declared, rung, element and wired pin, and the end of whatever closes. Behind an
/// anchor there is room on its line for one comment; all others get lines of their own, so that what the parser
/// says of a comment is what the canonical form says of it.
struct Gap {
    /// Comments before this one were settled.
    settled: usize,
    /// The line of the last anchor still has room.
    room: bool,
}

impl<'a> Parser<'a> {
    /// A parser of a source that may have so many tokens.
    pub(super) fn new(source: &'a Source, most_tokens: usize) -> Self {
        let stem = Path::new(source.name()).file_stem().and_then(|stem| stem.to_str());
        // The standard input has no name to take.
        let stem = stem.filter(|stem| *stem != "-").unwrap_or("main");
        // No name holds what its quoted form could not.
        let stem = stem.replace(['`', '\n', '\r'], "_");
        let mut parser = Self {
            source,
            lexer: Lexer::new(source.text()),
            token: Token { kind: Kind::End, span: Span::default(), first_on_line: true },
            end: 0,
            program: Program::of_one(Origin::Native, Name::new(stem, Span::default()), Vec::new(), Vec::new()),
            diagnostics: Vec::new(),
            depth: 0,
            too_deep: false,
            copies_left: (COPIES_PER_BYTE * source.text().len() + (1 << 16)).min(MOST_COPIES),
            tokens_left: most_tokens,
            gap: Gap { settled: 0, room: false },
        };
        parser.advance();
        parser.end = 0;
        parser
    }

    /// The whole file.
    pub(super) fn program(mut self) -> Parsed {
        let mut first = true;
        while self.token.kind != Kind::End {
            self.depth = 0;
            self.too_deep = false;
            if self.item(first).is_err() {
                while !self.token.kind.starts_item() {
                    self.advance();
                }
            }
            first = false;
        }
        self.anchor(u32::MAX);
        Parsed { program: self.program, diagnostics: self.diagnostics }
    }

    fn item(&mut self, first: bool) -> Parse<()> {
        match self.token.kind {
            Kind::Keyword(Keyword::Program) => self.program_line(first),
            Kind::Keyword(Keyword::Input) => self.declaration(VariableClass::Input),
            Kind::Keyword(Keyword::Output) => self.declaration(VariableClass::Output),
            Kind::Keyword(Keyword::Var) => self.declaration(VariableClass::Memory),
            Kind::Keyword(Keyword::Const) => self.declaration(VariableClass::Constant),
            Kind::Keyword(Keyword::Rung) => self.rung(),
            Kind::Keyword(Keyword::ReservedItem) => {
                let problem = self.reserved(self.token.span);
                self.advance();
                self.give_up(problem)
            }
            _ => {
                let problem = self
                    .unexpected("a declaration or a rung")
                    .hint("a line starts with program, input, output, var, const or rung");
                self.give_up(problem)
            }
        }
    }

    fn program_line(&mut self, first: bool) -> Parse<()> {
        if !first {
            let problem = Diagnostic::new(Code::UnexpectedToken, self.token.span, "`program` stands here too late");
            self.report(problem.hint("the first line names the program, and no other"));
        }
        self.advance();
        let at = self.token.span.start;
        let name = self.name("the program's name")?;
        if first {
            self.anchor(at);
            self.program.units[0].name = name.clone();
            self.program.name = name;
        }
        self.item_end("a declaration or a rung")
    }

    /// Makes sure that a declaration or rung is over.
    pub(super) fn item_end(&mut self, expected: &str) -> Parse<()> {
        if self.token.kind.starts_item() {
            return Ok(());
        }
        let problem = self.unexpected(expected);
        self.give_up(problem)
    }

    /// Goes to the next token.
    pub(super) fn advance(&mut self) {
        self.end = self.token.span.end;
        loop {
            self.token = self.lexer.token();
            let span = self.token.span;
            if self.token.kind != Kind::End {
                let Some(left) = self.tokens_left.checked_sub(1) else { return self.too_large() };
                self.tokens_left = left;
            }
            let problem = match self.token.kind {
                Kind::Comment => {
                    let text = self.source.slice(span).get(2..).unwrap_or("").trim().to_owned();
                    self.program.comments.push(Comment { text, span, own_line: self.token.first_on_line });
                    continue;
                }
                Kind::Unknown => {
                    self.report(self.unknown(span));
                    continue;
                }
                Kind::UnclosedText => {
                    self.token.kind = Kind::Text;
                    Diagnostic::new(Code::Unclosed, span, "this title has no closing quote on its line")
                        .hint("a quote within a title is written $\"")
                }
                Kind::UnclosedName => {
                    self.token.kind = Kind::QuotedName;
                    Diagnostic::new(Code::Unclosed, span, "this name has no closing back quote on its line")
                }
                _ => return,
            };
            self.report(problem);
            return;
        }
    }

    fn too_large(&mut self) {
        let message = "the file has too many words and signs: the rest of it was not read";
        self.report(Diagnostic::new(Code::FileTooLarge, self.token.span, message));
        self.stop();
    }

    /// Leaves the rest of the file unread.
    fn stop(&mut self) {
        self.lexer.stop();
        self.token.kind = Kind::End;
    }

    fn unknown(&self, span: Span) -> Diagnostic {
        let text = self.source.slice(span);
        let message = match text.chars().next() {
            Some(character) if character.is_control() || text.chars().nth(1).is_some() => {
                format!("{} has no meaning here", excerpt(text))
            }
            Some(character) => format!("`{character}` (U+{:04X}) has no meaning here", u32::from(character)),
            None => String::new(),
        };
        let problem = Diagnostic::new(Code::UnexpectedCharacter, span, message);
        match text.bytes().next() {
            Some(b';') => problem.hint("nothing ends with a semicolon here"),
            Some(b'\'') => problem.hint("a title stands in double quotes"),
            Some(b'!' | b'~') => problem.hint("a closed contact is written /name, and in braces NOT"),
            _ => problem,
        }
    }

    /// Goes to the next token if this one is of a kind, and says whether it was.
    pub(super) fn take(&mut self, kind: Kind) -> bool {
        let found = self.token.kind == kind;
        if found {
            self.advance();
        }
        found
    }

    /// Whether the current token is this word, outside quotes. For words that are no keywords.
    pub(super) fn at_word(&self, word: &str) -> bool {
        self.token.kind == Kind::Name && self.source.slice(self.token.span).eq_ignore_ascii_case(word)
    }

    /// Whether nothing stands between the last token and this one.
    pub(super) fn touching(&self) -> bool {
        self.token.span.start == self.end
    }

    /// A name.
    pub(super) fn name(&mut self, expected: &str) -> Parse<Name> {
        let span = self.token.span;
        let text = self.source.slice(span);
        let text = match self.token.kind {
            Kind::Name => text,
            Kind::QuotedName => {
                let inner = text.strip_prefix('`').unwrap_or(text);
                // The break of a line that is CR LF is no part of an unclosed name.
                inner.strip_suffix('`').unwrap_or(inner.trim_end_matches('\r'))
            }
            Kind::Keyword(Keyword::Reserved | Keyword::ReservedItem) => {
                let problem = self.reserved(span);
                return self.give_up(problem);
            }
            Kind::Keyword(_) => {
                let problem = self.unexpected(expected);
                let word = self.source.slice(span);
                return self.give_up(problem.hint(format!("`{word}` is a name only in back quotes")));
            }
            _ => {
                let problem = self.unexpected(expected);
                return self.give_up(problem);
            }
        };
        if text.is_empty() || text.contains('\r') {
            self.report(Diagnostic::new(Code::UnexpectedToken, span, "a name is neither empty nor has line breaks"));
        }
        let name = Name::new(text, span);
        self.advance();
        Ok(name)
    }

    fn reserved(&self, span: Span) -> Diagnostic {
        let word = self.source.slice(span);
        Diagnostic::new(Code::UnexpectedToken, span, format!("`{word}` is kept for a later version of the language"))
            .hint(format!("in back quotes, `{word}` is a name"))
    }

    /// The complaint that something else stands where `expected` should.
    pub(super) fn unexpected(&self, expected: &str) -> Diagnostic {
        let found = match self.token.kind {
            Kind::End => "the end of the file".to_owned(),
            _ => excerpt(self.source.slice(self.token.span)),
        };
        Diagnostic::new(Code::UnexpectedToken, self.token.span, format!("expected {expected}, found {found}"))
    }

    /// The closing counterpart of what was opened at `open`.
    pub(super) fn close(&mut self, kind: Kind, open: Span, hint: &str) -> Parse<()> {
        if self.take(kind) {
            return Ok(());
        }
        let closing = match kind {
            Kind::RightBracket => "]",
            Kind::RightBrace => "}",
            _ => ")",
        };
        let problem = if self.token.kind.starts_item() || self.token.kind.closes() {
            let opening = excerpt(self.source.slice(open));
            Diagnostic::new(Code::Unclosed, open, format!("{opening} is not closed"))
                .related(self.token.span, format!("a `{closing}` should stand before this"))
        } else {
            self.unexpected(&format!("`{closing}`"))
        };
        self.give_up(if hint.is_empty() { problem } else { problem.hint(hint) })
    }

    /// Reports and gives up the declaration or rung.
    pub(super) fn give_up<T>(&mut self, problem: Diagnostic) -> Parse<T> {
        self.report(problem);
        Err(GivenUp)
    }

    /// Reports. Past the limit it says so and leaves the rest of the file unread.
    pub(super) fn report(&mut self, problem: Diagnostic) {
        if self.diagnostics.len() < MOST_DIAGNOSTICS {
            self.diagnostics.push(problem);
        } else if self.diagnostics.len() == MOST_DIAGNOSTICS {
            let message = format!("more than {MOST_DIAGNOSTICS} errors: the rest of the file was not read");
            self.diagnostics.push(Diagnostic::new(Code::TooManyDiagnostics, problem.span, message));
            self.stop();
        }
    }

    /// Reports a literal that cannot be read; reading goes on behind it.
    pub(super) fn report_literal(&mut self, code: Code, span: Span, problem: Problem) {
        let text = excerpt(self.source.slice(span));
        let diagnostic = Diagnostic::new(code, span, format!("{text}: {}", problem.message));
        self.report(match problem.hint {
            Some(hint) => diagnostic.hint(hint),
            None => diagnostic,
        });
    }

    /// Goes one bracket deeper, at the opening bracket. Too deep, it reports, skips to behind the closing
    /// counterpart and says false.
    pub(super) fn enter(&mut self) -> Parse<bool> {
        if self.depth < MAXIMUM_DEPTH {
            self.depth += 1;
            self.advance();
            return Ok(true);
        }
        self.report_too_deep(self.token.span);
        let mut open = 0usize;
        while !self.token.kind.starts_item() {
            if self.token.kind.opens() {
                open += 1;
            } else if self.token.kind.closes() {
                open -= 1;
            }
            self.advance();
            if open == 0 {
                return Ok(false);
            }
        }
        Err(GivenUp)
    }

    /// Comes back from one bracket deeper.
    pub(super) fn leave(&mut self) {
        self.depth -= 1;
    }

    /// Reports that something is too deep, once in a declaration or rung.
    pub(super) fn report_too_deep(&mut self, span: Span) {
        if !std::mem::replace(&mut self.too_deep, true) {
            let message = format!("more than {MAXIMUM_DEPTH} levels deep");
            let problem = Diagnostic::new(Code::TooDeep, span, message);
            self.report(problem.hint("give a part of it a variable of its own"));
        }
    }

    /// Notes that comments can stand beside what stands here; see [`Gap`].
    pub(super) fn anchor(&mut self, at: u32) {
        while let Some(comment) = self.program.comments.get_mut(self.gap.settled)
            && comment.span.start < at
        {
            comment.own_line |= !self.gap.room;
            self.gap.room = false;
            self.gap.settled += 1;
        }
        self.gap.room = true;
    }

    /// From a place to the end of the last token.
    pub(super) fn since(&self, start: u32) -> Span {
        Span { start, end: self.end.max(start) }
    }
}

/// The start of a text, in quotes, with nothing in it that would spoil a line.
fn excerpt(text: &str) -> String {
    const LONGEST: usize = 40;
    let shown: String =
        text.chars().take(LONGEST).map(|c| if c.is_control() { char::REPLACEMENT_CHARACTER } else { c }).collect();
    let more = if text.chars().nth(LONGEST).is_some() { "…" } else { "" };
    format!("`{shown}{more}`")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn codes(text: &str, most_tokens: usize) -> Vec<Code> {
        let source = Source::new("x.rung", text);
        Parser::new(&source, most_tokens).program().diagnostics.iter().map(|problem| problem.code).collect()
    }

    #[test]
    fn a_file_of_more_tokens_than_permitted_is_not_read_to_its_end() {
        let text = "-- c\ninput a\noutput o\nrung\n  a (o) -- c\n";
        assert_eq!(codes(text, 11), []);
        assert_eq!(codes(text, 10), [Code::FileTooLarge]);
        let source = Source::new("x.rung", text);
        assert_eq!(Parser::new(&source, 4).program().program.units[0].rungs, []);
    }

    #[test]
    fn tokens_that_a_list_of_names_copies_count() {
        // 14 that are read, and twice the 7 behind the colon.
        let text = "var a, b, c : INT := 1 + 1 + 1\n";
        assert_eq!(codes(text, 28), []);
        assert_eq!(codes(text, 27), [Code::FileTooLarge]);
    }

    #[test]
    fn a_program_from_the_standard_input_is_called_main_where_it_says_nothing() {
        let name = |file| Parser::new(&Source::new(file, "rung\n"), 10).program().program.name.text;
        assert_eq!(["-", "folder/pump.rung", ""].map(name), ["main", "pump", "main"]);
    }
}
