//! An edit of one rung, for measuring what it takes.

use std::sync::Arc;

use rung::logic::{Binary, Layout, Op, Program};

/// The program with a layout of its own, as one has that was lowered anew after an edit.
pub(crate) fn lowered_anew(program: &Program) -> Program {
    Program { layout: Arc::new(Layout::clone(&program.layout)), ..program.clone() }
}

/// The same program with an AND of a section made an OR.
pub(crate) fn edited_at(mut program: Program, section: usize) -> Program {
    let range = program.section_range(section);
    let is_and = |op: &Op| matches!(op, Op::Binary(Binary::And, ..));
    let and = program.instructions[range].iter_mut().find(|instruction| is_and(&instruction.op));
    let and = and.expect("contacts in series");
    if let Op::Binary(_, a, b) = and.op {
        and.op = Op::Binary(Binary::Or, a, b);
    }
    program
}
