//! What each element of a diagram is in a rung: a contact, a coil, a box with what is wired to its pins, a formula.
//!
//! Power runs between vertices; data runs in expressions. An output of a block instance is read as its member. A function
//! that is needed once and has no EN stands as a formula where it is needed; else it is a box, and what others read of it
//! is kept in a hidden variable.

use std::cell::Cell;
use std::collections::{HashMap, HashSet};

use super::diagram::{Block, Coil, Diagram, Edge, ItemKind, Modifier, Source, Storage, negate};
use super::network::{Feed, PowerPin, Vertex, coil_kind};
use super::order::{Order, sources};
use super::report::Report;
use super::types::{Scope, elementary};
use crate::diagnostic::Code;
use crate::elementary::Elementary;
use crate::ladder::functions::{Function, StandardFunction};
use crate::ladder::{
    Argument, BinaryOperator, BlockCall, ContactKind, ElementKind, Expression, ExpressionKind, FunctionArgument,
    Literal, Name, Reference, Step, TypeReference, UnaryOperator, Variable, VariableClass, Wire, key,
};
use crate::source::Span;

/// The function that inverts power.
pub(super) const INVERTER: &str = "NOT";
/// How deep formulas are put into each other.
const MOST_NESTED: usize = 24;
/// How many operands are looked at for the type of one hidden variable: functions in circles have any number.
const MOST_LOOKS: usize = 64;

/// One use of what a block gives.
struct Use {
    /// Who uses it.
    user: usize,
    output: usize,
    power: bool,
}

/// How a block appears.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Form {
    Box,
    /// As an expression where its one user needs it.
    Nested,
    /// As a contact with a formula.
    Condition,
}

pub(super) struct Builder<'d, 'r> {
    diagram: &'d Diagram,
    order: &'d Order,
    scope: &'d Scope<'d>,
    report: &'r mut Report,
    /// What was made, in order of execution.
    pub(super) vertices: Vec<Vertex>,
    /// The variables that wires need.
    pub(super) hidden: Vec<Variable>,
    /// For each element the vertex whose right side is its power.
    power: Vec<Option<usize>>,
    forms: Vec<Form>,
    /// For each block the output that gives the power on its right.
    main: Vec<Option<usize>>,
    uses: HashMap<usize, Vec<Use>>,
    /// Places of hidden variables, by block and output.
    kept: HashMap<(usize, usize), usize>,
    /// The names of hidden variables and instances, as they are compared.
    taken: HashSet<String>,
    /// How many operands may still be looked at for a type.
    looks: Cell<usize>,
    /// The last vertex with an effect.
    last: Option<usize>,
}

impl<'d, 'r> Builder<'d, 'r> {
    pub(super) fn new(diagram: &'d Diagram, order: &'d Order, scope: &'d Scope<'d>, report: &'r mut Report) -> Self {
        let count = diagram.items.len();
        let mut builder = Self {
            diagram,
            order,
            scope,
            report,
            vertices: Vec::new(),
            hidden: Vec::new(),
            power: vec![None; count],
            forms: vec![Form::Box; count],
            main: vec![None; count],
            uses: HashMap::new(),
            kept: HashMap::new(),
            taken: HashSet::new(),
            looks: Cell::new(0),
            last: None,
        };
        builder.find_uses();
        builder.find_forms();
        builder
    }

    fn block(&self, item: usize) -> Option<&'d Block> {
        match &self.diagram.items[item].kind {
            ItemKind::Block(block) => Some(block),
            _ => None,
        }
    }

    fn find_uses(&mut self) {
        for user in &self.order.items {
            let (user, kind) = (*user, &self.diagram.items[*user].kind);
            let mut note = |source: &Source, power: bool| {
                if let Source::Output(block, output) = source {
                    self.uses.entry(*block).or_default().push(Use { user, output: *output, power });
                }
            };
            match kind {
                ItemKind::Coil(coil) => coil.inputs.iter().for_each(|source| note(source, coil_takes_power(coil))),
                ItemKind::Block(block) => {
                    for (pin, input) in block.inputs.iter().enumerate() {
                        let power = takes_power(self.scope, block, pin);
                        input.sources.iter().for_each(|source| note(source, power));
                    }
                }
                _ => sources(kind).for_each(|source| note(&source, true)),
            }
        }
    }

    /// How each block appears, from the last to the first, for a formula moves to where it is needed.
    fn find_forms(&mut self) {
        let count = self.order.items.len();
        // How many vertices with an effect stand before each step, counted from the end.
        let mut effects_behind = vec![0usize; count + 1];
        // Where a formula is computed in the end, and how deep in others it is.
        let mut site: Vec<usize> = (0..count).collect();
        let mut depth = vec![0usize; count];
        for step in (0..count).rev() {
            let item = self.order.items[step];
            let mut effect = !matches!(self.diagram.items[item].kind, ItemKind::Contact { .. });
            if let Some(block) = self.block(item) {
                let uses = self.uses.get(&item).map_or(&[][..], Vec::as_slice);
                let user_step = |used: &Use| self.order.step[used.user].filter(|user| *user > step);
                let forward = uses.iter().all(|used| user_step(used).is_some());
                let form = match uses {
                    [only] if forward && !only.power && self.is_formula(block, uses) => {
                        let user = user_step(only).unwrap_or(step);
                        let target = if self.forms[self.order.items[user]] == Form::Box { user } else { site[user] };
                        let crossed = effects_behind[step + 1] - effects_behind[target];
                        let nested = matches!(self.forms[self.order.items[user]], Form::Nested | Form::Condition);
                        let deep = if nested { depth[user] + 1 } else { 0 };
                        if crossed == 0 && deep <= MOST_NESTED {
                            site[step] = target;
                            depth[step] = deep;
                            Form::Nested
                        } else {
                            Form::Box
                        }
                    }
                    [_, ..] if forward && uses.iter().all(|used| used.power) && self.is_formula(block, uses) => {
                        Form::Condition
                    }
                    _ => Form::Box,
                };
                self.forms[item] = form;
                effect = form == Form::Box;
                if form == Form::Box {
                    self.main[item] = self.main_output(block, uses);
                }
            }
            effects_behind[step] = effects_behind[step + 1] + usize::from(effect);
        }
    }

    /// Whether a function can stand in an expression: without EN, ENO and power at its pins.
    fn is_formula(&self, block: &Block, uses: &[Use]) -> bool {
        let enabled = block.input("EN").is_some_and(|pin| !block.inputs[pin].sources.is_empty());
        let eno = block.output("ENO");
        let result = block.outputs.iter().position(|pin| !pin.name.text.eq_ignore_ascii_case("ENO"));
        block.instance.is_none()
            && self.scope.signatures.is_function(&block.type_name.text)
            && !enabled
            && uses.iter().all(|used| Some(used.output) != eno && Some(used.output) == result)
            && block.inputs.iter().any(|input| !input.sources.is_empty())
            && block
                .inputs
                .iter()
                .enumerate()
                .all(|(pin, input)| !takes_power(self.scope, block, pin) && (!input.in_out || input.sources.is_empty()))
    }

    fn main_output(&self, block: &Block, uses: &[Use]) -> Option<usize> {
        let used = |output: usize| uses.iter().any(|used| used.power && used.output == output);
        let plain = |output: &usize| !block.outputs[*output].negated;
        if let Some(eno) = block.output("ENO").filter(|eno| used(*eno)) {
            return Some(eno);
        }
        let first = self.scope.signatures.power_output(&block.type_name.text).and_then(|pin| block.output(&pin));
        let first =
            first.filter(|first| used(*first)).or_else(|| (0..block.outputs.len()).find(|output| used(*output)));
        first.filter(plain)
    }

    /// Makes the vertices of all elements.
    pub(super) fn build(&mut self) {
        let order = self.order;
        for item in &order.items {
            let diagram = self.diagram;
            match &diagram.items[*item].kind {
                ItemKind::Contact { operand, modifier, inputs } => self.contact(*item, operand, *modifier, inputs),
                ItemKind::Coil(coil) => self.coil(*item, coil),
                ItemKind::Block(block) => self.call(*item, block),
                ItemKind::Jump { label, inputs } => {
                    let kind = match label {
                        Some(label) => ElementKind::Jump { target: label.clone() },
                        None => ElementKind::Return,
                    };
                    let feeds = self.wired(*item, inputs);
                    self.add(*item, kind, feeds);
                }
                _ => {}
            }
        }
    }

    fn add(&mut self, item: usize, kind: ElementKind, feeds: Vec<Feed>) -> usize {
        let (span, y) = (self.diagram.items[item].span, self.diagram.items[item].y);
        let effect = !matches!(kind, ElementKind::Contact { .. } | ElementKind::Condition(_));
        self.vertices.push(Vertex { kind, feeds, pins: Vec::new(), item, span, y });
        let vertex = self.vertices.len() - 1;
        if effect {
            self.last = Some(vertex);
        }
        vertex
    }

    /// The power of wires that have to be there.
    fn wired(&mut self, item: usize, inputs: &[Source]) -> Vec<Feed> {
        let diagram = self.diagram;
        let element = &diagram.items[item];
        if inputs.is_empty() && !diagram.faulty.contains(&item) {
            let what = match &element.kind {
                ItemKind::Contact { .. } => "contact",
                ItemKind::Coil(coil) if coil.variable => "variable",
                ItemKind::Coil(_) => "coil",
                _ => "jump",
            };
            let message = format!("no wire reaches this {what} ({} {})", diagram.id_name, element.id);
            self.report.error(Code::NotConnected, element.span, message);
        }
        self.feeds(item, inputs)
    }

    /// The power of wires; without any, that of the left rail.
    fn feeds(&mut self, item: usize, inputs: &[Source]) -> Vec<Feed> {
        let mut feeds: Vec<Feed> = Vec::with_capacity(inputs.len());
        for source in inputs {
            let feed = self.feed(item, *source);
            if !feeds.contains(&feed) || inputs.len() > 256 {
                feeds.push(feed);
            }
        }
        if feeds.is_empty() {
            feeds.push(Feed::Rail);
        }
        feeds
    }

    fn feed(&mut self, user: usize, source: Source) -> Feed {
        match source {
            Source::Rail => Feed::Rail,
            Source::Power(item) => self.power[item].map_or(Feed::Rail, Feed::Vertex),
            Source::Output(item, output) if !self.negated(item, output) && self.main[item] == Some(output) => {
                match self.power[item] {
                    Some(vertex) => Feed::Vertex(vertex),
                    // Feedback.
                    None => self.read(user, source),
                }
            }
            Source::Output(item, output) if self.forms[item] == Form::Condition && self.power[item].is_some() => {
                let vertex = self.power[item].map_or(Feed::Rail, Feed::Vertex);
                if self.negated(item, output) { self.inverted(user, vec![vertex]) } else { vertex }
            }
            _ => self.read(user, source),
        }
    }

    fn negated(&self, item: usize, output: usize) -> bool {
        self.block(item).is_some_and(|block| block.outputs[output].negated)
    }

    /// A contact or formula that reads a value.
    fn read(&mut self, user: usize, source: Source) -> Feed {
        let value = self.value(source);
        let kind = match value.kind {
            ExpressionKind::Unary(UnaryOperator::Not, inner) if is_operand(&inner) => {
                ElementKind::Contact { kind: ContactKind::Closed, operand: *inner }
            }
            _ if is_operand(&value) => ElementKind::Contact { kind: ContactKind::Open, operand: value },
            _ => ElementKind::Condition(value),
        };
        Feed::Vertex(self.add(user, kind, vec![Feed::Rail]))
    }

    /// The power that is there where the other is not.
    fn inverted(&mut self, item: usize, feeds: Vec<Feed>) -> Feed {
        let span = self.diagram.items[item].span;
        let call = BlockCall {
            instance: Reference::of_name(Name::new(INVERTER, span)),
            type_name: None,
            arguments: Vec::new(),
            power_output: Some(Name::new("OUT", span)),
        };
        let vertex = self.add(item, ElementKind::Block(Box::new(call)), vec![Feed::Rail]);
        self.vertices[vertex].pins.push(PowerPin { name: Name::new("IN", span), feeds, place: 0 });
        Feed::Vertex(vertex)
    }

    /// Power after the modifier of a pin.
    fn modified(&mut self, item: usize, feeds: Vec<Feed>, modifier: Modifier, pin: &str) -> Vec<Feed> {
        let Some(edge) = modifier.edge else {
            return if modifier.negated { vec![self.inverted(item, feeds)] } else { feeds };
        };
        // The edge of what is inverted is the other edge.
        let rising = (edge == Edge::Rising) != modifier.negated;
        if let [Feed::Vertex(vertex)] = feeds.as_slice()
            && let Some(Vertex {
                kind: ElementKind::Contact { kind: kind @ ContactKind::Open, .. },
                feeds: rail,
                item: of,
                ..
            }) = self.vertices.get_mut(*vertex)
            && *of == item
            && rail == &[Feed::Rail]
        {
            *kind = if rising { ContactKind::Rising } else { ContactKind::Falling };
            return feeds;
        }
        let span = self.diagram.items[item].span;
        let block = if rising { "R_TRIG" } else { "F_TRIG" };
        let name = self.hidden_name(format!("_{block}{}_{pin}", self.diagram.items[item].id));
        let call = BlockCall {
            instance: Reference::of_name(Name::new(name, span)),
            type_name: Some(Name::new(block, span)),
            arguments: Vec::new(),
            power_output: None,
        };
        vec![Feed::Vertex(self.add(item, ElementKind::Block(Box::new(call)), feeds))]
    }

    fn contact(&mut self, item: usize, operand: &Expression, modifier: Modifier, inputs: &[Source]) {
        let feeds = self.wired(item, inputs);
        let kind = match (modifier.edge, modifier.negated) {
            (Some(edge), negated) if (edge == Edge::Rising) != negated => ContactKind::Rising,
            (Some(_), _) => ContactKind::Falling,
            (None, true) => ContactKind::Closed,
            (None, false) => ContactKind::Open,
        };
        let kind = match kind {
            ContactKind::Open if !is_operand(operand) => ElementKind::Condition(operand.clone()),
            ContactKind::Closed if !is_operand(operand) => ElementKind::Condition(negate(operand.clone())),
            kind => {
                if !is_operand(operand) {
                    self.report.not_supported("edge contact of an expression", self.diagram.items[item].span);
                }
                ElementKind::Contact { kind, operand: operand.clone() }
            }
        };
        self.power[item] = Some(self.add(item, kind, feeds));
    }

    fn coil(&mut self, item: usize, coil: &Coil) {
        if coil.variable && coil.inputs.is_empty() && coil.value.is_some() {
            return;
        }
        if !coil_takes_power(coil) && !coil.inputs.is_empty() {
            return self.assignment(item, coil);
        }
        let mut feeds = self.wired(item, &coil.inputs);
        let (negated, rising) = (coil.modifier.negated, coil.modifier.edge.map(|edge| edge == Edge::Rising));
        if negated && coil.storage.is_some() {
            feeds = vec![self.inverted(item, feeds)];
        }
        let set = coil.storage.map(|storage| storage == Storage::Set);
        let kind = ElementKind::Coil { kind: coil_kind(set, negated, rising), target: coil.target.clone() };
        self.power[item] = Some(self.add(item, kind, feeds));
    }

    /// A variable that takes a value.
    fn assignment(&mut self, item: usize, coil: &Coil) {
        let Some(source) = coil.inputs.first().copied() else { return };
        let mut feeds = vec![Feed::Rail];
        if let Source::Output(block_item, output) = source
            && self.forms[block_item] == Form::Box
            && let (Some(block), Some(vertex)) = (self.block(block_item), self.power[block_item])
        {
            let pin = &block.outputs[output];
            if self.last == Some(vertex)
                && !pin.negated
                && !coil.modifier.negated
                && let ElementKind::Block(call) = &mut self.vertices[vertex].kind
                && !call.arguments.iter().any(|wired| {
                    matches!(wired.wire, Wire::Output(_)) && wired.pin.text.eq_ignore_ascii_case(&pin.name.text)
                })
            {
                let span = self.diagram.items[item].span;
                call.arguments.push(Argument { pin: pin.name.clone(), wire: Wire::Output(coil.target.clone()), span });
                return;
            }
            // A function that did not run leaves the variable as it is.
            if block.instance.is_none() && block.input("EN").is_some_and(|pin| !block.inputs[pin].sources.is_empty()) {
                feeds.clone_from(&self.vertices[vertex].feeds);
            }
        }
        let value = self.value(source);
        let value = if coil.modifier.negated { negate(value) } else { value };
        self.add(item, ElementKind::Assignment { target: coil.target.clone(), value: Box::new(value) }, feeds);
    }

    fn call(&mut self, item: usize, block: &'d Block) {
        match self.forms[item] {
            Form::Nested => return,
            Form::Condition => {
                let formula = self.formula(item, block);
                self.power[item] = Some(self.add(item, ElementKind::Condition(formula), vec![Feed::Rail]));
                return;
            }
            Form::Box => {}
        }
        let span = self.diagram.items[item].span;
        let left = left_pin(self.scope, block);
        let mut feeds = vec![Feed::Rail];
        let (mut arguments, mut pins) = (Vec::new(), Vec::new());
        if let Some(left) = left {
            feeds = self.pin_power(item, block, left);
        }
        for (pin, input) in block.inputs.iter().enumerate() {
            if input.sources.is_empty() || left == Some(pin) {
                continue;
            }
            if takes_power(self.scope, block, pin) {
                let feeds = self.pin_power(item, block, pin);
                pins.push(PowerPin { name: input.name.clone(), feeds, place: arguments.len() });
                continue;
            }
            let Some(source) = input.sources.first() else { continue };
            let value = self.value(*source);
            let value = if input.modifier.negated { negate(value) } else { value };
            arguments.push(Argument { pin: input.name.clone(), wire: Wire::Value(value), span: input.name.span });
        }
        let name = &block.type_name;
        let (instance, type_name) = match &block.instance {
            Some(instance) => {
                // The power on the left would go to the first BOOL input; one without a wire keeps its value.
                let power = self.scope.signatures.power_input(&name.text);
                let open =
                    power.filter(|power| block.input(power).is_none_or(|pin| block.inputs[pin].sources.is_empty()));
                if let Some(open) = open {
                    let open = Name::new(open, span);
                    let value = read_member(instance, &open, span);
                    arguments.push(Argument { pin: open, wire: Wire::Value(value), span });
                }
                (instance.clone(), Some(name.clone()))
            }
            None => (Reference::of_name(name.clone()), None),
        };
        // What others read of a function, but for the power on its right.
        if block.instance.is_none() {
            for (output, pin) in block.outputs.iter().enumerate() {
                if self.is_read(item, output) {
                    let variable = self.keep(item, output);
                    let wire = Wire::Output(Reference::of_name(variable));
                    arguments.push(Argument { pin: pin.name.clone(), wire, span: pin.name.span });
                }
            }
        }
        let default = match &block.instance {
            Some(_) => self.scope.signatures.power_output(&name.text).and_then(|pin| block.output(&pin)),
            None => block.output("ENO"),
        };
        let main = self.main[item].filter(|main| Some(*main) != default);
        let power_output = main.map(|main| block.outputs[main].name.clone());
        let kind = ElementKind::Block(Box::new(BlockCall { instance, type_name, arguments, power_output }));
        let vertex = self.add(item, kind, feeds);
        self.vertices[vertex].pins = pins;
        self.power[item] = Some(vertex);
    }

    /// The power at a pin.
    fn pin_power(&mut self, item: usize, block: &'d Block, pin: usize) -> Vec<Feed> {
        let input = &block.inputs[pin];
        let mut modifier = input.modifier;
        // A counter sees edges itself; the mark only shows it. With EN, edges while it rests must not be kept.
        let counts = ["CU", "CD"].iter().any(|name| input.name.text.eq_ignore_ascii_case(name))
            && self.scope.signatures.is_standard(&block.type_name.text)
            && block.input("EN").is_none_or(|pin| block.inputs[pin].sources.is_empty());
        if counts && modifier == (Modifier { negated: false, edge: Some(Edge::Rising) }) {
            modifier.edge = None;
        }
        let feeds = self.feeds(item, &input.sources);
        self.modified(item, feeds, modifier, &input.name.text)
    }

    /// Whether an output of a function is read other than as the power on its right or by the wire that takes it at once.
    fn is_read(&self, item: usize, output: usize) -> bool {
        let step = self.order.step[item];
        let uses = self.uses.get(&item).map_or(&[][..], Vec::as_slice);
        let mut at_once = 0;
        let other = uses.iter().filter(|used| used.output == output).any(|used| {
            let behind = self.order.step[used.user] > step;
            let taken = behind && used.power && self.main[item] == Some(output) && !self.negated(item, output);
            let wired = behind && self.is_taken_at_once(item, used);
            at_once += usize::from(wired);
            !taken && !wired
        });
        // An output is wired once.
        other || at_once > 1
    }

    /// Whether a variable takes an output before anything else has an effect.
    fn is_taken_at_once(&self, item: usize, used: &Use) -> bool {
        let (Some(step), Some(user)) = (self.order.step[item], self.order.step[used.user]) else { return false };
        let simple = |item: usize| match &self.diagram.items[item].kind {
            ItemKind::Coil(coil) => !coil_takes_power(coil) && !coil.modifier.negated && coil.storage.is_none(),
            _ => false,
        };
        !used.power
            && simple(used.user)
            && !self.negated(item, used.output)
            && self.order.items[step + 1..user].iter().all(|between| {
                let of_this = matches!(&self.diagram.items[*between].kind, ItemKind::Coil(coil)
                    if matches!(coil.inputs.as_slice(), [Source::Output(block, output)]
                        if *block == item && !self.negated(item, *output)));
                simple(*between) && of_this
            })
    }

    /// The hidden variable that keeps what a function gives.
    fn keep(&mut self, item: usize, output: usize) -> Name {
        if let Some(place) = self.kept.get(&(item, output)) {
            return self.hidden[*place].name.clone();
        }
        let span = self.diagram.items[item].span;
        let Some(block) = self.block(item) else { return Name::new("_", span) };
        let id = self.diagram.items[item].id;
        let name = format!("_{}{id}_{}", block.type_name.text, block.outputs[output].name.text);
        let name = Name::new(self.hidden_name(name), span);
        let uses = self.uses.get(&item).map_or(&[][..], Vec::as_slice);
        // What is read before it is written holds its value from one scan to the next.
        let back = uses.iter().any(|used| used.output == output && self.order.step[used.user] <= self.order.step[item]);
        let class = if back { VariableClass::Memory } else { VariableClass::Temporary };
        self.looks.set(MOST_LOOKS);
        let ty = self.type_of(item, output, 0).unwrap_or_else(|| elementary(Elementary::Int, span));
        let variable =
            Variable { class, name: name.clone(), ty: Some(ty), address: None, initial: None, retain: false, span };
        self.kept.insert((item, output), self.hidden.len());
        self.hidden.push(variable);
        name
    }

    /// A name that the unit does not declare.
    fn hidden_name(&mut self, mut name: String) -> String {
        while self.scope.declares(&name) || !self.taken.insert(key(&name)) {
            name.push('_');
        }
        name
    }

    /// The type that a function gives: from its name, else its operands, else the variables that take it.
    fn type_of(&self, item: usize, output: usize, depth: usize) -> Option<TypeReference> {
        let block = self.block(item)?;
        let span = self.diagram.items[item].span;
        let mut operands = Vec::new();
        for (pin, input) in block.inputs.iter().enumerate() {
            let ty = match input.sources.as_slice() {
                _ if takes_power(self.scope, block, pin) => Some(elementary(Elementary::Bool, span)),
                [source] => self.source_type(*source, depth),
                _ => None,
            };
            operands.push((input.name.text.clone(), ty));
        }
        let given =
            self.scope.signatures.result(&block.type_name.text, &block.outputs[output].name.text, &operands, span);
        given.or_else(|| {
            let uses = self.uses.get(&item).map_or(&[][..], Vec::as_slice);
            uses.iter().filter(|used| used.output == output).find_map(|used| {
                match &self.diagram.items[used.user].kind {
                    _ if used.power => Some(elementary(Elementary::Bool, span)),
                    ItemKind::Coil(coil) => {
                        let kind = ExpressionKind::Read(coil.target.clone());
                        self.scope.value(&Expression { kind, span })
                    }
                    ItemKind::Block(user) => {
                        let pin = user.inputs.iter().find(|pin| pin.sources.contains(&Source::Output(item, output)))?;
                        self.scope.signatures.pin(&user.type_name.text, &pin.name.text, span)
                    }
                    _ => None,
                }
            })
        })
    }

    fn source_type(&self, source: Source, depth: usize) -> Option<TypeReference> {
        let looks = self.looks.get();
        if depth > MOST_NESTED || looks == 0 {
            return None;
        }
        self.looks.set(looks - 1);
        match source {
            Source::Rail | Source::Power(_) => None,
            Source::Value(item) => self.scope.value(value_of(&self.diagram.items[item].kind)?),
            Source::InOut(item, pin) => {
                let source = self.block(item)?.inputs[pin].sources.first()?;
                self.source_type(*source, depth + 1)
            }
            Source::Output(item, output) => {
                let block = self.block(item)?;
                let span = self.diagram.items[item].span;
                match &block.instance {
                    Some(_) => self.scope.signatures.pin(&block.type_name.text, &block.outputs[output].name.text, span),
                    None => match self.kept.get(&(item, output)) {
                        Some(place) => self.hidden[*place].ty.clone(),
                        None => self.type_of(item, output, depth + 1),
                    },
                }
            }
        }
    }

    /// What a wire of data carries.
    fn value(&mut self, source: Source) -> Expression {
        let truth = |span: Span| Expression { kind: ExpressionKind::Literal(Literal::Bool(true)), span };
        match source {
            Source::Rail => truth(Span::default()),
            Source::Power(item) => truth(self.diagram.items[item].span),
            Source::Value(item) => {
                let item = &self.diagram.items[item];
                value_of(&item.kind).cloned().unwrap_or_else(|| truth(item.span))
            }
            Source::InOut(item, pin) => {
                let source = self.block(item).and_then(|block| block.inputs[pin].sources.first().copied());
                match source {
                    Some(source @ Source::Value(_)) => self.value(source),
                    _ => truth(self.diagram.items[item].span),
                }
            }
            Source::Output(item, output) => {
                let span = self.diagram.items[item].span;
                let Some(block) = self.block(item) else { return truth(span) };
                let pin = &block.outputs[output];
                let value = match &block.instance {
                    _ if self.forms[item] != Form::Box => self.formula(item, block),
                    Some(instance) if !pin.name.text.eq_ignore_ascii_case("ENO") => {
                        read_member(instance, &pin.name, span)
                    }
                    _ => {
                        let variable = self.keep(item, output);
                        Expression { kind: ExpressionKind::Read(Reference::of_name(variable)), span }
                    }
                };
                if pin.negated { negate(value) } else { value }
            }
        }
    }

    /// A function as an expression. It nests no deeper than the forms allow.
    fn formula(&mut self, item: usize, block: &'d Block) -> Expression {
        let span = self.diagram.items[item].span;
        let mut operands: Vec<(Name, Expression)> = Vec::new();
        for input in &block.inputs {
            let Some(source) = input.sources.first() else { continue };
            let value = self.value(*source);
            operands.push((input.name.clone(), if input.modifier.negated { negate(value) } else { value }));
        }
        let function = (!self.scope.signatures.is_standard(&block.type_name.text)).then_some(None);
        let function = function.unwrap_or_else(|| Function::from_name(&block.type_name.text));
        let in_order = match function {
            Some(Function::Standard(function)) => {
                operands.len() >= function.parameters().len()
                    && operands.iter().enumerate().all(|(place, (pin, _))| function.place(&pin.text) == Some(place))
            }
            Some(_) => operands.len() == 1,
            None => false,
        };
        let operator = match function {
            Some(Function::Standard(function)) if in_order => operator(function),
            _ => None,
        };
        let kind = match (operator, operands.len()) {
            (Some(operator), 2) => {
                let mut values = operands.into_iter().map(|(_, value)| Box::new(value));
                match (values.next(), values.next()) {
                    (Some(left), Some(right)) => ExpressionKind::Binary(operator, left, right),
                    _ => ExpressionKind::Array(Vec::new()),
                }
            }
            (_, 1) if in_order && function == Some(Function::Standard(StandardFunction::Not)) => {
                return negate(operands.remove(0).1);
            }
            _ => {
                let arguments = operands
                    .into_iter()
                    .map(|(name, value)| FunctionArgument { parameter: (!in_order).then_some(name), value });
                ExpressionKind::Call { function: block.type_name.clone(), arguments: arguments.collect() }
            }
        };
        Expression { kind, span }
    }
}

/// The pin that takes the power on the left of a box.
fn left_pin(scope: &Scope<'_>, block: &Block) -> Option<usize> {
    let wired = |pin: &usize| !block.inputs[*pin].sources.is_empty();
    let enable = block.input("EN").filter(wired);
    enable.or_else(|| {
        block.instance.as_ref()?;
        let first = scope.signatures.power_input(&block.type_name.text)?;
        block.input(&first).filter(wired)
    })
}

/// Whether a pin takes power rather than a value.
fn takes_power(scope: &Scope<'_>, block: &Block, pin: usize) -> bool {
    let input = &block.inputs[pin];
    let many = input.sources.len() > 1;
    let power = input.sources.iter().any(|source| matches!(source, Source::Power(_)));
    !input.in_out && (many || power || input.modifier.edge.is_some() || left_pin(scope, block) == Some(pin))
}

/// Whether a variable takes power rather than a value.
fn coil_takes_power(coil: &Coil) -> bool {
    let data = matches!(coil.inputs.as_slice(), [Source::Value(_) | Source::Output(..) | Source::InOut(..)]);
    !coil.variable || coil.modifier.edge.is_some() || coil.storage.is_some() || !(data || coil.inputs.is_empty())
}

/// Whether a contact can stand for it.
fn is_operand(value: &Expression) -> bool {
    matches!(value.kind, ExpressionKind::Read(_) | ExpressionKind::Literal(Literal::Bool(_)))
}

/// What an element gives as a variable or value.
pub(super) fn value_of(kind: &ItemKind) -> Option<&Expression> {
    match kind {
        ItemKind::Value(value) | ItemKind::Coil(Coil { value: Some(value), .. }) => Some(value),
        _ => None,
    }
}

fn read_member(instance: &Reference, member: &Name, span: Span) -> Expression {
    let mut reference = instance.clone();
    reference.steps.push(Step::Member(member.clone()));
    Expression { kind: ExpressionKind::Read(reference), span }
}

/// The operator that a function of two operands is.
fn operator(function: StandardFunction) -> Option<BinaryOperator> {
    Some(match function {
        StandardFunction::Add => BinaryOperator::Add,
        StandardFunction::Subtract => BinaryOperator::Subtract,
        StandardFunction::Multiply => BinaryOperator::Multiply,
        StandardFunction::Divide => BinaryOperator::Divide,
        StandardFunction::Modulo => BinaryOperator::Modulo,
        StandardFunction::And => BinaryOperator::And,
        StandardFunction::Or => BinaryOperator::Or,
        StandardFunction::Xor => BinaryOperator::Xor,
        StandardFunction::Greater => BinaryOperator::Greater,
        StandardFunction::GreaterOrEqual => BinaryOperator::GreaterOrEqual,
        StandardFunction::Equal => BinaryOperator::Equal,
        StandardFunction::LessOrEqual => BinaryOperator::LessOrEqual,
        StandardFunction::Less => BinaryOperator::Less,
        StandardFunction::NotEqual => BinaryOperator::NotEqual,
        _ => return None,
    })
}
