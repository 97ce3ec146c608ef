//! Whether two programs over one layout compute the same: both are executed on random images.
//!
//! It can find a difference and never prove that there is none. What it says names the rung, so that a difference in a
//! large program is found.

use std::fmt;
use std::ops::Range;

use crate::logic::execute::Executor;
use crate::logic::{Origin, Program, Slot, SlotId, random};

/// Where two programs differ.
#[derive(Clone, PartialEq, Debug)]
pub struct Difference {
    /// Where the rung comes from that is the last to store what differs; `None` where none does.
    pub origin: Option<Origin>,
    /// What differs.
    pub slot: Option<Slot>,
    /// The seed of the image that shows it: [`random::image`], at [`random::now`].
    pub seed: u64,
}

impl fmt::Display for Difference {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.slot {
            Some(slot) => write!(f, "`{}`", slot.name)?,
            None => f.write_str("what is no slot")?,
        }
        if let Some(Origin { label, line }) = &self.origin {
            write!(f, " of `{label}` (line {line})")?;
        }
        write!(f, ", on the random image {}", self.seed)
    }
}

/// The first difference that random images with the seeds from 0 show. All tasks are executed, due or not.
///
/// # Panics
/// When one of them was not verified, or their layouts are not the same.
pub fn difference(before: &Program, after: &Program, images: u64) -> Option<Difference> {
    let executor = Executor::new(&before.layout);
    let run = |program: &Program, image: &[u8], now: i64| {
        let (mut image, count) = (image.to_vec(), program.instructions.len());
        executor.execute(&program.instructions, 0..count, &mut vec![0; count], &mut image, now);
        image
    };
    (0..images).find_map(|seed| {
        let (image, now) = (random::image(&before.layout, seed), random::now(seed));
        let (expected, actual) = (run(before, &image, now), run(after, &image, now));
        let byte = expected.iter().zip(&actual).position(|(expected, actual)| expected != actual)?;
        Some(at(before, after, byte, seed))
    })
}

/// The difference at a byte of the image.
fn at(before: &Program, after: &Program, byte: usize, seed: u64) -> Difference {
    let covers = |slot: &Slot| (slot.offset as usize..(slot.offset + slot.ty.size()) as usize).contains(&byte);
    let found = (0..).zip(before.layout.slots()).find(|(_, slot)| covers(slot));
    let origin = found.and_then(|(id, _)| {
        last_store([before, after].map(|program| (program, 0..program.sections.len())), SlotId(id))
    });
    Difference { origin, slot: found.map(|(_, slot)| slot.clone()), seed }
}

/// Where the rung comes from that is the last to store a slot, among some sections of a program, or else of another.
pub(super) fn last_store(among: [(&Program, Range<usize>); 2], slot: SlotId) -> Option<Origin> {
    among.into_iter().find_map(|(program, sections)| {
        let stores = |section: &usize| {
            let instructions = &program.instructions[program.section_range(*section)];
            instructions
                .iter()
                .any(|instruction| instruction.op.stores(&program.layout).is_some_and(|slots| slots.contains(&slot)))
        };
        let section = sections.rev().find(stores)?;
        program.origins.get(program.sections[section].origin as usize).cloned()
    })
}
