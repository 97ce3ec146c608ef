//! Which slots need no value for each lane, because what was stored last can be told from when it was stored.
//!
//! A slot is **tracked** when all that is ever stored to it is, by conditions, one of
//!
//! - what it held (the slot's own value, loaded in the same scan before the store),
//! - a constant,
//! - `now`, or `now` minus a tracked slot that only ever gets `now` (a **latch**),
//!
//! and when nobody but its own store, and for a latch such a difference, looks at its value. Then the value in a lane
//! is a function of two things: which of those choices was taken last, and in which scan; and all times of scans are
//! common to the lanes. [`track`](super::track) keeps just that. A comparison of such a difference with a constant,
//! which is a question about when the latch was set last, becomes a [`Due`].
//!
//! All this is seen from the operations alone, by the uses of values: nothing here may know a block. What is not proven
//! is left to [`columns`](super::columns), which is always right.

mod together;

use std::collections::{BTreeMap, HashMap, HashSet};

use crate::elementary::Elementary;
use crate::logic::{Area, Binary, Compare, Op, Program, SlotId, ValueId};
use together::never_together;

/// Operations in the choice that is stored to a tracked slot, at most.
const MOST_NODES: usize = 64;

/// Rounds of striking out slots that turn out not to fit. Two or three are enough but for contrived programs.
const MOST_ROUNDS: usize = 64;

/// Things that a tracked slot can be given, besides what it held, at most: what three bits tell apart.
const MOST_LEAVES: usize = 7;

/// What a tracked slot is given.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Leaf {
    /// Register bits.
    Constant(u64),
    /// The time of the scan.
    Now,
    /// The time of the scan minus a latch, as it was before the scan.
    Since(SlotId),
}

/// A slot of which only the last choice is kept.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(super) struct Tracked {
    pub(super) slot: SlotId,
    /// The one store to it, as an instruction.
    pub(super) store: usize,
    /// What it can be given, besides what it held: code 1 is the first, code 0 is a value that is kept for itself.
    pub(super) leaves: Vec<Leaf>,
    /// Whether it can also be given what it held.
    pub(super) keeps: bool,
    /// Whether all it holds can be told from the code alone, from the last run of its task, and from its latches as
    /// they are: it is given something in every run, and a difference only in lanes in which the latch is not set in
    /// the same run.
    pub(super) follows: bool,
}

impl Tracked {
    /// Whether it is only ever given `now`.
    pub(super) fn is_latch(&self) -> bool {
        self.leaves == [Leaf::Now]
    }

    /// Bits that tell the codes apart.
    pub(super) fn bits(&self) -> usize {
        (usize::BITS - self.leaves.len().leading_zeros()) as usize
    }

    /// The code of what is given; 0 of anything else.
    pub(super) fn code(&self, leaf: Leaf) -> usize {
        self.leaves.iter().position(|other| *other == leaf).map_or(0, |place| place + 1)
    }
}

/// A question about a latch: whether so many nanoseconds or more have passed since it was set.
#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Debug)]
pub(super) struct Due {
    /// Nanoseconds, of any sign.
    pub(super) preset: i64,
    pub(super) latch: SlotId,
}

/// What a comparison is.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Answer {
    Due { due: Due, inverted: bool },
    Always(bool),
}

/// What was recognised in a program.
#[derive(Debug, Default)]
pub(super) struct Recognised {
    /// Latches first; each kind in the order of the slots.
    pub(super) tracked: Vec<Tracked>,
    /// The comparisons that are answered from when a latch was set.
    pub(super) answers: HashMap<ValueId, Answer>,
    /// Instructions that nothing but tracked slots needs.
    pub(super) absorbed: HashSet<ValueId>,
}

/// What is stored to a slot that may be tracked, taken apart.
#[derive(Debug)]
struct Choice {
    store: usize,
    selects: Vec<ValueId>,
    /// Differences to latches.
    differences: Vec<ValueId>,
    leaves: Vec<Leaf>,
    /// Whether what the slot held is among them.
    keeps: bool,
}

impl Choice {
    fn is_latch(&self) -> bool {
        self.leaves == [Leaf::Now]
    }
}

/// Recognises what can be tracked in a verified program.
pub(super) fn recognise(program: &Program) -> Recognised {
    let facts = Facts::of(program);
    let mut choices: BTreeMap<SlotId, Choice> = BTreeMap::new();
    for (slot, stores) in &facts.stores {
        if let [store] = stores[..]
            && !facts.barred.contains(slot)
            && let Some(choice) = choice(program, *slot, store)
        {
            choices.insert(*slot, choice);
        }
    }
    for _ in 0..MOST_ROUNDS {
        let accounts = Accounts::of(program, &facts, &choices);
        let before = choices.len();
        let good: HashSet<SlotId> = choices
            .iter()
            .filter(|(slot, choice)| accounts.allow(program, &facts, &choices, **slot, choice))
            .map(|(slot, _)| *slot)
            .collect();
        choices.retain(|slot, _| good.contains(slot));
        if choices.len() == before {
            return accounts.recognised(program, choices);
        }
    }
    Recognised::default()
}

/// What is stored to a slot, if it is a choice between what a tracked slot may get.
fn choice(program: &Program, slot: SlotId, store: usize) -> Option<Choice> {
    let op = |value: ValueId| program.instructions[value.index()].op;
    let Op::Store(_, root) = program.instructions[store].op else { return None };
    let mut found = Choice { store, selects: Vec::new(), differences: Vec::new(), leaves: Vec::new(), keeps: false };
    let mut seen = HashSet::new();
    let mut open = vec![root];
    while let Some(value) = open.pop() {
        if !seen.insert(value) {
            continue;
        }
        if seen.len() > MOST_NODES {
            return None;
        }
        let leaf = match op(value) {
            Op::Select(_, a, b) => {
                found.selects.push(value);
                open.extend([b, a]);
                continue;
            }
            Op::Load(of) if of == slot => {
                found.keeps = true;
                continue;
            }
            Op::Constant(bits) => Leaf::Constant(bits),
            Op::Now => Leaf::Now,
            Op::Binary(Binary::Subtract, ..) => {
                let latch = difference(program, value).filter(|latch| *latch != slot)?;
                found.differences.push(value);
                Leaf::Since(latch)
            }
            Op::Load(_)
            | Op::Store(..)
            | Op::Unary(..)
            | Op::Binary(..)
            | Op::Compare(..)
            | Op::Convert(_)
            | Op::Reinterpret(_)
            | Op::Call(..)
            | Op::LoadIndexed(..)
            | Op::StoreIndexed(..)
            | Op::CopyArray(..) => return None,
        };
        if !found.leaves.contains(&leaf) {
            found.leaves.push(leaf);
        }
    }
    (found.leaves.len() <= MOST_LEAVES).then_some(found)
}

/// The slot that a value is `now` minus, if it is.
fn difference(program: &Program, value: ValueId) -> Option<SlotId> {
    let op = |value: ValueId| program.instructions[value.index()].op;
    match op(value) {
        Op::Binary(Binary::Subtract, a, b) if op(a) == Op::Now => match op(b) {
            Op::Load(slot) => Some(slot),
            _ => None,
        },
        _ => None,
    }
}

/// What a comparison asks of a difference, if it compares one with a constant: the difference, and the answer in
/// which `x >= c` is a due of c.
fn question(program: &Program, op: Compare, a: ValueId, b: ValueId) -> Option<(ValueId, Answer)> {
    let constant = |value: ValueId| match program.instructions[value.index()].op {
        Op::Constant(bits) => Some(bits.cast_signed()),
        _ => None,
    };
    let (value, op, with) = match (constant(a), constant(b)) {
        (None, Some(with)) => (a, op, with),
        (Some(with), None) => (b, mirrored(op), with),
        (Some(_), Some(_)) | (None, None) => return None,
    };
    let latch = difference(program, value)?;
    let at_least = |preset: i64, inverted| Answer::Due { due: Due { preset, latch }, inverted };
    let answer = match op {
        Compare::GreaterOrEqual => at_least(with, false),
        Compare::Less => at_least(with, true),
        Compare::Greater => with.checked_add(1).map_or(Answer::Always(false), |with| at_least(with, false)),
        Compare::LessOrEqual => with.checked_add(1).map_or(Answer::Always(true), |with| at_least(with, true)),
        Compare::Equal | Compare::NotEqual => return None,
    };
    Some((value, answer))
}

/// The comparison that says the same with its operands the other way round.
fn mirrored(op: Compare) -> Compare {
    match op {
        Compare::Equal | Compare::NotEqual => op,
        Compare::Less => Compare::Greater,
        Compare::LessOrEqual => Compare::GreaterOrEqual,
        Compare::Greater => Compare::Less,
        Compare::GreaterOrEqual => Compare::LessOrEqual,
    }
}

/// What is to be known of a program before anything can be recognised.
struct Facts {
    /// How often each value is used.
    uses: Vec<u32>,
    stores: BTreeMap<SlotId, Vec<usize>>,
    loads: HashMap<SlotId, Vec<usize>>,
    /// Slots that can be reached in other ways than by loads and stores of their own, and BOOLs.
    barred: HashSet<SlotId>,
}

impl Facts {
    fn of(program: &Program) -> Self {
        let (mut stores, mut loads): (BTreeMap<_, Vec<usize>>, HashMap<_, Vec<usize>>) = Default::default();
        let mut uses = vec![0; program.instructions.len()];
        let mut arrays = HashSet::new();
        for (index, instruction) in program.instructions.iter().enumerate() {
            instruction.op.operands().for_each(|operand| uses[operand.index()] += 1);
            match instruction.op {
                Op::Load(slot) => loads.entry(slot).or_default().push(index),
                Op::Store(slot, _) => stores.entry(slot).or_default().push(index),
                Op::LoadIndexed(array, _) | Op::StoreIndexed(array, ..) => drop(arrays.insert(array)),
                Op::CopyArray(to, from, _) => arrays.extend([to, from]),
                Op::Constant(_)
                | Op::Now
                | Op::Unary(..)
                | Op::Binary(..)
                | Op::Compare(..)
                | Op::Select(..)
                | Op::Convert(_)
                | Op::Reinterpret(_)
                | Op::Call(..) => {}
            }
        }
        let mut barred: HashSet<SlotId> = program.tasks.iter().filter_map(|task| task.due).collect();
        for array in arrays {
            let slots = program.layout.array(array).slots();
            barred.extend((slots.start.0..slots.end.0).map(SlotId));
        }
        let unfit = (0..).map(SlotId).zip(program.layout.slots());
        let unfit = unfit.filter(|(_, slot)| slot.ty == Elementary::Bool || slot.area == Area::Input);
        barred.extend(unfit.map(|(id, _)| id));
        Self { uses, stores, loads, barred }
    }
}

/// Which uses of values the choices account for.
struct Accounts {
    uses: HashMap<ValueId, u32>,
    /// The slot that each select is part of the choice of.
    owners: HashMap<ValueId, SlotId>,
    answers: HashMap<ValueId, Answer>,
}

impl Accounts {
    fn of(program: &Program, facts: &Facts, choices: &BTreeMap<SlotId, Choice>) -> Self {
        let mut accounts = Self { uses: HashMap::new(), owners: HashMap::new(), answers: HashMap::new() };
        for (slot, choice) in choices {
            program.instructions[choice.store].op.operands().for_each(|root| accounts.count(root));
            for select in &choice.selects {
                if *accounts.owners.entry(*select).or_insert(*slot) == *slot
                    && let Op::Select(_, a, b) = program.instructions[select.index()].op
                {
                    accounts.count(a);
                    accounts.count(b);
                }
            }
        }
        let is_latch = |slot: &SlotId| choices.get(slot).is_some_and(Choice::is_latch);
        for (index, instruction) in program.instructions.iter().enumerate() {
            if let Op::Compare(op, a, b) = instruction.op
                && let Some((value, answer)) = question(program, op, a, b)
                && difference(program, value).is_some_and(|latch| is_latch(&latch))
            {
                accounts.count(value);
                accounts.answers.insert(id(index), answer);
            }
        }
        // A difference of which all uses are accounted for accounts for a use of its latch.
        for (index, instruction) in program.instructions.iter().enumerate() {
            if matches!(instruction.op, Op::Binary(Binary::Subtract, ..))
                && difference(program, id(index)).is_some_and(|latch| is_latch(&latch))
                && accounts.all_uses(facts, id(index))
                && let Op::Binary(_, _, latch) = instruction.op
            {
                accounts.count(latch);
            }
        }
        accounts
    }

    fn count(&mut self, value: ValueId) {
        *self.uses.entry(value).or_default() += 1;
    }

    fn all_uses(&self, facts: &Facts, value: ValueId) -> bool {
        self.uses.get(&value).copied().unwrap_or_default() == facts.uses[value.index()]
    }

    /// Whether a slot can be tracked, as long as all others with a choice can.
    fn allow(
        &self,
        program: &Program,
        facts: &Facts,
        choices: &BTreeMap<SlotId, Choice>,
        slot: SlotId,
        choice: &Choice,
    ) -> bool {
        let loads = facts.loads.get(&slot).map_or(&[][..], Vec::as_slice);
        // A latch that starts at another time than 0 would have been set in no scan.
        let starts_well = !choice.is_latch() || program.layout.slot(slot).initial.bits() == 0;
        let selects = choice.selects.iter();
        let latches = choice.leaves.iter().filter_map(|leaf| match leaf {
            Leaf::Since(latch) => Some(latch),
            Leaf::Constant(_) | Leaf::Now => None,
        });
        starts_well
            && loads.iter().all(|load| *load < choice.store && self.all_uses(facts, id(*load)))
            && selects.clone().all(|select| self.owners.get(select) == Some(&slot) && self.all_uses(facts, *select))
            && choice.differences.iter().all(|difference| self.all_uses(facts, *difference))
            && latches.clone().all(|latch| choices.get(latch).is_some_and(Choice::is_latch))
    }

    /// What is left is tracked.
    fn recognised(self, program: &Program, choices: BTreeMap<SlotId, Choice>) -> Recognised {
        let mut absorbed: HashSet<ValueId> = HashSet::new();
        for index in 0..program.instructions.len() {
            let loaded = match program.instructions[index].op {
                Op::Load(slot) => Some(slot),
                Op::Binary(Binary::Subtract, ..) => difference(program, id(index)),
                _ => None,
            };
            if loaded.is_some_and(|slot| choices.contains_key(&slot)) {
                absorbed.insert(id(index));
            }
        }
        let mut tracked = Vec::new();
        for (slot, choice) in &choices {
            absorbed.extend(&choice.selects);
            let (leaves, keeps) = (choice.leaves.clone(), choice.keeps);
            let follows = follows(program, &choices, choice);
            tracked.push(Tracked { slot: *slot, store: choice.store, leaves, keeps, follows });
        }
        tracked.sort_by_key(|tracked| !tracked.is_latch());
        Recognised { tracked, answers: self.answers, absorbed }
    }
}

/// See [`Tracked::follows`].
fn follows(program: &Program, choices: &BTreeMap<SlotId, Choice>, choice: &Choice) -> bool {
    let not_with = |latch: &SlotId| {
        choices.get(latch).is_some_and(|set| {
            program.task_of(set.store) == program.task_of(choice.store)
                && never_together(program, (choice.store, Leaf::Since(*latch)), (set.store, Leaf::Now))
        })
    };
    let latches = choice.leaves.iter().filter_map(|leaf| match leaf {
        Leaf::Since(latch) => Some(latch),
        Leaf::Constant(_) | Leaf::Now => None,
    });
    !choice.keeps && latches.into_iter().all(not_with)
}

fn id(index: usize) -> ValueId {
    ValueId(u32::try_from(index).unwrap_or(u32::MAX))
}
