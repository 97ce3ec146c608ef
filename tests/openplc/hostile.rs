//! Files that nobody would write: they end in a diagnostic, without a panic, and soon.

use proptest::prelude::*;

use crate::drawing::{block, coil, contact, ladder, left, parallel, right, variable};
use crate::{codes, parse};
use rung::check::check;

fn valid() -> String {
    let pins = [("IN", "input"), ("PT", "input"), ("Q", "output"), ("ET", "output")];
    let nodes = [
        left(),
        parallel("P", "open"),
        contact("a", "negated", (10, 0)),
        contact("b", "risingEdge", (10, 40)),
        parallel("p", "close"),
        block("B", "TON", ("IN", "Q"), &pins, Some("t")),
        variable("V", "T#1s", "input", ("B", "PT")),
        coil("b#2", "set", (300, 0)),
        right(),
    ];
    let edges = ["L P", "P a", "P b", "a p", "b p", "p B.IN", "B.Q b#2", "b#2 R"];
    ladder("a b", &nodes, &edges).replace("a : bool;", "a : bool; t : TON;")
}

#[test]
fn deep_nesting_is_refused() {
    let text = format!("PROGRAM main\nVAR\n a : bool;\nEND_VAR\n{{\"a\":{}\nEND_PROGRAM", "[".repeat(1_000_000));
    assert!(codes(&parse(&text).diagnostics).contains(&"R0223".to_owned()));
}

#[test]
fn many_values_are_refused() {
    let text = format!("{{\"data\": [{}0]}}", "0,".repeat(5_000_000));
    assert!(codes(&parse(&text).diagnostics).contains(&"R0223".to_owned()));
}

#[test]
fn parallels_in_a_circle_and_in_a_row_end() {
    let nodes = [left(), parallel("P", "open"), parallel("Q", "open"), coil("b", "default", (20, 0))];
    let parsed = parse(&ladder("a b", &nodes, &["P Q", "Q P", "L P", "Q b"]));
    assert_eq!(codes(&parsed.diagnostics), Vec::<String>::new());
    let mut nodes = vec![left()];
    let mut edges = vec!["L p0".to_owned()];
    for n in 0..4000 {
        nodes.push(parallel(&format!("p{n}"), "open"));
        nodes.push(coil(&format!("b#{n}"), "default", (20, 0)));
        edges.push(format!("p{n} p{}", n + 1));
        edges.push(format!("p{n} b#{n}"));
    }
    edges.pop();
    nodes.push(parallel("p4000", "open"));
    let edges: Vec<&str> = edges.iter().map(String::as_str).collect();
    assert!(codes(&parse(&ladder("a b", &nodes, &edges)).diagnostics).contains(&"R0204".to_owned()));
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 96, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn any_change_of_a_file_is_read_without_a_panic(
        changes in prop::collection::vec((any::<prop::sample::Index>(), 0usize..12), 1..6),
        cut in any::<prop::sample::Index>(),
        cuts in any::<bool>(),
    ) {
        const PIECES: [&str; 12] =
            ["", "\"", "{", "}", "[", "null", "-1e999", "\\u12", "é", "\"id\": \"a\"", "\n{\"", "999999999999999999999"];
        let mut text = valid();
        for (place, piece) in changes {
            let mut at = place.index(text.len());
            while !text.is_char_boundary(at) { at -= 1; }
            let end = (at..=text.len()).find(|end| *end > at && text.is_char_boundary(*end)).unwrap_or(at);
            text.replace_range(at..end, PIECES[piece]);
        }
        if cuts {
            let mut at = cut.index(text.len() + 1);
            while !text.is_char_boundary(at) { at -= 1; }
            text.truncate(at);
        }
        let parsed = parse(&text);
        for problem in &parsed.diagnostics {
            prop_assert!(problem.span.end as usize <= text.len(), "{problem:?}");
        }
        if parsed.diagnostics.is_empty() {
            let _ = check(&parsed.program);
        }
    }

    #[test]
    fn any_values_in_the_places_of_others_are_read_without_a_panic(
        places in prop::collection::vec((any::<prop::sample::Index>(), 0usize..8), 1..4),
    ) {
        let text = valid();
        let start = text.find("\n{").expect("it has a drawing") + 1;
        let end = text.rfind("END_PROGRAM").expect("it ends");
        let mut body: serde_json::Value = serde_json::from_str(&text[start..end]).expect("it is JSON");
        for (place, other) in places {
            let others = [
                serde_json::json!(null), serde_json::json!(-1), serde_json::json!("x y"), serde_json::json!([]),
                serde_json::json!({}), serde_json::json!([[1]]), serde_json::json!(true), serde_json::json!({"id": "P"}),
            ];
            let mut paths = Vec::new();
            collect(&body, String::new(), &mut paths);
            let path = &paths[place.index(paths.len())];
            if let Some(found) = body.pointer_mut(path) { *found = others[other].clone(); }
        }
        let changed = format!("{}{}\nEND_PROGRAM", &text[..start], body);
        if body.is_object() {
            let parsed = parse(&changed);
            if parsed.diagnostics.is_empty() { let _ = check(&parsed.program); }
        }
    }
}

/// The paths of all values.
fn collect(value: &serde_json::Value, path: String, paths: &mut Vec<String>) {
    match value {
        serde_json::Value::Object(members) => {
            members.iter().for_each(|(name, inner)| collect(inner, format!("{path}/{name}"), paths));
        }
        serde_json::Value::Array(items) => {
            items.iter().enumerate().for_each(|(place, inner)| collect(inner, format!("{path}/{place}"), paths));
        }
        _ => {}
    }
    paths.push(path);
}
