//! Lanes against the interpreter, the whole image of every lane after every scan.

use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;
use rung_runtime::Scan;

use super::*;
use crate::elementary::Elementary;
use crate::engine::interp::Interpreter;
use crate::logic::{Area, Binary, Builder, Compare, Origin, Slot, SlotId, ValueId, random};

/// Lanes that are looked at: some in each of two vectors. An image of each costs far more than its scan.
const TESTED: usize = 130;

/// A program in lanes, and as many interpreted images.
struct Rig<'p> {
    program: &'p Program,
    lanes: Lanes,
    group: Group,
    interpreter: Interpreter,
    images: Vec<Vec<u8>>,
}

impl<'p> Rig<'p> {
    fn new(program: &'p Program, recognises: bool, wide: bool) -> Self {
        let lanes = Lanes::compile_as(program, recognises, wide).expect("code for this machine");
        let group = lanes.group(TESTED);
        let images = vec![program.layout.initial_image(); TESTED];
        Self { program, lanes, group, interpreter: Interpreter::new(program), images }
    }

    fn slots(&self) -> impl Iterator<Item = (SlotId, &'p Slot)> + use<'p> {
        (0..).map(SlotId).zip(self.program.layout.slots())
    }

    /// Sets a slot in a lane and in its image, unless lanes refuse it.
    fn set(&mut self, lane: usize, slot: SlotId, value: Value) {
        if self.lanes.set(&mut self.group, lane, slot, value).is_ok() {
            self.program.layout.slot(slot).write(&mut self.images[lane], value);
        }
    }

    fn scan(&mut self, now: i64) {
        self.lanes.scan(&mut self.group, now).expect("times that go on");
        self.images.iter_mut().for_each(|image| self.interpreter.scan(image, now));
        self.compare(now);
    }

    fn compare(&self, now: i64) {
        for (lane, image) in self.images.iter().enumerate() {
            for (id, slot) in self.slots() {
                let (found, expected) = (self.lanes.get(&self.group, lane, id), slot.read(image));
                assert_eq!(
                    found,
                    expected,
                    "`{}` of {} in lane {lane}, scan {} at {now} ns, which is {:?} in\n{}",
                    slot.name,
                    self.program.name,
                    self.group.history.last(),
                    self.lanes.plan.homes[id.index()],
                    crate::logic::print(self.program),
                );
            }
        }
    }
}

/// A time not before the last: mostly equal steps, some of none, some large.
fn later(rng: &mut Pcg64, now: i64) -> i64 {
    now.saturating_add(match rng.random_range(0..20) {
        0 => 0,
        1 => 1,
        2 => rng.random_range(0..100),
        3 => rng.random_range(0..3000),
        _ => 10,
    })
}

#[test]
fn every_operation_computes_in_every_lane_what_the_interpreter_says() {
    let mut compared = 0;
    for seed in 0..200 {
        let program = random::program(seed);
        if touches_turns(&program) {
            assert!(Lanes::compile(&program).is_err());
            continue;
        }
        compared += 1;
        let mut rig = Rig::new(&program, seed % 4 != 0, seed % 3 != 0);
        let mut rng = Pcg64::seed_from_u64(seed);
        for lane in 0..TESTED {
            let image = random::image(&program.layout, seed * 1000 + lane as u64);
            for (id, slot) in rig.slots() {
                rig.set(lane, id, slot.read(&image));
            }
        }
        rig.compare(-1);
        let mut now = 0;
        for scan in 0..6 {
            for (id, slot) in rig.slots().filter(|(_, slot)| slot.area == Area::Input) {
                for lane in 0..TESTED {
                    let image = random::image(&program.layout, rng.random());
                    if rng.random_bool(0.1) {
                        rig.set(lane, id, slot.read(&image));
                    }
                }
            }
            rig.scan(now);
            now = if scan == 4 { i64::MAX } else { later(&mut rng, now) };
        }
    }
    assert!(compared > 100, "only {compared} programs were compared");
}

/// A program that is full of latches, of questions about them and of what is computed from them.
fn latches(seed: u64) -> Program {
    let mut rng = Pcg64::seed_from_u64(seed);
    let mut layout = LayoutBuilder::new();
    let mut slot = |name: String, ty, area, initial: u64| {
        let initial = Value::from_bits(ty, initial);
        layout.slot(Slot { name: name.into(), ty, offset: 0, area, retain: false, initial, line: 0 })
    };
    let inputs: Vec<SlotId> = (0..6).map(|i| slot(format!("i{i}"), Elementary::Bool, Area::Input, 0)).collect();
    let outputs: Vec<SlotId> = (0..12).map(|q| slot(format!("q{q}"), Elementary::Bool, Area::Output, 0)).collect();
    let starts: Vec<SlotId> = (0..4).map(|l| slot(format!("start{l}"), Elementary::Time, Area::State, 0)).collect();
    let elapsed: Vec<SlotId> =
        (0..5).map(|e| slot(format!("elapsed{e}"), Elementary::Time, Area::Memory, e * 7)).collect();
    let number = slot("number".to_owned(), Elementary::Int, Area::Memory, 3);
    let due = slot("due".to_owned(), Elementary::Time, Area::State, 0);
    let mut builder = Builder::new(format!("latches_{seed}"), layout.finish(None).expect("few slots"));
    let presets = [i64::MIN, -5, 0, 1, 10, 20, 55, 100, 160, 170, 400, 2000, 6000, 100_000, i64::MAX];
    let conditions = |builder: &mut Builder, rng: &mut Pcg64| -> Vec<ValueId> {
        let mut bits: Vec<ValueId> = inputs.iter().chain(&outputs[..4]).map(|slot| builder.load(*slot)).collect();
        for _ in 0..4 {
            let [a, b] = [0; 2].map(|_| bits[rng.random_range(0..bits.len())]);
            let made = if rng.random_bool(0.5) { builder.and(a, b) } else { builder.not(a) };
            bits.push(made);
        }
        bits
    };
    for (index, start) in starts.iter().enumerate() {
        let bits = conditions(&mut builder, &mut rng);
        let mut bit = || bits[rng.random_range(0..bits.len())];
        let [when, guard] = [bit(), bit()];
        let mut choices: Vec<ValueId> = (0..12).map(|_| bit()).collect();
        let (now, old) = (builder.now(), builder.load(*start));
        let passed = builder.binary(Binary::Subtract, now, old);
        for (question, output) in outputs[4 + index * 2..][..2].iter().enumerate() {
            let preset = builder.constant(Value::time(presets[rng.random_range(0..presets.len())]));
            let op = Compare::ALL[if question == 0 { rng.random_range(2..6) } else { 5 }];
            let (a, b) = if rng.random_bool(0.2) { (preset, passed) } else { (passed, preset) };
            let answer = builder.compare(op, a, b);
            builder.store(*output, answer);
            choices.push(answer);
        }
        // One or two slots with what has passed, in choices of any shape.
        for slot in elapsed.iter().skip(index).take(1 + usize::from(index == 3)) {
            let mut values = vec![passed, builder.load(*slot)];
            values.push(builder.constant(Value::time(rng.random_range(0..3) * 50)));
            values.push(if rng.random_bool(0.5) { now } else { builder.constant(Value::time(5)) });
            for _ in 0..rng.random_range(1..6) {
                let [a, b] = [0; 2].map(|_| values[rng.random_range(0..values.len())]);
                let condition = choices[rng.random_range(0..choices.len())];
                values.push(builder.select(condition, a, b));
            }
            let made = values.pop().expect("at least one");
            builder.store(*slot, made);
        }
        let set = if rng.random_bool(0.7) { builder.select(when, now, old) } else { builder.select(when, old, now) };
        let set = if rng.random_bool(0.3) { builder.select(guard, set, old) } else { set };
        builder.store(*start, set);
        if index == 1 {
            let (ten, old) = (builder.constant(Value::from_bits(Elementary::Int, 10)), builder.load(number));
            let made = builder.select(when, ten, old);
            builder.store(number, made);
        }
        builder.end_section(Origin { label: format!("r{index}").into(), line: 0 });
        if index == 0 && rng.random_bool(0.3) {
            builder.end_task("slow", Some(25), Some(due));
        }
    }
    // Without what is made and not used, which would count as a use.
    crate::opt::optimise(builder.finish())
}

#[test]
fn what_is_tracked_is_exact_in_every_lane_whatever_the_times_and_choices() {
    let (mut tracked, mut asked) = (0, 0);
    for seed in 0..120 {
        let program = latches(seed);
        let mut rig = Rig::new(&program, true, seed % 3 != 0);
        tracked += rig.lanes.plan.tracks.len();
        asked += rig.lanes.plan.presets.iter().map(|preset| preset.stamps.len()).sum::<usize>();
        let mut rng = Pcg64::seed_from_u64(seed);
        // Inputs that change often, and ones that hardly do.
        let flips = [0.5, 0.2, 0.05, 0.02, 0.01, 0.004];
        let mut now = [0, 0, 1 << 62][rng.random_range(0..3)];
        for scan in 0..300 {
            for (input, flips) in (0..).map(SlotId).zip(flips) {
                for lane in 0..TESTED {
                    if rng.random_bool(flips) {
                        let value = rig.lanes.get(&rig.group, lane, input);
                        rig.set(lane, input, Value::bool(!value.is_true()));
                    }
                }
            }
            if scan % 37 == 36 {
                for (id, slot) in rig.slots() {
                    let value = Value::from_bits(slot.ty, rng.random());
                    rig.set(rng.random_range(0..TESTED), id, value);
                }
            }
            // Comparing costs far more than scanning.
            if scan % 5 == 0 || scan < 40 {
                rig.scan(now);
            } else {
                rig.lanes.scan(&mut rig.group, now).expect("times that go on");
                rig.images.iter_mut().for_each(|image| rig.interpreter.scan(image, now));
            }
            now = later(&mut rng, now);
        }
    }
    assert!(tracked > 120 * 6 && asked > 120 * 5, "only {tracked} slots were tracked, and {asked} answers asked for");
}

#[test]
fn what_is_tracked_is_exact_over_many_epochs_of_steps_that_are_mostly_equal() {
    for seed in 0..9 {
        let program = latches(seed);
        let mut rig = Rig::new(&program, true, seed % 3 != 0);
        let mut rng = Pcg64::seed_from_u64(seed);
        let mut now = 0;
        for scan in 0..1400 {
            for (input, flips) in (0..).map(SlotId).zip([0.3, 0.1, 0.02, 0.01, 0.003, 0.002]) {
                for lane in 0..TESTED {
                    if rng.random_bool(flips) {
                        let value = rig.lanes.get(&rig.group, lane, input);
                        rig.set(lane, input, Value::bool(!value.is_true()));
                    }
                }
            }
            rig.lanes.scan(&mut rig.group, now).expect("times that go on");
            rig.images.iter_mut().for_each(|image| rig.interpreter.scan(image, now));
            if scan % 53 == 52 {
                rig.compare(now);
            }
            now = if rng.random_bool(0.005) { later(&mut rng, now) } else { now + 10 };
        }
    }
}

#[test]
fn a_time_that_goes_back_is_refused_and_nothing_done() {
    let program = latches(1);
    let mut rig = Rig::new(&program, true, true);
    rig.scan(1000);
    assert_eq!(rig.lanes.scan(&mut rig.group, 999), Err(Refused));
    rig.compare(1000);
    rig.scan(1000);
}

#[test]
fn what_a_latch_holds_and_when_a_task_is_due_cannot_be_set_to_something_else() {
    let program = latches(1);
    let mut rig = Rig::new(&program, true, true);
    let Home::Tracked(0) = rig.lanes.plan.homes[18] else { panic!("{:?}", rig.lanes.plan.homes) };
    let start = SlotId(18);
    assert_eq!(rig.lanes.set(&mut rig.group, 3, start, Value::time(5)), Err(Refused));
    assert_eq!(rig.lanes.set(&mut rig.group, 3, start, Value::time(0)), Ok(()));
    rig.compare(0);
}
