//! The examples under their stimuli, on every engine and in the evaluator.

use std::path::{Path, PathBuf};

use rung::simulate::{Schedule, Stimuli};
use rung::source::Source;
use rung::{frontend, lower};

use crate::support::rig::{Rig, checked};

const CYCLES: [i64; 3] = [100_000_000, 10_000_000, 3_333_333];

#[test]
fn the_examples_compute_the_same_everywhere_and_the_evaluator_agrees() {
    let mut rungs = 0;
    for path in examples() {
        let source = source(&path);
        let parsed = frontend::parse(&source);
        assert_eq!(parsed.diagnostics, [], "{}", path.display());
        rungs += parsed.program.rungs().count();
        let checked = checked(&parsed.program).unwrap_or_else(|problems| panic!("{}: {problems}", path.display()));
        let layout = lower::lower(&checked, &source, None).expect("a small image").layout;
        let stimuli = self::source(&path.with_extension("stimuli.csv"));
        let stimuli = Stimuli::parse(&stimuli, &layout).unwrap_or_else(|problems| panic!("{problems:?}"));
        for cycle in CYCLES {
            let schedule = Schedule::covering(cycle, &stimuli).expect("a cycle that fits");
            let mut rig = Rig::new(&checked).unwrap_or_else(|problem| panic!("{}: {problem}", path.display()));
            let mut rows = stimuli.rows().peekable();
            for scan in 0..i64::try_from(schedule.count()).expect("few scans") {
                while let Some(row) = rows.next_if(|row| row.time <= scan * cycle) {
                    for setting in row.settings {
                        let observed = layout.observed().iter().find(|observed| observed.slot == setting.slot);
                        rig.set(&observed.expect("stimuli set what is observed").name, setting.value);
                    }
                }
                rig.scan(scan * cycle).unwrap_or_else(|difference| {
                    panic!("{}, scan {scan} every {cycle} ns: {difference:?}", path.display())
                });
            }
        }
    }
    assert!(rungs >= 40, "the examples have only {rungs} rungs: this test looks at the wrong place");
}

/// The programs of `examples/`.
pub(crate) fn examples() -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples");
    let entries = std::fs::read_dir(folder).expect("the examples' folder");
    let mut paths: Vec<PathBuf> = entries.map(|entry| entry.expect("an entry").path()).collect();
    paths.retain(|path| path.extension().is_some_and(|extension| extension == "rung"));
    paths.sort();
    paths
}

/// A file of text.
pub(crate) fn source(path: &Path) -> Source {
    let bytes = std::fs::read(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    Source::decode(path.display().to_string(), bytes).expect("text")
}
