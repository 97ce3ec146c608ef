//! What two programs are executed in together: a graph, the words that slots hold, and the functions that were applied.
//!
//! Whatever both of them compute alike is one thing here. What a slot holds is taken apart into bits only where somebody
//! looks: of a long array, of which an element is set by an index that is not known, mostly nobody does.

use std::collections::{BTreeMap, HashMap};
use std::rc::Rc;

use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;

use super::function::{Application, Function};
use super::graph::{Column, Graph, Literal, Node, Source, value_in};
use super::judge::Judge;
use super::word::{Word, as_constant, constant, signed};
use crate::elementary::{Elementary, Value};
use crate::logic::{Layout, SlotId, random};

/// Columns of samples at first.
pub(super) const COLUMNS: usize = 4;

/// Columns up to which counterexamples are added; from then on the oldest of them go.
const MOST_COLUMNS: usize = 12;

/// What a slot holds, by its number: equal numbers are equal values.
#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Debug)]
pub(super) struct Held(u32);

/// How what a slot holds is made.
#[derive(Clone, PartialEq, Eq, Hash, Debug)]
enum Made {
    /// It is there at first.
    Initially(SlotId),
    Bits(Rc<[Literal]>),
    /// The value where an index, a LINT, names this element, else what was there before.
    Where {
        index: Rc<[Literal]>,
        element: u32,
        value: Held,
        before: Held,
    },
    /// The one while a condition holds, else the other.
    While {
        condition: Literal,
        value: Held,
        before: Held,
    },
}

/// See the module.
#[derive(Debug)]
pub(super) struct Space<'a> {
    layout: &'a Layout,
    pub(super) graph: Graph,
    made: Vec<Made>,
    numbers: HashMap<Made, Held>,
    /// What was taken apart.
    bits: HashMap<Held, Rc<[Literal]>>,
    now: Option<Word>,
    applications: Vec<Application>,
    /// By application: its result as far as it was asked for.
    results: Vec<Word>,
    applied: HashMap<Application, u32>,
    /// The applications of a function whose operands have the same samples at first.
    alike: HashMap<(Function, Vec<u64>), Vec<u32>>,
    contents: HashMap<Vec<Held>, u32>,
    /// Columns that were added.
    added: usize,
    pub(super) judge: Judge,
}

impl<'a> Space<'a> {
    pub(super) fn new(layout: &'a Layout) -> Self {
        Self {
            layout,
            graph: Graph::new(COLUMNS),
            made: Vec::new(),
            numbers: HashMap::new(),
            bits: HashMap::new(),
            now: None,
            applications: Vec::new(),
            results: Vec::new(),
            applied: HashMap::new(),
            alike: HashMap::new(),
            contents: HashMap::new(),
            added: 0,
            judge: Judge::default(),
        }
    }

    fn number(&mut self, made: Made) -> Held {
        let next = Held(u32::try_from(self.made.len()).unwrap_or(u32::MAX));
        *self.numbers.entry(made.clone()).or_insert_with(|| {
            self.made.push(made);
            next
        })
    }

    /// What a slot holds at first.
    pub(super) fn initially(&mut self, slot: SlotId) -> Held {
        self.number(Made::Initially(slot))
    }

    pub(super) fn holding(&mut self, word: &[Literal]) -> Held {
        let word: Rc<[Literal]> = word.iter().map(|literal| self.graph.find(*literal)).collect();
        let held = self.number(Made::Bits(Rc::clone(&word)));
        self.bits.insert(held, word);
        held
    }

    /// What an element holds when an element by an index was set.
    pub(super) fn set_where(&mut self, index: &Rc<[Literal]>, element: u32, value: Held, before: Held) -> Held {
        if value == before {
            return before;
        }
        if as_constant(index) == Some(u64::from(element)) {
            return value;
        }
        self.number(Made::Where { index: Rc::clone(index), element, value, before })
    }

    /// What a slot holds when it was set while a condition holds.
    pub(super) fn set_while(&mut self, condition: Literal, value: Held, before: Held) -> Held {
        match self.graph.find(condition).as_constant() {
            Some(true) => value,
            Some(false) => before,
            None if value == before => before,
            None => self.number(Made::While { condition, value, before }),
        }
    }

    /// The bits of what a slot holds.
    pub(super) fn bits(&mut self, held: Held) -> Rc<[Literal]> {
        // What is made of what is made of ... comes from a long row of stores: without recursion.
        let mut waiting = vec![held];
        while let Some(next) = waiting.pop() {
            if self.bits.contains_key(&next) {
                continue;
            }
            let bits: Rc<[Literal]> = match self.made[next.0 as usize].clone() {
                Made::Bits(bits) => bits,
                Made::Initially(slot) => self.initial_bits(slot).into(),
                Made::Where { value, before, .. } | Made::While { value, before, .. }
                    if !self.bits.contains_key(&value) || !self.bits.contains_key(&before) =>
                {
                    waiting.extend([next, value, before]);
                    continue;
                }
                Made::Where { index, element, value, before } => {
                    let named = self.is_element(&index, element);
                    self.chosen(named, value, before)
                }
                Made::While { condition, value, before } => self.chosen(condition, value, before),
            };
            self.bits.insert(next, bits);
        }
        Rc::clone(&self.bits[&held])
    }

    fn chosen(&mut self, condition: Literal, value: Held, before: Held) -> Rc<[Literal]> {
        let (value, before) = (Rc::clone(&self.bits[&value]), Rc::clone(&self.bits[&before]));
        self.graph.select_word(condition, &value, &before).into()
    }

    /// Whether an index, a LINT, names an element.
    pub(super) fn is_element(&mut self, index: &[Literal], element: u32) -> Literal {
        let element = signed(&constant(u64::from(element), 32), false);
        let index = signed(index, true);
        self.graph.equal(&index, &element)
    }

    fn initial_bits(&mut self, slot: SlotId) -> Word {
        let ty = self.layout.slot(slot).ty;
        self.variables(u64::from(slot.0) + 1, ty, |bit| Source::Slot(slot, bit))
    }

    /// The bits of the time.
    pub(super) fn now(&mut self) -> Word {
        if let Some(now) = &self.now {
            return now.clone();
        }
        let now = self.variables(0, Elementary::Time, Source::Now);
        self.now = Some(now.clone());
        now
    }

    /// A value of which nothing is known but samples.
    fn variables(&mut self, seed: u64, ty: Elementary, source: impl Fn(u8) -> Source) -> Word {
        let columns = self.graph.columns().len();
        let samples: Vec<[u64; 64]> = (0..columns as u64)
            .map(|column| {
                let mut rng = Pcg64::seed_from_u64(seed << 4 | column);
                match (ty, column % 4) {
                    // A row of contacts conducts on few images where half of its bits are set.
                    (Elementary::Bool, 2) => [rng.random::<u64>() & rng.random::<u64>(); 64],
                    (Elementary::Bool, 3) => [rng.random::<u64>() | rng.random::<u64>(); 64],
                    (Elementary::Bool, _) => [rng.random(); 64],
                    _ => transposed(&std::array::from_fn(|_| random::value(&mut rng, ty).bits())),
                }
            })
            .collect();
        (0..ty.bits())
            .map(|bit| {
                let place = u8::try_from(bit).unwrap_or(u8::MAX);
                self.graph.variable(source(place), |column| samples[column][bit as usize])
            })
            .collect()
    }

    /// The number of the contents of an array.
    pub(super) fn contents(&mut self, elements: Vec<Held>) -> u32 {
        let next = u32::try_from(self.contents.len()).unwrap_or(u32::MAX);
        *self.contents.entry(elements).or_insert(next)
    }

    /// The low bits of what a function makes of operands.
    pub(super) fn apply(&mut self, function: Function, operands: Vec<Word>, width: usize) -> Word {
        let operands =
            operands.into_iter().map(|word| word.iter().map(|bit| self.graph.find(*bit)).collect()).collect();
        let application = Application::new(function, operands);
        if let Some(bits) = application.constant() {
            return constant(bits, width);
        }
        let number = self.application(application);
        let have = self.results[number as usize].len();
        if have < width {
            let application = &self.applications[number as usize];
            let columns = self.graph.columns().iter();
            let samples: Vec<[u64; 64]> =
                columns.map(|column| transposed(&application.samples(|bit| value_in(column, bit)))).collect();
            let more = (have..width).map(|bit| {
                let source = Source::Applied(number, u8::try_from(bit).unwrap_or(u8::MAX));
                self.graph.variable(source, |column| samples[column][bit])
            });
            self.results[number as usize].extend(more);
        }
        self.results[number as usize][..width].to_vec()
    }

    /// The number of an application, or of one whose operands are proved equal.
    fn application(&mut self, application: Application) -> u32 {
        if let Some(number) = self.applied.get(&application) {
            return *number;
        }
        let shape = application.operands.iter().flatten();
        let samples = shape.map(|bit| self.graph.sample(0, *bit)).collect();
        let key = (application.function, samples);
        let alike = self.alike.get(&key).cloned().unwrap_or_default();
        let same = alike.into_iter().find(|number| {
            let other = self.applications[*number as usize].operands.clone();
            let lengths = other.iter().map(Vec::len).eq(application.operands.iter().map(Vec::len));
            lengths
                && other
                    .iter()
                    .flatten()
                    .zip(application.operands.iter().flatten())
                    .all(|(a, b)| self.are_equal(*a, *b))
        });
        let number = same.unwrap_or_else(|| {
            let number = u32::try_from(self.applications.len()).unwrap_or(u32::MAX);
            self.applications.push(application.clone());
            self.results.push(Word::new());
            self.alike.entry(key).or_default().push(number);
            number
        });
        self.applied.insert(application, number);
        number
    }

    /// The operands of the product that a word of 64 bits is, if it is one.
    pub(super) fn as_product(&self, word: &[Literal]) -> Option<&[Word]> {
        let Node::Variable(Source::Applied(number, 0)) = self.graph.node(word.first()?.node()) else { return None };
        let application = &self.applications[number as usize];
        let is_product = application.function == Function::Product && self.results[number as usize].starts_with(word);
        is_product.then_some(&application.operands)
    }

    /// The image and the time of a sample: what no variable tells is as it starts.
    pub(super) fn sample(&self, column: usize, sample: u32) -> (Vec<u8>, i64) {
        let (mut values, mut now) = (BTreeMap::<SlotId, u64>::new(), 0u64);
        for (node, value) in (0..).zip(&self.graph.columns()[column]) {
            let set = value >> sample & 1;
            match self.graph.node(node) {
                Node::Variable(Source::Slot(slot, bit)) => *values.entry(slot).or_default() |= set << bit,
                Node::Variable(Source::Now(bit)) => now |= set << bit,
                Node::False | Node::And(..) | Node::Variable(Source::Applied(..)) => {}
            }
        }
        let mut image = self.layout.initial_image();
        for (slot, bits) in values {
            let slot = self.layout.slot(slot);
            slot.write(&mut image, Value::from_bits(slot.ty, bits));
        }
        (image, now.cast_signed())
    }

    /// What it costs to add samples, in the solver's units of work.
    pub(super) fn cost_of_samples(&self) -> u64 {
        /// A function is computed 64 times, of operands put together bit by bit.
        const FUNCTION: usize = 1000;
        (self.graph.len() + FUNCTION * self.applications.len()) as u64
    }

    /// Adds samples on which variables have these values, and some near them.
    pub(super) fn refine(&mut self, values: &HashMap<u32, bool>) {
        let mut rng = Pcg64::seed_from_u64(self.added as u64);
        let mut column: Column = Vec::with_capacity(self.graph.len());
        let mut last: Option<(u32, [u64; 64])> = None;
        for node in 0..self.graph.len() {
            let node = u32::try_from(node).unwrap_or(u32::MAX);
            let value = match self.graph.node(node) {
                Node::False => 0,
                Node::And(a, b) => value_in(&column, a) & value_in(&column, b),
                Node::Variable(Source::Applied(number, bit)) => {
                    let result = match last {
                        Some((of, result)) if of == number => result,
                        _ => {
                            let application = &self.applications[number as usize];
                            transposed(&application.samples(|bit| value_in(&column, bit)))
                        }
                    };
                    last = Some((number, result));
                    result[usize::from(bit)]
                }
                Node::Variable(Source::Slot(..) | Source::Now(_)) => match values.get(&node) {
                    Some(value) => {
                        // The first sample is exact; in the others one bit in sixteen is another.
                        let flips = (0..4).fold(!1, |flips, _| flips & rng.random::<u64>());
                        flips ^ if *value { u64::MAX } else { 0 }
                    }
                    None => self.graph.sample(0, Literal::of(node)),
                },
            };
            column.push(value);
        }
        let place = COLUMNS + self.added % (MOST_COLUMNS - COLUMNS);
        self.graph.set_column(place, column);
        self.added += 1;
    }
}

/// 64 numbers as their bits: of each number one bit in each of the results.
fn transposed(numbers: &[u64; 64]) -> [u64; 64] {
    let mut bits = [0; 64];
    for (lane, number) in numbers.iter().enumerate() {
        let mut rest = *number;
        while rest != 0 {
            bits[rest.trailing_zeros() as usize] |= 1 << lane;
            rest &= rest - 1;
        }
    }
    bits
}
