//! Configurations, resources, tasks and program instances.

use super::Report;
use super::xml::Node;
use crate::diagnostic::Code;
use crate::frontend::graph::expression;
use crate::ladder::{Expression, ExpressionKind, Literal, Name, Program, ProgramInstance, Task};
use crate::source::Span;

/// The configurations of a project.
pub(super) fn configurations<'d, 'a>(root: Node<'d, 'a>) -> impl Iterator<Item = Node<'d, 'a>> {
    root.all("instances").flat_map(|instances| instances.all("configurations")).flat_map(|all| all.all("configuration"))
}

/// Reads tasks and program instances.
pub(super) fn read(root: Node<'_, '_>, program: &mut Program, report: &mut Report) {
    for configuration in configurations(root) {
        for what in ["accessVars", "configVars"] {
            for list in configuration.all(what).filter(|list| list.children().next().is_some()) {
                report.not_supported(format!("`{what}` of a configuration"), list.span());
            }
        }
        for resource in configuration.all("resource") {
            for task in resource.all("task") {
                let Some(name) = task.attribute("name") else {
                    report.error(Code::BadElement, task.span(), "this `<task>` has no name");
                    continue;
                };
                let name = Name::new(name, task.span());
                let interval = task.attribute("interval").and_then(|text| interval(text, task.span(), report));
                let priority = task.attribute("priority").map(|text| expression::expression(text, task.span()));
                let priority = priority.and_then(|priority| report.read(priority, task.span()));
                if task.attribute("single").is_some() {
                    report.not_supported("task that an event starts", task.span());
                }
                program.tasks.push(Task { name: name.clone(), interval, priority, span: task.span() });
                for instance in task.all("pouInstance") {
                    program.instances.extend(self::instance(instance, Some(&name), report));
                }
            }
            for instance in resource.all("pouInstance") {
                program.instances.extend(self::instance(instance, None, report));
            }
        }
    }
}

fn instance(node: Node<'_, '_>, task: Option<&Name>, report: &mut Report) -> Option<ProgramInstance> {
    let (Some(name), Some(program)) = (node.attribute("name"), node.attribute("typeName")) else {
        report.error(Code::BadElement, node.span(), "this `<pouInstance>` has no name or no typeName");
        return None;
    };
    let [name, program] = [name, program].map(|text| Name::new(text, node.span()));
    Some(ProgramInstance { name, program, task: task.cloned(), span: node.span() })
}

/// `T#20ms`, and what else tools write: ISO 8601 (`PT0.02S`), or a number of milliseconds as CODESYS does.
fn interval(text: &str, span: Span, report: &mut Report) -> Option<Expression> {
    let literal = |text: &str| expression::expression(text, span);
    let read = if let Some(iso) = text.strip_prefix("PT").or_else(|| text.strip_prefix("P")) {
        literal(&format!("T#{}", iso.replace('T', "")))
    } else if text.bytes().all(|byte| byte.is_ascii_digit()) {
        literal(&format!("T#{text}ms"))
    } else if text.starts_with(|first: char| first.is_ascii_digit()) && !text.contains('#') {
        literal(&format!("T#{text}"))
    } else {
        literal(text)
    };
    let read = report.read(read, span)?;
    // Zero is how some say that a task runs as often as it can.
    Some(read).filter(|read| !matches!(read.kind, ExpressionKind::Literal(Literal::Time(0))))
}
