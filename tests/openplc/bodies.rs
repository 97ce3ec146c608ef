//! What each kind of element becomes.

use serde_json::json;

use crate::drawing::{block, coil, contact, file, ladder, left, node, parallel, right, rung, variable};
use crate::{parse, rungs};

#[test]
fn contacts_and_coils_have_variants() {
    for (variant, expected) in [("default", "a"), ("negated", "/a"), ("risingEdge", "^a"), ("fallingEdge", "^/a")] {
        let nodes = [left(), contact("a", variant, (10, 0)), coil("b", "default", (20, 0)), right()];
        assert_eq!(rungs(&ladder("a b", &nodes, &["L a", "a b", "b R"])), [format!("{expected} (b)")]);
    }
    let coils = [
        ("default", "(b)"),
        ("negated", "(/b)"),
        ("set", "(S b)"),
        ("reset", "(R b)"),
        ("risingEdge", "(P b)"),
        ("fallingEdge", "(N b)"),
    ];
    for (variant, expected) in coils {
        let nodes = [left(), contact("a", "default", (10, 0)), coil("b", variant, (20, 0)), right()];
        assert_eq!(rungs(&ladder("a b", &nodes, &["L a", "a b", "b R"])), [format!("a {expected}")]);
    }
}

#[test]
fn the_ends_of_parallels_are_wires_and_may_nest() {
    let nodes = [
        left(),
        parallel("P", "open"),
        contact("a", "default", (20, 0)),
        parallel("Q", "open"),
        contact("b", "default", (20, 40)),
        contact("c", "default", (20, 80)),
        parallel("q", "close"),
        parallel("p", "close"),
        coil("d", "default", (60, 0)),
        right(),
    ];
    let edges = ["L P", "P a", "P Q", "Q b", "Q c", "b q", "c q", "a p", "q p", "p d", "d R"];
    assert_eq!(rungs(&ladder("a b c d", &nodes, &edges)), ["[ a | b | c ] (d)"]);
}

#[test]
fn an_address_may_stand_behind_its_type() {
    let nodes = [left(), contact("a", "default", (10, 0)), coil("b", "default", (20, 0)), right()];
    let text = file("a : bool AT %IX0.2 := TRUE; b AT %QX0.1 : bool;", &[rung(&nodes, &["L a", "a b", "b R"])]);
    let parsed = parse(&text);
    let found: Vec<_> = parsed.program.units[0]
        .variables
        .iter()
        .map(|variable| (variable.address.as_ref().map(ToString::to_string), variable.initial.is_some()))
        .collect();
    assert_eq!(found, [(Some("%IX0.2".to_owned()), true), (Some("%QX0.1".to_owned()), false)]);
    assert_eq!(rungs(&text), ["a (b)"]);
}

#[test]
fn a_function_with_execution_control_has_en_and_eno() {
    let pins = [("EN", "input"), ("ENO", "output"), ("OUT", "output"), ("IN", "input")];
    let nodes = [
        left(),
        contact("a", "default", (10, 0)),
        block("B", "MOVE", ("EN", "ENO"), &pins, None),
        variable("V", "T#1s", "input", ("B", "IN")),
        variable("W", "t", "output", ("B", "OUT")),
        variable("X", "", "input", ("B", "IN")),
        coil("b", "default", (300, 40)),
        right(),
    ];
    // The wires of variables are those that the variables name, whether they are drawn or not.
    let edges = ["L a", "a.output B.EN", "B.ENO b", "b R", "V B.IN"];
    let text = file("a, b : bool; t : time;", &[rung(&nodes, &edges)]);
    assert_eq!(rungs(&text), ["a MOVE(IN := T#1s, OUT => t) (b)"]);
}

#[test]
fn power_goes_to_the_pin_on_the_left_and_comes_from_that_on_the_right() {
    let pins = [("CU", "input"), ("R", "input"), ("PV", "input"), ("Q", "output"), ("CV", "output")];
    let nodes = [
        left(),
        contact("a", "default", (10, 0)),
        block("B", "CTU", ("CU", "Q"), &pins, Some("c")),
        variable("V", "r", "input", ("B", "R")),
        variable("W", "10", "input", ("B", "PV")),
        coil("b", "default", (300, 0)),
        right(),
    ];
    // A pin that the box no longer has, as the editor leaves it when EN is switched off.
    let edges = ["L a", "a B.EN", "B.ENO b", "b R"];
    let text = file("a, b, r : bool; c : CTU;", &[rung(&nodes, &edges)]);
    assert_eq!(rungs(&text), ["a c:CTU(R := r, PV := 10) (b)"]);
}

#[test]
fn rungs_run_in_the_order_of_the_file_and_comments_are_titles() {
    let one = |name: &str, y: i32, comment: &str| {
        let nodes = [left(), contact("a", "default", (10, y)), coil(name, "default", (20, y)), right()];
        let mut rung = rung(&nodes, &["L a", &format!("a {name}"), &format!("{name} R")]);
        rung["comment"] = json!(comment);
        rung
    };
    // The first is drawn far below the second in its own space.
    let text = file("a, b, c : bool;", &[one("b", 900, "first"), one("c", 0, "second")]);
    assert_eq!(rungs(&text), ["\"first\" a (b)", "\"second\" a (c)"]);
}

#[test]
fn function_block_diagrams_are_read() {
    let at = |x| (x, 0);
    let value = |id: &str, ty: &str, name: &str, x: i32| node(id, ty, at(x), json!({"variable": {"name": name}}));
    let pins = [("IN1", "input"), ("IN2", "input"), ("OUT", "output")];
    let nodes = [
        value("x", "input-variable", "x", 0),
        value("y", "input-variable", "y", 0),
        block("B", "ADD", ("IN1", "OUT"), &pins, None),
        value("to", "connector", "sum", 300),
        value("from", "continuation", "sum", 400),
        value("z", "output-variable", "z", 500),
        node("C", "comment", at(0), json!({"content": "adds"})),
    ];
    let edges = ["x B.IN1", "y B.IN2", "B.OUT to", "from z"];
    let mut drawing = rung(&nodes, &edges);
    drawing["comment"] = json!("");
    let body = serde_json::to_string(&json!({"name": "main", "rung": drawing})).expect("it is JSON");
    let text = format!("PROGRAM main\nVAR\n x, y, z : int;\nEND_VAR\n{body}\nEND_PROGRAM\n");
    assert_eq!(rungs(&text), ["\"adds\" {z := x + y}"]);
}

#[test]
fn function_blocks_and_functions_are_files_too() {
    let nodes = [left(), contact("a", "default", (10, 0)), coil("q", "default", (20, 0)), right()];
    let body = serde_json::to_string(&json!({"rungs": [rung(&nodes, &["L a", "a q", "q R"])]})).expect("it is JSON");
    let text = format!(
        "(* repeats *)\n\nFUNCTION_BLOCK repeat_it\nVAR_INPUT\n a : bool;\nEND_VAR\nVAR_OUTPUT\n q : bool;\nEND_VAR\n{body}\n\
         END_FUNCTION_BLOCK"
    );
    let parsed = parse(&text);
    assert_eq!(parsed.diagnostics, []);
    assert_eq!(parsed.program.units[0].kind, rung::ladder::UnitKind::FunctionBlock);
    assert_eq!(parsed.program.rungs().count(), 1);
}
