//! The logic IR: one scan, flattened to a straight line of primitive operations over the process image.
//!
//! A [`Program`] is an image [`Layout`] and a list of instructions in SSA form, cut into **sections** (one a
//! rung, each with an opaque origin) and those into **chunks**, beyond which no value lives. A [`Task`] is a run of
//! chunks; a scan executes those of the tasks that are due, in order. There is no other control flow, no block, no
//! clock: a scan is a pure function of the image and of `now`.
//!
//! What each operation computes is [`evaluate`], and only that; every engine is tested against it. This module
//! must never know ladder or Cranelift.

mod build;
pub mod evaluate;
pub mod execute;
pub mod image;
pub mod map;
pub mod mathematics;
mod op;
mod parse;
mod print;
#[doc(hidden)]
pub mod random;
mod task;
mod verify;

pub use build::Builder;
pub use image::{Area, Array, ArrayId, Layout, LayoutBuilder, Slot, SlotId};
pub use op::{Binary, Compare, Domain, Helper, Instruction, Op, Unary, ValueId};
pub use parse::parse;
pub use print::{literal, print};
pub use task::{Task, Turn};
pub use verify::{Problem, verify};

use std::sync::Arc;

use lean_string::LeanString;

/// Sections to a chunk, unless the builder cuts earlier. Chunks of 64 to 1024 rungs run alike; smaller ones
/// compile in parallel and are replaced one by one.
pub const CHUNK_SECTIONS: u32 = 128;

/// One scan, of one round of tasks.
#[derive(Clone, PartialEq, Debug)]
pub struct Program {
    /// The name of the program that it was made from.
    pub name: String,
    /// The process image: never changed, so that parts and copies of a program share it.
    pub layout: Arc<Layout>,
    /// What sections come from.
    pub origins: Vec<Origin>,
    /// The sections, in order, which together cover all instructions.
    pub sections: Vec<Section>,
    /// The tasks, at least one, in the order in which those run that are due. Together they cover all sections.
    pub tasks: Vec<Task>,
    /// The instructions. A value is named by the place of the instruction that defines it.
    pub instructions: Vec<Instruction>,
}

/// What a section was made from: opaque here, for reports, comments and diagnostics.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Origin {
    /// A short label, such as the name of a rung.
    pub label: LeanString,
    /// The line of the source, from 1; 0 where there is none.
    pub line: u32,
}

/// A run of instructions with one origin.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Section {
    /// Index into [`Program::origins`].
    pub origin: u32,
    /// One past its last instruction; the first is where the section before ends.
    pub end: u32,
    /// Whether a new chunk starts here. The first section of a task always starts one.
    pub starts_chunk: bool,
}

impl Program {
    /// The instructions of a section, as indices into [`Program::instructions`].
    pub fn section_range(&self, section: usize) -> std::ops::Range<usize> {
        let start = if section == 0 { 0 } else { self.sections[section - 1].end as usize };
        start..self.sections[section].end as usize
    }

    /// The instructions of sections side by side, as indices into [`Program::instructions`].
    pub fn instruction_range(&self, sections: std::ops::Range<usize>) -> std::ops::Range<usize> {
        let end = |sections: usize| if sections == 0 { 0 } else { self.sections[sections - 1].end as usize };
        end(sections.start)..end(sections.end)
    }

    /// The sections of a task.
    pub fn task_range(&self, task: usize) -> std::ops::Range<usize> {
        let start = if task == 0 { 0 } else { self.tasks[task - 1].end as usize };
        start..self.tasks[task].end as usize
    }

    /// The task that an instruction belongs to.
    pub fn task_of(&self, instruction: usize) -> usize {
        let section = self.sections.partition_point(|section| section.end as usize <= instruction);
        self.tasks.partition_point(|task| task.end as usize <= section)
    }

    /// The chunks, each as a range of sections.
    pub fn chunks(&self) -> Vec<std::ops::Range<usize>> {
        let mut starts: Vec<usize> =
            (0..self.sections.len()).filter(|section| *section == 0 || self.sections[*section].starts_chunk).collect();
        starts.push(self.sections.len());
        starts.windows(2).map(|pair| pair[0]..pair[1]).collect()
    }
}
