//! Where in the image a chunk reaches: which pointers it is given, and which bytes were stored lately.

use std::collections::HashMap;
use std::ops::Range;

use super::{BASES, Target};
use crate::logic::{Op, Program, SlotId};

/// Sections for which a store may still wait on its way to memory, so that a wider load over it stalls.
const LATELY: usize = 96;

/// Bytes that a wide load of a BOOL reads.
const WIDE: u32 = 4;

/// Chooses the pointers that bring the most accesses of a chunk within short reach, and says how many it took. One that
/// can be the image itself is.
pub(super) fn bases(program: &Program, sections: Range<usize>, target: Target) -> ([u32; BASES], usize) {
    let mut offsets: Vec<u32> = accesses(program, sections).map(|(_, slot)| program.layout.slot(slot).offset).collect();
    offsets.sort_unstable();
    let (mut bases, mut used) = ([0; BASES], 0);
    for base in &mut bases {
        let Some(window) = densest(&offsets, target.below + target.above) else { break };
        let highest = offsets[window.start].saturating_add(target.below).min(program.layout.size());
        *base = if offsets[window.end - 1] <= target.above { 0 } else { highest };
        offsets.drain(window);
        used += 1;
    }
    (bases, used)
}

/// The most offsets that lie within `span` bytes, as a range of the sorted `offsets`.
fn densest(offsets: &[u32], span: u32) -> Option<Range<usize>> {
    let mut best: Option<Range<usize>> = None;
    let mut start = 0;
    for end in 0..offsets.len() {
        while offsets[end] - offsets[start] > span {
            start += 1;
        }
        if best.as_ref().is_none_or(|best| best.len() < end + 1 - start) {
            best = Some(start..end + 1);
        }
    }
    best
}

/// Every load and store of some sections: whether it stores, and what; of an array, its first element.
fn accesses(program: &Program, sections: Range<usize>) -> impl Iterator<Item = (bool, SlotId)> {
    let instructions = if sections.is_empty() {
        0..0
    } else {
        program.section_range(sections.start).start..program.section_range(sections.end - 1).end
    };
    let first = |array| program.layout.array(array).first;
    program.instructions[instructions]
        .iter()
        .flat_map(move |instruction| match instruction.op {
            Op::Load(slot) => [Some((false, slot)), None],
            Op::Store(slot, _) => [Some((true, slot)), None],
            // Which element is not known; it counts as one that is not stored, so that wide loads beside it stay.
            Op::LoadIndexed(array, _) | Op::StoreIndexed(array, ..) => [Some((false, first(array))), None],
            Op::CopyArray(to, from, _) => [Some((false, first(to))), Some((false, first(from)))],
            Op::Constant(_)
            | Op::Now
            | Op::Unary(..)
            | Op::Binary(..)
            | Op::Compare(..)
            | Op::Select(..)
            | Op::Convert(_)
            | Op::Reinterpret(_)
            | Op::Call(..) => [None, None],
        })
        .flatten()
}

/// What the sections before `section` stored lately, as what code depends on: how many sections ago, where, and how wide.
pub(super) fn stored_before(program: &Program, section: usize) -> Vec<(usize, u32, u32)> {
    let count = program.sections.len();
    let mut stored = Vec::new();
    for ago in (1..=LATELY.min(count)).rev() {
        let earlier = (section + count - ago) % count;
        for (stores, slot) in accesses(program, earlier..earlier + 1) {
            if stores {
                let slot = program.layout.slot(slot);
                stored.push((ago, slot.offset, slot.ty.size()));
            }
        }
    }
    stored
}

/// The bytes that were stored lately, as the sections run one after another.
pub(super) struct Stored {
    /// By byte: the number of the section that stored it last. Sections of the scan before count below `LATELY`.
    last: HashMap<u32, usize>,
}

impl Stored {
    /// What the sections before `section` stored; those before the first are the last of the scan before.
    pub(super) fn before(program: &Program, section: usize) -> Self {
        let mut stored = Self { last: HashMap::new() };
        for (ago, offset, size) in stored_before(program, section) {
            stored.mark(offset, size, section + LATELY - ago);
        }
        stored
    }

    /// Notes a store by a section.
    pub(super) fn store(&mut self, offset: u32, size: u32, section: usize) {
        self.mark(offset, size, section + LATELY);
    }

    fn mark(&mut self, offset: u32, size: u32, when: usize) {
        for byte in offset..offset + size {
            self.last.insert(byte, when);
        }
    }

    /// Whether a wide load at `offset` by a section would meet a store on its way.
    pub(super) fn lately(&self, offset: u32, section: usize) -> bool {
        (offset..offset.saturating_add(WIDE)).any(|byte| self.last.get(&byte).is_some_and(|last| *last >= section))
    }
}
