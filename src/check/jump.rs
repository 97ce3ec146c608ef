//! Jumps: where they may stand, and the rungs that they lead to. A jump must never lead backward, so that a scan ends.

use std::collections::HashMap;

use lean_string::LeanString;

use super::Checker;
use super::model::{self, RungIndex};
use super::network::{Power, Walk};
use super::report::clipped;
use super::scope::folded;
use super::spelling::{self, Budget};
use crate::diagnostic::{Code, Diagnostic};
use crate::ladder::{Branch, ElementKind, Name, Unit};
use crate::source::Span;

/// What jumps can name.
#[derive(Default)]
pub(super) struct Labels {
    /// The first rung of each name, by its place among all rungs of the unit.
    rungs: HashMap<LeanString, u32>,
    /// For each of all rungs, how many before it run: its place among those that run, or if it is off, the place of the
    /// next that is not.
    running: Vec<u32>,
    /// How many run in all.
    all_running: u32,
    budget: Budget,
}

impl Labels {
    pub(super) fn of(unit: &Unit) -> Self {
        let mut labels = Self::default();
        let mut running = 0;
        labels.running.reserve_exact(unit.rungs.len());
        for (index, rung) in (0..).zip(&unit.rungs) {
            if let Some(name) = &rung.name {
                labels.rungs.entry(folded(&name.text).into()).or_insert(index);
            }
            labels.running.push(running);
            running += u32::from(rung.enabled);
        }
        labels.all_running = running;
        labels
    }

    /// What can be jumped to that is nearest to a name that no rung has.
    fn suggest(&mut self, unit: &Unit, name: &str) -> Option<String> {
        let names =
            unit.rungs.iter().filter_map(|rung| rung.name.as_ref()).map(|name| name.text.as_str()).chain(["return"]);
        spelling::nearest(name, names, &mut self.budget).map(str::to_owned)
    }

    /// The first rung of a name, by its place.
    fn rung(&self, name: &Name) -> Option<usize> {
        self.rungs.get(folded(&name.text).as_ref()).map(|rung| *rung as usize)
    }

    /// The name of a rung of the unit before this one that is called the same.
    pub(super) fn earlier(&self, unit: &Unit, name: &Name, index: usize) -> Option<Span> {
        self.rung(name).filter(|first| *first < index).and_then(|first| Some(unit.rungs[first].name.as_ref()?.span))
    }
}

impl Checker<'_> {
    /// A jump to a rung, or without one out of the program.
    pub(super) fn jump(
        &mut self,
        target: Option<&Name>,
        span: Span,
        left: Power,
        walk: &mut Walk,
    ) -> Option<model::Element> {
        walk.effect(left);
        if walk.in_pin {
            self.jump_in_pin(span);
        }
        let Some(target) = target else { return Some(model::Element::Return) };
        let Some(index) = self.labels.rung(target) else {
            let problem =
                Diagnostic::new(Code::UndeclaredName, target.span, format!("no rung is called `{}`", target.text));
            let drawn = self.drawn();
            let hint = self.labels.suggest(drawn, &target.text).map(|near| format!("did you mean `{near}`?"));
            self.report.push(Diagnostic { hint, ..problem });
            return None;
        };
        if index <= walk.rung {
            let name = clipped(&target.text);
            let message = if index == walk.rung {
                format!("`{name}` is the rung of this jump itself: a scan runs each rung once")
            } else {
                format!("`{name}` stands before this jump: a scan goes through the rungs once, from first to last")
            };
            let problem = Diagnostic::new(Code::BackwardJump, target.span, message);
            let defined = self.drawn().rungs[index].name.as_ref().map_or(target.span, |name| name.span);
            self.report.push(
                problem.related(defined, "the rung is here").hint(
                    "the next scan comes to that rung by itself; keep in a variable what it must know until then",
                ),
            );
            return None;
        }
        let place = self.labels.running[index];
        let ends = place == self.labels.all_running;
        Some(if ends { model::Element::Return } else { model::Element::Jump(RungIndex(place)) })
    }

    pub(super) fn jump_in_pin(&mut self, span: Span) {
        let problem = Diagnostic::new(Code::MisplacedJump, span, "a jump cannot stand in a circuit at a pin");
        self.report.push(problem.hint("that circuit only gives a value; jump from a branch of the rung itself"));
    }

    /// Reports the jump of a branch that goes on behind it.
    pub(super) fn check_jumps_end(&mut self, branch: &Branch) {
        let is_jump = |kind: &ElementKind| matches!(kind, ElementKind::Jump { .. } | ElementKind::Return);
        let ends = branch.elements.len() - usize::from(branch.to.is_none() && !branch.elements.is_empty());
        for element in branch.elements[..ends].iter().filter(|element| is_jump(&element.kind)) {
            let problem = Diagnostic::new(Code::MisplacedJump, element.span, "a jump ends its branch");
            self.report
                .push(problem.hint("what runs without the jump stands on a branch of its own: `[ a >> r40 | b ]`"));
        }
    }
}
