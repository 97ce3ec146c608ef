//! Whether two literals are equal: told apart by samples, else by trying all values of what few they are made of, else
//! node by node up to them, else by a SAT solver.
//!
//! What is found equal is merged, so that what is made of it is one by structure, and later questions are small. It may
//! give up, but what it says is so.

use std::collections::{BTreeSet, HashMap, HashSet};

use super::graph::{Graph, Literal, Node};
use super::sat::{self, Answer, Effort};
use super::space::Space;

/// How something was proved, from the least effort to the most.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub(super) enum Method {
    /// It is one node.
    Structure,
    /// All values of what it is made of were tried.
    Exhaustion,
    /// A SAT solver found no values that tell them apart.
    Sat,
}

/// What is known of two literals.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Verdict {
    /// They are equal; [`Space::took`] says what the proof took.
    Equal,
    /// They differ on a sample: column and place in it.
    Differ(usize, u32),
    Unknown,
}

/// Nodes on which two can depend to try all their values, and those that may be looked at on the way there.
const MOST_LEAVES: usize = 12;
const MOST_ON_THE_WAY: usize = 20;
/// Nodes between.
const MOST_INNER: usize = 256;

/// Nodes that are looked at for one question, on the way up.
const MOST_SWEPT: usize = 20_000;
/// Equal samples that are tried for a node.
const MOST_TRIED: usize = 3;
/// Nodes for which none of those is, until no more are tried for one question.
const MOST_IN_VAIN: u32 = 100;

/// For a node on the way; for what was asked, before those and after.
const LITTLE: Effort = Effort { nodes: 300, conflicts: 50, work: WORK };
const SOME: Effort = Effort { nodes: 20_000, conflicts: 200, work: WORK };
const MUCH: Effort = Effort { nodes: 100_000, conflicts: 5_000, work: WORK };

/// Work of the solver, and on new samples, for all questions about one part of a program.
const WORK: u64 = 30_000_000;

/// What is remembered from one question to the next.
#[derive(Debug)]
pub(super) struct Judge {
    /// By node: whether it was compared with those before.
    tried: Vec<bool>,
    /// By node: whether it is in its class.
    listed: Vec<bool>,
    /// Nodes by their samples at first.
    classes: HashMap<u64, Vec<u32>>,
    /// The nodes that are BOOLs of programs, and those of the first program by their samples, each with its section.
    noted: HashSet<u32>,
    values: HashMap<u64, Vec<(usize, u32)>>,
    /// By node: its place in a table of all values, which only whoever fills that may use.
    places: Vec<u32>,
    /// Work that may still be done.
    work: u64,
    /// What the proofs took lately.
    took: Method,
}

impl Default for Judge {
    fn default() -> Self {
        Self {
            tried: Vec::new(),
            listed: Vec::new(),
            classes: HashMap::new(),
            noted: HashSet::new(),
            values: HashMap::new(),
            places: Vec::new(),
            work: WORK,
            took: Method::Structure,
        }
    }
}

impl Space<'_> {
    /// Whether two literals are known or proved to be equal.
    pub(super) fn are_equal(&mut self, a: Literal, b: Literal) -> bool {
        self.judge(a, b) == Verdict::Equal
    }

    /// What the proofs took since this was asked last.
    pub(super) fn took(&mut self) -> Method {
        std::mem::replace(&mut self.judge.took, Method::Structure)
    }

    /// Notes a BOOL that the first of two programs computes in some section.
    pub(super) fn note(&mut self, literal: Literal, section: usize) {
        let node = self.graph.find(literal).node();
        if node != 0 && self.judge.noted.insert(node) {
            let class = self.class(Literal::of(node)).0;
            self.judge.values.entry(class).or_default().push((section, node));
        }
    }

    /// Looks whether a BOOL that the second program computes in some section is one that was noted. If it is, all that
    /// is made of it is the same by structure.
    pub(super) fn meet(&mut self, literal: Literal, section: usize) {
        let node = self.graph.find(literal).node();
        if node == 0 || !self.judge.noted.insert(node) {
            return;
        }
        let (class, inverted) = self.class(Literal::of(node));
        let Some(noted) = self.judge.values.get(&class) else { return };
        // What a section computes is mostly what the same section computed.
        let mut near = noted.clone();
        near.sort_by_key(|(of, _)| of.abs_diff(section));
        for (_, other) in near.into_iter().take(MOST_TRIED) {
            let other = Literal::of(other);
            let other = other.turned(self.class(other).1 != inverted);
            if self.told_apart(Literal::of(node), other).is_some() {
                continue;
            }
            if !self.try_all(Literal::of(node), other) {
                self.ask(Literal::of(node), other, LITTLE);
            }
            if self.graph.find(other) == self.graph.find(Literal::of(node)) {
                return;
            }
        }
    }

    /// What can be found out about two literals.
    pub(super) fn judge(&mut self, a: Literal, b: Literal) -> Verdict {
        if self.graph.find(a) == self.graph.find(b) {
            return Verdict::Equal;
        }
        if let Some((column, sample)) = self.told_apart(a, b) {
            return Verdict::Differ(column, sample);
        }
        if self.try_all(a, b) {
            return Verdict::Equal;
        }
        self.ask(a, b, SOME);
        if self.graph.find(a) != self.graph.find(b) && self.told_apart(a, b).is_none() {
            self.sweep(a, b);
        }
        if self.graph.find(a) != self.graph.find(b) && self.told_apart(a, b).is_none() {
            self.ask(a, b, MUCH);
        }
        if self.graph.find(a) == self.graph.find(b) {
            return Verdict::Equal;
        }
        match self.told_apart(a, b) {
            Some((column, sample)) => Verdict::Differ(column, sample),
            None => Verdict::Unknown,
        }
    }

    /// A sample on which two literals differ.
    fn told_apart(&self, a: Literal, b: Literal) -> Option<(usize, u32)> {
        (0..self.graph.columns().len()).find_map(|column| {
            let differ = self.graph.sample(column, a) ^ self.graph.sample(column, b);
            (differ != 0).then(|| (column, differ.trailing_zeros()))
        })
    }

    fn proved(&mut self, a: Literal, b: Literal, method: Method) {
        self.graph.merge(a, b);
        self.judge.took = self.judge.took.max(method);
    }

    /// Asks the solver; merges them, or adds the samples that it found.
    fn ask(&mut self, a: Literal, b: Literal, effort: Effort) {
        let effort = Effort { work: effort.work.min(self.judge.work), ..effort };
        if effort.work == 0 {
            return;
        }
        let (answer, taken) = sat::ask(&self.graph, a, b, effort);
        self.judge.work = self.judge.work.saturating_sub(taken);
        match answer {
            Answer::Equal => self.proved(a, b, Method::Sat),
            Answer::Differ(values) => {
                self.judge.work = self.judge.work.saturating_sub(self.cost_of_samples());
                self.refine(&values);
            }
            Answer::Unknown => {}
        }
    }

    /// Compares the nodes that only one of two literals is made of with all that either is, from the variables up.
    fn sweep(&mut self, a: Literal, b: Literal) {
        let (of_a, of_b) = (self.cone(a), self.cone(b));
        let mut in_vain = 0;
        for node in &of_a | &of_b {
            let literal = Literal::of(node);
            let is_shared = of_a.contains(&node) && of_b.contains(&node);
            if self.graph.find(literal) != literal {
                continue;
            }
            if !is_shared && !std::mem::replace(&mut self.judge.tried[node as usize], true) {
                if let Some(same) = self.graph.again(node) {
                    self.graph.merge(literal, same);
                } else if in_vain < MOST_IN_VAIN {
                    in_vain += u32::from(!self.finds_equal(literal));
                }
            }
            if self.graph.find(literal) == literal && !std::mem::replace(&mut self.judge.listed[node as usize], true) {
                let class = self.class(literal).0;
                self.judge.classes.entry(class).or_default().push(node);
            }
        }
    }

    /// Looks for an earlier node with the same samples that is equal; FALSE where there were some, but none is.
    fn finds_equal(&mut self, literal: Literal) -> bool {
        let (class, inverted) = self.class(literal);
        let alike = self.judge.classes.get(&class).cloned().unwrap_or_default();
        let mut tried = 0;
        for other in alike {
            let other = Literal::of(other);
            let other = other.turned(self.class(other).1 != inverted);
            if other.node() == literal.node() || self.told_apart(literal, other).is_some() {
                continue;
            }
            if !self.try_all(literal, other) {
                self.ask(literal, other, LITTLE);
            }
            tried += 1;
            if self.graph.find(literal) == self.graph.find(other) {
                return true;
            }
            if tried == MOST_TRIED {
                break;
            }
        }
        tried == 0
    }

    /// The nodes that a literal is made of.
    fn cone(&mut self, literal: Literal) -> BTreeSet<u32> {
        self.judge.tried.resize(self.graph.len(), false);
        self.judge.listed.resize(self.graph.len(), false);
        // FALSE is a node that others may be.
        let mut found = BTreeSet::from([0]);
        let mut waiting = vec![self.graph.find(literal).node()];
        while let Some(node) = waiting.pop() {
            if found.len() == MOST_SWEPT || !found.insert(node) {
                continue;
            }
            if let Node::And(a, b) = self.graph.node(node) {
                waiting.extend([self.graph.find(a).node(), self.graph.find(b).node()]);
            }
        }
        found
    }

    /// A number that nodes with the same samples at first have in common, be they inverted or not, and whether it is.
    fn class(&self, literal: Literal) -> (u64, bool) {
        let inverted = self.graph.sample(0, literal) & 1 != 0;
        let hash = (0..super::space::COLUMNS).fold(0, |hash: u64, column| {
            let sample = self.graph.sample(column, literal.turned(inverted));
            (hash.rotate_left(5) ^ sample).wrapping_mul(0x9E37_79B9_7F4A_7C15)
        });
        (hash, inverted)
    }

    /// Whether two literals are equal for all values of a few nodes that they are made of. Those nodes may have any value
    /// then, also where they cannot: so that it is TRUE is a proof, and FALSE says nothing.
    fn try_all(&mut self, a: Literal, b: Literal) -> bool {
        let (a, b) = (self.graph.find(a), self.graph.find(b));
        let mut leaves: BTreeSet<u32> = [a.node(), b.node()].into_iter().filter(|node| *node != 0).collect();
        let mut inner = Vec::new();
        let is_and = |graph: &Graph, node: u32| matches!(graph.node(node), Node::And(..));
        while inner.len() < MOST_INNER && leaves.len() <= MOST_ON_THE_WAY {
            // The last one: what it is made of comes before, so that none is taken apart twice.
            let last = leaves.iter().rev().copied().find(|node| is_and(&self.graph, *node));
            let worth = leaves.len() <= 6 || last.is_none() || inner.len().is_power_of_two();
            if worth && leaves.len() <= MOST_LEAVES && self.equal_for_all(&leaves, &inner, a, b) {
                self.proved(a, b, Method::Exhaustion);
                return true;
            }
            let Some(last) = last else { return false };
            let Node::And(x, y) = self.graph.node(last) else { return false };
            leaves.remove(&last);
            inner.push(last);
            leaves.extend([x, y].map(|part| self.graph.find(part).node()).into_iter().filter(|node| *node != 0));
        }
        false
    }

    /// Whether two literals are equal for all values of the leaves; the nodes between come the last first.
    fn equal_for_all(&mut self, leaves: &BTreeSet<u32>, inner: &[u32], a: Literal, b: Literal) -> bool {
        /// The values of a leaf in 64 rows of the table.
        const PERIODS: [u64; 6] = [
            0xAAAA_AAAA_AAAA_AAAA,
            0xCCCC_CCCC_CCCC_CCCC,
            0xF0F0_F0F0_F0F0_F0F0,
            0xFF00_FF00_FF00_FF00,
            0xFFFF_0000_FFFF_0000,
            0xFFFF_FFFF_0000_0000,
        ];
        let (graph, places) = (&self.graph, &mut self.judge.places);
        places.resize(graph.len(), 0);
        // Row 0 is FALSE.
        for (place, node) in (1..).zip(leaves.iter().chain(inner.iter().rev())) {
            places[*node as usize] = place;
        }
        let step = |literal: Literal| (places[literal.node() as usize] as usize, literal.inverted());
        let steps: Vec<[(usize, bool); 2]> = inner
            .iter()
            .rev()
            .filter_map(|node| match graph.node(*node) {
                Node::And(x, y) => Some([step(graph.find(x)), step(graph.find(y))]),
                Node::False | Node::Variable(_) => None,
            })
            .collect();
        let (a, b) = (step(a), step(b));
        let mut values = vec![0u64; 1 + leaves.len() + inner.len()];
        let of = |values: &[u64], (place, inverted): (usize, bool)| values[place] ^ if inverted { u64::MAX } else { 0 };
        (0..1usize << leaves.len().saturating_sub(6)).all(|block| {
            for leaf in 0..leaves.len() {
                values[1 + leaf] = match PERIODS.get(leaf) {
                    Some(period) => *period,
                    None if block >> (leaf - 6) & 1 != 0 => u64::MAX,
                    None => 0,
                };
            }
            for (place, [x, y]) in steps.iter().enumerate() {
                values[1 + leaves.len() + place] = of(&values, *x) & of(&values, *y);
            }
            of(&values, a) == of(&values, b)
        })
    }
}
