//! The optimiser: an ordered list of small passes over logic.
//!
//! A pass is a pure function from a verified program to a verified one that leaves the same image after every scan,
//! with the same layout, tasks and origins. Only those that look at all of it change where sections and chunks end. None may
//! ever move a value out of its chunk, and the others look at no more than one, so that parts of a program are changed on all cores.
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
    /// Whether it looks at all of a program: others look at no more than a chunk at a time.
    pub of_all: bool,
}

impl Pass {
    const fn of_all(name: &'static str, run: fn(Program) -> Program) -> Self {
        Self { name, run, of_all: true }
    }

    const fn of_chunks(name: &'static str, run: fn(Program) -> Program) -> Self {
        Self { name, run, of_all: false }
    }
}

/// The passes, in order.
pub const PASSES: &[Pass] = &[
    Pass::of_all("cut", cut::cut),
    Pass::of_all("chunk", chunk::chunk),
    Pass::of_chunks("fold", fold::fold),
    Pass::of_chunks("forward", forward::forward),
    Pass::of_chunks("simplify", simplify::simplify),
    Pass::of_chunks("narrow", narrow::narrow),
    Pass::of_chunks("reduce", reduce::reduce),
    Pass::of_chunks("share", share::share),
    Pass::of_chunks("algebra", algebra::algebra),
    Pass::of_chunks("sweep", sweep::sweep),
];

/// Runs every pass.
pub fn optimise(program: Program) -> Program {
    optimise_by(program, PASSES)
}

/// Runs the passes that are wanted, so that one can see what another is good for.
///
/// # Panics
/// As [`optimise_by`].
pub fn optimise_with(program: Program, wanted: impl Fn(&Pass) -> bool) -> Program {
    let passes: Vec<Pass> = PASSES.iter().copied().filter(wanted).collect();
    optimise_by(program, &passes)
}

/// Runs passes in order, on all cores where they look at a chunk at a time.
///
/// # Panics
/// In a debug build, when a pass changed what the program computes.
pub fn optimise_by(program: Program, passes: &[Pass]) -> Program {
    let run = |passes: &[Pass], program: Program| passes.iter().fold(program, checked);
    passes.chunk_by(|pass, next| pass.of_all == next.of_all).fold(program, |program, passes| match passes {
        [Pass { of_all: false, .. }, ..] => parts::each(program, |part| run(passes, part)),
        _ => run(passes, program),
    })
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

/// Instructions up to which a debug build checks what a pass makes of a program or a part of one, and on how many images.
const CHECKED: usize = 20_000;
const IMAGES: u64 = 2;
