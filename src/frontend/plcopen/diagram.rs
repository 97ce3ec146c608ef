//! Reads the elements of a body in LD or FBD and the wires between them, each named by its `localId`.

use std::collections::{HashMap, HashSet};

use super::xml::Node;
use crate::diagnostic::{Code, Diagnostic};
use crate::frontend::graph::diagram::{
    Block, Coil, Diagram, Edge, InputPin, Item, ItemKind, Modifier, OutputPin, Source, Storage, negate,
};
use crate::frontend::graph::expression;
use crate::frontend::graph::report::Report;
use crate::ladder::{Expression, ExpressionKind, Name, Reference};
use crate::source::Span;

/// A wire as written.
struct Wire {
    from: From,
    /// The pin of the block that it comes from.
    pin: Option<String>,
    span: Span,
}

enum From {
    /// The element of that `localId`, where it is a number.
    Element(Option<u64>),
    /// A value that is written at the pin itself, by its place among those.
    Value(usize),
}

/// The wires of a connection point.
fn wires<'d, 'a>(point: Node<'d, 'a>) -> impl Iterator<Item = Wire> + use<'d, 'a> {
    point.all("connection").map(|node| Wire {
        from: From::Element(node.attribute("refLocalId").and_then(|id| id.parse().ok())),
        pin: node.attribute("formalParameter").map(str::to_owned),
        span: node.span(),
    })
}

/// Reads a body.
pub(super) fn read(body: Node<'_, '_>, report: &mut Report) -> Diagram {
    let mut reader = Reader {
        report,
        diagram: Diagram::new("localId"),
        ids: HashMap::new(),
        connectors: HashMap::new(),
        wires: Vec::new(),
        values: Vec::new(),
        taken: Vec::new(),
    };
    let elements = body.children().count();
    reader.ids.reserve(elements);
    reader.diagram.items.reserve(elements);
    reader.wires.reserve(elements);
    for node in body.children() {
        reader.element(node);
    }
    reader.connect();
    reader.diagram
}

/// The wires of one pin of an element: of an input of a block, or of all that an element has.
struct Pending {
    item: usize,
    pin: Option<usize>,
    wires: Vec<Wire>,
}

struct Reader<'r> {
    report: &'r mut Report,
    diagram: Diagram,
    ids: HashMap<u64, usize>,
    /// Connectors by name.
    connectors: HashMap<String, usize>,
    wires: Vec<Pending>,
    /// Values that are written at pins.
    values: Vec<(Expression, Span)>,
    /// Variables that are written at outputs of the box that is read, each with the place of the output.
    taken: Vec<(usize, Reference, Span)>,
}

fn number(node: Node<'_, '_>, name: &str) -> Option<i64> {
    // Some tools write fractions.
    let text = node.attribute(name)?;
    text.split('.').next()?.parse::<i32>().ok().map(i64::from)
}

fn modifier(node: Node<'_, '_>) -> Modifier {
    let edge = match node.attribute("edge") {
        Some(edge) if edge.eq_ignore_ascii_case("rising") => Some(Edge::Rising),
        Some(edge) if edge.eq_ignore_ascii_case("falling") => Some(Edge::Falling),
        _ => None,
    };
    Modifier { negated: node.flag("negated"), edge }
}

impl Reader<'_> {
    fn element(&mut self, node: Node<'_, '_>) {
        let span = node.span();
        let known = matches!(
            node.name(),
            "leftPowerRail"
                | "rightPowerRail"
                | "contact"
                | "coil"
                | "block"
                | "inVariable"
                | "outVariable"
                | "inOutVariable"
                | "connector"
                | "continuation"
                | "jump"
                | "return"
                | "label"
                | "comment"
        );
        if !known {
            match node.name() {
                "vendorElement" => self.vendor_element(node),
                "documentation" | "worksheet" => {}
                name => self.report.not_supported(format!("element `<{name}>`"), span),
            }
            return;
        }
        let Some(id) = node.attribute("localId").and_then(|id| id.parse::<u64>().ok()) else {
            let message = format!("this `<{}>` has no localId that is a number", node.name());
            self.report.error(Code::BadElement, span, message);
            return;
        };
        let item = self.diagram.items.len();
        let pending = self.wires.len();
        let Some(kind) = self.kind(node, item) else {
            self.wires.truncate(pending);
            return;
        };
        if let (ItemKind::Connector { .. }, Some(name)) = (&kind, node.attribute("name")) {
            self.connectors.entry(crate::ladder::key(name)).or_insert(item);
        }
        if let Some(first) = self.ids.get(&id) {
            let first = self.diagram.items[*first].span;
            let problem = Diagnostic::new(Code::DuplicateId, span, format!("two elements have the localId {id}"));
            self.report.push(problem.related(first, "the first is here"));
        } else {
            self.ids.insert(id, item);
        }
        let position = node.child("position");
        let at = |name: &str| position.and_then(|position| number(position, name)).unwrap_or(0);
        let order = node.attribute("executionOrderId").and_then(|order| order.parse().ok()).unwrap_or(0);
        let (x, y) = (at("x"), at("y"));
        self.diagram.items.push(Item { id, span, x, y, order, kind });
        // They take their values where the box stands, right behind it.
        for (output, target, span) in std::mem::take(&mut self.taken) {
            let inputs = vec![Source::Output(item, output)];
            let modifier = Modifier::default();
            let kind = ItemKind::Coil(Coil { target, modifier, storage: None, inputs, variable: true, value: None });
            self.diagram.items.push(Item { id, span, x, y, order, kind });
        }
    }

    /// What a tool draws beyond the standard: the title of a network is a comment, other things show but do nothing.
    fn vendor_element(&mut self, node: Node<'_, '_>) {
        let is_title = node.child("ElementType").is_some_and(|ty| ty.text().eq_ignore_ascii_case("networktitle"));
        let title = node.child("alternativeText").filter(|_| is_title).map(Node::whole_text);
        if let Some(title) = title.filter(|title| !title.is_empty()) {
            let position = node.child("position");
            let at = |name: &str| position.and_then(|position| number(position, name)).unwrap_or(0);
            let kind = ItemKind::Comment(title);
            self.diagram.items.push(Item { id: 0, span: node.span(), x: at("x"), y: at("y"), order: 0, kind });
        }
    }

    fn kind(&mut self, node: Node<'_, '_>, item: usize) -> Option<ItemKind> {
        let span = node.span();
        let inputs = Vec::new();
        if matches!(node.name(), "contact" | "coil" | "outVariable" | "inOutVariable" | "connector" | "jump" | "return")
        {
            let wires = node.all("connectionPointIn").flat_map(wires).collect();
            self.wires.push(Pending { item, pin: None, wires });
        }
        Some(match node.name() {
            "leftPowerRail" => ItemKind::LeftRail,
            "rightPowerRail" => ItemKind::RightRail,
            "contact" => {
                let operand = self.operand(node, "variable")?;
                ItemKind::Contact { operand, modifier: modifier(node), inputs }
            }
            "coil" | "outVariable" | "inOutVariable" => {
                let variable = node.name() != "coil";
                let value = self.operand(node, if variable { "expression" } else { "variable" })?;
                let ExpressionKind::Read(target) = value.kind.clone() else {
                    let message = format!("this `<{}>` names no variable", node.name());
                    self.report.error(Code::NotWritable, span, message);
                    return None;
                };
                let both = node.name() == "inOutVariable";
                let mut modifier = modifier(node);
                modifier.negated |= node.flag("negatedIn");
                let storage = match node.attribute("storage") {
                    Some(storage) if storage.eq_ignore_ascii_case("set") => Some(Storage::Set),
                    Some(storage) if storage.eq_ignore_ascii_case("reset") => Some(Storage::Reset),
                    _ => None,
                };
                let value = if node.flag("negatedOut") { negate(value) } else { value };
                ItemKind::Coil(Coil { target, modifier, storage, inputs, variable, value: both.then_some(value) })
            }
            "inVariable" => {
                let value = self.operand(node, "expression")?;
                ItemKind::Value(if node.flag("negated") { negate(value) } else { value })
            }
            "block" => ItemKind::Block(self.block(node, item)?),
            "connector" | "continuation" => {
                let Some(name) = node.attribute("name") else {
                    self.report.error(Code::BadElement, span, format!("this `<{}>` has no name", node.name()));
                    return None;
                };
                match node.name() {
                    "connector" => ItemKind::Connector { inputs },
                    _ => ItemKind::Continuation { name: crate::ladder::key(name) },
                }
            }
            "jump" | "label" => {
                let Some(label) = node.attribute("label") else {
                    self.report.error(Code::BadElement, span, format!("this `<{}>` has no label", node.name()));
                    return None;
                };
                let label = Name::new(label, span);
                if node.name() == "label" {
                    ItemKind::Label(label)
                } else {
                    ItemKind::Jump { label: Some(label), inputs }
                }
            }
            "return" => ItemKind::Jump { label: None, inputs },
            _ => ItemKind::Comment(node.whole_text()),
        })
    }

    fn operand(&mut self, node: Node<'_, '_>, child: &str) -> Option<Expression> {
        let text = node.child(child).or_else(|| node.child("variable")).or_else(|| node.child("expression"));
        let text = text.map(Node::text).filter(|text| !text.is_empty());
        let Some(text) = text.or_else(|| node.attribute("variable")) else {
            let id = node.attribute("localId").unwrap_or("?");
            let message = format!("this `<{}>` (localId {id}) names no variable", node.name());
            self.report.error(Code::BadElement, node.span(), message);
            return None;
        };
        self.report.read(expression::expression(text, node.span()), node.span())
    }

    fn block(&mut self, node: Node<'_, '_>, item: usize) -> Option<Block> {
        let span = node.span();
        let Some(type_name) = node.attribute("typeName") else {
            self.report.error(Code::BadElement, span, "this `<block>` has no typeName");
            return None;
        };
        let instance = match node.attribute("instanceName") {
            Some(name) => Some(self.report.read(expression::reference(name, span), span)?),
            None => None,
        };
        let mut inputs: Vec<InputPin> = Vec::new();
        for (list, in_out) in [("inputVariables", false), ("inOutVariables", true)] {
            for pin in node.all(list).flat_map(|list| list.all("variable")) {
                let name = Name::new(pin.attribute("formalParameter").unwrap_or("IN"), pin.span());
                let point = pin.child("connectionPointIn");
                let mut wires: Vec<Wire> = point.into_iter().flat_map(wires).collect();
                let text = point.and_then(|point| point.child("expression")).map(Node::text);
                if let Some(text) = text.filter(|text| !text.is_empty()) {
                    let value = self.report.read(expression::expression(text, pin.span()), pin.span());
                    wires.extend(value.map(|value| self.value(value, pin.span())));
                }
                self.wires.push(Pending { item, pin: Some(inputs.len()), wires });
                inputs.push(InputPin { name, modifier: modifier(pin), in_out, sources: Vec::new() });
            }
        }
        let mut outputs = Vec::new();
        self.taken.clear();
        for pin in node.all("outputVariables").flat_map(|list| list.all("variable")) {
            let name = Name::new(pin.attribute("formalParameter").unwrap_or("OUT"), pin.span());
            // CODESYS writes what takes an output at the pin itself.
            let target = pin.child("connectionPointOut").and_then(|point| point.child("expression")).map(Node::text);
            if let Some(target) = target.filter(|target| !target.is_empty()) {
                let target = self.report.read(expression::reference(target, pin.span()), pin.span());
                self.taken.extend(target.map(|target| (outputs.len(), target, pin.span())));
            }
            outputs.push(OutputPin { name, negated: pin.flag("negated") });
        }
        if node.child("STCode").is_some() {
            self.report.not_supported("box with structured text in it", span);
        }
        Some(Block { type_name: Name::new(type_name, span), instance, inputs, outputs })
    }

    /// A wire from a value that is written at the pin itself.
    fn value(&mut self, value: Expression, span: Span) -> Wire {
        self.values.push((value, span));
        Wire { from: From::Value(self.values.len() - 1), pin: None, span }
    }

    /// Resolves every wire.
    fn connect(&mut self) {
        let first_value = self.diagram.items.len();
        for (value, span) in std::mem::take(&mut self.values) {
            self.diagram.items.push(Item { id: 0, span, x: 0, y: 0, order: 0, kind: ItemKind::Value(value) });
        }
        let mut ends: Vec<(usize, Option<usize>, Vec<End>)> = Vec::new();
        for pending in std::mem::take(&mut self.wires) {
            let found: Vec<End> = pending.wires.iter().filter_map(|wire| self.end(wire, first_value)).collect();
            if found.len() < pending.wires.len() {
                self.diagram.faulty.insert(pending.item);
            }
            ends.push((pending.item, pending.pin, found));
        }
        let mut feeds: HashMap<usize, Vec<End>> = HashMap::new();
        for (item, _, ends) in &ends {
            if matches!(self.diagram.items[*item].kind, ItemKind::Connector { .. }) {
                feeds.insert(*item, ends.clone());
            }
        }
        for (item, pin, ends) in ends {
            let sources = follow(&ends, &feeds);
            match (&mut self.diagram.items[item].kind, pin) {
                (ItemKind::Block(block), Some(pin)) => block.inputs[pin].sources = sources,
                (
                    ItemKind::Contact { inputs, .. }
                    | ItemKind::Coil(Coil { inputs, .. })
                    | ItemKind::Connector { inputs }
                    | ItemKind::Jump { inputs, .. },
                    _,
                ) => *inputs = sources,
                _ => {}
            }
        }
    }

    /// Where a wire comes from.
    fn end(&mut self, wire: &Wire, first_value: usize) -> Option<End> {
        let id = match wire.from {
            From::Value(place) => return Some(End::Source(Source::Value(first_value + place))),
            From::Element(id) => id,
        };
        let Some(item) = id.and_then(|id| self.ids.get(&id)).copied() else {
            let id = id.map_or_else(|| "no number".to_owned(), |id| id.to_string());
            self.report.error(
                Code::DanglingConnection,
                wire.span,
                format!("no element has the localId that this wire comes from: {id}"),
            );
            return None;
        };
        let source = match &self.diagram.items[item].kind {
            ItemKind::LeftRail => Source::Rail,
            ItemKind::Contact { .. } | ItemKind::Coil(Coil { variable: false, .. }) => Source::Power(item),
            ItemKind::Value(_) | ItemKind::Coil(Coil { value: Some(_), .. }) => Source::Value(item),
            ItemKind::Block(block) => {
                let found = match &wire.pin {
                    Some(pin) => {
                        let output = block.output(pin).map(|output| Source::Output(item, output));
                        output.or_else(|| {
                            let input = block.input(pin).filter(|input| block.inputs[*input].in_out)?;
                            Some(Source::InOut(item, input))
                        })
                    }
                    // A function's result, for which not every tool writes a name.
                    None => {
                        let result = block.outputs.iter().position(|pin| !pin.name.text.eq_ignore_ascii_case("ENO"));
                        result.or((!block.outputs.is_empty()).then_some(0)).map(|output| Source::Output(item, output))
                    }
                };
                match found {
                    Some(source) => source,
                    None => {
                        let pin = wire.pin.as_deref().unwrap_or("?");
                        let id = self.diagram.items[item].id;
                        let message = format!("{} (localId {id}) has no output `{pin}`", block.type_name.text);
                        self.report.error(Code::DanglingConnection, wire.span, message);
                        return None;
                    }
                }
            }
            ItemKind::Continuation { name } => match self.connectors.get(name) {
                Some(connector) => return Some(End::Connector(*connector)),
                None => {
                    self.report.error(Code::DanglingConnection, wire.span, format!("no connector is called `{name}`"));
                    return None;
                }
            },
            _ => {
                let id = self.diagram.items[item].id;
                self.report.error(
                    Code::DanglingConnection,
                    wire.span,
                    format!("the element with the localId {id} gives nothing"),
                );
                return None;
            }
        };
        Some(End::Source(source))
    }
}

/// Where a wire comes from before connectors are followed.
#[derive(Clone, Copy)]
enum End {
    Source(Source),
    Connector(usize),
}

/// The sources of wires, each once, through any number of connectors.
fn follow(ends: &[End], feeds: &HashMap<usize, Vec<End>>) -> Vec<Source> {
    if let [End::Source(source)] = ends {
        return vec![*source];
    }
    let mut sources = Vec::new();
    let mut seen = HashSet::new();
    let mut found = HashSet::new();
    let mut open: Vec<End> = ends.iter().rev().copied().collect();
    while let Some(end) = open.pop() {
        match end {
            End::Source(source) if found.insert(source) => sources.push(source),
            End::Source(_) => {}
            End::Connector(connector) => {
                if seen.len() < MOST_CONNECTORS && seen.insert(connector) {
                    open.extend(feeds.get(&connector).into_iter().flatten().rev());
                }
            }
        }
    }
    sources
}

/// How many connectors one wire is followed through.
const MOST_CONNECTORS: usize = 64;
