//! A chunk's instructions, sorted into segments and steps.

use std::collections::{BTreeMap, HashMap};
use std::ops::Range;

use super::{Answer, Bit, BitOp, Cell, FALSE_WORD, Home, Piece, Plan, Recognised, TRUE_WORD};
use crate::elementary::Elementary;
use crate::engine::lanes::columns::{Column, Elements, Place, Step};
use crate::engine::lanes::recognise::{Due, Leaf};
use crate::logic::{ArrayId, Binary, Compare, Instruction, Op, Program, SlotId, Unary, ValueId};

/// Operations after which a segment ends with its section. Its code goes through all vectors of a word, and what it
/// touches in the first of them should still be near for the others: some 300 words are 20 kB.
const MOST_OPS: usize = 450;

/// Places beyond those of slots: what waits between pieces, and constants. Chunks use the same ones again.
pub(super) struct Store {
    /// The first word, and how many are needed.
    first_word: u32,
    words: u32,
    /// By width: the next column.
    columns: [u32; 4],
    constants: HashMap<(Elementary, u64), Column>,
    /// Columns that hold nothing now, by width.
    free: [Vec<u32>; 4],
}

impl Store {
    pub(super) fn new(plan: &Plan) -> Self {
        Self {
            first_word: u32::try_from(plan.words).unwrap_or(u32::MAX),
            words: 0,
            columns: plan.columns.map(|count| u32::try_from(count).unwrap_or(u32::MAX)),
            constants: HashMap::new(),
            free: Default::default(),
        }
    }

    /// Tells the plan of all places that were given.
    pub(super) fn settle(self, plan: &mut Plan) {
        plan.words += self.words as usize;
        plan.columns = self.columns.map(|count| count as usize);
        plan.constants = self.constants.into_iter().map(|((_, bits), column)| (column, bits)).collect();
    }

    fn column(&mut self, ty: Elementary) -> Column {
        let width = width(ty);
        let index = self.free[width].pop().unwrap_or_else(|| self.fresh(width));
        Column { ty, index }
    }

    fn fresh(&mut self, width: usize) -> u32 {
        self.columns[width] += 1;
        self.columns[width] - 1
    }

    fn constant(&mut self, ty: Elementary, bits: u64) -> Column {
        if let Some(column) = self.constants.get(&(ty, bits)) {
            return *column;
        }
        // Not from those that are free: they are written to.
        let column = Column { ty, index: self.fresh(width(ty)) };
        *self.constants.entry((ty, bits)).or_insert(column)
    }
}

fn width(ty: Elementary) -> usize {
    ty.size().trailing_zeros() as usize
}

/// Where a value is.
#[derive(Clone, Copy, Debug)]
enum Held {
    /// In the open segment.
    Bit(Bit),
    /// In a word that waits.
    Waiting(u32),
    /// In a column that is its own until its last use.
    Own(Column),
    /// In a slot's column.
    Slot(Column),
}

/// The pieces of a chunk.
pub(super) fn pieces(
    program: &Program,
    plan: &Plan,
    recognised: &Recognised,
    dues: &HashMap<Due, usize>,
    stores: &HashMap<usize, usize>,
    store: &mut Store,
    sections: Range<usize>,
) -> Vec<Piece> {
    let range = program.instruction_range(sections.clone());
    let mut sorter = Sorter {
        program,
        plan,
        recognised,
        dues,
        stores,
        asked: HashMap::new(),
        last_use: HashMap::new(),
        held: HashMap::new(),
        aliases: BTreeMap::new(),
        segment: Vec::new(),
        in_segment: Vec::new(),
        loaded: HashMap::new(),
        steps: Vec::new(),
        answered: Vec::new(),
        waiting: 0,
        pieces: Vec::new(),
        at: range.start,
        store,
    };
    sorter.prepare(range);
    for section in sections {
        for index in program.section_range(section) {
            sorter.at = index;
            sorter.instruction(index, program.instructions[index]);
            sorter.release(index);
        }
        if sorter.segment.len() >= MOST_OPS {
            sorter.at += 1;
            sorter.end_segment();
        }
    }
    sorter.end_segment();
    sorter.end_steps();
    sorter.finish()
}

struct Sorter<'a> {
    program: &'a Program,
    plan: &'a Plan,
    recognised: &'a Recognised,
    dues: &'a HashMap<Due, usize>,
    store: &'a mut Store,
    /// The questions of the chunk that are still to come or were answered, by the latch.
    asked: HashMap<SlotId, Vec<(ValueId, Answer)>>,
    /// The tracked slots, by the instructions that store them.
    stores: &'a HashMap<usize, usize>,
    /// The last instruction that uses a value.
    last_use: HashMap<ValueId, usize>,
    held: HashMap<ValueId, Held>,
    /// The values that are in a slot's column, by the slot.
    aliases: BTreeMap<SlotId, Vec<ValueId>>,
    segment: Vec<BitOp>,
    /// The values that are held in the open segment.
    in_segment: Vec<ValueId>,
    /// Words that wait and were loaded in the open segment already.
    loaded: HashMap<u32, u32>,
    steps: Vec<Step>,
    /// Words that the open steps set.
    answered: Vec<u32>,
    /// Words that wait so far.
    waiting: u32,
    pieces: Vec<Piece>,
    at: usize,
}

impl Sorter<'_> {
    /// Finds the last use of each value. A tracked slot's store uses the conditions of the choice that is stored.
    fn prepare(&mut self, range: Range<usize>) {
        for index in range {
            let op = self.program.instructions[index].op;
            if let Some(answer @ Answer::Due { due, .. }) = self.recognised.answers.get(&id(index)) {
                self.asked.entry(due.latch).or_default().push((id(index), *answer));
            }
            if self.recognised.absorbed.contains(&id(index)) || self.recognised.answers.contains_key(&id(index)) {
                continue;
            }
            if self.stores.contains_key(&index) {
                op.operands().for_each(|root| self.use_conditions(root, index));
            } else {
                self.last_use.extend(op.operands().map(|operand| (operand, index)));
            }
        }
    }

    fn use_conditions(&mut self, value: ValueId, index: usize) {
        // A tracked slot's choice has few nodes.
        if let Op::Select(condition, a, b) = self.program.instructions[value.index()].op {
            self.last_use.insert(condition, index);
            self.use_conditions(a, index);
            self.use_conditions(b, index);
        }
    }

    fn finish(self) -> Vec<Piece> {
        self.store.words = self.store.words.max(self.waiting);
        self.pieces
    }

    fn instruction(&mut self, index: usize, Instruction { ty, op }: Instruction) {
        let id = id(index);
        if let Some(answer) = self.recognised.answers.get(&id) {
            if !self.held.contains_key(&id) {
                self.answer_question(id, *answer);
            }
            return;
        }
        if let Some(track) = self.stores.get(&index) {
            return self.note(*track, op);
        }
        let unused = op.has_value() && !self.last_use.contains_key(&id);
        if unused || self.recognised.absorbed.contains(&id) {
            return;
        }
        if ty == Elementary::Bool { self.bool_instruction(id, op) } else { self.wide_instruction(id, ty, op) }
    }

    fn bool_instruction(&mut self, id: ValueId, op: Op) {
        let bit = match op {
            Op::Constant(bits) => Bit::Constant(bits != 0),
            Op::Load(slot) => {
                let word = self.word_of(slot);
                self.load(Cell::Word(word))
            }
            Op::Store(slot, a) => {
                let (word, a) = (self.word_of(slot), self.bit(a));
                self.push(BitOp::Store(Cell::Word(word), a));
                return;
            }
            Op::Unary(op, a) => {
                let a = self.bit(a);
                match op {
                    Unary::Not => self.not(a),
                    Unary::Negate | Unary::Absolute | Unary::SquareRoot => unreachable!("not an operation on BOOLs"),
                }
            }
            Op::Binary(op, a, b) => {
                let (a, b) = (self.bit(a), self.bit(b));
                match op {
                    Binary::And => self.and(a, b),
                    Binary::Or => self.or(a, b),
                    Binary::Xor => self.xor(a, b),
                    Binary::Add
                    | Binary::Subtract
                    | Binary::Multiply
                    | Binary::Divide
                    | Binary::Remainder
                    | Binary::Minimum
                    | Binary::Maximum
                    | Binary::ShiftLeft
                    | Binary::ShiftRight
                    | Binary::RotateLeft
                    | Binary::RotateRight => unreachable!("not an operation on BOOLs"),
                }
            }
            Op::Compare(op, a, b) if self.ty(a) == Elementary::Bool => {
                let (a, b) = (self.bit(a), self.bit(b));
                self.compare(op, a, b)
            }
            Op::Select(condition, a, b) => {
                let (condition, a, b) = (self.bit(condition), self.bit(a), self.bit(b));
                self.select(condition, a, b)
            }
            Op::Convert(a) | Op::Reinterpret(a) if self.ty(a) == Elementary::Bool => self.bit(a),
            Op::Compare(op, a, b) => {
                let (a, b) = (self.column(a), self.column(b));
                return self.answer(id, |to| Step::Compare { op, to, a, b });
            }
            Op::Convert(a) => {
                let from = Place::Column(self.column(a));
                return self.answer(id, |to| Step::Convert { to: Place::Word(to), from });
            }
            Op::LoadIndexed(array, index) => {
                let (from, index) = (self.elements(array), self.column(index));
                self.end_segment();
                self.answer(id, |to| Step::LoadIndexed { to: Place::Word(to), from, index });
                // Before anything sets a word that it reads.
                return self.end_steps();
            }
            Op::StoreIndexed(array, index, a) => {
                let (to, index, from) = (self.elements(array), self.column(index), Place::Word(self.word(a)));
                return self.on_words(Step::StoreIndexed { to, index, from });
            }
            Op::CopyArray(to, from, condition) => {
                let (to, from, condition) = (self.elements(to), self.elements(from), self.word(condition));
                return self.on_words(Step::CopyArray { to, from, condition });
            }
            Op::Now | Op::Call(..) | Op::Reinterpret(_) => unreachable!("not of type BOOL in a verified program"),
        };
        self.hold_bit(id, bit);
    }

    fn wide_instruction(&mut self, id: ValueId, ty: Elementary, op: Op) {
        match op {
            Op::Constant(bits) => {
                let column = self.store.constant(ty, bits);
                self.held.insert(id, Held::Slot(column));
            }
            Op::Load(slot) => {
                let column = self.column_of(slot);
                self.held.insert(id, Held::Slot(column));
                self.aliases.entry(slot).or_default().push(id);
            }
            Op::Store(slot, a) => {
                let (to, from) = (self.column_of(slot), self.column(a));
                self.unalias(slot..SlotId(slot.0 + 1));
                self.steps.push(Step::Copy { to, from });
            }
            Op::Now => self.make(id, ty, |to| Step::Now { to }),
            Op::Unary(op, a) => {
                let a = self.column(a);
                self.make(id, ty, |to| Step::Unary { op, to, a });
            }
            Op::Binary(op, a, b) => {
                let (a, b) = (self.column(a), self.column(b));
                self.make(id, ty, |to| Step::Binary { op, to, a, b });
            }
            Op::Select(condition, a, b) => {
                let (condition, a, b) = (self.word(condition), self.column(a), self.column(b));
                self.make(id, ty, |to| Step::Select { to, condition, a, b });
            }
            Op::Convert(a) => {
                let from = self.place(a);
                self.make(id, ty, |to| Step::Convert { to: Place::Column(to), from });
            }
            Op::Reinterpret(a) => {
                // A column holds no more than the bits.
                let from = self.column(a);
                self.make(id, ty, |to| Step::Copy { to, from });
            }
            Op::Call(helper, a, b) => {
                let (a, b) = (self.column(a), b.map(|b| self.column(b)));
                self.make(id, ty, |to| Step::Call { helper, to, a, b });
            }
            Op::LoadIndexed(array, index) => {
                let (from, index) = (self.elements(array), self.column(index));
                self.make(id, ty, |to| Step::LoadIndexed { to: Place::Column(to), from, index });
            }
            Op::StoreIndexed(array, index, a) => {
                let (to, index, from) = (self.elements(array), self.column(index), Place::Column(self.column(a)));
                self.unalias(self.program.layout.array(array).slots());
                self.steps.push(Step::StoreIndexed { to, index, from });
            }
            Op::CopyArray(array, from, condition) => {
                let (to, from, condition) = (self.elements(array), self.elements(from), self.word(condition));
                self.unalias(self.program.layout.array(array).slots());
                self.steps.push(Step::CopyArray { to, from, condition });
            }
            Op::Compare(..) => unreachable!("of type BOOL in a verified program"),
        }
    }

    /// Answers a question about a latch, of what was foreseen and what was set since.
    fn answer_question(&mut self, id: ValueId, answer: Answer) {
        let bit = match answer {
            Answer::Always(value) => Bit::Constant(value),
            Answer::Due { due, inverted } => {
                let stamp = self.dues[&due];
                let due = self.load(Cell::Row(row_of(stamp)));
                let bit = match self.plan.stamps[stamp].recent {
                    Some(recent) => {
                        let recent = self.load(Cell::Word(recent));
                        let still = self.not(recent);
                        self.and(due, still)
                    }
                    None => due,
                };
                if inverted { self.not(bit) } else { bit }
            }
        };
        self.hold_bit(id, bit);
    }

    /// Notes which of a tracked slot's choices is taken.
    fn note(&mut self, track: usize, op: Op) {
        let Some(root) = op.operands().next() else { return };
        let track = &self.plan.tracks[track];
        // What is asked of a latch is meant of what it holds before.
        for (id, answer) in self.asked.remove(&track.tracked.slot).unwrap_or_default() {
            if !self.held.contains_key(&id) {
                self.answer_question(id, answer);
            }
        }
        if !track.stamps.is_empty() {
            let held = vec![Bit::Constant(false)];
            let is_set = self.choice(root, &held, &|_| vec![Bit::Constant(true)], &mut HashMap::new());
            for stamp in &track.stamps {
                if let Some(word) = self.plan.stamps[*stamp].recent {
                    let before = self.load(Cell::Word(word));
                    let recent = self.or(before, is_set[0]);
                    self.push(BitOp::Store(Cell::Word(word), recent));
                }
                self.push(BitOp::Store(Cell::Row(row_of(*stamp)), is_set[0]));
            }
        }
        if !track.codes.is_empty() {
            let held: Vec<Bit> = match track.tracked.keeps {
                true => track.codes.clone().map(|word| self.load(Cell::Word(word))).collect(),
                false => Vec::new(),
            };
            let given = |leaf: Leaf| {
                let code = track.tracked.code(leaf);
                (0..track.codes.len()).map(|bit| Bit::Constant(code >> bit & 1 != 0)).collect()
            };
            let code = self.choice(root, &held, &given, &mut HashMap::new());
            for (word, bit) in track.codes.clone().zip(code) {
                self.push(BitOp::Store(Cell::Word(word), bit));
            }
        }
    }

    /// What a choice gives, as bits: some for what the slot held, and some for each leaf.
    fn choice(
        &mut self,
        value: ValueId,
        held: &[Bit],
        given: &impl Fn(Leaf) -> Vec<Bit>,
        known: &mut HashMap<ValueId, Vec<Bit>>,
    ) -> Vec<Bit> {
        if let Some(bits) = known.get(&value) {
            return bits.clone();
        }
        let leaf = match self.program.instructions[value.index()].op {
            Op::Select(condition, a, b) => {
                let (a, b) = (self.choice(a, held, given, known), self.choice(b, held, given, known));
                let condition = self.bit(condition);
                let bits: Vec<Bit> = a.into_iter().zip(b).map(|(a, b)| self.select(condition, a, b)).collect();
                known.insert(value, bits.clone());
                return bits;
            }
            Op::Constant(bits) => Some(Leaf::Constant(bits)),
            Op::Now => Some(Leaf::Now),
            Op::Binary(_, _, latch) => match self.program.instructions[latch.index()].op {
                Op::Load(slot) => Some(Leaf::Since(slot)),
                _ => None,
            },
            // What the slot held.
            Op::Load(_)
            | Op::Store(..)
            | Op::Unary(..)
            | Op::Compare(..)
            | Op::Convert(_)
            | Op::Reinterpret(_)
            | Op::Call(..)
            | Op::LoadIndexed(..)
            | Op::StoreIndexed(..)
            | Op::CopyArray(..) => None,
        };
        leaf.map_or_else(|| held.to_vec(), given)
    }

    // Places.

    fn ty(&self, value: ValueId) -> Elementary {
        self.program.instructions[value.index()].ty
    }

    fn word_of(&self, slot: SlotId) -> u32 {
        match self.plan.homes[slot.index()] {
            Home::Word(word) => word,
            Home::Column(_) | Home::Tracked(_) | Home::Due(_) => unreachable!("a BOOL slot has a word"),
        }
    }

    fn column_of(&self, slot: SlotId) -> Column {
        match self.plan.homes[slot.index()] {
            Home::Column(column) => column,
            Home::Word(_) | Home::Tracked(_) | Home::Due(_) => {
                unreachable!("what is loaded and stored in the general way has a column")
            }
        }
    }

    fn elements(&self, array: ArrayId) -> Elements {
        let array = self.program.layout.array(array);
        let first = match self.plan.homes[array.first.index()] {
            Home::Word(word) => Place::Word(word),
            Home::Column(column) => Place::Column(column),
            Home::Tracked(_) | Home::Due(_) => unreachable!("no element of an array is tracked"),
        };
        Elements { first, count: array.count }
    }

    // Values in segments.

    fn load(&mut self, cell: Cell) -> Bit {
        self.push(BitOp::Load(cell))
    }

    fn push(&mut self, op: BitOp) -> Bit {
        self.segment.push(op);
        Bit::Made(u32::try_from(self.segment.len() - 1).unwrap_or(u32::MAX))
    }

    fn hold_bit(&mut self, id: ValueId, bit: Bit) {
        self.held.insert(id, Held::Bit(bit));
        self.in_segment.push(id);
    }

    /// A BOOL in the open segment.
    fn bit(&mut self, id: ValueId) -> Bit {
        match self.held.get(&id) {
            Some(Held::Bit(bit)) => *bit,
            Some(Held::Waiting(word)) => {
                let word = *word;
                if self.answered.contains(&word) {
                    self.end_steps();
                }
                if let Some(made) = self.loaded.get(&word) {
                    return Bit::Made(*made);
                }
                let bit = self.load(Cell::Word(word));
                if let Bit::Made(made) = bit {
                    self.loaded.insert(word, made);
                }
                bit
            }
            Some(Held::Own(_) | Held::Slot(_)) | None => unreachable!("a BOOL that was made before"),
        }
    }

    /// A BOOL in a word that steps can read.
    fn word(&mut self, id: ValueId) -> u32 {
        match self.held.get(&id) {
            Some(Held::Waiting(word)) => *word,
            Some(Held::Bit(Bit::Constant(value))) => {
                if *value {
                    TRUE_WORD
                } else {
                    FALSE_WORD
                }
            }
            Some(Held::Bit(Bit::Made(_))) => {
                self.end_segment();
                match self.held.get(&id) {
                    Some(Held::Waiting(word)) => *word,
                    _ => unreachable!("what is used later waits"),
                }
            }
            Some(Held::Own(_) | Held::Slot(_)) | None => unreachable!("a BOOL that was made before"),
        }
    }

    fn wait(&mut self) -> u32 {
        self.waiting += 1;
        self.store.first_word + self.waiting - 1
    }

    /// Ends the open segment: what is needed of it later waits in words.
    fn end_segment(&mut self) {
        for id in std::mem::take(&mut self.in_segment) {
            let needed = self.last_use.get(&id).is_some_and(|last| *last >= self.at);
            if let (true, Some(Held::Bit(bit @ Bit::Made(_)))) = (needed, self.held.get(&id).copied()) {
                let word = self.wait();
                self.segment.push(BitOp::Store(Cell::Word(word), bit));
                self.held.insert(id, Held::Waiting(word));
            }
        }
        self.loaded.clear();
        if !self.segment.is_empty() {
            self.pieces.push(Piece::Segment(std::mem::take(&mut self.segment)));
        }
    }

    /// Ends the open steps.
    fn end_steps(&mut self) {
        self.answered.clear();
        if !self.steps.is_empty() {
            self.pieces.push(Piece::Steps(std::mem::take(&mut self.steps)));
        }
    }

    // Steps.

    /// A value in a column, until its last use at the earliest.
    fn column(&mut self, id: ValueId) -> Column {
        match self.held.get(&id) {
            Some(Held::Own(column) | Held::Slot(column)) => *column,
            Some(Held::Bit(_) | Held::Waiting(_)) | None => unreachable!("a value that was made before"),
        }
    }

    fn place(&mut self, id: ValueId) -> Place {
        if self.ty(id) == Elementary::Bool { Place::Word(self.word(id)) } else { Place::Column(self.column(id)) }
    }

    /// A step that makes a value in a column of its own.
    fn make(&mut self, id: ValueId, ty: Elementary, step: impl FnOnce(Column) -> Step) {
        let to = self.store.column(ty);
        self.steps.push(step(to));
        self.held.insert(id, Held::Own(to));
    }

    /// A step that makes a BOOL in a word that waits.
    fn answer(&mut self, id: ValueId, step: impl FnOnce(u32) -> Step) {
        let word = self.wait();
        self.steps.push(step(word));
        self.answered.push(word);
        self.held.insert(id, Held::Waiting(word));
    }

    /// A step that sets words of slots: all that comes before is done before it, all that comes after it after it.
    fn on_words(&mut self, step: Step) {
        self.end_segment();
        self.steps.push(step);
        self.end_steps();
    }

    /// Slots are about to be stored: values that are still needed move out of their columns.
    fn unalias(&mut self, slots: Range<SlotId>) {
        let touched: Vec<SlotId> = self.aliases.range(slots).map(|(slot, _)| *slot).collect();
        for id in touched.into_iter().filter_map(|slot| self.aliases.remove(&slot)).flatten() {
            let needed = self.last_use.get(&id).is_some_and(|last| *last > self.at);
            if let (true, Some(Held::Slot(from))) = (needed, self.held.get(&id).copied()) {
                let to = self.store.column(from.ty);
                self.steps.push(Step::Copy { to, from });
                self.held.insert(id, Held::Own(to));
            }
        }
    }

    /// Gives back the columns of values that were used last by an instruction.
    fn release(&mut self, index: usize) {
        let op = self.program.instructions[index].op;
        for operand in op.operands() {
            if self.last_use.get(&operand) == Some(&index)
                && let Some(Held::Own(column)) = self.held.get(&operand).copied()
            {
                self.held.remove(&operand);
                self.store.free[width(column.ty)].push(column.index);
            }
        }
    }

    // Operations on bits, simplified where one is known.

    fn not(&mut self, a: Bit) -> Bit {
        match a {
            Bit::Constant(value) => Bit::Constant(!value),
            Bit::Made(a) => self.push(BitOp::Not(a)),
        }
    }

    fn and(&mut self, a: Bit, b: Bit) -> Bit {
        match (a, b) {
            (Bit::Constant(false), _) | (_, Bit::Constant(false)) => Bit::Constant(false),
            (Bit::Constant(true), other) | (other, Bit::Constant(true)) => other,
            (Bit::Made(a), Bit::Made(b)) if a == b => Bit::Made(a),
            (Bit::Made(a), Bit::Made(b)) => self.push(BitOp::And(a, b)),
        }
    }

    fn or(&mut self, a: Bit, b: Bit) -> Bit {
        match (a, b) {
            (Bit::Constant(true), _) | (_, Bit::Constant(true)) => Bit::Constant(true),
            (Bit::Constant(false), other) | (other, Bit::Constant(false)) => other,
            (Bit::Made(a), Bit::Made(b)) if a == b => Bit::Made(a),
            (Bit::Made(a), Bit::Made(b)) => self.push(BitOp::Or(a, b)),
        }
    }

    fn xor(&mut self, a: Bit, b: Bit) -> Bit {
        match (a, b) {
            (Bit::Constant(false), other) | (other, Bit::Constant(false)) => other,
            (Bit::Constant(true), other) | (other, Bit::Constant(true)) => self.not(other),
            (Bit::Made(a), Bit::Made(b)) if a == b => Bit::Constant(false),
            (Bit::Made(a), Bit::Made(b)) => self.push(BitOp::Xor(a, b)),
        }
    }

    fn select(&mut self, condition: Bit, a: Bit, b: Bit) -> Bit {
        match (condition, a, b) {
            (Bit::Constant(true), a, _) => a,
            (Bit::Constant(false), _, b) => b,
            (_, a, b) if a == b => a,
            (condition, Bit::Constant(true), b) => self.or(condition, b),
            (condition, a, Bit::Constant(false)) => self.and(condition, a),
            (condition, Bit::Constant(false), b) => {
                let not = self.not(condition);
                self.and(b, not)
            }
            (condition, a, Bit::Constant(true)) => {
                let not = self.not(condition);
                self.or(not, a)
            }
            (condition, a, b) => {
                let not = self.not(condition);
                let (a, b) = (self.and(condition, a), self.and(b, not));
                self.or(a, b)
            }
        }
    }

    fn compare(&mut self, op: Compare, a: Bit, b: Bit) -> Bit {
        match op {
            Compare::NotEqual => self.xor(a, b),
            Compare::Equal => {
                let differ = self.xor(a, b);
                self.not(differ)
            }
            Compare::Less => {
                let not = self.not(a);
                self.and(b, not)
            }
            Compare::Greater => {
                let not = self.not(b);
                self.and(a, not)
            }
            Compare::LessOrEqual => {
                let not = self.not(a);
                self.or(b, not)
            }
            Compare::GreaterOrEqual => {
                let not = self.not(b);
                self.or(a, not)
            }
        }
    }
}

fn row_of(stamp: usize) -> u32 {
    u32::try_from(stamp).unwrap_or(u32::MAX)
}

fn id(index: usize) -> ValueId {
    ValueId(u32::try_from(index).unwrap_or(u32::MAX))
}
