//! The verifier: what every program must fulfil before an engine may run it.
//!
//! It checks, in time linear in the program but for sorting its slots, that
//!
//! - the layout is sound: aligned slots inside the image that do not overlap, unique names, initial values of their
//!   slots' types, observed slots that exist, runs that cover their slots, tail padding
//!   (see [`Layout::problems`](super::Layout::problems));
//! - sections are in order and together cover all instructions, and their origins exist;
//! - there is a task, tasks are in order and together cover all sections, and the first section of each starts a chunk;
//! - a task has an interval above 0 and a slot of type TIME that no other task has, or neither;
//! - every operand is defined before, in the same chunk, and not by a store, which has no value;
//! - every slot or array that is loaded or stored exists and has the instruction's type, and a stored value has it too;
//! - arrays of which one is copied to the other have one type and count, and are the same or share no slot;
//! - an index is a LINT, and constants are in register form;
//! - the types of operands and results are those of the op table, and of [`Op`]'s description.
//!
//! It must never panic, whatever the program.

use std::collections::HashSet;
use std::fmt;

use super::{ArrayId, Instruction, Op, Program, SlotId, ValueId};
use crate::elementary::{Elementary, canonical};

/// What is wrong with a program.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Problem {
    /// The place of the instruction, if it is about one.
    pub instruction: Option<usize>,
    /// What is wrong, in one line.
    pub message: String,
}

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.instruction {
            Some(index) => write!(f, "v{index}: {}", self.message),
            None => f.write_str(&self.message),
        }
    }
}

/// Checks a program.
///
/// # Errors
/// All that is wrong with it, but that nothing is said about instructions when the sections are out of order.
pub fn verify(program: &Program) -> Result<(), Vec<Problem>> {
    let mut problems: Vec<Problem> =
        program.layout.problems().into_iter().map(|message| Problem { instruction: None, message }).collect();
    let (mut start, mut chunk_start) = (0, 0);
    for (index, section) in program.sections.iter().enumerate() {
        let mut problem = |message| problems.push(Problem { instruction: None, message });
        let end = section.end as usize;
        if end < start || end > program.instructions.len() {
            problem(format!("section {index} cannot end at {end}"));
            return Err(problems);
        }
        if section.origin as usize >= program.origins.len() {
            problem(format!("section {index} has the origin {}, which there is not", section.origin));
        }
        if section.starts_chunk {
            chunk_start = start;
        }
        for place in start..end {
            if let Err(message) = instruction(program, chunk_start, place) {
                problems.push(Problem { instruction: Some(place), message });
            }
        }
        start = end;
    }
    if start != program.instructions.len() {
        let message = format!("the sections end at {start}, before the instructions do");
        problems.push(Problem { instruction: None, message });
    }
    problems.extend(tasks(program).into_iter().map(|message| Problem { instruction: None, message }));
    if problems.is_empty() { Ok(()) } else { Err(problems) }
}

fn tasks(program: &Program) -> Vec<String> {
    let mut problems = Vec::new();
    let (mut start, mut slots) = (0, HashSet::new());
    for (index, task) in program.tasks.iter().enumerate() {
        let end = task.end as usize;
        if end < start || end > program.sections.len() {
            problems.push(format!("task {index} cannot end at {end}"));
            return problems;
        }
        if end > start && !program.sections[start].starts_chunk {
            problems.push(format!("the first section of task {index} does not start a chunk"));
        }
        match (task.interval, task.due) {
            (None, None) => {}
            (Some(interval), _) if interval <= 0 => problems.push(format!("task {index} has the interval {interval}")),
            (Some(_), Some(due)) => match program.layout.slots().get(due.index()) {
                Some(slot) if slot.ty == Elementary::Time && slots.insert(due) => {}
                Some(_) => problems.push(format!("task {index} cannot keep when it is due in {due}")),
                None => problems.push(format!("task {index} has {due}, which does not exist")),
            },
            (Some(_), None) | (None, Some(_)) => {
                problems.push(format!("task {index} has not both, an interval and a slot for when it is due"));
            }
        }
        start = end;
    }
    if program.tasks.is_empty() || start != program.sections.len() {
        problems.push(format!("the tasks end at {start}, before the sections do"));
    }
    problems
}

fn instruction(program: &Program, chunk_start: usize, place: usize) -> Result<(), String> {
    let Instruction { ty, op } = program.instructions[place];
    let same = |what: fmt::Arguments<'_>, is: Elementary, expected: Elementary| {
        if is == expected { Ok(()) } else { Err(format!("{what} is {is}, but {expected} belongs here")) }
    };
    let operand = |value: ValueId| {
        if value.index() >= place {
            return Err(format!("{value} is used before it is defined"));
        }
        if value.index() < chunk_start {
            return Err(format!("{value} is of an earlier chunk"));
        }
        match program.instructions[value.index()] {
            Instruction { op, .. } if !op.has_value() => Err(format!("{value} is a store, which has no value")),
            Instruction { ty, .. } => Ok(ty),
        }
    };
    let expect = |value: ValueId, expected: Elementary| same(format_args!("{value}"), operand(value)?, expected);
    let result = |expected: Elementary| same(format_args!("the result"), ty, expected);
    let slot = |slot: SlotId| match program.layout.slots().get(slot.index()) {
        Some(found) => same(format_args!("{slot}"), found.ty, ty),
        None => Err(format!("{slot} does not exist")),
    };
    let array = |array: ArrayId| match program.layout.arrays().get(array.index()) {
        Some(found) => slot(found.first),
        None => Err(format!("{array} does not exist")),
    };
    let takes = |mnemonic: &str, domain: super::Domain| {
        if domain.contains(ty) { Ok(()) } else { Err(format!("{mnemonic} does not take {ty}")) }
    };
    match op {
        Op::Constant(bits) if canonical(ty, bits) != bits => Err(format!("{bits:#x} is no {ty} in register form")),
        Op::Constant(_) => Ok(()),
        Op::Now => result(Elementary::Time),
        Op::Load(from) => slot(from),
        Op::Store(to, a) => slot(to).and(expect(a, ty)),
        Op::LoadIndexed(from, index) => array(from).and(expect(index, Elementary::Lint)),
        Op::StoreIndexed(to, index, a) => array(to).and(expect(index, Elementary::Lint)).and(expect(a, ty)),
        Op::CopyArray(to, from, condition) => {
            array(to).and(array(from)).and(expect(condition, Elementary::Bool))?;
            let [a, b] = [to, from].map(|id| program.layout.array(id));
            if a.count != b.count {
                Err(format!("{to} has {} elements, but {from} has {}", a.count, b.count))
            } else if a != b && a.first < b.slots().end && b.first < a.slots().end {
                Err(format!("{to} and {from} share slots"))
            } else {
                Ok(())
            }
        }
        Op::Unary(op, a) => takes(op.mnemonic(), op.domain()).and(expect(a, ty)),
        Op::Binary(op, a, b) => {
            let second = if op.takes_amount() { Elementary::Udint } else { ty };
            takes(op.mnemonic(), op.domain()).and(expect(a, ty)).and(expect(b, second))
        }
        Op::Compare(_, a, b) => result(Elementary::Bool).and(expect(b, operand(a)?)),
        Op::Select(condition, a, b) => expect(condition, Elementary::Bool).and(expect(a, ty)).and(expect(b, ty)),
        Op::Convert(a) => operand(a).map(|_| ()),
        Op::Reinterpret(a) => {
            let from = operand(a)?;
            let as_wide = from.bits() == ty.bits();
            if as_wide { Ok(()) } else { Err(format!("{a} is {from}, which is not as wide as {ty}")) }
        }
        Op::Call(helper, _, b) if b.is_some() != helper.takes_two() => {
            let count = if helper.takes_two() { "two operands" } else { "one operand" };
            Err(format!("{} takes {count}", helper.mnemonic()))
        }
        Op::Call(helper, a, b) => {
            takes(helper.mnemonic(), helper.domain()).and(expect(a, ty)).and(b.map_or(Ok(()), |b| expect(b, ty)))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::elementary::Value;
    use crate::logic::image::LayoutBuilder;
    use crate::logic::{Area, Binary, Builder, Compare, Helper, Origin, Slot, Task, random};

    /// v0 = load s0, v1 = load s1, v2 = and v0 v0, v3 = store s0 v2 | v4 = lt v1 v1 in two sections.
    fn program() -> Program {
        let mut layout = LayoutBuilder::new();
        for (name, ty) in [("a", Elementary::Bool), ("n", Elementary::Int), ("due", Elementary::Time)] {
            let initial = Value::default_of(ty);
            let slot = Slot { name: name.into(), ty, offset: 0, area: Area::Memory, retain: false, initial, line: 0 };
            layout.slot(slot);
        }
        let mut builder = Builder::new("p", layout.finish(None).unwrap());
        let (a, n) = (builder.load(SlotId(0)), builder.load(SlotId(1)));
        let both = builder.and(a, a);
        builder.store(SlotId(0), both);
        builder.end_section(Origin { label: "r1".into(), line: 1 });
        builder.compare(Compare::Less, n, n);
        builder.end_section(Origin { label: "r2".into(), line: 2 });
        builder.finish()
    }

    fn message_of(change: impl Fn(&mut Program)) -> Vec<String> {
        let mut program = program();
        assert_eq!(verify(&program), Ok(()));
        change(&mut program);
        verify(&program).unwrap_err().iter().map(Problem::to_string).collect()
    }

    #[test]
    fn random_programs_pass() {
        for seed in 0..200 {
            assert_eq!(verify(&random::program(seed)), Ok(()), "seed {seed}");
        }
    }

    #[test]
    fn broken_instructions_are_named() {
        let (v, int) = (ValueId, Elementary::Int);
        let cases = [
            (2, Elementary::Bool, Op::Binary(Binary::And, v(0), v(2)), "v2: v2 is used before it is defined"),
            (2, Elementary::Bool, Op::Binary(Binary::And, v(0), v(1)), "v2: v1 is INT, but BOOL belongs here"),
            (2, int, Op::Binary(Binary::And, v(1), v(1)), "v2: and does not take INT"),
            (2, Elementary::Word, Op::Binary(Binary::ShiftLeft, v(0), v(1)), "v2: v0 is BOOL, but WORD belongs here"),
            (4, Elementary::Bool, Op::Convert(v(3)), "v4: v3 is a store, which has no value"),
            (4, Elementary::Real, Op::Reinterpret(v(1)), "v4: v1 is INT, which is not as wide as REAL"),
            (4, Elementary::Byte, Op::Reinterpret(v(0)), "v4: v0 is BOOL, which is not as wide as BYTE"),
            (4, int, Op::Reinterpret(v(4)), "v4: v4 is used before it is defined"),
            (4, int, Op::Compare(Compare::Less, v(1), v(1)), "v4: the result is INT, but BOOL belongs here"),
            (4, Elementary::Bool, Op::Compare(Compare::Less, v(0), v(1)), "v4: v1 is INT, but BOOL belongs here"),
            (4, int, Op::Select(v(1), v(1), v(1)), "v4: v1 is INT, but BOOL belongs here"),
            (4, int, Op::Load(SlotId(0)), "v4: s0 is BOOL, but INT belongs here"),
            (4, int, Op::Load(SlotId(3)), "v4: s3 does not exist"),
            (4, int, Op::Store(SlotId(1), v(0)), "v4: v0 is BOOL, but INT belongs here"),
            (4, int, Op::Constant(0xFFFF), "v4: 0xffff is no INT in register form"),
            (4, int, Op::Call(Helper::Sin, v(1), None), "v4: sin does not take INT"),
            (4, Elementary::Real, Op::Call(Helper::Sin, v(1), None), "v4: v1 is INT, but REAL belongs here"),
            (4, Elementary::Real, Op::Call(Helper::Sin, v(1), Some(v(1))), "v4: sin takes one operand"),
            (4, Elementary::Real, Op::Call(Helper::Power, v(1), None), "v4: pow takes two operands"),
            (4, int, Op::LoadIndexed(ArrayId(0), v(1)), "v4: a0 does not exist"),
            (4, int, Op::CopyArray(ArrayId(0), ArrayId(0), v(0)), "v4: a0 does not exist"),
            (4, int, Op::Now, "v4: the result is INT, but TIME belongs here"),
        ];
        for (place, ty, op, expected) in cases {
            let messages = message_of(|program| program.instructions[place] = Instruction { ty, op });
            assert!(messages.iter().any(|message| message == expected), "{messages:?} lacks {expected}");
        }
    }

    #[test]
    fn copies_between_arrays_that_do_not_fit_are_named() {
        let mut layout = LayoutBuilder::new();
        for index in 0..6 {
            let ty = if index < 4 { Elementary::Int } else { Elementary::Bool };
            let (name, initial) = (format!("x{index}"), Value::default_of(ty));
            layout.slot(Slot { name: name.into(), ty, offset: 0, area: Area::Memory, retain: false, initial, line: 0 });
        }
        for (first, count) in [(0, 2), (2, 2), (1, 2), (2, 1), (4, 2), (0, 2)] {
            layout.array(SlotId(first), count);
        }
        let layout = layout.finish(None).unwrap();
        let cases = [
            (1, None),
            (0, None),
            (5, None),
            (2, Some("v1: a0 and a2 share slots")),
            (3, Some("v1: a0 has 2 elements, but a3 has 1")),
            (4, Some("v1: s4 is BOOL, but INT belongs here")),
        ];
        for (from, expected) in cases {
            let mut builder = Builder::new("p", layout.clone());
            builder.copy_array(ArrayId(0), ArrayId(from), None);
            builder.end_section(Origin { label: "r1".into(), line: 1 });
            let problems = verify(&builder.finish()).err().unwrap_or_default();
            let messages: Vec<String> = problems.iter().map(Problem::to_string).collect();
            assert_eq!(messages, expected.into_iter().collect::<Vec<_>>());
        }
    }

    #[test]
    fn broken_tasks_are_named() {
        let task = |interval, due, end| Task { name: "t".to_owned(), interval, due, end };
        let both = Some(SlotId(2));
        let cases = [
            (vec![], "the tasks end at 0, before the sections do"),
            (vec![task(None, None, 1)], "the tasks end at 1, before the sections do"),
            (vec![task(None, None, 3)], "task 0 cannot end at 3"),
            (vec![task(None, None, 2), task(None, None, 1)], "task 1 cannot end at 1"),
            (vec![task(None, None, 1), task(None, None, 2)], "the first section of task 1 does not start a chunk"),
            (vec![task(Some(0), both, 2)], "task 0 has the interval 0"),
            (vec![task(Some(5), None, 2)], "task 0 has not both, an interval and a slot for when it is due"),
            (vec![task(None, both, 2)], "task 0 has not both, an interval and a slot for when it is due"),
            (vec![task(Some(5), Some(SlotId(9)), 2)], "task 0 has s9, which does not exist"),
            (vec![task(Some(5), Some(SlotId(1)), 2)], "task 0 cannot keep when it is due in s1"),
            (vec![task(Some(5), both, 2), task(Some(5), both, 2)], "task 1 cannot keep when it is due in s2"),
        ];
        for (tasks, expected) in cases {
            assert_eq!(message_of(|program| program.tasks.clone_from(&tasks)), [expected]);
        }
        let mut program = program();
        program.tasks = vec![task(None, None, 0), task(Some(5), both, 2), task(None, None, 2)];
        assert_eq!(verify(&program), Ok(()));
    }

    #[test]
    fn broken_sections_are_named() {
        assert_eq!(
            message_of(|program| program.sections[1].end = 4),
            ["the sections end at 4, before the instructions do"]
        );
        assert_eq!(message_of(|program| program.sections[1].end = 3), ["section 1 cannot end at 3"]);
        assert_eq!(message_of(|program| program.sections[1].end = 6), ["section 1 cannot end at 6"]);
        assert_eq!(
            message_of(|program| program.sections[1].origin = 2),
            ["section 1 has the origin 2, which there is not"]
        );
        assert_eq!(
            message_of(|program| program.sections[0].starts_chunk = false),
            ["the first section of task 0 does not start a chunk"]
        );
        assert_eq!(message_of(|program| program.sections[1].starts_chunk = true), ["v4: v1 is of an earlier chunk"]);
    }
}
