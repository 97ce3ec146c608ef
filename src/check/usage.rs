//! What only the whole program shows: names that nothing uses, coils that overwrite each other, instances that are
//! called twice. Rungs that do not run count for the first only. It must never depend on the order of a hash map, so
//! that of too many findings the same ones are kept in every run.

use super::Checker;
use super::model::{Place, VariableId};
use super::network::Walk;
use super::report::clipped;
use crate::diagnostic::{Code, Diagnostic};
use crate::ladder::{CoilKind, VariableClass};
use crate::source::Span;

/// Other places that one diagnostic names at most.
const MOST_RELATED: usize = 8;

/// What the rungs that run do, in their order.
#[derive(Default)]
pub(super) struct Usage {
    /// The coils, each with its place by the variable that has the storage.
    coils: Vec<(Place, Coil)>,
    /// The calls.
    calls: Vec<(VariableId, Call)>,
}

struct Call {
    span: Span,
    rung: usize,
}

struct Coil {
    variable: VariableId,
    span: Span,
    rung: usize,
    /// Whether it writes only while it has power, so that others do not disturb it nor it them.
    latches: bool,
}

impl Checker<'_> {
    pub(super) fn note_coil(&mut self, kind: CoilKind, target: Place, span: Span, walk: &Walk) {
        if walk.enabled {
            let latches = matches!(kind, CoilKind::Set | CoilKind::Reset);
            let coil = Coil { variable: target.variable, span, rung: walk.rung, latches };
            let place = Place { variable: self.scope.storage(target.variable), ..target };
            self.usage.coils.push((place, coil));
        }
    }

    pub(super) fn note_call(&mut self, instance: VariableId, span: Span, walk: &Walk) {
        if walk.enabled {
            self.usage.calls.push((instance, Call { span, rung: walk.rung }));
        }
    }

    /// Reports what the whole program shows; unused names only if all of it could be seen.
    pub(super) fn check_usage(&mut self, complete: bool) {
        let Usage { mut coils, mut calls } = std::mem::take(&mut self.usage);
        // Both sorts keep the order of the rungs among equals.
        coils.sort_by_key(|(place, _)| (place.variable, place.pin, place.bit));
        for group in coils.chunk_by(|(a, _), (b, _)| a == b) {
            self.check_coils(group);
        }
        calls.sort_by_key(|(instance, _)| *instance);
        for group in calls.chunk_by(|(a, _), (b, _)| a == b) {
            self.check_calls(group);
        }
        if complete {
            self.check_unused();
        }
    }

    /// The coils of one place.
    fn check_coils(&mut self, coils: &[(Place, Coil)]) {
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
            let note = format!("`{}` is written here, in {}", name(coil), self.rung_name(coil.rung));
            problem = problem.related(coil.span, note);
        }
        self.report.push(problem);
    }

    /// The calls of one instance.
    fn check_calls(&mut self, calls: &[(VariableId, Call)]) {
        let [(id, first), .., (_, last)] = calls else { return };
        let name = &self.scope.entry(*id).variable.name;
        let message = format!("`{name}` is called in {}", self.both(first.rung, last.rung));
        let problem = Diagnostic::new(Code::RepeatedBlock, last.span, message)
            .related(first.span, "called first here")
            .hint("an instance has one memory, and each call changes it; give each call its own");
        self.report.push(problem);
    }

    fn both(&self, first: usize, last: usize) -> String {
        if first == last {
            format!("{}, more than once", self.rung_name(first))
        } else {
            format!("{} and {}", self.rung_name(first), self.rung_name(last))
        }
    }

    fn check_unused(&mut self) {
        for id in self.scope.ids() {
            let entry = self.scope.entry(id);
            let variable = &entry.variable;
            if entry.mentioned || variable.name.starts_with('_') {
                continue;
            }
            let what = match variable.class {
                VariableClass::Input => "reads the input",
                VariableClass::Output => "writes the output",
                VariableClass::Memory => "uses",
                VariableClass::Constant => "uses the constant",
            };
            let problem =
                Diagnostic::new(Code::UnusedName, variable.span, format!("no rung {what} `{}`", variable.name));
            self.report.push(problem.hint("a name that starts with `_` may stay unused"));
        }
    }
}
