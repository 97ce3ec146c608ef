//! Stimuli, good and bad, and the order in which a simulation does things.

use std::collections::HashMap;

use proptest::prelude::*;
use rung_runtime::Scan;

use super::*;
use crate::diagnostic::{Code, Diagnostic};
use crate::elementary::{Elementary, Value};
use crate::logic::{Area, LayoutBuilder, Slot, SlotId};
use crate::source::Source;

/// A BOOL `run`, an INT `Count`, a REAL `level`, an LREAL `exact`, a TIME `delay.ET`, a USINT `small`.
fn layout() -> Layout {
    let mut builder = LayoutBuilder::new();
    let variables = [
        ("run", Elementary::Bool, Area::Input),
        ("Count", Elementary::Int, Area::Memory),
        ("level", Elementary::Real, Area::Memory),
        ("exact", Elementary::Lreal, Area::Memory),
        ("delay.ET", Elementary::Time, Area::State),
        ("small", Elementary::Usint, Area::Output),
    ];
    for (name, ty, area) in variables {
        let initial = Value::default_of(ty);
        let slot = builder.slot(Slot { name: name.into(), ty, offset: 0, area, retain: false, initial, line: 0 });
        builder.observe(name, slot);
    }
    builder.finish(None).expect("a small image")
}

fn parse(text: &str) -> Result<Stimuli, Vec<Diagnostic>> {
    Stimuli::parse(&Source::new("s.csv", text), &layout())
}

/// Each row as its time and what it sets, a slot and the bits.
fn rows(text: &str) -> Vec<(i64, Vec<(u32, u64)>)> {
    let stimuli = parse(text).expect("good stimuli");
    let settings = |row: Row<'_>| row.settings.iter().map(|set| (set.slot.0, set.value.bits())).collect();
    stimuli.rows().map(|row| (row.time, settings(row))).collect()
}

#[test]
fn rows_set_their_cells_and_leave_the_empty_ones() {
    let text = "time_ms, COUNT ,run\n0,-7,1\n\n0.5,,true\r\n0.5, 32767 ,FALSE\n2,,\n";
    let minus_seven = (-7i64).cast_unsigned();
    let expected = vec![
        (0, vec![(1, minus_seven), (0, 1)]),
        (500_000, vec![(0, 1)]),
        (500_000, vec![(1, 32767), (0, 0)]),
        (2_000_000, vec![]),
    ];
    assert_eq!(rows(text), expected);
}

#[test]
fn numbers_are_read_exactly_as_their_type() {
    // By way of an LREAL, this would be halfway between two REALs and round to 1.
    let tie = "1.00000005960464477539062500000000001";
    let text = format!("time_ms,level,exact,delay.ET\n0,{tie},0.1,-0.000001\n1,inf,NaN,9223372036854.775807\n");
    let one_ns_less = (-1i64).cast_unsigned();
    let expected = vec![
        (0, vec![(2, 0x3F80_0001), (3, 0.1f64.to_bits()), (4, one_ns_less)]),
        (
            1_000_000,
            vec![(2, u64::from(f32::INFINITY.to_bits())), (3, f64::NAN.to_bits()), (4, i64::MAX.cast_unsigned())],
        ),
    ];
    assert_eq!(rows(&text), expected);
}

#[test]
fn a_header_alone_is_no_row_and_quotes_are_understood() {
    assert_eq!(rows("time_ms,run"), vec![]);
    assert_eq!(rows("\"time_ms\",\"run\"\n\"3\",\"1\"\n"), vec![(3_000_000, vec![(0, 1)])]);
}

/// Findings as code, line, the text that is pointed at, and what is said.
fn findings(text: &str) -> Vec<(Code, usize, String, String)> {
    let source = Source::new("s.csv", text);
    let found = Stimuli::parse(&source, &layout()).expect_err("bad stimuli");
    let finding = |found: Diagnostic| {
        (found.code, source.line(found.span.start), source.slice(found.span).to_owned(), found.message)
    };
    found.into_iter().map(finding).collect()
}

#[test]
fn each_mistake_is_said_at_its_cell() {
    for (text, line, cell, message) in [
        ("", 1, "", "this file is empty"),
        ("\n\n", 1, "", "this file is empty"),
        ("time,run\n", 1, "time", "the first column must be `time_ms`"),
        ("time_ms,walk\n", 1, "walk", "the program has no variable `walk`"),
        ("time_ms,run,RUN\n", 1, "RUN", "there is a column `run` already"),
        ("time_ms,run\n1,0\n\n0.5,1\n", 4, "0.5", "this time goes back behind that of the row before"),
        ("time_ms,run\n-1,0\n", 2, "-1", "this time is before the first scan's, which is 0"),
        ("time_ms,run\n,0\n", 2, "", "`` is no time in milliseconds: it is not a decimal number"),
        ("time_ms,run\n1e3,0\n", 2, "1e3", "`1e3` is no time in milliseconds: it is not a decimal number"),
        (
            "time_ms,run\n0.0000001,0\n",
            2,
            "0.0000001",
            "`0.0000001` is no time in milliseconds: it is finer than a nanosecond",
        ),
        ("time_ms,run\r\n1,2\r\n", 2, "2", "`2` cannot be set: `run` takes 0, 1, FALSE or TRUE"),
        (
            "time_ms,run,count\n1,1, 32768 \n",
            2,
            "32768",
            "`32768` cannot be set: `Count` takes an integer from -32768 to 32767",
        ),
        ("time_ms,small\n1,-1\n", 2, "-1", "`-1` cannot be set: `small` takes an integer from 0 to 255"),
        ("time_ms,level\n1,1e39\n", 2, "1e39", "`1e39` cannot be set: `level` takes a number in the range of REAL"),
        (
            "time_ms,delay.et\n1,1s\n",
            2,
            "1s",
            "`1s` cannot be set: `delay.ET` takes milliseconds, with at most 6 decimals",
        ),
        ("time_ms,run\n1\n", 2, "1", "this row has 1 cells, and the header has 2"),
        ("time_ms,run\n1,1,\"a,b\"\n", 2, "\"a,b\"", "this row has 3 cells, and the header has 2"),
    ] {
        let expected = (Code::BadStimuli, line, cell.to_owned(), message.to_owned());
        assert_eq!(findings(text), vec![expected], "{text:?}");
    }
}

#[test]
fn all_mistakes_are_said_up_to_a_hundred() {
    let mistakes = findings("time,walk,run\n2,,x\n1,,0,\n");
    let lines: Vec<usize> = mistakes.iter().map(|(_, line, ..)| *line).collect();
    assert_eq!(lines, [1, 1, 2, 3, 3]);

    let many = format!("time_ms,run\n{}", "0,x\n".repeat(1000));
    let mistakes = findings(&many);
    assert_eq!(mistakes.len(), 101);
    assert_eq!(mistakes.last().map(|(code, ..)| *code), Some(Code::TooManyDiagnostics));
}

proptest! {
    #[test]
    fn any_bytes_give_stimuli_or_findings(bytes: Vec<u8>) {
        if let Ok(source) = Source::decode("s.csv", bytes) {
            let _ = Stimuli::parse(&source, &layout());
        }
    }

    #[test]
    fn any_table_gives_rows_in_order_of_time_or_findings_within_the_text(
        text in "time_ms(,(run|count|x|\"run\")){0,3}(\r?\n(-?[0-9.]{0,4}(,([01\"]|TRUE| 7|\n)?){0,3})?){0,5}"
    ) {
        match parse(&text) {
            Ok(stimuli) => {
                let times: Vec<i64> = stimuli.rows().map(|row| row.time).collect();
                prop_assert!(times.is_sorted());
            }
            Err(found) => {
                prop_assert!(!found.is_empty());
                prop_assert!(found.iter().all(|found| text.get(found.span.range()).is_some()));
            }
        }
    }
}

/// An engine that notes what it was given, and clears `run`.
#[derive(Default)]
struct Notes(Vec<(i64, u8)>);

impl Scan for Notes {
    fn scan(&mut self, image: &mut [u8], now: i64) {
        self.0.push((now, image[0]));
        image[0] = 0;
    }
}

#[test]
fn a_row_is_applied_before_the_first_scan_at_or_after_its_time() {
    let layout = layout();
    assert_eq!(layout.slot(SlotId(0)).offset, 0);
    let text = "time_ms,run\n0,1\n10,1\n10.000001,0\n15,1\n20,1\n25,1\n30,0\n1000,1\n";
    let stimuli = Stimuli::parse(&Source::new("s.csv", text), &layout).expect("good stimuli");
    let mut simulation = Simulation::new(&layout, &stimuli, Schedule::scans(10_000_000, 5).expect("a schedule"));
    let mut notes = Notes::default();
    let mut after = Vec::new();
    while let Some(now) = simulation.step(&mut notes) {
        after.push((now, simulation.image()[0]));
    }
    let ms = 1_000_000;
    // At 0 and 10 ms what is set for that very time, at 20 the last of three, at 30 again, at 40 nothing.
    assert_eq!(notes.0, [(0, 1), (10 * ms, 1), (20 * ms, 1), (30 * ms, 0), (40 * ms, 0)]);
    assert_eq!(after, [(0, 0), (10 * ms, 0), (20 * ms, 0), (30 * ms, 0), (40 * ms, 0)]);
    assert_eq!(simulation.step(&mut notes), None);
}

#[test]
fn a_replay_gives_each_scan_its_time_and_inputs() {
    let layout = layout();
    let recorded = |now, run| crate::replay::RecordedScan { now, inputs: vec![run] };
    let replay = Replay {
        program: String::new(),
        source_hash: 0,
        layout_hash: layout.hash(),
        reason: String::new(),
        start_image: None,
        scans: vec![recorded(5, 1), recorded(7, 0), recorded(100, 2)],
    };
    let mut simulation = Simulation::replaying(&layout, &replay);
    let mut notes = Notes::default();
    while simulation.step(&mut notes).is_some() {}
    assert_eq!(notes.0, [(5, 1), (7, 0), (100, 1)]);
}

#[test]
fn a_schedule_covers_what_was_asked_for() {
    let counts = |cycle: i64| {
        HashMap::from([0, 1, 9, 10, 11, 1000].map(|end| (end, Schedule::before(cycle, end).map(Schedule::count))))
    };
    assert_eq!(
        counts(10),
        HashMap::from([(0, Some(0)), (1, Some(1)), (9, Some(1)), (10, Some(1)), (11, Some(2)), (1000, Some(100))])
    );
    let covering = |cycle: i64, text: &str| Schedule::covering(cycle, &parse(text).expect("good")).map(Schedule::count);
    let ms = 1_000_000;
    assert_eq!(covering(10 * ms, "time_ms\n"), Some(Schedule::DEFAULT_SCANS));
    assert_eq!(covering(10 * ms, "time_ms\n500\n"), Some(150));
    // The last stimulus comes between two scans, both far apart: the second one is run.
    assert_eq!(covering(10_000 * ms, "time_ms\n500\n"), Some(2));
    assert_eq!(covering(2, "time_ms\n9223372036854.775807\n"), None);
}

#[test]
fn a_schedule_past_the_end_of_time_is_refused() {
    assert_eq!(Schedule::scans(0, 1), None);
    assert_eq!(Schedule::scans(-1, 1), None);
    assert_eq!(Schedule::scans(1, u64::MAX), None);
    assert_eq!(Schedule::scans(i64::MAX, 3), None);
    let last = Schedule::scans(i64::MAX, 2).map(|schedule| (schedule.count(), schedule.end()));
    assert_eq!(last, Some((2, i64::MAX)));
}
