//! Traces of small made-up scans, compared with stored files byte for byte; `BLESS=1` writes these anew.

use std::cell::RefCell;
use std::io;
use std::path::PathBuf;
use std::rc::Rc;

use proptest::prelude::*;
use rung::elementary::{Elementary, Value};
use rung::logic::{Area, Layout, LayoutBuilder, Slot, SlotId};
use rung::trace::{CsvTrace, Period, Signal, SvgTrace, Trace, VcdTrace};

const CYCLE: i64 = 10_000_000;

/// A layout in the order of the list: name, type, part.
fn layout(variables: &[(&str, Elementary, Area)]) -> Layout {
    let mut builder = LayoutBuilder::new();
    for (name, ty, area) in variables {
        let slot = Slot {
            name: (*name).to_owned().into(),
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

/// A writer whose bytes can be looked at while it is owned by a trace.
#[derive(Clone, Default)]
struct Shared(Rc<RefCell<Vec<u8>>>);

impl Shared {
    fn text(&self) -> String {
        String::from_utf8(self.0.borrow().clone()).expect("UTF-8")
    }
}

impl io::Write for Shared {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.borrow_mut().write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

fn period(scans: i64) -> Period {
    Period { start: 0, end: scans * CYCLE, cycle: CYCLE }
}

fn compare_with_stored(name: &str, text: &str) {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/trace").join(name);
    if std::env::var_os("BLESS").is_some() {
        std::fs::write(&path, text).expect("the stored file can be written");
    }
    let stored = std::fs::read_to_string(&path).expect("a stored file; BLESS=1 makes it");
    assert!(stored == text, "{name} differs from the stored one; look at it, then BLESS=1");
}

#[test]
fn the_motor_s_traces_are_the_stored_ones() {
    let out = Shared::default();
    let file = out.clone();
    motor(|layout| Box::new(CsvTrace::new(Signal::all(layout), file).expect("a header")));
    compare_with_stored("motor.csv", &out.text());

    let out = Shared::default();
    let file = out.clone();
    motor(|layout| Box::new(VcdTrace::new("motor <1>", Signal::all(layout), file).expect("a header")));
    compare_with_stored("motor.vcd", &out.text());

    let out = Shared::default();
    let file = out.clone();
    motor(|layout| Box::new(SvgTrace::new("motor <1>", Signal::all(layout), period(120), file)));
    compare_with_stored("motor.svg", &out.text());
}

#[test]
fn a_table_has_a_header_and_a_row_a_scan() {
    let mut panel = Panel::new(layout(&[
        ("a,b", Elementary::Bool, Area::Input),
        ("n", Elementary::Lint, Area::Memory),
        ("say \"x\"", Elementary::Time, Area::Memory),
    ]));
    let out = Shared::default();
    let mut trace = CsvTrace::new(Signal::all(&panel.layout), out.clone()).expect("a header");
    trace.record(0, &panel.image).expect("written");
    panel.set(0, Value::bool(true));
    panel.set(1, Value::integer(Elementary::Lint, i128::from(i64::MIN)).expect("in range"));
    panel.set(2, Value::time(-1_250_000));
    trace.record(500, &panel.image).expect("written");
    trace.finish().expect("written");
    let expected = "time_ms,\"a,b\",n,\"say \"\"x\"\"\"\n0,0,0,0\n0.0005,1,-9223372036854775808,-1.25\n";
    assert_eq!(out.text(), expected);
}

proptest! {
    #[test]
    fn waves_hold_every_value_of_every_scan(values in proptest::collection::vec(any::<[u64; 5]>(), 1..20)) {
        use Elementary::{Bool, Lreal, Sint, Time, Ulint};
        let types = [Bool, Sint, Ulint, Lreal, Time];
        let mut panel = Panel::new(layout(&types.map(|ty| (ty.name(), ty, Area::Memory))));
        let out = Shared::default();
        let mut trace = VcdTrace::new("p", Signal::all(&panel.layout), out.clone()).expect("a header");
        let mut expected = Vec::new();
        for (scan, bits) in (0u64..).zip(&values) {
            for (place, (bits, ty)) in (0..).zip(bits.iter().zip(types)) {
                // Few different values, so that some stay.
                panel.set(place, Value::from_bits(ty, bits & 3));
            }
            let all = panel.layout.slots().iter().map(|slot| slot.read(&panel.image)).collect::<Vec<_>>();
            expected.push((scan * 10, all));
            trace.record((scan * 10).cast_signed(), &panel.image).expect("written");
        }
        trace.finish().expect("written");
        prop_assert_eq!(read_waves(&out.text(), &types), expected);
    }
}

/// The values at each scan, 10 ns apart, as a reader of the format understands them.
fn read_waves(text: &str, types: &[Elementary]) -> Vec<(u64, Vec<Value>)> {
    let mut parser = vcd::Parser::new(text.as_bytes());
    let header = parser.parse_header().expect("a header");
    let codes: Vec<_> = types.iter().map(|ty| header.find_var(&["p", ty.name()]).expect("a variable").code).collect();
    let place = |id| codes.iter().position(|code| *code == id).expect("a declared variable");
    let mut now: Vec<Value> = types.iter().map(|ty| Value::default_of(*ty)).collect();
    let mut seen: Vec<(u64, Vec<Value>)> = Vec::new();
    let mut time = 0;
    let until = |seen: &mut Vec<(u64, Vec<Value>)>, time: u64, now: &Vec<Value>| {
        while (seen.len() as u64) * 10 < time {
            seen.push((seen.len() as u64 * 10, now.clone()));
        }
    };
    for command in parser {
        match command.expect("a command") {
            vcd::Command::Timestamp(next) => {
                until(&mut seen, next, &now);
                time = next;
            }
            vcd::Command::ChangeScalar(id, bit) => now[place(id)] = Value::bool(bit == vcd::Value::V1),
            vcd::Command::ChangeVector(id, vector) => {
                let bits = vector.iter().fold(0, |bits, bit| bits << 1 | u64::from(bit == vcd::Value::V1));
                now[place(id)] = Value::from_bits(types[place(id)], bits);
            }
            vcd::Command::ChangeReal(id, real) => {
                now[place(id)] = match types[place(id)] {
                    #[expect(clippy::cast_possible_truncation, reason = "a whole number of nanoseconds")]
                    Elementary::Time => Value::time((real * 1e6).round() as i64),
                    ty => Value::real(ty, real).expect("a real"),
                };
            }
            other => panic!("{other:?}"),
        }
    }
    until(&mut seen, time + 10, &now);
    seen
}

#[test]
fn members_of_an_instance_are_in_a_scope_of_their_own() {
    let panel = Panel::new(layout(&[
        ("a b", Elementary::Bool, Area::Input),
        ("t.Q", Elementary::Bool, Area::State),
        ("t.ET", Elementary::Time, Area::State),
        ("%QX0.1", Elementary::Bool, Area::Output),
        ("$end", Elementary::Word, Area::Output),
    ]));
    let out = Shared::default();
    VcdTrace::new("", Signal::all(&panel.layout), out.clone()).expect("a header").finish().expect("written");
    let expected = "$timescale 1 ns $end\n$scope module _ $end\n$var wire 1 ! a_b $end\n$scope module t $end\n\
        $var wire 1 \" Q $end\n$var real 64 # ET $end\n$upscope $end\n$var wire 1 $ %QX0.1 $end\n\
        $var wire 16 % _end $end\n$upscope $end\n$enddefinitions $end\n";
    assert_eq!(out.text(), expected);
}

#[test]
fn signals_are_selected_by_name_or_instance() {
    let panel = Panel::new(layout(&[
        ("start", Elementary::Bool, Area::Input),
        ("t.Q", Elementary::Bool, Area::State),
        ("t.ET", Elementary::Time, Area::State),
        ("%IX0.3", Elementary::Bool, Area::Input),
    ]));
    let select = |names: &[&str]| {
        let names: Vec<String> = names.iter().map(|name| (*name).to_owned()).collect();
        let found = Signal::select(&panel.layout, &names)?;
        Ok::<_, String>(found.iter().map(|signal| signal.name().to_owned()).collect::<Vec<_>>())
    };
    let chosen = |names: &[&str]| Ok(names.iter().map(|name| (*name).to_owned()).collect::<Vec<_>>());
    assert_eq!(select(&["T", "START", "t.q"]), chosen(&["t.Q", "t.ET", "start"]));
    assert_eq!(select(&["%ix0.3"]), chosen(&["%IX0.3"]));
    assert_eq!(select(&["start", "%IX0"]), Err("%IX0".to_owned()));
}

#[test]
fn a_long_picture_is_small_and_shows_a_single_pulse() {
    let mut panel = Panel::new(layout(&[
        ("pulse", Elementary::Bool, Area::Input),
        ("toggling", Elementary::Bool, Area::Output),
        ("counting", Elementary::Dint, Area::Memory),
    ]));
    let scans = 300_000;
    let out = Shared::default();
    let mut trace = SvgTrace::new("long", Signal::all(&panel.layout), period(scans), out.clone());
    for scan in 0..scans {
        panel.set(0, Value::bool(scan == 150_000));
        panel.set(1, Value::bool(scan % 2 == 0));
        panel.set(2, Value::integer(Elementary::Dint, i128::from(scan)).expect("in range"));
        trace.record(scan * CYCLE, &panel.image).expect("recorded");
    }
    trace.finish().expect("written");
    let text = out.text();
    assert!(text.len() < 10_000, "{} bytes", text.len());
    // The pulse: up in the middle of the picture, and down again less than a pixel later.
    let (_, waves) = text.split_once("class=\"input wave\"").expect("the pulse's wave");
    let (wave, _) = waves.split_once("/>").expect("its end");
    assert_eq!(wave.matches('H').count(), 3, "{wave}");
    assert_eq!(text.matches("url(#busy)").count(), 2);
}
