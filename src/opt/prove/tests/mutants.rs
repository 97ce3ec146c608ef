//! Small faults in the output of the passes: each that changes what is computed is told, and no other.

use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;

use super::super::{Difference, compare};
use super::optimised;
use crate::elementary::{Elementary, canonical};
use crate::logic::{Binary, Compare, Instruction, Op, Program, Unary, ValueId, random, verify};
use crate::opt::check;

/// Changes one instruction; `None` where it is not one that this fault can be in.
fn mutated(program: &Program, place: usize, rng: &mut Pcg64) -> Option<Program> {
    let Instruction { ty, op } = program.instructions[place];
    let fault = rng.random_range(0..3);
    let of = |value: ValueId| program.instructions[value.index()].ty;
    // Another value of a type that is there already.
    let other = |value: ValueId, rng: &mut Pcg64| {
        let another = ValueId(rng.random_range(0..u32::try_from(place).ok()?.max(1)));
        let fits = program.instructions[another.index()].op.has_value() && of(another) == of(value);
        (fits && another != value).then_some(another)
    };
    let op = match op {
        Op::Constant(bits) => Op::Constant(canonical(ty, bits ^ 1 << rng.random_range(0..ty.bits()))),
        Op::Unary(Unary::Not, a) => Op::Select(if ty == Elementary::Bool { a } else { return None }, a, a),
        Op::Unary(..) => return None,
        Op::Binary(Binary::And, a, b) => Op::Binary(if fault == 0 { Binary::Xor } else { Binary::Or }, a, b),
        Op::Binary(Binary::Or, a, b) => Op::Binary(if fault == 0 { Binary::Xor } else { Binary::And }, a, b),
        Op::Binary(Binary::Add, a, b) => Op::Binary(Binary::Subtract, a, b),
        Op::Binary(op, a, b) if of(a) == of(b) => Op::Binary(op, b, a),
        Op::Binary(..) => return None,
        Op::Compare(Compare::Less, a, b) => Op::Compare(Compare::LessOrEqual, a, b),
        Op::Compare(Compare::GreaterOrEqual, a, b) => Op::Compare(Compare::Greater, a, b),
        Op::Compare(op, a, b) => Op::Compare(op, other(a, rng)?, b),
        Op::Select(condition, a, b) => Op::Select(condition, b, a),
        Op::Store(slot, a) => Op::Store(slot, other(a, rng)?),
        Op::StoreIndexed(array, index, a) if fault == 0 => Op::StoreIndexed(array, other(index, rng)?, a),
        Op::StoreIndexed(array, index, a) => Op::StoreIndexed(array, index, other(a, rng)?),
        Op::CopyArray(to, from, a) => Op::CopyArray(to, from, other(a, rng)?),
        Op::LoadIndexed(array, index) => Op::LoadIndexed(array, other(index, rng)?),
        Op::Call(helper, a, b) => Op::Call(helper, other(a, rng)?, b),
        Op::Convert(a) => Op::Convert(other(a, rng)?),
        Op::Now | Op::Load(_) | Op::Reinterpret(_) => return None,
    };
    let mut mutant = program.clone();
    mutant.instructions[place] = Instruction { ty, op };
    // A value of another chunk is no operand.
    verify(&mutant).is_ok().then_some(mutant)
}

/// That a difference is one: the sections that the programs have in common leave on its image what it says.
fn confirm(before: &Program, after: &Program, difference: &Difference) {
    let chunk = |program: &Program, place: usize| program.chunks()[place].clone();
    let machine = super::super::witness::Machine::new(&before.layout);
    let shown = (0..after.chunks().len()).any(|place| {
        let sections = chunk(after, place);
        let [expected, actual] = [before, after]
            .map(|program| machine.run(program, sections.clone(), &difference.image, difference.now))
            .map(|image| difference.slot.read(&image));
        (expected, actual) == (difference.expected, difference.actual)
    });
    assert!(shown, "no chunk leaves {difference}");
}

#[test]
fn every_fault_that_random_images_show_is_told_and_every_one_told_is_one() {
    let (mut told, mut equivalent, mut unproved) = (0, 0, 0);
    for seed in 0..60 {
        let original = random::program(seed);
        let program = optimised(original.clone());
        let mut rng = Pcg64::seed_from_u64(seed);
        for _ in 0..24 {
            if program.instructions.is_empty() {
                continue;
            }
            let place = rng.random_range(0..program.instructions.len());
            let Some(mutant) = mutated(&program, place, &mut rng) else { continue };
            // Sections are the same ones, so that chunks of both correspond.
            let shown = check::difference(&program, &mutant, 40);
            match compare(&program, &mutant) {
                Err(different) => {
                    confirm(&program, &mutant, &different.1);
                    told += 1;
                }
                Ok(report) => {
                    assert_eq!(shown, None, "seed {seed}, {place} is not told:\n{mutant:#?}");
                    unproved += usize::from(!report.unproved.is_empty());
                    equivalent += usize::from(report.unproved.is_empty());
                }
            }
        }
    }
    assert!(told > 250 && equivalent > 30, "{told} told, {equivalent} equivalent");
    assert!(unproved * 10 < told, "{unproved} unproved, {told} told");
}

#[test]
fn a_store_that_is_dropped_or_moved_before_another_is_told() {
    let (mut dropped, mut told) = (0, 0);
    for seed in 0..40 {
        let program = optimised(random::program(seed));
        for place in 0..program.instructions.len() {
            let Op::Store(slot, value) = program.instructions[place].op else { continue };
            // A store of what is there is none.
            let mut without = program.clone();
            let before = without.instructions[..place].iter().rposition(|instruction| instruction.op == Op::Load(slot));
            let Some(before) = before.and_then(|before| u32::try_from(before).ok()).map(ValueId) else { continue };
            without.instructions[place].op = Op::Store(slot, before);
            if before == value || verify(&without).is_err() {
                continue;
            }
            dropped += 1;
            let shown = check::difference(&program, &without, 20).is_some();
            let found = compare(&program, &without).is_err();
            assert!(found || !shown, "seed {seed}, the store {place} of {slot}");
            told += usize::from(found);
        }
    }
    assert!(told * 10 > dropped * 7 && told > 20, "{told} of {dropped}");
}
