//! What the rungs use that decides which slots there are.
//!
//! An input pin of a standard block has a slot only if someone can tell: because a call leaves it unwired, so that it
//! keeps its value, because the instance is called at more than one place, or because a rung reads or writes the pin as a
//! member. What is said here of a variable holds for it in every instance of its unit.

use std::collections::{HashMap, HashSet};

use crate::check::{
    Call, Callee, Checked, Circuit, Element, Expression, ExpressionKind, Index, Output, PinId, Place, Statement, Step,
    UnitId, UnitKind, VariableId, Wire,
};
use crate::ladder::library::StandardBlock;
use crate::ladder::{CoilKind, ContactKind};
use crate::source::Span;

/// A declaration of block instances: a variable, or a member of the structure that it is.
type Declaration = (VariableId, Vec<usize>);

/// What the rungs of all units use.
#[derive(Default)]
pub(super) struct Used {
    pins: HashMap<Declaration, Pins>,
    /// Variables that are reached under other names.
    whole: HashSet<VariableId>,
    /// For each unit, for each of its rungs, how many edge contacts and edge coils it has.
    pub(super) edges: Vec<Vec<u32>>,
    /// The functions that are called.
    pub(super) functions: HashSet<UnitId>,
    /// The first rung of a program with a jump.
    pub(super) jump: Option<Span>,
    /// Whether an index is computed.
    pub(super) computed_index: bool,
}

#[derive(Default)]
struct Pins {
    kept: HashSet<usize>,
    called: bool,
}

impl Used {
    /// Walks all rungs.
    pub(super) fn find(checked: &Checked) -> Self {
        let mut used = Self::default();
        for unit in checked.units() {
            let mut edges = Vec::new();
            for rung in &unit.rungs {
                let mut walk = Walk { used: &mut used, edges: 0, jumps: false };
                walk.circuit(&rung.circuit);
                edges.push(walk.edges);
                if walk.jumps && unit.kind == UnitKind::Program {
                    used.jump.get_or_insert(rung.span);
                }
            }
            used.edges.push(edges);
        }
        used
    }

    /// Whether an input of the block instances of a declaration needs a slot.
    pub(super) fn keeps(&self, declaration: &Declaration, pin: usize) -> bool {
        let kept = |pins: &Pins| pins.kept.contains(&pin);
        // Of one that is never called, nothing is wired.
        self.whole.contains(&declaration.0) || self.pins.get(declaration).is_none_or(|pins| !pins.called || kept(pins))
    }
}

struct Walk<'a> {
    used: &'a mut Used,
    edges: u32,
    jumps: bool,
}

impl Walk<'_> {
    fn circuit(&mut self, circuit: &Circuit) {
        for element in circuit.branches.iter().flat_map(|branch| &branch.elements) {
            match element {
                Element::Contact { kind, operand } => {
                    self.edges += u32::from(matches!(kind, ContactKind::Rising | ContactKind::Falling));
                    self.expression(operand);
                }
                Element::Coil { kind, target } => {
                    self.edges += u32::from(matches!(kind, CoilKind::Rising | CoilKind::Falling));
                    self.place(target);
                }
                Element::Call(call) => self.call(call),
                Element::Condition(condition) => self.expression(condition),
                Element::Assignment { target, value } => {
                    self.place(target);
                    self.expression(value);
                }
                Element::Statements(statements) => self.statements(statements),
                Element::Parallel(circuit) => self.circuit(circuit),
                Element::Jump(_) | Element::Return => self.jumps = true,
            }
        }
    }

    fn statements(&mut self, statements: &[Statement]) {
        for statement in statements {
            match statement {
                Statement::Assignment { target, value } => {
                    self.place(target);
                    self.expression(value);
                }
                Statement::Copy { target, source, done } => {
                    if let Some(done) = done {
                        self.place(done);
                    }
                    self.alias(target);
                    self.alias(source);
                }
                Statement::Call(call) => self.call(call),
                Statement::If { branches, otherwise } => {
                    for (condition, body) in branches {
                        self.expression(condition);
                        self.statements(body);
                    }
                    self.statements(otherwise);
                }
                Statement::Case { selector, branches, otherwise } => {
                    self.expression(selector);
                    branches.iter().for_each(|(_, body)| self.statements(body));
                    self.statements(otherwise);
                }
                Statement::For { variable, body, .. } => {
                    self.place(variable);
                    self.statements(body);
                }
                Statement::Exit => {}
                Statement::Return => self.jumps = true,
            }
        }
    }

    fn call(&mut self, call: &Call) {
        match &call.callee {
            Callee::Standard(block, place) => {
                self.place(place);
                self.standard(*block, place, call);
            }
            Callee::Unit(_, place) => self.place(place),
            Callee::Function(..) => {}
            Callee::UserFunction(unit) => {
                self.used.functions.insert(*unit);
            }
        }
        call.enable.iter().for_each(|wire| self.wire(wire));
        call.inputs.iter().for_each(|input| self.wire(&input.wire));
        call.references.iter().for_each(|(_, place)| self.alias(place));
        call.outputs.iter().for_each(|(_, place): &(Output, Place)| self.place(place));
    }

    fn standard(&mut self, block: StandardBlock, place: &Place, call: &Call) {
        let pins = self.used.pins.entry(declaration(place)).or_default();
        // A call may stand in a circuit at another call's pin, of the same instance even.
        let called_before = std::mem::replace(&mut pins.called, true);
        for pin in 0..block.inputs().len() {
            let wired = call.power_input == Some(pin) || call.inputs.iter().any(|input| input.pin == pin);
            if called_before || !wired {
                pins.kept.insert(pin);
            }
        }
    }

    fn wire(&mut self, wire: &Wire) {
        match wire {
            Wire::Value(expression) => self.expression(expression),
            Wire::Circuit(circuit) => self.circuit(circuit),
        }
    }

    fn expression(&mut self, expression: &Expression) {
        match &expression.kind {
            ExpressionKind::Constant(_) => {}
            ExpressionKind::Read(place) => self.place(place),
            ExpressionKind::Unary(_, operand) | ExpressionKind::Widen(operand) => self.expression(operand),
            ExpressionKind::Binary(_, left, right) => {
                self.expression(left);
                self.expression(right);
            }
            ExpressionKind::UserCall { unit, arguments, references } => {
                self.used.functions.insert(*unit);
                arguments.iter().flatten().for_each(|argument| self.expression(argument));
                references.iter().for_each(|place| self.alias(place));
            }
            ExpressionKind::Call { arguments, .. } => arguments.iter().for_each(|argument| self.expression(argument)),
        }
    }

    /// A place that is reached under another name from here on.
    fn alias(&mut self, place: &Place) {
        self.place(place);
        self.used.whole.insert(declaration(place).0);
    }

    fn place(&mut self, place: &Place) {
        for step in &place.path {
            let Step::Element(indices) = step else { continue };
            for index in indices {
                if let Index::Computed(expression) = index {
                    self.used.computed_index = true;
                    self.expression(expression);
                }
            }
        }
        if let Some(Step::Pin(PinId::Input(pin))) = place.path.last() {
            self.used.pins.entry(declaration(place)).or_default().kept.insert(*pin);
        }
    }
}

/// The declaration of the instances that a place is one of, or a pin of.
fn declaration(place: &Place) -> Declaration {
    place.path.iter().fold((place.variable, Vec::new()), |(variable, mut fields), step| match step {
        Step::Variable(variable) => (*variable, Vec::new()),
        Step::Field(field) => {
            fields.push(*field);
            (variable, fields)
        }
        Step::Pin(_) | Step::Element(_) => (variable, fields),
    })
}
