//! Random verified programs and images, for testing engines against each other.
//!
//! Every operation occurs on every type that it takes, with extreme constants, several chunks and tasks, and loads and
//! stores that hit the same few slots over and over. The same seed gives the same program. Not for users.

use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;

use super::image::LayoutBuilder;
use super::{
    Area, Array, ArrayId, Binary, Builder, Compare, Helper, Layout, Origin, Program, Slot, SlotId, Unary, ValueId,
};
use crate::elementary::{Elementary, Value};

/// A program of up to a few hundred instructions over up to forty slots.
pub fn program(seed: u64) -> Program {
    let mut rng = Pcg64::seed_from_u64(seed);
    let (layout, mut due) = layout(&mut rng);
    let mut generator = Generator { builder: Builder::new(format!("random_{seed}"), layout), live: Vec::new(), rng };
    let mut starts = Vec::new();
    for section in 0..generator.rng.random_range(1..=12) {
        let ends_task = section > 0 && generator.rng.random_bool(0.15);
        if ends_task {
            let slot = due.pop();
            let interval = slot.map(|_| pick(&mut generator.rng, &[1, 7, 10_000_000, 1 << 40, i64::MAX]));
            generator.builder.end_task(format!("t{section}"), interval, slot);
        }
        let start = section == 0 || ends_task || generator.rng.random_bool(0.25);
        if start {
            generator.live.clear();
        }
        starts.push(start);
        // Mostly boolean programs, as ladders are, and mostly numeric ones.
        let booleans = if seed.is_multiple_of(2) { 0.8 } else { 0.2 };
        for _ in 0..generator.rng.random_range(0..40) {
            let boolean = generator.rng.random_bool(booleans);
            generator.instruction(boolean);
        }
        generator.builder.end_section(Origin { label: format!("r{section}").into(), line: section + 1 });
    }
    let mut program = generator.builder.finish();
    for (section, start) in program.sections.iter_mut().zip(starts) {
        section.starts_chunk = start;
    }
    program
}

/// An image with random, often extreme, values in all slots; every BOOL is 0 or 1 and padding is zero.
pub fn image(layout: &Layout, seed: u64) -> Vec<u8> {
    let mut rng = Pcg64::seed_from_u64(seed);
    let mut image = layout.initial_image();
    for slot in layout.slots() {
        slot.write(&mut image, value(&mut rng, slot.ty));
    }
    image
}

/// A time in nanoseconds: mostly small steps onwards, now and then one of the extremes.
pub fn now(seed: u64) -> i64 {
    Value::bits(value(&mut Pcg64::seed_from_u64(seed), Elementary::Time)).cast_signed()
}

/// A layout, and the slots in which tasks keep when they are due.
fn layout(rng: &mut Pcg64) -> (Layout, Vec<SlotId>) {
    let mut layout = LayoutBuilder::new();
    let count = rng.random_range(4..40);
    for index in 0..count {
        let ty = if rng.random_bool(0.5) { Elementary::Bool } else { pick(rng, &Elementary::ALL) };
        let area = pick(rng, &[Area::Input, Area::Output, Area::Memory, Area::State]);
        let slot = layout.slot(Slot {
            name: format!("x{index}").into(),
            ty,
            offset: 0,
            area,
            retain: area != Area::Input && rng.random_bool(0.3),
            initial: value(rng, ty),
            line: index,
        });
        if rng.random_bool(0.7) {
            layout.observe(format!("x{index}"), slot);
        }
    }
    for index in 0..rng.random_range(1..4) {
        let ty = if rng.random_bool(0.3) { Elementary::Bool } else { pick(rng, &Elementary::ALL) };
        let (area, retain) = (pick(rng, &[Area::Output, Area::Memory]), rng.random_bool(0.3));
        // Mostly small, so that indices hit them; some so long that engines copy them in another way.
        let most = match rng.random_range(0..50) {
            0 => 300,
            1..10 => 40,
            _ => 6,
        };
        let elements = rng.random_range(1..most);
        // Two alike, so that one can be copied to the other; of some, a part is an array, too.
        for copy in ["", "'"] {
            let slots: Vec<SlotId> = (0..elements)
                .map(|element| {
                    let (name, initial) = (format!("array{index}{copy}[{element}]"), value(rng, ty));
                    layout.slot(Slot { name: name.into(), ty, offset: 0, area, retain, initial, line: count + index })
                })
                .collect();
            layout.array(slots[0], elements);
            if rng.random_bool(0.3) {
                let from = rng.random_range(0..elements);
                layout.array(slots[from as usize], rng.random_range(1..=elements - from));
            }
        }
    }
    let due = (0..2)
        .map(|task| {
            let (name, ty, area, initial) = (format!("#task {task}"), Elementary::Time, Area::State, Value::time(0));
            layout.slot(Slot { name: name.into(), ty, offset: 0, area, retain: false, initial, line: 0 })
        })
        .collect();
    (layout.finish(None).unwrap_or_else(|_| unreachable!("so few slots fit")), due)
}

fn pick<T: Copy>(rng: &mut Pcg64, from: &[T]) -> T {
    from[rng.random_range(0..from.len())]
}

/// A value that is likely to lie at an edge: 0, 1, -1, the ends of the range, a power of two, a NaN, anything.
pub(crate) fn value(rng: &mut Pcg64, ty: Elementary) -> Value {
    let edges = [0, 1, u64::MAX, 1 << (ty.bits() - 1), (1 << (ty.bits() - 1)) - 1, 2, 7, 31, 32, 63, 64, 100];
    let reals =
        [0.0, -0.0, 1.0, -1.5, 0.5, 2.5, 1e10, -1e30, 1e300, f64::INFINITY, f64::NEG_INFINITY, f64::NAN, 1e-310];
    let bits = match rng.random_range(0..4) {
        0 => rng.random(),
        1 if ty == Elementary::Time => rng.random_range(0..10_000_000_000),
        _ if ty.is_real() => return Value::real(ty, pick(rng, &reals)).unwrap_or_else(|| Value::default_of(ty)),
        1 => 1 << rng.random_range(0..64),
        _ => pick(rng, &edges),
    };
    Value::from_bits(ty, bits)
}

struct Generator {
    builder: Builder,
    /// The values of this chunk.
    live: Vec<ValueId>,
    rng: Pcg64,
}

impl Generator {
    fn instruction(&mut self, boolean: bool) {
        let ty = if boolean { Elementary::Bool } else { pick(&mut self.rng, &Elementary::ALL) };
        let made = match self.rng.random_range(0..12) {
            0 => {
                if let Some(slot) = self.slot(ty) {
                    let value = self.operand(ty);
                    self.builder.store(slot, value);
                }
                return;
            }
            11 => {
                self.copy();
                return;
            }
            10 => {
                let arrays: Vec<u32> = (0..).zip(self.builder.layout().arrays()).map(|(index, _)| index).collect();
                let (array, index) = (ArrayId(pick(&mut self.rng, &arrays)), self.index());
                if self.rng.random_bool(0.5) {
                    self.builder.load_indexed(array, index)
                } else {
                    let layout = self.builder.layout();
                    let of = layout.slot(layout.array(array).first).ty;
                    let value = self.operand(of);
                    self.builder.store_indexed(array, index, value);
                    return;
                }
            }
            1 => match self.slot(ty) {
                Some(slot) => self.builder.load(slot),
                None => self.builder.now(),
            },
            2 if ty.is_real() && self.rng.random_bool(0.7) => {
                let (helper, a) = (pick(&mut self.rng, Helper::ALL), self.operand(ty));
                let b = helper.takes_two().then(|| self.operand(ty));
                self.builder.call(helper, a, b)
            }
            2 => {
                let (op, a) = (pick(&mut self.rng, Unary::ALL), self.operand(ty));
                if !op.domain().contains(ty) {
                    return;
                }
                self.builder.unary(op, a)
            }
            3 => {
                let of = if self.rng.random_bool(0.3) { ty } else { pick(&mut self.rng, &Elementary::ALL) };
                let (op, a, b) = (pick(&mut self.rng, Compare::ALL), self.operand(of), self.operand(of));
                self.builder.compare(op, a, b)
            }
            4 => {
                let (condition, a, b) = (self.operand(Elementary::Bool), self.operand(ty), self.operand(ty));
                self.builder.select(condition, a, b)
            }
            5 if self.rng.random_bool(0.4) => {
                let as_wide: Vec<Elementary> =
                    Elementary::ALL.iter().copied().filter(|from| from.bits() == ty.bits()).collect();
                let from = pick(&mut self.rng, &as_wide);
                let a = self.operand(from);
                self.builder.reinterpret(a, ty)
            }
            5 => {
                let from = pick(&mut self.rng, &Elementary::ALL);
                let a = self.operand(from);
                self.builder.convert(a, ty)
            }
            _ => {
                let ops: Vec<Binary> = Binary::ALL.iter().copied().filter(|op| op.domain().contains(ty)).collect();
                let op = pick(&mut self.rng, &ops);
                let a = self.operand(ty);
                let b = self.operand(if op.takes_amount() { Elementary::Udint } else { ty });
                self.builder.binary(op, a, b)
            }
        };
        self.live.push(made);
    }

    /// A copy from any array that fits to another.
    fn copy(&mut self) {
        let layout = self.builder.layout();
        let arrays: Vec<(u32, Array)> = (0..).zip(layout.arrays().iter().copied()).collect();
        let ty = |array: Array| layout.slot(array.first).ty;
        let fits = |a: Array, b: Array| {
            let apart = a.slots().end <= b.first || b.slots().end <= a.first;
            ty(a) == ty(b) && a.count == b.count && (a == b || apart)
        };
        let to = pick(&mut self.rng, &arrays);
        let from: Vec<u32> = arrays.iter().filter(|(_, from)| fits(to.1, *from)).map(|(index, _)| *index).collect();
        let from = pick(&mut self.rng, &from);
        let condition = self.rng.random_bool(0.8).then(|| self.operand(Elementary::Bool));
        self.builder.copy_array(ArrayId(to.0), ArrayId(from), condition);
    }

    /// A value of a type: one of the last ones of this chunk, or what a slot holds, or a constant.
    fn operand(&mut self, ty: Elementary) -> ValueId {
        let recent: Vec<ValueId> =
            self.live.iter().rev().copied().filter(|value| self.builder.ty(*value) == ty).take(8).collect();
        let (kind, slot) = (self.rng.random_range(0..10), self.slot(ty));
        let made = match slot {
            _ if kind < 6 && !recent.is_empty() => return pick(&mut self.rng, &recent),
            Some(slot) if kind < 9 => self.builder.load(slot),
            _ => {
                let constant = value(&mut self.rng, ty);
                self.builder.constant(constant)
            }
        };
        self.live.push(made);
        made
    }

    /// A LINT that names an element of a small array about half of the time.
    fn index(&mut self) -> ValueId {
        if self.rng.random_bool(0.6) {
            let any = self.operand(Elementary::Usint);
            let index = self.builder.convert(any, Elementary::Lint);
            let few = self.builder.constant(Value::from_bits(Elementary::Lint, 7));
            let index = self.builder.binary(Binary::Remainder, index, few);
            self.live.extend([index, few]);
            index
        } else {
            self.operand(Elementary::Lint)
        }
    }

    fn slot(&mut self, ty: Elementary) -> Option<SlotId> {
        let slots = self.builder.layout().slots();
        let matching: Vec<u32> =
            (0u32..).zip(slots).filter(|(_, slot)| slot.ty == ty).map(|(index, _)| index).collect();
        if matching.is_empty() { None } else { Some(SlotId(pick(&mut self.rng, &matching))) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::logic::{Domain, Op};

    #[test]
    fn a_seed_names_one_program() {
        assert_eq!(program(7), program(7));
        assert_ne!(program(7), program(8));
    }

    #[test]
    fn every_operation_occurs_on_every_type_that_it_takes() {
        let mut seen = std::collections::HashSet::new();
        for seed in 0..400 {
            let program = program(seed);
            for instruction in &program.instructions {
                let ty_of = |value: ValueId| program.instructions[value.index()].ty;
                seen.insert(match instruction.op {
                    Op::Unary(op, a) => (op.mnemonic(), ty_of(a)),
                    Op::Binary(op, a, _) => (op.mnemonic(), ty_of(a)),
                    Op::Compare(op, a, _) => (op.mnemonic(), ty_of(a)),
                    Op::Select(_, a, _) => ("select", ty_of(a)),
                    Op::Convert(a) => ("convert", ty_of(a)),
                    Op::Reinterpret(a) => ("reinterpret", ty_of(a)),
                    Op::Call(helper, a, _) => (helper.mnemonic(), ty_of(a)),
                    Op::Load(_) => ("load", instruction.ty),
                    Op::LoadIndexed(..) => ("load_indexed", instruction.ty),
                    Op::StoreIndexed(..) => ("store_indexed", instruction.ty),
                    Op::CopyArray(..) => ("copy_array", instruction.ty),
                    Op::Store(..) => ("store", instruction.ty),
                    Op::Constant(_) => ("constant", instruction.ty),
                    Op::Now => ("now", instruction.ty),
                });
            }
        }
        let mut expected: Vec<(&str, Domain)> = Vec::new();
        expected.extend(Unary::ALL.iter().map(|op| (op.mnemonic(), op.domain())));
        expected.extend(Binary::ALL.iter().map(|op| (op.mnemonic(), op.domain())));
        expected.extend(Compare::ALL.iter().map(|op| (op.mnemonic(), op.domain())));
        expected.extend(Helper::ALL.iter().map(|helper| (helper.mnemonic(), helper.domain())));
        expected.extend(["load_indexed", "store_indexed", "copy_array"].map(|name| (name, Domain::Any)));
        let others = ["select", "convert", "reinterpret", "load", "store", "constant"];
        expected.extend(others.map(|name| (name, Domain::Any)));
        for (name, domain) in expected {
            for ty in Elementary::ALL.into_iter().filter(|ty| domain.contains(*ty)) {
                assert!(seen.contains(&(name, ty)), "{name} {ty} never occurs");
            }
        }
        assert!(seen.contains(&("now", Elementary::Time)));
    }
}
