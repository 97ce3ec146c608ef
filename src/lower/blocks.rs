//! Function blocks: each block's rule, written once over its pins and states.
//!
//! A rule computes as if the block always ran. That a block whose EN is FALSE, or that a jump leaves out, keeps its
//! outputs and states is added here, so that no rule needs to know; nor that it may be an element of an array.

mod analog;
mod bistables;
mod counters;
mod edges;
mod register_machine;
mod timers;

use super::cell::{Cell, Pick};
use super::storage::{BlockCells, Cells};
use crate::elementary::{Elementary, Value};
use crate::ladder::library::StandardBlock;
use crate::logic::{Builder, ValueId};

/// What a block computes.
pub(super) struct Rule {
    /// What it remembers beside its outputs: names that set the slots apart, and types. All start at 0.
    pub(super) states: &'static [(&'static str, Elementary)],
    /// Computes one run, setting outputs and states.
    pub(super) run: fn(&mut Run<'_>),
}

/// The blocks of one file, with the rule that each of a group follows.
type Rules = &'static [(&'static [StandardBlock], Rule)];

/// The rule of each block, in the order of [`StandardBlock::ALL`]. A block without one, or with two, does not compile.
static RULES: [&Rule; StandardBlock::ALL.len()] = ordered(&[
    analog::RULES,
    bistables::RULES,
    counters::RULES,
    edges::RULES,
    timers::RULES,
    register_machine::bits::RULES,
    register_machine::counters::RULES,
    register_machine::drum::RULES,
    register_machine::shifts::RULES,
    register_machine::timers::RULES,
]);

/// The rule of a block.
pub(super) fn rule(block: StandardBlock) -> &'static Rule {
    RULES[block as usize]
}

const fn ordered(files: &[Rules]) -> [&'static Rule; StandardBlock::ALL.len()] {
    let mut found: [Option<&Rule>; StandardBlock::ALL.len()] = [None; StandardBlock::ALL.len()];
    // A constant function has no `for`.
    let mut file = 0;
    while file < files.len() {
        let mut group = 0;
        while group < files[file].len() {
            let (blocks, rule) = &files[file][group];
            let mut block = 0;
            while block < blocks.len() {
                assert!(found[blocks[block] as usize].replace(rule).is_none(), "a block has two rules");
                block += 1;
            }
            group += 1;
        }
        file += 1;
    }
    let mut rules = [found[0].expect("a block has no rule"); StandardBlock::ALL.len()];
    let mut block = 0;
    while block < rules.len() {
        rules[block] = found[block].expect("a block has no rule");
        block += 1;
    }
    rules
}

/// One run of a block: what its rule computes with. Pins and states are named by their place in their list.
pub(super) struct Run<'a> {
    /// The instructions so far.
    pub(super) logic: &'a mut Builder,
    cells: &'a BlockCells,
    /// Which element of these it is.
    pick: Pick,
    inputs: &'a [Wired],
    /// What it runs under, if it does not always run: EN, and that no jump leaves it out.
    runs: Option<ValueId>,
}

/// What an input gets.
#[derive(Clone, Copy)]
pub(super) enum Wired {
    /// A value, which is this one wherever it is constant.
    Value(ValueId, Option<Value>),
    /// The variable that a reference names.
    Reference(Cell),
}

impl<'a> Run<'a> {
    /// A run of the block that lies there, with something at each of its inputs.
    pub(super) fn new(
        logic: &'a mut Builder,
        cells: &'a BlockCells,
        pick: Pick,
        inputs: &'a [Wired],
        runs: Option<ValueId>,
    ) -> Self {
        Self { logic, cells, pick, inputs, runs }
    }

    /// The value on an input that is no reference.
    pub(super) fn input(&self, pin: usize) -> ValueId {
        match self.inputs[pin] {
            Wired::Value(value, _) => value,
            Wired::Reference(_) => unreachable!("a rule knows which of its pins are references"),
        }
    }

    /// The value on an input that takes constants only.
    pub(super) fn constant(&self, pin: usize) -> Value {
        match self.inputs[pin] {
            Wired::Value(_, Some(value)) => value,
            _ => unreachable!("checking lets only constants be wired to such a pin"),
        }
    }

    /// The constant on an input if it is the same in every run of the instance: it is wired so at its only call, and nobody
    /// sets the pin otherwise.
    pub(super) fn only_constant(&self, pin: usize) -> Option<Value> {
        match self.inputs[pin] {
            Wired::Value(_, constant) if self.cells.inputs[pin].is_none() => constant,
            Wired::Value(..) | Wired::Reference(_) => None,
        }
    }

    /// Whether the instance is kept while the power is off.
    pub(super) fn is_retained(&self) -> bool {
        self.logic.layout().slot(self.cells.outputs[0].first).retain
    }

    /// What the variable holds that a reference names, or the element of its array that many places behind it; the type's
    /// default where there is none.
    pub(super) fn register(&mut self, pin: usize, behind: u32) -> ValueId {
        let cell = self.reference(pin, behind);
        cell.load(self.logic)
    }

    /// Sets that variable; where there is none, nothing.
    pub(super) fn set_register(&mut self, pin: usize, behind: u32, value: ValueId) {
        let cell = self.reference(pin, behind);
        cell.store(self.logic, self.runs, value);
    }

    fn reference(&mut self, pin: usize, behind: u32) -> Cell {
        match self.inputs[pin] {
            Wired::Reference(cell) => cell.behind(self.logic, behind),
            Wired::Value(..) => unreachable!("a rule knows which of its pins are references"),
        }
    }

    /// What an output holds.
    pub(super) fn output(&mut self, pin: usize) -> ValueId {
        self.get(self.cells.outputs[pin])
    }

    /// What a state holds.
    pub(super) fn state(&mut self, state: usize) -> ValueId {
        self.get(self.cells.states[state])
    }

    /// Sets an output.
    pub(super) fn set_output(&mut self, pin: usize, value: ValueId) {
        self.set(self.cells.outputs[pin], value);
    }

    /// Sets a state.
    pub(super) fn set_state(&mut self, state: usize, value: ValueId) {
        self.set(self.cells.states[state], value);
    }

    fn get(&mut self, cells: Cells) -> ValueId {
        Cell { cells, pick: self.pick }.load(self.logic)
    }

    fn set(&mut self, cells: Cells, value: ValueId) {
        Cell { cells, pick: self.pick }.store(self.logic, self.runs, value);
    }

    /// Whether a signal has become TRUE since the block last ran, by a BOOL state that follows it.
    fn rises(&mut self, signal: ValueId, state: usize) -> ValueId {
        let before = self.state(state);
        self.set_state(state, signal);
        let was_off = self.logic.not(before);
        self.logic.and(signal, was_off)
    }
}
