//! The register machine's blocks on plain numbers: timers as machines with states, registers shifted bit by bit.

use super::block::Instance;

/// The greatest preset and value of timers and counters.
const DIGITS: u64 = 9999;
/// The greatest of a drum.
const DRUM: u64 = 2047;

/// What is wired to a TT or TS.
struct TimerInputs {
    timing: bool,
    enable: bool,
    kind: u64,
    preset: u64,
}

/// Where a timer is.
#[derive(Clone, Copy, PartialEq, Debug, Default)]
enum Phase {
    /// The coil of an off-delay or interval is off.
    #[default]
    Off,
    /// An off-delay's timing circuit conducts.
    Conducting,
    /// Time passes.
    Timing,
}

/// A TT or TS.
#[derive(Clone, Debug, Default)]
struct Timer {
    phase: Phase,
    /// The actual value in nanoseconds.
    actual: i128,
    /// The time of the last run.
    last: i64,
    /// The timing circuit in the last run.
    circuit: bool,
}

impl Timer {
    /// The coil, and the actual value in whole units.
    fn run(&mut self, inputs: &TimerInputs, unit: i128, now: i64) -> (bool, u64) {
        let preset = i128::from(inputs.preset.min(DIGITS)) * unit;
        let rises = inputs.timing && !self.circuit;
        let coil = if !inputs.enable {
            self.phase = Phase::Off;
            self.actual = 0;
            false
        } else {
            match inputs.kind {
                0 => self.off_delay(inputs.timing, preset, now),
                1 => self.on_delay(inputs.timing, preset, now),
                _ => self.interval(rises, preset, now),
            }
        };
        self.last = now;
        self.circuit = inputs.timing;
        (coil, u64::try_from(self.actual / unit).expect("an actual value is between 0 and 9999"))
    }

    fn on_delay(&mut self, timing: bool, preset: i128, now: i64) -> bool {
        if !timing {
            self.phase = Phase::Off;
        } else if self.phase == Phase::Timing {
            self.add_time(preset, now);
        } else {
            self.phase = Phase::Timing;
        }
        self.actual >= preset
    }

    fn off_delay(&mut self, timing: bool, preset: i128, now: i64) -> bool {
        if timing {
            self.phase = Phase::Conducting;
            self.actual = 0;
            return true;
        }
        match self.phase {
            Phase::Off => {}
            Phase::Conducting => self.phase = Phase::Timing,
            Phase::Timing => self.add_time(preset, now),
        }
        self.unless_over(preset)
    }

    fn interval(&mut self, rises: bool, preset: i128, now: i64) -> bool {
        if self.phase == Phase::Timing {
            self.add_time(preset, now);
        } else if rises {
            self.phase = Phase::Timing;
            self.actual = 0;
        }
        self.unless_over(preset)
    }

    /// The coil of what goes off at the preset.
    fn unless_over(&mut self, preset: i128) -> bool {
        if self.actual >= preset {
            self.phase = Phase::Off;
        }
        self.phase == Phase::Timing
    }

    /// What passed since the last run, up to the preset.
    fn add_time(&mut self, preset: i128, now: i64) {
        let passed = i128::from(now) - i128::from(self.last);
        if passed > 0 && self.actual < preset {
            self.actual = (self.actual + passed).min(preset);
        }
    }
}

/// An UC, or the counter of a DR.
#[derive(Clone, Debug, Default)]
struct UpCounter {
    actual: u64,
    circuit: bool,
}

impl UpCounter {
    fn count(&mut self, circuit: bool, enable: bool, most: u64) {
        let rises = circuit && !self.circuit;
        self.circuit = circuit;
        if !enable {
            self.actual = 0;
        } else if rises && self.actual < most {
            self.actual += 1;
        }
    }

    /// The coil and the actual value of an UC.
    fn run(&mut self, circuit: bool, enable: bool, preset: u64) -> (bool, u64) {
        self.count(circuit, enable, DIGITS);
        (enable && self.actual >= preset.min(DIGITS), self.actual)
    }

    /// The coil, the actual value and the taps of a DR.
    fn drum(&mut self, step: bool, enable: bool, preset: u64, taps: &[u64]) -> (bool, u64, Vec<bool>) {
        self.count(step, enable, DRUM);
        let taps = taps.iter().map(|tap| enable && self.actual >= *tap).collect();
        (enable && self.actual >= preset.min(DRUM), self.actual, taps)
    }
}

/// A DC.
#[derive(Clone, Debug, Default)]
struct DownCounter {
    /// None before the first run.
    actual: Option<u64>,
    circuit: bool,
}

impl DownCounter {
    /// The coil and the actual value.
    fn run(&mut self, circuit: bool, enable: bool, preset: u64) -> (bool, u64) {
        let preset = preset.min(DIGITS);
        let rises = circuit && !self.circuit;
        self.circuit = circuit;
        let mut actual = self.actual.unwrap_or(preset);
        if !enable {
            actual = preset;
        } else if rises && actual > 0 {
            actual -= 1;
        }
        self.actual = Some(actual);
        (enable && actual == 0, actual)
    }
}

/// Which way registers are shifted.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) enum Direction {
    Left,
    Right,
}

/// What is wired to a SHIFTL or SHIFTR.
struct ShiftInputs {
    shift: bool,
    data: bool,
    enable: bool,
    count: u64,
}

/// A SHIFTL or SHIFTR.
#[derive(Clone, Debug, Default)]
struct Shift {
    coil: bool,
    circuit: bool,
}

impl Shift {
    /// The coil. The registers, the lowest first, are all that are in the chain.
    fn run(&mut self, inputs: &ShiftInputs, direction: Direction, registers: &mut [u16]) -> bool {
        let rises = inputs.shift && !self.circuit;
        self.circuit = inputs.shift;
        if !inputs.enable {
            registers.fill(0);
            self.coil = false;
        } else if rises {
            for _ in 0..inputs.count.clamp(1, 15) {
                self.coil = one_place(direction, inputs.data, registers);
            }
        }
        self.coil
    }
}

/// Shifts by one place and gives the bit that left.
fn one_place(direction: Direction, data: bool, registers: &mut [u16]) -> bool {
    // From the lowest bit to the highest.
    let mut bits: Vec<bool> =
        registers.iter().flat_map(|register| (0..16).map(move |bit| register >> bit & 1 == 1)).collect();
    let left = match direction {
        Direction::Left => {
            bits.insert(0, data);
            bits.pop()
        }
        Direction::Right => {
            bits.push(data);
            Some(bits.remove(0))
        }
    };
    for (register, bits) in registers.iter_mut().zip(bits.chunks(16)) {
        *register = bits.iter().rev().fold(0, |register, bit| register << 1 | u16::from(*bit));
    }
    left.expect("a chain has a register")
}

/// The coil of a BS, which `sets` a bit of a register, or of a BC, which clears it.
fn bit(power: bool, sets: bool, bit: u64, register: &mut u16) -> bool {
    if bit > 15 {
        return false;
    }
    let mask = 1 << bit;
    if power && sets {
        *register |= mask;
    } else if power {
        *register &= !mask;
    }
    (*register & mask != 0) == sets
}

/// What a block of the register machine remembers.
#[derive(Clone, Debug, Default)]
pub(super) struct Machine {
    timer: Timer,
    up: UpCounter,
    down: DownCounter,
    shift: Shift,
}

impl Instance {
    /// A TT or TS that counts units of so many nanoseconds.
    pub(super) fn machine_timer(&mut self, unit: i128, now: i64) {
        let (timing, enable) = (self.bool(0), self.bool(1));
        let inputs = TimerInputs { timing, enable, kind: self.number(2), preset: self.number(3) };
        let (coil, actual) = self.machine.timer.run(&inputs, unit, now);
        self.put_counter(coil, actual);
    }

    pub(super) fn machine_up_counter(&mut self) {
        let (circuit, enable, preset) = (self.bool(0), self.bool(1), self.number(2));
        let (coil, actual) = self.machine.up.run(circuit, enable, preset);
        self.put_counter(coil, actual);
    }

    pub(super) fn machine_down_counter(&mut self) {
        let (circuit, enable, preset) = (self.bool(0), self.bool(1), self.number(2));
        let (coil, actual) = self.machine.down.run(circuit, enable, preset);
        self.put_counter(coil, actual);
    }

    pub(super) fn machine_drum(&mut self) {
        let (step, enable, preset) = (self.bool(0), self.bool(1), self.number(2));
        let taps: Vec<u64> = (3..19).map(|tap| self.number(tap)).collect();
        let (coil, actual, taps) = self.machine.up.drum(step, enable, preset, &taps);
        self.put_counter(coil, actual);
        for (tap, on) in taps.into_iter().enumerate() {
            self.put_bool(2 + tap, on);
        }
    }

    pub(super) fn machine_shift(&mut self, direction: Direction) {
        let (shift, data, enable, count) = (self.bool(0), self.bool(1), self.bool(2), self.number(3));
        let length = usize::try_from(self.number(5)).expect("at most 32");
        let mut registers: Vec<u16> = (0..length).map(|place| self.register(4, place)).collect();
        let coil = self.machine.shift.run(&ShiftInputs { shift, data, enable, count }, direction, &mut registers);
        for (place, register) in registers.into_iter().enumerate() {
            self.put_register(4, place, register);
        }
        self.put_bool(0, coil);
    }

    /// A BS, or a BC.
    pub(super) fn machine_bit(&mut self, sets: bool) {
        let mut register = self.register(1, 0);
        let coil = bit(self.bool(0), sets, self.number(2), &mut register);
        self.put_register(1, 0, register);
        self.put_bool(0, coil);
    }

    fn number(&self, input: usize) -> u64 {
        u64::try_from(self.integer(input)).expect("the input is a WORD or USINT")
    }

    fn put_counter(&mut self, coil: bool, actual: u64) {
        self.put_bool(0, coil);
        self.put_count(1, actual.into());
    }
}
