//! Checking: from the program as drawn to a program that runs, or to all that keeps it from running.
//!
//! Names, types, addresses and structure are resolved here and nowhere later. Checking must never stop at the
//! first error, and must never change what a program means. In order:
//!
//! 1. `declare`, `type_table`, `initial`: types, then the declared names of all units with their types and addresses, then their
//!    initial values.
//! 2. `collect`: what the rungs declare by use (instances, addresses, registers), and how deep they nest.
//! 3. `address`: which addresses share storage, and which overlap.
//! 4. `network`, `jump`, `block`, `pins`, `function_box`, `user_function`, `register`, `statement`, `place`, `expression`, `function`,
//!    `constant`, `fold`: the rungs, element by element.
//! 5. `usage`, `unit`, `size`: what only the whole program shows, such as unused names, double coils, calls in a circle, and what is
//!    too large once it is written out.
//! 6. `configuration`: tasks, program instances and the register machine.
//!
//! Rungs that are off are checked like the others, and what they name counts as used; but they are not in the
//! checked program, and their coils and calls do not collide with those of rungs that run.

mod address;
mod block;
mod collect;
mod configuration;
mod constant;
mod declare;
mod expression;
mod fold;
mod function;
mod function_box;
mod initial;
mod jump;
mod model;
mod network;
mod pins;
mod place;
mod register;
mod report;
mod scope;
mod size;
pub(crate) mod spelling;
mod statement;
mod type_table;
mod types;
mod unit;
mod usage;
mod user_function;

#[cfg(test)]
mod tests;

pub use collect::MAXIMUM_DEPTH;
pub use model::{
    ArrayType, ArrayTypeId, Branch, Call, Callee, Checked, Circuit, Dimension, Element, Expression, ExpressionKind,
    Field, Index, Initial, Input, NodeId, Output, PinId, Place, ProgramInstance, Rung, RungIndex, Statement, Step,
    Structure, StructureId, Task, TaskId, Type, Unit, UnitId, UnitKind, Variable, VariableId, Wire,
};
pub use report::MOST_REPORTED;
pub use type_table::MOST_ELEMENTS;
pub use unit::MOST_INLINED;

use std::collections::{HashMap, HashSet};

use crate::diagnostic::Diagnostic;
use crate::ladder::Program;

use collect::Direct;
use configuration::Resources;
use jump::Labels;
use report::Report;
use scope::Scope;
use type_table::TypeTable;
use unit::Signature;
use usage::Usage;

/// Checks a program: the checked program exactly where there is no error, and everything there is to say about it, in
/// order of place. It takes time in proportion to the program.
pub fn check(program: &Program) -> (Option<Checked>, Vec<Diagnostic>) {
    let mut checker = Checker {
        program,
        report: Report::default(),
        types: TypeTable::default(),
        units: Vec::new(),
        functions: unit::functions(program),
        first_rungs: unit::first_rungs(program),
        scope: Scope::default(),
        registers: Resources::default(),
        direct: Direct::default(),
        too_deep: HashSet::new(),
        loops: 0,
        turns: None,
        usage: Usage::default(),
        labels: Labels::default(),
    };
    checker.declare_variables();
    checker.check_overlaps();
    checker.check_register_count();
    let rungs: Vec<Vec<Rung>> = (0..program.units.len()).map(|unit| checker.check_unit(unit)).collect();
    checker.check_usage();
    let (tasks, programs) = checker.check_tasks();
    checker.check_sizes(&programs);
    checker.check_unused();
    checker.check_unused_units();
    let Checker { report, scope, types, units, .. } = checker;
    let (runs, diagnostics) = report.finish();
    let checked = runs.then(|| {
        let (variables, globals) = scope.into_variables();
        let units = program.units.iter().zip(units).zip(rungs);
        Checked {
            name: program.name.text.clone(),
            arrays: types.arrays,
            structures: types.structures,
            variables,
            globals,
            units: units.map(|((drawn, signature), rungs)| unit::checked(drawn, signature, rungs)).collect(),
            tasks,
            programs,
        }
    });
    (checked, diagnostics)
}

/// What checking knows so far. Its methods stand in the modules that the stages are named after.
struct Checker<'p> {
    program: &'p Program,
    report: Report,
    types: TypeTable,
    /// The units as their callers see them.
    units: Vec<Signature>,
    /// The functions among them, by their names.
    functions: HashMap<String, UnitId>,
    /// How many rungs stand before those of each unit.
    first_rungs: Vec<usize>,
    scope: Scope,
    registers: Resources,
    direct: Direct,
    /// Units and rungs that are nested too deeply to be checked.
    too_deep: HashSet<(usize, usize)>,
    /// The FORs around what is being checked.
    loops: u32,
    /// How often they repeat it; none where it does not run.
    turns: Option<u64>,
    usage: Usage,
    labels: Labels,
}
