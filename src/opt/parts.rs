//! A program taken apart between chunks, its parts changed on all cores, and put together again.
//!
//! For passes that look at no more than a chunk. Each part is a program of its own over the same layout, so that a pass
//! need not know of it; what comes out is the same however many cores there are. Parts also keep what a pass needs beside
//! the program small.

use std::ops::Range;
use std::sync::Arc;

use crate::logic::{Instruction, Program, Section, Task, ValueId};
use crate::parallel;

/// Instructions of a part, at least, and about how many parts there are at the most: each takes time for every slot.
const LEAST: usize = 8192;
const MOST: usize = 64;

/// Changes every part of a program. A small one is its only part.
pub(super) fn each(program: Program, change: impl Fn(Program) -> Program + Sync) -> Program {
    let parts = parts(&program, LEAST.max(program.instructions.len() / MOST));
    changed(program, parts, change)
}

/// Changes given parts of a program, which together are all of it.
fn changed(mut program: Program, parts: Vec<Range<usize>>, change: impl Fn(Program) -> Program + Sync) -> Program {
    if parts.len() < 2 {
        return change(program);
    }
    let changed = parallel::each(
        parts.len(),
        || (),
        |(), index| {
            let Program { sections, instructions, .. } = change(part(&program, parts[index].clone()));
            (sections, instructions)
        },
    );
    program.instructions = Vec::new();
    program.instructions.reserve_exact(changed.iter().map(|(_, instructions)| instructions.len()).sum());
    for (range, (sections, instructions)) in parts.into_iter().zip(changed) {
        // A program is shorter than 2^32 instructions.
        let start = u32::try_from(program.instructions.len()).unwrap_or(u32::MAX);
        for (section, part) in program.sections[range].iter_mut().zip(sections) {
            section.end = start + part.end;
        }
        program.instructions.extend(instructions.into_iter().map(|instruction| moved(instruction, |at| at + start)));
    }
    program
}

/// The sections of each part, of so many instructions at least.
fn parts(program: &Program, least: usize) -> Vec<Range<usize>> {
    let mut parts: Vec<Range<usize>> = Vec::new();
    for chunk in program.chunks() {
        match parts.last_mut() {
            Some(part) if program.instruction_range(part.clone()).len() < least => part.end = chunk.end,
            _ => parts.push(chunk),
        }
    }
    parts
}

/// Some sections as a program.
fn part(program: &Program, range: Range<usize>) -> Program {
    let instructions = program.instruction_range(range.clone());
    let start = u32::try_from(instructions.start).unwrap_or(u32::MAX);
    let section = |section: &Section| Section { end: section.end - start, ..*section };
    let sections: Vec<Section> = program.sections[range].iter().map(section).collect();
    Program {
        name: String::new(),
        layout: Arc::clone(&program.layout),
        // Sections name them by their places, and no pass looks at them; a check of a pass names the rung.
        origins: if cfg!(debug_assertions) { program.origins.clone() } else { Vec::new() },
        tasks: vec![Task::always(u32::try_from(sections.len()).unwrap_or(u32::MAX))],
        sections,
        instructions: program.instructions[instructions]
            .iter()
            .map(|instruction| moved(*instruction, |at| at - start))
            .collect(),
    }
}

/// The instruction with its operands elsewhere.
fn moved(Instruction { ty, op }: Instruction, to: impl Fn(u32) -> u32) -> Instruction {
    Instruction { ty, op: op.map_operands(|ValueId(at)| ValueId(to(at))) }
}

#[cfg(test)]
mod tests {
    use super::{changed, each, parts};
    use crate::logic::random;
    use crate::opt::PASSES;

    #[test]
    fn what_passes_make_of_the_parts_is_what_they_make_of_the_whole() {
        let mut apart = 0;
        for seed in 0..200 {
            let program = random::program(seed);
            let parts = parts(&program, 1);
            apart += usize::from(parts.len() > 1);
            let of_chunks = || PASSES.iter().filter(|pass| !pass.of_all);
            let run = |program| of_chunks().fold(program, |program, pass| (pass.run)(program));
            assert_eq!(changed(program.clone(), parts.clone(), |part| part), program, "of seed {seed}");
            assert_eq!(changed(program.clone(), parts, run), run(program.clone()), "of seed {seed}");
            assert_eq!(each(program.clone(), run), run(program), "of seed {seed}");
        }
        assert!(apart > 50, "only {apart} programs have more than one chunk, which shows little");
    }
}
