//! What only the whole program shows: names that nothing uses, coils that overwrite each other, instances that are
//! called twice. Rungs that do not run count for the first only. It must never depend on the order of a hash map, so
//! that of too many findings the same ones are kept in every run.

use std::collections::HashMap;

use lean_string::LeanString;

use super::Checker;
use super::model::{Input, Place, VariableId, Wire};
use super::network::Walk;
use super::register::is_constant;
use super::report::clipped;
use crate::diagnostic::{Code, Diagnostic};
use crate::elementary::Value;
use crate::ladder::library::{StandardBlock, Takes};
use crate::ladder::{CoilKind, VariableClass};
use crate::source::Span;

/// Other places that one diagnostic names at most.
const MOST_RELATED: usize = 8;

/// What the rungs that run do, in their order.
#[derive(Default)]
pub(super) struct Usage {
    /// The coils, each with its place by the variable that has the storage.
    coils: Vec<(Key, Coil)>,
    /// The calls.
    calls: Vec<(Key, Call)>,
    /// What each instance was given at pins that take constants only, and where first.
    constants: HashMap<(Key, usize), (Value, Span)>,
}

/// What tells two places apart: the variable that has the storage, the way from there, and the bit. Places with a computed index
/// have none.
type Key = (VariableId, LeanString, Option<u8>);

struct Call {
    instance: VariableId,
    span: Span,
    rung: RungPlace,
}

/// A rung: its unit, and its place there. There is one of these for each coil.
type RungPlace = (u32, u32);

fn place_of(walk: &Walk) -> RungPlace {
    // A rung takes more than a byte of a source, so that 32 bits are enough.
    let number = |index: usize| u32::try_from(index).unwrap_or(u32::MAX);
    (number(walk.unit), number(walk.rung))
}

struct Coil {
    variable: VariableId,
    span: Span,
    rung: RungPlace,
    /// Whether it writes only while it has power, so that others do not disturb it nor it them.
    latches: bool,
}

impl Checker<'_> {
    pub(super) fn note_coil(&mut self, kind: CoilKind, target: &Place, span: Span, walk: &Walk) {
        if walk.enabled
            && let Some(key) = self.key(target)
        {
            let latches = matches!(kind, CoilKind::Set | CoilKind::Reset);
            let coil = Coil { variable: target.variable, span, rung: place_of(walk), latches };
            self.usage.coils.push((key, coil));
        }
    }

    pub(super) fn note_call(&mut self, instance: &Place, span: Span, walk: &Walk) {
        if walk.enabled
            && !walk.conditional
            && let Some(key) = self.key(instance)
        {
            self.usage.calls.push((key, Call { instance: instance.variable, span, rung: place_of(walk) }));
        }
    }

    /// Reports a call that gives an instance another constant than an earlier one: what it remembers is of the kind that the
    /// constant says.
    pub(super) fn check_same_constants(
        &mut self,
        block: StandardBlock,
        instance: &Place,
        inputs: &[Input],
        span: Span,
    ) {
        // What a reference names is not of the instance, and each call may take another length of it.
        if block.inputs().iter().any(|pin| pin.takes == Takes::Reference) {
            return;
        }
        let Some(key) = self.key(instance) else { return };
        for (pin, declared) in block.inputs().iter().enumerate().filter(|(_, pin)| pin.takes == Takes::Constant) {
            let given = inputs.iter().find(|input| input.pin == pin);
            let Some(Wire::Value(value)) = given.map(|input| &input.wire) else { continue };
            let Some(value) = value.constant() else { continue };
            let (first, place) = *self.usage.constants.entry((key.clone(), pin)).or_insert((value, span));
            if first != value {
                let number = |value: Value| value.as_integer().unwrap_or_default();
                let message =
                    format!("`{}` is {} here, and {} in another call", declared.name, number(value), number(first));
                let problem = Diagnostic::new(Code::WrongArguments, span, message).related(place, "the other call");
                self.report.push(problem.hint("an instance is of one kind; give each call its own"));
            }
        }
    }

    fn key(&self, place: &Place) -> Option<Key> {
        if !is_constant(place) {
            return None;
        }
        let path = if place.path.is_empty() { LeanString::new() } else { format!("{:?}", place.path).into() };
        Some((self.scope.storage(place.variable), path, place.bit))
    }

    /// Reports what the rungs of all units show together.
    pub(super) fn check_usage(&mut self) {
        let Usage { mut coils, mut calls, .. } = std::mem::take(&mut self.usage);
        // Both sorts keep the order of the rungs among equals.
        coils.sort_by(|(a, _), (b, _)| a.cmp(b));
        for group in coils.chunk_by(|(a, _), (b, _)| a == b) {
            self.check_coils(group);
        }
        calls.sort_by(|(a, _), (b, _)| a.cmp(b));
        for group in calls.chunk_by(|(a, _), (b, _)| a == b) {
            self.check_calls(group);
        }
    }

    /// The coils of one place.
    fn check_coils(&mut self, coils: &[(Key, Coil)]) {
        let [earlier @ .., (_, last)] = coils else { return };
        let Some((_, first)) = earlier.first() else { return };
        if coils.iter().all(|(_, coil)| coil.latches) {
            return;
        }
        let name = |coil: &Coil| clipped(&self.scope.entry(coil.variable).variable.name);
        let message = format!("`{}` is written by coils in {}", name(last), self.both(first.rung, last.rung));
        let mut problem = Diagnostic::new(Code::DoubleCoil, last.span, message)
            .hint("the last one decides; join the circuits in one rung, or use only set and reset coils");
        for (_, coil) in earlier.iter().take(MOST_RELATED) {
            let note = format!("`{}` is written here, in {}", name(coil), self.rung_in_unit(coil.rung));
            problem = problem.related(coil.span, note);
        }
        self.report.push(problem);
    }

    /// The calls of one instance.
    fn check_calls(&mut self, calls: &[(Key, Call)]) {
        let [(_, first), .., (_, last)] = calls else { return };
        let name = &self.scope.entry(first.instance).variable.name;
        let message = format!("`{name}` is called in {}", self.both(first.rung, last.rung));
        let problem = Diagnostic::new(Code::RepeatedBlock, last.span, message)
            .related(first.span, "called first here")
            .hint("an instance has one memory, and each call changes it; give each call its own");
        self.report.push(problem);
    }

    fn both(&self, first: RungPlace, last: RungPlace) -> String {
        if first == last {
            format!("{}, more than once", self.rung_in_unit(first))
        } else {
            format!("{} and {}", self.rung_in_unit(first), self.rung_in_unit(last))
        }
    }

    /// A rung by its name or number, and its unit where there are several.
    fn rung_in_unit(&self, (unit, rung): RungPlace) -> String {
        let (unit, rung) = (unit as usize, rung as usize);
        let name = self.rung_name(unit, rung);
        match self.program.units.as_slice() {
            [_] => name,
            units => format!("{name} of {}", clipped(&units[unit].name.text)),
        }
    }

    /// Reports names that nothing uses, if all rungs could be seen.
    pub(super) fn check_unused(&mut self) {
        if !self.too_deep.is_empty() {
            return;
        }
        for id in self.scope.ids() {
            let entry = self.scope.entry(id);
            let variable = &entry.variable;
            if entry.mentioned || variable.name.starts_with('_') {
                continue;
            }
            let what = match variable.class {
                VariableClass::Input => "reads the input",
                VariableClass::Output => "writes the output",
                VariableClass::Memory | VariableClass::InOut | VariableClass::Temporary => "uses",
                VariableClass::Constant => "uses the constant",
            };
            let problem =
                Diagnostic::new(Code::UnusedName, variable.span, format!("no rung {what} `{}`", variable.name));
            self.report.push(problem.hint("a name that starts with `_` may stay unused"));
        }
    }
}
