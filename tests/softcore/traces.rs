//! On each target every example and random program leaves the interpreter's image, all of it, after every scan.

use crate::firmware;
use crate::suite::{Case, SUITE, places};
use crate::target::{AARCH64, CORTEX_M3, OPENRISC, RV32, RV64, RV64_WITH_REALS, Target, X86_64};

#[test]
#[expect(clippy::print_stdout, reason = "the table is for whoever runs the test with --nocapture")]
fn the_random_programs_hold_every_block_and_function() {
    println!("{}", SUITE.coverage);
    assert_eq!(SUITE.missing, [""; 0], "these are in no random program, or change nothing there");
}

#[test]
fn on_rv64_without_floating_point_every_trace_is_that_of_the_interpreter() {
    compare(RV64, |case| !case.has_reals);
}

#[test]
fn on_rv64_with_floating_point_every_trace_is_that_of_the_interpreter() {
    compare(RV64_WITH_REALS, |_| true);
}

#[test]
fn on_rv32_every_trace_is_that_of_the_interpreter() {
    compare(RV32, |_| true);
}

#[test]
fn on_a_cortex_m3_every_trace_is_that_of_the_interpreter() {
    compare(CORTEX_M3, |_| true);
}

#[test]
fn on_openrisc_every_trace_is_that_of_the_interpreter() {
    compare(OPENRISC, |_| true);
}

#[test]
fn on_aarch64_every_trace_is_that_of_the_interpreter() {
    compare(AARCH64, |_| true);
}

#[test]
fn on_x86_64_every_trace_is_that_of_the_interpreter() {
    compare(X86_64, |_| true);
}

fn compare(target: Target, wanted: impl Fn(&Case) -> bool) {
    let runs = firmware::run(target, wanted);
    assert!(runs.len() >= 12, "only {} programs", runs.len());
    let differing: Vec<String> = runs
        .iter()
        .filter(|(case, printed)| *printed != case.expected)
        .map(|(case, printed)| difference(case, printed))
        .collect();
    assert!(differing.is_empty(), "{}: {}\n{}", target.folder, differing.len(), differing.join("\n"));
}

/// Where a trace leaves the interpreter's first, by the names of what differs.
fn difference(case: &Case, printed: &str) -> String {
    let places = places(&case.layout);
    let mut lines = printed.lines();
    for (line, expected) in case.expected.lines().enumerate() {
        let found = lines.next().unwrap_or("nothing");
        if found == expected {
            continue;
        }
        let at = match line.checked_sub(1) {
            None => "at the start".to_owned(),
            Some(scan) => format!("after scan {scan}, at {} ns", case.moments[scan].now),
        };
        let only = |of: &str, other: &str| {
            let names = of.split_whitespace().filter(|change| !other.split_whitespace().any(|same| same == *change));
            let named = names.map(|change| {
                let (place, value) = change.split_once(':').unwrap_or((change, ""));
                let place = usize::from_str_radix(place, 16).ok().and_then(|index| places.get(index));
                let name = place.map(|place| place.name.clone().unwrap_or(format!("the byte {}", place.offset)));
                format!("{} = {value}", name.unwrap_or_else(|| change.to_owned()))
            });
            named.collect::<Vec<_>>().join(", ")
        };
        let (expected_only, found_only) = (only(expected, found), only(found, expected));
        return format!("{} {at}: [{found_only}] is not [{expected_only}]", case.name);
    }
    format!("{}: more is printed than there are scans", case.name)
}
