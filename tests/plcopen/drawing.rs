//! Writes PLCopen files for the tests: elements are one call each, wires are names such as `3` or `7.Q`.

use std::fmt::Write;

/// A project with these declarations and this body of its only program.
pub(crate) fn program(declarations: &str, language: &str, elements: &[String]) -> String {
    project(&pou("program", "p", declarations, &format!("<{language}>{}</{language}>", elements.concat())), "")
}

/// A ladder of BOOL variables with these names.
pub(crate) fn ladder(names: &str, elements: &[String]) -> String {
    program(&locals(names, "BOOL"), "LD", elements)
}

/// `<localVars>` of one type.
pub(crate) fn locals(names: &str, ty: &str) -> String {
    let ty = match ty {
        "BOOL" | "INT" | "DINT" | "REAL" | "TIME" => format!("<{ty}/>"),
        derived => format!("<derived name='{derived}'/>"),
    };
    let variables: String =
        names.split_whitespace().map(|name| format!("<variable name='{name}'><type>{ty}</type></variable>")).collect();
    format!("<localVars>{variables}</localVars>")
}

/// A POU.
pub(crate) fn pou(kind: &str, name: &str, interface: &str, body: &str) -> String {
    format!("<pou name='{name}' pouType='{kind}'><interface>{interface}</interface><body>{body}</body></pou>")
}

/// A project of POUs and configurations.
pub(crate) fn project(pous: &str, configurations: &str) -> String {
    format!(
        "<?xml version='1.0' encoding='utf-8'?>\n<project xmlns='http://www.plcopen.org/xml/tc6_0201'>\
         <types><dataTypes/><pous>{pous}</pous></types>\
         <instances><configurations>{configurations}</configurations></instances></project>"
    )
}

/// Wires to one place.
pub(crate) fn wires(from: &str) -> String {
    let mut text = "<connectionPointIn><relPosition x='0' y='10'/>".to_owned();
    for wire in from.split_whitespace() {
        let written = match wire.split_once('.') {
            Some((id, pin)) => write!(text, "<connection refLocalId='{id}' formalParameter='{pin}'/>"),
            None => write!(text, "<connection refLocalId='{wire}'><position x='1' y='2'/></connection>"),
        };
        written.expect("a string takes text");
    }
    text + "</connectionPointIn>"
}

/// An element; further down the greater its number.
pub(crate) fn element(tag: &str, id: u32, attributes: &str, inside: &str) -> String {
    let position = format!("<position x='{}' y='{}'/>", id * 10, id * 20);
    format!("<{tag} localId='{id}' {attributes}>{position}{inside}</{tag}>\n")
}

/// The left rail is number 1.
pub(crate) fn rail() -> String {
    element("leftPowerRail", 1, "", "<connectionPointOut formalParameter=''/>")
}

pub(crate) fn contact(id: u32, variable: &str, from: &str) -> String {
    contact_with(id, variable, from, "negated='false'")
}

pub(crate) fn contact_with(id: u32, variable: &str, from: &str, attributes: &str) -> String {
    element("contact", id, attributes, &format!("{}<variable>{variable}</variable>", wires(from)))
}

pub(crate) fn coil(id: u32, variable: &str, from: &str) -> String {
    coil_with(id, variable, from, "negated='false'")
}

pub(crate) fn coil_with(id: u32, variable: &str, from: &str, attributes: &str) -> String {
    element("coil", id, attributes, &format!("{}<variable>{variable}</variable>", wires(from)))
}

pub(crate) fn value(id: u32, expression: &str) -> String {
    element("inVariable", id, "negated='false'", &format!("<expression>{expression}</expression>"))
}

pub(crate) fn variable(id: u32, name: &str, from: &str) -> String {
    element("outVariable", id, "negated='false'", &format!("{}<expression>{name}</expression>", wires(from)))
}

/// A block; `inputs` are `IN=3 PT=4`, a pin without wires is `R=`, with a modifier `CU/negated=3`; `outputs` are `Q ET`.
pub(crate) fn block(id: u32, ty: &str, instance: &str, inputs: &str, outputs: &str) -> String {
    let instance = if instance.is_empty() { String::new() } else { format!(" instanceName='{instance}'") };
    let mut inside = "<inputVariables>".to_owned();
    for input in inputs.split_whitespace() {
        let (pin, from) = input.split_once('=').expect("a pin has its wires");
        let (pin, modifier) = pin.split_once('/').unwrap_or((pin, ""));
        let modifier = match modifier {
            "" => "",
            "negated" => " negated='true'",
            "rising" => " edge='rising'",
            other => panic!("no modifier {other}"),
        };
        inside += &format!("<variable formalParameter='{pin}'{modifier}>{}</variable>", wires(&from.replace('+', " ")));
    }
    inside += "</inputVariables><inOutVariables/><outputVariables>";
    for pin in outputs.split_whitespace() {
        inside += &format!("<variable formalParameter='{pin}'><connectionPointOut/></variable>");
    }
    element("block", id, &format!("typeName='{ty}'{instance}"), &(inside + "</outputVariables>"))
}
