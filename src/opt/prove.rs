//! Proving that passes change nothing: both programs are executed, part by part, on an image of which nothing is known, and
//! what they store is proved equal, value by value.
//!
//! A part is a chunk of the later program and the same sections of the earlier one; a pass may change nothing across the
//! ends of chunks, so the parts are proved one by one, on all cores, from any image in which BOOLs are 0 or 1. What an
//! operation means is in `scan`, how two bits are proved equal in `judge`. Products, quotients, REALs and
//! elements of long arrays are functions of which only that equal operands have equal results is known (`function`), so
//! that some values may stay unproved: these are counted.
//!
//! A difference is told only where both programs, executed on a counterexample as
//! [`execute`](crate::logic::execute) does it, leave different images. No input makes this run for ever: all work is
//! bounded by counts, and no clock is read.

mod function;
mod graph;
mod judge;
mod part;
mod sat;
mod scan;
mod space;
mod witness;
mod word;

#[cfg(test)]
mod tests;

use std::fmt;

use super::Pass;
use crate::elementary::Value;
use crate::logic::{Origin, Problem, Program, Slot, Task, verify};
use crate::parallel;
use judge::Method;
use part::Part;
use witness::Machine;

/// What was proved of the values that are stored, each slot counted once a chunk.
#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub struct Report {
    /// Values that both programs compute by the same operations, as far as Rung can see without trying anything.
    pub by_structure: usize,
    /// Values that are equal for all values of the few bits that they are made of.
    pub exhaustively: usize,
    /// Values for which a SAT solver was needed.
    pub by_sat: usize,
    /// Values that may differ for all that is known.
    pub unproved: Vec<Unproved>,
}

/// A value that was not proved equal.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Unproved {
    /// The name of the slot that holds it.
    pub slot: String,
    /// Where the rung comes from that is the last to store it.
    pub origin: Option<Origin>,
}

impl Report {
    /// Values that were proved equal.
    pub fn proved(&self) -> usize {
        self.by_structure + self.exhaustively + self.by_sat
    }

    /// Counts a value that was proved.
    fn count(&mut self, method: Method) {
        match method {
            Method::Structure => self.by_structure += 1,
            Method::Exhaustion => self.exhaustively += 1,
            Method::Sat => self.by_sat += 1,
        }
    }

    fn add(&mut self, other: Self) {
        self.by_structure += other.by_structure;
        self.exhaustively += other.exhaustively;
        self.by_sat += other.by_sat;
        self.unproved.extend(other.unproved);
    }
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { by_structure, exhaustively, by_sat, unproved } = self;
        let (proved, all) = (self.proved(), self.proved() + unproved.len());
        write!(
            f,
            "{proved} of {all} stored values proved equal ({by_structure} by structure, {exhaustively} exhaustively, \
             {by_sat} by SAT), {} unproved",
            unproved.len()
        )
    }
}

/// A difference, with an image that shows it.
#[derive(Clone, PartialEq, Debug)]
pub struct Difference {
    /// Where the rung comes from that is the last to store what differs; `None` where none does.
    pub origin: Option<Origin>,
    /// What differs.
    pub slot: Slot,
    /// What it holds afterwards, and what it should hold.
    pub actual: Value,
    /// See `actual`.
    pub expected: Value,
    /// The image before.
    pub image: Vec<u8>,
    /// The time, in nanoseconds.
    pub now: i64,
    /// The slots whose values in that image make the difference, with these; all others are as they start.
    pub because: Vec<(String, Value)>,
}

impl fmt::Display for Difference {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "`{}`", self.slot.name)?;
        if let Some(Origin { label, line }) = &self.origin {
            write!(f, " of `{label}` (line {line})")?;
        }
        write!(f, " becomes {:?} in place of {:?}", self.actual, self.expected)?;
        let because = self.because.iter().map(|(name, value)| format!("`{name}` is {value:?}"));
        let now = (self.now != 0).then(|| format!("the time is {} ns", self.now));
        let because: Vec<String> = because.chain(now).collect();
        match because.split_last() {
            None => f.write_str(" on the image at the start"),
            Some((last, [])) => write!(f, " where {last}"),
            Some((last, others)) => write!(f, " where {} and {last}", others.join(", ")),
        }
    }
}

/// What is wrong with what passes made.
#[derive(Clone, PartialEq, Debug)]
pub enum Fault {
    /// It is no program.
    Broken {
        /// The pass that made it.
        pass: &'static str,
        /// What is wrong.
        problems: Vec<Problem>,
    },
    /// It has another layout, other origins or other tasks.
    Reshaped {
        /// The pass that made it.
        pass: &'static str,
    },
    /// It computes something else.
    Different {
        /// The first pass whose output shows the difference.
        pass: &'static str,
        /// The difference.
        difference: Box<Difference>,
    },
}

/// Runs passes and proves, as far as it can be, that what comes out computes what went in.
///
/// # Errors
/// What is wrong with the output of one of them.
///
/// # Panics
/// When the program was not verified.
pub fn optimise_proved(program: Program, passes: &[Pass]) -> Result<(Program, Report), Fault> {
    let mut report = Report::default();
    // Proved from `before` on are the passes from `first` on, none of which changed where sections end.
    let (mut before, mut first) = (program.clone(), 0);
    let mut program = program;
    for (place, pass) in passes.iter().enumerate() {
        let after = run(pass, &program)?;
        if after.sections.len() != program.sections.len() {
            report.add(proved(&before, &program, &passes[first..place])?);
            report.add(proved(&program, &after, &passes[place..=place])?);
            (before, first) = (after.clone(), place + 1);
        }
        program = after;
    }
    report.add(proved(&before, &program, &passes[first..])?);
    Ok((program, report))
}

/// The output of a pass, if it is a program over the same image.
fn run(pass: &Pass, program: &Program) -> Result<Program, Fault> {
    let after = (pass.run)(program.clone());
    if let Err(problems) = verify(&after) {
        return Err(Fault::Broken { pass: pass.name, problems });
    }
    let told = |task: &Task| (task.name.clone(), task.interval, task.due);
    let keeps_tasks = program.tasks.iter().map(told).eq(after.tasks.iter().map(told));
    if program.layout != after.layout || program.origins != after.origins || !keeps_tasks {
        return Err(Fault::Reshaped { pass: pass.name });
    }
    Ok(after)
}

/// Compares what went into some passes with what came out, and names the pass that makes the difference.
fn proved(before: &Program, after: &Program, passes: &[Pass]) -> Result<Report, Fault> {
    // What no pass touched needs no proof, and is not counted.
    if before == after {
        return Ok(Report::default());
    }
    compare(before, after).map_err(|different| {
        let (part, difference) = *different;
        let machine = Machine::new(&before.layout);
        let expected = machine.run(before, part.before.clone(), &difference.image, difference.now);
        let mut program = before.clone();
        let culprit = passes.iter().find(|pass| {
            program = (pass.run)(std::mem::replace(&mut program, before.clone()));
            let sections = if program.sections.len() == after.sections.len() { &part.after } else { &part.before };
            machine.run(&program, sections.clone(), &difference.image, difference.now) != expected
        });
        let pass = culprit.or(passes.last()).map_or("", |pass| pass.name);
        Fault::Different { pass, difference: Box::new(difference) }
    })
}

/// Compares two verified programs over one layout, with the same origins.
fn compare(before: &Program, after: &Program) -> Result<Report, Box<(Part, Difference)>> {
    let parts = part::parts(before, after);
    let machine = Machine::new(&before.layout);
    let compared =
        parallel::each(parts.len(), || (), |(), place| part::compare(before, after, &parts[place], &machine));
    let mut report = Report::default();
    for (part, compared) in parts.into_iter().zip(compared) {
        match compared {
            Ok(of_part) => report.add(of_part),
            Err(difference) => return Err(Box::new((part, *difference))),
        }
    }
    Ok(report)
}
