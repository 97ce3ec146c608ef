//! One run of a unit: rungs from top to bottom, each depth first, left to right and top to bottom.
//!
//! Nothing is left out where there is no power. What a jump leaves out the walk does not come to at all.

use rung::check::{Branch, Circuit, Element, UnitId};
use rung::elementary::Value;
use rung::ladder::{CoilKind, ContactKind, VariableClass};

use super::Oracle;
use super::place::Attempt;
use super::storage::Frame;

/// Where a run is.
pub(super) struct Walk {
    pub(super) frame: Frame,
    /// The power on each node of the rung.
    nodes: Vec<bool>,
}

/// Why the walk leaves everything that it is in.
pub(super) enum Leave {
    /// A jump: it goes on at that rung, which may be one more than the last.
    To(usize),
    /// EXIT: it goes on behind the innermost FOR.
    Loop,
}

impl Leave {
    /// What RETURN does: nothing else of the unit runs.
    pub(super) const UNIT: Self = Self::To(usize::MAX);
}

impl Oracle<'_> {
    /// Runs a unit once on the variables of an instance.
    pub(super) fn run(&mut self, unit: UnitId, frame: &Frame) {
        let unit = self.checked.unit(unit);
        for id in unit.variables() {
            let variable = self.checked.variable(id);
            if variable.class == VariableClass::Temporary {
                let fresh = self.storage(variable.ty, &variable.initial);
                frame.get(id).expect("it is one of the unit's variables").copy(&fresh);
            }
        }
        let mut walk = Walk { frame: frame.clone(), nodes: Vec::new() };
        let mut place = 0;
        while let Some(rung) = unit.rungs.get(place) {
            walk.nodes = vec![false; rung.nodes as usize];
            place = match self.circuit(&mut walk, &rung.circuit, true) {
                Ok(_) => place + 1,
                Err(Leave::To(rung)) => rung,
                Err(Leave::Loop) => panic!("checking lets EXIT stand in a FOR only"),
            };
        }
    }

    pub(super) fn circuit(&mut self, walk: &mut Walk, circuit: &Circuit, left: bool) -> Result<bool, Leave> {
        let mut right = false;
        for branch in &circuit.branches {
            let power = self.branch(walk, branch, left)?;
            match branch.to {
                None => right |= power,
                Some(node) => walk.nodes[node.index()] |= power,
            }
        }
        Ok(right)
    }

    fn branch(&mut self, walk: &mut Walk, branch: &Branch, left: bool) -> Result<bool, Leave> {
        let start = branch.from.map_or(left, |node| walk.nodes[node.index()]);
        branch.elements.iter().try_fold(start, |power, element| self.element(walk, element, power))
    }

    fn element(&mut self, walk: &mut Walk, element: &Element, left: bool) -> Result<bool, Leave> {
        let mut attempt = Attempt::new(left);
        let right = match element {
            Element::Contact { kind, operand } => {
                let operand = self.value(&walk.frame, operand, &mut attempt).is_true();
                left & match kind {
                    ContactKind::Open => operand,
                    ContactKind::Closed => !operand,
                    ContactKind::Rising => self.rises(walk, element, operand),
                    ContactKind::Falling => self.rises(walk, element, !operand),
                }
            }
            Element::Coil { kind, target } => {
                let written = match kind {
                    CoilKind::Plain => Some(left),
                    CoilKind::Negated => Some(!left),
                    CoilKind::Set => left.then_some(true),
                    CoilKind::Reset => left.then_some(false),
                    CoilKind::Rising => Some(self.rises(walk, element, left)),
                    CoilKind::Falling => Some(self.rises(walk, element, !left)),
                };
                let target = self.locate(&walk.frame, target, &mut attempt);
                if let Some(value) = written {
                    self.put(&target, Value::bool(value));
                }
                left
            }
            Element::Condition(condition) => {
                let holds = self.value(&walk.frame, condition, &mut attempt).is_true();
                left & holds & !attempt.failed
            }
            Element::Assignment { target, value } => {
                let value = self.value(&walk.frame, value, &mut attempt);
                let target = self.locate(&walk.frame, target, &mut attempt);
                if left {
                    self.put(&target, value);
                }
                left & !attempt.failed
            }
            Element::Statements(statements) => {
                if left {
                    self.statements(walk, statements, &mut attempt)?;
                }
                left & !attempt.failed
            }
            Element::Call(call) => return Ok(self.call(walk, call, left)?.right),
            Element::Parallel(circuit) => self.circuit(walk, circuit, left)?,
            Element::Jump(_) | Element::Return => left,
        };
        self.activities.saw(walk.frame.id, element, kind(element), vec![Value::bool(right)]);
        match element {
            Element::Jump(target) if left => Err(Leave::To(target.index())),
            Element::Return if left => Err(Leave::UNIT),
            Element::Jump(_) | Element::Return => Ok(false),
            _ => Ok(right),
        }
    }

    /// Q := CLK AND NOT M; M := CLK, with the memory of a contact or coil, FALSE at first; each instance has one of its own.
    /// A falling edge is this of NOT CLK.
    fn rises(&mut self, walk: &Walk, element: &Element, clock: bool) -> bool {
        clock & !self.memories.insert((walk.frame.id, element), clock).unwrap_or(false)
    }
}

/// What a coverage table calls an element that is no call.
fn kind(element: &Element) -> &'static str {
    match element {
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
        Element::Condition(_) => "condition {a}",
        Element::Assignment { .. } => "assignment {a := b}",
        Element::Statements(_) => "statements {a; b}",
        Element::Call(_) => "call",
        Element::Parallel(_) => "parallel [a | b]",
        Element::Jump(_) => "jump >> r",
        Element::Return => "jump >> return",
    }
}
