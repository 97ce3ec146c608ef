//! Programs of OpenPLC Editor 4. `docs/openplc.md` is their reference.
//!
//! A unit is a file: its declarations in IEC text, then its drawing in JSON, then `END_PROGRAM`. A project is a folder of such
//! files with a `project.json`, which [`Source::joined`] makes one source; early projects are one JSON file that holds the units
//! too. `files` tells text and JSON apart; the text is read as structured text, `diagram` reads the drawings, and
//! `graph` makes rungs of them, as it does for PLCopen: the editor itself compiles by way of PLCopen.
//!
//! Syntax only, as in all front ends; whatever the bytes, the answer is a program and diagnostics, in bounded memory and time.

mod diagram;
mod files;
mod json;
mod pou;
mod project;
mod variables;

use super::graph::report::Report;
use super::graph::types::Signatures;
use super::{Parsed, graph, instances, located, structured_text};
use crate::diagnostic::{Code, Diagnostic};
use crate::ladder::{Name, Origin, Program, Unit, UnitKind};
use crate::source::{Source, Span};

/// Whether a text is JSON, or has a drawing in JSON behind declarations.
pub fn recognises(text: &str) -> bool {
    files::is_json(text) || files::body(text).is_some_and(|start| declares_a_unit(&text[..start]))
}

/// Whether structured text starts a unit.
fn declares_a_unit(text: &str) -> bool {
    let mut rest = text.trim_start();
    while let Some((_, behind)) = rest.strip_prefix("(*").and_then(|comment| comment.split_once("*)")) {
        rest = behind.trim_start();
    }
    let word = rest.split_whitespace().next().unwrap_or("");
    ["PROGRAM", "FUNCTION", "FUNCTION_BLOCK", "TYPE"].iter().any(|known| word.eq_ignore_ascii_case(known))
}

/// Reads a unit, a project of one file, or the joined files of a folder.
pub fn parse(source: &Source) -> Parsed {
    let mut report = Report::default();
    let files = files::split(source, &mut report);
    let mut around = Program::empty(Origin::Imported, Name::new("openplc", Span::default()));
    for document in &files.documents {
        let root = document.root();
        if root.member("data").is_some_and(|data| data.member("body").is_some()) {
            // A POU of an early project, in a file of its own.
        } else if root.member("meta").is_some() || root.member("data").is_some() {
            project::read(root, &mut around, &mut report);
        } else {
            let message = "this is JSON, but neither an OpenPLC project nor a unit of one";
            report.error(Code::UnknownFormat, root.span(), message);
        }
    }
    // What runs is settled when the units of all files are known.
    let task_instances = std::mem::take(&mut around.instances);
    let named = around.name.clone();
    let Parsed { mut program, diagnostics } =
        structured_text::parse_within(&Source::new(source.name(), files.masked), around);
    program.instances = task_instances;

    let mut drawn: Vec<(usize, json::Value<'_>)> = Vec::new();
    for body in &files.bodies {
        let inside = |unit: &Unit| body.file.contains(&unit.span.range().start) && unit.span.range().start < body.start;
        let unit = program.units.iter().rposition(inside);
        match unit {
            Some(unit) => drawn.push((unit, body.document.root())),
            None => {
                let place = body.document.root().span();
                report.error(
                    Code::BadElement,
                    place,
                    "no PROGRAM, FUNCTION_BLOCK or FUNCTION stands before this drawing",
                );
            }
        }
    }
    let pous = || files.documents.iter().map(json::Document::root);
    let mut written = Vec::new();
    for value in pous() {
        let own = value.member("data").filter(|data| data.member("body").is_some()).map(|_| value);
        let inner = value.member("data").into_iter().filter(|_| own.is_none());
        let inner: Vec<_> = inner.flat_map(|data| project::list(data, "pous", &mut report)).collect();
        for value in own.into_iter().chain(inner) {
            let Some((unit, body)) = pou::read(value, &program.globals, &mut report) else { continue };
            match body {
                pou::Body::Drawn(body) => drawn.push((program.units.len(), body)),
                pou::Body::Text(text) => written.push((program.units.len(), text)),
                pou::Body::None => {}
            }
            program.units.push(unit);
        }
    }
    let mut declared: Vec<&mut Unit> = program.units.iter_mut().collect();
    located::settle(&mut program.globals, &mut declared).into_iter().for_each(|problem| report.push(problem));
    let signatures = Signatures::new(&program, program.units.iter());
    let mut bodies = Vec::new();
    for (unit, body) in drawn {
        let diagram = diagram::read(body, &mut report);
        let comments = &mut program.comments;
        let (rungs, hidden) =
            graph::rungs(diagram, &program.units[unit], body.span(), &signatures, comments, &mut report);
        bodies.push((unit, rungs, hidden));
    }
    for (unit, text) in written {
        let rungs = pou::statements(source, text, &program, unit, &mut report);
        bodies.push((unit, rungs, Vec::new()));
    }
    for (unit, rungs, hidden) in bodies {
        let unit = &mut program.units[unit];
        unit.rungs.extend(rungs);
        unit.variables.extend(hidden);
    }
    name(&mut program, named);
    if program.units.is_empty() && diagnostics.is_empty() && report.is_empty() {
        let problem = "there is no program here";
        report.push(
            Diagnostic::new(Code::BadElement, Span::default(), problem)
                .hint("projects keep programs in files of their own: give the folder that holds project.json"),
        );
    }
    instances::settle(&mut program, &mut report);
    program.comments.sort_by_key(|comment| comment.span);
    let mut all = diagnostics;
    all.extend(report.finish());
    Parsed { program, diagnostics: all }
}

/// A program goes by the name of its only unit that runs, else by that of the project.
fn name(program: &mut Program, project: Name) {
    let mut programs = program.units.iter().filter(|unit| matches!(unit.kind, UnitKind::Program { .. }));
    if let (Some(only), None) = (programs.next(), programs.next()) {
        program.name = only.name.clone();
    } else if project.span != Span::default() {
        program.name = project;
    }
}
