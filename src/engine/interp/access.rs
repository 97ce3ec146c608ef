//! When each slot was last read or written on the way through a program, also by way of an array.
//!
//! Arrays that share slots count as one, so that an access takes no longer however large the array is; a slot may by that
//! seem to have been accessed later than it was, never earlier.

use std::ops::Range;

use crate::logic::{ArrayId, Layout, SlotId};

/// The last accesses so far: one past the place of the instruction, or 0.
pub(super) struct Accesses {
    slots: Vec<usize>,
    /// The slots of arrays, in order; those that overlap are joined.
    regions: Vec<Range<SlotId>>,
    /// By region.
    arrays: Vec<usize>,
}

impl Accesses {
    pub(super) fn new(layout: &Layout) -> Self {
        let mut all: Vec<Range<SlotId>> = layout.arrays().iter().map(|array| array.slots()).collect();
        all.sort_unstable_by_key(|slots| slots.start);
        let mut regions: Vec<Range<SlotId>> = Vec::new();
        for slots in all {
            match regions.last_mut() {
                Some(last) if slots.start < last.end => last.end = last.end.max(slots.end),
                _ => regions.push(slots),
            }
        }
        let arrays = vec![0; regions.len()];
        Self { slots: vec![0; layout.slots().len()], regions, arrays }
    }

    /// The last access to a slot, which is accessed again now.
    pub(super) fn slot(&mut self, slot: SlotId, now: usize) -> usize {
        let region = self.region(slot).map_or(0, |region| self.arrays[region]);
        std::mem::replace(&mut self.slots[slot.index()], now).max(region)
    }

    /// Notes an access to any element of an array.
    pub(super) fn array(&mut self, array: ArrayId, layout: &Layout, now: usize) {
        if let Some(region) = self.region(layout.array(array).first) {
            self.arrays[region] = now;
        }
    }

    /// The region that a slot is in.
    fn region(&self, slot: SlotId) -> Option<usize> {
        let region = self.regions.partition_point(|region| region.end <= slot);
        self.regions.get(region).filter(|found| found.start <= slot).map(|_| region)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::elementary::{Elementary, Value};
    use crate::logic::{Area, LayoutBuilder, Slot};

    #[test]
    fn an_access_to_an_array_is_one_to_all_that_shares_slots_with_it() {
        let mut layout = LayoutBuilder::new();
        for index in 0..8 {
            let (name, ty) = (format!("x{index}"), Elementary::Int);
            let initial = Value::default_of(ty);
            layout.slot(Slot { name: name.into(), ty, offset: 0, area: Area::Memory, retain: false, initial, line: 0 });
        }
        // Two that overlap, and one right behind them.
        let arrays = [(3, 2), (1, 3), (5, 2)].map(|(first, count)| layout.array(SlotId(first), count));
        let layout = layout.finish(None).unwrap();
        let mut accesses = Accesses::new(&layout);
        accesses.array(arrays[0], &layout, 1);
        accesses.array(arrays[2], &layout, 2);
        let found = (0..8).map(|slot| accesses.slot(SlotId(slot), 3)).collect::<Vec<_>>();
        assert_eq!(found, [0, 1, 1, 1, 1, 2, 2, 0]);
        accesses.array(arrays[1], &layout, 4);
        let found = (0..8).map(|slot| accesses.slot(SlotId(slot), 5)).collect::<Vec<_>>();
        assert_eq!(found, [3, 4, 4, 4, 4, 3, 3, 3]);
    }
}
