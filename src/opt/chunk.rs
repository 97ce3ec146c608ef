//! Which sections share a chunk, by what they hold.
//!
//! A chunk ends where it is long enough and the fewest values would have been handed on in registers; among such places
//! the rung's label decides. So where chunks end depends on nothing far away, and an edit of one rung moves no end but
//! its own chunk's: all other chunks compile to what they were. Values that cross sections keep these together.
//!
//! The limits are in instructions as they are lowered, some 1500 of which make a chunk: smaller ones save and restore
//! registers more often; larger ones run no faster, reach more of the image than a few pointers bring near, and take longer
//! to compile again after an edit.

use super::forward::WINDOW;
use crate::logic::{Op, Program};

/// Instructions from which on a chunk may end, and at which it must.
const LEAST: usize = 1000;
const MOST: usize = 2000;

/// Sections at which a chunk must end, too: of what nearly empty rungs are, few instructions are many.
const SECTIONS: usize = 512;

/// See the module.
pub(super) fn chunk(mut program: Program) -> Program {
    let costs = Costs::of(&program);
    for task in 0..program.tasks.len() {
        let sections = program.task_range(task);
        let mut start = sections.start;
        while start < sections.end {
            let next = costs.next(&program, start, sections.end);
            for section in start..next {
                program.sections[section].starts_chunk = section == start;
            }
            start = next;
        }
    }
    program
}

/// What it costs to end a chunk before a section.
struct Costs {
    /// Values that would have been handed on.
    handed: Vec<i32>,
    /// Values that cross, which must not be.
    crossing: Vec<i32>,
}

impl Costs {
    fn of(program: &Program) -> Self {
        let count = program.sections.len();
        // Differences first, from each section to the next.
        let mut costs = Self { handed: vec![0; count + 1], crossing: vec![0; count + 1] };
        let mut stored: Vec<Option<usize>> = vec![None; program.layout.slots().len()];
        let mut section_of = vec![0usize; program.instructions.len()];
        for section in 0..count {
            for index in program.section_range(section) {
                section_of[index] = section;
                let op = program.instructions[index].op;
                for operand in op.operands() {
                    let made = section_of[operand.index()];
                    if made < section {
                        costs.crossing[made + 1] += 1;
                        costs.crossing[section + 1] -= 1;
                    }
                }
                match op {
                    Op::Load(slot) => {
                        let near = stored[slot.index()].filter(|made| section - made <= WINDOW && *made < section);
                        if let Some(made) = near {
                            costs.handed[made + 1] += 1;
                            costs.handed[section + 1] -= 1;
                        }
                    }
                    Op::Store(slot, _) => stored[slot.index()] = Some(section),
                    Op::Constant(_)
                    | Op::Now
                    | Op::Unary(..)
                    | Op::Binary(..)
                    | Op::Compare(..)
                    | Op::Select(..)
                    | Op::Convert(_)
                    | Op::Reinterpret(_)
                    | Op::Call(..)
                    | Op::LoadIndexed(..)
                    | Op::StoreIndexed(..)
                    | Op::CopyArray(..) => {}
                }
            }
        }
        for differences in [&mut costs.handed, &mut costs.crossing] {
            let mut sum = 0;
            for difference in differences.iter_mut() {
                sum += *difference;
                *difference = sum;
            }
        }
        costs
    }

    /// Where the chunk that starts at a section ends, at the latest with the task.
    fn next(&self, program: &Program, start: usize, end: usize) -> usize {
        let first = program.section_range(start).start;
        let mut best: Option<((i32, u64), usize)> = None;
        for section in start + 1..end {
            let length = program.section_range(section).start - first;
            let with = program.sections[section].end as usize - first;
            let full = with > MOST || section - start >= SECTIONS;
            if self.crossing[section] == 0 && (length >= LEAST || full) {
                let cost = (self.handed[section], mark(program, section));
                if best.is_none_or(|(least, _)| cost < least) {
                    best = Some((cost, section));
                }
            }
            if full && let Some((_, section)) = best {
                return section;
            }
        }
        // The rest of the task, unless that is too long with what a chunk may have.
        end
    }
}

/// A number that depends on a rung's label and on nothing else.
fn mark(program: &Program, section: usize) -> u64 {
    let label = program.origins.get(program.sections[section].origin as usize).map_or("", |origin| &origin.label);
    label.bytes().fold(0xCBF2_9CE4_8422_2325, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01B3))
}
