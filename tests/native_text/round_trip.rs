//! Parse, print, parse is the identity, and the printed form is the one canonical form.

use proptest::prelude::*;
use rung::frontend::native;

use super::{parse_well, print_and_check, random_program};

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn random_programs_survive_printing_and_parsing(program in random_program::program()) {
        print_and_check(&program);
    }
}

/// Text in the canonical form prints as itself.
#[track_caller]
fn canonical(text: &str) {
    assert_eq!(native::print(&parse_well(text)), text);
}

#[test]
fn the_design_example_prints_neatly() {
    let text = "\
program pump_station

input  start, stop, low_level  -- contacts of the panel
output pump, alarm
const  warm : TIME := T#5s
var    runs : INT retain

rung r10 \"seal-in: stop wins\"
  [ start | pump ] /stop (pump)

rung r20 \"alarm when the level stays low\"
  pump low_level delay:TON(PT := warm) (S alarm)

rung r30
  ^pump starts:CTU(PV := 100, R := stop, CV => runs)

rung r40
  {runs > 90} [ (alarm) | {runs := runs - 1} ]
";
    canonical(text);
}

#[test]
fn clauses_and_comments_stand_in_columns() {
    let messy = "program p var a:INT:=5 -- one\nvar longer : TIME at %MD4 retain -- two\nvar x\nvar y,z := TRUE";
    let neat = "\
program p

var    a      : INT := 5             -- one
var    longer : TIME at %MD4 retain  -- two
var    x
var    y, z   := TRUE
";
    let printed = native::print(&parse_well(messy));
    assert_eq!(printed, neat);
    canonical(neat);
}

#[test]
fn a_list_of_names_too_long_for_a_line_becomes_several() {
    let names: Vec<String> = (0..40).map(|number| format!("sensor_{number}")).collect();
    let printed = print_and_check(&parse_well(&format!("program p input {} : BOOL", names.join(","))));
    assert!(printed.lines().all(|line| line.len() <= 100), "{printed}");
    assert_eq!(printed.matches("input").count(), 5);
}

#[test]
fn a_long_rung_breaks_between_words_and_at_branches() {
    let text = "\
program p

rung r1 \"long\"
  first_condition second_condition third_condition fourth_condition fifth_condition sixth_condition
  seventh_condition
  [ a_long_name_for_a_contact another_long_name_for_a_contact a_third_long_name_for_a_contact
  | b
    [ c_long_name_for_a_contact another_long_name_for_a_contact a_third_long_name_for_a_contact
    | d
    ] e
  ] (coil)
| {left + right > 100} (other)

rung
  enable
  main_counter:CTU(
    CU := first_condition_of_many,
    R :=
      [ reset_button_on_the_panel reset_is_enabled_by_the_key_switch
      | watchdog_of_the_other_station communication_is_lost
      ],
    PV := 100,
    CV => count
  ).Q (done)
";
    canonical(text);
}

#[test]
fn off_rungs_and_odd_names_keep_their_spelling() {
    canonical(
        "\
program `my plant`

input  `rung`, `größe 1`, größe, off, at, retain, s

rung off r1
  /`rung` ^`größe 1` ^/größe (off)

rung `off`
  at retain (s)

rung off `off` \"5$$ $\"off$\"$N\"

rung
  (S s) (R s) (P s) (N s) (/s)
",
    );
}

#[test]
fn nodes_and_wires_keep_their_shape() {
    canonical(
        "\
program p

rung bridge
  a >x>
| - >y>
| >x> >y>
| >x> b (c)
| >y>

rung
  [ a | ] [ | b ] [ ] [ - >x> | >x> ]
",
    );
}

#[test]
fn expressions_print_with_as_few_parentheses_as_they_need() {
    let cases = [
        ("((a))", "a"),
        ("(a OR b) AND c", "(a OR b) AND c"),
        ("a OR (b AND c)", "a OR b AND c"),
        ("a & b", "a AND b"),
        ("a - (b - c)", "a - (b - c)"),
        ("(a - b) - c", "a - b - c"),
        ("-(-a)", "-(-a)"),
        ("- NOT - a", "-NOT -a"),
        ("NOT (a = b)", "NOT (a = b)"),
        ("(NOT a) = b", "NOT a = b"),
        ("-(a + b) * -c", "-(a + b) * -c"),
        ("(a < b) = (c >= d)", "a < b = c >= d"),
        ("16#ff + 2#1_0 - 8#17 + 1_000", "16#FF + 2#10 - 8#17 + 1000"),
        ("int#5 + WORD#16#ff + INT#-3", "INT#5 + WORD#16#FF + -INT#3"),
        ("1.50 + 1.0E+3 + REAL#2 + 1.0e-9 + 1.0e300", "1.5 + 1000.0 + REAL#2.0 + 1.0e-9 + 1.0e300"),
        ("t#90s + TIME#1.5s + T#-5000ms + T#0s", "T#1m30s + T#1s500ms + T#-5s + T#0s"),
        ("T#1d2h_3m4s5ms6us7ns", "T#1d2h3m4s5ms6us7ns"),
        ("BOOL#true OR BOOL#1", "TRUE OR BOOL#1"),
        ("%iw3 + %MX0.3 + w.3 + d.ET", "%IW3 + %MX0.3 + w.3 + d.ET"),
        ("%IW3 .5 + w . 3", "%IW3 .5 + w.3"),
    ];
    for (written, printed) in cases {
        let text = native::print(&parse_well(&format!("rung\n{{{written}}}")));
        assert_eq!(text, format!("program test\n\nrung\n  {{{printed}}}\n"), "{written}");
        canonical(&text);
    }
}

#[test]
fn long_statements_break_over_lines() {
    canonical(
        "\
program p

rung
  a {x := 1;} {f(x);} {f(x)} {;}
  { a_call_with_many_arguments(
      first_argument_of_the_call := first_value,
      second_argument_of_the_call := second_value,
      third => x
    );
    x := 2;
  } b

rung
  a
  [ { x := 1;
      y := 2;
    }
  | { IF a THEN
        x := 1;
      END_IF;
    }
  ] b
",
    );
}

#[test]
fn a_function_named_like_an_operator_stays_a_call_in_back_quotes() {
    let text = "program p\n\nrung r1\n  {`NOT`(NOT a)} {NOT (a AND b)} (q)\n";
    assert_eq!(print_and_check(&parse_well(text)), text);
}
