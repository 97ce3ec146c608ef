//! What each mistake is called, and where it is said to be.

use rung::diagnostic::render;
use rung::source::Source;
use serde_json::json;

use crate::drawing::{block, coil, contact, ladder, left, node};
use crate::{codes, parse};

/// The codes and messages of a file.
fn said(text: &str) -> Vec<(String, String)> {
    parse(text).diagnostics.iter().map(|found| (found.code.to_string(), found.message.clone())).collect()
}

fn one(code: &str, message: &str) -> Vec<(String, String)> {
    vec![(code.to_owned(), message.to_owned())]
}

#[test]
fn a_wire_to_nowhere_is_named_with_its_line() {
    let nodes = [left(), contact("a", "default", (10, 0)), coil("b", "default", (20, 0))];
    let text = ladder("a b", &nodes, &["L a", "ghost b"]);
    assert_eq!(said(&text), one("R0521", "no node of the rung has the id of an end of this wire: `ghost`"));
    let problem = &parse(&text).diagnostics[0];
    let source = Source::new("main.ld", text.clone());
    assert!(source.slice(problem.span).contains("e_ghost b"));
    assert!(render(&source, std::slice::from_ref(problem)).contains("main.ld:"));
}

#[test]
fn a_coil_that_no_wire_reaches_is_named() {
    let nodes = [left(), contact("a", "default", (10, 0)), coil("b", "default", (20, 0))];
    assert_eq!(said(&ladder("a b", &nodes, &["L a"])), one("R0524", "no wire reaches this coil (numericId 8)"));
}

#[test]
fn power_in_a_circle_is_refused() {
    let nodes =
        [left(), contact("a", "default", (10, 0)), contact("a#2", "default", (30, 0)), coil("b", "default", (50, 0))];
    let found = said(&ladder("a b", &nodes, &["L a", "a a#2", "a#2 a", "a#2 b"]));
    assert_eq!(found.len(), 1, "{found:?}");
    assert_eq!(found[0].0, "R0523");
}

#[test]
fn two_nodes_of_one_id_are_refused() {
    let nodes =
        [left(), contact("a", "default", (10, 0)), contact("a", "default", (10, 0)), coil("b", "default", (20, 0))];
    assert_eq!(said(&ladder("a b", &nodes, &["L a", "a b"])), one("R0522", "two nodes have the id `a`"));
}

#[test]
fn nodes_that_lack_what_they_need_are_named_by_their_ids() {
    let bad = [
        (json!({"id": "x", "type": "contact"}), "R0222", "the node `x` has no `data`"),
        (json!({"type": "contact", "data": {}}), "R0222", "this node has no `id`"),
        (node("x", "contact", (0, 0), json!({"variable": {"name": ""}})), "R0222", "`x` names no variable"),
        (node("x", "contact", (0, 0), json!({"variable": 7})), "R0222", "`x` names no variable"),
        (node("x", "block", (0, 0), json!({"variant": "TON"})), "R0222", "the block `x` has no `variant` with a name"),
        (node("x", "gate", (0, 0), json!({})), "R0209", "Rung has no element of the type `gate`: used once here"),
        (node("x", "coil", (0, 0), json!({"variable": {"name": "1 + 1"}})), "R0404", "`x` writes what is no variable"),
    ];
    for (node, code, message) in bad {
        assert_eq!(said(&ladder("a b", &[left(), node], &[])), one(code, message));
    }
    let odd = [left(), contact("a", "wobbly", (0, 0))];
    let message = "`a` is of a kind that there is not: `wobbly`";
    assert_eq!(said(&ladder("a b", &odd, &["L a"])), one("R0222", message));
}

#[test]
fn an_output_that_a_box_has_not_is_named() {
    let nodes = [left(), block("B", "TON", ("IN", ""), &[("IN", "input")], Some("t")), coil("b", "default", (20, 0))];
    let found = said(&ladder("a b t", &nodes, &["L B.IN", "B.Q b"]));
    assert_eq!(found[0], ("R0521".to_owned(), "TON has no output `Q`".to_owned()));
}

#[test]
fn json_that_is_cut_off_or_wrong_is_said_with_its_place() {
    let nodes = [left(), contact("a", "default", (10, 0)), coil("b", "default", (20, 0))];
    let text = ladder("a b", &nodes, &["L a", "a b"]);
    let cut = &text[..text.len() / 2];
    let found = parse(cut);
    assert!(codes(&found.diagnostics).contains(&"R0223".to_owned()), "{:?}", found.diagnostics);
    let wrong = text.replacen("\"rungs\":", "\"rungs\" =", 1);
    assert_eq!(said(&wrong), one("R0223", "this is no JSON: a colon should stand here"));
    assert_eq!(said("{\"a\": 1}")[0].0, "R0105");
    let missing = "PROGRAM main\nVAR\n a : bool;\nEND_VAR\n{\"name\": \"main\"}\nEND_PROGRAM";
    assert_eq!(said(missing), one("R0222", "this body has no `rungs` and no `rung`"));
}
