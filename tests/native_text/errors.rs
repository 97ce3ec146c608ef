//! What each mistake is called, on which line, and that reading goes on behind it.

use rung::diagnostic::Code::{self, *};
use rung::frontend::native::MOST_DIAGNOSTICS;
use rung::source::Source;

use super::parse;

/// The codes and lines that a text gives.
fn findings(text: &str) -> Vec<(Code, usize)> {
    let source = Source::new("test.rung", text);
    parse(text).1.iter().map(|diagnostic| (diagnostic.code, source.line(diagnostic.span.start))).collect()
}

#[test]
fn every_mistake_has_its_code_and_line() {
    let cases: &[(&str, &[(Code, usize)])] = &[
        // The file.
        ("pump (motor)", &[(UnexpectedToken, 1)]),
        ("input a\nprogram p", &[(UnexpectedToken, 2)]),
        ("program p\nprogram q : r\nprogram s", &[(UnexpectedToken, 3)]),
        ("program", &[(UnexpectedToken, 1)]),
        ("program rung", &[(UnexpectedToken, 1)]),
        ("rung\na\ninput a", &[(UnexpectedToken, 3)]),
        ("input a\n;\nvar b", &[(UnexpectedToken, 2)]),
        ("input a\n!!\u{7}\u{7} ~\nvar b", &[(UnexpectedCharacter, 2), (UnexpectedCharacter, 2)]),
        ("rung\na\nfunction_block f", &[(UnexpectedToken, 3)]),
        (
            "task t\nglobal a\nregisters()\ntype t : INT",
            &[(UnexpectedToken, 2), (UnexpectedToken, 3), (UnexpectedToken, 4)],
        ),
        ("registers()\nregisters()", &[(DuplicateClause, 2)]),
        ("registers(hreg)\nregisters", &[(UnexpectedToken, 1), (UnexpectedToken, 2)]),
        ("task t(interval := 1ms, interval := 2ms,\nphase := 1)", &[(DuplicateClause, 1), (UnexpectedToken, 2)]),
        ("program p with", &[(UnexpectedToken, 1)]),
        ("program p : q\nvar a", &[(UnexpectedToken, 2)]),
        ("function f :", &[(UnexpectedToken, 1)]),
        // Types.
        (
            "type\ntype t\ntype t :\ntype `t` : (",
            &[(UnexpectedToken, 2), (UnexpectedToken, 3), (UnexpectedToken, 4), (UnexpectedToken, 4)],
        ),
        ("type t : (a b)", &[(UnexpectedToken, 1)]),
        ("type t : (a,\nvar b", &[(UnexpectedToken, 2)]),
        ("type t : struct x end_struct", &[(UnexpectedToken, 1)]),
        ("type t : struct x : INT\nvar b", &[(UnexpectedToken, 2)]),
        (
            "var a : array\nvar b : array [1]\nvar c : array [1..2] INT",
            &[(UnexpectedToken, 2), (UnexpectedToken, 2), (UnexpectedToken, 3)],
        ),
        (
            "var a := [1, 2\nvar b := [1 2]\nvar c := [2(3, 4)]",
            &[(Unclosed, 1), (UnexpectedToken, 2), (UnexpectedToken, 3)],
        ),
        ("var a := (x := 1, 2)\nvar b := (x := 1, y)", &[(UnexpectedToken, 1), (UnexpectedToken, 2)]),
        // Declarations.
        ("input", &[(UnexpectedToken, 1)]),
        ("input a,", &[(UnexpectedToken, 1)]),
        ("input a b", &[(UnexpectedToken, 1)]),
        ("input a :", &[(UnexpectedToken, 1)]),
        ("var a : INT\n: INT", &[(DuplicateClause, 2)]),
        (
            "var a retain\nretain\n:= 1 := 2\nat %MW1 at %MW2",
            &[(DuplicateClause, 2), (DuplicateClause, 3), (DuplicateClause, 4)],
        ),
        ("var a at 5", &[(UnexpectedToken, 1)]),
        ("var a at %ZX1", &[(BadAddress, 1)]),
        ("var a at %IX", &[(BadAddress, 1)]),
        ("var a at %I*", &[(BadAddress, 1), (UnexpectedToken, 1)]),
        ("var a at %IX1.4294967296", &[(BadAddress, 1)]),
        ("var a at %IX1x", &[(BadAddress, 1)]),
        ("var a at %", &[(BadAddress, 1)]),
        ("var a = 5", &[(UnexpectedToken, 1)]),
        ("var input : BOOL", &[(UnexpectedToken, 1), (UnexpectedToken, 1)]),
        ("var `a : BOOL\nvar b", &[(Unclosed, 1)]),
        ("var `` : BOOL", &[(UnexpectedToken, 1)]),
        // Literals.
        ("var a := 340282366920938463463374607431768211456", &[(BadLiteral, 1)]),
        ("var a := 2#12 + 7#1 + 16#G + 16#", &[(BadLiteral, 1); 4]),
        ("var a := 1__0 + 1_ + 10ms + 1e5", &[(BadLiteral, 1); 4]),
        ("var a := 1.0e999 + 1.2.3 + INT#1.5 + REAL#16#F + 1.5e", &[(BadLiteral, 1); 5]),
        ("var a := T# + T#5 + T#1s1m + T#1s1s + T#1.5m1s + T#1w", &[(BadLiteral, 1); 6]),
        ("var a := T#0.5ns + T#9223372036854775808ns + T#106752d + FOO#1 + TIME#", &[(BadLiteral, 1); 5]),
        ("var a := w.256 + w.3b", &[(BadLiteral, 1); 2]),
        ("rung r1 \"a $ b\"\na", &[(BadLiteral, 1)]),
        // Rungs.
        ("rung r1 a (b)", &[(UnexpectedToken, 1)]),
        ("rung\n\"late\" \"later\"", &[(UnexpectedToken, 2)]),
        ("rung \"open\na", &[(Unclosed, 1)]),
        ("rung\n]", &[(UnexpectedToken, 2)]),
        ("rung\na )", &[(UnexpectedToken, 2)]),
        ("rung\n[ a | b\nrung\na", &[(Unclosed, 2)]),
        ("rung\n[ a | b )", &[(Unclosed, 2)]),
        ("rung\n(a", &[(Unclosed, 2)]),
        ("rung\n(a b)", &[(UnexpectedToken, 2)]),
        ("rung\n()", &[(UnexpectedToken, 2)]),
        ("rung\n(* comment *)", &[(UnexpectedToken, 2)]),
        ("rung\n// comment", &[(UnexpectedToken, 2)]),
        ("rung\n{a", &[(Unclosed, 2)]),
        ("rung\n{}", &[(UnexpectedToken, 2)]),
        ("rung\n{a b}", &[(UnexpectedToken, 2)]),
        ("rung\n{1 := 2}", &[(UnexpectedToken, 2)]),
        ("rung\n{a := }", &[(UnexpectedToken, 2)]),
        ("rung\n{a := 1;\nb := 2}", &[(UnexpectedToken, 3)]),
        ("rung\n{a > 1;}", &[(UnexpectedToken, 2)]),
        (
            "rung\n{a := 1;\nb > 2;\nc := ;\nd := 4;\nt1(;\n}",
            &[(UnexpectedToken, 3), (UnexpectedToken, 4), (UnexpectedToken, 6)],
        ),
        (
            "rung\n{IF a\nb := 1; ELSE c := ;\nEND_IF; FOR TO\nEND_FOR; d := ;}",
            &[(UnexpectedToken, 3), (UnexpectedToken, 4), (UnexpectedToken, 5)],
        ),
        (
            "rung\n{IF a THEN b := ;\nELSIF c d\nEND_IF; e := ;}",
            &[(UnexpectedToken, 2), (UnexpectedToken, 3), (UnexpectedToken, 4)],
        ),
        ("rung\n{IF a THEN b := 1;}", &[(UnexpectedToken, 2)]),
        ("rung\n{END_IF;\nb := ;}", &[(UnexpectedToken, 2)]),
        ("rung\n{b := 1; END_IF;\nb := ;}", &[(UnexpectedToken, 2), (UnexpectedToken, 3)]),
        (
            "rung\n{CASE a OF 1 b := 1;\nEND_CASE;\nCASE a OF 1: b; END_CASE;}",
            &[(UnexpectedToken, 2), (UnexpectedToken, 4)],
        ),
        (
            "rung\n{a := 1;\nWHILE a < 5 DO a := a + 1; END_WHILE;\nREPEAT IF a THEN b := 1; END_IF; UNTIL a END_REPEAT; c := ;}",
            &[(UnboundedLoop, 3), (UnboundedLoop, 4), (UnexpectedToken, 4)],
        ),
        ("rung\n{f(x => y)}", &[(UnexpectedToken, 2)]),
        ("rung\n{f(1 => y);}", &[(UnexpectedToken, 2)]),
        ("rung\n{fb.t1(x)}", &[(UnexpectedToken, 2)]),
        ("rung\n{ABS(a b)}", &[(UnexpectedToken, 2)]),
        ("rung\n{a[1}", &[(Unclosed, 2)]),
        ("rung\na[]", &[(UnexpectedToken, 2)]),
        ("rung\na[1 2]", &[(UnexpectedToken, 2)]),
        ("rung\na := 1", &[(UnexpectedToken, 2)]),
        ("rung\na > 1", &[(UnexpectedToken, 2)]),
        ("rung\na AND b", &[(UnexpectedToken, 2)]),
        ("rung\n/(a)", &[(UnexpectedToken, 2)]),
        ("rung\na >>", &[(UnexpectedToken, 2)]),
        ("rung\na >> (b)", &[(UnexpectedToken, 2)]),
        ("rung\na >> rung", &[(UnexpectedToken, 2)]),
        ("rung\na >> >> r40", &[(UnexpectedToken, 2)]),
        ("rung\na >x> b", &[(UnexpectedToken, 2)]),
        ("rung\na - b", &[(UnexpectedToken, 2)]),
        ("rung\n- b", &[(UnexpectedToken, 2)]),
        ("rung\nt1:TON", &[(UnexpectedToken, 2)]),
        ("rung\nt1:TON (PT := T#1s) (a)", &[(UnexpectedToken, 2)]),
        ("rung\nt1(T#1s)", &[(UnexpectedToken, 2)]),
        ("rung\nt1(PT T#1s)", &[(UnexpectedToken, 2)]),
        ("rung\nt1(PT := T#1s,)", &[(UnexpectedToken, 2)]),
        ("rung\nt1(PT := T#1s", &[(Unclosed, 2)]),
        ("rung\nt1().3", &[(UnexpectedToken, 2)]),
        ("rung\nt1(Q => 5)", &[(UnexpectedToken, 2)]),
        // One finding an item, and all items.
        (
            "input 1\nrung\n[\nrung\n)\nvar 2",
            &[(UnexpectedToken, 1), (Unclosed, 3), (UnexpectedToken, 5), (UnexpectedToken, 6)],
        ),
    ];
    for (text, expected) in cases {
        assert_eq!(findings(text), *expected, "in\n{text}\n{:#?}", parse(text).1);
    }
}

#[test]
fn what_is_sound_behind_a_mistake_is_read() {
    let (program, diagnostics) =
        parse("program p\ninput 5\ninput a\nrung r1\n[ a ( ]\nrung r2\n{a := 99zz} (b)\nrung r3\na");
    assert_eq!(diagnostics.len(), 3);
    assert_eq!(program.name.text, "p");
    assert_eq!(program.units[0].variables.len(), 1);
    let names: Vec<_> = program.units[0].rungs.iter().map(|rung| rung.name.as_ref().unwrap().text.as_str()).collect();
    assert_eq!(names, ["r2", "r3"]);
    assert_eq!(program.units[0].rungs[0].circuit.branches[0].elements.len(), 2);
}

#[test]
fn mistakes_come_with_help() {
    let cases = [
        ("rung\na := 1", "expected an element, found `:=`", "an assignment stands in braces: {name := value}"),
        ("rung\na OR b", "expected an element, found `OR`", "contacts in parallel stand in brackets: [ a | b ]"),
        (
            "rung\n(a b)",
            "expected `)`, found `b`",
            "a coil stands in parentheses: (name), or with S, R, P, N or / before the name",
        ),
        ("var a := 10ms", "`10ms`: `m` is not a digit in base 10", "a duration starts with T#, such as T#10ms"),
        ("var rung", "expected the name of a variable, found `rung`", "`rung` is a name only in back quotes"),
        ("var task", "expected the name of a variable, found `task`", "`task` is a name only in back quotes"),
        ("rung r1 a (b)", "expected a title or a new line", "begin the circuit on the line after `rung`"),
        (
            "var a = 5",
            "expected a clause, another declaration or a rung, found `=`",
            "an initial value is given with :=",
        ),
        ("rung\na;", "expected an element, found `;`", "nothing ends with a semicolon here"),
    ];
    for (text, message, hint) in cases {
        let (_, diagnostics) = parse(text);
        assert_eq!((diagnostics[0].message.as_str(), diagnostics[0].hint.as_deref()), (message, Some(hint)), "{text}");
    }
}

#[test]
fn an_unclosed_bracket_is_shown_with_the_place_where_it_was_missed() {
    let text = "rung\n  [ a\nrung\n  b";
    let (_, diagnostics) = parse(text);
    assert_eq!(diagnostics.len(), 1);
    assert_eq!(&text[diagnostics[0].span.range()], "[");
    assert_eq!(&text[diagnostics[0].related[0].0.range()], "rung");
}

#[test]
fn too_many_mistakes_end_the_reading() {
    let (program, diagnostics) = parse(&format!("{}\nvar good", "var 1\n".repeat(100_000)));
    assert_eq!(diagnostics.len(), MOST_DIAGNOSTICS + 1);
    assert_eq!(diagnostics.last().unwrap().code, TooManyDiagnostics);
    assert_eq!(program.units[0].variables, []);
}
