//! Reads the elements of a body and the wires between them: the `rungs` of a ladder, or the one `rung` of an FBD.
//!
//! Power runs as OpenPLC Editor hands it to its compiler: what reaches a box but comes from no variable goes to the pin on its
//! left, `inputConnector`, and what leaves it leaves the pin on its right, `outputConnector`, unless the wire names another pin.
//! The ends of parallels are wires.

use std::collections::{HashMap, HashSet};

use super::json::Value;
use crate::diagnostic::{Code, Diagnostic};
use crate::frontend::graph::diagram::{
    Block, Coil, Diagram, Edge, InputPin, Item, ItemKind, Modifier, OutputPin, Source, Storage, negate,
};
use crate::frontend::graph::expression;
use crate::frontend::graph::report::Report;
use crate::ladder::{ExpressionKind, Name, Reference, key};
use crate::source::Span;

/// The space between a rung and the next one, in units of the drawing.
const BETWEEN: i64 = 100;

/// Reads a body.
pub(super) fn read(body: Value<'_>, report: &mut Report) -> Diagram {
    let mut reader = Reader {
        report,
        diagram: Diagram::new("numericId"),
        ids: HashMap::new(),
        connectors: HashMap::new(),
        steps: 0,
    };
    let mut top = 0;
    let rungs = body.member("rungs").into_iter().flat_map(Value::items);
    for rung in rungs.chain(body.member("rung")) {
        top = reader.rung(rung, top) + BETWEEN;
    }
    if body.member("rungs").or_else(|| body.member("rung")).is_none() {
        let message = "this body has no `rungs` and no `rung`";
        reader.report.error(Code::BadElement, body.span(), message);
    }
    reader.diagram
}

/// How many steps through parallels and connectors all wires of a body may take.
const MOST_STEPS: usize = 1 << 22;

/// What a node of the drawing is.
#[derive(Clone, Copy)]
enum Node {
    Item(usize),
    /// The end of a parallel, or a connector: its power is that of the wires to it.
    Wire,
    Continuation,
    /// Nothing starts or ends here that counts.
    Idle,
}

struct Reader<'r> {
    report: &'r mut Report,
    diagram: Diagram,
    /// The nodes of the rung.
    ids: HashMap<String, (Node, Span)>,
    /// Connectors of the body by name.
    connectors: HashMap<String, String>,
    /// Steps through parallels and connectors so far.
    steps: usize,
}

/// A wire as written.
struct Wire<'d> {
    source: String,
    target: String,
    source_pin: Option<std::borrow::Cow<'d, str>>,
    target_pin: Option<std::borrow::Cow<'d, str>>,
    span: Span,
}

impl Reader<'_> {
    /// Reads a rung whose top is there; the result is its bottom.
    fn rung(&mut self, rung: Value<'_>, top: i64) -> i64 {
        self.ids.clear();
        self.connectors.clear();
        let mut bottom = top;
        if let Some(text) = rung.text_of("comment") {
            let kind = ItemKind::Comment(text.into_owned());
            self.diagram.items.push(Item { id: 0, span: rung.span(), x: 0, y: top, order: 0, kind });
        }
        let nodes = || rung.member("nodes").into_iter().flat_map(Value::items);
        let mut named = Vec::new();
        for node in nodes() {
            let Some(id) = node.text_of("id") else {
                self.report.error(Code::BadElement, node.span(), "this node has no `id`");
                continue;
            };
            let span = node.member("id").map_or_else(|| node.span(), Value::span);
            let at = |name: &str| node.at(&["position", name]).and_then(Value::number).unwrap_or(0);
            let (x, y) = (at("x").clamp(-1_000_000, 1_000_000), at("y").clamp(-1_000_000, 1_000_000));
            let y = top.saturating_add(y);
            bottom = bottom.max(y);
            let kind = self.node(node, &id, span);
            let found = match kind {
                Ok(kind) => {
                    let number =
                        |value: Option<Value<'_>>| value.and_then(Value::number).and_then(|n| n.try_into().ok());
                    let data = node.member("data");
                    let number = |name: &str| number(data.and_then(|data| data.member(name))).unwrap_or(0);
                    let item = Item { id: number("numericId"), span, x, y, order: number("executionOrder"), kind };
                    self.diagram.items.push(item);
                    Node::Item(self.diagram.items.len() - 1)
                }
                Err(other) => other,
            };
            if let Some((_, first)) = self.ids.get(&*id) {
                let problem = Diagnostic::new(Code::DuplicateId, span, format!("two nodes have the id `{id}`"));
                self.report.push(problem.related(*first, "the first is here"));
                // Wires go to the first.
                if let Node::Item(item) = found {
                    self.diagram.faulty.insert(item);
                }
            } else {
                self.ids.insert(id.clone().into_owned(), (found, span));
                named.push((id, node));
            }
        }
        self.connect(rung, &named);
        bottom
    }

    /// What a node is; where it is no element, how wires go on at it.
    fn node(&mut self, node: Value<'_>, id: &str, span: Span) -> Result<ItemKind, Node> {
        let inputs = Vec::new();
        let ty = node.text_of("type").unwrap_or_default();
        let Some(data) = node.member("data") else {
            self.report.error(Code::BadElement, span, format!("the node `{id}` has no `data`"));
            return Err(Node::Idle);
        };
        let variant = data.text_of("variant").unwrap_or_default();
        match &*ty {
            "powerRail" if variant == "right" => Ok(ItemKind::RightRail),
            "powerRail" => Ok(ItemKind::LeftRail),
            "parallel" => Err(Node::Wire),
            "contact" => {
                let operand = self.operand(data, id, span)?;
                Ok(ItemKind::Contact { operand, modifier: self.modifier(&variant, id, span), inputs })
            }
            "coil" => {
                let target = self.target(data, id, span)?;
                let storage = match &*variant {
                    "set" => Some(Storage::Set),
                    "reset" => Some(Storage::Reset),
                    _ => None,
                };
                let modifier = if storage.is_some() { Modifier::default() } else { self.modifier(&variant, id, span) };
                Ok(ItemKind::Coil(Coil { target, modifier, storage, inputs, variable: false, value: None }))
            }
            "block" => self.block(data, id, span).map(ItemKind::Block),
            "variable" | "input-variable" | "output-variable" | "inout-variable" => {
                // The editor leaves one at every pin that nothing was written at.
                if data
                    .at(&["variable", "name"])
                    .is_none_or(|name| name.text().is_none_or(|name| name.trim().is_empty()))
                {
                    return Err(Node::Idle);
                }
                let negated = data.member("negated").is_some_and(Value::is_true);
                if ty == "output-variable" || variant == "output" || variant == "output-variable" {
                    let target = self.target(data, id, span)?;
                    let modifier = Modifier { negated, edge: None };
                    return Ok(ItemKind::Coil(Coil {
                        target,
                        modifier,
                        storage: None,
                        inputs,
                        variable: true,
                        value: None,
                    }));
                }
                let value = self.operand(data, id, span)?;
                let value = if negated { negate(value) } else { value };
                if ty == "inout-variable" {
                    let target = self.target(data, id, span)?;
                    let modifier = Modifier::default();
                    let value = Some(value);
                    return Ok(ItemKind::Coil(Coil { target, modifier, storage: None, inputs, variable: true, value }));
                }
                Ok(ItemKind::Value(value))
            }
            "connector" | "continuation" => {
                let Some(name) = data.at(&["variable", "name"]).and_then(Value::text) else {
                    self.report.error(Code::BadElement, span, format!("the {ty} `{id}` has no name"));
                    return Err(Node::Idle);
                };
                if ty == "continuation" {
                    return Err(Node::Continuation);
                }
                self.connectors.entry(key(&name)).or_insert_with(|| id.to_owned());
                Err(Node::Wire)
            }
            "comment" => match data.text_of("content") {
                Some(text) => Ok(ItemKind::Comment(text.into_owned())),
                None => Err(Node::Idle),
            },
            "mockNode" | "placeholder" | "parallelPlaceholder" => Err(Node::Idle),
            "" => {
                self.report.error(Code::BadElement, span, format!("the node `{id}` has no `type`"));
                Err(Node::Idle)
            }
            other => {
                self.report.not_supported(format!("element of the type `{}`", expression::clipped(other)), span);
                Err(Node::Idle)
            }
        }
    }

    fn modifier(&mut self, variant: &str, id: &str, span: Span) -> Modifier {
        let edge = match variant {
            "risingEdge" => Some(Edge::Rising),
            "fallingEdge" => Some(Edge::Falling),
            _ => None,
        };
        if edge.is_none() && !matches!(variant, "" | "default" | "negated") {
            let message = format!("`{id}` is of a kind that there is not: `{}`", expression::clipped(variant));
            self.report.error(Code::BadElement, span, message);
        }
        Modifier { negated: variant == "negated", edge }
    }

    /// The variable or expression that an element names.
    fn operand(&mut self, data: Value<'_>, id: &str, span: Span) -> Result<crate::ladder::Expression, Node> {
        let Some(text) = data.member("variable").and_then(|variable| variable.text_of("name")) else {
            self.report.error(Code::BadElement, span, format!("`{id}` names no variable"));
            return Err(Node::Idle);
        };
        self.report.read(expression::expression(&text, span), span).ok_or(Node::Idle)
    }

    fn target(&mut self, data: Value<'_>, id: &str, span: Span) -> Result<Reference, Node> {
        match self.operand(data, id, span)?.kind {
            ExpressionKind::Read(target) => Ok(target),
            _ => {
                self.report.error(Code::NotWritable, span, format!("`{id}` writes what is no variable"));
                Err(Node::Idle)
            }
        }
    }

    fn block(&mut self, data: Value<'_>, id: &str, span: Span) -> Result<Block, Node> {
        let variant = data.member("variant");
        let Some(name) = variant.and_then(|variant| variant.text_of("name")) else {
            self.report.error(Code::BadElement, span, format!("the block `{id}` has no `variant` with a name"));
            return Err(Node::Idle);
        };
        let instance = if variant.and_then(|variant| variant.text_of("type")).as_deref() == Some("function-block") {
            Some(self.target(data, id, span)?)
        } else {
            None
        };
        let (mut inputs, mut outputs): (Vec<InputPin>, Vec<OutputPin>) = (Vec::new(), Vec::new());
        let mut known = HashSet::new();
        let mut add = |pin: &str, class: &str| {
            if !known.insert(key(pin)) {
                return;
            }
            let name = Name::new(pin, span);
            match class {
                "input" | "inOut" | "inout" => inputs.push(InputPin {
                    name,
                    modifier: Modifier::default(),
                    in_out: class != "input",
                    sources: Vec::new(),
                }),
                "output" => outputs.push(OutputPin { name, negated: false }),
                _ => {}
            }
        };
        // Where EN takes the power, the pins of the type do not say so.
        if data.member("executionControl").is_some_and(Value::is_true) {
            add("EN", "input");
            add("ENO", "output");
        }
        for pin in variant.and_then(|variant| variant.member("variables")).into_iter().flat_map(Value::items) {
            let (Some(pin), Some(class)) = (pin.text_of("name"), pin.text_of("class")) else { continue };
            add(&pin, &class);
        }
        // The pins on the left and right are those that count, whatever is said of the type.
        for (connector, class) in [("inputConnector", "input"), ("outputConnector", "output")] {
            if let Some(pin) = data.member(connector).and_then(|connector| connector.text_of("id")) {
                add(&pin, class);
            }
        }
        Ok(Block { type_name: Name::new(name, span), instance, inputs, outputs })
    }

    /// Resolves the wires of a rung.
    fn connect<'d>(&mut self, rung: Value<'d>, nodes: &[(std::borrow::Cow<'d, str>, Value<'d>)]) {
        let by_id: HashMap<&str, Value<'d>> = nodes.iter().map(|(id, node)| (&**id, *node)).collect();
        let mut wires: Vec<Wire<'d>> = Vec::new();
        for edge in rung.member("edges").into_iter().flat_map(Value::items) {
            let (Some(source), Some(target)) = (edge.text_of("source"), edge.text_of("target")) else {
                self.report.error(Code::BadElement, edge.span(), "this edge has no `source` or no `target`");
                continue;
            };
            let span = edge.member("id").map_or_else(|| edge.span(), Value::span);
            let dangling = [&source, &target].into_iter().find(|end| !self.ids.contains_key(&***end));
            if let Some(end) = dangling {
                let message = format!("no node of the rung has the id of an end of this wire: `{end}`");
                self.report.error(Code::DanglingConnection, span, message);
                if let Some((Node::Item(item), _)) = self.ids.get(&*target) {
                    self.diagram.faulty.insert(*item);
                }
                continue;
            }
            let (source_pin, target_pin) = (edge.text_of("sourceHandle"), edge.text_of("targetHandle"));
            let (source, target) = (source.into_owned(), target.into_owned());
            wires.push(Wire { source, target, source_pin, target_pin, span });
        }
        self.variables(nodes, &by_id, &mut wires);
        let mut into: HashMap<&str, Vec<usize>> = HashMap::new();
        for (place, wire) in wires.iter().enumerate() {
            into.entry(&wire.target).or_default().push(place);
        }
        let mut found: Vec<(usize, Option<usize>, Source)> = Vec::new();
        for (id, node) in nodes {
            let Some((Node::Item(item), _)) = self.ids.get(&**id).copied() else { continue };
            let mut seen = HashSet::new();
            for place in into.get(&**id).into_iter().flatten() {
                let wire = &wires[*place];
                let pin = self.input(item, *node, wire);
                for source in self.sources(item, *place, &wires, &into, &by_id) {
                    if seen.insert((pin, source)) {
                        found.push((item, pin, source));
                    }
                }
            }
        }
        for (item, pin, source) in found {
            match (&mut self.diagram.items[item].kind, pin) {
                (ItemKind::Block(block), Some(pin)) => block.inputs[pin].sources.push(source),
                (
                    ItemKind::Contact { inputs, .. }
                    | ItemKind::Coil(Coil { inputs, .. })
                    | ItemKind::Jump { inputs, .. },
                    _,
                ) => inputs.push(source),
                _ => {}
            }
        }
    }

    /// The wires between a ladder's boxes and the variables at their pins, which name the pin themselves; those that are drawn
    /// too are left as they are.
    fn variables<'d>(
        &self,
        nodes: &[(std::borrow::Cow<'d, str>, Value<'d>)],
        by_id: &HashMap<&str, Value<'d>>,
        wires: &mut Vec<Wire<'d>>,
    ) {
        let mut wired: HashSet<(String, String)> = HashSet::new();
        for wire in wires.iter() {
            wired.insert((wire.source.clone(), wire.target.clone()));
        }
        for (id, node) in nodes {
            let Some(block) = node.at(&["data", "block"]) else { continue };
            let (Some(of), Some(pin)) = (block.text_of("id"), block.text_of("handleId")) else { continue };
            let Some((Node::Item(item), span)) = self.ids.get(&**id) else { continue };
            if !by_id.contains_key(&*of) {
                continue;
            }
            let gives = matches!(self.diagram.items[*item].kind, ItemKind::Value(_));
            let (id, of) = (id.clone().into_owned(), of.into_owned());
            let (source, target) = if gives { (id, of) } else { (of, id) };
            if wired.insert((source.clone(), target.clone())) {
                let (source_pin, target_pin) = if gives { (None, Some(pin)) } else { (Some(pin), None) };
                wires.push(Wire { source, target, source_pin, target_pin, span: *span });
            }
        }
    }

    /// The pin of a block at which a wire ends.
    fn input(&self, item: usize, node: Value<'_>, wire: &Wire<'_>) -> Option<usize> {
        let ItemKind::Block(block) = &self.diagram.items[item].kind else { return None };
        let named = wire.target_pin.as_ref().and_then(|pin| block.input(pin));
        let left = node.at(&["data", "inputConnector"]).and_then(|pin| pin.text_of("id"));
        let left = left.and_then(|pin| block.input(&pin));
        named.or(left).or((!block.inputs.is_empty()).then_some(0))
    }

    /// Where the power of a wire comes from, through any number of parallels and connectors.
    fn sources(
        &mut self,
        target: usize,
        wire: usize,
        wires: &[Wire<'_>],
        into: &HashMap<&str, Vec<usize>>,
        by_id: &HashMap<&str, Value<'_>>,
    ) -> Vec<Source> {
        let mut sources = Vec::new();
        let mut seen: HashSet<&str> = HashSet::new();
        let mut open = vec![wire];
        while let Some(place) = open.pop() {
            let wire = &wires[place];
            self.steps += 1;
            if self.steps >= MOST_STEPS {
                if self.steps == MOST_STEPS {
                    self.report.error(Code::TooDeep, wire.span, "the wires of this body have too many ways");
                }
                break;
            }
            let through = match self.ids.get(&wire.source).map(|(node, _)| *node) {
                Some(Node::Item(item)) => {
                    sources.extend(self.source(item, wire, by_id));
                    continue;
                }
                Some(Node::Wire) => &wire.source,
                Some(Node::Continuation) => {
                    let name = by_id.get(&*wire.source).and_then(|node| node.at(&["data", "variable", "name"]));
                    let name = key(&name.and_then(Value::text).unwrap_or_default());
                    let Some(connector) = self.connectors.get(&name) else {
                        let message = format!("no connector is called `{name}`");
                        self.report.error(Code::DanglingConnection, wire.span, message);
                        continue;
                    };
                    connector
                }
                // What is wrong there was said.
                Some(Node::Idle) | None => {
                    self.diagram.faulty.insert(target);
                    continue;
                }
            };
            let Some((through, _)) = by_id.get_key_value(&**through) else { continue };
            if seen.insert(through) {
                open.extend(into.get(through).into_iter().flatten().rev());
            }
        }
        sources
    }

    /// What an element gives to a wire.
    fn source(&mut self, item: usize, wire: &Wire<'_>, by_id: &HashMap<&str, Value<'_>>) -> Option<Source> {
        match &self.diagram.items[item].kind {
            ItemKind::LeftRail => Some(Source::Rail),
            ItemKind::Contact { .. } | ItemKind::Coil(Coil { variable: false, .. }) => Some(Source::Power(item)),
            ItemKind::Value(_) | ItemKind::Coil(Coil { value: Some(_), .. }) => Some(Source::Value(item)),
            ItemKind::Block(block) => {
                let named = wire.source_pin.as_ref().and_then(|pin| block.output(pin));
                let right = by_id.get(&*wire.source).and_then(|node| node.at(&["data", "outputConnector"]));
                let right = right.and_then(|pin| pin.text_of("id")).and_then(|pin| block.output(&pin));
                let in_out = wire.source_pin.as_ref().and_then(|pin| block.input(pin));
                let in_out = in_out.filter(|pin| block.inputs[*pin].in_out).map(|pin| Source::InOut(item, pin));
                let output = named.map(|output| Source::Output(item, output)).or(in_out);
                let output = output.or(right.map(|output| Source::Output(item, output)));
                if output.is_none() {
                    let pin = wire.source_pin.as_deref().unwrap_or("?");
                    let message = format!("{} has no output `{}`", block.type_name.text, expression::clipped(pin));
                    self.report.error(Code::DanglingConnection, wire.span, message);
                }
                output
            }
            _ => {
                let message = format!("`{}` gives nothing to a wire", wire.source);
                self.report.error(Code::DanglingConnection, wire.span, message);
                None
            }
        }
    }
}
