//! The programs that run on every target, what happens to them, and what the interpreter makes of it.
//!
//! They are the examples under their stimuli and random programs, chosen such that together they hold every block and
//! every function, and that each of those changed something.

use std::collections::BTreeSet;
use std::fmt::Write as _;
use std::fs;
use std::path::Path;
use std::sync::LazyLock;

use rung::check::{self, Checked};
use rung::engine::interp::Interpreter;
use rung::frontend::{self, native};
use rung::ladder::functions::StandardFunction;
use rung::ladder::library::StandardBlock;
use rung::logic::{Layout, Program, SlotId};
use rung::simulate::{self, Schedule};
use rung::source::Source;
use rung::{diagnostic, lower};
use rung_runtime::Scan;

use crate::support::coverage::Coverage;
use crate::support::oracle::Oracle;
use crate::support::random_program::random_program;
use crate::support::random_stimuli::{Stimuli, observed};
use crate::target::root;

/// Random programs on each target, and the seeds that they are chosen from.
const RANDOM_PROGRAMS: usize = 50;
const SEEDS: u64 = 1200;

/// Scans of a random program.
const SCANS: usize = 60;

/// The cycle that the examples' stored traces have, in nanoseconds.
const CYCLE: i64 = 100_000_000;

/// Larger programs are not chosen: compilers of C would take most of the time that there is for them.
const LARGEST_IMAGE: u32 = 2048;
const MOST_INSTRUCTIONS: usize = 1500;

/// A program and its course.
pub(crate) struct Case {
    /// The file, or the seed.
    pub(crate) name: String,
    pub(crate) text: String,
    pub(crate) layout: Layout,
    /// Whether it computes with REAL or LREAL.
    pub(crate) has_reals: bool,
    pub(crate) moments: Vec<Moment>,
    /// What the firmware must print: a line for the image at the start and one for each scan.
    pub(crate) expected: String,
}

/// A scan, and what is set before it.
pub(crate) struct Moment {
    pub(crate) now: i64,
    pub(crate) changes: Vec<Change>,
}

/// Bytes of the image that get a value.
pub(crate) struct Change {
    pub(crate) offset: u32,
    pub(crate) size: u32,
    pub(crate) bits: u64,
}

/// A part of the image that is printed as one number: a slot, or a byte that belongs to none.
pub(crate) struct Place {
    pub(crate) offset: u32,
    pub(crate) size: u32,
    /// That of the slot, if it is one.
    pub(crate) name: Option<String>,
}

/// All programs, and what is in the random ones.
pub(crate) struct Suite {
    pub(crate) cases: Vec<Case>,
    pub(crate) coverage: Coverage,
    /// The blocks and functions that are not in any random program.
    pub(crate) missing: Vec<&'static str>,
}

/// They are chosen once, for all targets.
pub(crate) static SUITE: LazyLock<Suite> = LazyLock::new(|| {
    let mut cases = Vec::new();
    for folder in ["examples", "examples/register_machine"] {
        let entries = fs::read_dir(root().join(folder)).expect("the examples");
        let mut paths: Vec<_> = entries.map(|entry| entry.expect("an entry").path()).collect();
        paths.retain(|path| path.extension().is_some_and(|extension| extension == "rung"));
        paths.sort();
        cases.extend(paths.iter().map(|path| example(path)));
    }
    assert!(cases.len() >= 18, "only {} examples", cases.len());
    let (seeds, missing) = chosen();
    let mut coverage = Coverage::default();
    for seed in seeds {
        let random = Random::new(seed).expect("it was good before");
        coverage.add(random.coverage());
        cases.push(random.case());
    }
    Suite { cases, coverage, missing }
});

/// An example under its stimuli, as long as its stored trace.
fn example(path: &Path) -> Case {
    let read = |path: &Path| fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    let text = read(path);
    let (_, program) = lowered(&text).unwrap_or_else(|problems| panic!("{}: {problems}", path.display()));
    let stimuli = Source::new("stimuli", read(&path.with_extension("stimuli.csv")));
    let stimuli = simulate::Stimuli::parse(&stimuli, &program.layout).expect("good stimuli");
    let schedule = Schedule::covering(CYCLE, &stimuli).expect("a cycle that fits");
    let mut rows = stimuli.rows().peekable();
    let mut moments = Vec::new();
    for scan in 0..i64::try_from(schedule.count()).expect("few scans") {
        let (now, mut changes) = (scan * CYCLE, Vec::new());
        while let Some(row) = rows.next_if(|row| row.time <= now) {
            let set = row.settings.iter().map(|setting| change(&program.layout, setting.slot, setting.value.bits()));
            changes.extend(set);
        }
        moments.push(Moment { now, changes });
    }
    let name = path.file_name().expect("a name").to_string_lossy().into_owned();
    case(name, text, &program, moments)
}

fn change(layout: &Layout, slot: SlotId, bits: u64) -> Change {
    let slot = layout.slot(slot);
    Change { offset: slot.offset, size: slot.ty.size(), bits: bits & (u64::MAX >> (64 - 8 * slot.ty.size())) }
}

/// A text as it is built, not optimised.
fn lowered(text: &str) -> Result<(Checked, Program), String> {
    let source = Source::new("program", text);
    let parsed = frontend::parse(&source);
    let (checked, diagnostics) = check::check(&parsed.program);
    let problems = diagnostic::render(&source, &[parsed.diagnostics, diagnostics].concat());
    let checked = checked.ok_or(problems)?;
    let program = lower::lower(&checked, &source, None).map_err(|error| format!("{error:?}"))?;
    Ok((checked, program))
}

fn case(name: String, text: String, program: &Program, moments: Vec<Moment>) -> Case {
    let has_reals = program.layout.slots().iter().any(|slot| slot.ty.is_real())
        || program.instructions.iter().any(|instruction| instruction.ty.is_real());
    let expected = expected(program, &moments);
    Case { name, text, layout: Layout::clone(&program.layout), has_reals, moments, expected }
}

/// The course of the interpreter, as `check.c` prints that of the firmware.
fn expected(program: &Program, moments: &[Moment]) -> String {
    let places = places(&program.layout);
    let mut interpreter = Interpreter::new(program);
    let mut image = program.layout.initial_image();
    let (mut before, mut text) = (vec![0; places.len()], String::new());
    let mut print = |image: &[u8]| {
        for ((index, place), before) in places.iter().enumerate().zip(&mut before) {
            let value = place.read(image);
            if value != *before {
                *before = value;
                let _ = write!(text, "{index:x}:{value:x} ");
            }
        }
        text.push('\n');
    };
    print(&image);
    for moment in moments {
        for change in &moment.changes {
            change.write(&mut image);
        }
        interpreter.scan(&mut image, moment.now);
        print(&image);
    }
    text
}

/// All bytes of an image, in order.
pub(crate) fn places(layout: &Layout) -> Vec<Place> {
    let mut slots: Vec<_> = layout.slots().iter().collect();
    slots.sort_by_key(|slot| slot.offset);
    let (mut places, mut end) = (Vec::new(), 0);
    let padding = |range: std::ops::Range<u32>| range.map(|offset| Place { offset, size: 1, name: None });
    for slot in slots {
        places.extend(padding(end..slot.offset));
        places.push(Place { offset: slot.offset, size: slot.ty.size(), name: Some(slot.name.to_string()) });
        end = slot.offset + slot.ty.size();
    }
    places.extend(padding(end..layout.size()));
    places
}

impl Place {
    /// Its bytes as a number, in the byte order of this machine, as the image has them.
    fn read(&self, image: &[u8]) -> u64 {
        let bytes = &image[self.offset as usize..][..self.size as usize];
        let mut word = [0; 8];
        if cfg!(target_endian = "little") {
            word[..bytes.len()].copy_from_slice(bytes);
        } else {
            word[8 - bytes.len()..].copy_from_slice(bytes);
        }
        u64::from_ne_bytes(word)
    }
}

impl Change {
    fn write(&self, image: &mut [u8]) {
        let (word, size) = (self.bits.to_ne_bytes(), self.size as usize);
        let bytes = if cfg!(target_endian = "little") { &word[..size] } else { &word[8 - size..] };
        image[self.offset as usize..][..size].copy_from_slice(bytes);
    }
}

/// A random program.
struct Random {
    seed: u64,
    drawn: rung::ladder::Program,
    text: String,
    checked: Checked,
    program: Program,
}

impl Random {
    /// The program of a seed, unless it is too large.
    fn new(seed: u64) -> Option<Self> {
        let drawn = random_program(seed);
        // C, which firmware is linked by, has no names with other letters.
        let text = native::print(&drawn).replace('ü', "ue").replace('Ü', "UE");
        let (checked, program) = lowered(&text).unwrap_or_else(|problems| panic!("seed {seed}: {problems}"));
        let small = program.layout.size() <= LARGEST_IMAGE && program.instructions.len() <= MOST_INSTRUCTIONS;
        small.then_some(Self { seed, drawn, text, checked, program })
    }

    fn stimuli(&self) -> Stimuli {
        Stimuli::new(self.seed, &self.checked, &observed(&self.program.layout))
    }

    /// What it is made of and what changed in it, as the independent evaluator sees it.
    fn coverage(&self) -> Coverage {
        let (mut oracle, mut stimuli) = (Oracle::new(&self.checked), self.stimuli());
        for _ in 0..SCANS {
            let (now, changes) = stimuli.next();
            changes.iter().for_each(|(name, value)| oracle.set(name, *value));
            oracle.scan(now);
        }
        let mut coverage = Coverage::default();
        coverage.add_program(&self.drawn);
        coverage.add_activities(oracle.activities());
        coverage
    }

    fn case(self) -> Case {
        let mut stimuli = self.stimuli();
        let layout = &self.program.layout;
        let slot = |name: &str| {
            let found = layout.observed().iter().find(|observed| observed.name == name);
            found.expect("stimuli set what is observed").slot
        };
        let moments = (0..SCANS).map(|_| {
            let (now, changes) = stimuli.next();
            let changes = changes.iter().map(|(name, value)| change(layout, slot(name), value.bits())).collect();
            Moment { now, changes }
        });
        let moments = moments.collect();
        case(format!("the random program of seed {}", self.seed), self.text, &self.program, moments)
    }
}

/// Seeds of random programs, each of which adds as many blocks and functions to those before as any can, and then
/// the first that were left; and the names of what is in none of them.
fn chosen() -> (Vec<u64>, Vec<&'static str>) {
    let mut candidates: Vec<(u64, BTreeSet<&'static str>)> =
        (0..SEEDS).filter_map(|seed| Random::new(seed).map(|random| (seed, held(&random.coverage())))).collect();
    let blocks = StandardBlock::ALL.iter().map(|block| block.name());
    let mut missing: BTreeSet<_> = blocks.chain(StandardFunction::ALL.iter().map(|function| function.name())).collect();
    let mut seeds = Vec::new();
    while seeds.len() < RANDOM_PROGRAMS && !candidates.is_empty() {
        let gain = |held: &BTreeSet<_>| held.intersection(&missing).count();
        // Of equal ones the first, so that the choice does not depend on the order of anything else.
        let best = (0..candidates.len()).rev().max_by_key(|index| gain(&candidates[*index].1)).expect("there is one");
        let (seed, held) = candidates.remove(best);
        missing.retain(|name| !held.contains(name));
        seeds.push(seed);
    }
    (seeds, missing.into_iter().collect())
}

/// The blocks that changed something, driven by power or with EN, and the functions that did so as a box or are called.
fn held(coverage: &Coverage) -> BTreeSet<&'static str> {
    let changes = |kind: String| coverage.missing(&[kind.as_str()]).is_empty();
    let occurs = |kind: String| coverage.never_drawn(&[kind]).is_empty();
    let blocks = StandardBlock::ALL.iter().map(|block| block.name());
    let functions = StandardFunction::ALL.iter().map(|function| function.name());
    let blocks = blocks.filter(|name| changes((*name).to_owned()) || changes(format!("{name} with EN")));
    let functions = functions.filter(|name| changes(format!("box {name}")) || occurs(format!("function {name}")));
    blocks.chain(functions).collect()
}
