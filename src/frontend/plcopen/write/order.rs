//! Whether the elements of a drawing run in the order of their rungs, by the order in which a drawing is read: the layout
//! says what runs when, so that what is written must be read again before it can be trusted.

use std::collections::{HashMap, HashSet};

use super::super::xml::Document;
use super::drawing::Drawing;
use super::xml::Xml;
use crate::frontend::graph::order;
use crate::frontend::graph::report::Report;
use crate::source::Source;

/// The longest stretch of a rung whose elements may run in another order.
const MOST_MOVED: usize = 500;

/// What an element touches, by the names of variables; `None` is what can be reached by several names.
#[derive(Default)]
pub(super) struct Touched {
    pub(super) reads: HashSet<Option<String>>,
    pub(super) writes: HashSet<Option<String>>,
    /// Whether what comes behind depends on it, whatever that is.
    pub(super) leaves: bool,
}

impl Touched {
    /// Whether the two can run in either order.
    fn is_apart(&self, other: &Self) -> bool {
        !self.leaves
            && !other.leaves
            && self.writes.is_disjoint(&other.reads)
            && self.writes.is_disjoint(&other.writes)
            && self.reads.is_disjoint(&other.writes)
    }
}

/// An element that runs.
pub(super) struct Step {
    pub(super) element: usize,
    pub(super) rung: usize,
    pub(super) touched: Touched,
}

/// Whether a drawing runs its elements in the order of these, or in one that is as good.
pub(super) fn is_kept(drawing: &Drawing, steps: &[Step]) -> bool {
    let mut xml = Xml::default();
    drawing.write(&mut xml);
    let source = Source::new("drawing", xml.finish());
    let Ok(document) = Document::read(source.text()) else { return false };
    let Some(root) = document.root() else { return false };
    let mut report = Report::default();
    let diagram = super::super::diagram::read(root, &mut report);
    let read = order::order(&diagram, &mut report);
    if !report.finish().is_empty() {
        return false;
    }
    let places: HashMap<u64, usize> =
        read.items.iter().enumerate().map(|(place, item)| (diagram.items[*item].id, place)).collect();
    let mut placed = Vec::with_capacity(steps.len());
    for step in steps {
        let Some(place) = places.get(&Drawing::local_id(step.element)) else { return false };
        placed.push(*place);
    }
    // The least place from each step on: where it is above all before, nothing moved across.
    let mut least = placed.clone();
    for at in (1..least.len()).rev() {
        least[at - 1] = least[at - 1].min(least[at]);
    }
    let (mut start, mut greatest) = (0, 0);
    for at in 0..steps.len() {
        greatest = greatest.max(placed[at]);
        if least.get(at + 1).is_none_or(|behind| *behind > greatest) {
            if at - start > MOST_MOVED || !stretch(steps, &placed, start, at + 1) {
                return false;
            }
            start = at + 1;
        }
    }
    true
}

/// Whether what changes places within a stretch may.
fn stretch(steps: &[Step], placed: &[usize], start: usize, end: usize) -> bool {
    for late in start..end {
        for early in start..late {
            if placed[early] > placed[late]
                && (steps[early].rung != steps[late].rung || !steps[early].touched.is_apart(&steps[late].touched))
            {
                return false;
            }
        }
    }
    true
}
