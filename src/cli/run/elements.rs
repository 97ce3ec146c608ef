//! The elements of a checked program, however they nest.

use crate::check::{Checked, Circuit, Element, Wire};

/// Elements by kind.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub(super) struct Counts {
    pub contacts: usize,
    pub coils: usize,
    pub blocks: usize,
    /// Comparisons and assignments in braces.
    pub boxes: usize,
}

/// Counts the elements of a program.
pub(super) fn count(checked: &Checked) -> Counts {
    let mut counts = Counts::default();
    visit(checked, |element| match element {
        Element::Contact { .. } => counts.contacts += 1,
        Element::Coil { .. } => counts.coils += 1,
        Element::Condition(_) | Element::Assignment { .. } | Element::Statements(_) => counts.boxes += 1,
        Element::Call(_) => counts.blocks += 1,
        Element::Parallel(_) | Element::Jump(_) | Element::Return => {}
    });
    counts
}

/// Shows each element, in no particular order. With a list instead of recursion, however deep circuits nest.
pub(super) fn visit<'p>(checked: &'p Checked, mut see: impl FnMut(&'p Element)) {
    let mut circuits: Vec<&Circuit> =
        checked.units().iter().flat_map(|unit| &unit.rungs).map(|rung| &rung.circuit).collect();
    while let Some(circuit) = circuits.pop() {
        for element in circuit.branches.iter().flat_map(|branch| &branch.elements) {
            see(element);
            match element {
                Element::Parallel(circuit) => circuits.push(circuit),
                Element::Call(call) => circuits.extend(call.inputs.iter().filter_map(|input| match &input.wire {
                    Wire::Circuit(circuit) => Some(circuit),
                    Wire::Value(_) => None,
                })),
                Element::Contact { .. }
                | Element::Coil { .. }
                | Element::Condition(_)
                | Element::Assignment { .. }
                | Element::Statements(_)
                | Element::Jump(_)
                | Element::Return => {}
            }
        }
    }
}
