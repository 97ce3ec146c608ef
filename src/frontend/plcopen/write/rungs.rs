//! Rungs as networks: each element of a branch becomes an element of the drawing, wired to all that power comes from.

use std::collections::HashMap;

use super::drawing::{Drawing, Input, Point, Shape, Source, width_of};
use super::order::{Step, Touched, is_kept};
use super::pins::{self, Callee, Scope};
use crate::frontend::graph::types::Signatures;
use crate::frontend::structured_text::print::Words;
use crate::frontend::uses;
use crate::ladder::{
    Argument, Branch, Circuit, CoilKind, ContactKind, Element, ElementKind, Expression, ExpressionKind, Program,
    Reference, Root, Rung, Unit, Wire,
};

/// Where the left rails stand, and how far elements are apart.
const RAIL: i32 = 40;
const GAP: i32 = 40;
/// How far apart rungs are, and how far a title stands above its rung.
const BETWEEN: i32 = 40;
/// The longest title that is written as one.
const LONGEST_TITLE: usize = 100;

/// The rungs of a unit as a drawing that runs them in their order; `None` where LD cannot say them.
pub(super) fn draw(program: &Program, unit: &Unit, signatures: &Signatures, words: Words<'_>) -> Option<Drawing> {
    let scope = Scope::new(program, unit, signatures);
    // What stands behind a box with outputs runs after them if it is drawn below them; that takes more room.
    [false, true].into_iter().find_map(|stepped| {
        let mut artist = Artist::new(&scope, words, stepped);
        artist.unit(unit)?;
        let steps = artist.finished();
        is_kept(&artist.drawing, &steps).then_some(artist.drawing)
    })
}

struct Artist<'p> {
    scope: &'p Scope<'p>,
    words: Words<'p>,
    stepped: bool,
    drawing: Drawing,
    /// What runs, in the order of the rungs.
    steps: Vec<Step>,
    /// Whether each element gives to another.
    used: Vec<bool>,
    rung: usize,
    rail: Point,
    nodes: HashMap<String, Point>,
}

/// Where the next element stands.
#[derive(Clone, Copy)]
struct Place {
    row: usize,
    x: i32,
}

impl<'p> Artist<'p> {
    fn new(scope: &'p Scope<'p>, words: Words<'p>, stepped: bool) -> Self {
        Self {
            scope,
            words,
            stepped,
            drawing: Drawing::default(),
            steps: Vec::new(),
            used: Vec::new(),
            rung: 0,
            rail: Vec::new(),
            nodes: HashMap::new(),
        }
    }

    /// The steps but for contacts that lead nowhere, which do nothing.
    fn finished(&mut self) -> Vec<Step> {
        let used = std::mem::take(&mut self.used);
        let does = |step: &Step| step.touched.leaves || !step.touched.writes.is_empty() || used[step.element];
        std::mem::take(&mut self.steps).into_iter().filter(does).collect()
    }

    fn unit(&mut self, unit: &Unit) -> Option<()> {
        let mut targets = Vec::new();
        for rung in &unit.rungs {
            jumps(&rung.circuit, &mut targets);
        }
        for (number, rung) in unit.rungs.iter().enumerate() {
            self.rung = number;
            let is_target = rung.name.as_ref().is_some_and(|name| targets.contains(&name.key()));
            self.rung(rung, is_target)?;
        }
        Some(())
    }

    fn rung(&mut self, rung: &Rung, is_target: bool) -> Option<()> {
        if !rung.enabled {
            return None;
        }
        let name = rung.name.as_ref().map(|name| name.text.as_str());
        let parts = [name.filter(|_| !is_target), rung.title.as_deref()];
        let title = parts.into_iter().flatten().collect::<Vec<_>>().join(": ");
        let mut apart = BETWEEN;
        if let (Some(name), true) = (name, is_target) {
            let row = self.drawing.row(apart);
            let label = Shape::Label(self.words.names.spell(name).into_owned());
            self.add(label, Vec::new(), Place { row, x: RAIL }, 0);
            apart = 0;
        }
        if !title.is_empty() {
            let row = self.drawing.row(apart);
            let short: String = title.chars().take(LONGEST_TITLE).collect();
            self.add(Shape::Comment(short), Vec::new(), Place { row, x: RAIL }, 0);
            apart = 0;
        }
        let row = self.drawing.row(apart);
        let rail = self.add(Shape::LeftRail, Vec::new(), Place { row, x: RAIL }, 0);
        self.rail = vec![Source { id: rail, output: 0 }];
        self.nodes.clear();
        self.circuit(&rung.circuit, &self.rail.clone(), Place { row, x: RAIL + GAP })?;
        Some(())
    }

    fn add(&mut self, shape: Shape, wires: Point, place: Place, down: i32) -> usize {
        let inside = match &shape {
            Shape::Block { inputs, in_outs, .. } => {
                inputs.iter().chain(in_outs).flat_map(|input| &input.wires).collect()
            }
            _ => Vec::new(),
        };
        for wire in wires.iter().chain(inside) {
            self.used[wire.id] = true;
        }
        self.used.push(false);
        self.drawing.add(shape, wires, place.row, place.x, down)
    }

    /// The power on the right of a circuit, and where its widest branch ends.
    fn circuit(&mut self, circuit: &Circuit, left: &Point, place: Place) -> Option<(Point, Place)> {
        let mut right = Point::new();
        let mut end = place;
        for (number, branch) in circuit.branches.iter().enumerate() {
            let row = if number == 0 { place.row } else { self.drawing.row(0) };
            let (power, after) = self.branch(branch, left, Place { row, ..place })?;
            end.x = end.x.max(after.x);
            if number == 0 {
                end.row = after.row;
            }
            match &branch.to {
                Some(node) => join(self.nodes.entry(node.key()).or_default(), power),
                None => join(&mut right, power),
            }
        }
        // Behind boxes that were stepped down from, the next row is that of the last of them.
        if self.stepped && circuit.branches.len() > 1 && end.row != place.row {
            end.row = self.drawing.row(0);
        }
        Some((right, end))
    }

    fn branch(&mut self, branch: &Branch, left: &Point, mut place: Place) -> Option<(Point, Place)> {
        let mut power = match &branch.from {
            Some(node) => self.nodes.get(&node.key())?.clone(),
            None => left.clone(),
        };
        for element in &branch.elements {
            if power.is_empty() {
                return None;
            }
            (power, place) = self.element(element, power, place)?;
        }
        Some((power, place))
    }

    fn element(&mut self, element: &Element, power: Point, place: Place) -> Option<(Point, Place)> {
        match &element.kind {
            ElementKind::Contact { kind, operand } => {
                let attributes: &[_] = match kind {
                    ContactKind::Open => &[("negated", "false")],
                    ContactKind::Closed => &[("negated", "true")],
                    ContactKind::Rising => &[("negated", "false"), ("edge", "rising")],
                    ContactKind::Falling => &[("negated", "false"), ("edge", "falling")],
                };
                Some(self.contact(self.words.expression(operand), attributes, operand, power, place))
            }
            ElementKind::Condition(condition) => {
                let text = self.words.expression(condition);
                let is_bare = matches!(condition.kind, ExpressionKind::Read(_) | ExpressionKind::Call { .. });
                let text = if is_bare { text } else { format!("({text})") };
                Some(self.contact(text, &[("negated", "false")], condition, power, place))
            }
            ElementKind::Coil { kind, target } => {
                let attributes: &[_] = match kind {
                    CoilKind::Plain => &[("negated", "false")],
                    CoilKind::Negated => &[("negated", "true")],
                    CoilKind::Set => &[("negated", "false"), ("storage", "set")],
                    CoilKind::Reset => &[("negated", "false"), ("storage", "reset")],
                    CoilKind::Rising => &[("negated", "false"), ("edge", "rising")],
                    CoilKind::Falling => &[("negated", "false"), ("edge", "falling")],
                };
                let variable = self.words.reference(target);
                let width = width_of(&variable);
                let shape = Shape::Coil { variable, attributes };
                let coil = self.add(shape, power, centred(place, width), 0);
                let touched = self.written(target);
                self.step(coil, touched);
                Some((vec![Source { id: coil, output: 0 }], after(place, width)))
            }
            ElementKind::Parallel(inner) => self.circuit(inner, &power, place),
            ElementKind::Block(call) => {
                let callee = pins::callee(self.scope, call)?;
                self.call(call, &callee, power, place)
            }
            ElementKind::Assignment { target, value } => self.assignment(target, value, power, place),
            ElementKind::Jump { target } => {
                let label = self.words.names.spell(&target.text).into_owned();
                Some(self.leave(Shape::Jump(label), power, place))
            }
            ElementKind::Return => Some(self.leave(Shape::Return, power, place)),
            ElementKind::Statements(_) => None,
        }
    }

    fn contact(
        &mut self,
        variable: String,
        attributes: &'static [(&'static str, &'static str)],
        operand: &Expression,
        power: Point,
        place: Place,
    ) -> (Point, Place) {
        let width = width_of(&variable);
        let contact = self.add(Shape::Contact { variable, attributes }, power, centred(place, width), 0);
        let mut touched = Touched::default();
        self.reads(operand, &mut touched);
        self.step(contact, touched);
        (vec![Source { id: contact, output: 0 }], after(place, width))
    }

    fn leave(&mut self, shape: Shape, power: Point, place: Place) -> (Point, Place) {
        let width = shape.width();
        let element = self.add(shape, power, place, 0);
        self.step(element, Touched { leaves: true, ..Touched::default() });
        (Point::new(), after(place, width))
    }

    /// `{x := e}`: with power on the rail a wire from the value to the variable, else a MOVE that power enables.
    fn assignment(
        &mut self,
        target: &Reference,
        value: &Expression,
        power: Point,
        place: Place,
    ) -> Option<(Point, Place)> {
        let mut computed_index = false;
        uses::reference(target, &mut |mentioned| computed_index |= uses::has_computed_index(mentioned));
        uses::expression(value, &mut |mentioned| computed_index |= uses::has_computed_index(mentioned));
        let text = self.words.expression(value);
        let variable = self.words.reference(target);
        let mut touched = self.written(target);
        self.reads(value, &mut touched);
        if power == self.rail && !computed_index {
            let from = Shape::InVariable(text);
            let width = from.width();
            let from = self.add(from, Vec::new(), place, 0);
            let next = after(place, width);
            let to = Shape::OutVariable(variable);
            let width = to.width();
            let to = self.add(to, vec![Source { id: from, output: 0 }], next, 0);
            self.step(to, touched);
            return Some((power, after(next, width)));
        }
        let inputs = vec![("EN".to_owned(), Given::Power(power)), ("IN".to_owned(), Given::Text(text))];
        let outputs = vec!["ENO".to_owned(), "OUT".to_owned()];
        let targets = vec![(1, variable, self.written(target))];
        let call = Drawn { name: "MOVE".to_owned(), instance: None, inputs, in_outs: Vec::new(), outputs, targets };
        Some(self.block(call, touched, 0, place))
    }

    fn call(
        &mut self,
        call: &crate::ladder::BlockCall,
        callee: &Callee,
        power: Point,
        place: Place,
    ) -> Option<(Point, Place)> {
        let named = |pin: &str| call.arguments.iter().any(|argument| argument.pin.text.eq_ignore_ascii_case(pin));
        let left = match &callee.power_input {
            Some(pin) if !callee.is_function && !named(pin) => pin.clone(),
            _ => "EN".to_owned(),
        };
        if named(&left) {
            return None;
        }
        let right = match (&call.power_output, &callee.power_output) {
            (Some(chosen), _) => chosen.text.to_string(),
            (None, Some(pin)) if !callee.is_function => pin.clone(),
            _ => "ENO".to_owned(),
        };
        let mut touched = Touched::default();
        if callee.is_own {
            touched.reads.insert(None);
            touched.writes.insert(None);
        }
        if !callee.is_function {
            self.touch(&call.instance, true, &mut touched);
        }
        // What takes the output of an instance keeps its value while EN is FALSE only if it is read at once.
        let at_once = !callee.is_function && left == "EN";
        let mut given: Vec<(String, Given)> = vec![(left, Given::Power(power))];
        let mut outputs: Vec<(String, String, Touched)> = Vec::new();
        let mut place = place;
        for (number, Argument { pin, wire, .. }) in call.arguments.iter().enumerate() {
            let pin = if pin.text.chars().any(char::is_alphabetic) {
                pin.text.to_string()
            } else {
                pins::parameter(&callee.name, number)
            };
            match wire {
                Wire::Value(value) => {
                    self.reads(value, &mut touched);
                    let in_out = callee.in_outs.iter().any(|known| known.eq_ignore_ascii_case(&pin));
                    if let (true, ExpressionKind::Read(reference)) = (in_out, &value.kind) {
                        self.touch(reference, true, &mut touched);
                    }
                    given.push((pin, Given::Text(self.words.expression(value))));
                }
                Wire::Circuit(inner) => {
                    let row = self.drawing.row(0);
                    let rail = self.rail.clone();
                    let (power, end) = self.circuit(inner, &rail, Place { row, x: place.x })?;
                    if power.is_empty() {
                        return None;
                    }
                    place.x = place.x.max(end.x);
                    given.push((pin, Given::Power(power)));
                }
                Wire::Output(target) => {
                    let mut pin = pin;
                    if callee.is_function && pin.eq_ignore_ascii_case(&callee.name) {
                        pin = "OUT".to_owned();
                    }
                    let mut touched = Touched { leaves: at_once, ..self.written(target) };
                    if !callee.is_function {
                        self.touch(&call.instance, false, &mut touched);
                    }
                    outputs.push((pin, self.words.reference(target), touched));
                }
            }
        }
        let is = |one: &str, other: &str| one.eq_ignore_ascii_case(other);
        let mut inputs: Vec<(String, Given)> = Vec::new();
        let mut in_outs: Vec<(String, Given)> = Vec::new();
        let mut take = |pin: &str| given.iter().position(|(name, _)| is(name, pin)).map(|at| given.swap_remove(at).1);
        inputs.extend(take("EN").map(|wired| ("EN".to_owned(), wired)));
        let enabled = !inputs.is_empty() || is(&right, "ENO") || outputs.iter().any(|(pin, ..)| is(pin, "ENO"));
        for pin in &callee.inputs {
            inputs.push((self.pin(pin), take(pin).unwrap_or(Given::Nothing)));
        }
        for pin in &callee.in_outs {
            in_outs.push((self.pin(pin), take(pin).unwrap_or(Given::Nothing)));
        }
        // Inputs of functions that take any number of them.
        given.sort_by_key(|(pin, _)| pin.trim_start_matches(|c: char| !c.is_ascii_digit()).parse::<u32>().unwrap_or(0));
        inputs.extend(given);
        let mut pins: Vec<String> = if enabled { vec!["ENO".to_owned()] } else { Vec::new() };
        pins.extend(callee.outputs.iter().cloned());
        let at = |pin: &str| pins.iter().position(|known| is(known, pin));
        let mut targets = Vec::new();
        for (pin, target, touched) in outputs {
            targets.push((at(&pin)?, target, touched));
        }
        targets.sort_by_key(|(pin, ..)| *pin);
        let right = at(&right)?;
        let outputs = pins.iter().map(|pin| self.pin(pin)).collect();
        let instance = (!callee.is_function).then(|| self.words.reference(&call.instance));
        let name = self.words.names.spell_function(&callee.name).into_owned();
        let call = Drawn { name, instance, inputs, in_outs, outputs, targets };
        Some(self.block(call, touched, right, place))
    }

    /// A box with what is wired to it; the result is the power of one of its outputs.
    fn block(&mut self, call: Drawn, mut touched: Touched, right: usize, mut place: Place) -> (Point, Place) {
        let texts = call.inputs.iter().chain(&call.in_outs).filter_map(|(_, given)| match given {
            Given::Text(text) => Some(width_of(text)),
            _ => None,
        });
        let room = texts.max().map_or(0, |width| width + GAP / 2);
        let at = Place { x: place.x + room, ..place };
        let mut inputs = [Vec::new(), Vec::new()];
        let mut pin = 0;
        for (list, given) in inputs.iter_mut().zip([call.inputs, call.in_outs]) {
            for (name, given) in given {
                let wires = match given {
                    Given::Power(power) => power,
                    Given::Nothing => Vec::new(),
                    Given::Text(text) => {
                        let x = at.x - GAP / 2 - width_of(&text);
                        let value = self.add(Shape::InVariable(text), Vec::new(), Place { x, ..place }, pin);
                        vec![Source { id: value, output: 0 }]
                    }
                };
                list.push(Input { name, wires });
                pin += 1;
            }
        }
        let [inputs, in_outs] = inputs;
        let shape = Shape::Block { name: call.name, instance: call.instance, inputs, in_outs, outputs: call.outputs };
        let width = shape.width();
        let block = self.add(shape, Vec::new(), at, 0);
        if call.targets.is_empty() {
            place = after(at, width);
        } else {
            let mut widest = 0;
            // Only the wires that leave it tell the order: the box itself runs when the first of them is followed.
            touched.writes.insert(Some(format!("#{block}")));
            for (output, target, mut written) in call.targets {
                written.reads.insert(Some(format!("#{block}")));
                let shape = Shape::OutVariable(target);
                widest = widest.max(shape.width());
                let wires = vec![Source { id: block, output }];
                let down = i32::try_from(output).unwrap_or(0);
                let variable = self.add(shape, wires, Place { x: at.x + width + GAP / 2, ..at }, down);
                self.step(variable, written);
            }
            place = Place { x: at.x + width + GAP / 2 + widest + GAP, ..at };
            if self.stepped {
                place = Place { row: self.drawing.row(0), x: at.x + width + GAP / 2 };
            }
        }
        self.before(block, touched);
        (vec![Source { id: block, output: right }], place)
    }

    fn step(&mut self, element: usize, touched: Touched) {
        self.steps.push(Step { element, rung: self.rung, touched });
    }

    /// The step of a box, before those of the variables that take what it gives.
    fn before(&mut self, block: usize, touched: Touched) {
        let behind = self.steps.iter().rev().take_while(|step| step.element > block).count();
        let at = self.steps.len() - behind;
        self.steps.insert(at, Step { element: block, rung: self.rung, touched });
    }

    /// The name of a pin: EN and ENO are keywords too.
    fn pin(&self, pin: &str) -> String {
        let is_enable = pin.eq_ignore_ascii_case("EN") || pin.eq_ignore_ascii_case("ENO");
        if is_enable { pin.to_owned() } else { self.words.names.spell(pin).into_owned() }
    }

    fn written(&self, target: &Reference) -> Touched {
        let mut touched = Touched::default();
        self.touch(target, true, &mut touched);
        touched
    }

    fn reads(&self, value: &Expression, touched: &mut Touched) {
        uses::expression(value, &mut |mentioned| match mentioned {
            uses::Use::Reference(reference) => self.touch_root(reference, false, touched),
            uses::Use::Function(name) if self.scope.unit(&name.text).is_some() => {
                touched.reads.insert(None);
                touched.writes.insert(None);
            }
            _ => {}
        });
    }

    fn touch(&self, reference: &Reference, writes: bool, touched: &mut Touched) {
        self.touch_root(reference, writes, touched);
        uses::reference(reference, &mut |mentioned| {
            if let uses::Use::Reference(inner) = mentioned {
                self.touch_root(inner, false, touched);
            }
        });
    }

    fn touch_root(&self, reference: &Reference, writes: bool, touched: &mut Touched) {
        let storage = match &reference.root {
            Root::Name(name) => self.scope.storage(&name.text),
            Root::Address(_) => None,
        };
        if writes {
            touched.writes.insert(storage);
        } else {
            touched.reads.insert(storage);
        }
    }
}

/// What is wired to an input.
enum Given {
    Nothing,
    Text(String),
    Power(Point),
}

/// A box that is to be drawn.
struct Drawn {
    name: String,
    instance: Option<String>,
    inputs: Vec<(String, Given)>,
    in_outs: Vec<(String, Given)>,
    outputs: Vec<String>,
    /// The variables that take its outputs, by their places.
    targets: Vec<(usize, String, Touched)>,
}

fn join(point: &mut Point, more: Point) {
    for source in more {
        if !point.contains(&source) {
            point.push(source);
        }
    }
}

/// The place behind something so wide.
fn after(place: Place, width: i32) -> Place {
    Place { x: place.x.saturating_add(width.max(21) + GAP), ..place }
}

/// Where a contact or coil stands under its name.
fn centred(place: Place, width: i32) -> Place {
    Place { x: place.x + (width - 21).max(0) / 2, ..place }
}

/// The keys of all rungs that a circuit jumps to.
fn jumps(circuit: &Circuit, targets: &mut Vec<String>) {
    for element in circuit.branches.iter().flat_map(|branch| &branch.elements) {
        match &element.kind {
            ElementKind::Jump { target } => targets.push(target.key()),
            ElementKind::Parallel(inner) => jumps(inner, targets),
            _ => {}
        }
    }
}
