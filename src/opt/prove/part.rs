//! Parts of two programs that correspond, and the proof of one of them.

use std::collections::BTreeSet;
use std::ops::Range;

use super::graph::Literal;
use super::judge::{Method, Verdict};
use super::scan::{self, Pair, Stored, Turn, execute};
use super::space::Space;
use super::witness::Machine;
use super::{Difference, Report, Unproved};
use crate::logic::{Origin, Program, SlotId, random};
use crate::opt::check::last_store;

/// Random images on which a part is executed of which something is not proved.
const IMAGES: u64 = 64;

/// Sections of two programs that have to compute the same.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(super) struct Part {
    pub(super) before: Range<usize>,
    pub(super) after: Range<usize>,
}

/// The parts: they end where a chunk of the later program does, if no value crosses there in the earlier one.
///
/// Sections correspond by their numbers. Where there are more of them, one of the earlier program is several of the later
/// one, of the same origin, and only where another origin starts it is known which.
pub(super) fn parts(before: &Program, after: &Program) -> Vec<Part> {
    let crossed = crossed(before);
    let starts: Vec<(usize, usize)> = if before.sections.len() == after.sections.len() {
        (0..before.sections.len()).map(|section| (section, section)).collect()
    } else {
        let (from, to) = (runs(before), runs(after));
        let origins_fit = from.iter().map(|(origin, _)| origin).eq(to.iter().map(|(origin, _)| origin));
        if origins_fit { from.into_iter().zip(to).map(|(from, to)| (from.1, to.1)).collect() } else { vec![(0, 0)] }
    };
    let may_start = |(from, to): &(usize, usize)| *from == 0 || after.sections[*to].starts_chunk && !crossed[*from];
    let mut starts: Vec<(usize, usize)> = starts.into_iter().filter(may_start).collect();
    starts.push((before.sections.len(), after.sections.len()));
    let parts = starts.windows(2).map(|pair| Part { before: pair[0].0..pair[1].0, after: pair[0].1..pair[1].1 });
    parts.filter(|part| !part.before.is_empty() || !part.after.is_empty()).collect()
}

/// By section: whether a value of an earlier one is used in it or behind it.
fn crossed(program: &Program) -> Vec<bool> {
    let mut crossed = vec![false; program.sections.len()];
    let mut section_of = vec![0usize; program.instructions.len()];
    for section in 0..program.sections.len() {
        section_of[program.section_range(section)].fill(section);
    }
    // From the last one back: the first section that any instruction from here on reaches back to.
    let mut reach = usize::MAX;
    for section in (0..program.sections.len()).rev() {
        for instruction in &program.instructions[program.section_range(section)] {
            let made = instruction.op.operands().map(|operand| section_of[operand.index()]).min();
            reach = reach.min(made.unwrap_or(usize::MAX));
        }
        crossed[section] = reach < section;
    }
    crossed
}

/// The runs of sections of one origin, each with its first section.
fn runs(program: &Program) -> Vec<(u32, usize)> {
    let mut runs: Vec<(u32, usize)> = Vec::new();
    for (section, of) in program.sections.iter().enumerate() {
        if runs.last().is_none_or(|(origin, _)| *origin != of.origin) {
            runs.push((of.origin, section));
        }
    }
    runs
}

/// Proves a part, value by value.
pub(super) fn compare(
    before: &Program,
    after: &Program,
    part: &Part,
    machine: &Machine<'_>,
) -> Result<Report, Box<Difference>> {
    let mut proof = Proof { before, after, part, machine, report: Report::default() };
    let mut space = Space::new(&before.layout);
    let stored = execute(&mut space, before, part.before.clone(), Turn::First)
        .and_then(|old| Some((old, execute(&mut space, after, part.after.clone(), Turn::Second)?)));
    match stored {
        Some((old, new)) => proof.values(&mut space, &old, &new)?,
        None => proof.too_large(),
    }
    drop(space);
    if proof.report.unproved.is_empty() {
        return Ok(proof.report);
    }
    // Values that are made up for what functions compute may have hidden a difference that many images show.
    let shown = (0..IMAGES).find_map(|seed| {
        let (image, now) = (random::image(&before.layout, seed), random::now(seed));
        machine.difference(before, after, part, image, now)
    });
    shown.map_or(Ok(proof.report), |difference| Err(Box::new(difference)))
}

struct Proof<'a> {
    before: &'a Program,
    after: &'a Program,
    part: &'a Part,
    machine: &'a Machine<'a>,
    report: Report,
}

impl Proof<'_> {
    fn origin(&self, slot: SlotId) -> Option<Origin> {
        last_store([(self.before, self.part.before.clone()), (self.after, self.part.after.clone())], slot)
    }

    fn unproved(&mut self, slot: SlotId) {
        let name = self.before.layout.slot(slot).name.clone();
        self.report.unproved.push(Unproved { slot: name.to_string(), origin: self.origin(slot) });
    }

    /// Counts all that is stored as unproved.
    fn too_large(&mut self) {
        let all = [(self.before, &self.part.before), (self.after, &self.part.after)];
        let slots = all.into_iter().flat_map(|(program, sections)| {
            program.instructions[program.instruction_range(sections.clone())]
                .iter()
                .filter_map(|instruction| instruction.op.stores(&program.layout))
        });
        let slots: BTreeSet<SlotId> = slots.flat_map(|slots| (slots.start.0..slots.end.0).map(SlotId)).collect();
        slots.into_iter().for_each(|slot| self.unproved(slot));
    }

    fn values(&mut self, space: &mut Space<'_>, old: &Stored, new: &Stored) -> Result<(), Box<Difference>> {
        let mut open: Vec<(u32, Pair)> = Vec::new();
        for pair in scan::pairs(space, old, new) {
            if pair.before == pair.after {
                self.report.count(pair.took);
                continue;
            }
            let (old, new) = (space.bits(pair.before), space.bits(pair.after));
            let known = |(old, new): (&Literal, &Literal)| space.graph.find(*old) == space.graph.find(*new);
            if old.iter().zip(&*new).all(known) {
                self.report.count(pair.took);
            } else {
                open.push((old.iter().chain(&*new).map(|bit| bit.node()).max().unwrap_or(0), pair));
            }
        }
        // What others are made of comes first.
        open.sort_by_key(|(last, pair)| (*last, pair.slot));
        open.into_iter().try_for_each(|(_, pair)| self.value(space, pair))
    }

    fn value(&mut self, space: &mut Space<'_>, pair: Pair) -> Result<(), Box<Difference>> {
        let (old, new) = (space.bits(pair.before), space.bits(pair.after));
        space.took();
        for (old, new) in old.iter().zip(&*new) {
            match space.judge(*old, *new) {
                Verdict::Equal => {}
                Verdict::Differ(column, sample) => {
                    let (image, now) = space.sample(column, sample);
                    if let Some(difference) = self.machine.difference(self.before, self.after, self.part, image, now) {
                        return Err(Box::new(difference));
                    }
                    // An element of a long array decides, whose samples are made up.
                    self.unproved(pair.slot);
                    return Ok(());
                }
                Verdict::Unknown => {
                    self.unproved(pair.slot);
                    return Ok(());
                }
            }
        }
        // Where all is equal by now, what was found out for others made it so: by no less than this.
        self.report.count(pair.took.max(space.took()).max(Method::Exhaustion));
        Ok(())
    }
}
