//! One drawing of the live view: lines of text for a terminal of a given size.

use rung_runtime::host::{Histogram, Statistics};
use unicode_width::{UnicodeWidthChar, UnicodeWidthStr};

use super::super::points::{Block, Point, Points, shown};
use super::super::time::{exact, rounded};
use crate::cli::tasks;
use crate::elementary::{Elementary, Value};

/// What is drawn.
pub(super) struct State<'a> {
    pub title: &'a str,
    pub engine: &'a str,
    /// Nanoseconds.
    pub cycle: i64,
    /// Nanoseconds since the controller started.
    pub now: i64,
    pub statistics: &'a Statistics,
    pub points: &'a Points,
    /// The image after some late scan.
    pub image: &'a [u8],
    /// An input as it is set on the panel.
    pub inputs: &'a dyn Fn(&Point) -> Value,
    /// The place of the input that keys change.
    pub selected: Option<usize>,
}

/// Columns from one item to the next.
const COLUMN: usize = 26;
/// Cells of a bar.
const BAR: u64 = 12;

/// The lines, each at most `width` columns wide, at most `height` of them.
pub(super) fn lines(state: &State<'_>, width: usize, height: usize) -> Vec<String> {
    let mut body = Vec::new();
    let inputs = state.points.inputs.iter().enumerate().map(|(index, input)| {
        let key = input.key.map_or_else(|| "   ".to_owned(), |key| format!("[{key}]"));
        let mark = if state.selected == Some(index) { ">" } else { " " };
        format!("{mark}{key} {}", named(input, (state.inputs)(input)))
    });
    section(&mut body, "inputs", inputs, width);
    let held = |point: &Point| format!("     {}", named(point, point.slot.read(state.image)));
    section(&mut body, "outputs", state.points.outputs.iter().map(held), width);
    if !state.points.blocks.is_empty() {
        body.push(String::new());
        body.push("blocks".to_owned());
        body.extend(state.points.blocks.iter().map(|shown| block(shown, state.image)));
    }
    section(&mut body, "variables", state.points.variables.iter().map(held), width);

    let mut lines = head(state);
    // The last line is for the keys, one more for what there is no room for.
    let room = height.saturating_sub(lines.len() + 1);
    if body.len() > room {
        let hidden = body.len() - room.saturating_sub(1);
        body.truncate(room.saturating_sub(1));
        body.push(format!("… {hidden} more lines"));
    }
    lines.append(&mut body);
    lines.truncate(height.saturating_sub(1));
    lines.push("a key in brackets toggles or selects, + and - change a selected number, q ends".to_owned());
    for line in &mut lines {
        *line = fitted(line, width);
    }
    lines.truncate(height);
    lines
}

fn head(state: &State<'_>) -> Vec<String> {
    let seconds = state.now.max(0) / 100_000_000;
    let quantiles = |histogram: &Histogram| {
        let all = histogram.quantiles();
        [all.p50, all.p99, all.max].map(|value| format!("{:>9}", rounded(value))).join("")
    };
    let statistics = state.statistics;
    let mut lines = vec![
        format!(
            "{}   engine {}   cycle {}   {}.{} s",
            state.title,
            state.engine,
            exact(state.cycle),
            seconds / 10,
            seconds % 10
        ),
        format!("               p50      p99      max    {:>8} cycles", statistics.cycles()),
        format!("scan     {}    {:>8} overruns", quantiles(&statistics.scan), statistics.overruns()),
        format!("lateness {}    {:>8} skipped", quantiles(&statistics.lateness), statistics.skipped()),
    ];
    if state.points.is_faulty(state.image) {
        lines.push(tasks::FAULT.to_owned());
    }
    lines
}

/// Items in columns below a heading; nothing where there are none.
fn section(lines: &mut Vec<String>, heading: &str, items: impl Iterator<Item = String>, width: usize) {
    let columns = (width / COLUMN).max(1);
    let mut items = items.peekable();
    if items.peek().is_some() {
        lines.push(String::new());
        lines.push(heading.to_owned());
    }
    // One that is longer than a column takes several.
    let mut line = String::new();
    for item in items {
        let start = if line.is_empty() { 0 } else { (line.width() + 1).next_multiple_of(COLUMN) };
        if start > 0 && (start + item.width() > width || start / COLUMN >= columns) {
            lines.push(std::mem::take(&mut line));
        } else {
            line.extend(std::iter::repeat_n(' ', start - line.width()));
        }
        line.push_str(&item);
    }
    if !line.is_empty() {
        lines.push(line);
    }
}

/// A name and its value; of a BOOL a lamp.
fn named(point: &Point, value: Value) -> String {
    if value.ty() == Elementary::Bool {
        format!("{} {}", lamp(value), point.name)
    } else {
        format!("{} = {}", point.name, shown(value))
    }
}

fn lamp(value: Value) -> char {
    if value.is_true() { '●' } else { '○' }
}

fn block(block: &Block, image: &[u8]) -> String {
    let powers: Vec<String> = block
        .powers
        .iter()
        .map(|power| {
            let pin = power.name.rsplit('.').next().unwrap_or_default();
            format!("{} {pin}", lamp(power.slot.read(image)))
        })
        .collect();
    let reached = block.reached.as_ref().map(|reached| reached.slot.read(image));
    let preset = block.preset.as_ref().map(|preset| preset.value(image));
    let progress = match (reached, preset) {
        (Some(reached), Some(preset)) => {
            let bar = if reached.ty() == Elementary::Time { bar(reached, preset) } else { String::new() };
            format!("{bar}  {} of {}", shown_briefly(reached), shown_briefly(preset))
        }
        (Some(reached), None) => format!("  {}", shown_briefly(reached)),
        _ => String::new(),
    };
    format!("     {:<16} {:<6} {:<10}{progress}", block.name, block.kind.name(), powers.join("  "))
}

/// A value; of a TIME as a person reads a clock.
fn shown_briefly(value: Value) -> String {
    match (value.ty(), u64::try_from(value.bits().cast_signed())) {
        (Elementary::Time, Ok(0)) => "0 s".to_owned(),
        (Elementary::Time, Ok(nanoseconds)) => rounded(nanoseconds),
        _ => shown(value),
    }
}

/// How far a timer is.
fn bar(reached: Value, preset: Value) -> String {
    let [reached, preset] = [reached, preset].map(|time| time.bits().cast_signed().max(0).cast_unsigned());
    let share = u128::from(reached) * u128::from(BAR) / u128::from(preset.max(1));
    let full = usize::try_from(share.min(u128::from(BAR))).unwrap_or(0);
    let cells = usize::try_from(BAR).unwrap_or(0);
    format!("  {}{}", "█".repeat(full), "░".repeat(cells - full))
}

/// A line cut to a width, in columns of a terminal.
fn fitted(line: &str, width: usize) -> String {
    let mut used = 0;
    line.chars()
        .take_while(|c| {
            used += c.width().unwrap_or(0);
            used <= width
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cli::run::points::Preset;
    use crate::ladder::library::StandardBlock;
    use crate::logic::image::{Area, Slot};

    fn point(name: &str, ty: Elementary, offset: u32, key: Option<char>) -> Point {
        let initial = Value::from_bits(ty, 0);
        let slot = Slot { name: name.into(), ty, offset, area: Area::Memory, retain: false, initial, line: 0 };
        Point { name: name.to_owned(), slot, key }
    }

    fn points() -> Points {
        let block = Block {
            name: "delay".to_owned(),
            kind: StandardBlock::Ton,
            powers: vec![point("delay.Q", Elementary::Bool, 1, None)],
            reached: Some(point("delay.ET", Elementary::Time, 8, None)),
            preset: Some(Preset::Slot(point("preset", Elementary::Time, 16, None).slot)),
        };
        Points {
            inputs: vec![
                point("start", Elementary::Bool, 0, Some('1')),
                point("level", Elementary::Int, 2, Some('2')),
                point("stop", Elementary::Bool, 0, Some('3')),
            ],
            outputs: vec![point("pump", Elementary::Bool, 1, None)],
            variables: Vec::new(),
            blocks: vec![block],
            fault: Some(point("#fault", Elementary::Bool, 4, None).slot),
        }
    }

    fn drawn(width: usize, height: usize) -> Vec<String> {
        drawn_with(width, height, false)
    }

    fn drawn_with(width: usize, height: usize, fault: bool) -> Vec<String> {
        let (points, statistics) = (points(), Statistics::default());
        let mut image = vec![0; 24];
        image[1] = 1;
        image[4] = u8::from(fault);
        point("delay.ET", Elementary::Time, 8, None).slot.write(&mut image, Value::time(1_500_000_000));
        point("preset", Elementary::Time, 16, None).slot.write(&mut image, Value::time(6_000_000_000));
        let state = State {
            title: "plant",
            engine: "jit",
            cycle: 10_000_000,
            now: 12_345_000_000,
            statistics: &statistics,
            points: &points,
            image: &image,
            inputs: &|point| Value::from_bits(point.slot.ty, 1),
            selected: Some(1),
        };
        lines(&state, width, height)
    }

    #[test]
    fn everything_that_runs_is_shown() {
        let expected = "\
plant   engine jit   cycle 10ms   12.3 s
               p50      p99      max           0 cycles
scan          0 ns     0 ns     0 ns           0 overruns
lateness      0 ns     0 ns     0 ns           0 skipped

inputs
 [1] ● start              >[2] level = 1
 [3] ● stop

outputs
     ● pump

blocks
     delay            TON    ● Q         ███░░░░░░░░░  1.5 s of 6.0 s
a key in brackets toggles or selects, + and - change a selected number";
        assert_eq!(drawn(70, 30).join("\n"), expected);
    }

    #[test]
    fn an_index_out_of_range_is_told_below_the_statistics() {
        let (right, faulty) = (drawn(120, 30), drawn_with(120, 30, true));
        assert!(!right.contains(&tasks::FAULT.to_owned()));
        assert_eq!((faulty[..4].to_vec(), faulty[4].as_str()), (right[..4].to_vec(), tasks::FAULT));
        assert_eq!(faulty[5..], right[4..]);
    }

    #[test]
    fn a_long_item_takes_columns_of_its_own_and_none_is_cut_off() {
        let items = ["     a = 1", "     a_long_name = T#1m30s500ms", "     b", "     c", "     the_last = 12345678"];
        let mut lines = Vec::new();
        section(&mut lines, "variables", items.map(str::to_owned).into_iter(), 80);
        let expected = "
variables
     a = 1                     a_long_name = T#1m30s500ms
     b                         c                         the_last = 12345678";
        assert_eq!(lines.join("\n"), expected);
    }

    #[test]
    fn any_terminal_is_drawn_within_its_size() {
        for width in 0..90 {
            for height in 0..30 {
                let lines = drawn(width, height);
                assert!(lines.len() <= height, "{width} x {height}");
                assert!(lines.iter().all(|line| line.width() <= width), "{width} x {height}");
            }
        }
        assert!(drawn(60, 10).join("\n").contains("… 6 more lines"));
    }
}
