//! Bodies in LD whose rungs are written out: `<rung>` holds its elements in series, each naming its variable in an attribute.
//! Tools for verification write them so.

use super::xml::Node;
use crate::diagnostic::Code;
use crate::frontend::graph::coil_kind;
use crate::frontend::graph::expression;
use crate::frontend::graph::report::Report;
use crate::frontend::graph::types::Signatures;
use crate::ladder::functions::Function;
use crate::ladder::{
    Argument, BlockCall, Branch, Circuit, ContactKind, Element, ElementKind, ExpressionKind, Name, Reference, Rung,
    Wire,
};

/// The rungs of a body.
pub(super) fn read(content: Node<'_, '_>, signatures: &Signatures, report: &mut Report) -> Vec<Rung> {
    let mut rungs = Vec::new();
    let mut comment = None;
    for node in content.children_and_comments() {
        match node.name() {
            "" => comment = Some(node.text().split_whitespace().collect::<Vec<_>>().join(" ")),
            "rung" => {
                let span = node.span();
                let elements: Vec<Element> =
                    node.children().filter_map(|element| self::element(element, signatures, report)).collect();
                let title = comment.take().or_else(|| node.attribute("comment").map(str::to_owned));
                let title = title.filter(|title| !title.is_empty());
                let name = node.attribute("label").map(|label| Name::new(label, span));
                let circuit = Circuit { branches: vec![Branch { from: None, elements, to: None, span }], span };
                rungs.push(Rung { name, title, enabled: true, circuit, span });
            }
            name => report.not_supported(format!("element `<{name}>` between rungs"), node.span()),
        }
    }
    rungs
}

fn element(node: Node<'_, '_>, signatures: &Signatures, report: &mut Report) -> Option<Element> {
    let span = node.span();
    let operand = |report: &mut Report| {
        let text = node.attribute("variable").or_else(|| node.child("variable").map(Node::text));
        let Some(text) = text else {
            report.error(Code::BadElement, span, format!("this `<{}>` names no variable", node.name()));
            return None;
        };
        report.read(expression::expression(text, span), span)
    };
    let says = |word: &str| {
        ["kind", "storage", "edge", "type"]
            .iter()
            .any(|name| node.attribute(name).is_some_and(|value| value.eq_ignore_ascii_case(word)))
    };
    let negated = node.flag("negated") || says("negated");
    let rising = if says("rising") { Some(true) } else { says("falling").then_some(false) };
    let kind = match node.name() {
        "contact" => {
            let operand = operand(report)?;
            let kind = match rising {
                Some(rising) if rising != negated => ContactKind::Rising,
                Some(_) => ContactKind::Falling,
                None if negated => ContactKind::Closed,
                None => ContactKind::Open,
            };
            ElementKind::Contact { kind, operand }
        }
        "coil" => {
            let ExpressionKind::Read(target) = operand(report)?.kind else {
                report.error(Code::NotWritable, span, "this coil names no variable");
                return None;
            };
            let set = if says("set") { Some(true) } else { says("reset").then_some(false) };
            ElementKind::Coil { kind: coil_kind(set, negated, rising), target }
        }
        "block" => ElementKind::Block(block(node, signatures, report)?),
        name => {
            report.not_supported(format!("element `<{name}>` in a rung"), span);
            return None;
        }
    };
    Some(Element { kind, span })
}

fn block(node: Node<'_, '_>, signatures: &Signatures, report: &mut Report) -> Option<BlockCall> {
    let span = node.span();
    let Some(type_name) = node.attribute("typeName") else {
        report.error(Code::BadElement, span, "this `<block>` has no typeName");
        return None;
    };
    let instance = match node.attribute("instanceName") {
        Some(name) => Some(report.read(expression::reference(name, span), span)?),
        None => None,
    };
    let mut arguments = Vec::new();
    for pin in node.all("variable") {
        let Some(name) = pin.attribute("formalParameter") else {
            report.error(Code::BadElement, pin.span(), "this pin has no formalParameter");
            continue;
        };
        let Some(value) = report.read(expression::expression(pin.text(), pin.span()), pin.span()) else { continue };
        let wire = match value.kind {
            ExpressionKind::Read(target) if is_output(type_name, name, signatures) => Wire::Output(target),
            kind => Wire::Value(crate::ladder::Expression { kind, span: pin.span() }),
        };
        arguments.push(Argument { pin: Name::new(name, pin.span()), wire, span: pin.span() });
    }
    let (instance, type_name) = match instance {
        Some(instance) => (instance, Some(Name::new(type_name, span))),
        None => (Reference::of_name(Name::new(type_name, span)), None),
    };
    Some(BlockCall { instance, type_name, arguments, power_output: None })
}

/// Whether a pin gives a value; of what is not known, by the names that outputs have.
fn is_output(block: &str, pin: &str, signatures: &Signatures) -> bool {
    if signatures.is_known_block(block) {
        return signatures.is_output(block, pin);
    }
    let names: &[&str] =
        if Function::from_name(block).is_some() { &["OUT", "ENO"] } else { &["OUT", "ENO", "Q", "ET", "CV"] };
    names.iter().any(|name| name.eq_ignore_ascii_case(pin))
}
