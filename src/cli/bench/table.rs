//! What was measured, as a table for people and as JSON for programs.

use std::fmt::Write as _;

use serde::Serialize;

use super::to_f64;

/// All engines on one program.
#[derive(Serialize)]
pub(super) struct Measured {
    pub(super) program: String,
    pub(super) rungs: usize,
    pub(super) rows: Vec<Row>,
}

/// One engine on one program. What is not known is left out.
#[derive(Serialize)]
pub(super) struct Row {
    pub(super) engine: &'static str,
    /// A scan, the median.
    #[serde(rename = "nanoseconds_a_scan", skip_serializing_if = "Option::is_none")]
    pub(super) nanoseconds: Option<f64>,
    #[serde(rename = "compile_milliseconds", skip_serializing_if = "Option::is_none")]
    pub(super) compile_ms: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) code_bytes: Option<usize>,
    /// Executed in a scan.
    #[serde(rename = "instructions_a_scan", skip_serializing_if = "Option::is_none")]
    pub(super) instructions: Option<f64>,
    /// The compiler was stopped then.
    #[serde(rename = "stopped_after_milliseconds", skip_serializing_if = "Option::is_none")]
    pub(super) stopped_after_ms: Option<f64>,
    /// The compiler is not installed.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub(super) missing: bool,
}

impl Row {
    pub(super) const fn new(engine: &'static str) -> Self {
        Self {
            engine,
            nanoseconds: None,
            compile_ms: None,
            code_bytes: None,
            instructions: None,
            stopped_after_ms: None,
            missing: false,
        }
    }
}

impl Measured {
    /// The row of an engine.
    pub(super) fn row(&self, engine: &str) -> Option<&Row> {
        self.rows.iter().find(|row| row.engine == engine)
    }

    /// Nanoseconds of the fastest and of the slowest engine. A clock may be too coarse to see a scan at all.
    pub(super) fn extremes(&self) -> (f64, f64) {
        let known = self.rows.iter().filter_map(|row| row.nanoseconds);
        let (least, most) = known.fold((f64::INFINITY, 0.1f64), |(least, most), one| (least.min(one), most.max(one)));
        (least.max(0.1), most)
    }
}

/// A JSON list of the programs, each with its engines.
pub(super) fn json(measured: &[Measured]) -> String {
    // Numbers, texts and lists of them can always be written.
    serde_json::to_string_pretty(measured).unwrap_or_default() + "\n"
}

/// The table. Ratios are to the first engine, and a full bar is the slowest.
pub(super) fn text(measured: &[Measured]) -> String {
    let mut table = format!(
        "{:<20} {:>6} {:<15} {:>11} {:>8} {:>7}  {:<BAR$} {:>10} {:>10} {:>10}\n",
        "program", "rungs", "engine", "ns/scan", "ns/rung", "ratio", "", "compile ms", "bytes/rung", "instr/rung"
    );
    for measured in measured {
        let (fastest, slowest) = measured.extremes();
        let first = measured.rows.first().and_then(|row| row.nanoseconds).unwrap_or(fastest).max(0.1);
        for row in &measured.rows {
            let known = |value: Option<f64>, digits: usize| {
                value.map_or_else(|| "-".to_owned(), |value| format!("{value:.digits$}"))
            };
            let a_rung = |value: Option<f64>| {
                known(value.filter(|_| measured.rungs > 0).map(|value| value / to_f64(measured.rungs)), 1)
            };
            let compile = match row.stopped_after_ms {
                Some(after) => format!("> {after:.0}"),
                None => known(row.compile_ms, 2),
            };
            // Writing to a string does not fail.
            let _ = writeln!(
                table,
                "{:<20} {:>6} {:<15} {:>11} {:>8} {:>7}  {:<BAR$} {:>10} {:>10} {:>10}",
                measured.program,
                measured.rungs,
                row.engine,
                known(row.nanoseconds, 1),
                a_rung(row.nanoseconds),
                known(row.nanoseconds.map(|nanoseconds| nanoseconds / first), 2),
                row.nanoseconds.map_or_else(String::new, |nanoseconds| bar(nanoseconds / slowest)),
                compile,
                a_rung(row.code_bytes.map(to_f64)),
                a_rung(row.instructions),
            );
        }
    }
    table
}

/// Cells of the longest bar.
const BAR: usize = 16;

/// A bar of a length from 0 to 1, at least a sliver.
fn bar(share: f64) -> String {
    (0..BAR).take_while(|cell| *cell == 0 || share * to_f64(BAR) >= to_f64(*cell) + 0.5).map(|_| '█').collect()
}
