//! The examples, the corpus and random programs, in 128 and in 300 lanes.

use std::path::Path;

use rung::check::{Checked, check};
use rung::frontend::{self, native};
use rung::ladder::Program as Drawn;
use rung::source::Source;
use rung::{logic, lower, opt};

use crate::Rig;
use crate::support::corpus;
use crate::support::random_program::random_program;
use crate::support::random_stimuli::{Stimuli, observed};

/// Random programs, and scans of each. `RUNG_SEEDS=5000 cargo test --test lanes` looks longer.
const SEEDS: u64 = 200;
const SCANS: usize = 70;

fn lowered(drawn: &Drawn) -> Option<(Checked, logic::Program)> {
    let checked = check(drawn).0?;
    let program = opt::optimise(lower::lower(&checked, &Source::new("drawn", ""), None).ok()?);
    Some((checked, program))
}

/// Runs a program with inputs of its own in each lane, at irregular times, and compares; every lane now and then, and a
/// few after every scan, since an image costs far more than a scan.
fn agrees(checked: &Checked, program: &logic::Program, seed: u64, lanes: usize, scans: usize) -> Result<(), String> {
    let mut rig = Rig::new(program, lanes);
    let observed = observed(&program.layout);
    let mut stimuli: Vec<Stimuli> =
        (0..lanes as u64).map(|lane| Stimuli::new(seed * 1000 + lane, checked, &observed)).collect();
    for scan in 0..scans {
        let mut common = None;
        for (lane, stimuli) in stimuli.iter_mut().enumerate() {
            let (now, changes) = stimuli.next();
            common.get_or_insert(now);
            changes.iter().for_each(|(name, value)| rig.set(lane, name, *value));
        }
        let now = common.unwrap_or_default();
        rig.scan(now);
        let every = if scan % 16 == 15 || scan < 3 { 1 } else { 29 };
        if let Some(difference) = rig.difference((scan % every..lanes).step_by(every)) {
            return Err(format!("seed {seed}, scan {scan} at {now} ns, {difference}"));
        }
    }
    Ok(())
}

/// The programs in files of a folder, and below it.
fn files(folder: &Path, found: &mut Vec<Drawn>) {
    for entry in std::fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            files(&path, found);
        } else if let Ok(bytes) = std::fs::read(&path)
            && path.extension().is_some_and(|extension| ["rung", "xml", "st"].iter().any(|known| extension == *known))
            && let Ok(source) = Source::decode(path.display().to_string(), bytes)
        {
            found.push(frontend::parse(&source).program);
        }
    }
}

#[test]
fn every_example_computes_in_300_lanes_what_it_does_alone() {
    let mut drawn = Vec::new();
    files(&Path::new(env!("CARGO_MANIFEST_DIR")).join("examples"), &mut drawn);
    let mut compared = 0;
    for drawn in &drawn {
        let Some((checked, program)) = lowered(drawn) else { continue };
        agrees(&checked, &program, compared, 300, 60).unwrap_or_else(|problem| panic!("{problem}"));
        compared += 1;
    }
    assert!(compared >= 15, "only {compared} examples were compared: this test looks at the wrong place");
}

#[test]
fn programs_of_strangers_compute_in_lanes_what_they_do_alone() {
    let Some(folder) = corpus::folder() else { return };
    let mut drawn = Vec::new();
    files(&folder, &mut drawn);
    let mut compared = 0;
    for drawn in &drawn {
        let Some((checked, program)) = lowered(drawn).filter(|(_, program)| program.instructions.len() < 5000) else {
            continue;
        };
        agrees(&checked, &program, compared, 128, 24).unwrap_or_else(|problem| panic!("{problem}"));
        compared += 1;
    }
    assert!(compared > 5, "only {compared} files were compared");
}

#[test]
fn random_programs_compute_in_lanes_what_they_do_alone() {
    let seeds = std::env::var("RUNG_SEEDS").ok().and_then(|text| text.parse().ok()).unwrap_or(SEEDS);
    let mut compared = 0;
    for seed in 0..seeds {
        let drawn = random_program(seed);
        let Some((checked, program)) = lowered(&drawn) else { continue };
        let lanes = if seed % 10 == 0 { 300 } else { 128 };
        if let Err(problem) = agrees(&checked, &program, seed, lanes, SCANS) {
            panic!("{problem}\n{}", native::print(&drawn));
        }
        compared += 1;
    }
    assert!(compared * 10 > seeds * 9, "only {compared} of {seeds} programs check");
}
