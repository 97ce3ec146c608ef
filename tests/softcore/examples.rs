//! The firmware as a reader starts it: `make check` and `make timer` in each folder.

use std::path::PathBuf;

use tempfile::TempDir;

use crate::target::{AARCH64, CORTEX_M3, OPENRISC, RV32, RV64, Target, X86_64};

/// The example and the time of its first timer, in milliseconds.
const TRAFFIC_LIGHT: &str = "PROGRAM=../../traffic_light.rung";
const RED_TIME: f64 = 1500.0;

fn prints_the_stored_traces(target: Target) {
    for program in [TRAFFIC_LIGHT, "PROGRAM=../../interlocking18.rung"] {
        let folder = TempDir::new().expect("a temporary folder");
        target.make(folder.path(), [program, "check"]);
    }
}

#[test]
fn on_rv64_the_firmware_prints_the_stored_traces() {
    prints_the_stored_traces(RV64);
}

#[test]
fn on_rv32_the_firmware_prints_the_stored_traces() {
    prints_the_stored_traces(RV32);
}

#[test]
fn on_a_cortex_m3_the_firmware_prints_the_stored_traces() {
    prints_the_stored_traces(CORTEX_M3);
}

#[test]
fn on_openrisc_the_firmware_prints_the_stored_traces() {
    prints_the_stored_traces(OPENRISC);
}

#[test]
fn on_aarch64_the_firmware_prints_the_stored_traces() {
    prints_the_stored_traces(AARCH64);
}

#[test]
fn on_x86_64_the_firmware_prints_the_stored_traces() {
    prints_the_stored_traces(X86_64);
}

/// Runs the firmware whose ticks come from the timer interrupt, with a cycle that the presets are no multiples of, and
/// looks at the first timer: on at the first cycle at or after its preset, and not before.
fn a_timer_fires_from_the_interrupt(target: Target) {
    let folder = TempDir::new().expect("a temporary folder");
    let mut arguments = vec![TRAFFIC_LIGHT, "CYCLE_MS=7", "OPT=-O2 -DDURATION_MS=2100", "timer"];
    if target.emulates_time {
        // One instruction a nanosecond; while the processor waits, time passes at once.
        arguments.push("QEMU_FLAGS=-icount shift=0,sleep=off");
    }
    let trace = target.make(folder.path(), arguments);
    let rows = Rows::new(&trace);
    let (times, on) = (rows.column("time_ms"), rows.column("red_phase.Q"));
    assert_eq!(times.len(), 300, "{trace}");
    assert!(times.is_sorted() && times.windows(2).any(|pair| pair[0] < pair[1]), "time does not pass:\n{trace}");
    // The light is red from the first scan on, and the timer started then.
    for (time, on) in times.iter().zip(&on) {
        assert_eq!(*on == 1.0, time - times[0] >= RED_TIME, "at {time} ms:\n{trace}");
    }
    let next = rows.column("prepare_phase.Q");
    assert!(next.contains(&1.0), "the timer that the first one starts never fires:\n{trace}");
}

#[test]
fn on_rv64_a_timer_fires_from_the_interrupt() {
    a_timer_fires_from_the_interrupt(RV64);
}

#[test]
fn on_rv32_a_timer_fires_from_the_interrupt() {
    a_timer_fires_from_the_interrupt(RV32);
}

#[test]
fn on_a_cortex_m3_a_timer_fires_from_the_interrupt() {
    a_timer_fires_from_the_interrupt(CORTEX_M3);
}

#[test]
fn on_openrisc_a_timer_fires_from_the_interrupt() {
    a_timer_fires_from_the_interrupt(OPENRISC);
}

#[test]
fn in_a_process_a_timer_fires_from_the_signal() {
    a_timer_fires_from_the_interrupt(X86_64);
}

#[test]
fn a_program_that_the_trace_cannot_print_is_refused_and_leaves_no_tables() {
    let folder = TempDir::new().expect("a temporary folder");
    let refused = std::panic::catch_unwind(|| RV32.make(folder.path(), ["PROGRAM=../../star_delta.rung", "check"]));
    let message = refused.expect_err("a REAL is not printed");
    let message = message.downcast_ref::<String>().expect("what make said");
    assert!(message.contains("is of type REAL, which this trace does not print"), "{message}");
    let tables: PathBuf = folder.path().join("tables.c");
    assert!(!tables.exists());
}

/// A trace's rows by column.
struct Rows<'a> {
    names: Vec<&'a str>,
    cells: Vec<Vec<&'a str>>,
}

impl<'a> Rows<'a> {
    fn new(trace: &'a str) -> Self {
        let mut lines = trace.lines().map(|line| line.split(',').collect::<Vec<_>>());
        Self { names: lines.next().unwrap_or_default(), cells: lines.collect() }
    }

    fn column(&self, name: &str) -> Vec<f64> {
        let place = self.names.iter().position(|found| *found == name).unwrap_or_else(|| panic!("no column {name}"));
        self.cells.iter().map(|row| row[place].parse().expect("a number")).collect()
    }
}
