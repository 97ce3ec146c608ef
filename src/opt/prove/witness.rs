//! Counterexamples: images on which both programs are executed to see that they differ, made as plain as they can be.

use std::cell::RefCell;
use std::ops::Range;

use super::Difference;
use super::part::Part;
use crate::logic::execute::Executor;
use crate::logic::{Layout, Program, SlotId};
use crate::opt::check::last_store;

/// Slots of a counterexample that are tried to be as they start.
const MOST_PLAIN: usize = 4096;

/// Executes parts of programs over one layout.
#[derive(Debug)]
pub(super) struct Machine<'a> {
    layout: &'a Layout,
    executor: Executor,
}

impl<'a> Machine<'a> {
    pub(super) fn new(layout: &'a Layout) -> Self {
        Self { layout, executor: Executor::new(layout) }
    }

    /// The image that sections leave.
    pub(super) fn run(&self, program: &Program, sections: Range<usize>, image: &[u8], now: i64) -> Vec<u8> {
        thread_local! {
            /// The values of instructions, of which a program may have millions.
            static VALUES: RefCell<Vec<u64>> = const { RefCell::new(Vec::new()) };
        }
        let (mut image, range) = (image.to_vec(), program.instruction_range(sections));
        VALUES.with_borrow_mut(|values| {
            values.resize(values.len().max(range.end), 0);
            self.executor.execute(&program.instructions, range, values, &mut image, now);
        });
        image
    }

    /// The difference that an image shows, if it does: with as few slots that are not as they start as are needed.
    pub(super) fn difference(
        &self,
        before: &Program,
        after: &Program,
        part: &Part,
        image: Vec<u8>,
        now: i64,
    ) -> Option<Difference> {
        let run = |image: &[u8], now: i64| {
            let expected = self.run(before, part.before.clone(), image, now);
            let actual = self.run(after, part.after.clone(), image, now);
            (expected, actual)
        };
        let differs = |image: &[u8], now: i64| {
            let (expected, actual) = run(image, now);
            expected != actual
        };
        if !differs(&image, now) {
            return None;
        }
        let (mut image, mut now) = (image, now);
        if differs(&image, 0) {
            now = 0;
        }
        let initial = self.layout.initial_image();
        let changed = |image: &[u8]| -> Vec<SlotId> {
            let slots = (0..).zip(self.layout.slots());
            slots.filter(|(_, slot)| slot.read(image) != slot.read(&initial)).map(|(id, _)| SlotId(id)).collect()
        };
        for slot in changed(&image).into_iter().take(MOST_PLAIN) {
            let mut plainer = image.clone();
            let slot = self.layout.slot(slot);
            slot.write(&mut plainer, slot.initial);
            if differs(&plainer, now) {
                image = plainer;
            }
        }
        let (expected, actual) = run(&image, now);
        let (place, slot) =
            (0..).zip(self.layout.slots()).find(|(_, slot)| slot.read(&expected) != slot.read(&actual))?;
        let because = changed(&image).into_iter().map(|id| self.layout.slot(id));
        let because = because.map(|slot| (slot.name.to_string(), slot.read(&image))).collect();
        let sections = [(before, part.before.clone()), (after, part.after.clone())];
        Some(Difference {
            origin: last_store(sections, SlotId(place)),
            slot: slot.clone(),
            actual: slot.read(&actual),
            expected: slot.read(&expected),
            because,
            image,
            now,
        })
    }
}
