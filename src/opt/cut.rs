//! A section that is very long is cut into several of the same origin where no value crosses, so that they can lie in
//! several chunks: a code generator takes more than in proportion for a long function.
//!
//! Constants and the time may cross: they are made again.

use crate::logic::{Instruction, Op, Program, Section, ValueId};

/// Instructions from which on a section is long, and of the least part.
const LONG: usize = 4096;
const PART: usize = 2048;

/// See the module.
pub(super) fn cut(program: Program) -> Program {
    let long = |section: usize| program.section_range(section).len() > LONG;
    if !(0..program.sections.len()).any(long) {
        return program;
    }
    let ends = ends(&program);
    if ends.iter().map(Vec::len).sum::<usize>() == program.sections.len() {
        return program;
    }
    parted(program, &ends)
}

/// The ends of the parts of each section.
fn ends(program: &Program) -> Vec<Vec<usize>> {
    let mut last_use = vec![0u32; program.instructions.len()];
    for (index, instruction) in (0..).zip(&program.instructions) {
        instruction.op.operands().for_each(|operand| last_use[operand.index()] = index);
    }
    let part_of = |section: usize| {
        let range = program.section_range(section);
        let mut ends = Vec::new();
        if range.len() > LONG {
            let (mut start, mut reach) = (range.start, 0);
            for index in range.clone() {
                let crosses = reach >= index;
                if !crosses && index - start >= PART && range.end - index >= PART {
                    ends.push(index);
                    start = index;
                }
                if !is_made_again(program.instructions[index]) {
                    reach = reach.max(last_use[index] as usize);
                }
            }
        }
        ends.push(range.end);
        ends
    };
    (0..program.sections.len()).map(part_of).collect()
}

fn is_made_again(instruction: Instruction) -> bool {
    matches!(instruction.op, Op::Constant(_) | Op::Now)
}

fn parted(mut program: Program, ends: &[Vec<usize>]) -> Program {
    let old = std::mem::take(&mut program.instructions);
    let mut instructions: Vec<Instruction> = Vec::with_capacity(old.len());
    let index = |count: usize| u32::try_from(count).unwrap_or(u32::MAX);
    // What stands for each value, and in which part that was made.
    let mut copies: Vec<(ValueId, usize)> = Vec::with_capacity(old.len());
    let (mut sections, mut lasts) = (Vec::new(), vec![0u32; program.sections.len()]);
    for (place, section) in program.sections.iter().enumerate() {
        for (part, end) in ends[place].iter().enumerate() {
            for at in copies.len()..*end {
                let Instruction { ty, op } = old[at];
                let op = op.map_operands(|operand| {
                    let (copy, made_in) = &mut copies[operand.index()];
                    if *made_in != sections.len() && ends[place].len() > 1 && is_made_again(old[operand.index()]) {
                        *copy = ValueId(index(instructions.len()));
                        *made_in = sections.len();
                        instructions.push(old[operand.index()]);
                    }
                    *copy
                });
                copies.push((ValueId(index(instructions.len())), sections.len()));
                instructions.push(Instruction { ty, op });
            }
            let starts_chunk = section.starts_chunk && part == 0;
            sections.push(Section { end: index(instructions.len()), starts_chunk, ..*section });
        }
        lasts[place] = index(sections.len());
    }
    for task in &mut program.tasks {
        task.end = (task.end as usize).checked_sub(1).map_or(0, |last| lasts[last]);
    }
    program.instructions = instructions;
    program.sections = sections;
    program
}
