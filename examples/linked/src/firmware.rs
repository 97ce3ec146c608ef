//! The traffic light as firmware: no standard library, no memory but its own, no `main` of Rust's. A timer interrupt
//! counts the time, and the loop runs a cycle whenever one is due. It is linked for the host, so that it can be run: the
//! loader calls `main`, the serial line is the standard output, and the loop itself plays the timer.
#![no_std]
#![no_main]

use core::fmt::{self, Write};
use core::panic::PanicInfo;

use rung_runtime::Instance;

/// Where each variable lies in the image.
#[allow(dead_code, reason = "of the variables that there are it needs a few")]
mod at {
    include!(concat!(env!("OUT_DIR"), "/light.rs"));
}

rung_runtime::program! {
    /// The traffic light, as `build.rs` has built it, with a tick of 1 ms.
    unsafe static LIGHT = "light";
}

/// When night falls and when it ends, in ticks.
const NIGHT: core::ops::Range<u32> = 11_000..15_000;
/// Ticks from one cycle to the next, and at the end.
const CYCLE: u32 = 100;
const END: u32 = 20_000;

/// What a board would have in its vector table.
fn timer_interrupt() {
    LIGHT.tick();
}

fn run(light: &mut Instance<'_>) -> fmt::Result {
    writeln!(Serial, "time_ms,night,red,amber,green")?;
    for tick in 0..END {
        if tick % CYCLE == 0 {
            // The switch is a pin; a cycle makes any byte other than 0 a TRUE.
            light.image()[at::NIGHT] = if NIGHT.contains(&tick) { 0xFF } else { 0 };
            light.cycle();
            let image = light.image();
            writeln!(
                Serial,
                "{tick},{},{},{},{}",
                image[at::NIGHT],
                image[at::RED],
                image[at::AMBER],
                image[at::GREEN]
            )?;
        }
        timer_interrupt();
    }
    Ok(())
}

/// Where the start-up code goes on. 0 is that all went well.
#[unsafe(no_mangle)]
extern "C" fn main() -> i32 {
    let Some(image) = LIGHT.take_image() else { return 2 };
    match LIGHT.start(image, None) {
        Ok(mut light) => i32::from(run(&mut light).is_err()),
        Err(error) => {
            let _ = writeln!(Serial, "{error}");
            1
        }
    }
}

/// The serial line.
struct Serial;

impl Write for Serial {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        // A trace is longer than what a pipe takes at once.
        let mut rest = text.as_bytes();
        while !rest.is_empty() {
            // SAFETY: the bytes are borrowed for the call.
            let written = unsafe { write(1, rest.as_ptr(), rest.len()) };
            let written = usize::try_from(written).map_err(|_| fmt::Error)?;
            rest = rest.get(written..).ok_or(fmt::Error)?;
        }
        Ok(())
    }
}

// What stands in for hardware: the host's C library.
#[link(name = "c")]
unsafe extern "C" {
    fn write(file: i32, bytes: *const u8, count: usize) -> isize;
    safe fn abort() -> !;
}

/// The host's core library can unwind, and refers to what would; a bare-metal target's does not.
#[unsafe(no_mangle)]
extern "C" fn rust_eh_personality() {}

#[panic_handler]
fn panic(_: &PanicInfo<'_>) -> ! {
    abort()
}
