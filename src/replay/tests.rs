use super::*;
use crate::elementary::{Elementary, Value};
use crate::logic::LayoutBuilder;
use crate::logic::image::{Area, Slot};
use rung_runtime::Scan;

fn layout() -> Layout {
    let mut builder = LayoutBuilder::new();
    for (name, ty, area) in [
        ("start", Elementary::Bool, Area::Input),
        ("level", Elementary::Int, Area::Input),
        ("sum", Elementary::Int, Area::Output),
    ] {
        let slot = builder.slot(Slot {
            name: name.into(),
            ty,
            offset: 0,
            area,
            retain: false,
            initial: Value::from_bits(ty, 0),
            line: 0,
        });
        builder.observe(name, slot);
    }
    builder.finish(None).expect("a small image")
}

fn replay() -> Replay {
    Replay {
        program: "examples/\"pump\".rung".to_owned(),
        source_hash: u64::MAX,
        layout_hash: layout().hash(),
        reason: String::new(),
        start_image: Some(vec![7; layout().size() as usize]),
        scans: vec![
            RecordedScan { now: 0, inputs: vec![0, 0, 1, 2] },
            RecordedScan { now: i64::MAX, inputs: vec![2, 0, 0xFE, 0xFF] },
        ],
    }
}

#[test]
fn a_replay_is_read_back_as_it_was_written() {
    let written = replay();
    assert_eq!(Replay::parse(&Source::new("r.json", written.to_json())), Ok(written.clone()));
    let without_image = Replay { start_image: None, ..written };
    assert_eq!(Replay::parse(&Source::new("r.json", without_image.to_json())), Ok(without_image));
}

#[test]
fn whatever_is_no_replay_is_a_bad_replay() {
    let good = replay().to_json();
    let mut texts = vec![
        String::new(),
        "{}".to_owned(),
        "[".repeat(100_000),
        good.replace("rung-replay-1", "rung-replay-2"),
        good.replace("\"inputs\": \"00000102\"", "\"inputs\": \"0000010\""),
        good.replace("\"inputs\": \"00000102\"", "\"inputs\": \"0000010é\""),
        good.replace("\"ffffffffffffffff\"", "\"+fffffffffffffff\""),
        good.replace(&i64::MAX.to_string(), "9223372036854775808"),
        good.replace(BYTE_ORDER, "middle"),
    ];
    texts.extend((0..good.len() - 1).step_by(7).map(|end| good.get(..end).unwrap_or("").to_owned()));
    for text in texts {
        assert_ne!(text, good);
        let found = Replay::parse(&Source::new("r.json", &text)).map_err(|problem| problem.code);
        assert_eq!(found, Err(Code::BadReplay), "{text}");
    }
}

#[test]
fn a_replay_of_another_layout_or_size_is_refused() {
    let layout = layout();
    assert_eq!(replay().check(&layout), Ok(()));
    let mut wrong = [replay(), replay(), replay()];
    wrong[0].layout_hash ^= 1;
    wrong[1].start_image = Some(vec![0; 3]);
    wrong[2].scans[1].inputs.pop();
    for replay in wrong {
        assert_eq!(replay.check(&layout).map_err(|problem| problem.code), Err(Code::BadReplay));
    }
}

#[test]
fn recorded_inputs_are_normalised_when_copied_in() {
    let layout = layout();
    let mut image = layout.initial_image();
    replay().scans[1].copy_in(&layout, &mut image);
    assert_eq!(image[..4], [1, 0, 0xFE, 0xFF]);
}

/// Adds the level to the sum, whose value thus tells of every scan since the first.
struct Accumulator;

impl Scan for Accumulator {
    fn scan(&mut self, image: &mut [u8], now: i64) {
        let changed = image[4].wrapping_mul(3).wrapping_add(image[2]).wrapping_add(now.to_ne_bytes()[0]);
        image[4] = changed;
    }
}

#[test]
fn the_recorded_end_of_a_run_leads_to_the_same_image() {
    let layout = layout();
    for scans in [0, 1, 4, 5, 8, 9, 23] {
        let mut recorder = Recorder::with_room(Accumulator, &layout, 4);
        let mut image = layout.initial_image();
        for now in 0..scans {
            RecordedScan { now, inputs: vec![1, 0, now.to_ne_bytes()[0], 0] }.copy_in(&layout, &mut image);
            recorder.scan(&mut image, now);
        }
        let replay = recorder.replay("p".to_owned(), 0, &layout, String::new());
        assert_eq!(replay.check(&layout), Ok(()));
        assert!(replay.scans.len() >= usize::try_from(scans.min(5)).expect("few") && replay.scans.len() <= 8);
        let mut again = replay.first_image(&layout);
        for scan in &replay.scans {
            scan.copy_in(&layout, &mut again);
            Accumulator.scan(&mut again, scan.now);
        }
        assert_eq!(again, image, "{scans} scans");
    }
}
