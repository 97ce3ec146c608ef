//! The blocks on REAL: what matiec's `*_st.txt` compute, on plain numbers.
//!
//! Every operation rounds to REAL. What is copied keeps its bits, also those of a NaN; what an operation makes
//! has the one NaN.

/// XOUT of an INTEGRAL that held `xout`.
pub(super) fn integral(xout: f32, run: bool, r1: bool, xin: f32, x0: f32, cycle: i64) -> f32 {
    if r1 {
        x0
    } else if run {
        one_nan(xout + xin * seconds(cycle))
    } else {
        xout
    }
}

/// The last three inputs of a DERIVATIVE.
#[derive(Clone, Debug, Default)]
pub(super) struct Derivative {
    x1: f32,
    x2: f32,
    x3: f32,
}

impl Derivative {
    pub(super) fn run(&mut self, run: bool, xin: f32, cycle: i64) -> f32 {
        let Self { x1, x2, x3 } = *self;
        if run {
            *self = Self { x1: xin, x2: x1, x3: x2 };
            one_nan((3.0 * (xin - x3) + x1 - x2) / (10.0 * seconds(cycle)))
        } else {
            *self = Self { x1: xin, x2: xin, x3: xin };
            0.0
        }
    }
}

/// A PID: an INTEGRAL and a DERIVATIVE of its error.
#[derive(Clone, Debug, Default)]
pub(super) struct Pid {
    integral: f32,
    derivative: Derivative,
}

/// What stands at the inputs of a PID.
pub(super) struct PidInputs {
    pub(super) auto: bool,
    pub(super) pv: f32,
    pub(super) sp: f32,
    pub(super) x0: f32,
    pub(super) kp: f32,
    pub(super) tr: f32,
    pub(super) td: f32,
    pub(super) cycle: i64,
}

impl Pid {
    pub(super) fn run(&mut self, inputs: &PidInputs) -> f32 {
        let &PidInputs { auto, pv, sp, x0, kp, tr, td, cycle } = inputs;
        let error = pv - sp;
        self.integral = integral(self.integral, auto, !auto, error, one_nan(tr * (x0 - error)), cycle);
        let slope = self.derivative.run(auto, error, cycle);
        one_nan(kp * (error + self.integral / tr + slope * td))
    }
}

/// Where a RAMP started, and for how long it has been on its way.
#[derive(Clone, Debug, Default)]
pub(super) struct Ramp {
    from: f32,
    time: i64,
}

impl Ramp {
    /// BUSY and XOUT.
    pub(super) fn run(&mut self, run: bool, x0: f32, x1: f32, tr: i64, cycle: i64) -> (bool, f32) {
        if !run {
            *self = Self { from: x0, time: 0 };
            (false, x0)
        } else if self.time >= tr {
            (false, x1)
        } else {
            let xout = self.from + (x1 - self.from) * seconds(self.time) / seconds(tr);
            self.time = self.time.wrapping_add(cycle);
            (true, one_nan(xout))
        }
    }
}

/// Q of a HYSTERESIS that held `q`.
pub(super) fn hysteresis(q: bool, xin1: f32, xin2: f32, eps: f32) -> bool {
    if q && xin1 < xin2 - eps {
        false
    } else if !q && xin1 > xin2 + eps {
        true
    } else {
        q
    }
}

/// A TIME as a REAL of seconds: the quotient in LREAL, rounded.
fn seconds(time: i64) -> f32 {
    #[expect(clippy::cast_possible_truncation, clippy::cast_precision_loss, reason = "rounding is the meaning")]
    let seconds = (time as f64 / 1e9) as f32;
    seconds
}

fn one_nan(result: f32) -> f32 {
    if result.is_nan() { f32::from_bits(0x7FC0_0000) } else { result }
}
