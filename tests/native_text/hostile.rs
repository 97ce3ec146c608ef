//! Any bytes at all: no panic, no hang, no exhausted stack, and what parses survives printing.

use proptest::prelude::*;
use rand::{Rng, RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use rung::diagnostic::Code;
use rung::engine::{interp::Interpreter, jit::Jit};
use rung::frontend::native::{self, MAXIMUM_DEPTH};
use rung::source::Source;
use rung::{check, draw, ladder, lower, opt};
use rung_runtime::Scan;

use super::{parse, parse_well, print_and_check};

/// The body of a fuzz target: reads bytes as a file would be read. A program without errors survives printing.
fn fuzz(bytes: &[u8]) {
    let source = match Source::decode("fuzz.rung", bytes) {
        Ok(source) => source,
        Err(undecoded) => undecoded.0,
    };
    let parsed = native::parse(&source);
    for diagnostic in &parsed.diagnostics {
        assert!(source.text().get(diagnostic.span.range()).is_some(), "{diagnostic:?}");
    }
    // A program with errors prints somehow too.
    let text = native::print(&parsed.program);
    draw::text(&parsed.program, &draw::TextOptions::default());
    if parsed.diagnostics.is_empty() {
        print_and_check(&parsed.program);
        run(&source, &parsed.program);
    } else {
        native::parse(&Source::new("fuzz.rung", text));
    }
}

/// A program that checks leaves the same image in the interpreter and compiled, whatever its inputs.
fn run(source: &Source, program: &ladder::Program) {
    let (Some(checked), _) = check::check(program) else { return };
    let Ok(lowered) = lower::lower(&checked, source, None) else { return };
    if lowered.layout.size() > 1 << 16 {
        return;
    }
    let mut interpreter = Interpreter::new(&lowered);
    let optimised = opt::optimise(lowered);
    let mut compiled = Jit::compile(&optimised).expect("what checks compiles");
    let layout = &optimised.layout;
    let (mut left, mut right) = (layout.initial_image(), layout.initial_image());
    let mut random = Pcg64Mcg::seed_from_u64(4);
    for scan in 0..5 {
        for run in layout.inputs() {
            let bytes = run.bytes.start as usize..run.bytes.end as usize;
            random.fill_bytes(&mut left[bytes.clone()]);
            left[run.bools.start as usize..run.bools.end as usize].iter_mut().for_each(|bool| *bool &= 1);
            right[bytes.clone()].copy_from_slice(&left[bytes]);
        }
        let now = scan * 70_000_000;
        interpreter.scan(&mut left, now);
        compiled.scan(&mut right, now);
        assert!(left == right, "the engines differ in scan {scan} of\n{}", source.text());
    }
}

const TOKENS: &[&str] = &[
    "program",
    "input",
    "output",
    "var",
    "const",
    "rung",
    "rung\n",
    "rung off",
    "off",
    "retain",
    "at",
    "a",
    "b",
    "t1",
    "S",
    "R",
    "TON",
    "`x y`",
    "größe",
    "\"title\"",
    "(",
    ")",
    "[",
    "]",
    "{",
    "}",
    "|",
    "/",
    "^",
    ":",
    ":=",
    "=>",
    ",",
    ".",
    "=",
    "<>",
    "<",
    "<=",
    ">",
    ">=",
    ">>",
    "+",
    "-",
    "*",
    "&",
    "AND",
    "OR",
    "NOT",
    "MOD",
    "TRUE",
    "1",
    "16#F",
    "1.5",
    "T#1s",
    "INT#-1",
    "%IX0.3",
    "%MW3",
    ">n>",
    "-- c\n",
    "\n-- own\n",
    "\n",
    " ",
    " ",
    "a (b)",
    "[ a | b ]",
    "t1(PT := 1)",
    "{a > 1}",
    ";",
    "\u{a0}",
    "global",
    "type",
    "struct",
    "end_struct",
    "array [",
    "..",
    "of",
    "registers(",
    "task",
    "with",
    "function",
    "function_block",
    "inout",
    "temp",
    "program p : q",
    "IF a THEN",
    "ELSIF",
    "ELSE",
    "END_IF",
    "CASE x OF",
    "END_CASE",
    "FOR i := 1 TO",
    "DO",
    "END_FOR",
    "WHILE",
    "END_WHILE",
    "EXIT",
    "RETURN",
    "a := 1;",
    "f(a, x := 1, Q => b);",
    "colour#red",
    "a[1]",
    "8(0)",
];

const EXAMPLE: &str = include_str!("example.rung");

/// A sound program with all that a mutation may meet: units, tasks, arrays, structures, statements and registers.
const PLANT: &str = include_str!("plant.rung");

/// A word, a number or one sign of a text, with its place.
fn words(text: &str) -> Vec<&str> {
    let mut words: Vec<&str> = Vec::new();
    let mut rest = text;
    while let Some(first) = rest.chars().next() {
        let part_of_word = |c: char| c.is_alphanumeric() || c == '_';
        let end = if part_of_word(first) { rest.find(|c| !part_of_word(c)) } else { Some(first.len_utf8()) };
        let (word, behind) = rest.split_at(end.unwrap_or(rest.len()));
        words.push(word);
        rest = behind;
    }
    words
}

#[test]
fn a_plant_with_words_exchanged_runs_alike_on_all_engines_if_it_checks() {
    let budget: u64 = std::env::var("RUNG_MUTATIONS").ok().and_then(|text| text.parse().ok()).unwrap_or(400);
    fuzz(PLANT.as_bytes());
    let sound = check::check(&parse_well(PLANT)).0;
    assert!(sound.is_some(), "the plant itself checks");
    let pool = words(PLANT);
    for seed in 0..budget {
        let mut random = Pcg64Mcg::seed_from_u64(seed);
        let mut mutated = pool.clone();
        for _ in 0..random.random_range(1..4) {
            let at = random.random_range(0..mutated.len());
            match random.random_range(0..8) {
                0 => drop(mutated.remove(at)),
                1 => mutated.insert(at, pool[random.random_range(0..pool.len())]),
                2 => mutated[at] = TOKENS[random.random_range(0..TOKENS.len())],
                // Of words only, so that more of what comes out still is a program.
                _ => {
                    let is_word = |word: &str| word.chars().all(char::is_alphanumeric);
                    let other = pool[random.random_range(0..pool.len())];
                    if is_word(mutated[at]) && is_word(other) {
                        mutated[at] = other;
                    }
                }
            }
        }
        fuzz(mutated.concat().as_bytes());
    }
}

#[test]
fn random_bytes_do_no_harm() {
    let mut random = Pcg64Mcg::seed_from_u64(1);
    for _ in 0..2000 {
        let length = random.random_range(0..200);
        let mut bytes = vec![0; length];
        random.fill_bytes(&mut bytes);
        fuzz(&bytes);
        // Almost all random bytes are no text at all; these are.
        bytes.iter_mut().for_each(|byte| *byte &= 0x7f);
        fuzz(&bytes);
    }
}

#[test]
fn random_tokens_do_no_harm() {
    let mut random = Pcg64Mcg::seed_from_u64(2);
    for round in 0..6000 {
        let mut text = String::new();
        if round % 2 == 0 {
            text.push_str("rung\n");
        }
        for _ in 0..random.random_range(0..30) {
            text.push_str(TOKENS[random.random_range(0..TOKENS.len())]);
            if random.random_bool(0.8) {
                text.push(' ');
            }
        }
        fuzz(text.as_bytes());
    }
}

#[test]
fn mutations_of_a_valid_program_do_no_harm() {
    assert_eq!(parse(EXAMPLE).1, []);
    let mut random = Pcg64Mcg::seed_from_u64(3);
    for _ in 0..1000 {
        let mut bytes = EXAMPLE.as_bytes().to_vec();
        for _ in 0..random.random_range(1..4) {
            let at = random.random_range(0..bytes.len());
            let to = (at + random.random_range(0..8usize)).min(bytes.len());
            let token = TOKENS[random.random_range(0..TOKENS.len())].bytes();
            match random.random_range(0..4) {
                0 => drop(bytes.drain(at..to)),
                1 => drop(bytes.splice(at..at, token)),
                2 => drop(bytes.splice(at..to, token)),
                _ => bytes[at] = random.random(),
            }
        }
        fuzz(&bytes);
    }
}

#[test]
fn comments_anywhere_survive() {
    let mut random = Pcg64Mcg::seed_from_u64(4);
    let gaps: Vec<usize> = EXAMPLE.match_indices([' ', '\n']).map(|(at, _)| at).collect();
    for _ in 0..1000 {
        let mut places: Vec<usize> =
            (0..random.random_range(1..6)).map(|_| gaps[random.random_range(0..gaps.len())]).collect();
        places.sort_unstable();
        let mut text = EXAMPLE.to_owned();
        for at in places.into_iter().rev() {
            text.insert_str(at, if random.random_bool(0.5) { " -- behind\n" } else { "\n-- alone\n" });
        }
        fuzz(text.as_bytes());
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 500, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn any_text_does_no_harm(text in "\\PC*") {
        fuzz(text.as_bytes());
    }
}

#[test]
fn nesting_is_read_to_the_limit_and_no_deeper() {
    let kinds: [(&str, &str, &str); 8] = [
        ("", "[ ", "] "),
        ("", "b(x := [ ", "]) "),
        ("{a := ", "(", ")"),
        ("{a := ", "NOT ", ""),
        ("{a := ", "-", ""),
        ("{a := ", "1 + (", ")"),
        ("{a := ", "f(a, ", ")"),
        ("{a := ", "a[", "]"),
    ];
    for (before, open, close) in kinds {
        // The last operand is a level of its own, and so is each sum.
        let deepest = MAXIMUM_DEPTH - usize::from(!before.is_empty());
        let nested = |depth: usize| {
            let inner = if before.is_empty() { "a " } else { "2" };
            let after = if before.is_empty() { "" } else { "}" };
            let open = if open == "-" { "- " } else { open };
            format!("rung r1\n{before}{}{inner}{}{after}\nrung r2\na", open.repeat(depth), close.repeat(depth))
        };
        print_and_check(&parse_well(&nested(deepest)));
        let codes = |text: &str| parse(text).1.iter().map(|diagnostic| diagnostic.code).collect::<Vec<_>>();
        assert_eq!(codes(&nested(MAXIMUM_DEPTH + 1)), [Code::TooDeep], "{open}");
        // More would be more tokens than a text may have.
        for depth in [100_000, 400_000] {
            let (program, diagnostics) = parse(&nested(depth));
            let codes: Vec<_> = diagnostics.iter().map(|diagnostic| diagnostic.code).collect();
            assert_eq!(codes, [Code::TooDeep], "{open}");
            assert_eq!(program.units[0].rungs.len(), 2, "{open}: reading goes on behind what is too deep");
        }
        let unclosed = open.replace("- ", "-").repeat(100_000);
        assert_eq!(codes(&format!("rung\n{before}{unclosed}")).len(), 1, "{open}");
    }
}

#[test]
fn statements_and_initial_values_nest_to_the_limit_and_no_deeper() {
    let kinds = [
        ("rung\n{", "IF a THEN ", "b := 1; ", "END_IF; ", "}\nrung\na"),
        ("rung\n{", "IF a THEN ELSE ", "b := 1; ", "END_IF; ", "}\nrung\na"),
        ("rung\n{", "CASE a OF 1: ", "b := 1; ", "END_CASE; ", "}\nrung\na"),
        ("rung\n{", "FOR a := 1 TO 2 DO ", "b := 1; ", "END_FOR; ", "}\nrung\na"),
        ("var a := ", "[", "", "]", "\nrung\na\nrung\na"),
        ("var a := [2", "(2 + (", "1", "))", "]\nrung\na\nrung\na"),
        ("var a := ", "(x := ", "1", ")", "\nrung\na\nrung\na"),
    ];
    for (before, open, inner, close, after) in kinds {
        let nested = |depth: usize| format!("{before}{}{inner}{}{after}", open.repeat(depth), close.repeat(depth));
        print_and_check(&parse_well(&nested(MAXIMUM_DEPTH / 2 - 1)));
        for depth in [MAXIMUM_DEPTH + 1, 100_000] {
            let (program, diagnostics) = parse(&nested(depth));
            let codes: Vec<_> = diagnostics.iter().map(|diagnostic| diagnostic.code).collect();
            assert_eq!(codes, [Code::TooDeep], "{open}");
            assert!(!program.units[0].rungs.is_empty(), "{open}: reading goes on behind what is too deep");
        }
        let codes = |text: &str| parse(text).1.iter().map(|diagnostic| diagnostic.code).collect::<Vec<_>>();
        assert!(!codes(&format!("{before}{}", open.repeat(100_000))).is_empty(), "{open}");
        assert!(!codes(&format!("{before}{}", close.repeat(100_000))).is_empty(), "{close}");
    }
}

#[test]
fn closing_brackets_alone_do_no_harm() {
    for close in [")", "]", "}"] {
        let (_, diagnostics) = parse(&format!("rung\n{}", close.repeat(100_000)));
        assert_eq!(diagnostics.len(), 1);
    }
}

#[test]
fn long_chains_of_operators_are_limited_and_long_series_are_not() {
    let sum = |terms: usize| format!("rung\n{{a := 1{}}} (b)", " + 1".repeat(terms));
    print_and_check(&parse_well(&sum(MAXIMUM_DEPTH - 1)));
    for terms in [MAXIMUM_DEPTH, 1_000_000] {
        let (program, diagnostics) = parse(&sum(terms));
        assert_eq!(diagnostics.iter().map(|diagnostic| diagnostic.code).collect::<Vec<_>>(), [Code::TooDeep]);
        assert_eq!(program.units[0].rungs[0].circuit.branches[0].elements.len(), 2);
    }
    let series = parse_well(&format!("rung\n{}", "a ".repeat(100_000)));
    assert_eq!(series.units[0].rungs[0].circuit.branches[0].elements.len(), 100_000);
    let arguments = parse_well(&format!("rung\n{{f({}a)}}", "a, ".repeat(100_000)));
    print_and_check(&arguments);
    let branches = parse_well(&format!("rung\n{}", "| ".repeat(100_000)));
    assert_eq!(branches.units[0].rungs[0].circuit.branches.len(), 100_001);
    let members = parse_well(&format!("rung\na{}", ".b".repeat(100_000)));
    assert_eq!(members.units[0].rungs.len(), 1);
}

#[test]
fn clauses_behind_many_names_do_not_multiply() {
    let names = vec!["a"; 50_000].join(",");
    let initial = vec!["(1)"; 50_000].join("=");
    let (_, diagnostics) = parse(&format!("var {names} : {}", "t".repeat(50_000)));
    assert_eq!(diagnostics.iter().map(|diagnostic| diagnostic.code).collect::<Vec<_>>(), [Code::FileTooLarge]);
    let (_, diagnostics) = parse(&format!("var {names} := {initial}"));
    assert!(diagnostics.iter().any(|diagnostic| diagnostic.code == Code::FileTooLarge));
    assert_eq!(parse_well(&format!("var {names} : BOOL")).units[0].variables.len(), 50_000);
}

/// 50 MB, or a tenth of it where the compiler has not optimised.
#[test]
fn a_large_file_is_read_whole() {
    let size = if cfg!(debug_assertions) { 5_000_000 } else { 50_000_000 };
    let rung = "rung \"this rung stands here many times, to make the file large\"\n  -- with a comment\n  \
                [ a_contact_of_some_length | another_contact_of_some_length ] /third_contact (and_a_coil_at_the_end)\n";
    let count = size / rung.len();
    let program = parse_well(&rung.repeat(count));
    assert_eq!((program.units[0].rungs.len(), program.comments.len()), (count, count));
    let text = native::print(&program);
    assert!(text.len() > size);
}

#[test]
fn a_large_file_without_any_sense_gives_few_diagnostics() {
    for line in ["rung\n)\n", "\u{1}\n", "\"\n", "`\n", "var 1\n", "rung\n{%}\n"] {
        let (_, diagnostics) = parse(&line.repeat(1_000_000));
        assert_eq!(diagnostics.last().unwrap().code, Code::TooManyDiagnostics, "{line:?}");
    }
}

#[test]
fn marks_breaks_and_nuls_of_other_systems() {
    let crlf = EXAMPLE.replace('\n', "\r\n");
    let marked = Source::decode("x.rung", format!("\u{feff}{crlf}").as_bytes()).unwrap();
    let parsed = native::parse(&marked);
    assert_eq!(parsed.diagnostics, []);
    assert_eq!(native::print(&parsed.program), native::print(&parse_well(EXAMPLE)));

    let (kept, problem) = *Source::decode("x.rung", b"input a\n\0input b").unwrap_err();
    assert_eq!(problem.code, Code::NotText);
    assert_eq!(native::parse(&kept).program.units[0].variables.len(), 1);
    let (_, diagnostics) = parse("input a\n\0");
    assert_eq!(diagnostics[0].code, Code::UnexpectedCharacter);

    // A byte order mark in the middle is no blank.
    assert_eq!(parse("input \u{feff}a").1[0].code, Code::UnexpectedCharacter);
    let title = parse_well("rung \"a\"\r\n  a\r\n").units[0].rungs.remove(0);
    assert_eq!(title.title.as_deref(), Some("a"));
}
