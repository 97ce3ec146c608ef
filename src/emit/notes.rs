//! What comments say beside the program: what a person wrote in the source, which logic does not know.
//!
//! Nothing here may change what is computed: without notes the same code comes out with shorter comments.

use std::collections::BTreeMap;

/// What is known of a source beyond its logic; empty where nothing is.
#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub struct Notes {
    /// The name of the source file; empty where there is none.
    pub source: String,
    /// The titles of rungs, by the line of the source, from 1, in which the rung starts.
    pub titles: BTreeMap<u32, String>,
    /// What is said of declared variables, by their names in lower case.
    pub declarations: BTreeMap<String, Declaration>,
}

/// What is said of a variable where it is declared.
#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub struct Declaration {
    /// Its address as it is written, such as `%QX0.3`; empty where it has none.
    pub address: String,
    /// The comment beside it; empty where there is none.
    pub comment: String,
}

impl Notes {
    /// What is said of the variable that a slot's name starts with.
    pub(super) fn declaration(&self, name: &str) -> Option<&Declaration> {
        self.declarations.get(&name.to_ascii_lowercase())
    }
}

/// A text as it may stand in a comment of C, on its line: nothing that ends or starts a comment, no trigraph, and nothing
/// that an editor would obey instead of showing it.
pub(super) fn comment(text: &str) -> String {
    let shown = |character: char| {
        let harmless = character.is_alphanumeric() || character.is_ascii_graphic() || character == ' ';
        if harmless { character } else { ' ' }
    };
    let mut comment = String::new();
    for character in text.chars().map(shown) {
        let joins = match comment.chars().last() {
            Some('*') => character == '/',
            Some('/') => character == '*' || character == '/',
            Some('?') => character == '?',
            _ => false,
        };
        if joins {
            comment.push(' ');
        }
        comment.push(character);
    }
    // A backslash at the end would join the next line.
    if comment.ends_with('\\') {
        comment.push(' ');
    }
    comment
}

#[cfg(test)]
mod tests {
    use super::comment;

    #[test]
    fn a_comment_neither_ends_nor_starts_another_and_holds_no_trigraph() {
        assert_eq!(comment("a */ b /* c // d ??/ e \\"), "a * / b / * c / / d ? ?/ e \\ ");
        assert_eq!(comment("two\nlines\u{202e}\tö"), "two lines  ö");
        assert_eq!(comment("*/*/"), "* / * /");
    }
}
