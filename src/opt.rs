//! The optimiser: an ordered list of small passes over logic.
//!
//! A pass is a pure function from a verified program to a verified one that leaves the same image after every scan,
//! with the same layout, tasks and origins. Only the first two change where sections and chunks end. None may ever move a
//! value out of its chunk, or look beyond one: behind those two, parts of a program are changed on all cores.
//!
//! In a debug build every pass is [checked](check) against the program that it was given.

mod algebra;
pub mod check;
mod chunk;
mod cut;
mod fold;
mod forward;
mod narrow;
mod parts;
pub mod prove;
mod reduce;
mod rewrite;
mod share;
mod simplify;
mod sweep;
#[cfg(test)]
mod tests;

use crate::logic::{Program, verify};

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
    Pass { name: "cut", run: cut::cut },
    Pass { name: "chunk", run: chunk::chunk },
    Pass { name: "fold", run: fold::fold },
    Pass { name: "forward", run: forward::forward },
    Pass { name: "simplify", run: simplify::simplify },
    Pass { name: "narrow", run: narrow::narrow },
    Pass { name: "reduce", run: reduce::reduce },
    Pass { name: "share", run: share::share },
    Pass { name: "algebra", run: algebra::algebra },
    Pass { name: "sweep", run: sweep::sweep },
];

/// How many passes, the first ones, look at all of a program.
const OF_ALL: usize = 2;

/// Runs every pass.
pub fn optimise(program: Program) -> Program {
    optimise_with(program, |_| true)
}

/// Runs the passes that are wanted, so that one can see what another is good for.
///
/// # Panics
/// In a debug build, when a pass changed what the program computes.
pub fn optimise_with(program: Program, wanted: impl Fn(&Pass) -> bool + Sync) -> Program {
    let run = |passes: &[Pass], program: Program| passes.iter().filter(|pass| wanted(pass)).fold(program, checked);
    let (whole, of_chunks) = PASSES.split_at(OF_ALL);
    let program = run(whole, program);
    parts::each(program, |part| run(of_chunks, part))
}

/// Runs a pass, and in a debug build checks what it did.
fn checked(program: Program, pass: &Pass) -> Program {
    if !cfg!(debug_assertions) || program.instructions.len() > CHECKED {
        return (pass.run)(program);
    }
    let after = (pass.run)(program.clone());
    assert_eq!(verify(&after), Ok(()), "the pass `{}` breaks what it is given", pass.name);
    if let Some(difference) = check::difference(&program, &after, IMAGES) {
        panic!("the pass `{}` changes {difference}", pass.name);
    }
    after
}

/// Instructions up to which a debug build checks a pass, and on how many images.
const CHECKED: usize = 20_000;
const IMAGES: u64 = 2;
