//! Tokens and keywords: the vocabulary that lexer, parsers and printer share. Nothing here reads text.

use crate::source::Span;

/// One word or sign of the text.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) struct Token {
    /// What it is.
    pub(crate) kind: Kind,
    /// Where.
    pub(crate) span: Span,
    /// Whether it is the first on its line.
    pub(crate) first_on_line: bool,
}

/// The kinds of token. What one says is read from the source when it is needed.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Kind {
    /// A name as it is.
    Name,
    /// A name in back quotes.
    QuotedName,
    /// A word with a fixed meaning.
    Keyword(Keyword),
    /// A number, or anything with a `#`: `INT#5`, `colour#red`.
    Literal,
    /// `%…`
    Address,
    /// `"…"`, and `'…'` where it is not native.
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
    /// `..`
    Range,
    /// `;`
    Semicolon,
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
    /// A comment, its marks included; the parser never sees it
    Comment,
    /// A comment that does not end; the parser never sees it
    UnclosedComment,
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
    pub(crate) const fn opens(self) -> bool {
        matches!(self, Self::LeftParenthesis | Self::LeftBracket | Self::LeftBrace)
    }

    /// Whether it closes what another opened.
    pub(crate) const fn closes(self) -> bool {
        matches!(self, Self::RightParenthesis | Self::RightBracket | Self::RightBrace)
    }

    /// Whether a declaration, rung or unit starts or ends here, or the text ends: where reading goes on after an error.
    pub(crate) const fn starts_item(self) -> bool {
        use Keyword as K;
        match self {
            Self::End => true,
            Self::Keyword(keyword) => {
                matches!(
                    keyword,
                    K::Program
                        | K::Function
                        | K::FunctionBlock
                        | K::Type
                        | K::Task
                        | K::Input
                        | K::Output
                        | K::InOut
                        | K::Temp
                        | K::Var
                        | K::Const
                        | K::Global
                        | K::Registers
                        | K::Imported
                        | K::Rung
                ) || keyword.is_of_structured_text_alone()
            }
            _ => false,
        }
    }

    /// Whether a list of statements ends before it.
    pub(crate) const fn ends_statements(self) -> bool {
        self.starts_item() || matches!(self, Self::RightBrace) || self.ends_part()
    }

    /// Whether it ends a part of a statement.
    pub(crate) const fn ends_part(self) -> bool {
        use Keyword as K;
        matches!(self, Self::Keyword(K::Elsif | K::Else | K::Until)) || self.ends_statement()
    }

    /// Whether it starts a statement with statements in it.
    pub(crate) const fn starts_statement(self) -> bool {
        use Keyword as K;
        matches!(self, Self::Keyword(K::If | K::Case | K::For | K::While | K::Repeat))
    }

    /// Whether it ends a statement with statements in it.
    pub(crate) const fn ends_statement(self) -> bool {
        use Keyword as K;
        matches!(self, Self::Keyword(K::EndIf | K::EndCase | K::EndFor | K::EndWhile | K::EndRepeat))
    }

    /// Whether it is a name, quoted or not.
    pub(crate) const fn is_name(self) -> bool {
        matches!(self, Self::Name | Self::QuotedName)
    }
}

/// A language that is read as text.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Dialect {
    /// Rung's own.
    Native,
    /// Files of structured text.
    StructuredText,
}

macro_rules! keywords {
    ($($(#[$doc:meta])* $table:ident { $($keyword:ident $spelling:literal,)* })*) => {
        /// Words with a fixed meaning, in any case: they are no names unless they stand in back quotes.
        #[derive(Clone, Copy, PartialEq, Eq, Debug)]
        pub(crate) enum Keyword {
            $($($keyword,)*)*
        }

        $($(#[$doc])* const $table: &[(&str, Keyword)] = &[$(($spelling, Keyword::$keyword),)*];)*
    };
}

keywords! {
    /// Those of every dialect.
    COMMON {
        Program "program",
        Function "function",
        FunctionBlock "function_block",
        Type "type",
        Struct "struct",
        EndStruct "end_struct",
        Array "array",
        Of "of",
        Task "task",
        Var "var",
        True "true",
        False "false",
        And "and",
        Or "or",
        Xor "xor",
        Not "not",
        Mod "mod",
        If "if",
        Then "then",
        Elsif "elsif",
        Else "else",
        EndIf "end_if",
        Case "case",
        EndCase "end_case",
        For "for",
        To "to",
        By "by",
        Do "do",
        EndFor "end_for",
        While "while",
        EndWhile "end_while",
        Repeat "repeat",
        Until "until",
        EndRepeat "end_repeat",
        Exit "exit",
        Return "return",
    }
    /// Those of the native text.
    NATIVE {
        Input "input",
        Output "output",
        InOut "inout",
        Temp "temp",
        Const "const",
        Global "global",
        Registers "registers",
        Imported "imported",
        Rung "rung",
    }
    /// Those of files of structured text.
    STRUCTURED_TEXT {
        VarInput "var_input",
        VarOutput "var_output",
        VarInOut "var_in_out",
        VarTemp "var_temp",
        VarGlobal "var_global",
        VarExternal "var_external",
        EndVar "end_var",
        EndType "end_type",
        EndProgram "end_program",
        EndFunction "end_function",
        EndFunctionBlock "end_function_block",
        Configuration "configuration",
        EndConfiguration "end_configuration",
        Resource "resource",
        EndResource "end_resource",
        Constant "constant",
        Retain "retain",
        NonRetain "non_retain",
        At "at",
        With "with",
        On "on",
    }
}

/// The keyword that a word is in a dialect, if it is one.
pub(crate) fn keyword(word: &str, dialect: Dialect) -> Option<Keyword> {
    let own = match dialect {
        Dialect::Native => NATIVE,
        Dialect::StructuredText => STRUCTURED_TEXT,
    };
    let found = COMMON.iter().chain(own).find(|(spelling, _)| spelling.eq_ignore_ascii_case(word));
    found.map(|(_, keyword)| *keyword)
}

/// Whether a character can start a name.
pub(crate) fn starts_name(character: char) -> bool {
    character == '_' || character.is_alphabetic()
}

/// Whether a character can stand inside a name.
pub(crate) fn continues_name(character: char) -> bool {
    character == '_' || character.is_alphanumeric()
}

/// Whether a name needs no back quotes in the native text.
pub(crate) fn is_plain_name(text: &str) -> bool {
    text.starts_with(starts_name) && text.chars().all(continues_name) && keyword(text, Dialect::Native).is_none()
}
impl Keyword {
    /// Whether only structured text has it, and it starts or ends a declaration or unit there.
    pub(crate) const fn is_of_structured_text_alone(self) -> bool {
        matches!(
            self,
            Self::VarInput
                | Self::VarOutput
                | Self::VarInOut
                | Self::VarTemp
                | Self::VarGlobal
                | Self::VarExternal
                | Self::EndVar
                | Self::EndType
                | Self::EndProgram
                | Self::EndFunction
                | Self::EndFunctionBlock
                | Self::Configuration
                | Self::EndConfiguration
                | Self::Resource
                | Self::EndResource
        )
    }
}
