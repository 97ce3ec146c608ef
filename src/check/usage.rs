//! What only the whole program shows: names that nothing uses, coils that overwrite each other, instances that are
//! called twice. Rungs that do not run count for the first only.

use std::collections::HashMap;

use super::Checker;
use super::model::{Place, VariableId};
use super::network::Walk;
use crate::diagnostic::{Code, Diagnostic};
use crate::ladder::{CoilKind, VariableClass};
use crate::source::Span;

/// Other places that one diagnostic names at most.
const MOST_RELATED: usize = 8;

/// What the rungs do, so far.
#[derive(Default)]
pub(super) struct Usage {
    /// The coils of each place, by the variable that has the storage.
    coils: HashMap<Place, Vec<Coil>>,
    /// The calls of each instance, and their rungs.
    pub(super) calls: HashMap<VariableId, Vec<(Span, usize)>>,
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
            self.usage.coils.entry(place).or_default().push(coil);
        }
    }

    /// Reports what the whole program shows; unused names only if all of it could be seen.
    pub(super) fn check_usage(&mut self, complete: bool) {
        let usage = std::mem::take(&mut self.usage);
        // In an order that does not depend on hashing: of too many findings the same ones are kept in every run.
        let mut places: Vec<_> = usage.coils.iter().filter(|(_, coils)| coils.len() > 1).collect();
        places.sort_by_key(|(place, _)| (place.variable, place.pin, place.bit));
        for (_, coils) in places {
            self.check_coils(coils);
        }
        let mut instances: Vec<_> = usage.calls.iter().filter(|(_, calls)| calls.len() > 1).collect();
        instances.sort_by_key(|(id, _)| **id);
        for (id, calls) in instances {
            self.check_calls(*id, calls);
        }
        if complete {
            self.check_unused();
        }
    }

    fn check_coils(&mut self, coils: &[Coil]) {
        let [first, .., last] = coils else { return };
        if coils.iter().all(|coil| coil.latches) {
            return;
        }
        let name = |coil: &Coil| &self.scope.entry(coil.variable).variable.name;
        let rungs = self.both(first.rung, last.rung);
        let mut problem =
            Diagnostic::new(Code::DoubleCoil, last.span, format!("`{}` is written by coils in {rungs}", name(last)))
                .hint("the last one decides; join the circuits in one rung, or use only set and reset coils");
        for coil in coils[..coils.len() - 1].iter().take(MOST_RELATED) {
            problem = problem
                .related(coil.span, format!("`{}` is written here, in {}", name(coil), self.rung_name(coil.rung)));
        }
        self.report.push(problem);
    }

    fn check_calls(&mut self, id: VariableId, calls: &[(Span, usize)]) {
        let [(first, first_rung), .., (last, last_rung)] = calls else { return };
        let name = &self.scope.entry(id).variable.name;
        let message = format!("`{name}` is called in {}", self.both(*first_rung, *last_rung));
        let problem = Diagnostic::new(Code::RepeatedBlock, *last, message)
            .related(*first, "called first here")
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
