//! What is wrong in a file is said under its code, at the line of the element, and the rest is still read.

use crate::drawing::{coil, contact, element, ladder, locals, pou, program, project, rail, wires};
use crate::{codes, parse};
use rung::source::Source;

/// The codes of a file's diagnostics with their lines.
fn found(text: &str) -> Vec<(String, usize)> {
    let source = Source::new("test.xml", text);
    let parsed = rung::frontend::parse(&source);
    parsed.diagnostics.iter().map(|found| (found.code.to_string(), source.line(found.span.start))).collect()
}

fn one(code: &str, line: usize) -> Vec<(String, usize)> {
    vec![(code.to_owned(), line)]
}

#[test]
fn a_wire_from_nowhere_is_an_error() {
    let text = ladder("a b", &[rail(), contact(2, "a", "9"), coil(3, "b", "2")]);
    assert_eq!(found(&text), one("R0521", 3));
    let text = ladder("a b", &[rail(), contact(2, "a", "1"), coil(3, "b", "2 4"), element("comment", 4, "", "")]);
    assert_eq!(found(&text), one("R0521", 4));
}

#[test]
fn two_elements_of_one_id_are_an_error() {
    let text = ladder("a b", &[rail(), contact(2, "a", "1"), contact(2, "b", "1"), coil(3, "b", "2")]);
    assert_eq!(found(&text), one("R0522", 4));
}

#[test]
fn a_circle_of_contacts_is_an_error() {
    let text = ladder("a b", &[rail(), contact(2, "a", "1 3"), contact(3, "b", "2"), coil(4, "b", "3")]);
    let parsed = parse(&text);
    assert_eq!(codes(&parsed.diagnostics), ["R0523"]);
    assert!(parsed.diagnostics[0].message.ends_with("localIds 3, 2"), "{:?}", parsed.diagnostics);
}

#[test]
fn a_coil_without_a_wire_is_an_error() {
    let text = ladder("a b", &[rail(), contact(2, "a", "1"), coil(3, "b", "")]);
    let parsed = parse(&text);
    assert_eq!(codes(&parsed.diagnostics), ["R0524"]);
    assert_eq!(parsed.diagnostics[0].message, "no wire reaches this coil (localId 3)");
}

#[test]
fn a_global_that_nobody_declares_is_an_error() {
    let interface = "<externalVars><variable name='g'><type><INT/></type></variable></externalVars>";
    let text = project(&pou("program", "p", interface, "<LD></LD>"), "");
    assert_eq!(codes(&parse(&text).diagnostics), ["R0301"]);
}

#[test]
fn an_element_without_a_name_or_id_is_an_error() {
    let nameless = element("contact", 2, "", &wires("1"));
    let text = ladder("a", &[rail(), nameless, "<coil><variable>a</variable></coil>\n".to_owned(), coil(4, "a", "1")]);
    assert_eq!(found(&text), [("R0222".to_owned(), 3), ("R0222".to_owned(), 4)]);
}

#[test]
fn bodies_in_other_languages_are_refused_by_name() {
    for (language, inside) in [("IL", "<p>LD a</p>"), ("SFC", "<step localId='1'/>")] {
        let parsed =
            parse(&project(&pou("functionBlock", "old", "", &format!("<{language}>{inside}</{language}>")), ""));
        assert_eq!(codes(&parsed.diagnostics), ["R0209"]);
        assert!(parsed.diagnostics[0].message.contains("`old` is in "), "{:?}", parsed.diagnostics);
    }
}

#[test]
fn what_rung_has_not_is_counted_by_kind() {
    let odd = |id: u32| element("inVariable", id, "", "<expression>'text'</expression>");
    let text = program(&locals("a", "BOOL"), "FBD", &[odd(2), odd(3), element("turnstile", 4, "", ""), odd(5)]);
    let parsed = parse(&text);
    let messages: Vec<&str> = parsed.diagnostics.iter().map(|found| found.message.as_str()).collect();
    assert_eq!(
        messages,
        ["Rung has no string literal: used 3 times, first here", "Rung has no element `<turnstile>`: used once here"]
    );
    assert_eq!(codes(&parsed.diagnostics), ["R0209", "R0209"]);
}

#[test]
fn malformed_xml_is_an_error_at_its_place() {
    for (text, code) in [
        ("<project>", "R0203"),
        ("<project></projekt>", "R0221"),
        ("<project a='1' a='2'/>", "R0221"),
        ("<project a=1/>", "R0221"),
        ("<project>&nbsp;</project>", "R0221"),
        ("<project/><project/>", "R0221"),
        ("<project/>text", "R0221"),
        ("<?xml version='1.0'?>", "R0221"),
        ("<!DOCTYPE project [<!ENTITY a 'aaaa'><!ENTITY b '&a;&a;&a;'>]><project>&b;</project>", "R0221"),
        ("<html/>", "R0105"),
        ("<project/>", "R0222"),
    ] {
        assert_eq!(codes(&parse(text).diagnostics), [code], "{text}");
    }
}

#[test]
fn a_variable_that_nothing_declares_is_an_error_at_its_element() {
    let text = ladder("b", &[rail(), contact(2, "ghost", "1"), coil(3, "b", "2")]);
    let source = Source::new("test.xml", text.as_str());
    let parsed = rung::frontend::parse(&source);
    let (checked, found) = rung::check::check(&parsed.program);
    assert!(checked.is_none());
    let errors: Vec<(String, usize)> = found
        .iter()
        .filter(|found| found.is_error())
        .map(|found| (found.code.to_string(), source.line(found.span.start)))
        .collect();
    assert_eq!(errors, one("R0301", 3));
}
