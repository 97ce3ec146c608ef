//! Checking: from the program as drawn to a program that runs, or to all that keeps it from running.
//!
//! Names, types, addresses and structure are resolved here and nowhere later. Checking must never stop at the
//! first error, and must never change what a program means. In order:
//!
//! 1. `declare`: the declared names, their types and addresses, then their initial values.
//! 2. `collect`: what the rungs declare by use (instances, addresses), and how deep they nest.
//! 3. `address`: which addresses share storage, and which overlap.
//! 4. `network`, `jump`, `block`, `place`, `expression`, `function`, `constant`, `fold`: the rungs, element by element.
//! 5. `usage`: what only the whole program shows, such as unused names and double coils.
//!
//! Rungs that are off are checked like the others, and what they name counts as used; but they are not in the
//! checked program, and their coils and calls do not collide with those of rungs that run.

mod address;
mod block;
mod collect;
mod constant;
mod declare;
mod expression;
mod fold;
mod function;
mod jump;
mod model;
mod network;
mod place;
mod report;
mod scope;
pub(crate) mod spelling;
mod types;
mod usage;

#[cfg(test)]
mod tests;

pub use collect::MAXIMUM_DEPTH;
pub use model::{
    Branch, Call, Checked, Circuit, Element, Expression, ExpressionKind, Input, NodeId, PinId, Place, Rung, RungIndex,
    Type, Variable, VariableId, Wire,
};
pub use report::MOST_REPORTED;

use crate::diagnostic::Diagnostic;
use crate::ladder::Program;

use jump::Labels;
use report::Report;
use scope::Scope;
use usage::Usage;

/// Checks a program: the checked program exactly where there is no error, and everything there is to say about it, in
/// order of place. It takes time in proportion to the program.
pub fn check(program: &Program) -> (Option<Checked>, Vec<Diagnostic>) {
    let mut checker = Checker {
        program,
        report: Report::default(),
        scope: Scope::default(),
        usage: Usage::default(),
        labels: Labels::default(),
    };
    checker.declare_variables();
    let too_deep = checker.collect_uses();
    checker.check_overlaps();
    let rungs = checker.check_rungs(&too_deep);
    checker.check_usage(too_deep.is_empty());
    let Checker { report, scope, .. } = checker;
    let (runs, diagnostics) = report.finish();
    let checked = runs.then(|| Checked { name: program.name.text.clone(), variables: scope.into_variables(), rungs });
    (checked, diagnostics)
}

/// What checking knows so far. Its methods stand in the modules that the stages are named after.
struct Checker<'p> {
    program: &'p Program,
    report: Report,
    scope: Scope,
    usage: Usage,
    labels: Labels,
}
