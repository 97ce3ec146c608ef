//! PLCopen TC6 XML, as OpenPLC Editor, Beremiz, CODESYS and others write it. `docs/plcopen.md` is its reference.
//!
//! [`parse`] reads declarations, tasks and the bodies in LD and FBD, whatever the namespace or prefix. A body is a
//! graph of elements that name those they are wired to: `diagram` reads it, and `graph` makes rungs of it. Syntax only: nothing here judges a type, and types are
//! looked at only where a wire needs a variable of its own.
//!
//! Whatever the bytes, the answer is a program and diagnostics, in bounded memory and time.

mod configuration;
mod declarations;
mod diagram;
mod textual;
mod write;
mod xml;

pub use self::write::print;

use std::collections::HashSet;

use self::xml::{Document, Node};
use super::Parsed;
use super::graph::report::Report;
use super::graph::types::Signatures;
use super::structured_text::{self, Scope};
use super::{events, graph, instances, located};
use crate::diagnostic::Code;
use crate::ladder::{Comment, Name, Origin, Program, Rung, Unit, UnitKind, Variable, key};
use crate::source::{Source, Span};

/// Whether a text is XML, which no other format that is read is; what it lacks as a PLCopen project is then said.
pub fn recognises(text: &str) -> bool {
    text.trim_start().starts_with('<')
}

/// Reads PLCopen XML. After an error it goes on with the next element, and the program holds the others.
pub fn parse(source: &Source) -> Parsed {
    let mut program = Program::empty(Origin::Imported, Name::new("plcopen", Span::default()));
    let mut report = Report::default();
    match Document::read(source.text()) {
        Err(problem) => report.push(problem),
        Ok(document) => {
            if let Some(root) = document.root() {
                project(root, &mut program, &mut report);
            }
        }
    }
    Parsed { program, diagnostics: report.finish() }
}

/// A POU of the file.
struct Pou<'d, 'a> {
    node: Node<'d, 'a>,
    unit: Unit,
    /// What it declares of the globals.
    externals: Vec<Variable>,
}

fn project(root: Node<'_, '_>, program: &mut Program, report: &mut Report) {
    if root.name() != "project" {
        let message = format!("this is XML, but no PLCopen project: its outermost element is `<{}>`", root.name());
        report.error(Code::UnknownFormat, root.span(), message);
        return;
    }
    if let Some(header) = root.child("contentHeader") {
        program.name = Name::new(header.attribute("name").unwrap_or("plcopen"), header.span());
    }
    let places = places(root);
    let all = |name| places.iter().flat_map(move |place| place.all(name));
    let mut declarations = declarations::Reader::new(report);
    for declared in all("dataType") {
        declarations.data_type(declared);
    }
    let mut pous = Vec::new();
    for node in all("pou") {
        pous.extend(declarations.pou(node));
    }
    program.globals = declarations.globals(all("globalVars"));
    let lists = std::mem::take(&mut declarations.lists);
    let (types, comments) = declarations.finish();
    program.types = types;
    program.comments = comments;
    let mut declared: Vec<&mut Unit> = pous.iter_mut().map(|pou| &mut pou.unit).collect();
    located::settle(&mut program.globals, &mut declared).into_iter().for_each(|problem| report.push(problem));
    let events = configuration::read(&places, program, report);
    check_externals(&pous, &program.globals, report);

    let signatures = Signatures::new(program, pous.iter().map(|pou| &pou.unit));
    let mut bodies = Vec::new();
    let mut comments = std::mem::take(&mut program.comments);
    for pou in &pous {
        bodies.push(body(pou, program, &signatures, &mut comments, report));
    }
    program.comments = comments;
    for (mut pou, (rungs, hidden)) in pous.into_iter().zip(bodies) {
        pou.unit.rungs.extend(rungs);
        pou.unit.variables.extend(hidden);
        program.units.push(pou.unit);
    }
    let mut programs = program.units.iter().filter(|unit| matches!(unit.kind, UnitKind::Program { .. }));
    if let (Some(only), None) = (programs.next(), programs.next()) {
        program.name = only.name.clone();
    }
    if program.units.is_empty() {
        report.error(Code::BadElement, root.span(), "this project has no program");
    }
    instances::settle(program, report);
    events::settle(program, events).into_iter().for_each(|problem| report.push(problem));
    lists.resolve(program);
    program.comments.sort_by_key(|comment| comment.span);
}

/// The elements in which POUs, types, global variables and resources may stand: most files have them among the types and in
/// configurations, some beside them, and CODESYS puts all of them into resources.
fn places<'d, 'a>(root: Node<'d, 'a>) -> Vec<Node<'d, 'a>> {
    const CONTAINERS: [&str; 9] = [
        "types",
        "dataTypes",
        "pous",
        "instances",
        "configurations",
        "configuration",
        "resource",
        "MixedAttrsVarList",
        "Device",
    ];
    let mut places = vec![root];
    let mut next = 0;
    while let Some(place) = places.get(next).copied() {
        places.extend(place.children().filter(|child| CONTAINERS.contains(&child.name())));
        next += 1;
    }
    places
}

/// The rungs of a POU, and the variables that wires in them need.
fn body(
    pou: &Pou<'_, '_>,
    program: &Program,
    signatures: &Signatures,
    comments: &mut Vec<Comment>,
    report: &mut Report,
) -> (Vec<Rung>, Vec<Variable>) {
    let name = &pou.unit.name.text;
    for what in ["actions", "transitions"] {
        for part in pou.node.child(what).into_iter().flat_map(Node::children) {
            report.not_supported(format!("{what} of `{name}`"), part.span());
        }
    }
    for (tag, what) in [("Method", "methods"), ("Property", "properties")] {
        for part in pou.node.all(tag) {
            report.not_supported(format!("{what} of `{name}`"), part.span());
        }
    }
    let mut rungs = (Vec::new(), Vec::new());
    let mut found = false;
    for content in pou.node.all("body").flat_map(Node::children) {
        let language = content.name();
        match language {
            "LD" | "ladderDiagram" | "FBD" | "functionBlockDiagram" => {
                let (more, hidden) = if content.child("rung").is_some() {
                    let around = textual::Around { unit: &pou.unit, program, signatures };
                    (textual::read(content, &around, report), Vec::new())
                } else {
                    let diagram = diagram::read(content, report);
                    graph::rungs(diagram, &pou.unit, content.span(), signatures, comments, report)
                };
                rungs.0.extend(more);
                rungs.1.extend(hidden);
            }
            "ST" | "structuredText" => rungs.0.extend(statements(content, pou, program, comments, report)),
            "IL" | "SFC" => {
                let problem = format!("the body of `{name}` is in {language}, which Rung does not read");
                report.error(Code::NotSupported, content.span(), problem);
            }
            _ => continue,
        }
        found = true;
    }
    if !found {
        report.error(Code::BadElement, pou.node.span(), format!("`{name}` has no body"));
    }
    rungs
}

/// The rungs of a body in structured text.
fn statements(
    content: Node<'_, '_>,
    pou: &Pou<'_, '_>,
    program: &Program,
    comments: &mut Vec<Comment>,
    report: &mut Report,
) -> Vec<Rung> {
    let text = content.text_node();
    let result = match &pou.unit.kind {
        UnitKind::Function { result: Some(result) } => Some((&pou.unit.name, result)),
        _ => None,
    };
    let scope = Scope { types: &program.types, globals: &program.globals, variables: &pou.unit.variables, result };
    let body = structured_text::body(text.text(), &scope, &|span| text.place(span));
    comments.extend(body.comments);
    body.diagnostics.into_iter().for_each(|problem| report.push(problem));
    body.rungs
}

/// An external variable is the global of its name, which has to be there.
fn check_externals(pous: &[Pou<'_, '_>], globals: &[Variable], report: &mut Report) {
    let globals: HashSet<String> = globals.iter().map(|global| global.name.key()).collect();
    for external in pous.iter().flat_map(|pou| &pou.externals) {
        if !globals.contains(&key(&external.name.text)) {
            let message = format!("no configuration or resource declares the global variable `{}`", external.name.text);
            report.error(Code::UndeclaredName, external.name.span, message);
        }
    }
}
