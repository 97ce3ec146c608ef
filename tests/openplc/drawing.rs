//! Drawings as OpenPLC Editor keeps them, with no more than counts.

use serde_json::{Value, json};

/// A node of a type at a place.
pub(crate) fn node(id: &str, ty: &str, at: (i32, i32), data: Value) -> Value {
    json!({"id": id, "type": ty, "position": {"x": at.0, "y": at.1}, "data": data})
}

pub(crate) fn left() -> Value {
    node("L", "powerRail", (0, 0), json!({"variant": "left", "variable": {"name": ""}}))
}

pub(crate) fn right() -> Value {
    node("R", "powerRail", (900, 0), json!({"variant": "right", "variable": {"name": ""}}))
}

/// An end of a parallel.
pub(crate) fn parallel(id: &str, ty: &str) -> Value {
    node(id, "parallel", (10, 0), json!({"type": ty, "variable": {"name": ""}}))
}

/// A contact of a variant, called as its variable.
pub(crate) fn contact(id: &str, variant: &str, at: (i32, i32)) -> Value {
    let variable = id.split('#').next();
    node(id, "contact", at, json!({"variant": variant, "variable": {"name": variable}, "numericId": "7"}))
}

/// A coil of a variant, called as its variable.
pub(crate) fn coil(id: &str, variant: &str, at: (i32, i32)) -> Value {
    let variable = id.split('#').next();
    node(id, "coil", at, json!({"variant": variant, "variable": {"name": variable}, "numericId": 8}))
}

/// A box: the pin on its left, that on its right, and all pins with their classes.
pub(crate) fn block(id: &str, ty: &str, pins: (&str, &str), all: &[(&str, &str)], instance: Option<&str>) -> Value {
    let variables: Vec<Value> = all.iter().map(|(name, class)| json!({"name": name, "class": class})).collect();
    let kind = if instance.is_some() { "function-block" } else { "function" };
    let data = json!({
        "variant": {"name": ty, "type": kind, "variables": variables},
        "variable": {"name": instance.unwrap_or("")},
        "executionControl": pins.0 == "EN",
        "inputConnector": {"id": pins.0},
        "outputConnector": {"id": pins.1},
        "numericId": "9",
    });
    node(id, "block", (200, 0), data)
}

/// A variable at a pin of a box; `variant` is `input` or `output`.
pub(crate) fn variable(id: &str, name: &str, variant: &str, block: (&str, &str)) -> Value {
    let data = json!({"variant": variant, "variable": {"name": name}, "block": {"id": block.0, "handleId": block.1}});
    node(id, "variable", (150, 20), data)
}

/// Wires, each `from to` or `from.pin to.pin`.
pub(crate) fn wires(all: &[&str]) -> Vec<Value> {
    let wire = |text: &&str| {
        let (from, to) = text.split_once(' ').expect("two ends");
        let end = |end: &str| match end.split_once('.') {
            Some((node, pin)) => (node.to_owned(), Some(pin.to_owned())),
            None => (end.to_owned(), None),
        };
        let ((source, source_pin), (target, target_pin)) = (end(from), end(to));
        json!({"id": format!("e_{text}"), "source": source, "sourceHandle": source_pin, "target": target,
            "targetHandle": target_pin})
    };
    all.iter().map(wire).collect()
}

pub(crate) fn rung(nodes: &[Value], edges: &[&str]) -> Value {
    json!({"id": "rung", "comment": "", "reactFlowViewport": [300, 100], "nodes": nodes, "edges": wires(edges)})
}

/// A file: declarations, drawing, end.
pub(crate) fn file(declarations: &str, rungs: &[Value]) -> String {
    let body = serde_json::to_string_pretty(&json!({"name": "main", "rungs": rungs})).expect("it is JSON");
    format!("PROGRAM main\nVAR\n{declarations}\nEND_VAR\n\n{body}\nEND_PROGRAM")
}

/// A file with one rung; all variables are BOOL.
pub(crate) fn ladder(variables: &str, nodes: &[Value], edges: &[&str]) -> String {
    let declarations: Vec<String> = variables.split(' ').map(|name| format!("\t{name} : bool;")).collect();
    file(&declarations.join("\n"), &[rung(nodes, edges)])
}
