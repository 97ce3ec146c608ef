//! Trees of AND, OR and NOT over BOOLs are regrouped so that inversions are few: all that must be FALSE is joined
//! first and inverted once.
//!
//! `a AND NOT b AND c AND NOT d` becomes `(a AND NOT (b OR d)) AND c`, one instruction a contact where the target
//! can join with a value in memory.

use super::rewrite::{Output, rewrite};
use crate::elementary::Elementary;
use crate::logic::{Binary, Op, Program, Unary, ValueId};

/// A tree: what is joined by its operation, as it is or inverted.
#[derive(Default)]
struct Leaves {
    straight: Vec<ValueId>,
    inverted: Vec<ValueId>,
}

/// See the module.
pub(super) fn gather(program: Program) -> Program {
    let mut uses = vec![0u32; program.instructions.len()];
    for operand in program.instructions.iter().flat_map(|instruction| instruction.op.operands()) {
        uses[operand.index()] += 1;
    }
    // From the last instruction on, so that a tree is met at its root; what lies within a tree is no root.
    let mut trees: Vec<Option<Leaves>> = Vec::new();
    trees.resize_with(program.instructions.len(), || None);
    let mut within = vec![false; program.instructions.len()];
    for section in (0..program.sections.len()).rev() {
        let range = program.section_range(section);
        for index in range.clone().rev() {
            if within[index] || program.instructions[index].ty != Elementary::Bool {
                continue;
            }
            if let Op::Binary(op @ (Binary::And | Binary::Or), a, b) = program.instructions[index].op {
                let leaves = leaves(&program, range.start, op, [a, b], &uses, &mut within);
                if !leaves.inverted.is_empty() {
                    trees[index] = Some(leaves);
                }
            }
        }
    }
    // What a tree consists of stands before its root, and so has a copy by then.
    let mut copies: Vec<Option<ValueId>> = vec![None; program.instructions.len()];
    rewrite(program, |output, place, instruction| {
        let copy = match (trees[place.index].take(), instruction.op) {
            (Some(tree), Op::Binary(op, ..)) => {
                let copied = |values: Vec<ValueId>| values.into_iter().filter_map(|v| copies[v.index()]).collect();
                Some(build(output, op, copied(tree.straight), copied(tree.inverted)))
            }
            _ => output.keep(instruction),
        };
        copies[place.index] = copy;
        copy
    })
}

/// The leaves below a root, in the order of the tree. Only what has no other use and stands in this section is taken apart.
fn leaves(
    program: &Program,
    section_start: usize,
    op: Binary,
    [a, b]: [ValueId; 2],
    uses: &[u32],
    within: &mut [bool],
) -> Leaves {
    let mut leaves = Leaves::default();
    let mut open = vec![(b, false), (a, false)];
    while let Some((value, inverted)) = open.pop() {
        let index = value.index();
        match program.instructions[index].op {
            Op::Unary(Unary::Not, inner) if index >= section_start => open.push((inner, !inverted)),
            // NOT (x OR y) is NOT x AND NOT y, and the other way round.
            Op::Binary(inner @ (Binary::And | Binary::Or), x, y)
                if uses[index] == 1 && index >= section_start && (inner == op) != inverted =>
            {
                within[index] = true;
                open.push((y, inverted));
                open.push((x, inverted));
            }
            _ if inverted => leaves.inverted.push(value),
            _ => leaves.straight.push(value),
        }
    }
    leaves
}

fn build(output: &mut Output, op: Binary, mut straight: Vec<ValueId>, inverted: Vec<ValueId>) -> ValueId {
    let opposite = if op == Binary::And { Binary::Or } else { Binary::And };
    let inverted = join(output, opposite, inverted).map(|value| output.not(value));
    if let (Binary::And, Some(inverted)) = (op, inverted) {
        // A load beside the inversion can be part of one instruction with it.
        let beside = straight.iter().position(|value| matches!(output.op(*value), Op::Load(_))).unwrap_or(0);
        if straight.is_empty() {
            return inverted;
        }
        straight.swap(0, beside);
        straight.insert(1, inverted);
    } else {
        straight.extend(inverted);
    }
    join(output, op, straight).unwrap_or_else(|| output.constant(Elementary::Bool, u64::from(op == Binary::And)))
}

fn join(output: &mut Output, op: Binary, values: Vec<ValueId>) -> Option<ValueId> {
    values.into_iter().reduce(|a, b| output.emit(Elementary::Bool, Op::Binary(op, a, b)))
}
