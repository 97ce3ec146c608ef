//! From vertices that feed each other to a circuit: series and parallel where the wires allow it, named nodes elsewhere.
//!
//! A vertex is something that stands in a branch. The power on its left is the OR of its feeds; those that are fed alike
//! share a point, and a vertex is an edge between two points. Edges in a row and side by side are drawn together until
//! nothing more fits; what is left becomes branches between nodes. That may move nothing across something with an effect:
//! where it would, every vertex stays a branch of its own, in order of execution.

use std::borrow::Cow;
use std::collections::BTreeMap;

// Keys are places that this module counts itself, never what a file says.
use rustc_hash::FxHashMap as HashMap;

use crate::ladder::{
    Argument, BlockCall, Branch, Circuit, CoilKind, ContactKind, Element, ElementKind, Expression, ExpressionKind,
    Literal, Name, Wire,
};
use crate::source::Span;

/// How many vertices are drawn together; more are branches of their own, for drawing is slow for thousands.
const MOST_DRAWN: usize = 600;
/// How deep circuits may nest in each other.
const MOST_NESTED: usize = 32;

/// Where power comes from.
#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Debug)]
pub(super) enum Feed {
    /// The left rail.
    Rail,
    /// The right side of a vertex, by its place.
    Vertex(usize),
}

/// Something that stands in a branch.
#[derive(Debug)]
pub(super) struct Vertex {
    /// What it is; the arguments in it are those without power.
    pub(super) kind: ElementKind,
    /// The power on its left is the OR of these; at least one.
    pub(super) feeds: Vec<Feed>,
    /// The pins of a call that take power.
    pub(super) pins: Vec<PowerPin>,
    /// The element of the diagram that it is for.
    pub(super) item: usize,
    pub(super) span: Span,
    /// How far down it is drawn.
    pub(super) y: i64,
}

/// A pin that takes power.
#[derive(Debug)]
pub(super) struct PowerPin {
    pub(super) name: Name,
    pub(super) feeds: Vec<Feed>,
    /// How many arguments stand before it.
    pub(super) place: usize,
}

impl Vertex {
    /// Whether it writes anything, so that nothing may move across it.
    fn has_effect(&self) -> bool {
        !matches!(self.kind, ElementKind::Contact { .. } | ElementKind::Condition(_))
    }
}

/// A point between edges.
#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Debug)]
enum Point {
    Rail,
    /// Behind a vertex.
    Behind(usize),
    /// Where the feeds of a set come together.
    Net(usize),
    /// Behind a vertex that feeds nothing.
    End,
}

/// Who takes power: a vertex on its left, or at one of its pins.
type User = (usize, Option<usize>);

/// Where a vertex stands: in the rung (0), or in the circuit of a pin.
type Region = usize;

/// What stands in a branch between two points.
enum Item {
    Vertex(usize),
    Parallel(Vec<Edge>),
}

struct Edge {
    from: Point,
    to: Point,
    items: Vec<Item>,
    /// The first and last vertex.
    first: usize,
    last: usize,
    depth: usize,
    y: i64,
    /// Nothing in it has an effect.
    pure: bool,
}

/// Makes the circuit of the vertices at these places, which are in order of execution and feed each other only.
pub(super) fn circuit(vertices: &[Vertex], members: &[usize], span: Span) -> Circuit {
    if members.len() <= MOST_DRAWN
        && let Some(circuit) = Plan::new(vertices, members, true).circuit(span)
    {
        return circuit;
    }
    let plain = Plan::new(vertices, members, false).circuit(span);
    plain.unwrap_or(Circuit { branches: Vec::new(), span })
}

struct Plan<'v> {
    vertices: &'v [Vertex],
    members: &'v [usize],
    /// Whether edges are drawn together.
    drawn: bool,
    /// The point of each set of feeds.
    points: HashMap<Cow<'v, [Feed]>, Point>,
    /// For each vertex its pins' regions.
    regions: HashMap<(usize, usize), Region>,
    edges: BTreeMap<Region, Vec<Edge>>,
    /// How many branches start at a point, and pins take its power.
    uses: HashMap<Point, usize>,
    names: HashMap<Point, usize>,
    /// The vertices in the order in which they were put into the circuit.
    emitted: Vec<usize>,
}

impl<'v> Plan<'v> {
    fn new(vertices: &'v [Vertex], members: &'v [usize], drawn: bool) -> Self {
        let mut plan = Self {
            vertices,
            members,
            drawn,
            points: HashMap::default(),
            regions: HashMap::default(),
            edges: BTreeMap::new(),
            uses: HashMap::default(),
            names: HashMap::default(),
            emitted: Vec::new(),
        };
        plan.lay();
        plan
    }

    /// Finds the points, and the region of every edge.
    fn lay(&mut self) {
        // Sets of feeds, each once, with those who take their power.
        let mut sets: Vec<(&'v [Feed], Vec<User>)> = Vec::new();
        let mut known: HashMap<Cow<'v, [Feed]>, usize> = HashMap::default();
        let mut note = |feeds: &'v [Feed], user: User| {
            let set = *known.entry(sorted(feeds)).or_insert_with(|| {
                sets.push((feeds, Vec::new()));
                sets.len() - 1
            });
            sets[set].1.push(user);
        };
        for member in self.members {
            let vertex = &self.vertices[*member];
            note(&vertex.feeds, (*member, None));
            for (pin, power) in vertex.pins.iter().enumerate() {
                note(&power.feeds, (*member, Some(pin)));
            }
        }
        let mut of_vertex: HashMap<usize, Vec<usize>> = HashMap::default();
        for (set, (feeds, _)) in sets.iter().enumerate() {
            for feed in *feeds {
                if let Feed::Vertex(vertex) = feed {
                    of_vertex.entry(*vertex).or_default().push(set);
                }
            }
        }
        for (set, (feeds, _)) in sets.iter().enumerate() {
            let point = match feeds {
                [Feed::Rail] => Point::Rail,
                [Feed::Vertex(vertex)] => Point::Behind(*vertex),
                _ => Point::Net(set),
            };
            self.points.insert(sorted(feeds), point);
        }
        // Regions, from the right to the left: a vertex stands where all that take its power do.
        let mut parents: Vec<Region> = vec![0];
        let mut region_of: HashMap<usize, Region> = HashMap::default();
        let mut owners: Vec<Option<Region>> = vec![None; sets.len()];
        for member in self.members.iter().rev() {
            let mut region: Option<Region> = None;
            for set in of_vertex.get(member).into_iter().flatten() {
                let owner = match owners[*set] {
                    Some(owner) => owner,
                    None => {
                        let mut owner: Option<Region> = None;
                        for (user, pin) in &sets[*set].1 {
                            let around = region_of.get(user).copied().unwrap_or(0);
                            let here = match pin {
                                Some(pin) if self.drawn => {
                                    parents.push(around);
                                    *self.regions.entry((*user, *pin)).or_insert(parents.len() - 1)
                                }
                                _ => around,
                            };
                            owner = Some(owner.map_or(here, |owner| common(&parents, owner, here)));
                        }
                        let owner = owner.unwrap_or(0);
                        owners[*set] = Some(owner);
                        owner
                    }
                };
                region = Some(region.map_or(owner, |region| common(&parents, region, owner)));
            }
            region_of.insert(*member, region.unwrap_or(0));
        }
        for member in self.members {
            let vertex = &self.vertices[*member];
            let to = match of_vertex.get(member).map(Vec::as_slice) {
                None => Point::End,
                Some([set]) if sets[*set].0.len() > 1 => Point::Net(*set),
                Some(_) => Point::Behind(*member),
            };
            let from = self.point(&vertex.feeds);
            let pure = !vertex.has_effect() && vertex.pins.is_empty();
            let items = vec![Item::Vertex(*member)];
            let edge = Edge { from, to, items, first: *member, last: *member, depth: 0, y: vertex.y, pure };
            *self.uses.entry(from).or_default() += 1;
            self.edges.entry(region_of.get(member).copied().unwrap_or(0)).or_default().push(edge);
        }
        // Wires from what has other uses too.
        for (set, (feeds, users)) in sets.iter().enumerate().filter(|(_, (feeds, _))| feeds.len() > 1) {
            let last =
                feeds.iter().filter_map(|feed| if let Feed::Vertex(vertex) = feed { Some(*vertex) } else { None });
            let last = last.max().unwrap_or(0);
            let first_user = users.iter().map(|(user, _)| *user).min().unwrap_or(0);
            for feed in *feeds {
                let from = match feed {
                    Feed::Rail => Point::Rail,
                    Feed::Vertex(vertex) if of_vertex.get(vertex).is_some_and(|sets| sets.len() > 1) => {
                        Point::Behind(*vertex)
                    }
                    Feed::Vertex(_) => continue,
                };
                let owner = owners[set].unwrap_or_else(|| region_of.get(&first_user).copied().unwrap_or(0));
                let y = if let Feed::Vertex(vertex) = feed { self.vertices[*vertex].y } else { i64::MIN };
                let edge =
                    Edge { from, to: Point::Net(set), items: Vec::new(), first: last, last, depth: 0, y, pure: true };
                *self.uses.entry(from).or_default() += 1;
                self.edges.entry(owner).or_default().push(edge);
            }
        }
        // Pins that take the power of a point outside of their own circuit.
        for member in self.members {
            for (pin, power) in self.vertices[*member].pins.iter().enumerate() {
                let set = known.get(&sorted(&power.feeds)).copied();
                let own = self.regions.get(&(*member, pin)).copied();
                let inside = own.is_some() && set.and_then(|set| owners[set]) == own;
                if !inside {
                    self.regions.remove(&(*member, pin));
                    *self.uses.entry(self.point(&power.feeds)).or_default() += 1;
                }
            }
        }
    }

    fn point(&self, feeds: &[Feed]) -> Point {
        self.points.get(&sorted(feeds)).copied().unwrap_or(Point::Rail)
    }

    /// The circuit; `None` where drawing would move something across an effect.
    fn circuit(mut self, span: Span) -> Option<Circuit> {
        let branches = self.region(0, None)?;
        if self.drawn && !self.in_order() {
            return None;
        }
        Some(Circuit { branches, span })
    }

    /// Whether what has an effect comes in its order, and everything else between the same effects.
    fn in_order(&self) -> bool {
        let ranks = |order: &[usize]| {
            let mut rank = 0;
            let mut ranks: HashMap<usize, usize> = HashMap::default();
            for vertex in order {
                ranks.insert(*vertex, rank);
                rank += usize::from(self.vertices[*vertex].has_effect());
            }
            ranks
        };
        self.emitted == self.members
            || self.emitted.len() == self.members.len() && ranks(&self.emitted) == ranks(self.members)
    }

    /// The branches of a region; those that end at `right` give the power of its circuit.
    fn region(&mut self, region: Region, right: Option<Point>) -> Option<Vec<Branch>> {
        let mut edges = self.edges.remove(&region).unwrap_or_default();
        if self.drawn {
            while self.side_by_side(&mut edges)? | self.in_row(&mut edges, right, false) {}
        } else {
            edges.sort_by_key(|edge| edge.first);
            while self.in_row(&mut edges, right, true) {}
        }
        self.branches(edges, right)
    }

    /// Draws edges between the same two points together.
    fn side_by_side(&mut self, edges: &mut Vec<Edge>) -> Option<bool> {
        let mut between: Vec<(Point, Point, usize)> =
            edges.iter().enumerate().map(|(place, edge)| (edge.from, edge.to, place)).collect();
        between.sort_unstable();
        let together =
            |one: &(Point, Point, usize), other: &(Point, Point, usize)| (one.0, one.1) == (other.0, other.1);
        let mut groups =
            between.chunk_by(together).filter(|group| group.len() > 1 && group[0].0 != Point::Rail).peekable();
        if groups.peek().is_none() {
            return Some(false);
        }
        let mut old: Vec<Option<Edge>> = std::mem::take(edges).into_iter().map(Some).collect();
        let mut merged = Vec::new();
        for group in groups {
            let (from, to, _) = group[0];
            let parts: Vec<Edge> = group.iter().filter_map(|(.., place)| old[*place].take()).collect();
            *self.uses.entry(from).or_default() -= parts.len() - 1;
            merged.push(parallel(from, to, parts)?);
        }
        edges.extend(old.into_iter().flatten());
        edges.append(&mut merged);
        Some(true)
    }

    /// Draws edges one behind the other that have a point for themselves; `adjacent`: only where nothing runs between them.
    fn in_row(&self, edges: &mut Vec<Edge>, right: Option<Point>, adjacent: bool) -> bool {
        let ends_of = |end: fn(&Edge) -> Point| {
            let mut ends: Vec<(Point, usize)> =
                edges.iter().enumerate().map(|(place, edge)| (end(edge), place)).collect();
            ends.sort_unstable();
            ends
        };
        let (entering, leaving) = (ends_of(|edge| edge.to), ends_of(|edge| edge.from));
        let mut order: Vec<(usize, &[(Point, usize)])> = Vec::new();
        for starts in leaving.chunk_by(|one, other| one.0 == other.0) {
            let [(point, start)] = *starts else { continue };
            if matches!(point, Point::Rail | Point::End) || right == Some(point) {
                continue;
            }
            let first = entering.partition_point(|(end, _)| *end < point);
            let ends = &entering[first..];
            let ends = &ends[..ends.partition_point(|(end, _)| *end == point)];
            // Something else, perhaps in another region, may take the power there too.
            if !ends.is_empty() && self.uses.get(&point).copied().unwrap_or(0) == 1 {
                order.push((start, ends));
            }
        }
        if order.is_empty() {
            return false;
        }
        let mut old: Vec<Option<Edge>> = std::mem::take(edges).into_iter().map(Some).collect();
        let mut changed = false;
        // From the left, so that a merged edge is found under the place of its left part.
        let mut moved: Vec<usize> = (0..old.len()).collect();
        for (start, ends) in order {
            if ends.len() > 1 && (adjacent || !ends.iter().all(|(_, end)| starts_at_rail(&old, &moved, *end))) {
                continue;
            }
            let places: Vec<usize> = ends.iter().map(|(_, end)| resolve(&moved, *end)).collect();
            let start = resolve(&moved, start);
            if places.contains(&start) {
                continue;
            }
            let Some(behind) = &old[start] else { continue };
            if adjacent {
                let before = old[places[0]].as_ref();
                let fits = before.is_some_and(|before| {
                    !before.items.is_empty() && !behind.items.is_empty() && before.last + 1 == behind.first
                });
                if !fits {
                    continue;
                }
            }
            let depth =
                places.iter().filter_map(|place| old[*place].as_ref()).map(|edge| edge.depth).max().unwrap_or(0);
            if places.len() > 1 && depth.max(behind.depth) + 1 > MOST_NESTED {
                continue;
            }
            let parts: Vec<Edge> = places.iter().filter_map(|place| old[*place].take()).collect();
            let Some(behind) = old[start].take() else { continue };
            let (from, to) = (parts.first().map_or(Point::Rail, |part| part.from), behind.from);
            let Some(mut before) = parallel(from, to, parts) else { continue };
            before.to = behind.to;
            before.first = before.first.min(behind.first);
            before.last = before.last.max(behind.last);
            before.depth = before.depth.max(behind.depth);
            before.pure &= behind.pure;
            before.items.extend(behind.items);
            for place in &places {
                moved[*place] = places[0];
            }
            moved[start] = places[0];
            old[places[0]] = Some(before);
            changed = true;
        }
        edges.extend(old.into_iter().flatten());
        changed
    }

    /// Edges as branches, each after those that feed its nodes.
    fn branches(&mut self, edges: Vec<Edge>, right: Option<Point>) -> Option<Vec<Branch>> {
        let mut waiting: HashMap<Point, usize> = HashMap::default();
        for edge in edges.iter().filter(|edge| edge.to != Point::End && right != Some(edge.to)) {
            *waiting.entry(edge.to).or_default() += 1;
        }
        let needs: Vec<Vec<Point>> = edges.iter().map(|edge| self.needs(edge)).collect();
        let mut missing: Vec<usize> = Vec::with_capacity(edges.len());
        let mut blocked: HashMap<Point, Vec<usize>> = HashMap::default();
        let mut ready = std::collections::BinaryHeap::new();
        let key = |edge: &Edge, place: usize| std::cmp::Reverse((edge.first, !edge.items.is_empty(), place));
        for (place, (edge, needs)) in edges.iter().zip(&needs).enumerate() {
            let mut count = 0;
            for need in needs.iter().filter(|need| waiting.contains_key(need)) {
                blocked.entry(*need).or_default().push(place);
                count += 1;
            }
            missing.push(count);
            if count == 0 {
                ready.push(key(edge, place));
            }
        }
        let mut edges: Vec<Option<Edge>> = edges.into_iter().map(Some).collect();
        let mut branches = Vec::with_capacity(edges.len());
        while let Some(std::cmp::Reverse((_, _, place))) = ready.pop() {
            let edge = edges[place].take()?;
            let to = edge.to;
            let outward = to != Point::End && right != Some(to);
            branches.push(self.branch(edge, outward)?);
            if !outward {
                continue;
            }
            let left = waiting.get_mut(&to)?;
            *left -= 1;
            if *left == 0 {
                for place in blocked.remove(&to).unwrap_or_default() {
                    missing[place] -= 1;
                    if missing[place] == 0 {
                        ready.push(key(edges[place].as_ref()?, place));
                    }
                }
            }
        }
        edges.iter().all(Option::is_none).then_some(branches)
    }

    /// The nodes that have to be complete before an edge: its own, and those of circuits at pins in it.
    fn needs(&self, edge: &Edge) -> Vec<Point> {
        let mut needs = Vec::new();
        let mut open = vec![edge];
        while let Some(edge) = open.pop() {
            needs.push(edge.from);
            for item in &edge.items {
                match item {
                    Item::Parallel(edges) => open.extend(edges),
                    Item::Vertex(vertex) => {
                        for (pin, power) in self.vertices[*vertex].pins.iter().enumerate() {
                            match self.regions.get(&(*vertex, pin)) {
                                Some(region) => open.extend(self.edges.get(region).into_iter().flatten()),
                                None => needs.push(self.point(&power.feeds)),
                            }
                        }
                    }
                }
            }
        }
        needs.sort_unstable();
        needs.dedup();
        needs
    }

    fn branch(&mut self, edge: Edge, outward: bool) -> Option<Branch> {
        let span = match edge.items.first() {
            Some(Item::Vertex(vertex)) => self.vertices[*vertex].span,
            _ => self.vertices[edge.first].span,
        };
        let from = (edge.from != Point::Rail).then(|| self.node(edge.from, span));
        let to = outward.then(|| self.node(edge.to, span));
        let elements = self.elements(edge.items)?;
        Some(Branch { from: from.map(Box::new), elements, to: to.map(Box::new), span })
    }

    fn elements(&mut self, items: Vec<Item>) -> Option<Vec<Element>> {
        let mut elements = Vec::with_capacity(items.len());
        for item in items {
            match item {
                Item::Vertex(vertex) => elements.push(self.element(vertex)?),
                Item::Parallel(edges) => {
                    let mut branches = Vec::with_capacity(edges.len());
                    for edge in edges {
                        let span = self.vertices[edge.first].span;
                        branches.push(Branch { from: None, elements: self.elements(edge.items)?, to: None, span });
                    }
                    let span = branches.first().map_or(Span::default(), |branch| branch.span);
                    elements.push(Element { kind: ElementKind::Parallel(Circuit { branches, span }), span });
                }
            }
        }
        Some(elements)
    }

    fn node(&mut self, point: Point, span: Span) -> Name {
        let next = self.names.len() + 1;
        Name::new(format!("n{}", self.names.entry(point).or_insert(next)), span)
    }

    fn element(&mut self, place: usize) -> Option<Element> {
        let vertex = &self.vertices[place];
        let span = vertex.span;
        let mut kind = vertex.kind.clone();
        if let ElementKind::Block(call) = &mut kind {
            for (pin, power) in vertex.pins.iter().enumerate() {
                let wire = simplify(self.pin(place, pin, span)?);
                let argument = Argument { pin: power.name.clone(), wire, span: power.name.span };
                call.arguments.insert((power.place + pin).min(call.arguments.len()), argument);
            }
            if let Some(contact) = inverted_contact(call, &vertex.feeds) {
                kind = contact;
            }
        }
        self.emitted.push(place);
        Some(Element { kind, span })
    }

    /// The circuit of a pin.
    fn pin(&mut self, vertex: usize, pin: usize, span: Span) -> Option<Circuit> {
        let point = self.point(&self.vertices[vertex].pins[pin].feeds);
        let branches = match self.regions.get(&(vertex, pin)).copied() {
            Some(region) => self.region(region, Some(point))?,
            None => {
                let from = (point != Point::Rail).then(|| self.node(point, span));
                vec![Branch { from: from.map(Box::new), elements: Vec::new(), to: None, span }]
            }
        };
        Some(Circuit { branches, span })
    }
}

fn resolve(moved: &[usize], mut place: usize) -> usize {
    while moved[place] != place {
        place = moved[place];
    }
    place
}

fn starts_at_rail(old: &[Option<Edge>], moved: &[usize], place: usize) -> bool {
    old[resolve(moved, place)].as_ref().is_some_and(|edge| edge.from == Point::Rail)
}

fn sorted(feeds: &[Feed]) -> Cow<'_, [Feed]> {
    if feeds.is_sorted_by(|one, other| one < other) {
        return Cow::Borrowed(feeds);
    }
    let mut feeds = feeds.to_vec();
    feeds.sort_unstable();
    feeds.dedup();
    Cow::Owned(feeds)
}

/// The innermost region that holds both.
fn common(parents: &[Region], mut one: Region, mut other: Region) -> Region {
    // A region inside of another has a greater number.
    while one != other {
        if one > other {
            one = parents[one];
        } else {
            other = parents[other];
        }
    }
    one
}

/// Edges between the same points as one edge.
fn parallel(from: Point, to: Point, mut parts: Vec<Edge>) -> Option<Edge> {
    if parts.len() == 1 {
        return parts.pop();
    }
    if parts.iter().all(|part| part.pure) {
        parts.sort_by_key(|part| (part.y, part.first));
    } else {
        parts.sort_by_key(|part| part.first);
    }
    let first = parts.iter().map(|part| part.first).min()?;
    let last = parts.iter().map(|part| part.last).max()?;
    let y = parts.iter().map(|part| part.y).min()?;
    let pure = parts.iter().all(|part| part.pure);
    let mut depth = 0;
    let mut branches = Vec::with_capacity(parts.len());
    for mut part in parts {
        // A branch that is nothing but branches joins them.
        match part.items.as_mut_slice() {
            [Item::Parallel(inner)] => {
                depth = depth.max(part.depth.saturating_sub(1));
                branches.append(inner);
            }
            _ => {
                depth = depth.max(part.depth);
                branches.push(part);
            }
        }
    }
    let depth = depth + 1;
    let items = vec![Item::Parallel(branches)];
    (depth <= MOST_NESTED).then_some(Edge { from, to, items, first, last, depth, y, pure })
}

/// A wire to a pin without brackets, where it is nothing but a contact.
fn simplify(mut circuit: Circuit) -> Wire {
    if let [Branch { from: None, elements, to: None, .. }] = circuit.branches.as_mut_slice() {
        match elements.as_mut_slice() {
            [] => {
                let kind = ExpressionKind::Literal(Literal::Bool(true));
                return Wire::Value(Expression { kind, span: circuit.span });
            }
            [Element { kind: ElementKind::Contact { kind: ContactKind::Open, operand }, .. }] => {
                return Wire::Value(operand.clone());
            }
            _ => {}
        }
    }
    Wire::Circuit(circuit)
}

/// What inverts the power of a single contact is the other contact.
fn inverted_contact(call: &BlockCall, feeds: &[Feed]) -> Option<ElementKind> {
    let is_not = call.instance.as_name().is_some_and(|name| name.text == super::vertices::INVERTER);
    let [argument] = call.arguments.as_slice() else { return None };
    if !is_not || feeds != [Feed::Rail] {
        return None;
    }
    match &argument.wire {
        Wire::Value(value) if matches!(value.kind, ExpressionKind::Read(_)) => {
            Some(ElementKind::Contact { kind: ContactKind::Closed, operand: value.clone() })
        }
        Wire::Circuit(circuit) => match circuit.branches.as_slice() {
            [Branch { from: None, elements, to: None, .. }] => match elements.as_slice() {
                [Element { kind: ElementKind::Contact { kind: ContactKind::Closed, operand }, .. }] => {
                    Some(ElementKind::Contact { kind: ContactKind::Open, operand: operand.clone() })
                }
                _ => None,
            },
            _ => None,
        },
        _ => None,
    }
}

/// What a coil with these modifiers does.
pub(in crate::frontend) fn coil_kind(set: Option<bool>, negated: bool, rising: Option<bool>) -> CoilKind {
    match (set, rising) {
        (Some(true), _) => CoilKind::Set,
        (Some(false), _) => CoilKind::Reset,
        (None, Some(rising)) if rising != negated => CoilKind::Rising,
        (None, Some(_)) => CoilKind::Falling,
        (None, None) if negated => CoilKind::Negated,
        (None, None) => CoilKind::Plain,
    }
}
