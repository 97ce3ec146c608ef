//! One scan: rungs from top to bottom, each depth first, left to right and top to bottom.
//!
//! Nothing is left out where there is no power. What a jump leaves out the walk does not come to at all.

use rung::check::{Branch, Call, Circuit, Element, Wire};
use rung::elementary::{Elementary, Value};
use rung::ladder::{CoilKind, ContactKind};

use super::{Activity, Oracle};

/// Where a scan is.
struct Walk {
    now: i64,
    /// The power on each node of the rung.
    nodes: Vec<bool>,
}

/// A jump that was taken: the walk leaves everything that it is in and goes on there.
struct Jumped {
    /// A rung, or one more than the last.
    to: usize,
}

impl Oracle<'_> {
    /// Runs one scan at `now`, nanoseconds since the controller started.
    pub(crate) fn scan(&mut self, now: i64) {
        let checked = self.checked;
        let mut walk = Walk { now, nodes: Vec::new() };
        let mut place = 0;
        while let Some(rung) = checked.rungs().get(place) {
            walk.nodes = vec![false; rung.nodes as usize];
            place = match self.circuit(&mut walk, &rung.circuit, true) {
                Ok(_) => place + 1,
                Err(Jumped { to }) => to,
            };
        }
    }

    fn circuit(&mut self, walk: &mut Walk, circuit: &Circuit, left: bool) -> Result<bool, Jumped> {
        let mut right = false;
        for branch in &circuit.branches {
            let power = self.branch(walk, branch, left)?;
            match branch.to {
                None => right |= power,
                Some(node) => walk.nodes[node.0 as usize] |= power,
            }
        }
        Ok(right)
    }

    fn branch(&mut self, walk: &mut Walk, branch: &Branch, left: bool) -> Result<bool, Jumped> {
        let start = branch.from.map_or(left, |node| walk.nodes[node.0 as usize]);
        branch.elements.iter().try_fold(start, |power, element| self.element(walk, element, power))
    }

    fn element(&mut self, walk: &mut Walk, element: &Element, left: bool) -> Result<bool, Jumped> {
        let right = match element {
            Element::Contact { kind, operand } => {
                let operand = self.value(operand).is_true();
                left & match kind {
                    ContactKind::Open => operand,
                    ContactKind::Closed => !operand,
                    ContactKind::Rising => self.rises(element, operand),
                    ContactKind::Falling => self.rises(element, !operand),
                }
            }
            Element::Coil { kind, target } => {
                let written = match kind {
                    CoilKind::Plain => Some(left),
                    CoilKind::Negated => Some(!left),
                    CoilKind::Set => left.then_some(true),
                    CoilKind::Reset => left.then_some(false),
                    CoilKind::Rising => Some(self.rises(element, left)),
                    CoilKind::Falling => Some(self.rises(element, !left)),
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
            Element::Call(call) => self.call(walk, call, left)?,
            Element::Parallel(circuit) => self.circuit(walk, circuit, left)?,
            Element::Jump(_) | Element::Return => left,
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
        self.saw(element, seen);
        match element {
            Element::Jump(target) if left => Err(Jumped { to: target.index() }),
            Element::Return if left => Err(Jumped { to: self.checked.rungs().len() }),
            Element::Jump(_) | Element::Return => Ok(false),
            _ => Ok(right),
        }
    }

    fn saw(&mut self, element: &Element, seen: Vec<Value>) {
        let next = self.activities.len();
        let place = *self.places_of_activities.entry(element).or_insert(next);
        if place == next {
            self.activities.push(Activity { kind: kind(element), toggles: 0, last: Vec::new() });
        }
        let activity = &mut self.activities[place];
        if !activity.last.is_empty() && activity.last != seen {
            activity.toggles += 1;
        }
        activity.last = seen;
    }

    /// Q := CLK AND NOT M; M := CLK, with the memory of a contact or coil, FALSE at first. A falling edge is this of
    /// NOT CLK.
    fn rises(&mut self, element: &Element, clock: bool) -> bool {
        clock & !self.memories.insert(element, clock).unwrap_or(false)
    }

    fn call(&mut self, walk: &mut Walk, call: &Call, left: bool) -> Result<bool, Jumped> {
        if let Some(input) = call.power_input {
            self.instance(call.instance).inputs[input] = Value::bool(left);
        }
        for input in &call.inputs {
            let value = match &input.wire {
                Wire::Value(expression) => self.value(expression),
                Wire::Circuit(circuit) => Value::bool(self.circuit(walk, circuit, true)?),
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
        Ok(call.power_output.map_or(enabled, |output| self.instance(call.instance).outputs[output].is_true()))
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
        Element::Jump(_) => "jump >> r",
        Element::Return => "jump >> return",
    };
    kind.to_owned()
}
