//! Any bytes at all: no panic, no hang, no exhausted stack.

use rand::{Rng, RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use rung::diagnostic::Code;
use rung::frontend::structured_text;
use rung::source::Source;

/// The body of a fuzz target: reads a text as a file would be read, whatever it looks like, and writes what came of it.
fn fuzz(text: &str) -> Vec<Code> {
    let source = Source::new("fuzz.st", text);
    structured_text::recognises(text);
    let parsed = structured_text::parse(&source);
    for diagnostic in &parsed.diagnostics {
        assert!(source.text().get(diagnostic.span.range()).is_some(), "{diagnostic:?}");
    }
    // A program with errors is written or refused, too.
    let _ = structured_text::print(&parsed.program);
    parsed.diagnostics.iter().map(|problem| problem.code).collect()
}

const WORDS: &[&str] = &[
    "PROGRAM p",
    "END_PROGRAM",
    "FUNCTION f : INT",
    "END_FUNCTION",
    "FUNCTION_BLOCK b",
    "END_FUNCTION_BLOCK",
    "TYPE",
    "END_TYPE",
    "STRUCT",
    "END_STRUCT",
    "VAR",
    "VAR_INPUT",
    "VAR_EXTERNAL",
    "VAR_GLOBAL",
    "END_VAR",
    "RETAIN",
    "AT %IX0.0",
    "CONFIGURATION c",
    "END_CONFIGURATION",
    "RESOURCE r ON x",
    "END_RESOURCE",
    "TASK t(INTERVAL := T#1s)",
    "IF",
    "THEN",
    "ELSIF",
    "ELSE",
    "END_IF",
    "CASE",
    "OF",
    "END_CASE",
    "FOR",
    "TO",
    "DO",
    "END_FOR",
    "WHILE",
    "END_WHILE",
    "REPEAT",
    "METHOD",
    "STEP",
    "LD",
    "a",
    "b",
    "x.y",
    ":",
    ":=",
    "=>",
    ";",
    ",",
    "(",
    ")",
    "[",
    "]",
    "{",
    "}",
    "(*",
    "*)",
    "//",
    "'",
    "\"",
    "1",
    "2#1",
    "T#1s",
    "+",
    "-",
    "NOT",
    "AND",
    "ADD(EN := a, IN1 := 1, ENO => b)",
    "INT (0..9)",
    "STRING[3]",
    "POINTER TO",
    "EXIT",
    "RETURN",
    "\n",
    "é",
    "\u{0}",
];

#[test]
fn random_words_do_no_harm() {
    let mut random = Pcg64Mcg::seed_from_u64(4);
    for _ in 0..3000 {
        let count = random.random_range(1..60);
        let words: Vec<&str> = (0..count).map(|_| WORDS[random.random_range(0..WORDS.len())]).collect();
        fuzz(&words.join(" "));
    }
}

#[test]
fn a_file_that_is_cut_or_has_a_wrong_byte_does_no_harm() {
    let text = include_str!("fixtures/generated.st");
    let mut random = Pcg64Mcg::seed_from_u64(5);
    for _ in 0..300 {
        let mut bytes = text.as_bytes().to_vec();
        bytes.truncate(random.random_range(0..bytes.len()));
        for _ in 0..random.random_range(0..4) {
            let at = random.random_range(0..bytes.len().max(1));
            if let Some(byte) = bytes.get_mut(at) {
                *byte = u8::try_from(random.next_u32() & 0x7f).unwrap_or(0);
            }
        }
        fuzz(&String::from_utf8_lossy(&bytes));
    }
}

#[test]
fn what_nests_too_deeply_or_does_not_end_is_one_error() {
    let body = |statements: &str| format!("PROGRAM p VAR a : BOOL; END_VAR\n{statements}\nEND_PROGRAM");
    let deep = 100_000;
    let parentheses = body(&format!("a := {}a{};", "(".repeat(deep), ")".repeat(deep)));
    assert_eq!(fuzz(&parentheses), [Code::TooDeep]);
    let conditions = body(&format!("{}{}", "IF a THEN ".repeat(deep), "END_IF; ".repeat(deep)));
    assert_eq!(fuzz(&conditions), [Code::TooDeep]);
    assert_eq!(fuzz(&"(* ".repeat(deep)), [Code::Unclosed]);
    assert!(fuzz(&body(&format!("a := a{};", " AND a".repeat(deep)))).contains(&Code::TooDeep));
    assert_eq!(fuzz(&body(&"a := NOT a;\n".repeat(deep))), []);
}
