//! Tasks that an event starts (`SINGLE := trigger`): their programs run in every round in which the trigger has become TRUE.
//!
//! There is no such task in the ladder. The program runs in every round, and its first rung leaves it unless the trigger rises:
//! `NOT(IN := [ ^trigger ]).OUT >> return`.

use std::collections::HashMap;

use super::missing::Missing;
use crate::diagnostic::Diagnostic;
use crate::ladder::{
    Argument, BlockCall, Branch, Circuit, ContactKind, Element, ElementKind, Expression, ExpressionKind, Name, Program,
    Reference, Root, Rung, UnitKind, Wire,
};
use crate::source::Span;

/// A task and what starts it.
pub(super) struct Event {
    pub(super) task: Name,
    pub(super) trigger: Expression,
    pub(super) span: Span,
}

/// Gives the programs of such tasks their first rung. What cannot be said so is not supported: a program with several
/// instances, a task that runs at an interval too, and a trigger that is no variable which the program sees.
pub(super) fn settle(program: &mut Program, events: Vec<Event>) -> Vec<Diagnostic> {
    let mut missing = Missing::default();
    let mut counts: HashMap<String, usize> = HashMap::new();
    for instance in &program.instances {
        *counts.entry(instance.program.key()).or_default() += 1;
    }
    for Event { task, trigger, span } in events {
        let is_periodic = program.tasks.iter().any(|known| known.name.key() == task.key() && known.interval.is_some());
        let ExpressionKind::Read(reference) = &trigger.kind else {
            missing.note("a task that a value starts", span);
            continue;
        };
        if is_periodic {
            missing.note("a task that runs at an interval and at an event", span);
            continue;
        }
        let listed = |unit: &str| {
            let of_task = |of: &Option<Name>| of.as_ref().is_some_and(|of| of.key() == task.key());
            program.instances.iter().any(|instance| instance.program.key() == unit && of_task(&instance.task))
        };
        let started: Vec<bool> = program
            .units
            .iter()
            .map(|unit| match &unit.kind {
                UnitKind::Program { task: own } => {
                    own.as_ref().is_some_and(|own| own.key() == task.key()) || listed(&unit.name.key())
                }
                _ => false,
            })
            .collect();
        for (unit, _) in program.units.iter_mut().zip(started).filter(|(_, started)| *started) {
            let hides = match &reference.root {
                Root::Name(name) => unit.variables.iter().any(|variable| variable.name.key() == name.key()),
                Root::Address(_) => false,
            };
            if hides || counts.get(&unit.name.key()).is_some_and(|count| *count > 1) {
                missing.note("an event that starts several instances of a program", span);
                continue;
            }
            unit.rungs.insert(0, leave_unless(&trigger, span));
        }
    }
    missing.into_diagnostics().collect()
}

fn leave_unless(trigger: &Expression, span: Span) -> Rung {
    let branch = |elements: Vec<Element>| Branch { from: None, elements, to: None, span };
    let element = |kind: ElementKind| Element { kind, span };
    let rises = element(ElementKind::Contact { kind: ContactKind::Rising, operand: trigger.clone() });
    let inner = Circuit { branches: vec![branch(vec![rises])], span };
    let argument = Argument { pin: Name::new("IN", span), wire: Wire::Circuit(inner), span };
    let not = ElementKind::Block(Box::new(BlockCall {
        instance: Reference::of_name(Name::new("NOT", span)),
        type_name: None,
        arguments: vec![argument],
        power_output: Some(Name::new("OUT", span)),
    }));
    let elements = vec![element(not), element(ElementKind::Return)];
    let circuit = Circuit { branches: vec![branch(elements)], span };
    Rung { name: None, title: Some("runs at an event".into()), enabled: true, circuit, span }
}
