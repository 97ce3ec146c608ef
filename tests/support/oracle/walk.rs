//! One scan: rungs from top to bottom, each depth first, left to right and top to bottom.
//!
//! Nothing is left out where there is no power, so that every scan comes to all elements in the same order. An
//! element's memory is therefore found by counting.

use rung::check::{Branch, Call, Circuit, Element, Wire};
use rung::elementary::{Elementary, Value};
use rung::ladder::{CoilKind, ContactKind};

use super::{Activity, Oracle};

/// Where a scan is.
struct Walk {
    now: i64,
    /// How many elements it came to.
    elements: usize,
    /// How many of them have a memory.
    memories: usize,
    /// The power on each node of the rung.
    nodes: Vec<bool>,
}

impl Oracle<'_> {
    /// Runs one scan at `now`, nanoseconds since the controller started.
    pub(crate) fn scan(&mut self, now: i64) {
        let checked = self.checked;
        let mut walk = Walk { now, elements: 0, memories: 0, nodes: Vec::new() };
        for rung in checked.rungs() {
            walk.nodes = vec![false; rung.nodes as usize];
            self.circuit(&mut walk, &rung.circuit, true);
        }
    }

    fn circuit(&mut self, walk: &mut Walk, circuit: &Circuit, left: bool) -> bool {
        let mut right = false;
        for branch in &circuit.branches {
            let power = self.branch(walk, branch, left);
            match branch.to {
                None => right |= power,
                Some(node) => walk.nodes[node.0 as usize] |= power,
            }
        }
        right
    }

    fn branch(&mut self, walk: &mut Walk, branch: &Branch, left: bool) -> bool {
        let start = branch.from.map_or(left, |node| walk.nodes[node.0 as usize]);
        branch.elements.iter().fold(start, |power, element| self.element(walk, element, power))
    }

    fn element(&mut self, walk: &mut Walk, element: &Element, left: bool) -> bool {
        let place = walk.elements;
        walk.elements += 1;
        if place == self.activities.len() {
            self.activities.push(Activity { kind: kind(element), toggles: 0, last: Vec::new() });
        }
        let right = match element {
            Element::Contact { kind, operand } => {
                let operand = self.value(operand).is_true();
                left & match kind {
                    ContactKind::Open => operand,
                    ContactKind::Closed => !operand,
                    ContactKind::Rising => self.rises(walk, operand),
                    ContactKind::Falling => self.rises(walk, !operand),
                }
            }
            Element::Coil { kind, target } => {
                let written = match kind {
                    CoilKind::Plain => Some(left),
                    CoilKind::Negated => Some(!left),
                    CoilKind::Set => left.then_some(true),
                    CoilKind::Reset => left.then_some(false),
                    CoilKind::Rising => Some(self.rises(walk, left)),
                    CoilKind::Falling => Some(self.rises(walk, !left)),
                };
                if let Some(value) = written {
                    self.write(*target, Value::bool(value));
                }
                left
            }
            Element::Condition(condition) => left & self.value(condition).is_true(),
            Element::Assignment { target, value } => {
                let value = self.value(value);
                if left {
                    self.write(*target, value);
                }
                left
            }
            Element::Call(call) => self.call(walk, call, left),
            Element::Parallel(circuit) => self.circuit(walk, circuit, left),
        };
        let seen = match element {
            Element::Call(call) => {
                let outputs = &self.instance(call.instance).outputs;
                let bools: Vec<Value> =
                    outputs.iter().copied().filter(|value| value.ty() == Elementary::Bool).collect();
                if bools.is_empty() { outputs.clone() } else { bools }
            }
            _ => vec![Value::bool(right)],
        };
        let activity = &mut self.activities[place];
        if !activity.last.is_empty() && activity.last != seen {
            activity.toggles += 1;
        }
        activity.last = seen;
        right
    }

    /// Q := CLK AND NOT M; M := CLK, with the memory of the contact or coil that the walk has come to. A falling
    /// edge is this of NOT CLK.
    fn rises(&mut self, walk: &mut Walk, clock: bool) -> bool {
        let place = walk.memories;
        walk.memories += 1;
        if place == self.memories.len() {
            self.memories.push(false);
        }
        clock & !std::mem::replace(&mut self.memories[place], clock)
    }

    fn call(&mut self, walk: &mut Walk, call: &Call, left: bool) -> bool {
        if let Some(input) = call.power_input {
            self.instance(call.instance).inputs[input] = Value::bool(left);
        }
        for input in &call.inputs {
            let value = match &input.wire {
                Wire::Value(expression) => self.value(expression),
                Wire::Circuit(circuit) => Value::bool(self.circuit(walk, circuit, true)),
            };
            self.instance(call.instance).inputs[input.pin] = value;
        }
        let enabled = call.power_input.is_some() || left;
        if enabled {
            self.instance(call.instance).execute(walk.now);
            for (output, target) in &call.outputs {
                let value = self.instance(call.instance).outputs[*output];
                self.write(*target, value);
            }
        }
        call.power_output.map_or(enabled, |output| self.instance(call.instance).outputs[output].is_true())
    }
}

/// What a coverage table calls an element.
fn kind(element: &Element) -> String {
    let kind = match element {
        Element::Contact { kind: ContactKind::Open, .. } => "contact a",
        Element::Contact { kind: ContactKind::Closed, .. } => "contact /a",
        Element::Contact { kind: ContactKind::Rising, .. } => "contact ^a",
        Element::Contact { kind: ContactKind::Falling, .. } => "contact ^/a",
        Element::Coil { kind: CoilKind::Plain, .. } => "coil (a)",
        Element::Coil { kind: CoilKind::Negated, .. } => "coil (/a)",
        Element::Coil { kind: CoilKind::Set, .. } => "coil (S a)",
        Element::Coil { kind: CoilKind::Reset, .. } => "coil (R a)",
        Element::Coil { kind: CoilKind::Rising, .. } => "coil (P a)",
        Element::Coil { kind: CoilKind::Falling, .. } => "coil (N a)",
        Element::Call(call) if call.power_input.is_none() => return format!("{} with EN", call.block.name()),
        Element::Call(call) => call.block.name(),
        Element::Condition(_) => "condition {a}",
        Element::Assignment { .. } => "assignment {a := b}",
        Element::Parallel(_) => "parallel [a | b]",
    };
    kind.to_owned()
}
