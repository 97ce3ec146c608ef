//! What a variable was in all plants and scans, in a few numbers.

use std::fmt::Write as _;

use super::super::super::Failure;
use crate::batch::{Part, Variable};
use crate::diagnostic::Code;
use crate::elementary::{Elementary, Value};
use crate::logic::{Area, Layout, SlotId};
use crate::trace::{Signal, Spelled};

/// The variables to sum up: those that are named, or all outputs, or without any all that are no inputs.
pub(super) fn shown(layout: &Layout, names: Option<&[String]>) -> Result<Vec<(Signal, SlotId)>, Failure> {
    let all = Signal::all(layout);
    let signals = match names {
        Some(names) => Signal::select(layout, names)
            .map_err(|name| Failure::new(Code::UndeclaredName, format!("there is no variable `{name}` to sum up")))?,
        None if all.iter().any(|signal| signal.area() == Area::Output) => {
            all.into_iter().filter(|signal| signal.area() == Area::Output).collect()
        }
        None => all.into_iter().filter(|signal| signal.area() != Area::Input).collect(),
    };
    let slot = |signal: &Signal| {
        let observed = layout.observed().iter().find(|observed| observed.name == signal.name());
        observed.map(|observed| observed.slot)
    };
    Ok(signals.into_iter().filter_map(|signal| slot(&signal).map(|slot| (signal, slot))).collect())
}

/// See the module.
#[derive(Clone, Debug)]
pub(super) struct Summary {
    ty: Elementary,
    count: u64,
    /// Of a BOOL.
    on: u64,
    /// Of another type: the least and the greatest, and the sum.
    ends: Option<(Value, Value)>,
    sum: f64,
}

impl Summary {
    pub(super) fn new(ty: Elementary) -> Self {
        Self { ty, count: 0, on: 0, ends: None, sum: 0.0 }
    }

    /// Adds what a variable is in the lanes of a part.
    pub(super) fn add(&mut self, part: &Part<'_>, variable: Variable) {
        self.count += part.lanes() as u64;
        if self.ty == Elementary::Bool {
            let words = (0..part.words()).filter_map(|word| part.word(word, variable).ok());
            self.on += words.map(|word| u64::from(word.count_ones())).sum::<u64>();
            return;
        }
        for value in (0..part.lanes()).filter_map(|lane| part.get(lane, variable).ok()) {
            self.sum += number(value);
            self.stretch(value, value);
        }
    }

    /// Adds what another sums up.
    pub(super) fn join(&mut self, other: &Self) {
        self.count += other.count;
        self.on += other.on;
        self.sum += other.sum;
        if let Some((least, greatest)) = other.ends {
            self.stretch(least, greatest);
        }
    }

    fn stretch(&mut self, least: Value, greatest: Value) {
        let (low, high) = self.ends.get_or_insert((least, greatest));
        if less(least, *low) {
            *low = least;
        }
        if less(*high, greatest) {
            *high = greatest;
        }
    }
}

fn less(a: Value, b: Value) -> bool {
    match (a.as_integer(), b.as_integer()) {
        (Some(a), Some(b)) => a < b,
        _ => number(a) < number(b),
    }
}

fn number(value: Value) -> f64 {
    #[expect(clippy::cast_precision_loss, reason = "a mean for people to read")]
    value.as_real().or(value.as_integer().map(|integer| integer as f64)).unwrap_or_default()
}

/// A row for each variable.
pub(super) fn table(shown: &[(Signal, SlotId)], summaries: &[Summary], unlike: &[usize], lanes: usize) -> String {
    let width = shown.iter().map(|(signal, _)| signal.name().chars().count()).max().unwrap_or(0).max(8);
    let mut table = format!(
        "{:<width$} {:<5} {:>9} {:>12} {:>12} {:>12} {:>16}\n",
        "variable", "type", "on", "min", "mean", "max", "unlike lane 0"
    );
    for (((signal, _), summary), unlike) in shown.iter().zip(summaries).zip(unlike) {
        #[expect(clippy::cast_precision_loss, reason = "shares for people to read")]
        let (count, on) = (summary.count.max(1) as f64, summary.on as f64);
        let [on, least, mean, greatest] = if summary.ty == Elementary::Bool {
            [format!("{:.3} %", on / count * 100.0), String::new(), String::new(), String::new()]
        } else {
            let mean = summary.sum / count / if summary.ty == Elementary::Time { 1e6 } else { 1.0 };
            let none = Value::default_of(summary.ty);
            let (least, greatest) = summary.ends.unwrap_or((none, none));
            [String::new(), Spelled(least).to_string(), format!("{mean:.3}"), Spelled(greatest).to_string()]
        };
        // Writing to a string does not fail.
        let _ = writeln!(
            table,
            "{:<width$} {:<5} {on:>9} {least:>12} {mean:>12} {greatest:>12} {:>16}",
            signal.name(),
            summary.ty.name(),
            format!("{unlike} of {lanes}"),
        );
    }
    table
}

/// A rate in the unit that suits it.
pub(super) fn rounded(rate: f64) -> String {
    match rate {
        rate if rate >= 1e9 => format!("{:.2} billion", rate / 1e9),
        rate if rate >= 1e6 => format!("{:.1} million", rate / 1e6),
        rate => format!("{rate:.0}"),
    }
}
