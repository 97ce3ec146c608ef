//! Random programs under random stimuli.
//!
//! `RUNG_SEEDS=5000 RUNG_SCANS=1000 cargo test --test agreement -- --nocapture` looks longer; a seed that failed
//! is looked at again with `RUNG_FIRST_SEED=17 RUNG_SEEDS=1`.

use std::fmt::Write as _;

use rung::check::{Call, Callee, Checked, Circuit, Element, Place, Wire};
use rung::elementary::Elementary;
use rung::frontend::{self, native};
use rung::ladder::Program;
use rung::ladder::library::StandardBlock;
use rung::source::Source;

use crate::support::coverage::Coverage;
use crate::support::oracle::Oracle;
use crate::support::random_program::random_program;
use crate::support::random_stimuli::Stimuli;
use crate::support::rig::{Rig, checked};

/// Every kind of element that must occur and change in a run of the usual length.
const KINDS: [&str; 15] = [
    "contact a",
    "contact /a",
    "contact ^a",
    "contact ^/a",
    "coil (a)",
    "coil (/a)",
    "coil (S a)",
    "coil (R a)",
    "coil (P a)",
    "coil (N a)",
    "condition {a}",
    "assignment {a := b}",
    "parallel [a | b]",
    "jump >> r",
    "jump >> return",
];

/// Programs in a run of the usual length, and scans of each.
const SEEDS: u64 = 500;
const SCANS: u64 = 200;

#[test]
fn random_programs_compute_the_same_on_every_engine_and_in_the_evaluator() {
    for seed in seeds() {
        let program = random_program(seed);
        if run(&program, seed).is_err() {
            panic!("{}", report(&program, seed));
        }
    }
}

#[test]
#[expect(clippy::print_stdout, reason = "the table is for whoever runs the test with --nocapture")]
fn in_random_programs_every_element_and_block_occurs_and_changes() {
    let mut coverage = Coverage::default();
    for seed in seeds() {
        let program = random_program(seed);
        coverage.add_program(&program);
        let checked = checked(&program).unwrap_or_else(|problems| panic!("seed {seed}\n{problems}"));
        let mut oracle = Oracle::new(&checked);
        let mut stimuli = Stimuli::new(seed, &checked);
        for _ in 0..number("RUNG_SCANS", SCANS) {
            let (now, changes) = stimuli.next();
            changes.iter().for_each(|(name, value)| oracle.set(name, *value));
            oracle.scan(now);
        }
        coverage.add_activities(oracle.activities());
    }
    println!("{coverage}");
    if number("RUNG_SEEDS", SEEDS) >= SEEDS && number("RUNG_SCANS", SCANS) >= SCANS {
        assert_eq!(coverage.missing(&KINDS), [""; 0], "these elements never changed");
        let kinds = StandardBlock::ALL.iter().map(|block| {
            let takes_power = block.inputs().iter().any(|pin| pin.ty == Elementary::Bool);
            if takes_power { block.name().to_owned() } else { format!("{} with EN", block.name()) }
        });
        let blocks: Vec<String> = kinds.collect();
        let blocks: Vec<&str> = blocks.iter().map(String::as_str).collect();
        assert_eq!(coverage.missing(&blocks), [""; 0], "these blocks never changed");
    }
}

#[test]
fn printed_and_parsed_again_a_random_program_prints_and_computes_the_same() {
    for seed in seeds() {
        let program = random_program(seed);
        let text = native::print(&program);
        let source = Source::new("random.rung", text.as_str());
        let parsed = frontend::parse(&source);
        let problems = rung::diagnostic::render(&source, &parsed.diagnostics);
        assert!(parsed.diagnostics.is_empty(), "seed {seed}\n{problems}\n{text}");
        assert_eq!(native::print(&parsed.program), text, "seed {seed}");
        let drawn = checked(&program).unwrap_or_else(|problems| panic!("seed {seed}\n{problems}\n{text}"));
        let read = checked(&parsed.program).unwrap_or_else(|problems| panic!("seed {seed}\n{problems}\n{text}"));
        assert_eq!(trace(&read, seed), trace(&drawn, seed), "seed {seed}\n{text}");
    }
}

fn seeds() -> std::ops::Range<u64> {
    let first = number("RUNG_FIRST_SEED", 0);
    first..first + number("RUNG_SEEDS", SEEDS)
}

/// A number from the environment.
fn number(name: &str, otherwise: u64) -> u64 {
    match std::env::var(name) {
        Ok(text) => text.parse().unwrap_or_else(|error| panic!("{name}: {error}")),
        Err(_) => otherwise,
    }
}

/// What the evaluator says to a program under a seed's stimuli.
fn trace(checked: &Checked, seed: u64) -> String {
    let mut oracle = Oracle::new(checked);
    let mut stimuli = Stimuli::new(seed, checked);
    let mut trace = format!("{:?}\n", oracle.names());
    for _ in 0..20 {
        let (now, changes) = stimuli.next();
        for (name, value) in changes {
            oracle.set(&name, value);
        }
        oracle.scan(now);
        for name in oracle.names() {
            let _ = write!(trace, "{:?} ", oracle.get(name));
        }
        trace.push('\n');
    }
    trace
}

/// A failure: a heading that stays the same while the program is made smaller, and the particulars.
struct Failure {
    heading: &'static str,
    particulars: String,
}

/// Runs a program everywhere and compares after every scan.
fn run(program: &Program, seed: u64) -> Result<(), Failure> {
    let failure = |heading, particulars| Failure { heading, particulars };
    let checked = checked(program).map_err(|problems| failure("it does not check", problems))?;
    let mut rig = Rig::new(&checked).map_err(|problem| failure("it does not compile", problem))?;
    let mut stimuli = Stimuli::new(seed, &checked);
    for scan in 0..number("RUNG_SCANS", SCANS) {
        let (now, changes) = stimuli.next();
        for (name, value) in &changes {
            rig.set(name, *value);
        }
        rig.scan(now).map_err(|difference| {
            let writers = writers(&checked, &difference.name).join(", ");
            let (name, values) = (difference.name, difference.values);
            let particulars = format!("scan {scan} at {now} ns: {name}, written in {writers}\n{values}{changes:?}");
            failure("the engines differ", particulars)
        })?;
    }
    Ok(())
}

/// What is wrong with a program, after leaving out every rung without which it is wrong in the same way.
fn report(program: &Program, seed: u64) -> String {
    let Err(mut failure) = run(program, seed) else { return format!("seed {seed}: it fails only sometimes") };
    let mut smallest = program.clone();
    let mut place = smallest.units[0].rungs.len();
    while place > 0 {
        place -= 1;
        let mut smaller = smallest.clone();
        smaller.units[0].rungs.remove(place);
        match run(&smaller, seed) {
            Err(same) if same.heading == failure.heading && failure.heading != "it does not check" => {
                (smallest, failure) = (smaller, same);
            }
            _ => {}
        }
    }
    let Failure { heading, particulars } = failure;
    format!("seed {seed}: {heading}\n{particulars}\n{}", native::print(&smallest))
}

/// The rungs that write a variable or call an instance.
fn writers(checked: &Checked, name: &str) -> Vec<String> {
    let variable = name.split_once(['.', '[']).filter(|_| !name.starts_with('%')).map_or(name, |(first, _)| first);
    let is_it = |place: &Place| checked.variable(place.variable).name == variable;
    let in_call = |call: &Call| {
        let is_called = match &call.callee {
            Callee::Standard(_, instance) | Callee::Unit(_, instance) => is_it(instance),
            Callee::Function(..) | Callee::UserFunction(_) => false,
        };
        let references = call.references.iter().map(|(_, place)| place);
        is_called || call.outputs.iter().map(|(_, target)| target).chain(references).any(is_it)
    };
    let rungs = checked.units().iter().flat_map(|unit| &unit.rungs).filter(|rung| {
        let mut found = false;
        elements(&rung.circuit, &mut |element| {
            found |= match element {
                Element::Coil { target, .. } | Element::Assignment { target, .. } => is_it(target),
                Element::Call(call) => in_call(call),
                _ => false,
            };
        });
        found
    });
    rungs.map(|rung| rung.label.clone()).collect()
}

fn elements(circuit: &Circuit, visit: &mut impl FnMut(&Element)) {
    for element in circuit.branches.iter().flat_map(|branch| &branch.elements) {
        visit(element);
        match element {
            Element::Parallel(circuit) => elements(circuit, visit),
            Element::Call(call) => {
                for input in &call.inputs {
                    if let Wire::Circuit(circuit) = &input.wire {
                        elements(circuit, visit);
                    }
                }
            }
            _ => {}
        }
    }
}
