//! Random ladder-like logic: rungs of one to three branches of one to five contacts, one on-delay timer per six rungs.

use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;
use rung::elementary::{Elementary, Value};
use rung::logic::{Area, Binary, Builder, Compare, LayoutBuilder, Origin, Program, Slot, SlotId, ValueId};

/// A program of so many rungs; contacts refer to inputs, coils and timers at random. One seed, one program.
pub(crate) fn workload(rungs: usize) -> Program {
    let mut rng = Pcg64::seed_from_u64(rungs as u64);
    let mut layout = LayoutBuilder::new();
    let mut slot = |name: String, ty, area| {
        layout.slot(Slot { name, ty, offset: 0, area, retain: false, initial: Value::default_of(ty), line: 0 })
    };
    let inputs: Vec<SlotId> =
        (0..rungs.div_ceil(2)).map(|i| slot(format!("i{i}"), Elementary::Bool, Area::Input)).collect();
    let coils: Vec<SlotId> = (0..rungs).map(|i| slot(format!("c{i}"), Elementary::Bool, Area::Output)).collect();
    let timers: Vec<Timer> = (0..rungs / 6)
        .map(|i| Timer {
            q: slot(format!("t{i}.Q"), Elementary::Bool, Area::State),
            previous: slot(format!("t{i}.previous"), Elementary::Bool, Area::State),
            start: slot(format!("t{i}.start"), Elementary::Time, Area::State),
            elapsed: slot(format!("t{i}.ET"), Elementary::Time, Area::State),
        })
        .collect();
    let contacts: Vec<SlotId> =
        inputs.iter().chain(&coils).copied().chain(timers.iter().map(|timer| timer.q)).collect();
    let layout = layout.finish(None).expect("a small image");
    let mut logic = Builder::new(format!("{rungs}_rungs"), layout);
    for (rung, coil) in coils.iter().enumerate() {
        let mut power: Option<ValueId> = None;
        for _ in 0..rng.random_range(1..=3) {
            let mut branch = logic.bool(true);
            for _ in 0..rng.random_range(1..=5) {
                let contact = logic.load(contacts[rng.random_range(0..contacts.len())]);
                let conducts = if rng.random_bool(0.5) { logic.not(contact) } else { contact };
                branch = logic.and(branch, conducts);
            }
            power = Some(power.map_or(branch, |other| logic.or(other, branch)));
        }
        let mut power = power.unwrap_or_else(|| logic.bool(true));
        if let Some(timer) = timers.get(rung / 6).filter(|_| rung % 6 == 5) {
            power = timer.on_delay(&mut logic, power, rng.random_range(1..1000));
        }
        logic.store(*coil, power);
        logic.end_section(Origin { label: format!("r{rung}"), line: 0 });
    }
    logic.finish()
}

struct Timer {
    q: SlotId,
    previous: SlotId,
    start: SlotId,
    elapsed: SlotId,
}

impl Timer {
    /// An on-delay timer, as lowering expands it.
    fn on_delay(&self, logic: &mut Builder, on: ValueId, milliseconds: i64) -> ValueId {
        let (was_on, q) = (logic.load(self.previous), logic.load(self.q));
        let (now, start) = (logic.now(), logic.load(self.start));
        let preset = logic.constant(Value::time(milliseconds * 1_000_000));
        let elapsed = logic.binary(Binary::Subtract, now, start);
        let due = logic.compare(Compare::GreaterOrEqual, elapsed, preset);
        let stays_on = logic.and(on, was_on);
        let expired = logic.or(q, due);
        let new_q = logic.and(stays_on, expired);
        let et = logic.load(self.elapsed);
        let running = logic.select(due, preset, elapsed);
        let held = logic.select(q, et, running);
        let zero = logic.constant(Value::time(0));
        let new_et = logic.select(stays_on, held, zero);
        let new_start = logic.select(was_on, start, now);
        logic.store(self.start, new_start);
        logic.store(self.previous, on);
        logic.store(self.q, new_q);
        logic.store(self.elapsed, new_et);
        new_q
    }
}
