//! What of a program needs floating point: not what moves reals about, which is done in registers of integers.

use super::Floats;
use crate::elementary::Elementary;
use crate::logic::{Instruction, Op, Program, Unary};

/// The first section that computes more of reals than a processor can, if there is one.
pub(in crate::engine) fn first_beyond(program: &Program, floats: Floats) -> Option<usize> {
    if floats == Floats::Double {
        return None;
    }
    let beyond = |at: usize| needed(program, program.instructions[at]) > floats;
    (0..program.sections.len()).find(|section| program.section_range(*section).any(beyond))
}

/// What the code of an instruction computes in.
fn needed(program: &Program, Instruction { ty, op }: Instruction) -> Floats {
    match op {
        Op::Unary(Unary::SquareRoot, _) => width(ty),
        // On the bits.
        Op::Unary(Unary::Not | Unary::Negate | Unary::Absolute, _) => Floats::No,
        Op::Binary(..) => width(ty),
        Op::Compare(_, a, _) => width(program.instructions[a.index()].ty),
        Op::Convert(a) => {
            let from = program.instructions[a.index()].ty;
            match (from.is_real(), ty.is_real()) {
                // Also of a REAL by way of LREAL, which has room for the rounding.
                (true, false) if ty != Elementary::Bool => Floats::Double,
                (true, true) if from == ty => Floats::No,
                (true, true) => Floats::Double,
                (false, true) => width(ty),
                (_, false) => Floats::No,
            }
        }
        Op::Call(..) => Floats::Double,
        Op::Constant(_)
        | Op::Now
        | Op::Load(_)
        | Op::Store(..)
        | Op::Reinterpret(_)
        | Op::Select(..)
        | Op::LoadIndexed(..)
        | Op::StoreIndexed(..)
        | Op::CopyArray(..) => Floats::No,
    }
}

fn width(ty: Elementary) -> Floats {
    match ty {
        Elementary::Real => Floats::Single,
        Elementary::Lreal => Floats::Double,
        _ => Floats::No,
    }
}
