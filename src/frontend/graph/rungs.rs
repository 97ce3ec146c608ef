//! Which elements of a body make a rung, and what the rung is called.
//!
//! Elements that share wires are one rung; rails do not join, nor do variables. Rungs come in the order in which their first
//! elements run. Where two would have to take turns, and one writes what the other touches, they are one rung.

use std::collections::{BTreeMap, HashMap};

use super::diagram::{Diagram, Item, ItemKind, Source};
use super::network::{self, Vertex};
use super::order::{self, Order, sources};
use super::pins;
use super::report::Report;
use super::types::{Scope, Signatures};
use super::vertices::{Builder, value_of};
use crate::ladder::{Circuit, Comment, Expression, ExpressionKind, Name, Reference, Root, Rung, Step, Unit, Variable};
use crate::source::Span;

/// The longest comment that becomes the title of a rung, in characters.
const LONGEST_TITLE: usize = 100;

/// The rungs of a diagram that is the body of a unit, and the variables that wires in it need. Comments that become no titles
/// are added to `comments`, at the place of the body.
pub(in crate::frontend) fn rungs(
    mut diagram: Diagram,
    unit: &Unit,
    body: Span,
    signatures: &Signatures,
    comments: &mut Vec<Comment>,
    report: &mut Report,
) -> (Vec<Rung>, Vec<Variable>) {
    pins::name(&mut diagram, signatures);
    let diagram = &diagram;
    let order = order::order(diagram, report);
    let scope = Scope::new(signatures, unit);
    let mut builder = Builder::new(diagram, &order, &scope, report);
    builder.build();
    let (vertices, hidden) = (builder.vertices, builder.hidden);
    let groups = groups(diagram, &order, &scope, &vertices);
    let mut rungs: Vec<Placed> = groups.iter().map(|members| Placed::new(diagram, &vertices, members)).collect();
    label(diagram, &mut rungs);
    title(diagram, &mut rungs, body, comments);
    (rungs.into_iter().map(|placed| placed.rung).collect(), hidden)
}

/// A rung and where it is drawn.
struct Placed {
    rung: Rung,
    top: i64,
    bottom: i64,
    left: i64,
}

impl Placed {
    fn new(diagram: &Diagram, vertices: &[Vertex], members: &[usize]) -> Self {
        let span = members.first().map_or(Span::default(), |first| vertices[*first].span);
        let circuit = network::circuit(vertices, members, span);
        let items = || members.iter().map(|member| &diagram.items[vertices[*member].item]);
        let top = items().map(|item| item.y).min().unwrap_or(0);
        let bottom = items().map(|item| item.y).max().unwrap_or(0);
        let left = items().map(|item| item.x).min().unwrap_or(0);
        Self { rung: Rung { name: None, title: None, enabled: true, circuit, span }, top, bottom, left }
    }

    /// Whether it and an element are drawn at one and the same place, as if there were no places.
    fn is_at(&self, item: &Item) -> bool {
        self.top == item.y && self.bottom == item.y && self.left == item.x
    }

    /// A rung with nothing but a name.
    fn empty(name: Name, y: i64) -> Self {
        let span = name.span;
        let branch = crate::ladder::Branch { from: None, elements: Vec::new(), to: None, span };
        let circuit = Circuit { branches: vec![branch], span };
        Self { rung: Rung { name: Some(name), title: None, enabled: true, circuit, span }, top: y, bottom: y, left: 0 }
    }
}

/// A label names the first rung that is not wholly above it. Where a tool writes no places, all have the same, and it names the
/// first rung behind it in the file.
fn label(diagram: &Diagram, rungs: &mut Vec<Placed>) {
    for item in &diagram.items {
        let ItemKind::Label(name) = &item.kind else { continue };
        let is_named = |placed: &Placed| match placed.is_at(item) {
            true => placed.rung.span.start >= item.span.start,
            false => placed.bottom >= item.y,
        };
        let place = rungs.iter().position(is_named).unwrap_or(rungs.len());
        match rungs.get_mut(place) {
            Some(placed) if placed.rung.name.is_none() => placed.rung.name = Some(name.clone()),
            _ => rungs.insert(place, Placed::empty(name.clone(), item.y)),
        }
    }
}

/// A short comment is the title of the rung that it stands beside or above; others are kept before the rungs.
fn title(diagram: &Diagram, rungs: &mut [Placed], body: Span, comments: &mut Vec<Comment>) {
    let near = Near::new(rungs);
    for item in &diagram.items {
        let ItemKind::Comment(text) = &item.kind else { continue };
        let line = text.split_whitespace().collect::<Vec<_>>().join(" ");
        if line.is_empty() {
            continue;
        }
        match near.find(rungs, item).and_then(|place| rungs.get_mut(place)) {
            Some(placed) if placed.rung.title.is_none() && line.chars().count() <= LONGEST_TITLE => {
                placed.rung.title = Some(line.into());
            }
            _ => comments.push(Comment { text: text.clone(), span: body, own_line: true }),
        }
    }
}

/// Finds the rung that is nearest to a place, without looking at all of them.
struct Near {
    /// The rungs by their tops.
    by_top: Vec<usize>,
    /// The lowest bottom of each and those before it.
    lowest: Vec<i64>,
}

impl Near {
    fn new(rungs: &[Placed]) -> Self {
        let mut by_top: Vec<usize> = (0..rungs.len()).collect();
        by_top.sort_by_key(|place| rungs[*place].top);
        let mut bottom = i64::MIN;
        let lowest = by_top.iter().map(|place| {
            bottom = bottom.max(rungs[*place].bottom);
            bottom
        });
        Self { lowest: lowest.collect(), by_top }
    }

    /// The nearest above or below; of those as near the one that is nearest to the right or left, and rather below than above; of
    /// those at one place the first behind it in the file.
    fn find(&self, rungs: &[Placed], item: &Item) -> Option<usize> {
        // Positions are any numbers that a file has; differences of these cannot overflow.
        let away = |place: usize| {
            let placed = &rungs[place];
            let up_or_down = (placed.top - item.y).max(item.y - placed.bottom).max(0);
            let before = match placed.is_at(item) {
                true => placed.rung.span.start < item.span.start,
                false => placed.bottom < item.y,
            };
            (up_or_down, (placed.left - item.x).abs(), before, place)
        };
        let mut best: Option<(i64, i64, bool, usize)> = None;
        let from = self.by_top.partition_point(|place| rungs[*place].top <= item.y);
        for at in (0..from).rev() {
            if best.is_some_and(|best| item.y - self.lowest[at] > best.0) {
                break;
            }
            let found = away(self.by_top[at]);
            best = Some(best.map_or(found, |best| best.min(found)));
        }
        for place in &self.by_top[from..] {
            let found = away(*place);
            if best.is_some_and(|best| found.0 > best.0) {
                break;
            }
            best = Some(best.map_or(found, |best| best.min(found)));
        }
        best.map(|best| best.3)
    }
}

/// The vertices of each rung, in order.
fn groups(diagram: &Diagram, order: &Order, scope: &Scope<'_>, vertices: &[Vertex]) -> Vec<Vec<usize>> {
    let mut sets = Sets::new(diagram.items.len());
    for item in &order.items {
        for source in sources(&diagram.items[*item].kind) {
            if let Some(other) = source.item() {
                sets.join(*item, other);
            }
        }
    }
    // Joining makes spans longer, so that others may come to overlap; a few rounds do for drawings.
    for _ in 0..8 {
        if !join_entangled(diagram, order, scope, vertices, &mut sets) {
            break;
        }
    }
    let mut groups: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    let mut first: HashMap<usize, usize> = HashMap::new();
    for (place, vertex) in vertices.iter().enumerate() {
        let first = *first.entry(sets.find(vertex.item)).or_insert(place);
        groups.entry(first).or_default().push(place);
    }
    groups.into_values().collect()
}

/// Joins rungs that would have to take turns and touch the same variable, which one of them writes.
fn join_entangled(diagram: &Diagram, order: &Order, scope: &Scope<'_>, vertices: &[Vertex], sets: &mut Sets) -> bool {
    let mut extents: HashMap<usize, (usize, usize)> = HashMap::new();
    for (place, vertex) in vertices.iter().enumerate() {
        extents.entry(sets.find(vertex.item)).or_insert((place, place)).1 = place;
    }
    let mut ordered: Vec<(usize, usize)> = extents.values().copied().collect();
    ordered.sort_unstable();
    if ordered.windows(2).all(|pair| pair[0].1 < pair[1].0) {
        return false;
    }
    let mut touched: BTreeMap<String, (bool, Vec<usize>)> = BTreeMap::new();
    for item in &order.items {
        let set = sets.find(*item);
        touches(diagram, scope, *item, &mut |name, written| {
            let (any_written, users) = touched.entry(name).or_default();
            *any_written |= written;
            if users.last() != Some(&set) {
                users.push(set);
            }
        });
    }
    let mut changed = false;
    for (_, users) in touched.into_values().filter(|(written, users)| *written && users.len() > 1) {
        let mut spans: Vec<(usize, usize, usize)> =
            users.iter().filter_map(|set| extents.get(set).map(|(first, last)| (*first, *last, *set))).collect();
        spans.sort_unstable();
        spans.dedup();
        let mut around: Option<(usize, usize)> = None;
        for (first, last, set) in spans {
            around = match around {
                Some((end, other)) if first < end => {
                    changed |= sets.join(other, set);
                    Some((end.max(last), set))
                }
                _ => Some((last, set)),
            };
        }
    }
    changed
}

/// What other rungs may reach by name: calls of units that may touch any global variable.
const GLOBALS: &str = "#globals";

/// The variables that an element reads and writes.
fn touches(diagram: &Diagram, scope: &Scope<'_>, item: usize, note: &mut dyn FnMut(String, bool)) {
    let kind = &diagram.items[item].kind;
    match kind {
        ItemKind::Contact { operand, .. } => reads(scope, operand, note),
        ItemKind::Coil(coil) => touch(scope, &coil.target, true, note),
        ItemKind::Block(block) => {
            if let Some(instance) = &block.instance {
                touch(scope, instance, true, note);
            }
            if !scope.signatures.is_standard(&block.type_name.text) {
                note(GLOBALS.to_owned(), true);
            }
            for pin in block.inputs.iter().filter(|pin| pin.in_out) {
                for source in &pin.sources {
                    if let Source::Value(value) = source
                        && let Some(Expression { kind: ExpressionKind::Read(reference), .. }) =
                            value_of(&diagram.items[*value].kind)
                    {
                        touch(scope, reference, true, note);
                    }
                }
            }
        }
        _ => {}
    }
    for source in sources(kind) {
        if let Source::Value(value) = source
            && let Some(value) = value_of(&diagram.items[value].kind)
        {
            reads(scope, value, note);
        }
    }
}

fn touch(scope: &Scope<'_>, reference: &Reference, written: bool, note: &mut dyn FnMut(String, bool)) {
    let storage = match &reference.root {
        Root::Name(name) => scope.storage(&name.text),
        Root::Address(address) => address.to_string(),
    };
    if storage.starts_with(['.', '%']) {
        note(GLOBALS.to_owned(), false);
    }
    note(storage, written);
    for step in &reference.steps {
        if let Step::Index(indices, _) = step {
            indices.iter().for_each(|index| reads(scope, index, note));
        }
    }
}

fn reads(scope: &Scope<'_>, value: &Expression, note: &mut dyn FnMut(String, bool)) {
    // Expressions nest no deeper than their reader lets them.
    match &value.kind {
        ExpressionKind::Read(reference) => touch(scope, reference, false, note),
        ExpressionKind::Unary(_, operand) => reads(scope, operand, note),
        ExpressionKind::Binary(_, left, right) => {
            reads(scope, left, note);
            reads(scope, right, note);
        }
        ExpressionKind::Call { arguments, .. } => {
            arguments.iter().for_each(|argument| reads(scope, &argument.value, note));
        }
        ExpressionKind::Literal(_) | ExpressionKind::Array(_) | ExpressionKind::Structure(_) => {}
    }
}

/// Sets of elements that come together.
struct Sets {
    parents: Vec<usize>,
}

impl Sets {
    fn new(count: usize) -> Self {
        Self { parents: (0..count).collect() }
    }

    fn find(&mut self, mut item: usize) -> usize {
        while self.parents[item] != item {
            self.parents[item] = self.parents[self.parents[item]];
            item = self.parents[item];
        }
        item
    }

    /// Whether they were apart.
    fn join(&mut self, one: usize, other: usize) -> bool {
        let (one, other) = (self.find(one), self.find(other));
        self.parents[one.max(other)] = one.min(other);
        one != other
    }
}
