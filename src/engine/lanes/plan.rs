//! What is done with the lanes in a scan, and where everything of them lies: made once of a program, without Cranelift.
//!
//! A chunk becomes pieces that run one after another: **segments** of operations on whole words, for
//! [`compile`](super::compile), and runs of **steps** on columns, for [`columns`](super::columns). As many operations
//! as
//! can go into one piece do: a piece ends only where the next needs what it made. A BOOL that is needed in another
//! piece
//! waits in a word of its own.

mod chunk;

use std::collections::HashMap;

use super::columns::{Column, Step};
use super::recognise::{Answer, Due, Leaf, Recognised, Tracked, recognise};
use super::track::ROW_BITS;
use crate::elementary::Elementary;
use crate::logic::{Program, SlotId};

/// Words that hold TRUE and FALSE in every lane, always.
pub(super) const TRUE_WORD: u32 = 0;
pub(super) const FALSE_WORD: u32 = 1;
const FIRST_WORD: u32 = 2;

/// A bit of a segment: known, or what the operation at an index makes.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Bit {
    Constant(bool),
    Made(u32),
}

/// An operation on whole words. Operands are indices of operations before it.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum BitOp {
    /// What a word holds.
    Load(u32),
    Not(u32),
    And(u32, u32),
    Or(u32, u32),
    Xor(u32, u32),
    /// Sets a word.
    Store(u32, Bit),
    /// Sets a word of this scan's row of codes.
    Note(u32, Bit),
}

/// A part of a chunk.
#[derive(Clone, PartialEq, Debug)]
pub(super) enum Piece {
    /// Operations on words.
    Segment(Vec<BitOp>),
    /// Operations on columns.
    Steps(Vec<Step>),
}

/// Where a slot's values are.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Home {
    /// A bit for each lane.
    Word(u32),
    /// A value for each lane.
    Column(Column),
    /// In no place of its own, but known: an index into [`Plan::tracked`].
    Tracked(usize),
    /// When a task is due next, which is the same for all lanes: the task.
    Due(usize),
}

/// A tracked slot and its place.
#[derive(Clone, PartialEq, Debug)]
pub(super) struct Track {
    pub(super) tracked: Tracked,
    pub(super) ty: Elementary,
    pub(super) initial: u64,
    /// The first of its words in a row, and how far it is to the next. Latches have those of their own index.
    pub(super) row: usize,
    pub(super) stride: usize,
    /// The codes that stand for a difference, each with the index of its latch.
    pub(super) since: Vec<(usize, usize)>,
}

/// Tracked slots with codes of as many bits, at least one. In a row stand the lowest bits of all of them, then the
/// next.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(super) struct Class {
    pub(super) bits: usize,
    /// Which of [`Plan::tracks`].
    pub(super) tracks: std::ops::Range<usize>,
    /// The first of its words in a row.
    pub(super) row: usize,
}

impl Class {
    /// Words that sum up a slot's codes: whether there is any, the bits of its row's number, and its bits, of more
    /// than one.
    pub(super) fn sums(&self) -> usize {
        1 + ROW_BITS + if self.bits > 1 { self.bits } else { 0 }
    }
}

/// Questions with one preset, as a range of [`Plan::dues`].
#[derive(Clone, PartialEq, Eq, Debug)]
pub(super) struct Preset {
    pub(super) nanoseconds: i64,
    pub(super) dues: std::ops::Range<usize>,
}

/// See the module.
#[derive(Debug)]
pub(super) struct Plan {
    /// By slot.
    pub(super) homes: Vec<Home>,
    /// Words in all: two constants, the BOOL slots, the answers, and those that wait between pieces.
    pub(super) words: usize,
    /// Columns of values of 1, 2, 4 and 8 bytes.
    pub(super) columns: [usize; 4],
    /// Columns that hold one value always.
    pub(super) constants: Vec<(Column, u64)>,
    /// Latches first.
    pub(super) tracks: Vec<Track>,
    /// Latches are the first class.
    pub(super) classes: Vec<Class>,
    /// How many of them are latches.
    pub(super) latches: usize,
    /// Words of a row.
    pub(super) row_words: usize,
    /// By answer: the latch. In order of their presets.
    pub(super) dues: Vec<usize>,
    pub(super) presets: Vec<Preset>,
    /// The word of the first answer.
    pub(super) first_due: u32,
    /// By task: the pieces of its chunks.
    pub(super) tasks: Vec<Vec<Piece>>,
}

impl Plan {
    /// The plan of a verified program; `recognises` is off where all is to take the general path.
    pub(super) fn of(program: &Program, recognises: bool) -> Self {
        let recognised = if recognises { recognise(program) } else { Recognised::default() };
        let mut dues: Vec<Due> = recognised
            .answers
            .values()
            .filter_map(|answer| match answer {
                Answer::Due { due, .. } => Some(*due),
                Answer::Always(_) => None,
            })
            .collect();
        dues.sort_unstable();
        dues.dedup();
        let mut plan = Self::of_slots(program, &recognised);
        plan.first_due = plan.take_words(dues.len());
        for (index, due) in dues.iter().enumerate() {
            match plan.presets.last_mut() {
                Some(last) if last.nanoseconds == due.preset => last.dues.end = index + 1,
                _ => plan.presets.push(Preset { nanoseconds: due.preset, dues: index..index + 1 }),
            }
            let Home::Tracked(latch) = plan.homes[due.latch.index()] else { unreachable!("latches are tracked") };
            plan.dues.push(latch);
        }
        let word_of: HashMap<Due, u32> = dues.into_iter().zip(plan.first_due..).collect();
        let stores: HashMap<usize, usize> = plan.tracks.iter().map(|track| track.tracked.store).zip(0..).collect();
        let chunks = program.chunks();
        let mut store = chunk::Store::new(&plan);
        plan.tasks = (0..program.tasks.len())
            .map(|task| {
                let sections = program.task_range(task);
                let first = chunks.partition_point(|chunk| chunk.start < sections.start);
                let own = chunks[first..].iter().take_while(|chunk| chunk.start < sections.end).cloned();
                own.flat_map(|chunk| chunk::pieces(program, &plan, &recognised, &word_of, &stores, &mut store, chunk))
                    .collect()
            })
            .collect();
        store.settle(&mut plan);
        plan
    }

    /// A plan with places for all slots.
    fn of_slots(program: &Program, recognised: &Recognised) -> Self {
        let mut plan = Self {
            homes: Vec::new(),
            words: FIRST_WORD as usize,
            columns: [0; 4],
            constants: Vec::new(),
            tracks: Vec::new(),
            classes: Vec::new(),
            latches: recognised.tracked.iter().filter(|tracked| tracked.is_latch()).count(),
            row_words: 0,
            dues: Vec::new(),
            presets: Vec::new(),
            first_due: 0,
            tasks: Vec::new(),
        };
        for class in recognised.tracked.chunk_by(|a, b| (a.is_latch(), a.bits()) == (b.is_latch(), b.bits())) {
            let (bits, first, row) = (class[0].bits(), plan.tracks.len(), plan.row_words);
            for (tracked, row) in class.iter().zip(row..) {
                let slot = program.layout.slot(tracked.slot);
                let (ty, initial, stride) = (slot.ty, slot.initial.bits(), class.len());
                plan.tracks.push(Track { tracked: tracked.clone(), ty, initial, row, stride, since: Vec::new() });
            }
            plan.row_words += bits * class.len();
            if bits > 0 {
                plan.classes.push(Class { bits, tracks: first..plan.tracks.len(), row });
            }
        }
        let tracked: HashMap<SlotId, usize> = plan.tracks.iter().map(|track| track.tracked.slot).zip(0..).collect();
        for track in &mut plan.tracks {
            let since = track.tracked.leaves.iter().filter_map(|leaf| match leaf {
                Leaf::Since(latch) => Some((track.tracked.code(*leaf), tracked[latch])),
                Leaf::Constant(_) | Leaf::Now => None,
            });
            track.since = since.collect();
        }
        let due: HashMap<SlotId, usize> = program
            .tasks
            .iter()
            .zip(0..)
            .filter(|(task, _)| task.interval.is_some())
            .filter_map(|(task, index)| Some((task.due?, index)))
            .collect();
        for (id, slot) in (0..).map(SlotId).zip(program.layout.slots()) {
            let home = if let Some(index) = tracked.get(&id) {
                Home::Tracked(*index)
            } else if let Some(task) = due.get(&id) {
                Home::Due(*task)
            } else if slot.ty == Elementary::Bool {
                Home::Word(plan.take_words(1))
            } else {
                Home::Column(plan.take_column(slot.ty))
            };
            plan.homes.push(home);
        }
        plan
    }

    /// Words that nothing else has, and the first of them.
    fn take_words(&mut self, count: usize) -> u32 {
        let first = u32::try_from(self.words).unwrap_or(u32::MAX);
        self.words += count;
        first
    }

    fn take_column(&mut self, ty: Elementary) -> Column {
        let width = ty.size().trailing_zeros() as usize;
        let index = u32::try_from(self.columns[width]).unwrap_or(u32::MAX);
        self.columns[width] += 1;
        Column { ty, index }
    }
}
