//! The blocks of the evaluator against their step tables.

use std::collections::HashSet;

use rung::ladder::library::StandardBlock;

use super::Instance;
use crate::support::step_table::all_cases;

#[test]
fn every_block_does_what_its_step_table_says() {
    for case in all_cases() {
        let mut instance = Instance::new(case.block);
        for step in &case.steps {
            instance.inputs.clone_from(&step.inputs);
            if step.enabled {
                instance.execute(step.now);
            }
            assert_eq!(instance.outputs, step.outputs, "{}", step.rule);
        }
    }
}

#[test]
fn every_block_has_a_step_table() {
    let with_table: HashSet<StandardBlock> = all_cases().map(|case| case.block).collect();
    let without: Vec<&StandardBlock> = StandardBlock::ALL.iter().filter(|block| !with_table.contains(block)).collect();
    assert_eq!(without, [&StandardBlock::Ton; 0]);
}
