//! Which programs run, in a format that lists the instances of programs.

use std::collections::{HashMap, HashSet};

use super::graph::report::Report;
use crate::diagnostic::{Code, Diagnostic};
use crate::ladder::{Name, Program, Unit, UnitKind};

/// Where no program has two instances, lets each run under its own name; reports instances of no program; and keeps programs
/// from running that no instance names, where there are instances.
pub(super) fn settle(program: &mut Program, report: &mut Report) {
    let mut counts: HashMap<String, usize> = HashMap::new();
    for instance in &program.instances {
        *counts.entry(instance.program.key()).or_default() += 1;
    }
    if counts.is_empty() {
        return;
    }
    let is_program = |unit: &&Unit| matches!(unit.kind, UnitKind::Program { .. });
    let known: HashSet<String> = program.units.iter().filter(is_program).map(|unit| unit.name.key()).collect();
    for instance in program.instances.iter().filter(|instance| !known.contains(&instance.program.key())) {
        let message = format!("there is no program `{}`", instance.program.text);
        report.error(Code::UndeclaredName, instance.span, message);
    }
    let mut tasks: HashMap<String, Option<Name>> = HashMap::new();
    if counts.values().all(|count| *count == 1) {
        let instances = std::mem::take(&mut program.instances);
        tasks = instances.into_iter().map(|instance| (instance.program.key(), instance.task)).collect();
    }
    for unit in &mut program.units {
        let UnitKind::Program { task } = &mut unit.kind else { continue };
        let name = unit.name.key();
        if let Some(found) = tasks.remove(&name) {
            *task = found;
        }
        if !counts.contains_key(&name) {
            let message = format!("no task runs the program `{}`", unit.name.text);
            report.push(Diagnostic::new(Code::NeverRuns, unit.span, message).hint("its rungs are read as `rung off`"));
            unit.rungs.iter_mut().for_each(|rung| rung.enabled = false);
        }
    }
}
