//! Configurations, resources, tasks and program instances.

use super::Report;
use super::xml::Node;
use crate::diagnostic::Code;
use crate::frontend::events::Event;
use crate::frontend::graph::expression;
use crate::ladder::{Expression, ExpressionKind, Literal, Name, Program, ProgramInstance, Task};
use crate::source::Span;

/// Reads tasks and program instances; gives the tasks that an event starts.
pub(super) fn read(places: &[Node<'_, '_>], program: &mut Program, report: &mut Report) -> Vec<Event> {
    let mut events = Vec::new();
    for place in places {
        for what in ["accessVars", "configVars"] {
            for list in place.all(what).filter(|list| list.children().next().is_some()) {
                report.not_supported(format!("`{what}` of a configuration"), list.span());
            }
        }
        for task in place.all("task") {
            let Some(name) = task.attribute("name") else {
                report.error(Code::BadElement, task.span(), "this `<task>` has no name");
                continue;
            };
            let name = Name::new(name, task.span());
            let interval = task.attribute("interval").and_then(|text| interval(text, task.span(), report));
            let priority = task.attribute("priority").map(|text| expression::expression(text, task.span()));
            let priority = priority.and_then(|priority| report.read(priority, task.span()));
            if let Some(trigger) = task.attribute("single") {
                let trigger = report.read(expression::expression(trigger, task.span()), task.span());
                events.extend(trigger.map(|trigger| Event { task: name.clone(), trigger, span: task.span() }));
            }
            program.tasks.push(Task { name: name.clone(), interval, priority, span: task.span() });
            for instance in task.all("pouInstance") {
                program.instances.extend(self::instance(instance, Some(&name), report));
            }
        }
        for instance in place.all("pouInstance") {
            program.instances.extend(self::instance(instance, None, report));
        }
    }
    events
}

/// CODESYS names the program alone, which is its own only instance.
fn instance(node: Node<'_, '_>, task: Option<&Name>, report: &mut Report) -> Option<ProgramInstance> {
    let (name, program) = (node.attribute("name"), node.attribute("typeName"));
    let (Some(name), Some(program)) = (name.or(program), program.or(name)) else {
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
