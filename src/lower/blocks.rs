//! Function blocks: each block's rule, written once over its pins and states.
//!
//! A rule computes as if the block always ran. That a block whose EN is FALSE, or that a jump leaves out, keeps its
//! outputs and states is added here, so that no rule needs to know.

mod analog;
mod bistables;
mod counters;
mod edges;
mod timers;

use super::Lowering;
use super::slots::InstanceSlots;
use crate::check::{Call, Callee, Output, Wire};
use crate::elementary::Elementary;
use crate::ladder::library::StandardBlock;
use crate::logic::{Builder, SlotId, ValueId};

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
static RULES: [&Rule; StandardBlock::ALL.len()] =
    ordered(&[analog::RULES, bistables::RULES, counters::RULES, edges::RULES, timers::RULES]);

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
    slots: &'a InstanceSlots,
    inputs: Vec<ValueId>,
    /// What it runs under, if it does not always run: EN, and that no jump leaves it out.
    runs: Option<ValueId>,
}

impl Run<'_> {
    /// The value on an input.
    pub(super) fn input(&self, pin: usize) -> ValueId {
        self.inputs[pin]
    }

    /// What an output holds.
    pub(super) fn output(&mut self, pin: usize) -> ValueId {
        self.logic.load(self.slots.outputs[pin])
    }

    /// What a state holds.
    pub(super) fn state(&mut self, state: usize) -> ValueId {
        self.logic.load(self.slots.states[state])
    }

    /// Sets an output.
    pub(super) fn set_output(&mut self, pin: usize, value: ValueId) {
        self.set(self.slots.outputs[pin], value);
    }

    /// Sets a state.
    pub(super) fn set_state(&mut self, state: usize, value: ValueId) {
        self.set(self.slots.states[state], value);
    }

    fn set(&mut self, slot: SlotId, value: ValueId) {
        self.logic.store_if(self.runs, slot, value);
    }

    /// Whether a signal has become TRUE since the block last ran, by a BOOL state that follows it.
    fn rises(&mut self, signal: ValueId, state: usize) -> ValueId {
        let before = self.state(state);
        self.set_state(state, signal);
        let was_off = self.logic.not(before);
        self.logic.and(signal, was_off)
    }
}

impl Lowering<'_> {
    /// A call; gives the power on its right.
    pub(super) fn call(&mut self, call: &Call, left: ValueId, nodes: &mut Vec<Option<ValueId>>) -> ValueId {
        let Callee::Standard(block, instance) = &call.callee else { return left };
        let slots = self.slots.instance(instance.variable);
        let mut wired = vec![None; slots.inputs.len()];
        let mut wire = |lowering: &mut Self, pin: usize, value: ValueId| {
            wired[pin] = Some(value);
            if let Some(slot) = slots.inputs[pin] {
                lowering.store(slot, value);
            }
        };
        if let Some(pin) = call.power_input {
            wire(self, pin, left);
        }
        for input in &call.inputs {
            let value = match &input.wire {
                Wire::Value(expression) => self.expression(expression),
                Wire::Circuit(circuit) => {
                    let rail = self.logic.bool(true);
                    self.circuit(circuit, rail, nodes)
                }
            };
            wire(self, input.pin, value);
        }
        let inputs = wired.iter().zip(&slots.inputs).map(|(wired, slot)| match (wired, slot) {
            (_, Some(slot)) => self.logic.load(*slot),
            (Some(value), None) => *value,
            (None, None) => unreachable!("an input that a call leaves unwired has a slot"),
        });
        let inputs = inputs.collect();
        let enable = if call.power_input.is_none() { Some(left) } else { None };
        let runs = self.unless_jumped(enable);
        (rule(*block).run)(&mut Run { logic: &mut self.logic, slots, inputs, runs });
        for (pin, target) in &call.outputs {
            let value = self.logic.load(slots.outputs[output(*pin)]);
            match enable {
                None => self.write(target, value),
                Some(enable) => self.write_if(enable, target, value),
            }
        }
        match call.power_output {
            Output::Pin(pin) => self.logic.load(slots.outputs[pin]),
            // ENO, which is TRUE for a block that always runs.
            Output::Eno => enable.unwrap_or_else(|| self.logic.bool(true)),
        }
    }
}

fn output(output: Output) -> usize {
    if let Output::Pin(pin) = output { pin } else { 0 }
}
