//! Whether the number of executed instructions depends on what is in the image: callgrind counts those of each scan.

use std::collections::BTreeMap;
use std::path::Path;
use std::process::{Command, Stdio};

use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;
use rung::elementary::Elementary;
use rung::engine::object;
use rung::engine::target::Target;
use rung::interface::{Interface, image_size};
use rung::logic::Layout;
use rung::source::Source;
use rung::{check, frontend, lower, opt};

use crate::{Plan, generated};

/// How many images took how many instructions, for the random ones and those of all 0 and all 1.
pub(crate) struct Spread {
    pub(crate) rungs: u32,
    pub(crate) counts: BTreeMap<u64, usize>,
}

pub(crate) fn measure(plan: &Plan, folder: &Path) -> Vec<Spread> {
    plan.sizes.iter().filter(|(rungs, _)| *rungs <= 1451).map(|size| one(*size, plan.images, folder)).collect()
}

fn one((rungs, timers): (u32, u32), images: usize, folder: &Path) -> Spread {
    let source = Source::new("spread", std::fs::read_to_string(generated(folder, rungs, timers)).expect("written"));
    let checked = check::check(&frontend::parse(&source).program).0.expect("no errors");
    let program = opt::optimise(lower::lower(&checked, &source, None).expect("a small image"));
    let interface = Interface::new("ladder", 1_000_000).expect("a prefix");
    let target = Target::host().expect("a back end for this machine");
    let folder = tempfile::tempdir_in(folder).expect("a writable folder");
    let path = |name: &str| folder.path().join(name);
    std::fs::write(path("ladder.o"), object::build(&program, &interface, &target).expect("an object"))
        .expect("written");
    std::fs::write(path("spread.c"), include_str!("spread.c")).expect("written");
    let status =
        Command::new("gcc").current_dir(folder.path()).args(["-O1", "-o", "spread", "spread.c", "ladder.o"]).status();
    assert!(status.expect("gcc is needed here").success());
    std::fs::write(path("images"), bytes(&program.layout, images)).expect("written");
    // It writes what it counted after each call, and once more at the end.
    let counted = Command::new("valgrind")
        .current_dir(folder.path())
        .args(["--tool=callgrind", "--toggle-collect=ladder_scan", "--dump-after=ladder_scan"])
        .args(["--callgrind-out-file=out", "./spread"])
        .stdin(Stdio::from(std::fs::File::open(path("images")).expect("written")))
        .stderr(Stdio::null())
        .status();
    assert!(counted.expect("valgrind is needed here").success());
    let mut counts = BTreeMap::new();
    for image in 1..=images + 2 {
        let out = std::fs::read_to_string(path(&format!("out.{image}"))).expect("a count for each image");
        let count = out.lines().find_map(|line| line.strip_prefix("summary: ")).expect("a summary");
        *counts.entry(count.trim().parse().expect("a number")).or_default() += 1;
    }
    Spread { rungs, counts }
}

/// The size, and images: random ones, one of all 0 and one of all 1, where BOOLs are 0 or 1 in all.
fn bytes(layout: &Layout, random: usize) -> Vec<u8> {
    let size = image_size(layout) as usize;
    let mut bytes = u32::try_from(size).expect("a small image").to_ne_bytes().to_vec();
    let mut rng = Pcg64::seed_from_u64(1);
    for number in 0..random + 2 {
        let mut image: Vec<u8> = match number.checked_sub(random) {
            None => (0..size).map(|_| rng.random()).collect(),
            Some(0) => vec![0; size],
            Some(_) => vec![0xFF; size],
        };
        for slot in layout.slots().iter().filter(|slot| slot.ty == Elementary::Bool) {
            image[slot.offset as usize] &= 1;
        }
        bytes.extend(image);
    }
    bytes
}
