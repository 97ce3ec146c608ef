//! The optimiser: an ordered list of small passes over logic.
use crate::logic::Program;

/// One pass.
pub struct Pass {
    /// Its name, as `--after` takes it.
    pub name: &'static str,
    /// What it does.
    pub run: fn(Program) -> Program,
}

/// The passes, in order.
pub const PASSES: &[Pass] = &[];

/// Runs every pass.
pub fn optimise(program: Program) -> Program {
    PASSES.iter().fold(program, |program, pass| (pass.run)(program))
}
