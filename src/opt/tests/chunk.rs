//! Where chunks end.

use super::pass;
use crate::elementary::{Elementary, Value};
use crate::logic::{Area, Builder, LayoutBuilder, Origin, Program, Slot, SlotId, verify};

/// Rungs with so many contacts each over BOOLs of their own; some read the coil of the one before.
fn rungs(contacts: usize, labels: impl Iterator<Item = String>, reads_last: fn(usize) -> bool) -> Program {
    let mut layout = LayoutBuilder::new();
    let labels: Vec<String> = labels.collect();
    let slots: Vec<SlotId> = (0..=labels.len())
        .map(|number| {
            let (name, ty, initial) = (format!("b{number}"), Elementary::Bool, Value::bool(false));
            layout.slot(Slot { name: name.into(), ty, offset: 0, area: Area::Memory, retain: false, initial, line: 0 })
        })
        .collect();
    let mut logic = Builder::new("p", layout.finish(None).expect("a small image"));
    for (number, label) in labels.into_iter().enumerate() {
        let mut power = logic.load(slots[number + usize::from(!reads_last(number))]);
        for _ in 1..contacts {
            let contact = logic.load(slots[number + 1]);
            power = logic.and(power, contact);
        }
        logic.store(slots[number + 1], power);
        logic.end_section(Origin { label: label.into(), line: 1 });
    }
    logic.finish()
}

fn labels(count: usize) -> impl Iterator<Item = String> {
    (0..count).map(|number| format!("r{number}"))
}

/// The labels of the rungs that start a chunk.
fn starts(program: &Program) -> Vec<String> {
    program.chunks().iter().map(|chunk| program.origins[chunk.start].label.to_string()).collect()
}

#[test]
fn chunks_are_of_a_length_whatever_the_rungs_are() {
    for contacts in [1, 8, 60] {
        let program = pass("chunk", rungs(contacts, labels(4000), |_| false));
        assert_eq!(verify(&program), Ok(()));
        let chunks = program.chunks();
        for chunk in &chunks[..chunks.len() - 1] {
            let length = program.instruction_range(chunk.clone()).len();
            assert!(
                chunk.len() == 512 || (1000..=2000).contains(&length),
                "{contacts} contacts: {length} in {chunk:?}"
            );
        }
    }
}

#[test]
fn a_chunk_ends_where_no_rung_reads_the_coil_of_the_one_before() {
    let program = pass("chunk", rungs(8, labels(1000), |number| number % 50 != 7));
    assert!(program.chunks().len() > 4);
    for chunk in &program.chunks()[1..] {
        assert_eq!(chunk.start % 50, 7);
    }
}

#[test]
fn a_rung_more_moves_the_ends_near_it_and_no_others() {
    let before = starts(&pass("chunk", rungs(8, labels(4000), |_| false)));
    let inserted = labels(1000).chain(["new".to_owned()]).chain(labels(4000).skip(1000));
    let after = starts(&pass("chunk", rungs(8, inserted, |_| false)));
    assert!(before.len() > 20);
    let of_rung = |label: &String| label[1..].parse::<usize>().unwrap_or(1000);
    let far = |starts: &[String]| -> Vec<String> {
        starts.iter().filter(|label| !(1000..2000).contains(&of_rung(label))).cloned().collect()
    };
    assert_eq!(far(&before), far(&after));
}

#[test]
fn values_that_cross_keep_sections_together_and_tasks_never_share_a_chunk() {
    let mut layout = LayoutBuilder::new();
    let (name, ty, initial) = ("a".to_owned(), Elementary::Bool, Value::bool(false));
    let slot =
        layout.slot(Slot { name: name.into(), ty, offset: 0, area: Area::Memory, retain: false, initial, line: 0 });
    let mut logic = Builder::new("p", layout.finish(None).expect("a small image"));
    let first = logic.load(slot);
    for task in 0..2 {
        let mut power = if task == 0 { first } else { logic.load(slot) };
        for _ in 0..20 {
            for _ in 0..400 {
                power = logic.not(power);
            }
            logic.store(slot, power);
            logic.end_section(Origin { label: "r".into(), line: 1 });
        }
        logic.end_task(format!("t{task}"), None, None);
    }
    let program = pass("chunk", logic.finish());
    assert_eq!(verify(&program), Ok(()));
    assert_eq!(program.chunks(), [0..20, 20..40]);
}
