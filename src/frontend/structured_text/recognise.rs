//! Whether a text is structured text. Rung's own text begins with the same words, so that signs and words decide that only one
//! of the two has.

use crate::frontend::text::lexer::Lexer;
use crate::frontend::text::token::{Dialect, Keyword, Kind, keyword};

/// Whether a text looks like structured text. It reads up to the first sign that decides, in real files within the first
/// declaration.
pub fn recognises(text: &str) -> bool {
    let mut lexer = Lexer::new(text, Dialect::StructuredText);
    let mut token = lexer.token();
    let mut commented = false;
    while token.kind == Kind::Comment {
        commented = true;
        token = lexer.token();
    }
    use Keyword as K;
    match token.kind {
        Kind::Keyword(K::Configuration | K::VarGlobal) => return true,
        Kind::Keyword(K::Program | K::Function | K::FunctionBlock | K::Type) => {}
        // A file of nothing but comments is structured text if they are those of structured text.
        Kind::End => return commented,
        _ => return false,
    }
    let mut before = token;
    loop {
        token = lexer.token();
        match token.kind {
            Kind::Semicolon => return true,
            Kind::End => return false,
            // A comment of the native text.
            Kind::Minus if before.kind == Kind::Minus && before.span.end == token.span.start => return false,
            // `input start`: a declaration of the native text. In structured text a sign follows a name.
            Kind::Name | Kind::Text if before.kind == Kind::Name && before.first_on_line => {
                let word = text.get(before.span.range()).unwrap_or("");
                if keyword(word, Dialect::Native).is_some() {
                    return false;
                }
            }
            Kind::Keyword(found) if found.is_of_structured_text_alone() => return true,
            _ => {}
        }
        before = token;
    }
}

#[cfg(test)]
mod tests {
    use super::recognises;

    #[test]
    fn texts_of_both_languages_are_told_apart_by_what_only_one_has() {
        let structured = [
            "PROGRAM p VAR a : BOOL; END_VAR a := TRUE; END_PROGRAM",
            "(* made by a tool *)\nprogram p\nvar_input\n  input : BOOL;\nend_var\nend_program",
            "{attribute 'x'} // c\nFUNCTION f : INT f := 1; END_FUNCTION",
            "TYPE colour : (red, green); END_TYPE",
            "CONFIGURATION c END_CONFIGURATION",
            "program p\nvar\n  output : BOOL;\nend_var\nend_program",
            "(* nothing *)",
        ];
        let native = [
            "",
            "program p\ninput a\noutput o\nrung\n  a (o)\n",
            "program p\n-- a; b\nvar x : INT\nrung\n  {x := 1; x := 2;}\n",
            "type colour : (red, green)\nprogram p\nrung \"a; b\"\n  (o)\n",
            "function f : INT\n  input x : INT\nrung  {f := x}\n",
            "rung  a (o);",
            "<?xml version='1.0'?>",
        ];
        assert_eq!(structured.map(recognises), [true; 7]);
        assert_eq!(native.map(recognises), [false; 7]);
    }
}
