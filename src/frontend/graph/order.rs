//! What runs when: elements that take power or values run in one order, and each first pulls what it needs.
//!
//! Elements with an `executionOrderId` above 0 come first, by it; then coils, variables that are written, jumps and blocks
//! that nothing reads, by their places: from top to bottom in steps of ten units, from left to right; of those at one place (some
//! tools write none) by their numbers. A block that is reached again while it is pulled is read as it was left by the scan before.

use super::diagram::{Block, Diagram, ItemKind, Source};
use super::report::Report;
use crate::diagnostic::{Code, Diagnostic};

/// The elements in order of execution.
pub(in crate::frontend) struct Order {
    /// Their places among the items, each once.
    pub(in crate::frontend) items: Vec<usize>,
    /// For each item its place in `items`, if it runs.
    pub(in crate::frontend) step: Vec<Option<usize>>,
}

/// What an element pulls, in order.
pub(super) fn sources(kind: &ItemKind) -> impl Iterator<Item = Source> {
    let (inputs, block): (&[Source], Option<&Block>) = match kind {
        ItemKind::Contact { inputs, .. } | ItemKind::Jump { inputs, .. } => (inputs, None),
        ItemKind::Coil(coil) => (&coil.inputs, None),
        ItemKind::Block(block) => (&[], Some(block)),
        _ => (&[], None),
    };
    let of_pins = block.into_iter().flat_map(|block| {
        // What stands on the left of the box first: EN.
        let enable = block.input("EN");
        let pins = enable.into_iter().chain((0..block.inputs.len()).filter(move |pin| Some(*pin) != enable));
        pins.flat_map(|pin| block.inputs[pin].sources.iter().copied())
    });
    inputs.iter().copied().chain(of_pins)
}

/// The order of a body.
pub(in crate::frontend) fn order(diagram: &Diagram, report: &mut Report) -> Order {
    let mut read = vec![false; diagram.items.len()];
    for item in &diagram.items {
        for source in sources(&item.kind) {
            if let Some(item) = source.item() {
                read[item] = true;
            }
        }
    }
    let mut roots: Vec<(Key, usize)> = Vec::new();
    for (place, item) in diagram.items.iter().enumerate() {
        let (ordered, consumes) = match &item.kind {
            ItemKind::Coil(coil) => (coil.variable, !(coil.inputs.is_empty() && coil.value.is_some())),
            ItemKind::Jump { .. } => (true, true),
            ItemKind::Block(_) => (true, !read[place]),
            _ => (false, false),
        };
        if ordered && item.order > 0 {
            roots.push((Key::Given(item.order), place));
        } else if consumes {
            roots.push((Key::Placed(item.y.div_euclid(10), item.x, item.id), place));
        }
    }
    // Last what nothing needs: contacts that lead nowhere, blocks that only feed each other.
    for (place, item) in diagram.items.iter().enumerate() {
        if matches!(item.kind, ItemKind::Contact { .. } | ItemKind::Block(_)) {
            roots.push((Key::Left(read[place], item.y.div_euclid(10), item.x, item.id), place));
        }
    }
    roots.sort_unstable();
    let count = diagram.items.len();
    let mut walk = Walk {
        diagram,
        report,
        state: vec![State::New; count],
        items: Vec::new(),
        tried: vec![false; count],
        ahead: 0,
    };
    for (_, root) in roots {
        walk.pull(root);
    }
    let mut step = vec![None; count];
    for (place, item) in walk.items.iter().enumerate() {
        step[*item] = Some(place);
    }
    Order { items: walk.items, step }
}

#[derive(PartialEq, Eq, PartialOrd, Ord)]
enum Key {
    Given(u64),
    Placed(i64, i64, u64),
    /// First what nothing reads, so that a chain comes from its end.
    Left(bool, i64, i64, u64),
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum State {
    New,
    Open,
    Done,
}

struct Walk<'d, 'r> {
    diagram: &'d Diagram,
    report: &'r mut Report,
    state: Vec<State>,
    items: Vec<usize>,
    /// Blocks that were pulled ahead because they close a circle.
    tried: Vec<bool>,
    /// How many they are.
    ahead: usize,
}

/// How many blocks may be pulled ahead; each time the elements around it start again.
const MOST_AHEAD: usize = 1000;

impl Walk<'_, '_> {
    fn is_block(&self, item: usize) -> bool {
        matches!(self.diagram.items[item].kind, ItemKind::Block(_))
    }

    /// Runs an element after what it needs. The stack is a list, for wires may be long.
    fn pull(&mut self, root: usize) {
        // Blocks on circles are pulled first; each can be put before the others once.
        let mut wanted = vec![root];
        while let Some(next) = wanted.last().copied() {
            match self.pull_one(next) {
                None => {
                    wanted.pop();
                }
                Some(first) => wanted.push(first),
            }
        }
    }

    /// As [`Walk::pull`]; the result is a block that has to run first, and then nothing was opened.
    fn pull_one(&mut self, root: usize) -> Option<usize> {
        if self.state[root] != State::New {
            return None;
        }
        let mut stack: Vec<(usize, Vec<usize>)> = Vec::new();
        self.open(root, &mut stack);
        while let Some((item, rest)) = stack.last_mut() {
            let item = *item;
            let Some(next) = rest.pop() else {
                self.state[item] = State::Done;
                self.items.push(item);
                stack.pop();
                continue;
            };
            match self.state[next] {
                State::Done => {}
                State::New => self.open(next, &mut stack),
                // Feedback: what a block gave in the scan before.
                State::Open if self.is_block(next) => {}
                State::Open => {
                    let from = stack.iter().position(|(open, _)| *open == next).unwrap_or(0);
                    let circle: Vec<usize> = stack[from..].iter().map(|(open, _)| *open).collect();
                    let block = circle.iter().copied().find(|item| self.is_block(*item));
                    match block {
                        Some(block) if !self.tried[block] && self.ahead < MOST_AHEAD => {
                            self.ahead += 1;
                            self.tried[block] = true;
                            for (open, _) in stack {
                                self.state[open] = State::New;
                            }
                            return Some(block);
                        }
                        // Its contact has no value of the scan before.
                        _ => self.circle(&circle),
                    }
                }
            }
        }
        None
    }

    fn open(&mut self, item: usize, stack: &mut Vec<(usize, Vec<usize>)>) {
        self.state[item] = State::Open;
        let mut needs: Vec<usize> = sources(&self.diagram.items[item].kind).filter_map(Source::item).collect();
        needs.reverse();
        stack.push((item, needs));
    }

    fn circle(&mut self, circle: &[usize]) {
        let Some(first) = circle.first() else { return };
        let mut ids: Vec<String> = circle.iter().take(8).map(|item| self.diagram.items[*item].id.to_string()).collect();
        if circle.len() > ids.len() {
            ids.push("…".to_owned());
        }
        let message = format!(
            "power runs in a circle through the elements with the {}s {}",
            self.diagram.id_name,
            ids.join(", ")
        );
        let problem = Diagnostic::new(Code::PowerCycle, self.diagram.items[*first].span, message);
        self.report.push(problem.hint("only through a block can power come back, with its value of the scan before"));
    }
}
