//! Random programs under random stimuli.
//!
//! `RUNG_SEEDS=100000 RUNG_SCANS=1000 cargo test --test agreement -- --nocapture` looks longer; a seed that failed
//! is looked at again with `RUNG_FIRST_SEED=17 RUNG_SEEDS=1`.

use std::fmt::Write as _;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{LazyLock, Mutex};

use rung::check::{Call, Callee, Checked, Circuit, Element, Place, Wire};
use rung::elementary::Elementary;
use rung::frontend::{self, native};
use rung::ladder::Program;
use rung::ladder::functions::StandardFunction;
use rung::ladder::library::StandardBlock;
use rung::source::Source;

use crate::support::coverage::Coverage;
use crate::support::oracle::{Activity, Oracle};
use crate::support::random_program::random_program;
use crate::support::random_stimuli::Stimuli;
use crate::support::rig::{Rig, checked};
use crate::support::shrink;

/// Every kind of element that must occur and change in a run of the usual length.
const KINDS: [&str; 34] = [
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
    "statements {a; b}",
    "statement a := b",
    "statement a := b of many",
    "statement call",
    "statement IF",
    "statement CASE",
    "statement FOR",
    "statement EXIT",
    "statement RETURN",
    "own block",
    "own block with EN",
    "own block with references",
    "own block with references, with EN",
    "box of an own function",
    "own function f(a)",
    "box that converts",
    "index a[i]",
    "index out of range",
    "task with an interval",
];

/// What else must occur; it has no value of its own that could change.
const DRAWN: [&str; 40] = [
    "sizes of the register machine",
    "type with another name",
    "type structure",
    "type enumeration",
    "unit program",
    "unit function block",
    "unit function",
    "named instance of a program",
    "task",
    "global",
    "declared own type",
    "declared array of own type",
    "declared Input",
    "declared Output",
    "declared Memory",
    "declared Constant",
    "declared InOut",
    "declared Temporary",
    "declared with an initial value",
    "declared retain",
    "declared at an address",
    "declared array of many dimensions",
    "rung that is off",
    "branch at a node",
    "branch without elements",
    "operand address",
    "operand member",
    "operand bit",
    "operand index",
    "operand literal",
    "operand of an enumeration",
    "initial value of many",
    "call with a chosen power output",
    "pin EN",
    "pin ENO",
    "pin with a value",
    "pin with a circuit",
    "pin with an output",
    "CASE of a range",
    "FOR by a step",
];

/// Programs in a run of the usual length, and scans of each.
const SEEDS: u64 = 2000;
const SCANS: u64 = 100;

/// What became of all programs; they run once, for several tests to look at.
struct Outcome {
    /// The least seed that failed.
    failed: Option<u64>,
    coverage: Coverage,
}

static OUTCOME: LazyLock<Outcome> = LazyLock::new(|| {
    let (next, failed) = (AtomicU64::new(seeds().start), AtomicU64::new(u64::MAX));
    let coverage = Mutex::new(Coverage::default());
    let work = || {
        let mut seen = Coverage::default();
        loop {
            let seed = next.fetch_add(1, Ordering::Relaxed);
            if seed >= seeds().end || failed.load(Ordering::Relaxed) < seed {
                break;
            }
            let program = random_program(seed);
            seen.add_program(&program);
            match run(&program, seed) {
                Ok(activities) => seen.add_activities(&activities),
                Err(_) => drop(failed.fetch_min(seed, Ordering::Relaxed)),
            }
        }
        coverage.lock().expect("no thread panics while it adds").add(seen);
    };
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    std::thread::scope(|scope| (0..threads).for_each(|_| drop(scope.spawn(work))));
    let failed = Some(failed.into_inner()).filter(|seed| *seed < u64::MAX);
    Outcome { failed, coverage: coverage.into_inner().expect("all threads are done") }
});

#[test]
fn random_programs_compute_the_same_on_every_engine_and_in_the_evaluator() {
    if let Some(seed) = OUTCOME.failed {
        panic!("{}", report(&random_program(seed), seed));
    }
}

#[test]
#[expect(clippy::print_stdout, reason = "the table is for whoever runs the test with --nocapture")]
fn in_random_programs_every_element_block_function_and_statement_occurs_and_changes() {
    let coverage = &OUTCOME.coverage;
    println!("{coverage}");
    if number("RUNG_SEEDS", SEEDS) < SEEDS || number("RUNG_SCANS", SCANS) < SCANS || OUTCOME.failed.is_some() {
        return;
    }
    assert_eq!(coverage.missing(&KINDS), [""; 0], "these elements never changed");
    let takes_power = |block: &StandardBlock| block.inputs().iter().any(|pin| pin.ty == Elementary::Bool);
    let blocks = StandardBlock::ALL.iter().flat_map(|block| {
        let by_power = takes_power(block).then(|| block.name().to_owned());
        by_power.into_iter().chain([format!("{} with EN", block.name())])
    });
    let boxes = StandardFunction::ALL.iter().map(|function| format!("box {}", function.name()));
    let changing: Vec<String> = blocks.chain(boxes).collect();
    let changing: Vec<&str> = changing.iter().map(String::as_str).collect();
    assert_eq!(coverage.missing(&changing), [""; 0], "these blocks and boxes never changed");
    let functions = StandardFunction::ALL.iter().map(|function| format!("function {}", function.name()));
    let declared = Elementary::ALL.iter().flat_map(|ty| [format!("declared {ty}"), format!("declared array of {ty}")]);
    let instances = StandardBlock::ALL.iter().map(|block| format!("declared {}", block.name()));
    let drawn = DRAWN.into_iter().map(str::to_owned);
    let drawn: Vec<String> = functions.chain(declared).chain(instances).chain(drawn).collect();
    assert_eq!(coverage.never_drawn(&drawn), [""; 0], "these never occurred");
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
    let mut stimuli = Stimuli::new(seed, checked, &oracle.observed());
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

/// The heading of a program with errors.
const DOES_NOT_CHECK: &str = "it does not check";

/// A failure: a heading that stays the same while the program is made smaller, and the particulars.
struct Failure {
    heading: &'static str,
    particulars: String,
}

/// Runs a program everywhere and compares after every scan.
fn run(program: &Program, seed: u64) -> Result<Vec<Activity>, Failure> {
    let failure = |heading, particulars| Failure { heading, particulars };
    let checked = checked(program).map_err(|problems| failure(DOES_NOT_CHECK, problems))?;
    let mut rig = Rig::new(&checked).map_err(|problem| failure("it does not compile", problem))?;
    let mut stimuli = Stimuli::new(seed, &checked, &rig.oracle.observed());
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
    Ok(rig.oracle.activities().to_vec())
}

/// What is wrong with a program, after leaving out everything without which it is wrong in the same way.
fn report(program: &Program, seed: u64) -> String {
    let Err(mut failure) = run(program, seed) else { return format!("seed {seed}: it fails only sometimes") };
    let smallest = match failure.heading {
        DOES_NOT_CHECK => program.clone(),
        heading => shrink::smallest(program, |smaller| match run(smaller, seed) {
            Err(same) if same.heading == heading => {
                failure = same;
                true
            }
            _ => false,
        }),
    };
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
    rungs.map(|rung| rung.label.to_string()).collect()
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
