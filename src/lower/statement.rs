//! Statements: each is executed under the guard of where it stands.
//!
//! A FOR is unrolled. While it is, what its variable holds is known, so that an index that is made of it is a constant; but
//! no longer than until something else writes the variable.

use super::Lowering;
use super::storage::Cells;
use crate::check::{Expression, Place, Statement};
use crate::elementary::Value;
use crate::logic::{Compare, SlotId, ValueId};

/// The variable of a loop that is being unrolled.
pub(super) struct Counter {
    slot: SlotId,
    /// What it holds, as long as that is known.
    value: Option<Value>,
}

impl Lowering<'_> {
    /// Braces; gives the power on their right.
    pub(super) fn braces(&mut self, statements: &[Statement], left: ValueId) -> ValueId {
        let outer = self.failed.take();
        self.enter_branch(Some(left));
        self.statements(statements);
        self.leave();
        match std::mem::replace(&mut self.failed, outer) {
            None => left,
            Some(failed) => {
                let went_well = self.logic.not(failed);
                self.logic.and(left, went_well)
            }
        }
    }

    fn statements(&mut self, statements: &[Statement]) {
        for statement in statements {
            self.statement(statement);
        }
    }

    fn statement(&mut self, statement: &Statement) {
        match statement {
            Statement::Assignment { target, value } => {
                let outer = self.begin(None);
                let value = self.expression(value);
                let target = self.spot(target);
                self.store(target, value, None);
                let in_range = self.end(outer);
                self.note_failure(in_range, None);
            }
            Statement::Copy { target, source, done } => {
                let outer = self.begin(None);
                let source = self.part(source);
                let target = self.part(target);
                let done = done.as_ref().map(|done| self.spot(done));
                self.copy(target, source, None);
                let in_range = self.end(outer);
                if let Some(done) = done {
                    let in_range = in_range.unwrap_or_else(|| self.logic.bool(true));
                    self.store(done, in_range, None);
                }
                self.note_failure(in_range, None);
            }
            Statement::Call(call) => {
                let called = self.call(call, None);
                self.note_failure(called.in_range, called.enabled);
            }
            Statement::If { branches, otherwise } => {
                self.enter_branch(None);
                for (condition, body) in branches {
                    let holds = self.operand_of_statement(condition);
                    self.alternative(holds, body);
                }
                self.statements(otherwise);
                self.leave();
            }
            Statement::Case { selector, branches, otherwise } => {
                self.enter_branch(None);
                let selector = self.operand_of_statement(selector);
                for (labels, body) in branches {
                    let matches = self.matches(selector, labels);
                    self.alternative(matches, body);
                }
                self.statements(otherwise);
                self.leave();
            }
            Statement::For { variable, first, step, count, body } => {
                self.repeat(variable, *first, *step, *count, body);
            }
            Statement::Exit => self.exit(),
            Statement::Return => self.jump(self.unit.end, None),
        }
    }

    /// What a statement decides by.
    fn operand_of_statement(&mut self, expression: &Expression) -> ValueId {
        let outer = self.begin(None);
        let value = self.expression(expression);
        let in_range = self.end(outer);
        self.note_failure(in_range, None);
        value
    }

    /// The body under a condition; what comes behind is executed where the condition does not hold.
    fn alternative(&mut self, condition: ValueId, body: &[Statement]) {
        self.enter_branch(Some(condition));
        self.statements(body);
        self.leave();
        let otherwise = self.logic.not(condition);
        self.narrow(Some(otherwise));
    }

    fn matches(&mut self, selector: ValueId, labels: &[(Value, Value)]) -> ValueId {
        let mut any = None;
        for (first, last) in labels {
            let low = self.logic.constant(*first);
            let matches = if first == last {
                self.logic.compare(Compare::Equal, selector, low)
            } else {
                let high = self.logic.constant(*last);
                let above = self.logic.compare(Compare::GreaterOrEqual, selector, low);
                let below = self.logic.compare(Compare::LessOrEqual, selector, high);
                self.logic.and(above, below)
            };
            any = Some(any.map_or(matches, |any| self.logic.or(any, matches)));
        }
        any.unwrap_or_else(|| self.logic.bool(false))
    }

    fn repeat(&mut self, variable: &Place, first: Value, step: i128, count: u32, body: &[Statement]) {
        self.enter_loop();
        let edges = self.unit.edges.clone();
        let depth = self.counters.len();
        for time in 0..count {
            // Each time the body's edges are the same ones.
            self.unit.edges = edges.clone();
            self.count(variable, stepped(first, step, time));
            self.statements(body);
            self.counters.truncate(depth);
        }
        self.count(variable, stepped(first, step, count));
        self.counters.truncate(depth);
        self.leave();
    }

    /// Sets the variable of a loop, and knows from then on what it holds.
    fn count(&mut self, variable: &Place, value: Value) {
        let outer = self.begin(None);
        let spot = self.spot(variable);
        let held = self.logic.constant(value);
        self.store(spot, held, None);
        let in_range = self.end(outer);
        self.note_failure(in_range, None);
        // What a function writes elsewhere is perhaps not written.
        if let Some(slot) = spot.slot().filter(|_| spot.home == self.guard.functions()) {
            self.counters.push(Counter { slot, value: Some(value) });
        }
    }

    /// What the variable of a loop holds, if the place is one and that is known.
    pub(super) fn counter(&self, place: &Place) -> Option<Value> {
        if self.counters.is_empty() || !place.path.is_empty() {
            return None;
        }
        let slot = self.variable(place.variable).value().filter(|_| place.bit.is_none())?.slot()?;
        self.counters.iter().rev().find(|counter| counter.slot == slot)?.value
    }

    /// Something is written to a run: what the variables of loops in it hold is not known any longer.
    pub(super) fn forget(&mut self, cells: Cells) {
        for counter in &mut self.counters {
            if (cells.first.0..cells.first.0 + cells.count).contains(&counter.slot.0) {
                counter.value = None;
            }
        }
    }

    /// Notes for the braces around it that an index was out of range in what was executed.
    fn note_failure(&mut self, in_range: Option<ValueId>, enabled: Option<ValueId>) {
        let Some(in_range) = in_range else { return };
        let outside = self.logic.not(in_range);
        let enabled = self.both(Some(outside), enabled);
        let failed = self.executed(enabled);
        self.failed = match (self.failed, failed) {
            (Some(before), Some(failed)) => Some(self.logic.or(before, failed)),
            (before, failed) => before.or(failed),
        };
    }
}

/// What the variable of a loop holds after so many steps: as all integers, it wraps around.
fn stepped(first: Value, step: i128, times: u32) -> Value {
    let value = first.as_integer().unwrap_or_default().wrapping_add(step.wrapping_mul(i128::from(times)));
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "the low 64 bits are the register form"
    )]
    Value::from_bits(first.ty(), value as u64)
}
