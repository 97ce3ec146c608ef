//! Any program as PLCopen TC6 XML, with a layout that editors show. Read again it has the same trace.
//!
//! Rungs become networks in LD. A body that holds what LD has not (statements, rungs that are off), or whose elements would
//! run in another order when they are drawn, becomes structured text, as a whole: a POU has one language. Nothing is left
//! out silently: what cannot be written is a diagnostic.

mod declarations;
mod drawing;
mod order;
mod pins;
mod rungs;
mod xml;

use self::xml::Xml;
use crate::diagnostic::{Code, Diagnostic};
use crate::frontend::graph::types::Signatures;
use crate::frontend::structured_text::print::{Instances, Names, Words, body, instances, of_units, used};
use crate::ladder::{Program, Unit, UnitKind, key};

/// Prints a program, which may come from any front end; it should have been checked.
///
/// # Errors
/// A diagnostic for each part that neither LD nor structured text has, such as the register machine.
pub fn print(program: &Program) -> Result<String, Vec<Diagnostic>> {
    let mut problems = Vec::new();
    if let Some(registers) = &program.registers {
        let message = "the registers of the register machine have no counterpart";
        problems.push(Diagnostic::new(Code::CannotConvert, registers.span, message));
    }
    let mut names = Names::of(program);
    let instances = named(program, instances(program, &mut names), &mut names);
    let signatures = Signatures::new(program, program.units.iter());
    let mut xml = Xml::document();
    let namespaces = [
        ("xmlns", "http://www.plcopen.org/xml/tc6_0201"),
        ("xmlns:xhtml", "http://www.w3.org/1999/xhtml"),
        ("xmlns:xsd", "http://www.w3.org/2001/XMLSchema"),
    ];
    xml.element("project", &namespaces, |xml| {
        header(xml, program);
        xml.element("types", &[], |xml| {
            declarations::types(xml, program, Words { names: &names });
            xml.element("pous", &[], |xml| {
                for place in of_units(program) {
                    let unit = &program.units[place];
                    pou(xml, program, unit, &signatures, &instances, &mut names, &mut problems);
                }
            });
        });
        declarations::configuration(xml, program, &instances, Words { names: &names });
    });
    if problems.is_empty() { Ok(xml.finish()) } else { Err(problems) }
}

/// A reader takes the names of instances only where a program has several; else a program has its own name, which then is that
/// of its instance.
fn named(program: &Program, mut instances: Instances, names: &mut Names) -> Instances {
    let mut seen = std::collections::HashSet::new();
    if instances.list.iter().all(|(_, of, _)| seen.insert(of.clone())) {
        let of_declared = |of: &str| program.instances.iter().find(|instance| instance.program.key() == of);
        for (name, of, _) in &mut instances.list {
            instances.types.remove(of.as_str());
            if let Some(declared) = of_declared(of) {
                instances.types.insert(of.clone(), names.spell(&declared.name.text).into_owned());
            }
            *name = names.fresh("instance");
        }
    }
    instances
}

fn header(xml: &mut Xml, program: &Program) {
    // A program says nothing of when it was written, and the same program gives the same file.
    let time = "1970-01-01T00:00:00";
    xml.empty(
        "fileHeader",
        &[
            ("companyName", "unknown"),
            ("productName", &program.name.text),
            ("productVersion", "1"),
            ("creationDateTime", time),
        ],
    );
    xml.element("contentHeader", &[("name", &program.name.text), ("modificationDateTime", time)], |xml| {
        xml.element("coordinateInfo", &[], |xml| {
            for language in ["fbd", "ld", "sfc"] {
                xml.element(language, &[], |xml| xml.empty("scaling", &[("x", "10"), ("y", "10")]));
            }
        });
    });
}

fn pou(
    xml: &mut Xml,
    program: &Program,
    unit: &Unit,
    signatures: &Signatures,
    instances: &Instances,
    names: &mut Names,
    problems: &mut Vec<Diagnostic>,
) {
    let kind = match &unit.kind {
        UnitKind::Program { .. } => "program",
        UnitKind::FunctionBlock => "functionBlock",
        UnitKind::Function { .. } => "function",
    };
    let renamed = instances.types.get(&key(&unit.name.text)).filter(|_| kind == "program").cloned();
    let name = renamed.unwrap_or_else(|| names.spell(&unit.name.text).into_owned());
    let drawn = rungs::draw(program, unit, signatures, Words { names });
    let (text, added) = match drawn {
        Some(_) => (String::new(), Vec::new()),
        None => body(program, unit, names, problems),
    };
    let words = Words { names };
    let used = used(program, unit, words, problems);
    xml.element("pou", &[("name", &name), ("pouType", kind)], |xml| {
        xml.element("interface", &[], |xml| {
            if let UnitKind::Function { result: Some(result) } = &unit.kind {
                xml.element("returnType", &[], |xml| declarations::type_reference(xml, result, words));
            }
            declarations::externals(xml, &used.globals, words);
            declarations::variables(xml, &unit.variables, words);
            declarations::added(xml, used.instances.iter().chain(&added));
        });
        xml.element("body", &[], |xml| match &drawn {
            Some(drawing) => drawing.write(xml),
            None => xml.formatted("ST", &text),
        });
    });
}
