//! What all parsers of text share: the current token, diagnostics, recovery, the limits and the comments. The rules are in
//! `expressions`, `statements`, `types`, and in the parsers of the languages.

use std::path::Path;

use super::lexer::Lexer;
use super::literals::Problem;
use super::token::{Dialect, Kind, Token};
use super::{MAXIMUM_DEPTH, MOST_DIAGNOSTICS, literals};
use crate::diagnostic::{Code, Diagnostic};
use crate::frontend::missing::Missing;
use crate::ladder::{Address, Area, Comment, Name, TypeDeclaration, Width};
use crate::source::{Source, Span};

/// How many bytes of clauses a file may copy to the names before them, for each byte that it has. Without a limit
/// a long list of names with a long clause would take memory by the square of the file.
const COPIES_PER_BYTE: usize = 16;

/// How many bytes of clauses any file may copy.
const MOST_COPIES: usize = 256 << 20;

/// A syntax error that was reported: the statement, declaration or rung around it is given up.
pub(crate) struct GivenUp;

/// What a rule gives.
pub(crate) type Parse<T> = Result<T, GivenUp>;

/// Reads tokens, and what is made of them in every language. One token is looked at ahead, never more, and nothing is
/// read twice.
pub(crate) struct Reader<'a> {
    /// What is read.
    pub(crate) source: &'a Source,
    pub(super) dialect: Dialect,
    lexer: Lexer<'a>,
    /// The token to be read next.
    pub(crate) token: Token,
    /// Where the last token that was read ended.
    pub(crate) end: u32,
    /// The comments so far.
    pub(crate) comments: Vec<Comment>,
    /// What was found so far.
    pub(crate) diagnostics: Vec<Diagnostic>,
    /// What the text has and Rung has not.
    pub(crate) missing: Missing,
    /// Types that declarations write out, under names of their own.
    pub(crate) hidden: Vec<TypeDeclaration>,
    /// Brackets, parentheses and statements around the current token.
    depth: usize,
    /// TooDeep was said of this declaration or rung: once is enough.
    too_deep: bool,
    /// Bytes that lists of names may still copy of the clauses behind them.
    copies_left: usize,
    /// Tokens that may still be read or copied.
    tokens_left: usize,
    gap: Gap,
}

/// A place from which clauses are copied to the names before them.
pub(crate) struct CopiedFrom {
    start: u32,
    tokens_left: usize,
}

/// The comments since the last anchor. Anchors are the places beside which the printer can put comments: the
/// start of every name that is declared, rung, element, wired pin and statement, and the end of whatever closes. Behind an
/// anchor there is room on its line for one comment; all others get lines of their own, so that what the parser
/// says of a comment is what the canonical form says of it.
struct Gap {
    /// Comments before this one were settled.
    settled: usize,
    /// The line of the last anchor still has room.
    room: bool,
}

impl<'a> Reader<'a> {
    /// A reader of a source that may have so many tokens.
    pub(crate) fn new(source: &'a Source, dialect: Dialect, most_tokens: usize) -> Self {
        let mut reader = Self {
            source,
            dialect,
            lexer: Lexer::new(source.text(), dialect),
            token: Token { kind: Kind::End, span: Span::default(), first_on_line: true },
            end: 0,
            comments: Vec::new(),
            diagnostics: Vec::new(),
            missing: Missing::default(),
            hidden: Vec::new(),
            depth: 0,
            too_deep: false,
            copies_left: (COPIES_PER_BYTE * source.text().len() + (1 << 16)).min(MOST_COPIES),
            tokens_left: most_tokens,
            gap: Gap { settled: 0, room: false },
        };
        reader.advance();
        reader.end = 0;
        reader
    }

    /// The name of the file without its folder and ending, for a program that has no other.
    pub(crate) fn stem(&self) -> Name {
        let stem = Path::new(self.source.name()).file_stem().and_then(|stem| stem.to_str());
        // The standard input has no name to take.
        let stem = stem.filter(|stem| *stem != "-").unwrap_or("main");
        // No name holds what its quoted form could not.
        Name::new(stem.replace(['`', '\n', '\r'], "_"), Span::default())
    }

    /// Starts a declaration, a rung or another part that stands in no bracket.
    pub(crate) fn start_item(&mut self) {
        self.depth = 0;
        self.too_deep = false;
    }

    /// Leaves out what is left of a declaration or rung that was given up.
    pub(crate) fn skip_item(&mut self) {
        while !self.token.kind.starts_item() {
            self.advance();
        }
    }

    /// Goes to the next token.
    pub(crate) fn advance(&mut self) {
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
                    let text = bare_comment(self.source.slice(span), self.dialect).to_owned();
                    self.comments.push(Comment { text, span, own_line: self.token.first_on_line });
                    continue;
                }
                Kind::UnclosedComment => {
                    self.report(Diagnostic::new(Code::Unclosed, span, "this comment is not closed"));
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
            _ if self.dialect != Dialect::Native => problem,
            Some(b'\'') => problem.hint("a title stands in double quotes"),
            Some(b'!' | b'~') => problem.hint("a closed contact is written /name, and in braces NOT"),
            _ => problem,
        }
    }

    /// Goes to the next token if this one is of a kind, and says whether it was.
    pub(crate) fn take(&mut self, kind: Kind) -> bool {
        let found = self.token.kind == kind;
        if found {
            self.advance();
        }
        found
    }

    /// Whether the current token is this word, outside quotes. For words that are no keywords.
    pub(crate) fn at_word(&self, word: &str) -> bool {
        self.token.kind == Kind::Name && self.source.slice(self.token.span).eq_ignore_ascii_case(word)
    }

    /// Whether nothing stands between the last token and this one.
    pub(crate) fn touching(&self) -> bool {
        self.token.span.start == self.end
    }

    /// A name.
    pub(crate) fn name(&mut self, expected: &str) -> Parse<Name> {
        let span = self.token.span;
        let text = self.source.slice(span);
        let text = match self.token.kind {
            Kind::Name => text,
            Kind::QuotedName => {
                let inner = text.strip_prefix('`').unwrap_or(text);
                // The break of a line that is CR LF is no part of an unclosed name.
                inner.strip_suffix('`').unwrap_or(inner.trim_end_matches('\r'))
            }
            Kind::Keyword(_) => {
                let problem = self.unexpected(expected);
                let word = self.source.slice(span);
                return self.give_up(match self.dialect {
                    Dialect::Native => problem.hint(format!("`{word}` is a name only in back quotes")),
                    Dialect::StructuredText => problem.hint(format!("`{word}` is a keyword")),
                });
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

    /// The complaint that something else stands where `expected` should.
    pub(crate) fn unexpected(&self, expected: &str) -> Diagnostic {
        self.unexpected_token(self.token, expected)
    }

    /// The complaint that a token stands where `expected` should.
    pub(crate) fn unexpected_token(&self, token: Token, expected: &str) -> Diagnostic {
        let found = match token.kind {
            Kind::End => "the end of the file".to_owned(),
            _ => excerpt(self.source.slice(token.span)),
        };
        Diagnostic::new(Code::UnexpectedToken, token.span, format!("expected {expected}, found {found}"))
    }

    /// The closing counterpart of what was opened at `open`.
    pub(crate) fn close(&mut self, kind: Kind, open: Span, hint: &str) -> Parse<()> {
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
    pub(crate) fn give_up<T>(&mut self, problem: Diagnostic) -> Parse<T> {
        self.report(problem);
        Err(GivenUp)
    }

    /// Reports. Past the limit it says so and leaves the rest of the file unread.
    pub(crate) fn report(&mut self, problem: Diagnostic) {
        if self.diagnostics.len() < MOST_DIAGNOSTICS {
            self.diagnostics.push(problem);
        } else if self.diagnostics.len() == MOST_DIAGNOSTICS {
            let message = format!("more than {MOST_DIAGNOSTICS} errors: the rest of the file was not read");
            self.diagnostics.push(Diagnostic::new(Code::TooManyDiagnostics, problem.span, message));
            self.stop();
        }
    }

    /// Reports a literal that cannot be read; reading goes on behind it.
    pub(crate) fn report_literal(&mut self, code: Code, span: Span, problem: Problem) {
        let text = excerpt(self.source.slice(span));
        let diagnostic = Diagnostic::new(code, span, format!("{text}: {}", problem.message));
        self.report(match problem.hint {
            Some(hint) => diagnostic.hint(hint),
            None => diagnostic,
        });
    }

    /// Goes one bracket deeper, at the opening bracket. Too deep, it reports, skips to behind the closing
    /// counterpart and says false.
    pub(crate) fn enter(&mut self) -> Parse<bool> {
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
                open = open.saturating_sub(1);
            }
            self.advance();
            if open == 0 {
                return Ok(false);
            }
        }
        Err(GivenUp)
    }

    /// Goes one statement deeper, behind its first word. Too deep, it reports and says false.
    pub(crate) fn enter_statement(&mut self, start: Span) -> bool {
        let room = self.depth < MAXIMUM_DEPTH;
        if room {
            self.depth += 1;
        } else {
            self.report_too_deep(start);
        }
        room
    }

    /// How deep the current token stands.
    pub(crate) fn depth(&self) -> usize {
        self.depth
    }

    /// Goes on at the depth that something given up had started at.
    pub(crate) fn resume_at(&mut self, depth: usize) {
        self.depth = depth;
    }

    /// Comes back from one bracket deeper.
    pub(crate) fn leave(&mut self) {
        self.depth -= 1;
    }

    /// Reports that something is too deep, once in a declaration or rung.
    pub(crate) fn report_too_deep(&mut self, span: Span) {
        if !std::mem::replace(&mut self.too_deep, true) {
            let message = format!("more than {MAXIMUM_DEPTH} levels deep");
            let problem = Diagnostic::new(Code::TooDeep, span, message);
            self.report(problem.hint("give a part of it a variable of its own"));
        }
    }

    /// Notes that comments can stand beside what stands here; see [`Gap`].
    pub(crate) fn anchor(&mut self, at: u32) {
        while let Some(comment) = self.comments.get_mut(self.gap.settled)
            && comment.span.start < at
        {
            comment.own_line |= !self.gap.room;
            self.gap.room = false;
            self.gap.settled += 1;
        }
        self.gap.room = true;
    }

    /// Notes where clauses begin that stand behind several names.
    pub(crate) fn copied_from(&self) -> CopiedFrom {
        CopiedFrom { start: self.end, tokens_left: self.tokens_left }
    }

    /// Counts what clauses are copied to the names before them, all but one. A long clause behind many names must not make a
    /// large program of a small file.
    pub(crate) fn count_copies(&mut self, from: &CopiedFrom, names: usize, whole: Span) -> Parse<()> {
        let times = names.saturating_sub(1);
        let bytes = times.saturating_mul(self.since(from.start).range().len());
        let tokens = times.saturating_mul(from.tokens_left - self.tokens_left);
        if bytes > self.copies_left || tokens > self.tokens_left {
            let problem = Diagnostic::new(Code::FileTooLarge, whole, "these clauses are too long for so many names");
            return self.give_up(problem.hint("declare the variables one by one, or in smaller groups"));
        }
        self.copies_left -= bytes;
        self.tokens_left -= tokens;
        Ok(())
    }

    /// The address that is the current token. One that cannot be read is reported, and another put in its place.
    pub(crate) fn address(&mut self) -> Address {
        let span = self.token.span;
        let address = literals::address(self.source.slice(span), span).unwrap_or_else(|problem| {
            self.report_literal(Code::BadAddress, span, problem);
            Address { area: Area::Memory, width: Width::Bit, numbers: vec![0], span }
        });
        self.advance();
        address
    }

    /// Notes that comments can stand beside the current token.
    pub(crate) fn anchor_here(&mut self) {
        self.anchor(self.token.span.start);
    }

    /// From a place to the end of the last token.
    pub(crate) fn since(&self, start: u32) -> Span {
        Span { start, end: self.end.max(start) }
    }
}

/// A comment without its marks.
fn bare_comment(text: &str, dialect: Dialect) -> &str {
    if dialect == Dialect::Native || text.starts_with("//") {
        return text.get(2..).unwrap_or("").trim();
    }
    let marks = [("(*", "*)"), ("/*", "*/")].into_iter();
    let mut inner = marks.filter_map(|(open, close)| text.strip_prefix(open)?.strip_suffix(close));
    // A pragma keeps its braces: it is more than a remark.
    inner.next().unwrap_or(text).trim()
}

/// The start of a text, in quotes, with nothing in it that would spoil a line.
fn excerpt(text: &str) -> String {
    const LONGEST: usize = 40;
    let shown: String =
        text.chars().take(LONGEST).map(|c| if c.is_control() { char::REPLACEMENT_CHARACTER } else { c }).collect();
    let more = if text.chars().nth(LONGEST).is_some() { "…" } else { "" };
    format!("`{shown}{more}`")
}
