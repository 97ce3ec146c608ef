//! The register machine of Shobha and Ramachandran, "Realization of Timers, Counters and Shift Registers for Programmable
//! Controller Using Ladder Diagram": numbers are WORDs, in registers; presets come from there and actual values go there.
//!
//! Where the paper contradicts itself, `docs/register-machine.md` says what was chosen. Every block has an enable circuit of its
//! own, which clears it; that is not EN, without which a block is not executed and keeps all. The memories of edges follow
//! their circuits on every run, whether enabled or not.

pub(super) mod bits;
pub(super) mod counters;
pub(super) mod drum;
pub(super) mod shifts;
pub(super) mod timers;

use super::Run;
use crate::elementary::{Elementary, Value};
use crate::logic::{Binary, ValueId};

/// The greatest preset and value of timers and counters: four decimal digits.
const DIGITS: u16 = 9999;

/// A preset, which is a WORD, as another type; one above the limit, which can only come from a register, counts as the limit.
fn preset(run: &mut Run<'_>, pin: usize, limit: u16, ty: Elementary) -> ValueId {
    let preset = run.input(pin);
    let preset = run.logic.convert(preset, ty);
    let limit = number(run, ty, i64::from(limit));
    run.logic.binary(Binary::Minimum, preset, limit)
}

/// A constant number of a type.
fn number(run: &mut Run<'_>, ty: Elementary, number: i64) -> ValueId {
    run.logic.constant(Value::from_bits(ty, number.cast_unsigned()))
}
