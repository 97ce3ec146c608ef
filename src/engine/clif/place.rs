//! Where in the image a chunk reaches: which pointers it is given, and which bytes were stored lately.

use std::collections::HashMap;
use std::ops::Range;

use super::{BASES, Target};
use crate::logic::{Op, Program, SlotId};

/// Sections for which a store may still wait on its way to memory, so that a wider load over it stalls.
pub(super) const LATELY: usize = 96;

/// Bytes that a wide load of a BOOL reads.
const WIDE: u32 = 4;

/// Chooses the pointers that bring the most accesses of a chunk within short reach, and says how many it took. One that
/// can be the image itself is.
pub(super) fn bases(program: &Program, sections: Range<usize>, target: Target) -> ([u32; BASES], usize) {
    let mut offsets: Vec<u32> = accesses(program, sections).map(|slot| program.layout.slot(slot).offset).collect();
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

/// What some sections load and store; of an array, its first element.
fn accesses(program: &Program, sections: Range<usize>) -> impl Iterator<Item = SlotId> {
    let first = |array| program.layout.array(array).first;
    program.instructions[program.instruction_range(sections)]
        .iter()
        .flat_map(move |instruction| match instruction.op {
            Op::Load(slot) | Op::Store(slot, _) => [Some(slot), None],
            Op::LoadIndexed(array, _) | Op::StoreIndexed(array, ..) => [Some(first(array)), None],
            Op::CopyArray(to, from, _) => [Some(first(to)), Some(first(from))],
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
pub(super) fn stored_before(program: &Program, section: usize) -> impl Iterator<Item = (usize, u32, u32)> {
    let count = program.sections.len();
    (1..=LATELY.min(count)).rev().flat_map(move |ago| {
        let earlier = program.section_range((section + count - ago) % count);
        program.instructions[earlier].iter().filter_map(move |instruction| {
            // Which element of an array is stored is not known; none counts, so that wide loads beside it stay.
            let Op::Store(slot, _) = instruction.op else { return None };
            let slot = program.layout.slot(slot);
            Some((ago, slot.offset, slot.ty.size()))
        })
    })
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
