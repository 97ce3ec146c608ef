//! A slot for everything that a scan leaves behind: variables, pins, what blocks and edges remember.
//!
//! An input pin has a slot only if someone can tell: because a call leaves it unwired, so that it keeps its value,
//! because the instance is called more than once, or because a rung reads or writes the pin as a member. Names of slots must depend on nothing but the names in the
//! program and the place within a rung, so that an edit elsewhere moves no slot.

use std::collections::HashSet;

use super::blocks;
use crate::check::{
    Call, Callee, Checked, Circuit, Element, Expression, ExpressionKind, PinId, Place, Step, Type, Variable,
    VariableId, Wire,
};
use crate::elementary::{Elementary, Value};
use crate::ladder::library::StandardBlock;
use crate::ladder::{self, CoilKind, ContactKind, VariableClass};
use crate::logic::image::{EarlierLayout, ImageTooLarge};
use crate::logic::{Area, Layout, LayoutBuilder, Slot, SlotId};
use crate::source::Span;

/// The slots of one program.
pub(super) struct Slots {
    /// One entry a variable, in their order.
    pub(super) variables: Vec<VariableSlots>,
    /// The memory of each edge contact and edge coil, in the order of the drawing.
    pub(super) edges: Vec<SlotId>,
    /// Where execution goes on after the last jump that was taken in this scan, if there are jumps.
    jump: Option<SlotId>,
}

/// The slots of one variable.
pub(super) enum VariableSlots {
    /// A value.
    Value(SlotId),
    /// A block instance.
    Instance(InstanceSlots),
}

/// The slots of one block instance.
#[derive(Clone, Default)]
pub(super) struct InstanceSlots {
    /// One entry an input; `None` where nobody could tell.
    pub(super) inputs: Vec<Option<SlotId>>,
    /// One entry an output.
    pub(super) outputs: Vec<SlotId>,
    /// One entry a state of the block's rule.
    pub(super) states: Vec<SlotId>,
}

impl Slots {
    /// The slots of a block instance.
    pub(super) fn instance(&self, id: VariableId) -> &InstanceSlots {
        match &self.variables[id.index()] {
            VariableSlots::Instance(slots) => slots,
            VariableSlots::Value(_) => unreachable!("the checker makes calls of instances only"),
        }
    }

    /// Where execution goes on after the last jump that was taken in this scan.
    pub(super) fn jump(&self) -> SlotId {
        self.jump.unwrap_or_else(|| unreachable!("a program with jumps has the slot"))
    }

    /// The slot of a place, without regard to its bit.
    pub(super) fn of(&self, place: &Place) -> SlotId {
        let slot = match (&self.variables[place.variable.index()], pin_of(place)) {
            (VariableSlots::Value(slot), _) => Some(*slot),
            (VariableSlots::Instance(slots), Some(PinId::Input(pin))) => slots.inputs[pin],
            (VariableSlots::Instance(slots), Some(PinId::Output(pin))) => Some(slots.outputs[pin]),
            (VariableSlots::Instance(_), None) => None,
        };
        slot.unwrap_or_else(|| {
            unreachable!("the checker makes places of values and pins, and all pins in use have slots")
        })
    }
}

fn pin_of(place: &Place) -> Option<PinId> {
    place.path.iter().find_map(|step| if let Step::Pin(pin) = step { Some(*pin) } else { None })
}

/// Gives every slot its name and place.
pub(super) fn allocate(
    checked: &Checked,
    line: impl Fn(Span) -> u32,
    earlier: Option<&EarlierLayout>,
) -> Result<(Slots, Layout), ImageTooLarge> {
    let used = Used::find(checked);
    let mut allocator = Allocator { layout: LayoutBuilder::new(), names: HashSet::new() };
    let mut variables: Vec<VariableSlots> = Vec::with_capacity(checked.variables().len());
    for (variable, kept_inputs) in checked.variables().iter().zip(&used.kept_inputs) {
        let slots = match (variable.ty, variable.shares) {
            (Type::Elementary(_), Some(other)) => match &variables[other.index()] {
                VariableSlots::Value(slot) => VariableSlots::Value(*slot),
                VariableSlots::Instance(_) => unreachable!("block instances have no address"),
            },
            (Type::Elementary(ty), None) => VariableSlots::Value(allocator.value(variable, ty, line(variable.span))),
            (Type::Block(block), _) => {
                VariableSlots::Instance(allocator.instance(variable, block, kept_inputs, line(variable.span)))
            }
            _ => continue,
        };
        match (&slots, variable.ty) {
            (VariableSlots::Instance(slots), Type::Block(block)) => {
                for (pin, slot) in block.outputs().iter().zip(&slots.outputs) {
                    allocator.layout.observe(format!("{}.{}", variable.name, pin.name), *slot);
                }
            }
            (VariableSlots::Value(slot), _) => allocator.layout.observe(&variable.name, *slot),
            (VariableSlots::Instance(_), _) => {}
        }
        variables.push(slots);
    }
    let mut edges = Vec::new();
    for (rung, count) in checked.units()[0].rungs.iter().zip(&used.edges) {
        for number in 1..=*count {
            edges.push(allocator.state(format!("{}#{number}", rung.label), Elementary::Bool, false, line(rung.span)));
        }
    }
    let jump = used.jump.map(|span| allocator.state("#jump".to_owned(), Elementary::Udint, false, line(span)));
    Ok((Slots { variables, edges, jump }, allocator.layout.finish(earlier)?))
}

struct Allocator {
    layout: LayoutBuilder,
    names: HashSet<String>,
}

impl Allocator {
    fn value(&mut self, variable: &Variable, ty: Elementary, line: u32) -> SlotId {
        let area = match (&variable.address, variable.class) {
            (Some(address), _) => match address.area {
                ladder::Area::Input => Area::Input,
                ladder::Area::Output => Area::Output,
                ladder::Area::Memory => Area::Memory,
            },
            (None, VariableClass::Input) => Area::Input,
            (None, VariableClass::Output) => Area::Output,
            (None, _) => Area::Memory,
        };
        let name = self.unique(variable.name.clone());
        let (retain, initial) = (variable.retain, variable.initial.value(ty));
        self.layout.slot(Slot { name, ty, offset: 0, area, retain, initial, line })
    }

    fn instance(
        &mut self,
        variable: &Variable,
        block: StandardBlock,
        kept_inputs: &[bool],
        line: u32,
    ) -> InstanceSlots {
        let mut state = |separator: &str, name: &str, ty: Elementary| {
            self.state(format!("{}{separator}{name}", variable.name), ty, variable.retain, line)
        };
        InstanceSlots {
            outputs: block.outputs().iter().map(|pin| state(".", pin.name, pin.ty)).collect(),
            inputs: (block.inputs().iter().zip(kept_inputs))
                .map(|(pin, kept)| kept.then(|| state(".", pin.name, pin.ty)))
                .collect(),
            states: blocks::rule(block).states.iter().map(|(name, ty)| state("#", name, *ty)).collect(),
        }
    }

    fn state(&mut self, name: String, ty: Elementary, retain: bool, line: u32) -> SlotId {
        let (name, initial) = (self.unique(name), Value::default_of(ty));
        self.layout.slot(Slot { name, ty, offset: 0, area: Area::State, retain, initial, line })
    }

    /// The name itself, or with primes behind it: a foreign name may hold the marks that set slots of a block apart.
    fn unique(&mut self, mut name: String) -> String {
        while !self.names.insert(name.clone()) {
            name.push('\'');
        }
        name
    }
}

/// What the rungs use that decides about slots.
struct Used {
    /// For each variable, for each of its input pins, whether it needs a slot.
    kept_inputs: Vec<Vec<bool>>,
    /// For each variable, whether a call of it was found.
    called: Vec<bool>,
    /// For each rung, how many edge contacts and edge coils it has.
    edges: Vec<usize>,
    /// The first rung with a jump.
    jump: Option<Span>,
}

impl Used {
    fn find(checked: &Checked) -> Self {
        let pins = |variable: &Variable| match variable.ty {
            Type::Block(block) => vec![false; block.inputs().len()],
            _ => Vec::new(),
        };
        let mut used = Self {
            kept_inputs: checked.variables().iter().map(pins).collect(),
            called: vec![false; checked.variables().len()],
            edges: Vec::new(),
            jump: None,
        };
        for rung in &checked.units()[0].rungs {
            used.edges.push(0);
            if used.circuit(&rung.circuit) {
                used.jump.get_or_insert(rung.span);
            }
        }
        used
    }

    /// Whether there is a jump in the circuit.
    fn circuit(&mut self, circuit: &Circuit) -> bool {
        let mut jumps = false;
        for element in circuit.branches.iter().flat_map(|branch| &branch.elements) {
            match element {
                Element::Contact { kind, operand } => {
                    self.edge(matches!(kind, ContactKind::Rising | ContactKind::Falling));
                    self.expression(operand);
                }
                Element::Coil { kind, target } => {
                    self.edge(matches!(kind, CoilKind::Rising | CoilKind::Falling));
                    self.place(target);
                }
                Element::Call(call) => self.call(call),
                Element::Condition(condition) => self.expression(condition),
                Element::Assignment { target, value } => {
                    self.place(target);
                    self.expression(value);
                }
                Element::Parallel(circuit) => jumps |= self.circuit(circuit),
                Element::Jump(_) | Element::Return => jumps = true,
                Element::Statements(_) => {}
            }
        }
        jumps
    }

    fn edge(&mut self, is_edge: bool) {
        if let (true, Some(count)) = (is_edge, self.edges.last_mut()) {
            *count += 1;
        }
    }

    fn call(&mut self, call: &Call) {
        // A call may stand in a circuit at another call's pin, of the same instance even.
        let Callee::Standard(_, instance) = &call.callee else { return };
        let called_before = std::mem::replace(&mut self.called[instance.variable.index()], true);
        for (pin, kept) in self.kept_inputs[instance.variable.index()].iter_mut().enumerate() {
            let wired = call.power_input == Some(pin) || call.inputs.iter().any(|input| input.pin == pin);
            *kept |= called_before || !wired;
        }
        for input in &call.inputs {
            match &input.wire {
                Wire::Value(expression) => self.expression(expression),
                Wire::Circuit(circuit) => drop(self.circuit(circuit)),
            }
        }
        for (_, target) in &call.outputs {
            self.place(target);
        }
    }

    fn expression(&mut self, expression: &Expression) {
        match &expression.kind {
            ExpressionKind::Constant(_) => {}
            ExpressionKind::Read(place) => self.place(place),
            ExpressionKind::UserCall { .. } => {}
            ExpressionKind::Unary(_, operand) | ExpressionKind::Widen(operand) => self.expression(operand),
            ExpressionKind::Binary(_, left, right) => {
                self.expression(left);
                self.expression(right);
            }
            ExpressionKind::Call { arguments, .. } => arguments.iter().for_each(|argument| self.expression(argument)),
        }
    }

    fn place(&mut self, place: &Place) {
        if let Some(PinId::Input(pin)) = pin_of(place) {
            self.kept_inputs[place.variable.index()][pin] = true;
        }
    }
}
