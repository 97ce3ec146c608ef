//! Whether two literals can differ, asked of a SAT solver.
//!
//! A solver of its own for each question, which knows no more of the graph than the two are made of: so the memory is
//! bounded, and a question costs what it is worth. This is the only place that knows the solver.

use std::cell::Cell;
use std::collections::{BTreeSet, HashMap};

use batsat::{Callbacks, ClauseKind, Lit, Solver, SolverInterface, SolverOpts, lbool};

use super::graph::{Graph, Literal, Node};

/// What is spent on a question at most.
#[derive(Clone, Copy, Debug)]
pub(super) struct Effort {
    /// Nodes that are told to the solver; those below them can have any value.
    pub(super) nodes: usize,
    /// Conflicts after which it gives up.
    pub(super) conflicts: u64,
    /// Work after which it gives up: conflicts times nodes. A million takes some ten milliseconds.
    pub(super) work: u64,
}

/// What came of it.
#[derive(Debug)]
pub(super) enum Answer {
    /// They are equal, whatever the variables are.
    Equal,
    /// They differ where the variables have these values, those that are results of functions included.
    Differ(HashMap<u32, bool>),
    /// Not found out.
    Unknown,
}

/// Decisions for each conflict that may be spent.
const DECISIONS: u64 = 100;

/// Ends the search when all is spent; it counts itself, so that no clock is needed.
struct Budget {
    conflicts: u64,
    decisions: Cell<u64>,
}

impl Callbacks for Budget {
    fn on_new_clause(&mut self, _: &[Lit], kind: ClauseKind) {
        self.conflicts = self.conflicts.saturating_sub(u64::from(kind == ClauseKind::Learnt));
    }

    /// Asked before each decision.
    fn stop(&self) -> bool {
        let left = self.decisions.get();
        self.decisions.set(left.saturating_sub(1));
        self.conflicts == 0 || left == 0
    }
}

/// Asks, and gives the work that it took.
pub(super) fn ask(graph: &Graph, a: Literal, b: Literal, effort: Effort) -> (Answer, u64) {
    let mut solver = Solver::new(SolverOpts::default(), Budget { conflicts: 0, decisions: Cell::new(0) });
    let mut cone = Cone { graph, variables: HashMap::new(), waiting: BTreeSet::new() };
    let [a, b] = [a, b].map(|literal| cone.literal(&mut solver, graph.find(literal)));
    let mut told = 0;
    // The last first: what two nodes have in common is told once.
    while let Some(node) = cone.waiting.pop_last() {
        let Node::And(x, y) = graph.node(node) else { continue };
        if told == effort.nodes {
            break;
        }
        told += 1;
        let [all, x, y] = [Literal::of(node), graph.find(x), graph.find(y)].map(|part| cone.literal(&mut solver, part));
        solver.add_clause_reuse(&mut vec![!all, x]);
        solver.add_clause_reuse(&mut vec![!all, y]);
        solver.add_clause_reuse(&mut vec![all, !x, !y]);
    }
    let is_whole = told < effort.nodes;
    solver.add_clause_reuse(&mut vec![a, b]);
    solver.add_clause_reuse(&mut vec![!a, !b]);
    let work = told as u64 + 1;
    let conflicts = effort.conflicts.min(effort.work / work);
    *solver.cb_mut() = Budget { conflicts, decisions: Cell::new(conflicts.saturating_mul(DECISIONS)) };
    let found = solver.solve_limited(&[]);
    // To tell it a node costs no less than a conflict does.
    let taken = work * (1 + conflicts - solver.cb().conflicts);
    if found == lbool::FALSE {
        return (Answer::Equal, taken);
    }
    if found != lbool::TRUE || !is_whole {
        return (Answer::Unknown, taken);
    }
    let values = cone.variables.iter().filter(|(node, _)| matches!(graph.node(**node), Node::Variable(_)));
    let values = values.map(|(node, literal)| (*node, solver.value_lit(*literal) == lbool::TRUE));
    (Answer::Differ(values.collect()), taken)
}

/// What was told of the graph.
struct Cone<'a> {
    graph: &'a Graph,
    /// By node: what it is to the solver.
    variables: HashMap<u32, Lit>,
    /// The nodes that the solver knows, but not what they are made of.
    waiting: BTreeSet<u32>,
}

impl Cone<'_> {
    fn literal(&mut self, solver: &mut Solver<Budget>, literal: Literal) -> Lit {
        let node = literal.node();
        let known = *self.variables.entry(node).or_insert_with(|| {
            let variable = Lit::new(solver.new_var_default(), true);
            match self.graph.node(node) {
                Node::False => {
                    solver.add_clause_reuse(&mut vec![!variable]);
                }
                Node::And(..) => {
                    self.waiting.insert(node);
                }
                Node::Variable(_) => {}
            }
            variable
        });
        known.apply_sign(!literal.inverted())
    }
}
