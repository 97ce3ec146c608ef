//! A trace as a timing diagram, drawn as textbooks draw them: a lane a signal, over one time axis.
//!
//! BOOLs are square waves, numbers are buses with their values where these fit, and elapsed times are ramps. What
//! changes faster than lines can be seen apart is joined, so that the picture of a long trace is no larger than that
//! of a short one. The picture must depend on nothing but the recording.

mod axis;
mod lane;
mod wave;

use std::fmt::Write as _;
use std::io::{self, Write};

use svg::Document;
use svg::node::element::{Definitions, Group, Line, Path, Pattern, Rectangle, Style, Text, Title};
use unicode_width::UnicodeWidthStr;

use self::axis::Axis;
use self::lane::Lane;
use super::{Signal, Trace};
use crate::elementary::Elementary;
use crate::logic::Area;

/// Width of the time axis, in pixels.
const PLOT_WIDTH: f64 = 960.0;
/// Parts of the axis that are seen apart: a pixel and a half each, the width of a line.
const SHORTEST_PARTS: i64 = 640;
/// Room at the left, right and bottom edges.
const MARGIN: f64 = 24.0;
/// Where the lanes begin, below title and legend.
const TOP: f64 = 56.0;
/// Width of a character of a name, and of a value.
const NAME_ADVANCE: f64 = 7.3;
const VALUE_ADVANCE: f64 = 6.3;
/// Columns of a name that are shown.
const NAME_COLUMNS: usize = 36;
/// Lanes from which a second axis stands above them.
const MANY_LANES: usize = 16;

const STYLE: &str =
    "text { font-family: 'DejaVu Sans Mono', Menlo, Consolas, monospace; font-size: 12px; fill: #1d2733 }
.title { font-size: 15px; font-weight: bold }
.small { font-size: 10px; fill: #66727f }
.value { font-size: 10.5px }
.grid { stroke: #dde3ea; stroke-width: 1 }
.lane { stroke: #edf0f4; stroke-width: 1 }
.axis { stroke: #1d2733; stroke-width: 1; fill: none }
.preset { stroke: #66727f; stroke-width: 1; fill: none }
.input { stroke: #0b7285; fill: #0b7285 }
.output { stroke: #c2410c; fill: #c2410c }
.memory { stroke: #334e9e; fill: #334e9e }
.state { stroke: #5b6670; fill: #5b6670 }
.wave { stroke-width: 1.6; fill: none; stroke-linejoin: round }
.fill { fill-opacity: 0.13; stroke: none }";

impl Period {
    /// The period of scans at these times, in nanoseconds: from the first to as long after the last as the first two
    /// are apart, or a millisecond.
    pub fn of(mut times: impl DoubleEndedIterator<Item = i64>) -> Self {
        let start = times.next().unwrap_or(0);
        let cycle = times.next().map_or(1_000_000, |second| second.saturating_sub(start).max(1));
        let last = times.next_back().unwrap_or(start.saturating_add(cycle));
        Self { start, end: last.saturating_add(cycle), cycle }
    }
}

/// Collects what is recorded and draws it at the end.
#[derive(Debug)]
pub struct SvgTrace<W> {
    title: String,
    lanes: Vec<Lane>,
    period: Period,
    out: W,
}

/// The stretch of time that a diagram shows, in nanoseconds.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Period {
    /// The left end of the axis, not after the first scan.
    pub start: i64,
    /// The right end: the value after the last scan is drawn up to there.
    pub end: i64,
    /// The usual time from one scan to the next.
    pub cycle: i64,
}

impl<W: Write> SvgTrace<W> {
    /// A diagram of these signals over a period, with a title.
    pub fn new(title: &str, signals: Vec<Signal>, period: Period, out: W) -> Self {
        let shortest = period.end.saturating_sub(period.start) / SHORTEST_PARTS;
        let lanes = signals.into_iter().map(|signal| Lane::new(signal, shortest)).collect();
        Self { title: title.to_owned(), lanes, period, out }
    }

    fn draw(&self) -> Document {
        let names = self.lanes.iter().map(|lane| short_name(lane.signal.name()).width()).max().unwrap_or(0);
        let left = (MARGIN + 14.0 + names as f64 * NAME_ADVANCE + 14.0).ceil();
        let axis = Axis::new(left, PLOT_WIDTH, &self.period);
        let bottom = TOP + self.lanes.iter().map(wave::height).sum::<f64>();
        let many = self.lanes.len() >= MANY_LANES;
        let (width, height) = (left + PLOT_WIDTH + MARGIN + 30.0, bottom + 30.0 + MARGIN);

        let mut document = Document::new()
            .set("width", width)
            .set("height", height)
            .set("viewBox", (0, 0, width, height))
            .add(Style::new(STYLE))
            .add(Definitions::new().add(hatching()))
            .add(Rectangle::new().set("width", width).set("height", height).set("fill", "#ffffff"))
            .add(text(&self.title, MARGIN, 28.0).set("class", "title"))
            .add(self.legend(left + PLOT_WIDTH))
            .add(axis.grid(TOP, bottom))
            .add(axis.draw(bottom, false));
        if many {
            document = document.add(axis.draw(TOP, true));
        }
        let mut top = TOP;
        for lane in &self.lanes {
            let lane_height = wave::height(lane);
            let middle = top + lane_height / 2.0;
            let name = text(&short_name(lane.signal.name()), MARGIN + 14.0, middle + 4.0)
                .add(Title::new(clean(&format!("{} : {}", lane.signal.name(), lane.signal.ty()))));
            let marker = Rectangle::new()
                .set("class", class(lane.signal.area()))
                .set("x", MARGIN)
                .set("y", px(middle - 5.0))
                .set("width", 4)
                .set("height", 10);
            let separator = Line::new()
                .set("class", "lane")
                .set("x1", MARGIN)
                .set("x2", px(left + PLOT_WIDTH))
                .set("y1", px(top + lane_height))
                .set("y2", px(top + lane_height));
            document = document.add(separator).add(marker).add(name);
            document = document.add(wave::draw(lane, &axis, top, self.period.cycle));
            top += lane_height;
        }
        document
    }

    /// Which colour is what, at the right end of the title's line.
    fn legend(&self, right: f64) -> Group {
        let mut group = Group::new();
        let mut x = right;
        for area in [Area::State, Area::Memory, Area::Output, Area::Input] {
            if self.lanes.iter().any(|lane| lane.signal.area() == area) {
                let label = match area {
                    Area::Input => "input",
                    Area::Output => "output",
                    Area::Memory => "memory",
                    Area::State => "block",
                };
                x -= label.len() as f64 * 6.1;
                group = group.add(text(label, x, 28.0).set("class", "small"));
                x -= 8.0;
                let marker = Rectangle::new().set("class", class(area)).set("x", px(x)).set("y", 19);
                group = group.add(marker.set("width", 4).set("height", 10));
                x -= 16.0;
            }
        }
        group
    }
}

impl<W: Write> Trace for SvgTrace<W> {
    fn record(&mut self, now: i64, image: &[u8]) -> io::Result<()> {
        for lane in &mut self.lanes {
            lane.record(now, lane.signal.read(image));
        }
        Ok(())
    }

    fn finish(&mut self) -> io::Result<()> {
        for lane in &mut self.lanes {
            lane.finish(self.period.end);
        }
        writeln!(self.out, "{}", self.draw())?;
        self.out.flush()
    }
}

/// The fill of what changes too often to be drawn.
fn hatching() -> Pattern {
    Pattern::new()
        .set("id", "busy")
        .set("width", 4)
        .set("height", 4)
        .set("patternUnits", "userSpaceOnUse")
        .add(Rectangle::new().set("width", 4).set("height", 4).set("fill", "#c9d1da"))
        .add(Path::new().set("d", "M0 4L4 0").set("stroke", "#8b97a4").set("stroke-width", 1))
}

fn class(area: Area) -> &'static str {
    match area {
        Area::Input => "input",
        Area::Output => "output",
        Area::Memory => "memory",
        Area::State => "state",
    }
}

fn text(content: &str, x: f64, y: f64) -> Text {
    Text::new(clean(content)).set("x", px(x)).set("y", px(y))
}

/// A name that fits the column of names; the whole one is its tooltip.
fn short_name(name: &str) -> String {
    if name.width() <= NAME_COLUMNS {
        return name.to_owned();
    }
    let mut short = String::new();
    for c in name.chars() {
        if short.width() + 2 > NAME_COLUMNS {
            break;
        }
        short.push(c);
    }
    short + "…"
}

/// Text without the control characters that XML does not allow.
fn clean(text: &str) -> String {
    text.chars().map(|c| if c.is_control() || matches!(c, '\u{FFFE}' | '\u{FFFF}') { '\u{FFFD}' } else { c }).collect()
}

/// A coordinate to a hundredth of a pixel.
fn px(coordinate: f64) -> f64 {
    (coordinate * 100.0).round() / 100.0
}

/// Adds a command with its coordinates to the data of a path.
fn draw_to(path: &mut String, command: char, coordinates: &[f64]) {
    path.push(command);
    for (index, coordinate) in coordinates.iter().enumerate() {
        let separator = if index == 0 { "" } else { " " };
        // Writing to a string cannot fail.
        let _ = write!(path, "{separator}{}", px(*coordinate));
    }
}

/// Whether a lane of this type is drawn as a square wave.
fn is_wave(ty: Elementary) -> bool {
    ty == Elementary::Bool
}
