//! The step tables of all blocks, as programs on every engine.

use crate::support::rig::{Rig, checked};
use crate::support::step_table::{Case, all_cases};

#[test]
fn every_engine_does_what_the_step_tables_say_with_enable() {
    for case in all_cases() {
        run(&case, true);
    }
}

#[test]
fn every_engine_does_what_the_step_tables_say_with_power_as_the_first_input() {
    for case in all_cases().filter(|case| !case.uses_enable()) {
        run(&case, false);
    }
}

fn run(case: &Case, enable: bool) {
    let checked = checked(&case.program(enable)).expect("the program of a step table checks");
    let mut rig = Rig::new(&checked).expect("and runs");
    for step in &case.steps {
        for (name, value) in case.settings(step) {
            rig.set(&name, value);
        }
        rig.scan(step.now).unwrap_or_else(|difference| panic!("{}: {difference:?}", step.rule));
        for (name, value) in case.expectations(step) {
            assert_eq!(rig.oracle.get(&name), value, "{}: {name}", step.rule);
        }
    }
}
