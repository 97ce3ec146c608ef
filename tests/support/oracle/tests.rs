//! The blocks of the evaluator against their step tables.

use super::Instance;
use crate::support::step_table::{TABLES, cases};

#[test]
fn every_block_does_what_its_step_table_says() {
    for (block, table) in TABLES {
        for case in cases(block, table) {
            let mut instance = Instance::new(block);
            for step in &case.steps {
                instance.inputs.clone_from(&step.inputs);
                if step.enabled {
                    instance.execute(step.now);
                }
                assert_eq!(instance.outputs, step.outputs, "{}", step.rule);
            }
        }
    }
}
