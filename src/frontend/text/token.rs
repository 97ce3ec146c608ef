//! Tokens and keywords: the vocabulary that lexer, parser and printer share.

use crate::source::Span;

/// One word or sign of the text.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) struct Token {
    /// What it is.
    pub(super) kind: Kind,
    /// Where.
    pub(super) span: Span,
    /// Whether it is the first on its line.
    pub(super) first_on_line: bool,
}

/// The kinds of token. What one says is read from the source when it is needed.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Kind {
    /// A name as it is.
    Name,
    /// A name in back quotes.
    QuotedName,
    /// A word with a fixed meaning.
    Keyword(Keyword),
    /// A number, or anything with a `#`.
    Literal,
    /// `%…`
    Address,
    /// `"…"`
    Text,
    /// `(`
    LeftParenthesis,
    /// `)`
    RightParenthesis,
    /// `[`
    LeftBracket,
    /// `]`
    RightBracket,
    /// `{`
    LeftBrace,
    /// `}`
    RightBrace,
    /// `|`
    Bar,
    /// `/`
    Slash,
    /// `^`
    Caret,
    /// `:`
    Colon,
    /// `:=`
    Assign,
    /// `=>`
    Arrow,
    /// `,`
    Comma,
    /// `.`
    Dot,
    /// `=`
    Equal,
    /// `<>`
    NotEqual,
    /// `<`
    Less,
    /// `<=`
    LessOrEqual,
    /// `>`
    Greater,
    /// `>=`
    GreaterOrEqual,
    /// `>>`
    Jump,
    /// `+`
    Plus,
    /// `-`
    Minus,
    /// `*`
    Star,
    /// `&`
    Ampersand,
    /// `--` to the end of the line; the parser never sees it
    Comment,
    /// Characters without a meaning; the parser never sees it
    Unknown,
    /// A title whose quote does not close on its line
    UnclosedText,
    /// A name whose back quote does not close on its line
    UnclosedName,
    /// The end of the text
    End,
}

impl Kind {
    /// Whether it opens something that has to be closed.
    pub(super) const fn opens(self) -> bool {
        matches!(self, Self::LeftParenthesis | Self::LeftBracket | Self::LeftBrace)
    }

    /// Whether it closes what another opened.
    pub(super) const fn closes(self) -> bool {
        matches!(self, Self::RightParenthesis | Self::RightBracket | Self::RightBrace)
    }

    /// Whether a declaration or rung starts here, or the text ends: where reading goes on after an error.
    pub(super) const fn starts_item(self) -> bool {
        match self {
            Self::End => true,
            Self::Keyword(keyword) => matches!(
                keyword,
                Keyword::Program
                    | Keyword::Input
                    | Keyword::Output
                    | Keyword::Var
                    | Keyword::Const
                    | Keyword::Rung
                    | Keyword::ReservedItem
            ),
            _ => false,
        }
    }

    /// Whether it is a name, quoted or not.
    pub(super) const fn is_name(self) -> bool {
        matches!(self, Self::Name | Self::QuotedName)
    }
}

/// Words that are names only in back quotes. They are written in any case.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Keyword {
    Program,
    Input,
    Output,
    Var,
    Const,
    Rung,
    True,
    False,
    And,
    Or,
    Xor,
    Not,
    Mod,
    /// A word that will start a declaration in a later version.
    ReservedItem,
    /// Another word of a later version.
    Reserved,
}

const KEYWORDS: [(&str, Keyword); 21] = [
    ("program", Keyword::Program),
    ("input", Keyword::Input),
    ("output", Keyword::Output),
    ("var", Keyword::Var),
    ("const", Keyword::Const),
    ("rung", Keyword::Rung),
    ("true", Keyword::True),
    ("false", Keyword::False),
    ("and", Keyword::And),
    ("or", Keyword::Or),
    ("xor", Keyword::Xor),
    ("not", Keyword::Not),
    ("mod", Keyword::Mod),
    ("global", Keyword::ReservedItem),
    ("inout", Keyword::ReservedItem),
    ("temp", Keyword::ReservedItem),
    ("type", Keyword::ReservedItem),
    ("function", Keyword::ReservedItem),
    ("function_block", Keyword::ReservedItem),
    ("task", Keyword::ReservedItem),
    ("array", Keyword::Reserved),
];

/// The keyword that a word is, if it is one.
pub(super) fn keyword(word: &str) -> Option<Keyword> {
    KEYWORDS.iter().find(|(spelling, _)| spelling.eq_ignore_ascii_case(word)).map(|(_, keyword)| *keyword)
}

/// Whether a character can start a name.
pub(super) fn starts_name(character: char) -> bool {
    character == '_' || character.is_alphabetic()
}

/// Whether a character can stand inside a name.
pub(super) fn continues_name(character: char) -> bool {
    character == '_' || character.is_alphanumeric()
}

/// Whether a name needs no back quotes.
pub(super) fn is_plain_name(text: &str) -> bool {
    text.starts_with(starts_name) && text.chars().all(continues_name) && keyword(text).is_none()
}
