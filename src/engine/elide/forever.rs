//! Whether a scan leaves an image as it is at every later time: a scan executed on what is known of values, not on values.
//!
//! The image is known to the last bit, and the time is known to be no less than it was. Of each value it is then known
//! either what it is, or that it is the time moved by a constant, or nothing. `now - start` of a timer that has expired is at
//! least its preset, today and for ever; of one that is idle, and moves its start along with the time, it is 0.
//!
//! Slots that no name shows may **move**: a timer notes the time while it is idle, to have it as its start. What a scan
//! loads from one that moves is unknown, since it may be what any later scan left there; what it stores there must be told by
//! the time alone, so that the last of many scans leaves what it alone would leave.
//!
//! This must never say TRUE where some later scan could change a variable; that it says FALSE costs only time.

use std::collections::BTreeSet;
use std::ops::Range;
use std::sync::Arc;

use crate::elementary::{Elementary, Value, canonical};
use crate::logic::image::FAULT;
use crate::logic::{Area, Array, Binary, Compare, Instruction, Layout, Op, Program, SlotId, ValueId, evaluate};

/// How far ahead of the present time is looked, in nanoseconds: 73 years. No sum of such times overflows.
pub(super) const HORIZON: i64 = 1 << 61;

/// What is known of a value in all scans from now on.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Known {
    /// It is this, in register form.
    Exactly(u64),
    /// It is the time of the scan and so many nanoseconds.
    TimePlus(i64),
    Nothing,
}

/// What of a program has to be known beforehand.
#[derive(Debug)]
pub(super) struct Outlook {
    layout: Arc<Layout>,
    instructions: Vec<Instruction>,
    /// The instructions of the tasks that run in every round.
    always: Vec<Range<usize>>,
    /// The slots that may move.
    hidden: BTreeSet<SlotId>,
}

impl Outlook {
    /// That of a verified program.
    pub(super) fn of(program: &Program) -> Self {
        let tasks = (0..program.tasks.len()).filter(|task| program.tasks[*task].interval.is_none());
        Self {
            layout: Arc::clone(&program.layout),
            instructions: program.instructions.clone(),
            always: tasks.map(|task| program.instruction_range(program.task_range(task))).collect(),
            hidden: hidden(program),
        }
    }

    /// The bytes of the slots that may move.
    pub(super) fn may_move(&self) -> impl Iterator<Item = Range<usize>> {
        self.hidden.iter().map(|slot| {
            let slot = self.layout.slot(*slot);
            slot.offset as usize..(slot.offset + slot.ty.size()) as usize
        })
    }

    /// Whether no scan of this image, from `now` on and up to [`HORIZON`] later, changes anything but slots that move, as long
    /// as no task with an interval is due. What such slots hold then is what the last scan alone leaves there.
    pub(super) fn is_still(&self, image: &[u8], now: i64) -> bool {
        if !(-HORIZON..=HORIZON).contains(&now) {
            return false;
        }
        let held = |slot: SlotId| self.layout.slot(slot).read(image).bits();
        let mut moving = BTreeSet::new();
        loop {
            let Some(changed) = self.changed(&held, &moving, now) else { return false };
            let before = moving.len();
            for (slot, stored) in changed {
                // What is not told by the time alone may be made of what moves.
                if !self.hidden.contains(&slot) || stored == Known::Nothing && moving.contains(&slot) {
                    return false;
                }
                moving.insert(slot);
            }
            if moving.len() == before {
                return true;
            }
        }
    }

    /// What a scan leaves in the slots that it does not leave as they are; `None` where it may store anywhere in an array.
    fn changed(
        &self,
        held: &impl Fn(SlotId) -> u64,
        moving: &BTreeSet<SlotId>,
        now: i64,
    ) -> Option<Vec<(SlotId, Known)>> {
        let mut scan = Scanned {
            outlook: self,
            slots: (0..self.layout.slots().len())
                .map(|index| SlotId(u32::try_from(index).unwrap_or(u32::MAX)))
                .map(|slot| if moving.contains(&slot) { Known::Nothing } else { Known::Exactly(held(slot)) })
                .collect(),
            values: vec![Known::Nothing; self.instructions.len()],
            now,
        };
        for range in &self.always {
            for index in range.clone() {
                scan.execute(index)?;
            }
        }
        let after = scan.slots.iter().enumerate();
        let slots = after.map(|(index, known)| (SlotId(u32::try_from(index).unwrap_or(u32::MAX)), *known));
        Some(slots.filter(|(slot, known)| *known != Known::Exactly(held(*slot))).collect())
    }
}

/// The slots that nothing but loads and stores of their own can reach and that no name shows.
fn hidden(program: &Program) -> BTreeSet<SlotId> {
    let layout = &program.layout;
    let mut may: Vec<bool> = layout.slots().iter().map(|slot| slot.area == Area::State && slot.name != FAULT).collect();
    for observed in layout.observed() {
        may[observed.slot.index()] = false;
    }
    for array in layout.arrays() {
        may[array.indices()].fill(false);
    }
    for due in program.tasks.iter().filter_map(|task| task.due) {
        may[due.index()] = false;
    }
    let slots = may.iter().enumerate().filter(|(_, may)| **may);
    slots.map(|(index, _)| SlotId(u32::try_from(index).unwrap_or(u32::MAX))).collect()
}

/// A scan of which only so much is known.
struct Scanned<'a> {
    outlook: &'a Outlook,
    slots: Vec<Known>,
    values: Vec<Known>,
    now: i64,
}

impl Scanned<'_> {
    /// Executes an instruction; `None` where it is not known what it stores to.
    fn execute(&mut self, index: usize) -> Option<()> {
        let Instruction { ty, op } = self.outlook.instructions[index];
        let of = |value: ValueId| self.values[value.index()];
        let value = match op {
            Op::Constant(bits) => Known::Exactly(bits),
            Op::Now => Known::TimePlus(0),
            Op::Load(slot) => self.slots[slot.index()],
            Op::Store(slot, a) => {
                self.slots[slot.index()] = stored(ty, of(a));
                return Some(());
            }
            Op::Unary(op, a) => exactly([of(a)], |[a]| evaluate::unary(op, ty, a)),
            Op::Binary(op, a, b) => self.binary(op, ty, of(a), of(b)),
            Op::Compare(op, a, b) => self.compare(op, self.outlook.instructions[a.index()].ty, of(a), of(b)),
            Op::Select(condition, a, b) => match of(condition) {
                Known::Exactly(condition) => of(if condition == 0 { b } else { a }),
                _ if of(a) == of(b) => of(a),
                _ => Known::Nothing,
            },
            Op::Convert(a) => {
                let from = self.outlook.instructions[a.index()].ty;
                exactly([of(a)], |[a]| evaluate::convert(from, ty, a))
            }
            Op::Reinterpret(a) => exactly([of(a)], |[a]| evaluate::reinterpret(ty, a)),
            Op::Call(helper, a, None) => exactly([of(a)], |[a]| evaluate::call(helper, ty, a, None)),
            Op::Call(helper, a, Some(b)) => exactly([of(a), of(b)], |[a, b]| evaluate::call(helper, ty, a, Some(b))),
            Op::LoadIndexed(array, at) => match of(at) {
                Known::Exactly(at) => self.element(self.outlook.layout.array(array), at),
                Known::TimePlus(_) | Known::Nothing => Known::Nothing,
            },
            Op::StoreIndexed(array, at, a) => {
                let Known::Exactly(at) = of(at) else { return None };
                let Array { first, count } = self.outlook.layout.array(array);
                if let Some(element) = evaluate::element(count, at) {
                    self.slots[first.index() + element as usize] = stored(ty, of(a));
                }
                return Some(());
            }
            Op::CopyArray(to, from, condition) => {
                let Known::Exactly(condition) = of(condition) else { return None };
                if condition != 0 {
                    let [to, from] = [to, from].map(|array| self.outlook.layout.array(array).indices());
                    self.slots.copy_within(from, to.start);
                }
                return Some(());
            }
        };
        self.values[index] = value;
        Some(())
    }

    fn element(&self, Array { first, count }: Array, at: u64) -> Known {
        evaluate::element(count, at).map_or(Known::Exactly(0), |element| self.slots[first.index() + element as usize])
    }

    fn binary(&self, op: Binary, ty: Elementary, a: Known, b: Known) -> Known {
        let all = canonical(ty, u64::MAX);
        match (op, a, b) {
            (Binary::And, Known::Exactly(0), _) | (Binary::And, _, Known::Exactly(0)) => Known::Exactly(0),
            (Binary::Or, Known::Exactly(bits), _) | (Binary::Or, _, Known::Exactly(bits)) if bits == all => {
                Known::Exactly(all)
            }
            (_, Known::Exactly(a), Known::Exactly(b)) => Known::Exactly(evaluate::binary(op, ty, a, b)),
            (Binary::Subtract, Known::TimePlus(a), Known::TimePlus(b)) => {
                Known::Exactly(a.wrapping_sub(b).cast_unsigned())
            }
            (Binary::Subtract, Known::TimePlus(a), Known::Exactly(b)) => moved(a, b.cast_signed().checked_neg()),
            (Binary::Add, Known::TimePlus(a), Known::Exactly(b))
            | (Binary::Add, Known::Exactly(b), Known::TimePlus(a)) => moved(a, Some(b.cast_signed())),
            // Where the other operand decides.
            (Binary::Minimum | Binary::Maximum, _, _) if ty.is_signed() => {
                let less = self.compare(Compare::Less, ty, a, b);
                match (less, op) {
                    (Known::Exactly(1), Binary::Minimum) | (Known::Exactly(0), Binary::Maximum) => a,
                    (Known::Exactly(_), _) => b,
                    (Known::TimePlus(_) | Known::Nothing, _) => Known::Nothing,
                }
            }
            _ => Known::Nothing,
        }
    }

    fn compare(&self, op: Compare, ty: Elementary, a: Known, b: Known) -> Known {
        if let (Known::Exactly(a), Known::Exactly(b)) = (a, b) {
            return Known::Exactly(u64::from(evaluate::compare(op, ty, a, b)));
        }
        let (Some((a_least, a_most)), Some((b_least, b_most))) = (self.range(ty, a), self.range(ty, b)) else {
            return Known::Nothing;
        };
        let (always, never) = match op {
            Compare::Less => (a_most < b_least, a_least >= b_most),
            Compare::LessOrEqual => (a_most <= b_least, a_least > b_most),
            Compare::Greater => (a_least > b_most, a_most <= b_least),
            Compare::GreaterOrEqual => (a_least >= b_most, a_most < b_least),
            Compare::Equal => (false, a_most < b_least || a_least > b_most),
            Compare::NotEqual => (a_most < b_least || a_least > b_most, false),
        };
        match (always, never) {
            (true, _) => Known::Exactly(1),
            (_, true) => Known::Exactly(0),
            _ => Known::Nothing,
        }
    }

    /// The least and the most that a signed integer of 64 bits can be.
    fn range(&self, ty: Elementary, known: Known) -> Option<(i64, i64)> {
        match known {
            _ if !matches!(ty, Elementary::Time | Elementary::Lint) => None,
            Known::Exactly(bits) => Some((bits.cast_signed(), bits.cast_signed())),
            // Neither end overflows: all three are within the horizon.
            Known::TimePlus(way) => Some((self.now + way, self.now.saturating_add(HORIZON).saturating_add(way))),
            Known::Nothing => None,
        }
    }
}

/// The time, moved once more; nothing where sums could overflow.
fn moved(way: i64, further: Option<i64>) -> Known {
    let way = further.and_then(|further| way.checked_add(further));
    way.filter(|way| (-HORIZON..=HORIZON).contains(way)).map_or(Known::Nothing, Known::TimePlus)
}

/// What a slot of a type then holds.
fn stored(ty: Elementary, known: Known) -> Known {
    match known {
        Known::Exactly(bits) => Known::Exactly(Value::from_bits(ty, bits).bits()),
        known => known,
    }
}

/// A function of values that are known exactly.
fn exactly<const N: usize>(operands: [Known; N], of: impl FnOnce([u64; N]) -> u64) -> Known {
    let mut bits = [0; N];
    for (bits, known) in bits.iter_mut().zip(operands) {
        let Known::Exactly(exact) = known else { return Known::Nothing };
        *bits = exact;
    }
    Known::Exactly(of(bits))
}
