//! The blocks of the evaluator against their step tables.

use std::collections::HashSet;

use rung::elementary::Value;
use rung::ladder::library::{StandardBlock, Takes};

use super::Instance;
use super::storage::Register;
use crate::support::step_table::{REGISTERS, all_cases};

#[test]
fn every_block_does_what_its_step_table_says() {
    for case in all_cases() {
        let mut instance = Instance::new(case.block);
        for (registers, pin) in instance.references.iter_mut().zip(case.block.inputs()) {
            if pin.takes == Takes::Reference {
                registers.extend((0..REGISTERS).map(|_| Register::new(Value::default_of(pin.ty))));
            }
        }
        for step in &case.steps {
            for (input, value) in instance.inputs.iter().zip(&step.inputs) {
                input.set(*value);
            }
            for (pin, place, value) in &step.registers {
                instance.references[*pin][*place].set(*value);
            }
            if step.enabled {
                instance.execute(step.now);
            }
            let outputs: Vec<Value> = instance.outputs.iter().map(Register::get).collect();
            assert_eq!(outputs, step.outputs, "{}", step.rule);
            let after = step.registers_after.iter();
            let held = after.map(|(pin, place, _)| (*pin, *place, instance.references[*pin][*place].get()));
            assert_eq!(held.collect::<Vec<_>>(), step.registers_after, "{}", step.rule);
        }
    }
}

#[test]
fn every_block_has_a_step_table() {
    let with_table: HashSet<StandardBlock> = all_cases().map(|case| case.block).collect();
    let without: Vec<&StandardBlock> = StandardBlock::ALL.iter().filter(|block| !with_table.contains(block)).collect();
    assert_eq!(without, [&StandardBlock::Ton; 0]);
}
