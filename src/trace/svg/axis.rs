//! The time axis: where a time is, and which times have a tick.

use svg::node::element::{Group, Line, Path};

use super::{Period, px, text};
use crate::simulate::decimal::Scaled;

/// Ticks that an axis has at most.
const MOST_TICKS: i128 = 12;

/// Units that times are told in: name, nanoseconds, and the finest step between ticks.
const UNITS: [(&str, i64, i64); 6] = [
    ("ns", 1, 1),
    ("µs", 1_000, 1),
    ("ms", 1_000_000, 1),
    ("s", 1_000_000_000, 1),
    ("min", 60_000_000_000, 60_000_000_000),
    ("h", 3_600_000_000_000, 3_600_000_000_000),
];

/// An axis over a period.
#[derive(Debug)]
pub(super) struct Axis {
    left: f64,
    width: f64,
    start: i64,
    /// From the start to the right end, above 0.
    length: i64,
    /// Nanoseconds between ticks.
    step: i64,
    unit: (&'static str, i64),
}

impl Axis {
    pub(super) fn new(left: f64, width: f64, period: &Period) -> Self {
        let (start, length) = (period.start, period.end.saturating_sub(period.start).max(1));
        // Two of a unit, so that the numbers are not all below 1; minutes and hours, which are not decimal, later.
        let fits = |unit: &&(&str, i64, i64)| length / unit.1 >= if unit.2 == 1 { 2 } else { 10 };
        let (name, unit, finest) = *UNITS.iter().rev().find(fits).unwrap_or(&UNITS[0]);
        let steps = (0..19u32).flat_map(|power| [1, 2, 5].map(|digit| i128::from(finest) * digit * 10i128.pow(power)));
        let step = steps.into_iter().find(|step| i128::from(length) / step <= MOST_TICKS).unwrap_or(i128::from(length));
        Self { left, width, start, length, step: i64::try_from(step).unwrap_or(i64::MAX), unit: (name, unit) }
    }

    /// The place of a time, in pixels.
    pub(super) fn x(&self, time: i64) -> f64 {
        self.left + self.width * (time.saturating_sub(self.start) as f64 / self.length as f64)
    }

    /// The place of its left end, in pixels.
    pub(super) fn left(&self) -> f64 {
        self.left
    }

    fn ticks(&self) -> impl Iterator<Item = i64> {
        let first = self.start.div_euclid(self.step) + i64::from(self.start.rem_euclid(self.step) != 0);
        let last = self.start.saturating_add(self.length).div_euclid(self.step);
        (first..=last).map(|index| index * self.step)
    }

    /// Light lines from top to bottom at the ticks.
    pub(super) fn grid(&self, top: f64, bottom: f64) -> Group {
        self.ticks().fold(Group::new().set("class", "grid"), |group, time| {
            let x = px(self.x(time));
            group.add(Line::new().set("x1", x).set("x2", x).set("y1", top).set("y2", px(bottom)))
        })
    }

    /// The axis with an arrow, ticks, numbers and the unit, below `y` or above it.
    pub(super) fn draw(&self, y: f64, above: bool) -> Group {
        let (out, baseline) = if above { (-5.0, y - 9.0) } else { (5.0, y + 18.0) };
        let right = self.left + self.width;
        let mut lines = format!("M{} {}H{}", px(self.left), px(y), px(right + 14.0));
        lines.push_str(&format!("m-6 -3l6 3l-6 3M{} {}", px(self.left), px(y)));
        let mut group = Group::new();
        for time in self.ticks() {
            let x = px(self.x(time));
            lines.push_str(&format!("M{x} {}v{out}", px(y)));
            let number = text(&self.label(time), x, baseline).set("class", "small").set("text-anchor", "middle");
            group = group.add(number);
        }
        let unit = text(self.unit.0, right + 20.0, y + 3.5).set("class", "small");
        group.add(Path::new().set("class", "axis").set("d", lines)).add(unit)
    }

    fn label(&self, time: i64) -> String {
        match decimals(self.unit.1) {
            Some(decimals) => Scaled(time, decimals).to_string(),
            None => (time / self.unit.1).to_string(),
        }
    }
}

/// The power of ten that a decimal unit has of nanoseconds.
fn decimals(unit: i64) -> Option<u32> {
    let decimals = unit.ilog10();
    (10i64.pow(decimals) == unit).then_some(decimals)
}

/// A duration in the unit that suits it, exactly.
pub(super) fn duration(nanoseconds: i64) -> String {
    let magnitude = nanoseconds.unsigned_abs();
    let decimal = UNITS.iter().rev().filter(|unit| unit.2 == 1);
    let (name, unit, _) = decimal.into_iter().find(|unit| magnitude >= unit.1.unsigned_abs()).unwrap_or(&UNITS[3]);
    format!("{} {name}", Scaled(nanoseconds, unit.ilog10()))
}
