//! What one signal did, as few pieces as a picture can show.
//!
//! Unchanged stretches are one piece, and so is a timer's elapsed time while it rises with the time itself. Pieces too
//! short to be seen apart are joined to one that says so; a single short one stays, since a pulse must not get lost.

use crate::elementary::{Elementary, Value};
use crate::trace::Signal;

/// A piece of a lane, from `start` to `end` in nanoseconds.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) struct Piece {
    pub(super) start: i64,
    pub(super) end: i64,
    pub(super) shape: Shape,
}

/// What a signal did during a piece.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) enum Shape {
    /// It kept a value.
    Level(Value),
    /// A TIME rose by as much as the time went on. If it `arrived`, its last step was less than that, because
    /// it reached what it rises to.
    Ramp { from: i64, to: i64, arrived: bool },
    /// It changed more often than can be drawn.
    Busy,
}

/// One signal's pieces, each of which starts where the one before ends.
#[derive(Debug)]
pub(super) struct Lane {
    pub(super) signal: Signal,
    pub(super) pieces: Vec<Piece>,
    /// Least and greatest finite number that it had; the first above the second while there was none.
    pub(super) least: f64,
    pub(super) greatest: f64,
    /// Nanoseconds below which a piece cannot be seen apart.
    shortest: i64,
    /// The time and the value recorded last.
    last: Option<(i64, Value)>,
}

impl Lane {
    pub(super) fn new(signal: Signal, shortest: i64) -> Self {
        let (least, greatest) = (f64::INFINITY, f64::NEG_INFINITY);
        Self { signal, pieces: Vec::new(), least, greatest, shortest, last: None }
    }

    /// Records the value after the scan at `now`. Until then it had the one that was recorded last.
    pub(super) fn record(&mut self, now: i64, value: Value) {
        let number = number(value);
        if number.is_finite() {
            self.least = self.least.min(number);
            self.greatest = self.greatest.max(number);
        }
        let last = self.last.replace((now, value));
        let (Some((before, held)), Some(piece)) = (last, self.pieces.last_mut()) else {
            self.push(now, now, Shape::Level(value));
            return;
        };
        let rise = rise(before, held, now, value);
        match (&mut piece.shape, rise) {
            (Shape::Level(level), _) if *level == value => piece.end = now,
            (Shape::Ramp { to, arrived, .. }, Some(arrives)) if !*arrived => {
                (*to, *arrived) = (time(value), arrives);
                piece.end = now;
            }
            (_, Some(arrived)) => {
                if piece.start == piece.end {
                    self.pieces.pop();
                }
                self.push(before, now, Shape::Ramp { from: time(held), to: time(value), arrived });
            }
            (Shape::Ramp { .. }, None) => {
                self.push(before, now, Shape::Level(held));
                if held != value {
                    self.push(now, now, Shape::Level(value));
                }
            }
            (Shape::Level(_) | Shape::Busy, None) => {
                piece.end = now;
                self.push(now, now, Shape::Level(value));
            }
        }
    }

    /// Ends the last piece: the value holds until `end`.
    pub(super) fn finish(&mut self, end: i64) {
        let (Some((before, held)), Some(piece)) = (self.last, self.pieces.last_mut()) else { return };
        if matches!(piece.shape, Shape::Ramp { .. }) {
            self.push(before, end.max(before), Shape::Level(held));
        } else {
            piece.end = end.max(before);
        }
    }

    /// Whether it ever rose with the time.
    pub(super) fn has_ramp(&self) -> bool {
        self.pieces.iter().any(|piece| matches!(piece.shape, Shape::Ramp { .. }))
    }

    /// Adds a piece behind the last, which by that is complete and may be joined to the one before.
    fn push(&mut self, start: i64, end: i64, shape: Shape) {
        if let [.., before, last] = self.pieces.as_mut_slice() {
            let short =
                |piece: &Piece| piece.shape == Shape::Busy || piece.end.saturating_sub(piece.start) < self.shortest;
            if short(before) && short(last) {
                *before = Piece { start: before.start, end: last.end, shape: Shape::Busy };
                self.pieces.pop();
            }
        }
        self.pieces.push(Piece { start, end, shape });
    }
}

/// Whether a TIME rose by as much as the time went on (`Some(false)`) or by less (`Some(true)`).
fn rise(before: i64, held: Value, now: i64, value: Value) -> Option<bool> {
    let passed = now.checked_sub(before)?;
    let rise = time(value).checked_sub(time(held))?;
    (value.ty() == Elementary::Time && 0 < rise && rise <= passed).then_some(rise < passed)
}

fn time(value: Value) -> i64 {
    value.bits().cast_signed()
}

/// A value as a number to draw.
pub(super) fn number(value: Value) -> f64 {
    value.as_real().unwrap_or_else(|| value.as_integer().unwrap_or_default() as f64)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::logic::{Area, LayoutBuilder, Slot};

    fn lane(ty: Elementary, shortest: i64) -> Lane {
        let mut builder = LayoutBuilder::new();
        let initial = Value::default_of(ty);
        let slot = Slot { name: "x".into(), ty, offset: 0, area: Area::Memory, retain: false, initial, line: 0 };
        let slot = builder.slot(slot);
        builder.observe("x", slot);
        Lane::new(Signal::all(&builder.finish(None).expect("a small image")).remove(0), shortest)
    }

    fn pieces(shortest: i64, values: &[i64]) -> Vec<(i64, i64, Shape)> {
        let mut lane = lane(Elementary::Time, shortest);
        for (scan, value) in (0..).zip(values) {
            lane.record(scan * 10, Value::time(*value));
        }
        lane.finish(10 * i64::try_from(values.len()).expect("few"));
        lane.pieces.iter().map(|piece| (piece.start, piece.end, piece.shape)).collect()
    }

    fn level(time: i64) -> Shape {
        Shape::Level(Value::time(time))
    }

    #[test]
    fn a_timer_s_elapsed_time_is_a_ramp_that_arrives_or_is_reset() {
        let ramp = |from, to, arrived| Shape::Ramp { from, to, arrived };
        assert_eq!(
            pieces(0, &[0, 0, 10, 20, 25, 25, 25, 0, 10, 20, 0]),
            [
                (0, 10, level(0)),
                (10, 40, ramp(0, 25, true)),
                (40, 70, level(25)),
                (70, 90, ramp(0, 20, false)),
                (90, 100, level(20)),
                (100, 110, level(0)),
            ]
        );
        // Rising from the first scan on; and a jump by more than the time is none.
        assert_eq!(
            pieces(0, &[0, 10, 10, 90]),
            [(0, 10, ramp(0, 10, false)), (10, 30, level(10)), (30, 40, level(90)),]
        );
    }

    #[test]
    fn short_pieces_are_joined_but_for_a_single_one() {
        assert_eq!(
            pieces(15, &[0, 0, 50, 0, 0, 50, 0, 50, 0, 0]),
            [(0, 20, level(0)), (20, 30, level(50)), (30, 50, level(0)), (50, 80, Shape::Busy), (80, 100, level(0)),]
        );
    }

    proptest! {
        #[test]
        fn pieces_cover_the_recording_without_gap_and_are_few(
            values in proptest::collection::vec(0i64..40, 1..300), shortest in 0i64..60
        ) {
            let pieces = pieces(shortest, &values);
            let end = 10 * i64::try_from(values.len()).expect("few");
            prop_assert_eq!(pieces[0].0, 0);
            prop_assert_eq!(pieces[pieces.len() - 1].1, end);
            prop_assert!(pieces.windows(2).all(|pair| pair[0].1 == pair[1].0), "{:?}", pieces);
            if let Some(most) = end.checked_div(shortest) {
                prop_assert!(i64::try_from(pieces.len()).expect("few") <= 2 * most + 4, "{:?}", pieces);
            }
        }

        #[test]
        fn any_times_and_values_are_drawn(records: Vec<(i64, i64)>, end: i64) {
            let mut lane = lane(Elementary::Time, 1000);
            for (now, value) in records {
                lane.record(now, Value::time(value));
            }
            lane.finish(end);
        }
    }
}
