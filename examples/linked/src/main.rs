//! A host program with the traffic light linked into it, in virtual time: it prints the trace that `rung sim` prints.

use rung_runtime::{LinkError, Memory};

/// Where each variable lies in the image.
#[allow(dead_code, reason = "of the variables that there are it needs a few")]
mod at {
    include!(concat!(env!("OUT_DIR"), "/light.rs"));
}

rung_runtime::program! {
    /// The traffic light, as `build.rs` has built it.
    unsafe static LIGHT = "light";
}

/// When night falls and when it ends, in milliseconds.
const NIGHT: std::ops::Range<i64> = 11_000..15_000;
/// Milliseconds from one scan to the next, and at the last.
const CYCLE: usize = 100;
const END: i64 = 20_000;

fn main() -> Result<(), LinkError> {
    let mut memory = Memory::<1024>::new();
    let mut light = LIGHT.start(memory.bytes(), None)?;
    println!("time_ms,night,red,amber,green");
    for time in (0..END).step_by(CYCLE) {
        light.image()[at::NIGHT] = u8::from(NIGHT.contains(&time));
        light.scan(time * 1_000_000);
        let image = light.image();
        println!("{time},{},{},{},{}", image[at::NIGHT], image[at::RED], image[at::AMBER], image[at::GREEN]);
    }
    Ok(())
}
