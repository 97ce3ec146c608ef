//! Lanes: many plants of one program in one pass, a bit each.
//!
//! A BOOL is a word of four times 128 bits, and one vector instruction does an operation for 128 lanes. Everything
//! else is,
//! in general, a column of as many values (`columns`). What timers keep needs neither: it is recognised by the flow
//! of
//! values, and only *when* it was set is kept (`recognise` has the proof, `track`, `stamps` and `history` the means).
//! Every lane computes exactly what a scalar engine does: `now` is one for all lanes, nothing is quantised, and what
//! cannot be told in this way is refused ([`Refused`]), never computed otherwise.
//!
//! `plan` sorts a program's operations, `compile` makes code of those on words. No engine may know a block.

mod columns;
mod compile;
mod epoch;
mod history;
mod plan;
mod recognise;
mod stamps;
mod track;
mod unfold;
mod word;

#[cfg(test)]
mod tests;

pub(in crate::engine) use compile::{Code, Through};
pub(in crate::engine) use word::{VECTORS, Word};

use std::sync::Arc;

use super::clif::CompileError;
use super::jit::host_isa;
use super::jit::segments::Segments;
use crate::elementary::Value;
use crate::logic::{ArrayId, Layout, LayoutBuilder, Op, Program, SlotId, Task, Turn, verify};
use columns::Columns;
use history::History;
use plan::{Home, Piece, Plan};
use track::Tracks;
use unfold::unfold;

/// Lanes of a group.
pub const LANES: usize = VECTORS * VECTOR_LANES;

/// Lanes of a word of a group: those whose BOOLs are read and set at once.
pub const VECTOR_LANES: usize = word::VECTOR_LANES;

/// The most words that code can reach.
const MOST_WORDS: usize = 1 << 24;

/// What the lanes of a group cannot do, since it would not be the same for all of them, or not in order: a scalar
/// engine
/// can, for each lane on its own.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Refused;

/// A program, compiled for lanes.
#[derive(Debug)]
pub struct Lanes {
    layout: Arc<Layout>,
    plan: Plan,
    segments: Segments,
    /// The first of those of an epoch.
    of_epoch: usize,
    /// By task: when it is due, over an image of nothing but that, and where there.
    turns: Vec<Turn>,
    dues: Layout,
}

/// Up to [`LANES`] plants: all that they hold.
#[derive(Clone, Debug)]
pub struct Group {
    /// How many vectors of a word have lanes that count.
    vectors: usize,
    words: Vec<Word>,
    columns: Columns,
    tracks: Tracks,
    history: History,
    /// When each task is due next.
    dues: Vec<u8>,
}

impl Lanes {
    /// Compiles a verified program for this machine, on all its cores.
    ///
    /// # Errors
    /// When there is no back end for this machine, or none for its vectors; when the program is too large, or looks at
    /// when its own tasks are due; or when memory is refused.
    pub fn compile(program: &Program) -> Result<Self, CompileError> {
        Self::compile_as(program, true, true)
    }

    /// The same, for tests: `recognises` is off where all is to take the general path, and `wide` where vectors are to be
    /// Cranelift's.
    fn compile_as(program: &Program, recognises: bool, wide: bool) -> Result<Self, CompileError> {
        debug_assert_eq!(verify(program), Ok(()), "engines take verified programs only");
        let refused = |reason: String| CompileError::Chunk { sections: 0..program.sections.len(), reason };
        if touches_turns(program) {
            return Err(refused("its rungs look at when a task is due, which lanes have in common".to_owned()));
        }
        let unfolded = recognises.then(|| unfold(program));
        let plan = Plan::of(unfolded.as_ref().unwrap_or(program), recognises);
        if plan.words.max(plan.stamp_stride() * epoch::KINDS) > MOST_WORDS {
            return Err(refused(format!("it has {} BOOLs, and at most {MOST_WORDS} can be reached", plan.words)));
        }
        let isa = host_isa()?;
        let (code, of_epoch) = compile::compile(&plan, &*isa, wide)?;
        let segments = Segments::install(&code).map_err(CompileError::Memory)?;
        let (turns, dues) = turns(program);
        Ok(Self { layout: Arc::clone(&program.layout), plan, segments, of_epoch, turns, dues })
    }

    /// So many plants, or as many as a group has, before the first scan: every slot at its initial value. Lanes beyond
    /// them
    /// are there, but may not be scanned.
    pub fn group(&self, lanes: usize) -> Group {
        let presets = self.plan.presets.iter().map(|preset| preset.nanoseconds);
        let mut group = Group {
            vectors: lanes.div_ceil(VECTOR_LANES).clamp(1, VECTORS),
            words: vec![Word::ZEROS; self.plan.words],
            columns: Columns::new(self.plan.columns),
            tracks: Tracks::new(&self.plan),
            history: History::new(presets),
            dues: self.dues.initial_image(),
        };
        group.words[plan::TRUE_WORD as usize] = Word::ONES;
        for (column, bits) in &self.plan.constants {
            group.columns.fill(*column, *bits);
        }
        for (home, slot) in self.plan.homes.iter().zip(self.layout.slots()) {
            match home {
                Home::Word(word) => group.words[*word as usize] = Word::all(slot.initial.is_true()),
                Home::Column(column) => group.columns.fill(*column, slot.initial.bits()),
                Home::Tracked(_) | Home::Due(_) => {}
            }
        }
        group
    }

    /// Runs one scan in every lane.
    ///
    /// # Errors
    /// [`Refused`] when `now` is before that of the last scan, or below 0; or after 2^32 scans. Nothing is done then.
    ///
    /// # Panics
    /// When the group is another program's.
    pub fn scan(&self, group: &mut Group, now: i64) -> Result<(), Refused> {
        let Group { vectors, words, columns, tracks, history, dues } = group;
        if !history.accepts(now) {
            return Err(Refused);
        }
        let scan = history.begin(now);
        let run = |segment: usize, common: &mut [Word], stamps: &mut [Word], count: usize| {
            self.segments.run(self.of_epoch + segment, common, stamps, [count, VECTORS]);
        };
        tracks.begin(&self.plan, history, words, &run);
        let mut segment = 0;
        for (task, (turn, pieces)) in self.turns.iter().zip(&self.plan.tasks).enumerate() {
            let runs = turn.take(dues, now);
            tracks.note_run(&self.plan, task, scan, runs);
            let row = tracks.stamps.row(scan);
            for piece in pieces {
                match piece {
                    Piece::Segment(_) => {
                        if runs {
                            self.segments.run(segment, words, row, [1, *vectors]);
                        }
                        segment += 1;
                    }
                    Piece::Steps(steps) if runs => {
                        steps.iter().for_each(|step| columns.execute(step, words, now));
                    }
                    Piece::Steps(_) => {}
                }
            }
        }
        Ok(())
    }

    /// The value of a slot in a lane.
    ///
    /// # Panics
    /// When there is no such slot or lane, or the group is another program's.
    pub fn get(&self, group: &Group, lane: usize, slot: SlotId) -> Value {
        let ty = self.layout.slot(slot).ty;
        let bits = match self.plan.homes[slot.index()] {
            Home::Word(word) => u64::from(group.words[word as usize].get(lane)),
            Home::Column(column) => group.columns.get(column, lane),
            Home::Tracked(index) => group.tracks.get(&self.plan, &group.history, &group.words, (index, lane)),
            Home::Due(task) => self.due(group, task).bits(),
        };
        Value::from_bits(ty, bits)
    }

    /// Sets a slot in a lane; bits outside its type are dropped.
    ///
    /// # Errors
    /// [`Refused`] when the slot keeps the time of a scan, as a timer's start does, or when a task is due next, and the
    /// value is another than it has.
    ///
    /// # Panics
    /// As [`Lanes::get`].
    pub fn set(&self, group: &mut Group, lane: usize, slot: SlotId, value: Value) -> Result<(), Refused> {
        let value = Value::from_bits(self.layout.slot(slot).ty, value.bits());
        match self.plan.homes[slot.index()] {
            Home::Word(word) => group.words[word as usize].set(lane, value.is_true()),
            Home::Column(column) => group.columns.set(column, lane, value.bits()),
            Home::Tracked(_) | Home::Due(_) if self.get(group, lane, slot) == value => {}
            Home::Tracked(index) if group.tracks.set(&self.plan, &mut group.words, (index, lane), value.bits()) => {}
            Home::Tracked(_) | Home::Due(_) => return Err(Refused),
        }
        Ok(())
    }

    /// A BOOL slot in 128 lanes, of which the first is the lowest bit; of another slot, whether it is other than 0.
    ///
    /// # Panics
    /// When there is no such slot or vector of lanes, or the group is another program's.
    pub fn word(&self, group: &Group, slot: SlotId, vector: usize) -> u128 {
        match self.plan.homes[slot.index()] {
            Home::Word(word) => group.words[word as usize].vector(vector),
            Home::Column(_) | Home::Tracked(_) | Home::Due(_) => {
                let first = vector * VECTOR_LANES;
                let holds = |lane: usize| u128::from(self.get(group, first + lane, slot).is_true()) << lane;
                (0..VECTOR_LANES).map(holds).sum()
            }
        }
    }

    /// Sets a BOOL slot in 128 lanes, of which the first is the lowest bit. A slot of another type stays as it is.
    ///
    /// # Panics
    /// As [`Lanes::word`].
    pub fn set_word(&self, group: &mut Group, slot: SlotId, vector: usize, bits: u128) {
        if let Home::Word(word) = self.plan.homes[slot.index()] {
            group.words[word as usize].set_vector(vector, bits);
        }
    }

    fn due(&self, group: &Group, task: usize) -> Value {
        // Those of the tasks before it are before it.
        let periodic = self.turns[..task].iter().filter(|turn| **turn != Turn::default()).count();
        self.dues.slots()[periodic].read(&group.dues)
    }

    /// Slots that take the general path, a value for each lane: how many of how many.
    pub fn general(&self) -> (usize, usize) {
        let columns = self.plan.homes.iter().filter(|home| matches!(home, Home::Column(_)));
        (columns.count(), self.plan.homes.len())
    }
}

/// Whether any instruction loads or stores a slot in which a task keeps when it is due. Lowered programs have none.
fn touches_turns(program: &Program) -> bool {
    let dues: Vec<SlotId> = program.tasks.iter().filter_map(|task| task.due).collect();
    let within = |array: ArrayId| dues.iter().any(|due| program.layout.array(array).slots().contains(due));
    program.instructions.iter().any(|instruction| match instruction.op {
        Op::Load(slot) | Op::Store(slot, _) => dues.contains(&slot),
        Op::LoadIndexed(array, _) | Op::StoreIndexed(array, ..) => within(array),
        Op::CopyArray(to, from, _) => within(to) || within(from),
        Op::Constant(_)
        | Op::Now
        | Op::Unary(..)
        | Op::Binary(..)
        | Op::Compare(..)
        | Op::Select(..)
        | Op::Convert(_)
        | Op::Reinterpret(_)
        | Op::Call(..) => false,
    })
}

/// When each task is due, over an image of its own of nothing but that.
fn turns(program: &Program) -> (Vec<Turn>, Layout) {
    let mut layout = LayoutBuilder::new();
    let own: Vec<Option<SlotId>> = program
        .tasks
        .iter()
        .map(|task| {
            let slot = task.interval.and(task.due).map(|due| program.layout.slot(due).clone())?;
            Some(layout.slot(slot))
        })
        .collect();
    // Eight bytes a task, of an image that has as many.
    let layout = layout.finish(None).unwrap_or_else(|_| unreachable!("it is a part of an image that is small enough"));
    let turns = program.tasks.iter().zip(own).map(|(task, due)| Turn::of(&Task { due, ..task.clone() }, &layout));
    (turns.collect(), layout)
}
