//! What one element looks like: its kind, its texts cut to size, and the room that it needs.
//!
//! Sizes are in grid columns (one terminal column) and grid rows (one line). A symbol must know nothing of the
//! place where it will stand.

use std::collections::HashMap;

use super::label;
use crate::elementary::Elementary;
use crate::ladder::functions::Function;
use crate::ladder::library::{Pin, StandardBlock};
use crate::ladder::{
    BlockCall, CoilKind, ContactKind, Expression, Program, Reference, Root, Step, Unit, UnitKind, Variable,
    VariableClass, Wire, key,
};

/// The columns of the frame of a contact or coil: its two sides and the mark between.
pub(super) const FRAME: usize = 3;
/// The least columns of a contact or coil with the wire on both sides.
const LEAST_COLUMNS: usize = 7;

/// How wide texts may be, in columns.
#[derive(Clone, Copy)]
pub(super) struct Limits {
    /// A name above a contact or a coil.
    pub(super) name: usize,
    /// The instance or the type of a block.
    pub(super) block: usize,
    /// An expression in a box.
    pub(super) expression: usize,
    /// What is written beside a pin.
    pub(super) pin: usize,
    /// The name of a pin.
    pub(super) pin_name: usize,
}

impl Limits {
    /// Limits that keep every element within a cell of that width, and a block within one of at least 32 columns.
    pub(super) fn within(columns: usize) -> Self {
        let pin_name = (columns / 6).clamp(4, 16);
        // The names of two pins, what is wired to them, and all that is between.
        let pin = (columns.saturating_sub(2 * pin_name + 9) / 2).clamp(6, 28);
        Self {
            name: columns.saturating_sub(2).clamp(4, 36),
            block: 2 * pin_name,
            expression: columns.saturating_sub(6).clamp(4, 60),
            pin,
            pin_name,
        }
    }
}

/// One drawn element.
pub(super) struct Symbol {
    pub(super) kind: SymbolKind,
    /// The least columns that it needs, wires on both sides included.
    pub(super) columns: usize,
    /// Rows above its wire.
    pub(super) above: usize,
    /// Rows below its wire.
    pub(super) below: usize,
    /// Whether it only writes, so that it belongs at the right.
    pub(super) is_output: bool,
}

/// What a symbol is, with its texts.
pub(super) enum SymbolKind {
    Contact { mark: char, name: String },
    Coil { mark: char, name: String },
    Box { lines: Vec<String> },
    NodeStart { text: String },
    NodeEnd { text: String },
    Jump { text: String },
    Block(BlockBox),
}

/// The box of a block call.
pub(super) struct BlockBox {
    pub(super) instance: String,
    pub(super) type_name: String,
    /// The pins of the left side; power comes in at the first.
    pub(super) left: Vec<PinLabel>,
    /// The pins of the right side; power goes out at the first.
    pub(super) right: Vec<PinLabel>,
    /// Columns left of the box.
    pub(super) left_columns: usize,
    /// Columns of the box, borders included.
    pub(super) box_columns: usize,
}

impl BlockBox {
    /// Rows of pins.
    pub(super) fn rows(&self) -> usize {
        self.left.len().max(self.right.len())
    }
}

/// One pin.
pub(super) struct PinLabel {
    /// Its name inside the box.
    pub(super) name: String,
    /// What is wired to it, beside the box; empty for nothing, or for the power.
    pub(super) wired: String,
}

impl Symbol {
    /// A contact.
    pub(super) fn contact(kind: ContactKind, operand: &Expression, limits: Limits) -> Self {
        let mark = match kind {
            ContactKind::Open => ' ',
            ContactKind::Closed => '/',
            ContactKind::Rising => 'P',
            ContactKind::Falling => 'N',
        };
        let name = label::expression(operand, limits.name);
        let columns = (label::width(&name) + 2).max(LEAST_COLUMNS);
        Self { kind: SymbolKind::Contact { mark, name }, columns, above: 1, below: 0, is_output: false }
    }

    /// A coil.
    pub(super) fn coil(kind: CoilKind, target: &Reference, limits: Limits) -> Self {
        let mark = match kind {
            CoilKind::Plain => ' ',
            CoilKind::Negated => '/',
            CoilKind::Set => 'S',
            CoilKind::Reset => 'R',
            CoilKind::Rising => 'P',
            CoilKind::Falling => 'N',
        };
        let name = label::reference(target, limits.name);
        let columns = (label::width(&name) + 2).max(LEAST_COLUMNS);
        Self { kind: SymbolKind::Coil { mark, name }, columns, above: 1, below: 0, is_output: true }
    }

    /// A box with lines of text, the first of them beside the wire.
    pub(super) fn boxed(lines: Vec<String>, is_output: bool) -> Self {
        let columns = lines.iter().map(|line| label::width(line)).max().unwrap_or(0) + 6;
        let below = lines.len().max(1);
        Self { kind: SymbolKind::Box { lines }, columns, above: 1, below, is_output }
    }

    /// The connector of a node that the wire starts from.
    pub(super) fn node_start(name: &str, limits: Limits) -> Self {
        let text = node_text(name, limits);
        let columns = label::width(&text) + 3;
        Self { kind: SymbolKind::NodeStart { text }, columns, above: 0, below: 0, is_output: false }
    }

    /// The connector of a node that the wire ends at.
    pub(super) fn node_end(name: &str, limits: Limits) -> Self {
        let text = node_text(name, limits);
        let columns = label::width(&text) + 3;
        Self { kind: SymbolKind::NodeEnd { text }, columns, above: 0, below: 0, is_output: false }
    }

    /// An arrow to where execution goes on, at the end of the wire.
    pub(super) fn jump(target: &str, limits: Limits) -> Self {
        let text = format!(">> {}", label::cut_name(target, limits.name.saturating_sub(4).max(3)));
        let columns = label::width(&text) + 3;
        Self { kind: SymbolKind::Jump { text }, columns, above: 0, below: 0, is_output: false }
    }

    /// A block. `circuit_labels` are what to write at the pins that circuits are wired to, in their order.
    pub(super) fn block(
        call: &BlockCall,
        types: &InstanceTypes<'_>,
        circuit_labels: Vec<String>,
        limits: Limits,
    ) -> Self {
        let function = types.function(call);
        let type_name = function.or_else(|| types.type_of(call));
        let signature = type_name.and_then(|name| types.signature(name, function.is_some()));
        let (left, right) = pins(call, signature, circuit_labels, limits);
        let instance = match function {
            Some(_) => String::new(),
            None => label::reference(&call.instance, limits.block),
        };
        let type_name = label::cut_name(type_name.unwrap_or("?"), limits.block);

        let widest = |pins: &[PinLabel], text: fn(&PinLabel) -> &str| {
            pins.iter().map(|pin| label::width(text(pin))).max().unwrap_or(0)
        };
        // Beside a text: the pin's wire and a blank.
        let left_columns = (widest(&left, |pin| &pin.wired) + 2).max(2);
        let right_columns = match widest(&right, |pin| &pin.wired) {
            0 => 2,
            text => text + 3,
        };
        let names = widest(&left, |pin| &pin.name) + 2 + widest(&right, |pin| &pin.name);
        // The instance's name may reach over what stands at both sides of the box.
        let overhang = 2 * left_columns.min(right_columns);
        let below_instance = label::width(&instance).saturating_sub(overhang);
        let box_columns = names.max(label::width(&type_name) + 2).max(below_instance) + 2;
        let block = BlockBox { instance, type_name, left, right, left_columns, box_columns };
        Self {
            columns: left_columns + box_columns + right_columns,
            // The row of the instance's name, the frame and the type.
            above: if block.instance.is_empty() { 2 } else { 3 },
            below: block.rows(),
            kind: SymbolKind::Block(block),
            is_output: false,
        }
    }
}

/// What stands at a node's connector.
pub(super) fn node_text(name: &str, limits: Limits) -> String {
    format!(">{}>", label::cut_name(name, limits.name.saturating_sub(3).max(3)))
}

/// What the names of a unit stand for, as far as boxes show it.
pub(super) struct InstanceTypes<'a> {
    /// The types of what is declared.
    types: HashMap<String, Option<&'a str>>,
    /// The function blocks and functions of the program.
    units: HashMap<String, &'a Unit>,
}

impl<'a> InstanceTypes<'a> {
    /// Those of a unit.
    pub(super) fn of(program: &'a Program, unit: &'a Unit) -> Self {
        let typed =
            |variable: &'a Variable| (variable.name.key(), variable.ty.as_ref().map(|ty| ty.name.text.as_str()));
        let is_called = |unit: &&Unit| !matches!(unit.kind, UnitKind::Program { .. });
        Self {
            types: program.globals.iter().chain(&unit.variables).map(typed).collect(),
            units: program.units.iter().filter(is_called).map(|unit| (unit.name.key(), unit)).collect(),
        }
    }

    fn is_function(&self, key: &str) -> bool {
        self.units.get(key).is_some_and(|unit| matches!(unit.kind, UnitKind::Function { .. }))
    }

    /// What is known of the pins of a function, or of a block of that type. The program's own come first, as nothing of
    /// theirs is known from elsewhere.
    fn signature(&self, name: &str, is_function: bool) -> Option<Signature<'a>> {
        match self.units.get(&key(name)) {
            Some(unit) => Some(Signature::of_unit(unit)),
            None if is_function => Some(Signature { is_function, inputs: Vec::new(), outputs: Vec::new() }),
            None => StandardBlock::from_name(name).map(Signature::of_block),
        }
    }

    /// The type of what a call calls: that which it names itself, or that of the declaration, of an array its elements'.
    fn type_of(&self, call: &'a BlockCall) -> Option<&'a str> {
        if let Some(name) = &call.type_name {
            return Some(&name.text);
        }
        let element = call.instance.steps.iter().all(|step| matches!(step, Step::Index(..)));
        match &call.instance.root {
            Root::Name(name) if element => self.types.get(&name.key()).copied().flatten(),
            _ => None,
        }
    }

    /// The function that a call calls, if it is one.
    fn function(&self, call: &'a BlockCall) -> Option<&'a str> {
        let name = call.instance.as_name().filter(|_| call.type_name.is_none())?;
        let key = name.key();
        let known = self.is_function(&key) || Function::from_name(&name.text).is_some();
        (known && !self.types.contains_key(&key)).then_some(name.text.as_str())
    }
}

/// The most pins of a unit that are shown though nothing is wired to them.
const MOST_PINS: usize = 64;

/// What is known of the pins of a box.
struct Signature<'a> {
    /// Power goes through a function from EN to ENO.
    is_function: bool,
    inputs: Vec<KnownPin<'a>>,
    outputs: Vec<KnownPin<'a>>,
}

struct KnownPin<'a> {
    name: &'a str,
    /// Power may flow through it.
    is_bool: bool,
}

impl<'a> Signature<'a> {
    fn of_block(block: StandardBlock) -> Self {
        let known = |pin: &'static Pin| KnownPin { name: pin.name, is_bool: pin.ty == Elementary::Bool };
        Self {
            is_function: false,
            inputs: block.inputs().iter().map(known).collect(),
            outputs: block.outputs().iter().map(known).collect(),
        }
    }

    fn of_unit(unit: &'a Unit) -> Self {
        let pins = |wanted: fn(VariableClass) -> bool| {
            let declared = unit.variables.iter().filter(move |variable| wanted(variable.class));
            declared.take(MOST_PINS).map(|variable| {
                let is_bool = variable
                    .ty
                    .as_ref()
                    .is_none_or(|ty| ty.dimensions.is_empty() && ty.name.text.eq_ignore_ascii_case("BOOL"));
                // The caller's own variable carries no power.
                KnownPin { name: &variable.name.text, is_bool: is_bool && variable.class != VariableClass::InOut }
            })
        };
        let result = match &unit.kind {
            UnitKind::Function { result: Some(_) } => Some(KnownPin { name: "OUT", is_bool: false }),
            _ => None,
        };
        Self {
            is_function: matches!(unit.kind, UnitKind::Function { .. }),
            inputs: pins(|class| matches!(class, VariableClass::Input | VariableClass::InOut)).collect(),
            outputs: result.into_iter().chain(pins(|class| class == VariableClass::Output)).collect(),
        }
    }
}

/// The pins of both sides, those that power flows through first, then the block's own in their order, wired or
/// not, then what else the call names.
fn pins(
    call: &BlockCall,
    signature: Option<Signature<'_>>,
    circuit_labels: Vec<String>,
    limits: Limits,
) -> (Vec<PinLabel>, Vec<PinLabel>) {
    let pin = |name: &str, wired: String| PinLabel { name: label::cut_name(name, limits.pin_name), wired };
    let mut circuit_labels = circuit_labels.into_iter();
    // What is wired, taken out below as the block's pins are listed.
    let mut inputs: Vec<(&str, String)> = Vec::new();
    let mut outputs: Vec<(&str, String)> = Vec::new();
    for argument in &call.arguments {
        let name = argument.pin.text.as_str();
        match &argument.wire {
            Wire::Value(value) => inputs.push((name, label::expression(value, limits.pin))),
            Wire::Circuit(_) => inputs.push((name, circuit_labels.next().unwrap_or_default())),
            Wire::Output(target) => {
                outputs.push((name, format!("=> {}", label::reference(target, limits.pin.saturating_sub(3).max(4)))));
            }
        }
    }
    let is_wired = |wired: &[(&str, String)], name: &str| wired.iter().any(|(pin, _)| pin.eq_ignore_ascii_case(name));
    let take = |wired: &mut Vec<(&str, String)>, name: &str| {
        let found = wired.iter().position(|(pin, _)| pin.eq_ignore_ascii_case(name));
        found.map_or_else(String::new, |at| wired.remove(at).1)
    };
    let known = signature.is_some();
    let Signature { is_function, inputs: known_inputs, outputs: known_outputs } =
        signature.unwrap_or(Signature { is_function: false, inputs: Vec::new(), outputs: Vec::new() });
    let first_bool = |pins: &[KnownPin<'_>]| pins.iter().position(|pin| pin.is_bool && !is_function);

    let power_in = match first_bool(&known_inputs).map(|first| known_inputs[first].name) {
        Some(first) if !is_wired(&inputs, first) => first,
        _ if known => "EN",
        _ => "",
    };
    let mut left = vec![pin(power_in, String::new())];
    for input in known_inputs.iter().filter(|input| input.name != power_in) {
        left.push(pin(input.name, take(&mut inputs, input.name)));
    }
    left.extend(inputs.into_iter().map(|(name, wired)| pin(name, wired)));

    let chosen = call.power_output.as_ref().map(|name| name.text.as_str());
    let own = match first_bool(&known_outputs).map(|first| known_outputs[first].name) {
        Some(first) => first,
        None if known => "ENO",
        None => "",
    };
    let power_out = chosen.unwrap_or(own);
    let mut right = vec![pin(power_out, String::new())];
    for output in known_outputs.iter().filter(|output| !output.name.eq_ignore_ascii_case(power_out)) {
        right.push(pin(output.name, take(&mut outputs, output.name)));
    }
    // An output that is wired and carries the power as well comes here, a second time.
    right.extend(outputs.into_iter().map(|(name, wired)| pin(name, wired)));
    (left, right)
}
