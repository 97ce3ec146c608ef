//! Boolean algebra: the trees of AND, OR and NOT of a section, seen as ANDs of literals that may be inverted, are made
//! smaller and written in the polarity that costs least.
//!
//! By De Morgan every such tree is one of ANDs: `a OR b` is `NOT (NOT a AND NOT b)`. In this view an AND and the OR that it
//! is the inverse of are one node, what is equal is one node, absorption and common factors are a look at sets of literals
//! (`graph`), and where inversions are put is a choice that is made last (`emit`).
//!
//! What a tree consists of must have been computed before its root, so a tree never reaches beyond its section: what
//! other sections made is a leaf.

mod emit;
mod graph;

use super::rewrite::rewrite_raw;
use crate::elementary::Elementary;
use crate::logic::{Binary, Instruction, Op, Program, Unary, ValueId};
use graph::{Graph, Literal};

/// How deep ANDs may stand below inverted ANDs; what is deeper is computed for itself.
const DEPTH: u32 = 32;

/// See the module.
pub(super) fn algebra(program: Program) -> Program {
    let uses = Uses::of(&program);
    let mut trees = Trees::default();
    rewrite_raw(program, |output, place| {
        if place.index == place.start {
            trees.read(output.old(), place.start..place.end, &uses);
        }
        match trees.literals[place.index - place.start] {
            None => output.mapped(place.index).and_then(|instruction| output.keep(instruction)),
            Some(root) if root.is_root => Some(trees.graph.root(output, root.literal)),
            Some(_) => None,
        }
    })
}

/// What becomes of each value of the program.
struct Uses {
    counts: Vec<u32>,
    /// Whether the value itself is wanted, and not only as part of a tree of its section.
    outside: Vec<bool>,
}

impl Uses {
    fn of(program: &Program) -> Self {
        let count = program.instructions.len();
        let mut uses = Self { counts: vec![0; count], outside: vec![false; count] };
        for section in 0..program.sections.len() {
            let range = program.section_range(section);
            for instruction in &program.instructions[range.clone()] {
                let within = joins(instruction);
                for operand in instruction.op.operands() {
                    uses.counts[operand.index()] += 1;
                    uses.outside[operand.index()] |= !within || operand.index() < range.start;
                }
            }
        }
        uses
    }
}

/// Whether an instruction is part of trees: an AND, OR or NOT of BOOLs.
fn joins(instruction: &Instruction) -> bool {
    let op = matches!(instruction.op, Op::Binary(Binary::And | Binary::Or, ..) | Op::Unary(Unary::Not, _));
    op && instruction.ty == Elementary::Bool
}

/// The trees of one section.
#[derive(Default)]
struct Trees {
    /// The section's first instruction.
    start: usize,
    graph: Graph,
    /// By instruction of the section: what it is, if it is part of trees.
    literals: Vec<Option<Part>>,
}

/// What an AND, OR or NOT is.
#[derive(Clone, Copy)]
struct Part {
    literal: Literal,
    /// Whether its node is nobody else's.
    alone: bool,
    /// Whether its value is wanted.
    is_root: bool,
}

impl Trees {
    fn read(&mut self, old: &[Instruction], section: std::ops::Range<usize>, uses: &Uses) {
        self.start = section.start;
        self.graph.clear();
        self.literals.clear();
        for index in section {
            let instruction = old[index];
            let part = joins(&instruction).then(|| match instruction.op {
                Op::Unary(_, a) => {
                    let a = self.operand(old, a, uses);
                    (a.literal.inverse(), a.alone)
                }
                Op::Binary(op, a, b) => {
                    let of_or = op == Binary::Or;
                    let operands = [a, b].map(|operand| {
                        let part = self.operand(old, operand, uses);
                        (if of_or { part.literal.inverse() } else { part.literal }, part.alone)
                    });
                    let literal = self.graph.join(operands);
                    (if of_or { literal.inverse() } else { literal }, true)
                }
                _ => unreachable!("only these are parts of trees"),
            });
            self.literals.push(part.map(|(literal, alone)| Part { literal, alone, is_root: uses.outside[index] }));
        }
    }

    /// An operand as a literal.
    fn operand(&mut self, old: &[Instruction], value: ValueId, uses: &Uses) -> Part {
        if let Op::Constant(bits) = old[value.index()].op {
            return Part { literal: self.graph.constant(bits != 0), alone: false, is_root: false };
        }
        let known = value.index().checked_sub(self.start).and_then(|place| self.literals[place].as_mut());
        match known {
            Some(part) if self.graph.depth(part.literal) >= DEPTH => part.is_root = true,
            Some(part) => {
                let alone = part.alone && uses.counts[value.index()] == 1 && !part.is_root;
                if !alone {
                    self.graph.share(part.literal);
                }
                return Part { alone, ..*part };
            }
            None => {}
        }
        Part { literal: self.graph.leaf(value), alone: false, is_root: false }
    }
}
