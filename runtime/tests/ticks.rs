//! Time from ticks, on a counter that the test advances itself.

use std::num::NonZeroU32;

use rung_runtime::{Latch, Schedule, TickCounter, TickSource};

const MILLISECOND: NonZeroU32 = NonZeroU32::new(1_000_000).expect("not zero");

fn cycle(ticks: u32) -> NonZeroU32 {
    NonZeroU32::new(ticks).expect("not zero")
}

#[test]
fn time_starts_at_zero_wherever_the_counter_stands() {
    let counter = TickCounter::starting_at(MILLISECOND, 0xDEAD_BEEF);
    let mut latch = Latch::new(&counter);
    assert_eq!(latch.latch(), 0);
    counter.tick();
    assert_eq!(latch.latch(), 1);
    assert_eq!(latch.nanoseconds(1), 1_000_000);
}

#[test]
fn the_extended_count_goes_on_when_the_counter_wraps_around() {
    let counter = TickCounter::starting_at(MILLISECOND, u32::MAX - 1);
    let mut latch = Latch::new(&counter);
    let mut expected = 0;
    // More than three times around, in steps up to the longest that is allowed.
    for step in [1, 1, 1, u32::MAX, 1 << 31, 7, u32::MAX, u32::MAX] {
        counter.advance(step);
        expected += u64::from(step);
        assert_eq!(latch.latch(), expected);
        assert_eq!(latch.latch(), expected, "latching again adds nothing");
        assert_eq!(latch.raw(expected), counter.ticks());
        assert_eq!(latch.raw(expected + 5), counter.ticks().wrapping_add(5));
    }
}

#[test]
fn a_tenth_of_a_second_and_a_second_are_exact_for_every_period_that_divides_them() {
    for period in [1_000u32, 10_000, 125_000, 1_000_000, 2_000_000, 10_000_000, 100_000_000] {
        let counter = TickCounter::new(NonZeroU32::new(period).expect("not zero"));
        let mut latch = Latch::new(&counter);
        for hundreds in 1..=36_000u32 {
            counter.advance(100_000_000 / period);
            let ticks = latch.latch();
            assert_eq!(latch.nanoseconds(ticks), i64::from(hundreds) * 100_000_000, "an hour without drift");
        }
    }
}

#[test]
fn time_is_held_at_the_end_of_its_range() {
    let counter = TickCounter::new(NonZeroU32::MAX);
    let latch = Latch::new(&counter);
    assert_eq!(latch.nanoseconds(u64::MAX), i64::MAX);
    assert_eq!(latch.nanoseconds(1 << 62), i64::MAX);
}

#[test]
fn one_counter_may_have_several_latches() {
    let counter = TickCounter::new(MILLISECOND);
    let mut early = Latch::new(&counter);
    counter.advance(10);
    let mut late = Latch::new(&counter);
    counter.advance(5);
    assert_eq!((early.latch(), late.latch()), (15, 5));
}

#[test]
fn cycles_that_are_in_time_count_as_nothing() {
    let mut schedule = Schedule::new(cycle(10));
    for k in 0..100 {
        assert_eq!(schedule.due(), k * 10);
        // Within its own cycle it may begin and end at any tick.
        assert_eq!(schedule.begin(k * 10 + k % 9), k * 10);
        schedule.end(k * 10 + 9);
    }
    assert_eq!((schedule.overruns(), schedule.skipped()), (0, 0));
}

#[test]
fn a_cycle_that_outlasts_itself_is_an_overrun_and_the_skipped_are_not_caught_up() {
    let mut schedule = Schedule::new(cycle(10));
    schedule.begin(0);
    schedule.end(10);
    assert_eq!((schedule.overruns(), schedule.skipped(), schedule.due()), (1, 0, 10));
    // Cycle 1 is still in its own time, and ends in that of cycle 4.
    assert_eq!(schedule.begin(11), 10);
    schedule.end(45);
    assert_eq!((schedule.overruns(), schedule.skipped(), schedule.due()), (2, 0, 20));
    // 2 and 3 never run; 4 begins late.
    assert_eq!(schedule.begin(45), 40);
    schedule.end(46);
    assert_eq!((schedule.overruns(), schedule.skipped(), schedule.due()), (3, 2, 50));
    assert_eq!(schedule.begin(50), 50);
    schedule.end(51);
    assert_eq!((schedule.overruns(), schedule.skipped(), schedule.due()), (3, 2, 60));
}
