//! Configurations, resources, tasks and program instances.

use std::collections::{HashMap, HashSet};

use super::xml::Node;
use super::{Pou, Report};
use crate::diagnostic::{Code, Diagnostic};
use crate::frontend::graph::expression;
use crate::ladder::{Expression, ExpressionKind, Literal, Name, Program, ProgramInstance, Task, UnitKind, key};
use crate::source::Span;

/// The configurations of a project.
pub(super) fn configurations<'d, 'a>(root: Node<'d, 'a>) -> impl Iterator<Item = Node<'d, 'a>> {
    root.all("instances").flat_map(|instances| instances.all("configurations")).flat_map(|all| all.all("configuration"))
}

/// Reads tasks and program instances. Where no program has two instances, each runs under its own name. The result holds the
/// programs that no instance names, where there are instances.
pub(super) fn read(
    root: Node<'_, '_>,
    program: &mut Program,
    pous: &mut [Pou<'_, '_>],
    report: &mut Report,
) -> HashSet<String> {
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
    let mut counts: HashMap<String, usize> = HashMap::new();
    for instance in &program.instances {
        *counts.entry(instance.program.key()).or_default() += 1;
    }
    let known = |name: &Name| {
        pous.iter().any(|pou| pou.unit.name.key() == name.key() && matches!(pou.unit.kind, UnitKind::Program { .. }))
    };
    for instance in program.instances.iter().filter(|instance| !known(&instance.program)) {
        let message = format!("there is no program `{}`", instance.program.text);
        report.error(Code::UndeclaredName, instance.span, message);
    }
    let programs = pous.iter().filter(|pou| matches!(pou.unit.kind, UnitKind::Program { .. }));
    let idle = programs.map(|pou| pou.unit.name.key()).filter(|name| !counts.is_empty() && !counts.contains_key(name));
    let idle = idle.collect();
    if counts.values().all(|count| *count == 1) {
        let instances = std::mem::take(&mut program.instances);
        let mut tasks: HashMap<String, Option<Name>> =
            instances.into_iter().map(|instance| (instance.program.key(), instance.task)).collect();
        for pou in pous {
            if let UnitKind::Program { task } = &mut pou.unit.kind {
                *task = tasks.remove(&key(&pou.unit.name.text)).flatten();
            }
        }
    }
    idle
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

/// Keeps programs from running that no task runs, in a file that says what its tasks run.
pub(super) fn switch_off(program: &mut Program, idle: &HashSet<String>, report: &mut Report) {
    for unit in program.units.iter_mut().filter(|unit| idle.contains(&unit.name.key())) {
        if matches!(unit.kind, UnitKind::Program { .. }) {
            let message = format!("no task runs the program `{}`", unit.name.text);
            report.push(Diagnostic::new(Code::NeverRuns, unit.span, message).hint("its rungs are read as `rung off`"));
            for rung in &mut unit.rungs {
                rung.enabled = false;
            }
        }
    }
}
