//! An and-inverter graph: every bit that a program computes is an AND of two others, each as it is or inverted.
//!
//! What is equal by construction is one node: operands are ordered, hashed, and looked at one level deep. What was proved
//! equal later is merged, and from then on stands for each other. Every node also has its values on some sample images,
//! 64 to a **column**; two nodes with other samples are not equal, and of the rest most are.
//!
//! The graph must know neither slots nor operations: of a variable it knows where it comes from only as a [`Source`].

use std::collections::HashMap;
use std::ops::Not;

use crate::logic::SlotId;

/// A node, as it is or inverted.
#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Debug)]
pub(super) struct Literal(u32);

impl Literal {
    pub(super) const FALSE: Self = Self(0);
    pub(super) const TRUE: Self = Self(1);

    /// A node as it is.
    pub(super) fn of(node: u32) -> Self {
        Self(node << 1)
    }

    pub(super) fn constant(value: bool) -> Self {
        Self(u32::from(value))
    }

    pub(super) fn node(self) -> u32 {
        self.0 >> 1
    }

    pub(super) fn inverted(self) -> bool {
        self.0 & 1 != 0
    }

    /// The same, inverted if `inverted`.
    pub(super) fn turned(self, inverted: bool) -> Self {
        Self(self.0 ^ u32::from(inverted))
    }

    /// FALSE or TRUE, if it is one of them.
    pub(super) fn as_constant(self) -> Option<bool> {
        (self.node() == 0).then_some(self.inverted())
    }
}

impl Not for Literal {
    type Output = Self;

    fn not(self) -> Self {
        self.turned(true)
    }
}

/// Where the value of a variable comes from.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Source {
    /// A bit of what a slot holds at first.
    Slot(SlotId, u8),
    /// A bit of the time.
    Now(u8),
    /// A bit of the result of a function that is not taken apart.
    Applied(u32, u8),
}

#[derive(Clone, Copy, Debug)]
pub(super) enum Node {
    /// FALSE, the first node and no other.
    False,
    Variable(Source),
    And(Literal, Literal),
}

/// The values of all nodes on 64 sample images.
pub(super) type Column = Vec<u64>;

/// Nodes up to which a graph grows; each takes some hundred bytes.
const MOST_NODES: usize = 1 << 21;

#[derive(Debug)]
pub(super) struct Graph {
    nodes: Vec<Node>,
    /// By node: a node before it that is equal, or itself.
    merged: Vec<Literal>,
    hashed: HashMap<(Literal, Literal), u32>,
    columns: Vec<Column>,
}

impl Graph {
    /// An empty one with so many columns.
    pub(super) fn new(columns: usize) -> Self {
        Self {
            nodes: vec![Node::False],
            merged: vec![Literal::FALSE],
            hashed: HashMap::new(),
            columns: vec![vec![0]; columns],
        }
    }

    pub(super) fn len(&self) -> usize {
        self.nodes.len()
    }

    /// Whether it has grown so large that no more should be made of it.
    pub(super) fn is_full(&self) -> bool {
        self.nodes.len() >= MOST_NODES
    }

    pub(super) fn node(&self, node: u32) -> Node {
        self.nodes[node as usize]
    }

    pub(super) fn columns(&self) -> &[Column] {
        &self.columns
    }

    /// Adds or replaces a column, which has a value for every node.
    pub(super) fn set_column(&mut self, place: usize, column: Column) {
        debug_assert_eq!(column.len(), self.nodes.len(), "a column has a value for every node");
        match self.columns.get_mut(place) {
            Some(old) => *old = column,
            None => self.columns.push(column),
        }
    }

    /// The value of a literal on the samples of a column.
    pub(super) fn sample(&self, column: usize, literal: Literal) -> u64 {
        value_in(&self.columns[column], literal)
    }

    /// A new variable, with its values in each column.
    pub(super) fn variable(&mut self, source: Source, samples: impl Fn(usize) -> u64) -> Literal {
        for (place, column) in self.columns.iter_mut().enumerate() {
            column.push(samples(place));
        }
        self.push(Node::Variable(source))
    }

    /// Adds a node, whose samples are there already.
    fn push(&mut self, node: Node) -> Literal {
        // Far fewer than 2^31: see `is_full`.
        let literal = Literal::of(u32::try_from(self.nodes.len()).unwrap_or(u32::MAX >> 1));
        self.nodes.push(node);
        self.merged.push(literal);
        literal
    }

    /// The first that is known to be equal.
    pub(super) fn find(&self, literal: Literal) -> Literal {
        let mut found = literal;
        loop {
            let next = self.merged[found.node() as usize];
            if next.node() == found.node() {
                return found;
            }
            found = next.turned(found.inverted());
        }
    }

    /// Takes two that are equal as one from now on.
    pub(super) fn merge(&mut self, a: Literal, b: Literal) {
        let (a, b) = (self.find(a), self.find(b));
        let (first, second) = if a.node() <= b.node() { (a, b) } else { (b, a) };
        if first.node() != second.node() {
            self.merged[second.node() as usize] = first.turned(second.inverted());
        }
    }

    /// The operands of an AND that is not inverted, as far as they are known now.
    fn parts(&self, literal: Literal) -> Option<[Literal; 2]> {
        match self.nodes[literal.node() as usize] {
            Node::And(a, b) => Some([self.find(a), self.find(b)]),
            Node::False | Node::Variable(_) => None,
        }
    }

    /// What an AND is without a new node, looking at its operands and one level below; else its ordered operands.
    fn reduced(&self, a: Literal, b: Literal) -> Result<Literal, (Literal, Literal)> {
        let (mut a, mut b) = (self.find(a), self.find(b));
        // Each turn puts an operand of an operand in its place, which is an earlier node.
        loop {
            if a > b {
                (a, b) = (b, a);
            }
            if a == Literal::FALSE || a == !b {
                return Ok(Literal::FALSE);
            }
            if a == Literal::TRUE || a == b {
                return Ok(b);
            }
            let Some((other, smaller)) = [(a, b), (b, a)].into_iter().find_map(|(one, other)| {
                let parts = self.parts(one)?;
                let within = |wanted: Literal| parts.contains(&wanted);
                match one.inverted() {
                    // (x AND y) AND x; (x AND y) AND NOT x.
                    false if within(other) => Some((one, one)),
                    false if within(!other) => Some((one, Literal::FALSE)),
                    false => None,
                    // NOT (x AND y) AND NOT x.
                    true if within(!other) => Some((other, other)),
                    // NOT (x AND y) AND x is NOT y AND x.
                    true if within(other) => Some((other, !if parts[0] == other { parts[1] } else { parts[0] })),
                    true => None,
                }
            }) else {
                return Err((a, b));
            };
            (a, b) = (other, smaller);
        }
    }

    /// The AND of two literals.
    pub(super) fn and(&mut self, a: Literal, b: Literal) -> Literal {
        let (a, b) = match self.reduced(a, b) {
            Ok(known) => return known,
            Err(operands) => operands,
        };
        if let Some(node) = self.hashed.get(&(a, b)) {
            return self.find(Literal::of(*node));
        }
        for column in &mut self.columns {
            let value = value_in(column, a) & value_in(column, b);
            column.push(value);
        }
        let literal = self.push(Node::And(a, b));
        self.hashed.insert((a, b), literal.node());
        literal
    }

    /// What a node is by what is known now of its operands, if that is an earlier node.
    pub(super) fn again(&self, node: u32) -> Option<Literal> {
        let Node::And(a, b) = self.nodes[node as usize] else { return None };
        let found = match self.reduced(a, b) {
            Ok(known) => known,
            Err(operands) => self.find(Literal::of(*self.hashed.get(&operands)?)),
        };
        (found.node() < node).then_some(found)
    }

    pub(super) fn or(&mut self, a: Literal, b: Literal) -> Literal {
        !self.and(!a, !b)
    }

    pub(super) fn xor(&mut self, a: Literal, b: Literal) -> Literal {
        let (a, b) = (self.find(a), self.find(b));
        // Inversions of operands are one of the result.
        let inverted = a.inverted() != b.inverted();
        let (a, b) = (a.turned(a.inverted()), b.turned(b.inverted()));
        let (both, neither) = (self.and(a, b), self.and(!a, !b));
        self.and(!both, !neither).turned(inverted)
    }

    /// `a` while the condition holds, else `b`.
    pub(super) fn select(&mut self, condition: Literal, a: Literal, b: Literal) -> Literal {
        let (a, b) = (self.find(a), self.find(b));
        if a == b {
            return a;
        }
        let (taken, left) = (self.and(condition, a), self.and(!condition, b));
        self.or(taken, left)
    }
}

/// The value of a literal in a column, made as far as its node.
pub(super) fn value_in(column: &[u64], literal: Literal) -> u64 {
    column[literal.node() as usize] ^ if literal.inverted() { u64::MAX } else { 0 }
}
