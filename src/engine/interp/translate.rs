//! From a program to gates and steps.
//!
//! A BOOL stays a [`Function`] of cells for as long as it can: it gets a gate of its own when it is stored, when a step
//! needs it, when several others share it, or when a cell that it reads is about to change. A value that a later store
//! puts into a slot goes there at once if nothing touches the slot before that store.

use std::collections::{BTreeMap, HashMap};
use std::ops::Range;

use super::access::Accesses;
use super::gate::{Function, Gate, compare};
use super::step::{Kind, Step};
use super::{Interpreter, Part};
use crate::elementary::{Elementary, Value};
use crate::logic::image::write;
use crate::logic::{Array, ArrayId, Binary, Instruction, Op, Program, SlotId, Turn, Unary, ValueId};

/// Constants and the time take eight bytes each, whatever their type.
const CONSTANT_BYTES: u32 = 8;

pub(super) fn translate(program: &Program) -> Interpreter {
    let mut translator = Translator::new(program);
    let mut ends = program.tasks.iter().map(|task| task.end as usize).peekable();
    for chunk in program.chunks() {
        while ends.next_if(|end| *end <= chunk.start).is_some() {
            translator.end_task();
        }
        // No value lives beyond its chunk, so every chunk uses the same cells.
        translator.scratch_end = translator.scratch_start;
        for index in program.instruction_range(chunk) {
            translator.instruction(index);
        }
    }
    ends.for_each(|_| translator.end_task());
    translator.finish()
}

struct Translator<'a> {
    program: &'a Program,
    /// The instruction being translated.
    at: usize,
    /// What each value is made of now; of one that is not BOOL, always a single cell.
    values: Vec<Function>,
    /// How often each value is still used, from the present instruction on.
    uses: Vec<u32>,
    /// The place of the first store of each value.
    first_store: Vec<Option<usize>>,
    /// Of each store, one past the place where its slot was loaded or stored before, or 0.
    access_before: Vec<usize>,
    /// Which values may be made of the cell of a slot.
    watchers: BTreeMap<u32, Vec<ValueId>>,
    constants: HashMap<(u32, u64), u32>,
    tasks: Vec<Part>,
    gates: Vec<Gate>,
    steps: Vec<Step>,
    /// The gates before the last step.
    gates_placed: usize,
    cells: Vec<u8>,
    scratch_start: u32,
    scratch_end: u32,
    scratch_most: u32,
}

impl<'a> Translator<'a> {
    fn new(program: &'a Program) -> Self {
        let count = program.instructions.len();
        let mut uses = vec![0; count];
        let (mut first_store, mut access_before) = (vec![None; count], vec![0; count]);
        let mut accesses = Accesses::new(&program.layout);
        // The time comes right behind the image, and then a FALSE.
        let mut cells = vec![0; (program.layout.size() + 2 * CONSTANT_BYTES) as usize];
        let mut constants = HashMap::new();
        for (index, instruction) in program.instructions.iter().enumerate() {
            for operand in instruction.op.operands() {
                uses[operand.index()] += 1;
            }
            match instruction.op {
                Op::Load(slot) => {
                    accesses.slot(slot, index + 1);
                }
                Op::Store(slot, value) => {
                    first_store[value.index()].get_or_insert(index);
                    access_before[index] = accesses.slot(slot, index + 1);
                }
                Op::LoadIndexed(array, _) | Op::StoreIndexed(array, ..) => {
                    accesses.array(array, &program.layout, index + 1);
                }
                Op::CopyArray(to, from, _) => {
                    for array in [to, from] {
                        accesses.array(array, &program.layout, index + 1);
                    }
                }
                Op::Constant(bits) if instruction.ty != Elementary::Bool => {
                    constants.entry((instruction.ty.size(), bits)).or_insert_with(|| {
                        let cell = offset(cells.len());
                        cells.resize(cells.len() + CONSTANT_BYTES as usize, 0);
                        write(&mut cells, cell, Value::from_bits(instruction.ty, bits));
                        cell
                    });
                }
                _ => {}
            }
        }
        let scratch = offset(cells.len());
        Self {
            program,
            at: 0,
            values: vec![Function::constant(false); count],
            uses,
            first_store,
            access_before,
            watchers: BTreeMap::new(),
            constants,
            tasks: Vec::new(),
            gates: Vec::new(),
            steps: Vec::new(),
            gates_placed: 0,
            cells,
            scratch_start: scratch,
            scratch_end: scratch,
            scratch_most: scratch,
        }
    }

    fn finish(mut self) -> Interpreter {
        self.cells.resize(self.scratch_most as usize, 0);
        let image_size = self.program.layout.size() as usize;
        Interpreter { tasks: self.tasks, gates: self.gates, steps: self.steps, cells: self.cells, image_size }
    }

    /// Ends the next task: what was made since the last one is its.
    fn end_task(&mut self) {
        let (gates, steps) = self.tasks.last().map_or((0, 0), |task| (task.gates.end, task.steps.end));
        let task = &self.program.tasks[self.tasks.len()];
        let turn = Turn::of(task, &self.program.layout);
        self.tasks.push(Part { turn, gates: gates..self.gates.len(), steps: steps..self.steps.len() });
        self.gates_placed = self.gates.len();
    }

    fn instruction(&mut self, index: usize) {
        self.at = index;
        let instruction = self.program.instructions[index];
        let value = ValueId(offset(index));
        match instruction.op {
            Op::Store(slot, stored) => self.store(slot, stored),
            Op::StoreIndexed(array, place, stored) => self.store_indexed(array, place, stored),
            Op::CopyArray(to, from, condition) => self.copy_array(to, from, condition),
            // What nothing uses is not computed.
            _ if self.uses[index] == 0 => {}
            Op::Constant(bits) if instruction.ty == Elementary::Bool => {
                self.set(value, Function::constant(bits != 0));
            }
            Op::Constant(bits) => self.set(value, Function::cell(self.constants[&(instruction.ty.size(), bits)])),
            Op::Now => self.set(value, Function::cell(self.program.layout.size())),
            Op::Load(slot) => self.set(value, Function::cell(self.program.layout.slot(slot).offset)),
            // The same bytes, and so the same cell.
            Op::Reinterpret(a) => self.set(value, self.values[a.index()]),
            Op::LoadIndexed(array, place) => self.load_indexed(value, array, place),
            op => match boolean(self.program, instruction) {
                Some(of) => {
                    let function = self.combine(op, of);
                    self.set(value, function);
                }
                None => self.step(value, instruction),
            },
        }
        for operand in instruction.op.operands() {
            self.uses[operand.index()] -= 1;
        }
    }

    fn ty(&self, value: ValueId) -> Elementary {
        self.program.instructions[value.index()].ty
    }

    /// Notes what a value is made of now.
    fn set(&mut self, value: ValueId, function: Function) {
        self.values[value.index()] = function;
        let size = self.program.layout.size();
        for cell in function.inputs().iter().filter(|cell| **cell < size) {
            self.watchers.entry(*cell).or_default().push(value);
        }
    }

    fn store(&mut self, slot: SlotId, value: ValueId) {
        let cell = self.program.layout.slot(slot).offset;
        if self.values[value.index()].as_cell() == Some(cell) {
            return;
        }
        self.release(cell, Some(value));
        self.compute(value, cell);
    }

    fn load_indexed(&mut self, value: ValueId, array: ArrayId, index: ValueId) {
        self.settle(index);
        let Array { first, count } = self.program.layout.array(array);
        let (offset, ty) = (self.program.layout.slot(first).offset, self.ty(value));
        let target = self.target(value, ty);
        // Only now: making the target ready can move it.
        let index = self.values[index.index()].as_cell().unwrap_or_default();
        self.push(Kind::LoadIndexed(ty), [index, offset, count], target);
        self.set(value, Function::cell(target));
    }

    fn store_indexed(&mut self, array: ArrayId, index: ValueId, value: ValueId) {
        self.settle(index);
        self.settle(value);
        let Array { first, count } = self.program.layout.array(array);
        let slot = self.program.layout.slot(first);
        let (start, ty) = (slot.offset, slot.ty);
        self.release_all(start..start + count * ty.size());
        let [index, value] = [index, value].map(|of| self.values[of.index()].as_cell().unwrap_or_default());
        self.push(Kind::StoreIndexed(ty), [index, value, count], start);
    }

    fn copy_array(&mut self, to: ArrayId, from: ArrayId, condition: ValueId) {
        self.settle(condition);
        let layout = &self.program.layout;
        let Array { first, count } = layout.array(to);
        let (target, size) = (layout.slot(first).offset, count * layout.slot(first).ty.size());
        let start = layout.slot(layout.array(from).first).offset;
        self.release_all(target..target + size);
        let condition = self.values[condition.index()].as_cell().unwrap_or_default();
        self.push(Kind::CopyArray, [condition, start, size], target);
    }

    /// A BOOL operation as a function of cells.
    fn combine(&mut self, op: Op, of: Boolean) -> Function {
        for operand in op.operands() {
            // What several use is computed once.
            if self.uses[operand.index()] > 1 && self.values[operand.index()].inputs().len() > 1 {
                self.settle(operand);
            }
        }
        loop {
            // Settling one operand can move another, so each round looks at all of them anew.
            let none = Function::constant(false);
            let mut operands = [&none; 3];
            for (place, operand) in operands.iter_mut().zip(op.operands()) {
                *place = &self.values[operand.index()];
            }
            if let Some(function) = Function::combine(operands, |tables| of.apply(tables)) {
                return function;
            }
            if let Some(largest) = op.operands().max_by_key(|operand| self.values[operand.index()].inputs().len()) {
                self.settle(largest);
            }
        }
    }

    fn step(&mut self, value: ValueId, instruction: Instruction) {
        let operands: Vec<ValueId> = instruction.op.operands().collect();
        operands.iter().for_each(|operand| self.settle(*operand));
        let kind = operands.first().and_then(|first| Kind::of(instruction, self.ty(*first)));
        let Some((kind, swapped)) = kind else { return };
        // An operand for the last time may lie in the very cell that the step sets: it reads before it writes.
        operands.iter().for_each(|operand| self.uses[operand.index()] -= 1);
        let target = self.target(value, instruction.ty);
        operands.iter().for_each(|operand| self.uses[operand.index()] += 1);
        let mut cells = [0; 3];
        for (cell, operand) in cells.iter_mut().zip(&operands) {
            *cell = self.values[operand.index()].as_cell().unwrap_or_default();
        }
        if swapped {
            cells.swap(0, 1);
        }
        self.push(kind, cells, target);
        self.set(value, Function::cell(target));
    }

    fn push(&mut self, kind: Kind, operands: [u32; 3], target: u32) {
        let gates_before = offset(self.gates.len() - self.gates_placed);
        self.gates_placed = self.gates.len();
        self.steps.push(Step { gates_before, target, operands, kind });
    }

    /// Sees to it that a value has a cell of its own.
    fn settle(&mut self, value: ValueId) {
        if self.values[value.index()].as_cell().is_none() {
            let target = self.target(value, Elementary::Bool);
            self.compute(value, target);
        }
    }

    /// Computes a BOOL into a cell, or copies a value there; from now on it is that cell.
    fn compute(&mut self, value: ValueId, target: u32) {
        let function = self.values[value.index()];
        match function.as_cell() {
            Some(cell) if self.ty(value) != Elementary::Bool => {
                self.push(Kind::copy(self.ty(value)), [cell; 3], target);
            }
            _ => self.gates.push(Gate::new(&function, target, self.program.layout.size() + CONSTANT_BYTES)),
        }
        self.set(value, Function::cell(target));
    }

    /// A cell for a value: the slot that it will be stored to, if nothing touches that before, else one of its own.
    fn target(&mut self, value: ValueId, ty: Elementary) -> u32 {
        if let Some(store) = self.first_store[value.index()].filter(|store| *store > self.at)
            && let Op::Store(slot, _) = self.program.instructions[store].op
            && self.access_before[store] <= self.at
        {
            let cell = self.program.layout.slot(slot).offset;
            self.release(cell, Some(value));
            return cell;
        }
        self.scratch(ty)
    }

    fn scratch(&mut self, ty: Elementary) -> u32 {
        let cell = self.scratch_end.next_multiple_of(ty.size());
        self.scratch_end = cell + ty.size();
        self.scratch_most = self.scratch_most.max(self.scratch_end);
        cell
    }

    /// Makes the cells of an array ready to be set.
    fn release_all(&mut self, bytes: Range<u32>) {
        let cells: Vec<u32> = self.watchers.range(bytes).map(|(cell, _)| *cell).collect();
        for cell in cells {
            self.release(cell, None);
        }
    }

    /// Makes a slot's cell ready to be set to a value: whatever else is made of what it holds gets another cell.
    fn release(&mut self, cell: u32, value: Option<ValueId>) {
        for watcher in self.watchers.remove(&cell).unwrap_or_default() {
            let made_of_it = self.values[watcher.index()].inputs().contains(&cell);
            if Some(watcher) != value && self.uses[watcher.index()] > 0 && made_of_it {
                let target = self.scratch(self.ty(watcher));
                self.compute(watcher, target);
            }
        }
    }
}

/// An operation of which all operands and the result are BOOL.
#[derive(Clone, Copy)]
struct Boolean(Op);

/// The instruction's operation, if it is boolean.
fn boolean(program: &Program, instruction: Instruction) -> Option<Boolean> {
    let is_bool = |value: ValueId| program.instructions[value.index()].ty == Elementary::Bool;
    let all = instruction.ty == Elementary::Bool && instruction.op.operands().all(is_bool);
    all.then_some(Boolean(instruction.op))
}

impl Boolean {
    fn apply(self, [a, b, c]: [u16; 3]) -> u16 {
        match self.0 {
            Op::Unary(Unary::Not, _) => !a,
            Op::Binary(Binary::And, ..) => a & b,
            Op::Binary(Binary::Or, ..) => a | b,
            Op::Binary(Binary::Xor, ..) => a ^ b,
            Op::Compare(op, ..) => compare(op, a, b),
            Op::Select(..) => a & b | !a & c,
            // A conversion; the verifier leaves no other on BOOLs.
            _ => a,
        }
    }
}

fn offset(count: usize) -> u32 {
    u32::try_from(count).unwrap_or(u32::MAX)
}
