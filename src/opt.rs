//! The optimiser: an ordered list of small passes over logic.
//!
//! A pass is a pure function from a verified program to a verified one that leaves the same image after every scan,
//! with the same layout, sections, origins and chunks. It must never move a value out of its chunk.

mod fold;
mod forward;
mod gather;
mod rewrite;
mod simplify;
mod sweep;
#[cfg(test)]
mod tests;

use crate::logic::Program;

/// One pass.
#[derive(Clone, Copy, Debug)]
pub struct Pass {
    /// Its name, as `--after` takes it.
    pub name: &'static str,
    /// What it does.
    pub run: fn(Program) -> Program,
}

/// The passes, in order.
pub const PASSES: &[Pass] = &[
    Pass { name: "fold", run: fold::fold },
    Pass { name: "forward", run: forward::forward },
    Pass { name: "simplify", run: simplify::simplify },
    Pass { name: "gather", run: gather::gather },
    Pass { name: "sweep", run: sweep::sweep },
];

/// Runs every pass.
pub fn optimise(program: Program) -> Program {
    PASSES.iter().fold(program, |program, pass| (pass.run)(program))
}
