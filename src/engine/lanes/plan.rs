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
use std::ops::Range;

use super::columns::{Column, Step};
use super::recognise::{Answer, Due, Leaf, Recognised, Tracked, recognise};
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

/// Where a bit for each lane is in memory.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub(super) enum Cell {
    /// One of the words.
    Word(u32),
    /// In this scan's row, that of a stamp: what [`track`](super::track) foresaw, until the scan sets it.
    Row(u32),
}

/// An operation on whole words. Operands are indices of operations before it.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum BitOp {
    /// What is in memory.
    Load(Cell),
    Not(u32),
    And(u32, u32),
    Or(u32, u32),
    Xor(u32, u32),
    /// Sets what is in memory.
    Store(Cell, Bit),
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

/// A tracked slot, and what is kept for it.
#[derive(Clone, PartialEq, Debug)]
pub(super) struct Track {
    pub(super) tracked: Tracked,
    pub(super) ty: Elementary,
    pub(super) initial: u64,
    /// The task that its store belongs to.
    pub(super) task: usize,
    /// The words of its code, the lowest bit first; a latch has none.
    pub(super) codes: Range<u32>,
    /// Its stamps: those of a latch all tell the same, others have one at most.
    pub(super) stamps: Vec<usize>,
    /// The codes that stand for a difference, each with the index of its latch.
    pub(super) since: Vec<(usize, usize)>,
}

impl Track {
    /// Whether it is given `now` or a difference, of which the value depends on the scan.
    fn is_timed(&self) -> bool {
        self.tracked.leaves.iter().any(|leaf| match leaf {
            Leaf::Now | Leaf::Since(_) => true,
            Leaf::Constant(_) => false,
        })
    }
}

/// What tells, for each lane, which scan was the last to give a tracked slot anything but what it held.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(super) struct Stamp {
    /// The task whose scans do.
    pub(super) task: usize,
    /// The word of the lanes in which it was set in this epoch, if any preset is asked about.
    pub(super) recent: Option<u32>,
}

/// A preset, with a stamp for each question about it.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(super) struct Preset {
    pub(super) nanoseconds: i64,
    pub(super) stamps: Range<usize>,
}

/// See the module.
#[derive(Debug)]
pub(super) struct Plan {
    /// By slot.
    pub(super) homes: Vec<Home>,
    /// Words in all: two constants, the BOOL slots, codes, what was set lately, and those that wait between pieces.
    pub(super) words: usize,
    /// Columns of values of 1, 2, 4 and 8 bytes.
    pub(super) columns: [usize; 4],
    /// Columns that hold one value always.
    pub(super) constants: Vec<(Column, u64)>,
    /// Latches first.
    pub(super) tracks: Vec<Track>,
    /// How many of them are latches.
    pub(super) latches: usize,
    /// Those with a preset first, in the order of the presets.
    pub(super) stamps: Vec<Stamp>,
    pub(super) presets: Vec<Preset>,
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
        let stamp_of = plan.take_stamps(&dues);
        let stores: HashMap<usize, usize> = plan.tracks.iter().map(|track| track.tracked.store).zip(0..).collect();
        let chunks = program.chunks();
        let mut store = chunk::Store::new(&plan);
        plan.tasks = (0..program.tasks.len())
            .map(|task| {
                let sections = program.task_range(task);
                let first = chunks.partition_point(|chunk| chunk.start < sections.start);
                let own = chunks[first..].iter().take_while(|chunk| chunk.start < sections.end).cloned();
                own.flat_map(|chunk| chunk::pieces(program, &plan, &recognised, &stamp_of, &stores, &mut store, chunk))
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
            latches: recognised.tracked.iter().filter(|tracked| tracked.is_latch()).count(),
            stamps: Vec::new(),
            presets: Vec::new(),
            tasks: Vec::new(),
        };
        for tracked in &recognised.tracked {
            let slot = program.layout.slot(tracked.slot);
            let bits = if tracked.is_latch() { 0 } else { tracked.bits() };
            let first = plan.take_words(bits);
            plan.tracks.push(Track {
                tracked: tracked.clone(),
                ty: slot.ty,
                initial: slot.initial.bits(),
                task: program.task_of(tracked.store),
                codes: first..first + u32::try_from(bits).unwrap_or(u32::MAX),
                stamps: Vec::new(),
                since: Vec::new(),
            });
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

    /// From one word of a stamp to its next. An odd number of lines of the cache, in which they so do not contend for the
    /// same place.
    pub(super) fn stamp_stride(&self) -> usize {
        self.stamps.len() | 1
    }

    /// Gives each question a stamp, and one to every latch without, and to the other tracked slots that need it. Tells the
    /// stamp of each question.
    fn take_stamps(&mut self, dues: &[Due]) -> HashMap<Due, usize> {
        let mut stamp_of = HashMap::new();
        for due in dues {
            let Home::Tracked(latch) = self.homes[due.latch.index()] else { unreachable!("latches are tracked") };
            let stamp = self.stamps.len();
            match self.presets.last_mut() {
                Some(last) if last.nanoseconds == due.preset => last.stamps.end = stamp + 1,
                _ => self.presets.push(Preset { nanoseconds: due.preset, stamps: stamp..stamp + 1 }),
            }
            let recent = Some(self.take_words(1));
            self.stamps.push(Stamp { task: self.tracks[latch].task, recent });
            self.tracks[latch].stamps.push(stamp);
            stamp_of.insert(*due, stamp);
        }
        for index in 0..self.tracks.len() {
            let track = &self.tracks[index];
            let needs = index < self.latches || track.is_timed() && !track.tracked.follows;
            if needs && track.stamps.is_empty() {
                self.tracks[index].stamps.push(self.stamps.len());
                self.stamps.push(Stamp { task: self.tracks[index].task, recent: None });
            }
        }
        stamp_of
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
