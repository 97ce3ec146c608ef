//! Drawing one lane: as a square wave, a bus, or a curve.

use svg::node::element::{Group, Path, Rectangle};

use super::axis::{Axis, duration};
use super::lane::{Lane, Piece, Shape, number};
use super::{VALUE_ADVANCE, class, draw_to, is_wave, px, text};
use crate::elementary::{Elementary, Value};
use crate::trace::Spelled;

/// Pieces from which a number is a curve, because their values would no longer fit.
const MANY_PIECES: usize = 48;
/// How far the ends of a bus are slanted, in pixels.
const SLANT: f64 = 3.0;
/// Room between a lane's lines and those of the next.
const INSET: f64 = 7.0;

/// How a lane is drawn.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Style {
    Square,
    Bus,
    Curve,
}

fn style(lane: &Lane) -> Style {
    if is_wave(lane.signal.ty()) {
        Style::Square
    } else if lane.has_ramp() || lane.pieces.len() >= MANY_PIECES {
        Style::Curve
    } else {
        Style::Bus
    }
}

/// The height of a lane in pixels.
pub(super) fn height(lane: &Lane) -> f64 {
    match style(lane) {
        Style::Square | Style::Bus => 34.0,
        Style::Curve => 54.0,
    }
}

/// A lane's wave, whose upper edge is `top`.
pub(super) fn draw(lane: &Lane, axis: &Axis, top: f64, cycle: i64) -> Group {
    let band = Band { axis, high: top + INSET, low: top + height(lane) - INSET };
    let group = Group::new();
    if lane.pieces.is_empty() {
        return group;
    }
    let class = class(lane.signal.area());
    match style(lane) {
        Style::Square => band.square(group, lane, class),
        Style::Bus => band.bus(group, lane, class),
        Style::Curve => band.curve(group, lane, class, cycle),
    }
}

/// Where a lane's lines are.
struct Band<'a> {
    axis: &'a Axis,
    high: f64,
    low: f64,
}

impl Band<'_> {
    /// From where to where a piece goes.
    fn ends(&self, piece: &Piece) -> (f64, f64) {
        (self.axis.x(piece.start), self.axis.x(piece.end))
    }

    fn square(&self, group: Group, lane: &Lane, class: &str) -> Group {
        let (mut line, mut area) = (String::new(), String::new());
        let mut group = group;
        for piece in &lane.pieces {
            let (start, end) = self.ends(piece);
            let y = match piece.shape {
                Shape::Level(value) if !value.is_true() => self.low,
                Shape::Level(_) | Shape::Ramp { .. } => self.high,
                Shape::Busy => {
                    group = group.add(self.busy(start, end));
                    continue;
                }
            };
            if y == self.high {
                draw_to(&mut area, 'M', &[start, self.low]);
                draw_to(&mut area, 'V', &[self.high]);
                draw_to(&mut area, 'H', &[end]);
                draw_to(&mut area, 'V', &[self.low]);
                area.push('Z');
            }
            let command = if line.is_empty() { 'M' } else { 'L' };
            draw_to(&mut line, command, &[start, y]);
            draw_to(&mut line, 'H', &[end]);
        }
        self.paths(group, class, line, area)
    }

    fn bus(&self, group: Group, lane: &Lane, class: &str) -> Group {
        let mut line = String::new();
        let mut group = group;
        let middle = (self.high + self.low) / 2.0;
        for (index, piece) in lane.pieces.iter().enumerate() {
            let (start, end) = self.ends(piece);
            let Shape::Level(value) = piece.shape else {
                group = group.add(self.busy(start, end));
                continue;
            };
            let slant = SLANT.min((end - start) / 2.0);
            // Open where the picture ends, since the value was there before and stays.
            let (open_left, open_right) = (index == 0, index + 1 == lane.pieces.len());
            for y in [self.high, self.low] {
                draw_to(&mut line, 'M', &[start, if open_left { y } else { middle }]);
                draw_to(&mut line, 'L', &[start + slant, y]);
                draw_to(&mut line, 'H', &[end - slant]);
                draw_to(&mut line, 'L', &[end, if open_right { y } else { middle }]);
            }
            let label = label(value);
            if fits(&label, end - start - 2.0 * slant) {
                let label = text(&label, (start + end) / 2.0, middle + 4.0);
                group = group.add(label.set("class", "value").set("text-anchor", "middle"));
            }
        }
        self.paths(group, class, line, String::new())
    }

    fn curve(&self, group: Group, lane: &Lane, class: &str, cycle: i64) -> Group {
        let least = if lane.signal.ty() == Elementary::Time { lane.least.min(0.0) } else { lane.least };
        let span = lane.greatest - least;
        let y = |number: f64| {
            let part = if span > 0.0 && span.is_finite() { (number - least) / span } else { 0.0 };
            // No number at all is drawn at the bottom.
            self.low - if part.is_nan() { 0.0 } else { part.clamp(0.0, 1.0) } * (self.low - self.high)
        };
        let (mut line, mut group) = (String::new(), group);
        for (index, piece) in lane.pieces.iter().enumerate() {
            let (start, end) = self.ends(piece);
            let (from, to) = match piece.shape {
                Shape::Level(value) => (number(value), number(value)),
                Shape::Ramp { from, to, .. } => (from as f64, to as f64),
                Shape::Busy => {
                    group = group.add(self.busy(start, end));
                    continue;
                }
            };
            let command = if line.is_empty() { 'M' } else { 'L' };
            draw_to(&mut line, command, &[start, y(from)]);
            draw_to(&mut line, 'L', &[end, y(to)]);
            let next = lane.pieces.get(index + 1);
            // A rise that stays where it arrived took the preset time; one that is higher later was only held up.
            let rises_later = lane.pieces.get(index + 2).is_some_and(|later| match later.shape {
                Shape::Level(value) => number(value) > to,
                Shape::Ramp { from: value, .. } => value as f64 > to,
                Shape::Busy => false,
            });
            let stays = !rises_later
                && next.is_some_and(|next| {
                    matches!(next.shape, Shape::Level(_)) && next.end.saturating_sub(next.start) > cycle
                });
            if let Shape::Ramp { from: 0, to, .. } = piece.shape
                && stays
            {
                let stays_until = next.map_or(end, |next| self.axis.x(next.end));
                group = preset(group, start, end, stays_until, y(to as f64), &format!("T={}", duration(to)));
            }
        }
        let mut area = String::new();
        if let (Some(first), Some(last)) = (lane.pieces.first(), lane.pieces.last()) {
            area.clone_from(&line);
            draw_to(&mut area, 'L', &[self.axis.x(last.end), self.low]);
            draw_to(&mut area, 'H', &[self.axis.x(first.start)]);
            area.push('Z');
        }
        if lane.signal.ty() != Elementary::Time {
            for (number, y) in [(lane.greatest, self.high + 4.0), (least, self.low + 4.0)] {
                // A REAL in its own shortest form, not in that of the same LREAL.
                let spelled = Value::real(lane.signal.ty(), number).map(|value| Spelled(value).to_string());
                let label = spelled.unwrap_or_else(|| number.to_string());
                let label = text(&label, self.axis.left() - 4.0, y);
                group = group.add(label.set("class", "small").set("text-anchor", "end"));
            }
        }
        self.paths(group, class, line, area)
    }

    fn busy(&self, start: f64, end: f64) -> Rectangle {
        Rectangle::new()
            .set("x", px(start))
            .set("y", px(self.high))
            .set("width", px((end - start).max(0.5)))
            .set("height", px(self.low - self.high))
            .set("fill", "url(#busy)")
    }

    fn paths(&self, group: Group, class: &str, line: String, area: String) -> Group {
        let mut group = group;
        if !area.is_empty() {
            group = group.add(Path::new().set("class", format!("{class} fill")).set("d", area));
        }
        group.add(Path::new().set("class", format!("{class} wave")).set("d", line))
    }
}

/// A measure from the start of a ramp to its end, with the time that it took: in the half above the ramp, or where
/// that is too narrow, behind it.
fn preset(group: Group, start: f64, end: f64, stays_until: f64, y: f64, label: &str) -> Group {
    // At the height of the label's lower edge the ramp has gone two thirds of its way.
    let x = if fits(label, (end - start) * 0.66 - 6.0) {
        start + 6.0
    } else if fits(label, stays_until - end) {
        end + 4.0
    } else {
        return group;
    };
    let mut measure = String::new();
    draw_to(&mut measure, 'M', &[start, y - 3.0]);
    draw_to(&mut measure, 'V', &[y + 3.0]);
    draw_to(&mut measure, 'M', &[start, y]);
    draw_to(&mut measure, 'H', &[end]);
    let head = 5f64.min((end - start) / 3.0);
    for (tip, back) in [(start, start + head), (end, end - head)] {
        draw_to(&mut measure, 'M', &[back, y - 2.5]);
        draw_to(&mut measure, 'L', &[tip, y]);
        draw_to(&mut measure, 'L', &[back, y + 2.5]);
    }
    group.add(Path::new().set("class", "preset").set("d", measure)).add(text(label, x, y + 14.0).set("class", "value"))
}

/// A value as a bus shows it.
fn label(value: Value) -> String {
    if value.ty() == Elementary::Time { duration(value.bits().cast_signed()) } else { Spelled(value).to_string() }
}

/// Whether a value's text fits into so many pixels.
fn fits(label: &str, width: f64) -> bool {
    label.chars().count() as f64 * VALUE_ADVANCE + 4.0 <= width
}
