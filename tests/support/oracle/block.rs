//! The standard function blocks, each as the little machine that the semantics describe.

use rung::elementary::{Elementary, Value};
use rung::ladder::library::{Pin, StandardBlock};

use super::analog::{Derivative, Pid, PidInputs, Ramp, hysteresis, integral};
use super::register_machine::{Direction, Machine};
use super::storage::Register;

/// One instance: its pins and what it remembers.
#[derive(Clone, Debug)]
pub(crate) struct Instance {
    block: StandardBlock,
    /// What its inputs were given last; at first the pin's default.
    pub inputs: Vec<Register>,
    /// What its outputs hold; at first 0.
    pub outputs: Vec<Register>,
    /// For each input what it stands for in this call, if it is a reference: the variable, or the element and all behind it.
    pub references: Vec<Vec<Register>>,
    state: State,
    start: i64,
    /// For a timer last scan's IN; for others the memory of the rising edge of each BOOL input.
    previous: [bool; 2],
    derivative: Derivative,
    pid: Pid,
    ramp: Ramp,
    pub(super) machine: Machine,
}

/// Where a timer is.
#[derive(Clone, Copy, PartialEq, Debug)]
enum State {
    Idle,
    Timing,
    Expired,
}

impl Instance {
    /// An instance that never ran.
    pub(crate) fn new(block: StandardBlock) -> Self {
        let registers = |pins: &[Pin]| pins.iter().map(|pin| Register::new(pin.initial_value())).collect();
        Self {
            block,
            inputs: registers(block.inputs()),
            outputs: registers(block.outputs()),
            references: vec![Vec::new(); block.inputs().len()],
            state: State::Idle,
            start: 0,
            previous: [false; 2],
            derivative: Derivative::default(),
            pid: Pid::default(),
            ramp: Ramp::default(),
            machine: Machine::default(),
        }
    }

    /// Runs it once on the inputs that it has.
    pub(crate) fn execute(&mut self, now: i64) {
        match self.block {
            StandardBlock::Ton => self.on_delay(now),
            StandardBlock::Tof => self.off_delay(now),
            StandardBlock::Tp => self.pulse(now),
            StandardBlock::Tonr => self.retentive_on_delay(now),
            StandardBlock::Ctu
            | StandardBlock::CtuInt
            | StandardBlock::CtuDint
            | StandardBlock::CtuLint
            | StandardBlock::CtuUdint
            | StandardBlock::CtuUlint => self.count_up(),
            StandardBlock::Ctd
            | StandardBlock::CtdInt
            | StandardBlock::CtdDint
            | StandardBlock::CtdLint
            | StandardBlock::CtdUdint
            | StandardBlock::CtdUlint => self.count_down(),
            StandardBlock::Ctud
            | StandardBlock::CtudInt
            | StandardBlock::CtudDint
            | StandardBlock::CtudLint
            | StandardBlock::CtudUdint
            | StandardBlock::CtudUlint => self.count_up_and_down(),
            StandardBlock::Tt => self.machine_timer(100_000_000, now),
            StandardBlock::Ts => self.machine_timer(1_000_000_000, now),
            StandardBlock::Uc => self.machine_up_counter(),
            StandardBlock::Dc => self.machine_down_counter(),
            StandardBlock::Dr => self.machine_drum(),
            StandardBlock::Shiftl => self.machine_shift(Direction::Left),
            StandardBlock::Shiftr => self.machine_shift(Direction::Right),
            StandardBlock::Bs => self.machine_bit(true),
            StandardBlock::Bc => self.machine_bit(false),
            StandardBlock::RTrig => {
                let rises = self.rises(0, 0);
                self.put_bool(0, rises);
            }
            StandardBlock::FTrig => {
                // Q := NOT CLK AND NOT M; M := NOT CLK.
                let open = !self.bool(0);
                self.put_bool(0, open && !self.previous[0]);
                self.previous[0] = open;
            }
            StandardBlock::Sr => {
                let q1 = self.bool(0) || (!self.bool(1) && self.outputs[0].get().is_true());
                self.put_bool(0, q1);
            }
            StandardBlock::Integral => {
                self.put_bool(0, !self.bool(1));
                let held = real(self.outputs[1].get());
                let xout = integral(held, self.bool(0), self.bool(1), self.real(2), self.real(3), self.time(4));
                self.put_real(1, xout);
            }
            StandardBlock::Derivative => {
                let (run, xin, cycle) = (self.bool(0), self.real(1), self.time(2));
                let xout = self.derivative.run(run, xin, cycle);
                self.put_real(0, xout);
            }
            StandardBlock::Pid => {
                let [pv, sp, x0, kp, tr, td] = [1, 2, 3, 4, 5, 6].map(|pin| self.real(pin));
                let inputs = PidInputs { auto: self.bool(0), pv, sp, x0, kp, tr, td, cycle: self.time(7) };
                let xout = self.pid.run(&inputs);
                self.put_real(0, xout);
            }
            StandardBlock::Ramp => {
                let (run, x0, x1, tr, cycle) = (self.bool(0), self.real(1), self.real(2), self.time(3), self.time(4));
                let (busy, xout) = self.ramp.run(run, x0, x1, tr, cycle);
                self.put_bool(0, busy);
                self.put_real(1, xout);
            }
            StandardBlock::Hysteresis => {
                let q = hysteresis(self.outputs[0].get().is_true(), self.real(0), self.real(1), self.real(2));
                self.put_bool(0, q);
            }
            StandardBlock::Sema => {
                let taken = self.bool(0) || (self.outputs[0].get().is_true() && !self.bool(1));
                self.put_bool(0, taken);
            }
            StandardBlock::Rs => {
                let q1 = !self.bool(1) && (self.bool(0) || self.outputs[0].get().is_true());
                self.put_bool(0, q1);
            }
        }
    }

    fn on_delay(&mut self, now: i64) {
        let input = self.bool(0);
        if self.state == State::Idle && input && !self.previous[0] {
            self.begin(now);
            self.put_bool(0, false);
            self.put_elapsed(0);
        } else if !input {
            self.state = State::Idle;
            self.put_bool(0, false);
            self.put_elapsed(0);
        } else if self.state == State::Timing && self.time_is_up(now) {
            self.put_bool(0, true);
        }
        self.previous[0] = input;
    }

    fn off_delay(&mut self, now: i64) {
        let input = self.bool(0);
        if self.state == State::Idle && !input && self.previous[0] {
            self.begin(now);
        } else if input {
            self.state = State::Idle;
            self.put_bool(0, true);
            self.put_elapsed(0);
        } else if self.state == State::Timing && self.time_is_up(now) {
            self.put_bool(0, false);
        }
        self.previous[0] = input;
    }

    fn pulse(&mut self, now: i64) {
        let input = self.bool(0);
        if self.state == State::Idle && input && !self.previous[0] {
            self.begin(now);
            self.put_bool(0, true);
        } else if self.state == State::Timing && self.time_is_up(now) {
            self.put_bool(0, false);
        }
        if self.state == State::Expired && !input {
            self.state = State::Idle;
            self.put_elapsed(0);
        }
        self.previous[0] = input;
    }

    /// Idle: neither input is on. Timing: IN without R. Expired: until R. `start` is when it last ran.
    fn retentive_on_delay(&mut self, now: i64) {
        let was_timing = self.state == State::Timing;
        if self.bool(1) {
            self.state = State::Idle;
            self.put_bool(0, false);
            self.put_elapsed(0);
        } else if self.state != State::Expired {
            self.state = if self.bool(0) { State::Timing } else { State::Idle };
            if was_timing && self.state == State::Timing {
                let passed = i128::from(now) - i128::from(self.start);
                let elapsed = self.output(1) + passed.max(0);
                let preset = self.integer(2);
                if elapsed >= preset {
                    self.state = State::Expired;
                    self.put_bool(0, true);
                }
                let elapsed = i64::try_from(elapsed.min(preset)).expect("PT is a TIME");
                self.put_elapsed(elapsed);
            }
        }
        self.start = now;
    }

    fn begin(&mut self, now: i64) {
        self.state = State::Timing;
        self.start = now;
    }

    /// The step of every timing timer: expires, or tells how long it has been timing.
    fn time_is_up(&mut self, now: i64) -> bool {
        let preset = self.time(1);
        let up = i128::from(self.start) + i128::from(preset) <= i128::from(now);
        if up {
            self.state = State::Expired;
            self.put_elapsed(preset);
        } else {
            self.put_elapsed(now - self.start);
        }
        up
    }

    fn count_up(&mut self) {
        let up = self.rises(0, 0);
        let (reset, preset, mut count) = (self.bool(1), self.integer(2), self.output(1));
        if reset {
            count = 0;
        } else if up && count < preset {
            count += 1;
        }
        self.put_bool(0, count >= preset);
        self.put_count(1, count);
    }

    fn count_down(&mut self) {
        let down = self.rises(0, 0);
        let (load, preset, mut count) = (self.bool(1), self.integer(2), self.output(1));
        if load {
            count = preset;
        } else if down && count > 0 {
            count -= 1;
        }
        self.put_bool(0, count <= 0);
        self.put_count(1, count);
    }

    fn count_up_and_down(&mut self) {
        let up = self.rises(0, 0);
        let down = self.rises(1, 1);
        let (reset, load, preset, mut count) = (self.bool(2), self.bool(3), self.integer(4), self.output(2));
        if reset {
            count = 0;
        } else if load {
            count = preset;
        } else if up && down {
            // Both edges in one scan: no change.
        } else if up && count < preset {
            count += 1;
        } else if down && count > 0 {
            count -= 1;
        }
        self.put_bool(0, count >= preset);
        self.put_bool(1, count <= 0);
        self.put_count(2, count);
    }

    /// R_TRIG on an input: Q := CLK AND NOT M; M := CLK.
    pub(super) fn rises(&mut self, input: usize, memory: usize) -> bool {
        let clock = self.bool(input);
        let rises = clock && !self.previous[memory];
        self.previous[memory] = clock;
        rises
    }

    /// The register at a place from the one on that a reference stands for; one that is beyond the array reads 0.
    pub(super) fn register(&self, input: usize, place: usize) -> u16 {
        let bits = self.references[input].get(place).map_or(0, |register| register.get().bits());
        u16::try_from(bits).expect("a register is a WORD")
    }

    /// Writes that register; what is beyond the array is lost.
    pub(super) fn put_register(&self, input: usize, place: usize, value: u16) {
        if let Some(register) = self.references[input].get(place) {
            register.set(Value::from_bits(Elementary::Word, value.into()));
        }
    }

    pub(super) fn bool(&self, input: usize) -> bool {
        self.inputs[input].get().is_true()
    }

    pub(super) fn integer(&self, input: usize) -> i128 {
        self.inputs[input].get().as_integer().expect("the input is no REAL")
    }

    pub(super) fn time(&self, input: usize) -> i64 {
        i64::try_from(self.integer(input)).expect("a TIME has 64 bits")
    }

    pub(super) fn real(&self, input: usize) -> f32 {
        real(self.inputs[input].get())
    }

    pub(super) fn output(&self, output: usize) -> i128 {
        self.outputs[output].get().as_integer().expect("the output is no REAL")
    }

    pub(super) fn put_bool(&self, output: usize, value: bool) {
        self.outputs[output].set(Value::bool(value));
    }

    pub(super) fn put_real(&self, output: usize, value: f32) {
        self.outputs[output].set(Value::from_bits(Elementary::Real, u64::from(value.to_bits())));
    }

    /// A timer's ET.
    fn put_elapsed(&self, nanoseconds: i64) {
        self.outputs[1].set(Value::time(nanoseconds));
    }

    pub(super) fn put_count(&self, output: usize, count: i128) {
        let ty = self.outputs[output].get().ty();
        self.outputs[output].set(Value::integer(ty, count).expect("a count stays between 0 and PV"));
    }
}

/// The number of a REAL, with the bits of a NaN.
fn real(value: Value) -> f32 {
    f32::from_bits(u32::try_from(value.bits()).expect("a REAL has 32 bits"))
}
