//! How much there is of a checked program.

use crate::check::{Branch, Checked, Circuit, Element, Wire};

/// Elements by kind.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub(super) struct Counts {
    pub contacts: usize,
    pub coils: usize,
    pub blocks: usize,
    /// Comparisons and assignments in braces.
    pub boxes: usize,
}

pub(super) fn count(checked: &Checked) -> Counts {
    let mut counts = Counts::default();
    // With a list instead of recursion, however deep circuits nest.
    let mut circuits: Vec<&Circuit> = checked.rungs().iter().map(|rung| &rung.circuit).collect();
    while let Some(circuit) = circuits.pop() {
        for Branch { elements, .. } in &circuit.branches {
            for element in elements {
                match element {
                    Element::Contact { .. } => counts.contacts += 1,
                    Element::Coil { .. } => counts.coils += 1,
                    Element::Condition(_) | Element::Assignment { .. } => counts.boxes += 1,
                    Element::Parallel(circuit) => circuits.push(circuit),
                    Element::Call(call) => {
                        counts.blocks += 1;
                        circuits.extend(call.inputs.iter().filter_map(|input| match &input.wire {
                            Wire::Circuit(circuit) => Some(circuit),
                            Wire::Value(_) => None,
                        }));
                    }
                }
            }
        }
    }
    counts
}
