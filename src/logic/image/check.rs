//! What a layout must fulfil, whether it was computed, parsed or read from a map. It must never trust a number.

use std::collections::HashSet;
use std::ops::Range;

use super::{ALIGNMENT, Area, EarlierLayout, KeptSlot, MAXIMUM_SIZE, TAIL_PADDING};
use crate::elementary::Elementary;

impl EarlierLayout {
    /// What is wrong with it; nothing, if an image may be laid out so. It is checked that
    ///
    /// - the size is a multiple of the alignment, at most the largest, and leaves the tail padding free;
    /// - names are unique, slots aligned and inside, and no two overlap;
    /// - runs are inside and in order, and none of the inputs overlaps one of the outputs or of the retained;
    /// - a slot lies inside a run of its part, and of the retained if it is, and outside all others;
    /// - a BOOL input lies where BOOLs are, and nothing else does.
    pub fn problems(&self) -> Vec<String> {
        let mut problems = Vec::new();
        if self.size > MAXIMUM_SIZE || !self.size.is_multiple_of(ALIGNMENT) || self.size < TAIL_PADDING {
            problems.push(format!("an image cannot have {} bytes", self.size));
        }
        let end = self.size.saturating_sub(TAIL_PADDING);
        let inputs: Vec<Range<u32>> = self.inputs.iter().map(|extent| extent.bytes.clone()).collect();
        let bools: Vec<Range<u32>> = self.inputs.iter().map(|extent| extent.bools.clone()).collect();
        let runs = [("input", &inputs), ("output", &self.outputs), ("retained", &self.retained), ("BOOL", &bools)];
        for (what, runs) in runs {
            problems.extend(misplaced(runs, end).map(|run| format!("the {what} run {run:?} is misplaced")));
        }
        let holds = |whole: &Range<u32>, part: &Range<u32>| whole.start <= part.start && part.end <= whole.end;
        let strays = self.inputs.iter().filter(|extent| !holds(&extent.bytes, &extent.bools));
        problems.extend(strays.map(|extent| format!("the BOOLs {:?} are not inside their run", extent.bools)));
        if !problems.is_empty() {
            // What follows searches the runs and needs them in order.
            return problems;
        }
        for other in self.outputs.iter().chain(&self.retained) {
            if cover(&inputs, other) != Cover::None {
                problems.push(format!("the run {other:?} overlaps the inputs"));
            }
        }
        let mut names = HashSet::new();
        for slot in &self.slots {
            let KeptSlot { name, ty, area, retain, offset } = slot;
            if !names.insert(name) {
                problems.push(format!("`{name}` is there twice"));
            }
            if !offset.is_multiple_of(ty.size()) || u64::from(*offset) + u64::from(ty.size()) > u64::from(end) {
                problems.push(format!("`{name}` cannot lie at {offset}"));
                continue;
            }
            let memberships = [
                ("an input", &inputs, *area == Area::Input),
                ("an output", &self.outputs, *area == Area::Output),
                ("retained", &self.retained, *retain),
                ("a BOOL input", &bools, *area == Area::Input && *ty == Elementary::Bool),
            ];
            for (what, runs, is) in memberships {
                if cover(runs, &slot.bytes()) != if is { Cover::Whole } else { Cover::None } {
                    let word = if is { "is" } else { "is not" };
                    problems.push(format!("`{name}` at {offset} {word} {what}, unlike the run that it lies in"));
                }
            }
        }
        let mut sorted: Vec<&KeptSlot> = self.slots.iter().collect();
        sorted.sort_by_key(|slot| slot.offset);
        for pair in sorted.windows(2) {
            if u64::from(pair[0].offset) + u64::from(pair[0].ty.size()) > u64::from(pair[1].offset) {
                problems.push(format!("`{}` and `{}` overlap", pair[0].name, pair[1].name));
            }
        }
        problems
    }
}

impl KeptSlot {
    fn bytes(&self) -> Range<u32> {
        self.offset..self.offset + self.ty.size()
    }
}

/// The runs that are outside `0..end` or not behind the one before.
fn misplaced(runs: &[Range<u32>], end: u32) -> impl Iterator<Item = &Range<u32>> {
    let befores = std::iter::once(0).chain(runs.iter().map(|run| run.end));
    runs.iter()
        .zip(befores)
        .filter(move |(run, before)| run.start < *before || run.end < run.start || run.end > end)
        .map(|(run, _)| run)
}

#[derive(PartialEq, Eq)]
enum Cover {
    None,
    Part,
    Whole,
}

/// How much of `bytes` lies in one of the runs, which are in order.
fn cover(runs: &[Range<u32>], bytes: &Range<u32>) -> Cover {
    match runs.get(runs.partition_point(|run| run.end <= bytes.start)) {
        Some(run) if run.start <= bytes.start && bytes.end <= run.end => Cover::Whole,
        Some(run) if run.start < bytes.end => Cover::Part,
        _ => Cover::None,
    }
}
