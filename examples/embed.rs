//! Rung inside a host program: a tank, simulated, and the ladder that keeps it between two floats.
//!
//! The tank is this program's; the pump is the ladder's. They meet at variables by name, ten times a simulated second.
//!
//! `cargo run --release --example embed` prints what they do in three minutes.

use std::error::Error;
use std::io::{self, Write};
use std::ops::Range;
use std::time::Duration;

use rung::Controller;

/// The ladder. A host program would read it from a file, in any format that `rung check` takes.
const LADDER: &str = "
-- Empties a tank between two floats, and counts the starts of the pump for its maintenance.
program tank

input  high_float, low_float     -- closed while the water stands above them
input  inflow       : REAL       -- litres a second
output pump
output alarm
var    starts       : INT retain
const  too_high     : TIME := T#10s

rung r10 \"between the floats the pump keeps doing what it does\"
  [ high_float | pump ] low_float (pump)

rung r20
  ^pump {starts := starts + 1}

rung r30 \"water too high for too long, or far more of it than the pump can take\"
  [ high_float flood:TON(PT := too_high) | {inflow > 30.0} ] (alarm)
";

/// Simulated time from one scan to the next.
const CYCLE: Duration = Duration::from_millis(100);
const SCANS: u32 = 1800;
/// When it rains more than the pump can take.
const STORM: Range<Duration> = Duration::from_secs(120)..Duration::from_secs(150);

/// Water, and what is put into it.
struct Tank {
    litres: f64,
}

impl Tank {
    const HIGH: f64 = 800.0;
    const LOW: f64 = 200.0;
    /// Litres a second.
    const PUMP: f64 = 20.0;

    fn flow(&mut self, inflow: f64, pump: bool, time: Duration) {
        let outflow = if pump { Self::PUMP } else { 0.0 };
        self.litres = (self.litres + (inflow - outflow) * time.as_secs_f64()).max(0.0);
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    run(&mut io::stdout())
}

/// Runs tank and ladder side by side, and tells what the outputs do.
pub(crate) fn run(out: &mut impl Write) -> Result<(), Box<dyn Error>> {
    let mut controller = Controller::load("tank.rung", LADDER.as_bytes())?;
    writeln!(out, "{}:", controller.name())?;
    for variable in controller.variables() {
        writeln!(out, "  {:<10} {:<4}  {:?}", variable.name(), variable.ty().name(), variable.area())?;
    }

    let mut tank = Tank { litres: 700.0 };
    let mut before = (false, false);
    for scan in 0..SCANS {
        let now = CYCLE * scan;
        let inflow = if STORM.contains(&now) { 24.0 } else { 9.0 };
        controller.write("high_float", tank.litres > Tank::HIGH)?;
        controller.write("low_float", tank.litres > Tank::LOW)?;
        controller.write("inflow", inflow)?;
        controller.scan(now);
        let (pump, alarm) = (controller.read("pump")?, controller.read("alarm")?);
        if (pump, alarm) != before {
            let (time, litres) = (now.as_secs_f64(), tank.litres);
            writeln!(out, "{time:>5.1} s  {litres:>4.0} l  pump {}  alarm {}", word(pump), word(alarm))?;
            before = (pump, alarm);
        }
        tank.flow(inflow, pump, CYCLE);
    }
    writeln!(out, "the pump has started {} times", controller.read::<i64>("starts")?)?;
    Ok(())
}

fn word(on: bool) -> &'static str {
    if on { "on" } else { "off" }
}
