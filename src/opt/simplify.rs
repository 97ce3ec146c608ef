//! What the identities of logic make simpler is made so, and what is constant only by that is computed, too.

use super::fold::folded;
use super::rewrite::{Output, rewrite};
use crate::elementary::{Elementary, canonical};
use crate::logic::{Binary, Compare, Instruction, Op, Program, Unary, ValueId, evaluate};

/// See the module.
pub(super) fn simplify(program: Program) -> Program {
    let arrays = program.layout.arrays().to_vec();
    rewrite(program, |output, _, instruction| {
        let folded = folded(output, &arrays, instruction);
        let simpler = folded.or_else(|| simplified(output, instruction).map(Some));
        simpler.unwrap_or_else(|| output.keep(instruction))
    })
}

fn simplified(output: &mut Output, Instruction { ty, op }: Instruction) -> Option<ValueId> {
    match op {
        Op::Constant(_) | Op::Now | Op::Load(_) | Op::Store(..) | Op::Call(..) => None,
        Op::LoadIndexed(..) | Op::StoreIndexed(..) | Op::CopyArray(..) => None,
        Op::Unary(op, a) => unary(output, op, a),
        Op::Binary(op, a, b) => bitwise(output, op, ty, a, b),
        Op::Compare(op, a, b) => compare(output, op, a, b),
        Op::Select(condition, a, b) => select(output, ty, condition, a, b),
        Op::Convert(a) => (output.ty(a) == ty).then_some(a),
        Op::Reinterpret(a) if output.ty(a) == ty => Some(a),
        // There and back.
        Op::Reinterpret(a) => match output.op(a) {
            Op::Reinterpret(inner) => (output.ty(inner) == ty).then_some(inner),
            _ => None,
        },
    }
}

fn unary(output: &mut Output, op: Unary, a: ValueId) -> Option<ValueId> {
    match (op, output.op(a)) {
        (Unary::Not, Op::Unary(Unary::Not, inner)) => Some(inner),
        // With a NaN neither a comparison nor its opposite holds.
        (Unary::Not, Op::Compare(compare, x, y)) if !output.ty(x).is_real() => {
            let opposite = match compare {
                Compare::Equal => Compare::NotEqual,
                Compare::NotEqual => Compare::Equal,
                Compare::Less => Compare::GreaterOrEqual,
                Compare::LessOrEqual => Compare::Greater,
                Compare::Greater => Compare::LessOrEqual,
                Compare::GreaterOrEqual => Compare::Less,
            };
            Some(output.emit(Elementary::Bool, Op::Compare(opposite, x, y)))
        }
        (Unary::Not | Unary::Negate | Unary::Absolute | Unary::SquareRoot, _) => None,
    }
}

fn bitwise(output: &mut Output, op: Binary, ty: Elementary, a: ValueId, b: ValueId) -> Option<ValueId> {
    let all = canonical(ty, u64::MAX);
    let inverse = inverts(output, a, b) || inverts(output, b, a);
    // A constant among the two, and the other.
    let constant = match (output.constant_of(a), output.constant_of(b)) {
        (Some(bits), _) => Some((bits, b)),
        (_, Some(bits)) => Some((bits, a)),
        (None, None) => None,
    };
    match op {
        Binary::And if a == b => Some(a),
        Binary::And if inverse => Some(output.constant(ty, 0)),
        Binary::And => match constant? {
            (0, _) => Some(output.constant(ty, 0)),
            (bits, other) => (bits == all).then_some(other),
        },
        Binary::Or if a == b => Some(a),
        Binary::Or if inverse => Some(output.constant(ty, all)),
        Binary::Or => match constant? {
            (0, other) => Some(other),
            (bits, _) => (bits == all).then(|| output.constant(ty, all)),
        },
        Binary::Xor if a == b => Some(output.constant(ty, 0)),
        Binary::Xor if inverse => Some(output.constant(ty, all)),
        Binary::Xor => match constant? {
            (0, other) => Some(other),
            (bits, other) => (bits == all).then(|| output.emit(ty, Op::Unary(Unary::Not, other))),
        },
        Binary::Add
        | Binary::Subtract
        | Binary::Multiply
        | Binary::Divide
        | Binary::Remainder
        | Binary::Minimum
        | Binary::Maximum
        | Binary::ShiftLeft
        | Binary::ShiftRight
        | Binary::RotateLeft
        | Binary::RotateRight => None,
    }
}

/// A comparison of a value with itself, which of a NaN is another; and one of a BOOL with a constant.
fn compare(output: &mut Output, op: Compare, a: ValueId, b: ValueId) -> Option<ValueId> {
    let ty = output.ty(a);
    if a == b && !ty.is_real() {
        let holds = matches!(op, Compare::Equal | Compare::LessOrEqual | Compare::GreaterOrEqual);
        return Some(output.constant(Elementary::Bool, u64::from(holds)));
    }
    if ty != Elementary::Bool {
        return None;
    }
    let (value, with) = match (output.constant_of(a), output.constant_of(b)) {
        (Some(bits), None) => (b, [0, 1].map(|value| evaluate::compare(op, ty, bits, value))),
        (None, Some(bits)) => (a, [0, 1].map(|value| evaluate::compare(op, ty, value, bits))),
        _ => return None,
    };
    Some(match with {
        [false, true] => value,
        [true, false] => output.not(value),
        [both, _] => output.constant(Elementary::Bool, u64::from(both)),
    })
}

fn inverts(output: &Output, a: ValueId, b: ValueId) -> bool {
    matches!(output.op(a), Op::Unary(Unary::Not, inner) if inner == b)
}

fn select(output: &mut Output, ty: Elementary, condition: ValueId, a: ValueId, b: ValueId) -> Option<ValueId> {
    if a == b {
        return Some(a);
    }
    // Of a choice by the same condition within, one side is never taken.
    let taken = |output: &Output, value: ValueId, holds: bool| match output.op(value) {
        Op::Select(inner, a, b) if inner == condition => Some(if holds { a } else { b }),
        _ => None,
    };
    if let Some(value) = taken(output, a, true) {
        return select(output, ty, condition, value, b).or_else(|| emitted(output, ty, condition, value, b));
    }
    if let Some(value) = taken(output, b, false) {
        return select(output, ty, condition, a, value).or_else(|| emitted(output, ty, condition, a, value));
    }
    if ty == Elementary::Bool {
        let (op, x, y) = match (output.constant_of(a), output.constant_of(b)) {
            (Some(1), _) => (Binary::Or, condition, b),
            (Some(_), _) => (Binary::And, output.not(condition), b),
            (None, Some(0)) => (Binary::And, condition, a),
            (None, Some(_)) => (Binary::Or, output.not(condition), a),
            (None, None) => return swapped(output, ty, condition, a, b),
        };
        return bitwise(output, op, ty, x, y).or_else(|| Some(output.emit(ty, Op::Binary(op, x, y))));
    }
    swapped(output, ty, condition, a, b)
}

fn emitted(output: &mut Output, ty: Elementary, condition: ValueId, a: ValueId, b: ValueId) -> Option<ValueId> {
    Some(output.emit(ty, Op::Select(condition, a, b)))
}

/// A choice by an inverse is the other choice.
fn swapped(output: &mut Output, ty: Elementary, condition: ValueId, a: ValueId, b: ValueId) -> Option<ValueId> {
    match output.op(condition) {
        Op::Unary(Unary::Not, inner) => Some(output.emit(ty, Op::Select(inner, b, a))),
        _ => None,
    }
}
