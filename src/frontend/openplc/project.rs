//! What `project.json` says: data types, global variables, tasks, program instances, and in early projects the POUs.

use super::json::{Kind, Value};
use super::variables::{dimensions, initial_value, name_of, type_of, variable};
use crate::diagnostic::{Code, Diagnostic};
use crate::frontend::graph::expression;
use crate::frontend::graph::report::Report;
use crate::ladder::{
    Expression, ExpressionKind, Field, Literal, Name, Program, ProgramInstance, Task, TypeDeclaration, TypeKind,
    TypeReference, VariableClass,
};
use crate::source::Span;

/// Reads all but the POUs.
pub(super) fn read(project: Value<'_>, program: &mut Program, report: &mut Report) {
    if let Some(name) = project.at(&["meta", "name"]).filter(|name| name.kind() == Kind::Text) {
        program.name = Name::new(name.text().unwrap_or_default(), name.span());
    }
    let Some(data) = project.member("data") else {
        report.error(Code::BadElement, project.span(), "this project has no `data`");
        return;
    };
    for ty in list(data, "dataTypes", report) {
        program.types.extend(data_type(ty, report));
    }
    // Early ones had `configurations`.
    let configuration = data.member("configuration").or_else(|| data.member("configurations"));
    let Some(resource) = configuration.and_then(|configuration| configuration.member("resource")) else { return };
    for global in list(resource, "globalVariables", report) {
        let variable = variable(global, report);
        program.globals.extend(variable.map(|(mut variable, _)| {
            if variable.class != VariableClass::Constant {
                variable.class = VariableClass::Memory;
            }
            variable
        }));
    }
    for value in list(resource, "tasks", report) {
        program.tasks.extend(task(value, report));
    }
    for value in list(resource, "instances", report) {
        program.instances.extend(instance(value, report));
    }
}

/// The items of a member that has to be a list where it is there.
pub(super) fn list<'d>(value: Value<'d>, name: &str, report: &mut Report) -> impl Iterator<Item = Value<'d>> + use<'d> {
    let found = value.member(name).filter(|list| list.kind() != Kind::Null);
    if let Some(other) = found.filter(|list| list.kind() != Kind::Array) {
        report.error(Code::BadElement, other.span(), format!("`{name}` is no list"));
    }
    found.filter(|list| list.kind() == Kind::Array).into_iter().flat_map(Value::items)
}

fn data_type(value: Value<'_>, report: &mut Report) -> Option<TypeDeclaration> {
    let name = name_of(value, "data type", report)?;
    let initial = value.member("initialValue");
    let kind = match value.text_of("derivation").as_deref() {
        Some("enumerated") => {
            let mut values = Vec::new();
            for item in list(value, "values", report) {
                match item.text_of("description") {
                    Some(text) => values.push((Name::new(text.trim(), item.span()), None)),
                    None => report.error(Code::BadElement, item.span(), "this value has no `description`"),
                }
            }
            let initial = initial.and_then(|initial| Some((initial.text()?, initial.span())));
            let initial = initial.filter(|(text, _)| !text.trim().is_empty());
            TypeKind::Enumeration {
                base: None,
                values,
                initial: initial.map(|(text, span)| Name::new(text.trim(), span)),
            }
        }
        Some("structure") => {
            let mut fields = Vec::new();
            for field in list(value, "variable", report) {
                let Some(name) = name_of(field, "member", report) else { continue };
                let Some(ty) = type_of(field, &name, report) else { continue };
                let initial = field.member("initialValue");
                let initial = initial.and_then(|initial| initial.at(&["simpleValue", "value"]).or(Some(initial)));
                let initial = initial.and_then(|initial| initial_value(initial, Some(&ty), report));
                fields.push(Field { name, ty, initial });
            }
            TypeKind::Structure(fields)
        }
        Some("array") => {
            let Some(base) = value.member("baseType").and_then(|base| base.text_of("value")) else {
                report.error(Code::BadElement, name.span, format!("the array `{}` has no base type", name.text));
                return None;
            };
            let dimensions = dimensions(value, report)?;
            let span = name.span;
            let ty = TypeReference { dimensions, name: Name::new(base.to_uppercase(), span), span };
            let initial = initial.and_then(|initial| initial_value(initial, Some(&ty), report));
            TypeKind::Alias { ty, initial }
        }
        other => {
            let other = expression::clipped(other.unwrap_or("nothing"));
            let message = format!("the data type `{}` is of a kind that there is not: {other}", name.text);
            report.error(Code::BadElement, name.span, message);
            return None;
        }
    };
    let span = name.span;
    Some(TypeDeclaration { name, kind, span })
}

fn task(value: Value<'_>, report: &mut Report) -> Option<Task> {
    let name = name_of(value, "task", report)?;
    let span = name.span;
    if value.text_of("triggering").is_some_and(|triggering| !triggering.eq_ignore_ascii_case("cyclic")) {
        report.not_supported("task that an event starts", span);
    }
    let interval = value.member("interval").and_then(|interval| {
        let text = interval.text().filter(|text| !text.trim().is_empty())?;
        report.read(expression::expression(&text, interval.span()), interval.span())
    });
    // Zero says that it runs as often as it can.
    let interval = interval.filter(|read| !matches!(read.kind, ExpressionKind::Literal(Literal::Time(0))));
    let priority = value.member("priority").and_then(|priority| Some((priority.number()?, priority.span())));
    let priority = priority.and_then(|(number, span)| integer(number, span, report));
    Some(Task { name, interval, priority, span })
}

fn integer(number: i64, span: Span, report: &mut Report) -> Option<Expression> {
    report.read(expression::expression(&number.to_string(), span), span)
}

fn instance(value: Value<'_>, report: &mut Report) -> Option<ProgramInstance> {
    let name = name_of(value, "program instance", report)?;
    let span = name.span;
    let Some(program) = value.text_of("program") else {
        report.push(Diagnostic::new(
            Code::BadElement,
            span,
            format!("the instance `{}` says not what program it is of", name.text),
        ));
        return None;
    };
    let task = value.text_of("task").map(|task| Name::new(task.trim(), span));
    Some(ProgramInstance { name, program: Name::new(program.trim(), span), task, span })
}
