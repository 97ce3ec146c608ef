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

/// The native form of a text without a fault.
fn sound(text: &str) -> String {
    let parsed = rung::frontend::parse(&Source::new("test.st", text));
    assert!(parsed.diagnostics.iter().all(|found| !found.is_error()), "{:?}", parsed.diagnostics);
    let (checked, found) = rung::check::check(&parsed.program);
    assert!(checked.is_some(), "{found:?}");
    native::print(&parsed.program)
}

#[test]
fn arrays_of_arrays_and_types_that_are_written_out_get_names() {
    let text = "PROGRAM p\nVAR a : ARRAY[0..3] OF ARRAY[1..2] OF INT; s : STRUCT x : INT; y : BOOL; END_STRUCT;\n\
        e : (red, green) := green; i : INT; END_VAR\n\
        FOR i := 0 TO 3 DO a[i][1] := i; END_FOR;\ns.x := a[2][1];\nIF e = green THEN s.y := TRUE; END_IF;\nEND_PROGRAM";
    let native = sound(text);
    for part in [
        "type _TYPE1 : array [1..2] of INT",
        "type _TYPE2 : struct",
        "type _TYPE3 : (red, green)",
        "a : array [0..3] of _TYPE1",
        "e : _TYPE3 := green",
        "{s.x := a[2][1]}",
    ] {
        assert!(native.contains(part), "{part}\n{native}");
    }
}

#[test]
fn pins_that_nothing_is_wired_to_may_be_named_in_a_call() {
    let native =
        sound("PROGRAM p\nVAR t : TON; a : BOOL; e : TIME; END_VAR\nt(IN := a, PT := , Q => , ET => e);\nEND_PROGRAM");
    assert!(native.contains("t(IN := a, ET => e)"), "{native}");
}

#[test]
fn standard_blocks_have_the_pins_of_other_tools_too() {
    let text = "PROGRAM p\nVAR c : CTU; s : SR; own : mine; a, b : BOOL; END_VAR\n\
        c(CU := a, RESET := b, PV := 3);\ns(SET1 := a, RESET := b);\nb := c.RESET;\nown(RESET := a);\nEND_PROGRAM\n\
        FUNCTION_BLOCK mine\nVAR_INPUT RESET : BOOL; END_VAR\nVAR x : BOOL; END_VAR\nx := RESET;\nEND_FUNCTION_BLOCK";
    let native = sound(text);
    for part in ["c(CU := a, R := b, PV := 3)", "s(S1 := a, R := b)", "{b := c.R}", "own(RESET := a)"] {
        assert!(native.contains(part), "{part}\n{native}");
    }
}

#[test]
fn globals_of_a_program_are_seen_by_its_blocks() {
    let text = "PROGRAM p\nVAR_GLOBAL g : INT; END_VAR\nVAR f : fb; END_VAR\nf();\ng := g + 1;\nEND_PROGRAM\n\
        FUNCTION_BLOCK fb\nVAR_EXTERNAL g : INT; END_VAR\ng := 2;\nEND_FUNCTION_BLOCK";
    assert!(sound(text).contains("global g : INT"));
}

#[test]
fn open_addresses_are_inputs_and_outputs_without_one() {
    let text = "VAR_GLOBAL g AT %Q* : INT; END_VAR\nPROGRAM p\nVAR a AT %I* : BOOL; b AT %QX* : BOOL; END_VAR\nb := a;\ng := 1;\nEND_PROGRAM";
    let (native, codes) = read(text);
    assert_eq!(codes, [Code::OpenAddress]);
    for part in ["global g : INT at %QW10000", "input  a : BOOL", "output b : BOOL"] {
        assert!(native.contains(part), "{part}\n{native}");
    }
    assert_eq!(codes_of("c AT %J* : BOOL;", ""), [Code::BadAddress]);
}

#[test]
fn a_program_that_an_event_starts_leaves_unless_it_comes() {
    let text = "PROGRAM p\nVAR n : INT; END_VAR\nn := n + 1;\nEND_PROGRAM\nCONFIGURATION c\nVAR_GLOBAL go : BOOL; END_VAR\n\
        RESOURCE r ON PLC\nTASK t(SINGLE := go, PRIORITY := 1);\nPROGRAM one WITH t : p;\nEND_RESOURCE\nEND_CONFIGURATION";
    assert!(sound(text).contains("NOT(IN := [ ^go ]).OUT >> return"));
    let (_, codes) = read(&text.replace("SINGLE", "INTERVAL := T#1s, SINGLE"));
    assert_eq!(codes, [Code::NotSupported]);
    let (_, codes) = read(&text.replace(":= go", ":= TRUE"));
    assert_eq!(codes, [Code::NotSupported]);
}

#[test]
fn durations_are_multiplied_and_divided_by_numbers() {
    let native = sound("PROGRAM p\nVAR t : TIME; n : INT; END_VAR\nt := T#10ms * n / 2;\nEND_PROGRAM");
    assert!(native.contains("{t := T#10ms * n / 2}"), "{native}");
    let wrong = "PROGRAM p\nVAR t : TIME; n : INT; END_VAR\nt := n * T#10ms;\nEND_PROGRAM";
    let parsed = rung::frontend::parse(&Source::new("test.st", wrong));
    assert!(rung::check::check(&parsed.program).0.is_none());
}
