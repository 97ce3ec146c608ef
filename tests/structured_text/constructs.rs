//! What files of structured text become.

use rung::diagnostic::Code;
use rung::frontend::{native, structured_text};
use rung::source::{Source, Span};

/// The native form of a text, and the codes of what was said about it.
fn read(text: &str) -> (String, Vec<Code>) {
    let parsed = rung::frontend::parse(&Source::new("test.st", text));
    (native::print(&parsed.program), parsed.diagnostics.iter().map(|problem| problem.code).collect())
}

fn codes_of(declarations: &str, statements: &str) -> Vec<Code> {
    read(&format!("PROGRAM p\nVAR a, b : BOOL; x : INT; {declarations} END_VAR\n{statements}\nEND_PROGRAM")).1
}

#[test]
fn a_generated_file_checks_and_becomes_the_program_that_its_ladder_was() {
    let source = Source::new("generated.st", include_str!("fixtures/generated.st"));
    let parsed = rung::frontend::parse(&source);
    assert_eq!(parsed.diagnostics, []);
    let (checked, problems) = rung::check::check(&parsed.program);
    assert!(checked.is_some(), "{}", rung::diagnostic::render(&source, &problems));
    let native = native::print(&parsed.program);
    for part in [
        "rung \"seal-in: stop wins\"\n  {pump := NOT stop AND (start OR pump)}",
        "var    total          : DINT retain",
        "type mode : (idle, filling, draining := 7)",
        "global limit : INT := 90",
        "task task0(interval := T#20ms, priority := 0)",
        "program instance0 : station with task0",
    ] {
        assert!(native.contains(part), "{part}\n{native}");
    }
}

#[test]
fn a_function_that_is_not_enabled_gives_the_default_of_its_type() {
    let text = "PROGRAM p\nVAR a, e : BOOL; t : TIME; END_VAR\nt := ADD(EN := a, IN1 := t, IN2 := T#1s, ENO => e);\nEND_PROGRAM";
    let (native, codes) = read(text);
    assert_eq!(codes, []);
    let expected = "\
  { IF a THEN
      ADD(OUT => t, IN1 := t, IN2 := T#1s, ENO => e);
    ELSE
      t := T#0s;
      e := FALSE;
    END_IF;
  }";
    assert!(native.contains(expected), "{native}");
}

#[test]
fn what_rung_has_not_is_one_error_a_kind() {
    assert_eq!(codes_of("s, t : STRING[20]; u : STRING := 'x';", ""), [Code::NotSupported]);
    assert_eq!(codes_of("p : POINTER TO INT;", ""), [Code::NotSupported]);
    assert_eq!(codes_of("", "WHILE a DO b := a; END_WHILE;\nb := a;"), [Code::UnboundedLoop]);
    assert_eq!(codes_of("", "REPEAT b := a; UNTIL a END_REPEAT;"), [Code::UnboundedLoop]);
    assert_eq!(codes_of("", "LD a\nST b"), [Code::NotSupported]);
    assert_eq!(codes_of("", "INITIAL_STEP s: END_STEP"), [Code::NotSupported]);
}

#[test]
fn an_error_costs_its_statement_or_declaration() {
    let (native, codes) = read("PROGRAM p\nVAR a : BOOL; b BOOL; c : BOOL; END_VAR\na := ;\nc := a;\nEND_PROGRAM");
    assert_eq!(codes, [Code::UnexpectedToken; 2]);
    assert!(native.contains("{c := a}") && native.contains("var    c : BOOL"), "{native}");
}

#[test]
fn what_is_open_and_unknown_is_named() {
    assert_eq!(read("PROGRAM p\nVAR a : BOOL;\na := TRUE;\nEND_PROGRAM").1.first(), Some(&Code::UnexpectedToken));
    let external = "PROGRAM p\nVAR_EXTERNAL g : INT; END_VAR\ng := 1;\nEND_PROGRAM";
    assert_eq!(read(external).1, [Code::UndeclaredName]);
    let idle = "PROGRAM p\nVAR a : BOOL; END_VAR\na := TRUE;\nEND_PROGRAM\nCONFIGURATION c\nRESOURCE r ON x\nEND_RESOURCE\nEND_CONFIGURATION";
    assert_eq!(read(idle).1, [Code::UnusedName]);
}

#[test]
fn a_body_of_another_format_has_its_places_there() {
    let scope = structured_text::Scope { types: &[], globals: &[], variables: &[], result: None };
    let body = structured_text::body("(* why *)\na := b;\nc := ;", &scope, &|span| Span {
        start: span.start + 100,
        end: span.end + 100,
    });
    assert_eq!(body.rungs.len(), 1);
    assert_eq!(body.rungs[0].title.as_deref(), Some("why"));
    assert_eq!(body.rungs[0].span, Span::new(110, 116));
    let places: Vec<_> = body.diagnostics.iter().map(|problem| (problem.code, problem.span.start)).collect();
    assert_eq!(places, [(Code::UnexpectedToken, 123)]);
}
