//! Jumps: a straight line has none, so everything runs, and what a jump leaves out keeps what it held.
//!
//! A hidden slot holds the number of the rung at which execution goes on. Where a jump may lead over a place, all
//! stores there are under the condition that none does. A program without jumps must come out as if this module were
//! not there.

use super::Lowering;
use crate::check::RungIndex;
use crate::elementary::{Elementary, Value};
use crate::logic::{Compare, SlotId, ValueId};

/// The jumps before the place that lowering has come to.
#[derive(Default)]
pub(super) struct Jumps {
    /// The furthest target of all.
    furthest: Option<RungIndex>,
    /// Whether no jump leads over this place; `None` where none can. A value of this section, since none crosses
    /// a chunk.
    live: Option<ValueId>,
}

impl Lowering<'_> {
    /// At the start of a rung: jumps to it end here, those to later ones lead over it.
    pub(super) fn land(&mut self, rung: RungIndex) {
        self.jumps.live = self.jumps.furthest.filter(|furthest| *furthest > rung).map(|_| {
            let goes_on = self.logic.load(self.slots.jump());
            let here = self.number(rung);
            self.logic.compare(Compare::LessOrEqual, goes_on, here)
        });
    }

    /// A jump; gives the power on its right, of which there is none.
    pub(super) fn jump(&mut self, target: RungIndex, power: ValueId) -> ValueId {
        let taken = self.unless_jumped(Some(power)).unwrap_or(power);
        // Before the first jump, what the slot holds is of the last scan.
        let otherwise = match self.jumps.furthest {
            None => self.number(RungIndex(0)),
            Some(_) => self.logic.load(self.slots.jump()),
        };
        let goes_on = self.number(target);
        let goes_on = self.logic.select(taken, goes_on, otherwise);
        self.logic.store(self.slots.jump(), goes_on);
        let stays = self.logic.not(power);
        self.jumps.live = self.unless_jumped(Some(stays));
        self.jumps.furthest = self.jumps.furthest.max(Some(target));
        self.logic.bool(false)
    }

    /// Sets a slot, unless a jump leaves this out.
    pub(super) fn store(&mut self, slot: SlotId, value: ValueId) {
        self.logic.store_if(self.jumps.live, slot, value);
    }

    /// The condition for what runs under a condition, or always, with jumps taken into account.
    pub(super) fn unless_jumped(&mut self, condition: Option<ValueId>) -> Option<ValueId> {
        match (self.jumps.live, condition) {
            (Some(live), Some(condition)) => Some(self.logic.and(live, condition)),
            (live, condition) => live.or(condition),
        }
    }

    fn number(&mut self, rung: RungIndex) -> ValueId {
        self.logic.constant(Value::from_bits(Elementary::Udint, u64::from(rung.0)))
    }
}
