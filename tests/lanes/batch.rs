//! The library's batch: names, words, errors, and what it does where lanes cannot run as one.

use rung::batch::{Batch, BatchError, RandomInputs, WORD_LANES};
use rung::elementary::{Elementary, Value};
use rung::simulate::{Schedule, Simulation, Stimuli};
use rung::source::Source;

use crate::{Rig, program};

const TEXT: &str = "program p\ninput a, b\ninput level : INT\noutput q, r\noutput n : INT\n\
    rung\n  a t:TON(PT := T#20ms) (q)\nrung\n  ^b {n := n + level}\nrung\n  {n > 5} (r)\n";
const CYCLE: i64 = 10_000_000;

#[test]
fn a_variable_is_set_and_read_by_lane_by_word_and_in_all() {
    let program = program(TEXT);
    let mut batch = Batch::new(&program, 200).expect("a small image");
    assert_eq!((batch.lanes(), batch.words(), batch.parts()), (200, 2, 1));
    let [a, b, level, q, n] = ["A", "b", "level", "t.q", "n"].map(|name| batch.variable(name).expect("a variable"));
    assert_eq!((level.ty(), q.ty()), (Elementary::Int, Elementary::Bool));
    batch.set_word(0, a, 0b101).expect("a BOOL");
    batch.set_word(1, a, u128::MAX).expect("a BOOL");
    batch.set_all(level, Value::from_bits(Elementary::Int, 3)).expect("an INT");
    batch.set(199, level, Value::from_bits(Elementary::Int, 9)).expect("an INT");
    batch.set_all(b, Value::bool(true)).expect("a BOOL");
    for scan in 0..4 {
        batch.scan(scan * CYCLE);
    }
    assert_eq!(batch.word(0, q), Ok(0b101));
    assert_eq!(batch.word(1, q), Ok((1 << (200 - WORD_LANES)) - 1), "no bits beyond the last lane");
    assert_eq!(batch.word(1, n), batch.word(1, q), "a number counts as whether it is other than 0");
    let number = |lane| batch.get(lane, n).map(Value::bits);
    assert_eq!((number(0), number(198), number(199)), (Ok(3), Ok(3), Ok(9)));
    let r = batch.variable("r").expect("a variable");
    assert_eq!(batch.differing(0, &[r]), Ok(vec![199]));
    batch.reset();
    assert_eq!(batch.get(199, n), Ok(Value::from_bits(Elementary::Int, 0)));
    assert_eq!(batch.image(5), Ok(program.layout.initial_image()));
}

#[test]
fn what_there_is_not_and_what_does_not_fit_is_refused() {
    let program = program(TEXT);
    assert_eq!(Batch::new(&program, 0).err(), Some(BatchError::NoLanes));
    assert!(matches!(Batch::new(&program, 1 << 40).err(), Some(BatchError::TooLarge { .. })));
    let mut batch = Batch::new(&program, 130).expect("a small image");
    let nowhere = BatchError::NoSuchVariable { name: "nowhere".to_owned() };
    assert_eq!(batch.variable("nowhere"), Err(nowhere));
    let (a, n) = (batch.variable("a").expect("a variable"), batch.variable("n").expect("a variable"));
    let no_lane = |lane| BatchError::NoSuchLane { lane, lanes: 130 };
    assert_eq!(batch.get(130, a), Err(no_lane(130)));
    assert_eq!(batch.set(usize::MAX, a, Value::bool(true)), Err(no_lane(usize::MAX)));
    assert_eq!(batch.word(2, a), Err(no_lane(256)));
    assert_eq!(batch.image(130), Err(no_lane(130)));
    let wrong = BatchError::WrongType { expected: Elementary::Int, found: Elementary::Bool };
    assert_eq!(batch.set(0, n, Value::bool(true)), Err(wrong.clone()));
    assert_eq!(batch.set_word(0, n, 1), Err(wrong));
    let size = program.layout.size() as usize;
    assert_eq!(batch.set_image(0, &[0]), Err(BatchError::WrongSize { found: 1, size }));
    for error in [BatchError::NoLanes, no_lane(7), BatchError::TooLarge { bytes: 1 << 37 }] {
        assert!(!error.to_string().is_empty());
    }
}

#[test]
fn times_that_go_back_and_images_from_outside_are_exact_too() {
    let program = program(TEXT);
    let mut rig = Rig::new(&program, 600);
    (0..600).for_each(|lane| rig.set(lane, "a", Value::bool(lane % 3 == 0)));
    for now in [0, 1, 2, 3] {
        rig.scan(now * CYCLE);
    }
    assert!(rig.batch.each(|part| part.is_joined()).into_iter().all(|joined| joined));
    // The start of a timer that no scan has set.
    let start = program.layout.slots().iter().find(|slot| slot.name == "t#start").expect("a TON has a start");
    start.write(&mut rig.images[599], Value::time(3 * CYCLE + 7));
    let image = rig.images[599].clone();
    rig.batch.set_image(599, &image).expect("an image of its size");
    assert_eq!(rig.batch.each(|part| part.is_joined()), [true, false]);
    assert_eq!(rig.difference(0..600), None);
    for now in [5, 4, 4, 9, -100, 12, i64::MIN, i64::MAX] {
        rig.scan(if (-200..200).contains(&now) { now * CYCLE } else { now });
        assert_eq!(rig.difference(0..600), None, "at {now}");
    }
    assert_eq!(rig.batch.each(|part| part.is_joined()), [false, false]);
    rig.batch.reset();
    assert_eq!(rig.batch.each(|part| part.is_joined()), [true, true]);
}

#[test]
fn an_image_that_a_scan_left_is_taken_without_falling_back() {
    let program = program("program p\ninput a\noutput q\noutput n : INT\nrung\n  a (q)\nrung\n  ^a {n := n + 1}\n");
    let mut rig = Rig::new(&program, 128);
    rig.set(3, "a", Value::bool(true));
    rig.scan(0);
    let image = rig.images[3].clone();
    rig.batch.set_image(77, &image).expect("an image of its size");
    rig.images[77] = image;
    assert_eq!(rig.difference(0..128), None);
    assert_eq!(rig.batch.each(|part| part.is_joined()), [true]);
}

#[test]
fn tasks_with_intervals_run_in_all_lanes_or_in_none() {
    let program = program(
        "task slow(interval := 30ms)\nprogram quick\ninput a\noutput q\nrung\n  a t:TON(PT := T#20ms) (q)\n\
         program slowly with slow\ninput b\noutput r\noutput n : INT\nrung\n  b u:TOF(PT := T#50ms) (r)\n\
         rung\n  ^b {n := n + 1}\n",
    );
    let mut rig = Rig::new(&program, 131);
    for scan in 0..200i64 {
        for lane in 0..131 {
            let bit =
                |divisor: i64| Value::bool((scan * (i64::try_from(lane).unwrap_or_default() + 1) / divisor) % 3 == 0);
            rig.set(lane, "quick.a", bit(50));
            rig.set(lane, "slowly.b", bit(170));
        }
        rig.scan(scan * CYCLE + scan % 7);
        assert_eq!(rig.difference(0..131), None, "scan {scan}");
    }
    // A lane whose task is due at another time.
    let due = program.layout.slots().iter().find(|slot| slot.name.starts_with("#task")).expect("a task's turn");
    due.write(&mut rig.images[1], Value::time(i64::MAX));
    let image = rig.images[1].clone();
    rig.batch.set_image(1, &image).expect("an image of its size");
    for scan in 200..220 {
        rig.scan(scan * CYCLE);
        assert_eq!(rig.difference(0..131), None, "scan {scan}");
    }
}

#[test]
fn a_lane_of_a_seed_gets_the_same_alone_as_among_others() {
    let program = program(TEXT);
    let none = Default::default();
    let mut batch = Batch::new(&program, 700).expect("a small image");
    let images = batch.each(|mut part| {
        let words = part.first() / WORD_LANES..part.first() / WORD_LANES + part.words();
        let mut random: Vec<_> = words.map(|word| RandomInputs::new(&program.layout, 42, word, &none)).collect();
        for scan in 0..120 {
            random.iter_mut().enumerate().for_each(|(word, random)| random.apply(&mut part, word));
            part.scan(scan * CYCLE);
        }
    });
    assert_eq!(images.len(), 2);
    for lane in [0, 77, 128, 511, 512, 699] {
        let random = RandomInputs::new(&program.layout, 42, lane / WORD_LANES, &none);
        let stimuli = random.stimuli_of(lane, CYCLE, 120, &Stimuli::default());
        let text = stimuli.to_csv(&program.layout);
        let read = Stimuli::parse(&Source::new("lane.csv", text.as_str()), &program.layout);
        assert_eq!(read.as_ref(), Ok(&stimuli), "{text}");
        let schedule = Schedule::scans(CYCLE, 120).expect("a schedule");
        let mut simulation = Simulation::new(&program.layout, &stimuli, schedule);
        let mut interpreter = rung::engine::interp::Interpreter::new(&program);
        while simulation.step(&mut interpreter).is_some() {}
        assert_eq!(batch.image(lane).as_deref(), Ok(simulation.image()), "lane {lane}");
    }
    let random =
        |seed| RandomInputs::new(&program.layout, seed, 0, &none).stimuli_of(0, CYCLE, 50, &Stimuli::default());
    assert_ne!(random(1), random(2));
}
