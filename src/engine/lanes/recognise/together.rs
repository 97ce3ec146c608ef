//! Whether two choices can be taken in one scan and lane.
//!
//! Each is taken under conditions, those of the selects on the way to it. Where every way to the one needs a condition
//! that every way to the other needs to be otherwise, they never are. What is not seen here is only slower.

use std::collections::BTreeMap;

use super::{Leaf, difference};
use crate::logic::{Binary, Op, Program, Unary, ValueId};

/// Ways to a choice, and conditions of a way, at most.
const MOST_WAYS: usize = 32;
const MOST_CONDITIONS: usize = 64;

/// What each of some BOOLs has to be.
type Conditions = BTreeMap<ValueId, bool>;

/// Whether a store never gives its slot one leaf in a scan and lane in which another gives its slot another.
pub(super) fn never_together(program: &Program, one: (usize, Leaf), other: (usize, Leaf)) -> bool {
    let ways = |(store, leaf): (usize, Leaf)| {
        let root = program.instructions[store].op.operands().next()?;
        ways(program, root, leaf)
    };
    let (Some(one), Some(other)) = (ways(one), ways(other)) else { return false };
    let contradict = |a: &Conditions, b: &Conditions| a.iter().any(|(value, holds)| b.get(value) == Some(&!*holds));
    one.iter().all(|a| other.iter().all(|b| contradict(a, b)))
}

/// The ways to a leaf, unless there are too many.
fn ways(program: &Program, root: ValueId, leaf: Leaf) -> Option<Vec<Conditions>> {
    let mut open = vec![(root, Conditions::new())];
    let (mut found, mut seen) = (Vec::new(), 0);
    while let Some((value, conditions)) = open.pop() {
        seen += 1;
        if seen > MOST_WAYS * 4 || found.len() > MOST_WAYS {
            return None;
        }
        match program.instructions[value.index()].op {
            Op::Select(condition, a, b) => {
                for (value, holds) in [(a, true), (b, false)] {
                    let mut conditions = conditions.clone();
                    assume(program, &mut conditions, condition, holds);
                    open.push((value, conditions));
                }
            }
            op if is_leaf(program, value, op, leaf) => found.push(conditions),
            _ => {}
        }
    }
    Some(found)
}

fn is_leaf(program: &Program, value: ValueId, op: Op, leaf: Leaf) -> bool {
    match leaf {
        Leaf::Constant(bits) => op == Op::Constant(bits),
        Leaf::Now => op == Op::Now,
        Leaf::Since(latch) => difference(program, value) == Some(latch),
    }
}

/// Adds a condition, and those that follow from it.
fn assume(program: &Program, conditions: &mut Conditions, value: ValueId, holds: bool) {
    let mut open = vec![(value, holds)];
    while let Some((value, holds)) = open.pop() {
        if conditions.len() >= MOST_CONDITIONS || conditions.insert(value, holds).is_some() {
            continue;
        }
        match (program.instructions[value.index()].op, holds) {
            (Op::Unary(Unary::Not, a), _) => open.push((a, !holds)),
            (Op::Binary(Binary::And, a, b), true) | (Op::Binary(Binary::Or, a, b), false) => {
                open.extend([(a, holds), (b, holds)]);
            }
            _ => {}
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::elementary::{Elementary, Value};
    use crate::logic::{Area, Builder, LayoutBuilder, Origin, Slot};

    /// Whether a slot that gets `now` minus a latch under one condition never does while the latch is set under
    /// another, each made of two inputs.
    fn never(
        when: impl Fn(&mut Builder, ValueId, ValueId) -> ValueId,
        sets: impl Fn(&mut Builder, ValueId, ValueId) -> ValueId,
    ) -> bool {
        let mut layout = LayoutBuilder::new();
        let mut slot = |name: &str, ty, area| {
            let initial = Value::default_of(ty);
            layout.slot(Slot { name: name.into(), ty, offset: 0, area, retain: false, initial, line: 0 })
        };
        let [a, b] = ["a", "b"].map(|name| slot(name, Elementary::Bool, Area::Input));
        let [start, elapsed] = ["start", "elapsed"].map(|name| slot(name, Elementary::Time, Area::Memory));
        let mut builder = Builder::new("p".to_owned(), layout.finish(None).expect("few slots"));
        let [a, b] = [a, b].map(|slot| builder.load(slot));
        let (now, old) = (builder.now(), builder.load(start));
        let passed = builder.binary(Binary::Subtract, now, old);
        let zero = builder.constant(Value::time(0));
        let when = when(&mut builder, a, b);
        let given = builder.select(when, passed, zero);
        builder.store(elapsed, given);
        let sets = sets(&mut builder, a, b);
        let set = builder.select(sets, now, old);
        builder.store(start, set);
        builder.end_section(Origin { label: "r".into(), line: 0 });
        let program = builder.finish();
        let is_store = |index: &usize| matches!(program.instructions[*index].op, Op::Store(..));
        let stores: Vec<usize> = (0..program.instructions.len()).filter(is_store).collect();
        never_together(&program, (stores[0], Leaf::Since(start)), (stores[1], Leaf::Now))
    }

    #[test]
    fn choices_are_never_taken_together_where_a_condition_of_one_is_otherwise_for_the_other() {
        assert!(never(|_, a, _| a, |builder, a, _| builder.not(a)));
        assert!(never(Builder::and, |builder, a, _| builder.not(a)));
        assert!(never(
            |_, _, b| b,
            |builder, a, b| {
                let either = builder.or(a, b);
                builder.not(either)
            }
        ));
    }

    #[test]
    fn choices_that_may_be_taken_together_are_not_said_to_exclude_each_other() {
        assert!(!never(|_, a, _| a, |_, _, b| b));
        assert!(!never(|_, a, _| a, |_, a, _| a));
        assert!(!never(Builder::or, |builder, a, _| builder.not(a)));
        assert!(!never(
            |_, a, _| a,
            |builder, a, b| {
                let both = builder.and(a, b);
                builder.not(both)
            }
        ));
    }
}
