//! What is computed wider than anyone needs is computed narrow: conversions there and back go, comparisons of widened
//! values compare what was widened, and sums whose upper bits are dropped are computed without them.

use super::rewrite::{Output, rewrite};
use crate::elementary::{Elementary, Value};
use crate::logic::{Binary, Instruction, Op, Program, ValueId};

/// See the module.
pub(super) fn narrow(program: Program) -> Program {
    rewrite(program, |output, _, instruction| narrowed(output, instruction).or_else(|| output.keep(instruction)))
}

fn narrowed(output: &mut Output, Instruction { ty, op }: Instruction) -> Option<ValueId> {
    match op {
        Op::Convert(a) => match output.op(a) {
            Op::Convert(inner) if skips(output.ty(inner), output.ty(a), ty) => {
                Some(if output.ty(inner) == ty { inner } else { output.emit(ty, Op::Convert(inner)) })
            }
            Op::Binary(op, x, y) if drops_upper_bits(op, ty, output.ty(a)) => {
                let (x, y) = (before_widening(output, x, ty)?, before_widening(output, y, ty)?);
                let [x, y] = [x, y].map(|operand| operand.made(output, ty));
                Some(output.emit(ty, Op::Binary(op, x, y)))
            }
            _ => None,
        },
        Op::Compare(op, a, b) => {
            let wide = output.ty(a);
            let from = [a, b].into_iter().find_map(|value| match output.op(value) {
                Op::Convert(inner) => Some(output.ty(inner)),
                _ => None,
            })?;
            // The order must be that of the wide values, so that all narrow ones must be among them.
            if !holds_all(wide, from) {
                return None;
            }
            let (a, b) = (before_widening(output, a, from)?, before_widening(output, b, from)?);
            let [a, b] = [a, b].map(|operand| operand.made(output, from));
            Some(output.emit(Elementary::Bool, Op::Compare(op, a, b)))
        }
        Op::Constant(_)
        | Op::Now
        | Op::Load(_)
        | Op::Store(..)
        | Op::Unary(..)
        | Op::Binary(..)
        | Op::Select(..)
        | Op::Reinterpret(_)
        | Op::Call(..)
        | Op::LoadIndexed(..)
        | Op::StoreIndexed(..)
        | Op::CopyArray(..) => None,
    }
}

/// Whether every value of a type is one of another; of neither BOOL nor the reals.
fn holds_all(wide: Elementary, narrow: Elementary) -> bool {
    match (wide.range(), narrow.range()) {
        (Some((least, most)), Some((from, to))) => wide != Elementary::Bool && least <= from && to <= most,
        _ => false,
    }
}

/// Whether a conversion by way of a type is the one without it.
fn skips(from: Elementary, by_way_of: Elementary, to: Elementary) -> bool {
    // Truth of a value with bits that the type on the way drops is another.
    let drops = !from.is_real()
        && !by_way_of.is_real()
        && !to.is_real()
        && by_way_of != Elementary::Bool
        && to != Elementary::Bool
        && to.bits() <= by_way_of.bits();
    drops || holds_all(by_way_of, from)
}

/// Whether the low bits of an operation's result depend on nothing but those of its operands.
fn drops_upper_bits(op: Binary, narrow: Elementary, wide: Elementary) -> bool {
    let integers = !narrow.is_real() && !wide.is_real() && narrow != Elementary::Bool && wide != Elementary::Bool;
    let depends = match op {
        Binary::And | Binary::Or | Binary::Xor | Binary::Add | Binary::Subtract | Binary::Multiply => true,
        Binary::Divide
        | Binary::Remainder
        | Binary::Minimum
        | Binary::Maximum
        | Binary::ShiftLeft
        | Binary::ShiftRight
        | Binary::RotateLeft
        | Binary::RotateRight => false,
    };
    integers && depends && narrow.bits() < wide.bits() && op.domain().contains(narrow)
}

/// A value before it was widened.
enum Narrow {
    Value(ValueId),
    Constant(u64),
}

impl Narrow {
    fn made(&self, output: &mut Output, ty: Elementary) -> ValueId {
        match self {
            Self::Value(value) => *value,
            Self::Constant(bits) => output.constant(ty, *bits),
        }
    }
}

/// What a value was before it was widened from a type, if it was; a constant has to be one of that type.
fn before_widening(output: &Output, value: ValueId, from: Elementary) -> Option<Narrow> {
    let wide = output.ty(value);
    match output.op(value) {
        Op::Convert(inner) if output.ty(inner) == from => Some(Narrow::Value(inner)),
        Op::Constant(bits) => {
            let number = Value::from_bits(wide, bits).as_integer()?;
            Value::integer(from, number).map(|value| Narrow::Constant(value.bits()))
        }
        _ => None,
    }
}
