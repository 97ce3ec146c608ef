//! Traces of small made-up scans, compared with stored files byte for byte; `BLESS=1` writes these anew.

use std::path::PathBuf;

use super::*;
use crate::logic::LayoutBuilder;
use crate::logic::image::SlotId;

const CYCLE: i64 = 10_000_000;

/// A layout in the order of the list: name, type, part.
fn layout(variables: &[(&str, Elementary, Area)]) -> Layout {
    let mut builder = LayoutBuilder::new();
    for (name, ty, area) in variables {
        let slot = Slot {
            name: (*name).to_owned(),
            ty: *ty,
            offset: 0,
            area: *area,
            retain: false,
            initial: Value::default_of(*ty),
            line: 0,
        };
        let id = builder.slot(slot);
        builder.observe(*name, id);
    }
    builder.finish(None).expect("a small image")
}

/// An image that is filled by name.
struct Panel {
    layout: Layout,
    image: Vec<u8>,
}

impl Panel {
    fn new(layout: Layout) -> Self {
        let image = layout.initial_image();
        Self { layout, image }
    }

    fn set(&mut self, place: u32, value: Value) {
        self.layout.slot(SlotId(place)).write(&mut self.image, value);
    }
}

/// A motor that starts by a button and warms up for 300 ms, a counter of its starts, a temperature, and what has an
/// unusual name.
fn motor(trace: impl FnOnce(&Layout) -> Box<dyn Trace>) {
    use Elementary::{Bool, Int, Real, Time};
    let mut panel = Panel::new(layout(&[
        ("start", Bool, Area::Input),
        ("stop", Bool, Area::Input),
        ("motor", Bool, Area::Output),
        ("warm", Bool, Area::Output),
        ("starts", Int, Area::Memory),
        ("a <b>, \"c\" & d", Real, Area::Memory),
        ("preset", Time, Area::Memory),
        ("delay.Q", Bool, Area::State),
        ("delay.ET", Time, Area::State),
        ("%IX0.3", Bool, Area::Input),
    ]));
    let mut trace = trace(&panel.layout);
    let (mut motor, mut since, mut starts) = (false, 0, -1);
    panel.set(6, Value::time(300_000_000));
    for scan in 0..120i32 {
        let now = i64::from(scan) * CYCLE;
        let (start, stop) = ((10..15).contains(&scan) || (75..78).contains(&scan), (62..66).contains(&scan));
        let runs = (start || motor) && !stop;
        if runs && !motor {
            (since, starts) = (now, starts + 1);
        }
        motor = runs;
        let elapsed = if motor { (now - since).min(300_000_000) } else { 0 };
        let warm = elapsed == 300_000_000;
        for (place, value) in [(0, start), (1, stop), (2, motor), (3, warm), (7, warm), (9, scan % 2 == 1)] {
            panel.set(place, Value::bool(value));
        }
        panel.set(4, Value::integer(Int, starts).expect("in range"));
        let heat = if scan < 30 { f64::from(scan / 10) * 0.1 } else { 1e20 };
        panel.set(5, Value::real(Real, if scan == 119 { f64::NAN } else { heat }).expect("a REAL"));
        panel.set(8, Value::time(elapsed));
        trace.record(now, &panel.image).expect("a vector takes all");
    }
    trace.finish().expect("a vector takes all");
}

#[test]
fn preview() {
    let file = std::fs::File::create("/tmp/preview.svg").expect("x");
    motor(|layout| {
        Box::new(SvgTrace::new(
            "motor <1>",
            Signal::all(layout),
            Period { start: 0, end: 120 * CYCLE, cycle: CYCLE },
            file,
        ))
    });
}
