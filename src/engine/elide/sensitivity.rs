//! When the time counts: a program that runs as another does and also says whether a scan at another time would leave
//! another image.
//!
//! A value is **tainted** if it is computed from `now`. It **matters** where a change of it would change what is stored:
//! always where it is stored itself, and else where the value that it is an operand of matters, and lets it through. A
//! tainted operand of an AND passes only while the other one is TRUE, that of an OR only while the other is FALSE, and what
//! is chosen from only while it is chosen; all that provided the other operand, or the choice, is not tainted itself. So
//! for each tainted value there is a condition, over values that are not tainted, and `now` counts only while that of some
//! `now` is TRUE.
//!
//! Were one scan run at two times with all those conditions FALSE, then by induction over the instructions no value that
//! differs would matter, hence none would be stored, hence what is loaded would be the same: the images would be the same.
//!
//! Timers note the time while they are idle, to have it as their start. **Passive** slots are those that no name shows and
//! that hold something tainted. They are left out of the comparison: storing to one does not count, but a load of one is
//! treated as `now` is. While no condition of a load holds, no variable depends on what they hold either. What many scans
//! leave there is what the last of them alone would leave.
//!
//! This module must never leave out a way by which a value reaches the image.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

use crate::elementary::{Elementary, Value};
use crate::logic::image::{EarlierLayout, FAULT};
use crate::logic::{Area, Binary, Instruction, Layout, LayoutBuilder, Op, Program, Slot, SlotId, Unary, ValueId};

/// The name of the slot that says whether the time counted.
const ANSWER: &str = "#time_counts";

/// A program with an answer.
#[derive(Debug)]
pub(super) struct Twin {
    /// Over an image of which all but the end is the other's.
    pub(super) program: Program,
    /// Where in the image the answer is: set to 0 before a scan, it is 1 after it if the time counted.
    pub(super) answer: usize,
    /// The passive slots.
    pub(super) passive: BTreeSet<SlotId>,
}

/// Whether a value matters.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Matters {
    Never,
    While(ValueId),
    Always,
}

/// See the module; `None` where the image is so large that there is no room for one more slot.
pub(super) fn twin(program: &Program) -> Option<Twin> {
    let passive = passive(program);
    let (layout, answer) = with_answer(&program.layout)?;
    let offset = layout.slot(answer).offset as usize;
    let mut twin = Program {
        layout,
        instructions: Vec::with_capacity(program.instructions.len() + program.instructions.len() / 4),
        ..program.clone()
    };
    for sections in program.chunks() {
        let range = program.instruction_range(sections.clone());
        let (first, shift) = (range.start, twin.instructions.len() - range.start);
        // What was inserted before moves all values of a chunk alike.
        let moved = |value: ValueId| ValueId(index(value.index() + shift));
        for instruction in &program.instructions[range.clone()] {
            twin.instructions.push(Instruction { op: instruction.op.map_operands(moved), ..*instruction });
        }
        for section in sections.clone() {
            twin.sections[section].end = index(program.sections[section].end as usize + shift);
        }
        let tainted = tainted(program, range.clone(), |op| op == Op::Now || is_load_of(op, &passive));
        let mut end = ChunkEnd { instructions: &mut twin.instructions, first: first + shift };
        end.ask(&tainted, &passive, answer);
        if let Some(last) = sections.last() {
            twin.sections[last].end = index(twin.instructions.len());
        }
    }
    Some(Twin { program: twin, answer: offset, passive })
}

/// The layout with one more slot behind all others.
fn with_answer(layout: &Layout) -> Option<(Layout, SlotId)> {
    let mut builder = LayoutBuilder::new();
    for slot in layout.slots() {
        builder.slot(slot.clone());
    }
    for array in layout.arrays() {
        builder.array(array.first, array.count);
    }
    for observed in layout.observed() {
        builder.observe(observed.name.clone(), observed.slot);
    }
    let answer = builder.slot(Slot {
        name: ANSWER.to_owned(),
        ty: Elementary::Bool,
        offset: 0,
        area: Area::State,
        retain: false,
        initial: Value::bool(false),
        line: 0,
    });
    let layout = builder.finish(Some(&EarlierLayout::from(layout))).ok()?;
    Some((layout, answer))
}

/// The slots that no name shows and that hold something tainted, provided that what the last of many scans leaves there can
/// be told without the others: it is what was there, or has nothing to do with what was in any of them.
fn passive(program: &Program) -> BTreeSet<SlotId> {
    let mut passive = hidden(program);
    loop {
        let before = passive.len();
        let mut stores: BTreeMap<SlotId, bool> = BTreeMap::new();
        for sections in program.chunks() {
            let range = program.instruction_range(sections);
            let tainted = tainted(program, range.clone(), |op| op == Op::Now || is_load_of(op, &passive));
            let lagging = self::tainted(program, range.clone(), |op| is_load_of(op, &passive));
            for index in range.clone() {
                if let Op::Store(slot, value) = program.instructions[index].op {
                    let at = |value: ValueId| value.index() - range.start;
                    let kept_or_free = |value: ValueId| {
                        !lagging[at(value)] || program.instructions[value.index()].op == Op::Load(slot)
                    };
                    let free = match program.instructions[value.index()].op {
                        Op::Select(condition, a, b) => !tainted[at(condition)] && kept_or_free(a) && kept_or_free(b),
                        _ => !lagging[at(value)],
                    };
                    // A second store, or a load behind the first, would see what is there on the way.
                    stores.entry(slot).and_modify(|free| *free = false).or_insert(free);
                }
            }
        }
        passive.retain(|slot| stores.get(slot).is_some_and(|free| *free));
        if passive.len() == before {
            return passive;
        }
    }
}

/// The slots that hold something tainted and that nothing but loads and stores of their own can reach.
fn hidden(program: &Program) -> BTreeSet<SlotId> {
    let layout = &program.layout;
    let mut may: Vec<bool> = layout.slots().iter().map(|slot| slot.area == Area::State && slot.name != FAULT).collect();
    for observed in layout.observed() {
        may[observed.slot.index()] = false;
    }
    for array in layout.arrays() {
        may[array.indices()].fill(false);
    }
    for due in program.tasks.iter().filter_map(|task| task.due) {
        may[due.index()] = false;
    }
    let mut hidden = BTreeSet::new();
    loop {
        let before = hidden.len();
        for sections in program.chunks() {
            let range = program.instruction_range(sections);
            let tainted = tainted(program, range.clone(), |op| op == Op::Now || is_load_of(op, &hidden));
            for index in range.clone() {
                if let Op::Store(slot, value) = program.instructions[index].op
                    && may[slot.index()]
                    && tainted[value.index() - range.start]
                {
                    hidden.insert(slot);
                }
            }
        }
        if hidden.len() == before {
            return hidden;
        }
    }
}

/// Which values of a chunk are computed from one of some sources.
fn tainted(program: &Program, range: Range<usize>, is_source: impl Fn(Op) -> bool) -> Vec<bool> {
    let mut tainted = vec![false; range.len()];
    for index in range.clone() {
        let op = program.instructions[index].op;
        tainted[index - range.start] =
            is_source(op) || op.has_value() && op.operands().any(|operand| tainted[operand.index() - range.start]);
    }
    tainted
}

fn is_load_of(op: Op, slots: &BTreeSet<SlotId>) -> bool {
    matches!(op, Op::Load(slot) if slots.contains(&slot))
}

/// The end of a chunk of the twin, where conditions are appended.
struct ChunkEnd<'a> {
    instructions: &'a mut Vec<Instruction>,
    /// The chunk's first instruction.
    first: usize,
}

impl ChunkEnd<'_> {
    /// Appends what sets the answer if the time counts in this chunk.
    fn ask(&mut self, tainted: &[bool], passive: &BTreeSet<SlotId>, answer: SlotId) {
        let mut matters = vec![Matters::Never; tainted.len()];
        let mut counts = Matters::Never;
        // What uses a value comes behind it.
        for place in (0..tainted.len()).rev() {
            let Instruction { ty, op } = self.instructions[self.first + place];
            let first = self.first;
            let is = |value: ValueId| tainted[value.index() - first];
            let here = matters[place];
            if op == Op::Now || is_load_of(op, passive) {
                counts = self.either(counts, here);
            }
            // Each tainted operand, and when this instruction lets it through.
            let ways: Vec<(ValueId, Matters)> = match op {
                Op::Store(slot, a) if passive.contains(&slot) => vec![(a, Matters::Never)],
                Op::Store(..) | Op::StoreIndexed(..) | Op::CopyArray(..) => {
                    op.operands().map(|operand| (operand, Matters::Always)).collect()
                }
                Op::Binary(Binary::And, a, b) if ty == Elementary::Bool => vec![
                    (a, if is(b) { here } else { self.both(here, b) }),
                    (b, if is(a) { here } else { self.both(here, a) }),
                ],
                Op::Binary(Binary::Or, a, b) if ty == Elementary::Bool => vec![
                    (a, if is(b) { here } else { self.unless(here, b) }),
                    (b, if is(a) { here } else { self.unless(here, a) }),
                ],
                Op::Select(condition, a, b) if !is(condition) => {
                    vec![(a, self.both(here, condition)), (b, self.unless(here, condition))]
                }
                _ => op.operands().map(|operand| (operand, here)).collect(),
            };
            for (operand, way) in ways {
                let operand = operand.index() - self.first;
                if tainted[operand] {
                    matters[operand] = self.either(matters[operand], way);
                }
            }
        }
        let counts = match counts {
            Matters::Never => return,
            Matters::While(condition) => condition,
            Matters::Always => self.push(Op::Constant(1)),
        };
        let before = self.push(Op::Load(answer));
        let after = self.push(Op::Binary(Binary::Or, before, counts));
        self.push(Op::Store(answer, after));
    }

    fn push(&mut self, op: Op) -> ValueId {
        let value = ValueId(index(self.instructions.len()));
        self.instructions.push(Instruction { ty: Elementary::Bool, op });
        value
    }

    fn either(&mut self, a: Matters, b: Matters) -> Matters {
        match (a, b) {
            (Matters::Never, other) | (other, Matters::Never) => other,
            (Matters::Always, _) | (_, Matters::Always) => Matters::Always,
            (Matters::While(a), Matters::While(b)) if a == b => Matters::While(a),
            (Matters::While(a), Matters::While(b)) => Matters::While(self.push(Op::Binary(Binary::Or, a, b))),
        }
    }

    fn both(&mut self, matters: Matters, condition: ValueId) -> Matters {
        match matters {
            Matters::Never => Matters::Never,
            Matters::Always => Matters::While(condition),
            Matters::While(a) => Matters::While(self.push(Op::Binary(Binary::And, a, condition))),
        }
    }

    fn unless(&mut self, matters: Matters, condition: ValueId) -> Matters {
        if matters == Matters::Never {
            return Matters::Never;
        }
        let condition = self.push(Op::Unary(Unary::Not, condition));
        self.both(matters, condition)
    }
}

fn index(place: usize) -> u32 {
    // A program that long would need more memory than there is.
    u32::try_from(place).unwrap_or(u32::MAX)
}
