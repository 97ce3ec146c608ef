//! The functions that firmware calls: start, save, tick and cycle.

use rung::elementary::{Elementary, Value};
use rung::engine::interp::Interpreter;
use rung::interface::{input_bools, retain_size};
use rung::logic::image::LayoutBuilder;
use rung::logic::{Area, Builder, Layout, Origin, Program, Slot, random};
use rung_runtime::Scan;

use crate::rig::{CHECKED, GCC, Rig, TCC};

const TICK: i64 = 10_000_000;

/// Random programs of which some retain something and some do not.
fn programs() -> Vec<Program> {
    let programs: Vec<Program> = (9000..).map(random::program).take(20).collect();
    assert!(programs.iter().any(|program| !program.layout.retained().is_empty()));
    programs
}

/// The clock of an image.
fn with_clock(image: &[u8], last: u32, total: u64) -> Vec<u8> {
    [image, &last.to_ne_bytes(), &[0; 4], &total.to_ne_bytes()].concat()
}

#[test]
fn a_start_sets_initial_values_and_what_was_saved_with_its_bools_made_0_or_1() {
    let mut programs = programs();
    programs.push(empty());
    let mut rig = Rig::new(CHECKED, &programs, TICK);
    for (number, program) in programs.iter().enumerate() {
        let layout = &program.layout;
        let image = random::image(layout, number as u64);
        let runs = layout.retained().iter().map(|run| run.start as usize..run.end as usize);
        let retained: Vec<u8> = runs.clone().flat_map(|run| image[run].to_vec()).collect();
        rig.save(number, &image, &retained);
        rig.init(number, None, &layout.initial_image());
        // Bytes that are no BOOLs, from memory that was never written or of another program.
        let damaged: Vec<u8> = retained.iter().map(|byte| byte.wrapping_mul(3).wrapping_add(1)).collect();
        for retained in [retained, damaged] {
            let mut expected = layout.initial_image();
            let mut at = 0;
            for run in runs.clone() {
                expected[run.clone()].copy_from_slice(&retained[at..at + run.len()]);
                at += run.len();
            }
            for slot in layout.slots().iter().filter(|slot| slot.retain && slot.ty == Elementary::Bool) {
                expected[slot.offset as usize] = u8::from(expected[slot.offset as usize] != 0);
            }
            rig.init(number, Some(&retained), &expected);
        }
        assert_eq!(at_most(layout), retain_size(layout));
    }
    rig.finish();
}

fn at_most(layout: &Layout) -> u32 {
    layout.retained().iter().map(|run| run.end - run.start).sum()
}

/// A program that does nothing, over an image of nothing.
fn empty() -> Program {
    Builder::new("", LayoutBuilder::new().finish(None).expect("it fits")).finish()
}

#[test]
fn a_cycle_scans_at_the_time_that_the_ticks_tell_with_bools_of_inputs_made_0_or_1() {
    let programs = programs();
    for compiler in [GCC, TCC] {
        let mut rig = Rig::new(compiler, &programs, TICK);
        for (number, program) in programs.iter().enumerate() {
            let layout = &program.layout;
            let mut interpreter = Interpreter::new(program);
            let (mut last, mut total, mut counter) = (0, 0, 0);
            let mut image = layout.initial_image();
            for cycle in 0..10u32 {
                let ticks = [0, 1, 7, 300][cycle as usize % 4];
                rig.ticks(number, ticks);
                counter += ticks;
                let mut given = image.clone();
                for run in input_bools(layout) {
                    for place in run {
                        given[place as usize] = [0, 1, 0x80, 0xFF][(cycle + place) as usize % 4];
                        image[place as usize] = u8::from(given[place as usize] != 0);
                    }
                }
                let before = with_clock(&given, last, total);
                total += u64::from(counter - last);
                last = counter;
                interpreter.scan(&mut image, i64::try_from(total).expect("few ticks") * TICK);
                rig.cycle(number, &before, &with_clock(&image, last, total));
            }
        }
        rig.finish();
    }
}

/// A program that notes the time.
fn clock() -> Program {
    let mut layout = LayoutBuilder::new();
    let (name, ty) = ("time".to_owned(), Elementary::Time);
    let initial = Value::default_of(ty);
    let slot =
        layout.slot(Slot { name: name.into(), ty, offset: 0, area: Area::Output, retain: false, initial, line: 1 });
    let mut logic = Builder::new("clock", layout.finish(None).expect("it fits"));
    let now = logic.now();
    logic.store(slot, now);
    logic.end_section(Origin { label: "r1".to_owned().into(), line: 2 });
    logic.finish()
}

#[test]
fn ticks_are_counted_in_32_bits_and_the_time_stays_at_its_end() {
    let programs = [clock()];
    let mut rig = Rig::new(CHECKED, &programs, TICK);
    let size = programs[0].layout.size() as usize;
    let image = |time: i64| {
        let mut image = vec![0; size];
        image[..8].copy_from_slice(&time.to_ne_bytes());
        image
    };
    rig.ticks(0, 5);
    let most = u64::try_from(i64::MAX / TICK).expect("not negative");
    for (last, total, total_after, time) in [
        // The counter has gone around since.
        (u32::MAX - 1, 0, 7, 7 * TICK),
        (5, 7, 7, 7 * TICK),
        (0, most - 5, most, i64::MAX / TICK * TICK),
        (0, most - 4, most + 1, i64::MAX),
        (4, 1 << 62, (1 << 62) + 1, i64::MAX),
    ] {
        rig.cycle(0, &with_clock(&image(0), last, total), &with_clock(&image(time), 5, total_after));
    }
    rig.finish();
}
