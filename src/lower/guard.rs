//! The guard: the condition under which what is being lowered is executed. A straight line has no jumps and no branches, so
//! everything runs, and what is not executed keeps what it held.
//!
//! EN, IF, CASE and braces narrow the guard for what they hold; a jump, a RETURN and an EXIT narrow it for what they lead
//! over. A program with none of these must come out as if this module were not there.
//!
//! What can be left by a jump or RETURN is a unit; what EXIT leaves is a loop. A number says at which rung of a unit
//! execution goes on: of a program, whose rungs may lie in several chunks, in a hidden slot, else in a value.
//!
//! A function in an expression gives its value also where the expression is computed for nothing: its own variables are
//! written as if it were executed, and only what it does elsewhere is under the guard of its call, which is in `calls`.

use super::Lowering;
use crate::check::RungIndex;
use crate::elementary::{Elementary, Value};
use crate::logic::{Compare, SlotId, ValueId};

/// The guard, and what there is to come back to.
#[derive(Default)]
pub(super) struct Guard {
    /// Whether what comes now is executed; `None` where it always is. A value of this section, since none crosses a
    /// chunk.
    live: Option<ValueId>,
    /// In functions that are called within each other: the guard of each call, in the function that makes it.
    calls: Vec<Option<ValueId>>,
    /// What is being executed, the outermost first.
    scopes: Vec<Scope>,
}

struct Scope {
    kind: Kind,
    /// The guard when it was entered.
    before: Option<ValueId>,
    /// Whether something leads out of here further than behind its end.
    left: Option<ValueId>,
}

#[derive(Clone, Copy)]
enum Kind {
    /// A program, or a unit that is called.
    Unit {
        goes_on: GoesOn,
        /// The furthest target of all jumps so far.
        furthest: Option<RungIndex>,
    },
    /// A FOR.
    Loop,
    /// What a condition holds.
    Branch,
}

/// Where the number is at which execution goes on.
#[derive(Clone, Copy)]
enum GoesOn {
    /// In a slot, if the program has jumps.
    Slot(Option<SlotId>),
    /// In a value, once there was a jump.
    Value(Option<ValueId>),
}

impl Guard {
    /// How many functions that are called within each other what is lowered stands in.
    pub(super) fn functions(&self) -> usize {
        self.calls.len()
    }
}

impl Lowering<'_> {
    /// Starts a program.
    pub(super) fn enter_program(&mut self) {
        let goes_on = GoesOn::Slot(self.slots.jump);
        self.guard = Guard::default();
        self.enter(Kind::Unit { goes_on, furthest: None });
    }

    /// Starts a function block that is called, under a condition if there is one.
    pub(super) fn enter_instance(&mut self, enabled: Option<ValueId>) {
        self.enter_branch(enabled);
        self.enter(Kind::Unit { goes_on: GoesOn::Value(None), furthest: None });
    }

    /// Ends it.
    pub(super) fn leave_instance(&mut self) {
        self.leave();
        self.leave();
    }

    /// Starts a function that is called, under a condition if there is one. Gives the guard to come back to.
    pub(super) fn enter_function(&mut self, enabled: Option<ValueId>) -> Guard {
        let mut calls = self.guard.calls.clone();
        calls.push(self.executed(enabled));
        let guard = Guard { calls, ..Guard::default() };
        let caller = std::mem::replace(&mut self.guard, guard);
        self.enter(Kind::Unit { goes_on: GoesOn::Value(None), furthest: None });
        caller
    }

    /// Ends it.
    pub(super) fn leave_function(&mut self, caller: Guard) {
        self.guard = caller;
    }

    /// Starts a loop, which EXIT leaves.
    pub(super) fn enter_loop(&mut self) {
        self.enter(Kind::Loop);
    }

    /// Starts what is executed under a condition.
    pub(super) fn enter_branch(&mut self, condition: Option<ValueId>) {
        self.enter(Kind::Branch);
        self.narrow(condition);
    }

    /// What comes now is only executed under a condition, too.
    pub(super) fn narrow(&mut self, condition: Option<ValueId>) {
        self.guard.live = self.executed(condition);
    }

    fn enter(&mut self, kind: Kind) {
        self.guard.scopes.push(Scope { kind, before: self.guard.live, left: None });
    }

    /// Ends a loop or branch: all that came into it goes on, but what was led further.
    pub(super) fn leave(&mut self) {
        let Some(scope) = self.guard.scopes.pop() else { return };
        self.guard.live = scope.before;
        if let Some(left) = scope.left {
            let stays = self.logic.not(left);
            self.narrow(Some(stays));
        }
    }

    /// The condition for what runs under a condition, or always, with all that is around it taken into account.
    pub(super) fn executed(&mut self, condition: Option<ValueId>) -> Option<ValueId> {
        self.both(self.guard.live, condition)
    }

    /// The same for what has an effect outside of a function.
    pub(super) fn effective(&mut self, condition: Option<ValueId>) -> Option<ValueId> {
        self.reaching(0, condition)
    }

    /// The same for what writes the own of one of the functions that are called within each other: it is under the guards of
    /// the calls from there on.
    pub(super) fn reaching(&mut self, home: usize, condition: Option<ValueId>) -> Option<ValueId> {
        let mut reaching = self.executed(condition);
        for call in home..self.guard.calls.len() {
            reaching = self.both(self.guard.calls[call], reaching);
        }
        reaching
    }

    /// At the start of a rung: jumps to it end here, those to later ones lead over it.
    pub(super) fn land(&mut self, rung: RungIndex) {
        let Some(&Scope { kind: Kind::Unit { goes_on, furthest }, before, .. }) = self.guard.scopes.last() else {
            return;
        };
        self.guard.live = before;
        if furthest.is_some_and(|furthest| furthest > rung) {
            let goes_on = self.goes_on(goes_on);
            let here = self.number(rung);
            let lands = self.logic.compare(Compare::LessOrEqual, goes_on, here);
            self.narrow(Some(lands));
        }
    }

    /// A jump in the unit that is being executed, with power or always.
    pub(super) fn jump(&mut self, target: RungIndex, power: Option<ValueId>) {
        let units = self.guard.scopes.iter().rposition(|scope| matches!(scope.kind, Kind::Unit { .. }));
        let Some(unit) = units else { return };
        let Kind::Unit { goes_on, furthest } = self.guard.scopes[unit].kind else { return };
        let taken = self.taken(power);
        // Before the first jump, what a slot holds is of the last scan.
        let otherwise = match furthest {
            None => self.number(RungIndex(0)),
            Some(_) => self.goes_on(goes_on),
        };
        let number = self.number(target);
        let number = self.logic.select(taken, number, otherwise);
        let goes_on = match goes_on {
            GoesOn::Slot(slot) => {
                slot.into_iter().for_each(|slot| self.logic.store(slot, number));
                goes_on
            }
            GoesOn::Value(_) => GoesOn::Value(Some(number)),
        };
        self.guard.scopes[unit].kind = Kind::Unit { goes_on, furthest: furthest.max(Some(target)) };
        self.lead_out(unit, taken);
    }

    /// Leaves the innermost loop.
    pub(super) fn exit(&mut self) {
        if let Some(innermost) = self.guard.scopes.iter().rposition(|scope| matches!(scope.kind, Kind::Loop)) {
            let taken = self.taken(None);
            self.lead_out(innermost, taken);
        }
    }

    fn taken(&mut self, power: Option<ValueId>) -> ValueId {
        self.executed(power).unwrap_or_else(|| self.logic.bool(true))
    }

    /// Where `taken` holds, goes on behind what is in a scope.
    fn lead_out(&mut self, to: usize, taken: ValueId) {
        for scope in to + 1..self.guard.scopes.len() {
            let left = match self.guard.scopes[scope].left {
                None => taken,
                Some(left) => self.logic.or(left, taken),
            };
            self.guard.scopes[scope].left = Some(left);
        }
        let stays = self.logic.not(taken);
        self.narrow(Some(stays));
    }

    fn goes_on(&mut self, goes_on: GoesOn) -> ValueId {
        match goes_on {
            GoesOn::Slot(Some(slot)) => self.logic.load(slot),
            GoesOn::Value(Some(value)) => value,
            GoesOn::Slot(None) | GoesOn::Value(None) => self.number(RungIndex(0)),
        }
    }

    fn number(&mut self, rung: RungIndex) -> ValueId {
        self.logic.constant(Value::from_bits(Elementary::Udint, u64::from(rung.0)))
    }
}
