//! The view of trees as ANDs of literals, and what makes them smaller.

use std::collections::HashSet;

use rustc_hash::FxHashMap;

use crate::logic::ValueId;

/// A node, as it is or inverted.
#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Debug)]
pub(super) struct Literal {
    pub(super) node: u32,
    pub(super) inverted: bool,
}

impl Literal {
    pub(super) fn inverse(self) -> Self {
        Self { inverted: !self.inverted, ..self }
    }

    /// The same, inverted if `inverted`.
    fn turned(self, inverted: bool) -> Self {
        Self { inverted: self.inverted != inverted, ..self }
    }
}

/// TRUE, an AND of nothing. Always the first node.
const TRUE: Literal = Literal { node: 0, inverted: false };

/// Literals beside each other, and ANDs among them, up to which they are compared with each other.
const COMPARED: usize = 16;

#[derive(Clone, Debug)]
pub(super) enum Node {
    /// A value of the old program that no tree takes apart.
    Leaf(ValueId),
    /// Whether all of some literals hold.
    And(Vec<Literal>),
}

/// The nodes of one section.
#[derive(Debug, Default)]
pub(super) struct Graph {
    pub(super) nodes: Vec<Node>,
    /// By node: how deep it is, 0 for a leaf.
    depths: Vec<u32>,
    /// By node: whether it has several users, so that it is not taken apart.
    shared: Vec<bool>,
    /// By node: what it is made simpler, once it was.
    simple: Vec<Option<Literal>>,
    leaves: FxHashMap<ValueId, u32>,
    /// The simple ANDs, by their literals in order.
    interned: FxHashMap<Vec<Literal>, u32>,
    /// By node: what it came out as, once it did.
    pub(super) emitted: Vec<Option<super::emit::Emitted>>,
}

impl Graph {
    /// Forgets all.
    pub(super) fn clear(&mut self) {
        self.nodes.clear();
        self.depths.clear();
        self.shared.clear();
        self.simple.clear();
        self.leaves.clear();
        self.interned.clear();
        self.emitted.clear();
        self.add(Node::And(Vec::new()), 0);
        self.simple[0] = Some(TRUE);
    }

    fn add(&mut self, node: Node, depth: u32) -> u32 {
        let place = u32::try_from(self.nodes.len()).unwrap_or(u32::MAX);
        self.nodes.push(node);
        self.depths.push(depth);
        self.shared.push(false);
        self.simple.push(None);
        self.emitted.push(None);
        place
    }

    pub(super) fn constant(&self, value: bool) -> Literal {
        TRUE.turned(!value)
    }

    pub(super) fn leaf(&mut self, value: ValueId) -> Literal {
        let node = match self.leaves.get(&value) {
            Some(node) => *node,
            None => {
                let node = self.add(Node::Leaf(value), 0);
                self.leaves.insert(value, node);
                node
            }
        };
        Literal { node, inverted: false }
    }

    pub(super) fn depth(&self, literal: Literal) -> u32 {
        self.depths[literal.node as usize]
    }

    /// Notes that a node has several users.
    pub(super) fn share(&mut self, literal: Literal) {
        self.shared[literal.node as usize] = true;
    }

    /// The AND of two literals, each with whether its node is nobody else's and so can become part of the new one.
    pub(super) fn join(&mut self, operands: [(Literal, bool); 2]) -> Literal {
        let (mut literals, mut depth) = (Vec::new(), 1);
        for (literal, alone) in operands {
            let below = self.depth(literal);
            match &mut self.nodes[literal.node as usize] {
                Node::And(parts) if alone && !literal.inverted => {
                    depth = depth.max(below);
                    if literals.is_empty() {
                        literals = std::mem::take(parts);
                    } else {
                        literals.append(parts);
                    }
                }
                Node::And(_) | Node::Leaf(_) => {
                    depth = depth.max(below + 1);
                    literals.push(literal);
                }
            }
        }
        Literal { node: self.add(Node::And(literals), depth), inverted: false }
    }

    /// What a literal is made simpler. Its node must be no part of another that it was joined into.
    pub(super) fn simplify(&mut self, literal: Literal) -> Literal {
        let place = literal.node as usize;
        if let Some(simple) = self.simple[place] {
            return simple.turned(literal.inverted);
        }
        let simple = match &mut self.nodes[place] {
            Node::Leaf(_) => Literal { node: literal.node, inverted: false },
            Node::And(parts) => {
                let parts = std::mem::take(parts);
                let parts = parts.into_iter().map(|part| self.simplify(part)).collect();
                let simple = self.and(parts);
                if self.shared[place] {
                    self.share(simple);
                }
                simple
            }
        };
        self.simple[place] = Some(simple);
        simple.turned(literal.inverted)
    }

    /// The parts of a literal that is an AND which may be taken apart.
    fn parts(&self, literal: Literal) -> Option<&[Literal]> {
        match &self.nodes[literal.node as usize] {
            Node::And(parts) if !self.shared[literal.node as usize] => Some(parts),
            Node::And(_) | Node::Leaf(_) => None,
        }
    }

    /// The AND of simple literals.
    fn and(&mut self, literals: Vec<Literal>) -> Literal {
        let mut all = Vec::with_capacity(literals.len());
        for literal in literals {
            match self.parts(literal) {
                Some(parts) if !literal.inverted => all.extend_from_slice(parts),
                _ => all.push(literal),
            }
        }
        loop {
            if all.len() > COMPARED {
                let mut seen = HashSet::with_capacity(all.len());
                all.retain(|literal| *literal != TRUE && seen.insert(*literal));
                if all.iter().any(|literal| *literal == TRUE.inverse() || seen.contains(&literal.inverse())) {
                    return TRUE.inverse();
                }
                break;
            }
            let mut kept: Vec<Literal> = Vec::with_capacity(all.len());
            for literal in all {
                if literal == TRUE.inverse() || kept.contains(&literal.inverse()) {
                    return TRUE.inverse();
                }
                if literal != TRUE && !kept.contains(&literal) {
                    kept.push(literal);
                }
            }
            all = kept;
            match self.absorbed(&all).or_else(|| self.factored(&all)) {
                Some(smaller) => all = smaller,
                None => break,
            }
        }
        self.intern(all)
    }

    fn intern(&mut self, all: Vec<Literal>) -> Literal {
        match all[..] {
            [] => return TRUE,
            [only] => return only,
            _ => {}
        }
        let mut key = all.clone();
        key.sort_unstable();
        if let Some(node) = self.interned.get(&key) {
            return Literal { node: *node, inverted: false };
        }
        let depth = all.iter().map(|literal| self.depth(*literal)).max().unwrap_or(0) + 1;
        let node = self.add(Node::And(all), depth);
        let literal = Literal { node, inverted: false };
        self.simple[node as usize] = Some(literal);
        self.interned.insert(key, node);
        literal
    }

    /// Literals of one AND without what the others say already: `a AND (a OR b)` is `a`, `a AND NOT (a AND b)` is
    /// `a AND NOT b`, and `NOT (a AND b) AND NOT (a AND b AND c)` is its first half. `None` where nothing is too much.
    fn absorbed(&mut self, all: &[Literal]) -> Option<Vec<Literal>> {
        for (place, literal) in all.iter().enumerate().filter(|(_, literal)| literal.inverted) {
            let Some(parts) = self.parts(*literal).filter(|parts| (1..=COMPARED).contains(&parts.len())) else {
                continue;
            };
            let without = |with: Option<Literal>| {
                let others = all.iter().enumerate().filter(|(other, _)| *other != place).map(|(_, literal)| *literal);
                Some(others.chain(with).collect())
            };
            if parts.iter().any(|part| all.contains(&part.inverse())) {
                return without(None);
            }
            let rest: Vec<Literal> = parts.iter().copied().filter(|part| !all.contains(part)).collect();
            if rest.len() < parts.len() {
                let rest = self.and(rest).inverse();
                return without(Some(rest));
            }
            let includes = |other: &Literal| {
                let smaller = self.parts(*other).filter(|smaller| smaller.len() < parts.len());
                other.inverted && smaller.is_some_and(|smaller| smaller.iter().all(|part| parts.contains(part)))
            };
            if all.iter().any(includes) {
                return without(None);
            }
        }
        None
    }

    /// `NOT (a AND b) AND NOT (a AND c)` as `NOT (a AND (b OR c))`, by the literal that most have in common.
    fn factored(&mut self, all: &[Literal]) -> Option<Vec<Literal>> {
        let mut counts: Vec<(Literal, usize)> = Vec::new();
        for literal in all.iter().filter(|literal| literal.inverted) {
            for part in self.parts(*literal).into_iter().flatten() {
                match counts.iter().position(|(counted, _)| counted == part) {
                    Some(place) => counts[place].1 += 1,
                    None if counts.len() < COMPARED => counts.push((*part, 1)),
                    None => {}
                }
            }
        }
        let most = counts.iter().map(|(_, count)| *count).max().filter(|most| *most > 1)?;
        let (factor, _) = *counts.iter().find(|(_, count)| *count == most)?;
        let (mut others, mut rests) = (Vec::new(), Vec::new());
        for literal in all {
            match self.parts(*literal) {
                Some(parts) if literal.inverted && parts.contains(&factor) => {
                    rests.push(parts.iter().copied().filter(|part| *part != factor).collect());
                }
                _ => others.push(*literal),
            }
        }
        let rests = rests.into_iter().map(|rest| self.and(rest).inverse()).collect();
        let none_of_the_rests = self.and(rests);
        let product = self.and(vec![factor, none_of_the_rests.inverse()]);
        others.push(product.inverse());
        Some(others)
    }
}
