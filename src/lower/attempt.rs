//! Indices out of range: what was noted while the places of one element or statement were computed.
//!
//! Where it is executed, a computed index out of range sets the sticky fault bit, which nothing ever clears.

use super::Lowering;
use crate::logic::ValueId;

/// What is known of the element or statement whose expressions and places are being lowered.
#[derive(Clone, Copy, Default)]
pub(super) struct Attempt {
    /// Whether it has power, beside the guard; `None` where it always has.
    power: Option<ValueId>,
    /// Whether all indices so far are in range; `None` where none was computed.
    in_range: Option<ValueId>,
}

impl Lowering<'_> {
    /// Starts one; gives that around it.
    pub(super) fn begin(&mut self, power: Option<ValueId>) -> Attempt {
        std::mem::replace(&mut self.attempt, Attempt { power, in_range: None })
    }

    /// Ends it and goes on with that around it. Gives whether all indices were in range, if any was computed.
    pub(super) fn end(&mut self, outer: Attempt) -> Option<ValueId> {
        let Attempt { power, in_range } = std::mem::replace(&mut self.attempt, outer);
        if let (Some(in_range), Some(fault)) = (in_range, self.slots.fault) {
            let outside = self.logic.not(in_range);
            let condition = self.effective(power);
            let condition = self.both(condition, Some(outside));
            let on = self.logic.bool(true);
            self.logic.store_if(condition, fault, on);
        }
        in_range
    }

    /// Notes an index, or those of several dimensions.
    pub(super) fn note_index(&mut self, in_range: ValueId) {
        self.attempt.in_range = self.both(self.attempt.in_range, Some(in_range));
    }

    /// Whether what is being lowered has power.
    pub(super) fn power(&self) -> Option<ValueId> {
        self.attempt.power
    }

    /// Two conditions, each of which may be left out.
    pub(super) fn both(&mut self, a: Option<ValueId>, b: Option<ValueId>) -> Option<ValueId> {
        match (a, b) {
            (Some(a), Some(b)) => Some(self.logic.and(a, b)),
            (a, b) => a.or(b),
        }
    }
}
