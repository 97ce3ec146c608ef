//! What is done with stamps when an epoch ends, as operations for [`compile`](super::compile): a segment that sums it up,
//! and one for each row that a preset may reach, which makes the answers for all scans of the next epoch.
//!
//! They go through stamps side by side: [`Cell::Row`] is a word of the stamp itself, as numbered here; [`Cell::Word`] is
//! common to all, and the same in all lanes. What they compute is said in [`stamps`](super::stamps), which uses the same
//! formulas on words where it does not run them.

use std::cell::RefCell;
use std::ops::{BitAnd, BitOr, BitXor, Not};

use super::plan::{Bit, BitOp, Cell};

/// Scans of an epoch: a power of two, so that the number of a scan in it is some bits of its number.
pub(super) const ROWS: usize = 1 << ROW_BITS;
pub(super) const ROW_BITS: usize = 3;

/// Low bits of a scan's number, which are kept up to date with every epoch; and those of them that number an epoch of
/// an era.
pub(super) const LOW_BITS: usize = 8;
pub(super) const ERA_BITS: usize = LOW_BITS - ROW_BITS;

/// The words of a stamp: rows, planes of the low bits, and the lanes that were set in this era, and in the one before.
pub(super) const LOW: usize = ROWS;
pub(super) const ERA: usize = LOW + LOW_BITS;
pub(super) const ERA_BEFORE: usize = ERA + 1;
pub(super) const KINDS: usize = ERA_BEFORE + 1;

/// The common words: the two that every segment has; the bits of an epoch and of the next; whether the first is in this
/// era, in the one before, or in either; and the first two for the next.
pub(super) const BITS: usize = 2;
pub(super) const NEXT_BITS: usize = BITS + ERA_BITS;
pub(super) const IN_ERA: usize = NEXT_BITS + ERA_BITS;
pub(super) const IN_ERA_BEFORE: usize = IN_ERA + 1;
pub(super) const IN_EITHER: usize = IN_ERA + 2;
pub(super) const NEXT_IN_ERA: usize = IN_ERA + 3;
pub(super) const NEXT_IN_ERA_BEFORE: usize = IN_ERA + 4;
pub(super) const COMMON: usize = IN_ERA + 5;

/// A bit for each lane, or what will be one.
pub(super) trait Bits: Copy + BitAnd<Output = Self> + BitOr<Output = Self> + Not<Output = Self> {}

impl<T: Copy + BitAnd<Output = T> + BitOr<Output = T> + Not<Output = T>> Bits for T {}

/// Of the rows of an epoch: the lanes with any, and the bits of the last row that has each, the lowest first.
#[inline(always)]
pub(super) fn sum<T: Bits>(rows: [T; ROWS]) -> (T, [T; ROW_BITS]) {
    // Of two halves, the later counts in the lanes that it has, and whether it has is the bit that tells them apart.
    let two = |first: usize| (rows[first] | rows[first + 1], rows[first + 1]);
    let four = |first: usize| {
        let ((early, early_0), (late, late_0)) = (two(first), two(first + 2));
        (early | late, early_0 & !late | late_0, late)
    };
    let ((early, early_0, early_1), (late, late_0, late_1)) = (four(0), four(4));
    (early | late, [early_0 & !late | late_0, early_1 & !late | late_1, late])
}

/// The lanes in which the number of a row is below 1, 2, up to 7.
#[inline(always)]
pub(super) fn below<T: Bits>([low, middle, high]: [T; ROW_BITS]) -> [T; ROWS - 1] {
    let any = low | middle;
    let two = low & middle;
    [!(any | high), !(middle | high), !(high | two), !high, !(high & any), !(high & middle), !(high & two)]
}

/// The segments, of stamps of which one word is so many from the next: the one that sums up, then those that foresee,
/// by the row that is reached in the first scan.
pub(super) fn segments(stride: usize) -> Vec<Vec<BitOp>> {
    let record = |segment: &dyn Fn(&Recorder)| {
        let recorder = Recorder { stride, ops: RefCell::new(Vec::new()) };
        segment(&recorder);
        recorder.ops.into_inner()
    };
    let mut segments = vec![record(&sum_up)];
    segments.extend((0..ROWS).map(|row| record(&|recorder: &Recorder| foresee(recorder, row))));
    segments
}

/// Adds the rows of the epoch to the numbers.
fn sum_up(recorder: &Recorder) {
    let (any, number) = sum(std::array::from_fn(|row| recorder.load(row)));
    for (bit, new) in number.into_iter().enumerate() {
        recorder.store(LOW + bit, recorder.load(LOW + bit) & !any | new);
    }
    for bit in 0..ERA_BITS {
        let plane = LOW + ROW_BITS + bit;
        recorder.store(plane, recorder.load(plane) & !any | recorder.common(BITS + bit) & any);
    }
    recorder.store(ERA, recorder.load(ERA) | any);
}

/// Makes the answers for the scans of an epoch, of a preset that reaches a row in the first and goes on by one with each.
fn foresee(recorder: &Recorder, reached: usize) {
    let in_era = recorder.load(ERA);
    let in_era_before = recorder.load(ERA_BEFORE) & !in_era;
    let within =
        |here: usize, earlier: usize| in_era & recorder.common(here) | in_era_before & recorder.common(earlier);
    let mut first = within(IN_ERA, IN_ERA_BEFORE);
    let mut before = !(in_era & recorder.common(IN_EITHER) | in_era_before & recorder.common(IN_ERA_BEFORE));
    let mut next = within(NEXT_IN_ERA, NEXT_IN_ERA_BEFORE);
    for bit in (0..ERA_BITS).rev() {
        let plane = recorder.load(LOW + ROW_BITS + bit);
        let wanted = recorder.common(BITS + bit);
        let differs = plane ^ wanted;
        before = before | first & differs & wanted;
        first = first & !differs;
        if reached > 0 {
            next = next & !(plane ^ recorder.common(NEXT_BITS + bit));
        }
    }
    let below = below(std::array::from_fn(|bit| recorder.load(LOW + bit)));
    let before_next = before | first;
    for row in 0..ROWS {
        let answer = match (reached + row) % ROWS {
            0 if row + reached == 0 => before,
            0 => before_next,
            end if reached + row < ROWS => before | first & below[end - 1],
            end => before_next | next & below[end - 1],
        };
        recorder.store(row, answer);
    }
}

/// Where operations are written down.
struct Recorder {
    stride: usize,
    ops: RefCell<Vec<BitOp>>,
}

/// What an operation that was written down makes.
#[derive(Clone, Copy)]
struct Recorded<'r> {
    recorder: &'r Recorder,
    index: u32,
}

impl Recorder {
    fn record(&self, op: BitOp) -> Recorded<'_> {
        let mut ops = self.ops.borrow_mut();
        ops.push(op);
        Recorded { recorder: self, index: index(ops.len() - 1) }
    }

    /// A word of the stamp.
    fn load(&self, kind: usize) -> Recorded<'_> {
        self.record(BitOp::Load(Cell::Row(index(kind * self.stride))))
    }

    fn common(&self, word: usize) -> Recorded<'_> {
        self.record(BitOp::Load(Cell::Word(index(word))))
    }

    fn store(&self, kind: usize, bit: Recorded<'_>) {
        self.record(BitOp::Store(Cell::Row(index(kind * self.stride)), Bit::Made(bit.index)));
    }
}

impl BitAnd for Recorded<'_> {
    type Output = Self;

    fn bitand(self, other: Self) -> Self {
        self.recorder.record(BitOp::And(self.index, other.index))
    }
}

impl BitOr for Recorded<'_> {
    type Output = Self;

    fn bitor(self, other: Self) -> Self {
        self.recorder.record(BitOp::Or(self.index, other.index))
    }
}

impl BitXor for Recorded<'_> {
    type Output = Self;

    fn bitxor(self, other: Self) -> Self {
        self.recorder.record(BitOp::Xor(self.index, other.index))
    }
}

impl Not for Recorded<'_> {
    type Output = Self;

    fn not(self) -> Self {
        self.recorder.record(BitOp::Not(self.index))
    }
}

fn index(word: usize) -> u32 {
    u32::try_from(word).unwrap_or(u32::MAX)
}
