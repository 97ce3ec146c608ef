//! Random jumps, put into the rungs once all are there: a jump leads to a rung that comes later.

use rung::ladder::{Circuit, ElementKind, Name};

use super::Generator;
use crate::support::drawing;

/// How far most jumps lead, in rungs: longer ones would leave out most of a program.
const REACH: usize = 4;

impl Generator {
    /// Puts jumps into some rungs, each in a branch of its own among those of any circuit but one at a pin.
    pub(super) fn add_jumps(&mut self) {
        if self.dice.percent(50) {
            return;
        }
        let names: Vec<Option<Name>> = self.unit.rungs.iter().map(|rung| rung.name.clone()).collect();
        for place in 0..names.len() {
            if !self.dice.percent(25) {
                continue;
            }
            let end = if self.dice.percent(80) { names.len().min(place + 1 + REACH) } else { names.len() };
            let targets: Vec<&Name> = names[place + 1..end].iter().flatten().collect();
            let kind = if targets.is_empty() || self.dice.percent(10) {
                ElementKind::Return
            } else {
                ElementKind::Jump { target: (*self.dice.pick(&targets)).clone() }
            };
            // A signal that is on half of the time would leave out too much.
            let elements = vec![self.contact(), self.contact(), drawing::element(kind)];
            let mut rung = std::mem::replace(&mut self.unit.rungs[place], drawing::rung(Vec::new()));
            let circuit = self.some_circuit(&mut rung.circuit);
            let among = self.dice.below(circuit.branches.len() + 1);
            circuit.branches.insert(among, drawing::branch(elements));
            self.unit.rungs[place] = rung;
        }
    }

    /// The circuit itself or one of the parallels in it.
    fn some_circuit<'c>(&mut self, circuit: &'c mut Circuit) -> &'c mut Circuit {
        let is_parallel = |kind: &ElementKind| matches!(kind, ElementKind::Parallel(_));
        let elements = || circuit.branches.iter().flat_map(|branch| &branch.elements);
        let parallels = elements().filter(|element| is_parallel(&element.kind)).count();
        if parallels == 0 || self.dice.percent(40) {
            return circuit;
        }
        let chosen = self.dice.below(parallels);
        let elements = circuit.branches.iter_mut().flat_map(|branch| &mut branch.elements);
        let mut inner = elements.filter_map(|element| match &mut element.kind {
            ElementKind::Parallel(circuit) => Some(circuit),
            _ => None,
        });
        let inner = inner.nth(chosen).expect("as many as were counted");
        self.some_circuit(inner)
    }
}
