//! Random programs that check without an error, small and entangled, so that things happen in them.
//!
//! A seed gives one program. Every element, statement, block, type and way to wire a pin occurs; presets are small and
//! variables few, so that timers expire and counters fill while stimuli (see `random_stimuli`) come in.
//!
//! `unit` draws units one after the other, `declaration` and `shape` what they declare, `circuit`, `call` and
//! `statement` what their rungs hold, `expression` and `function` values; `jump` puts jumps in at last.

mod call;
mod circuit;
mod declaration;
mod expression;
mod function;
mod function_box;
mod jump;
mod shape;
mod statement;
mod unit;

use rung::elementary::Elementary;
use rung::ladder::library::StandardBlock;
use rung::ladder::{Program, Reference, Root, Rung, Unit, UnitKind, VariableClass};

use super::dice::Dice;
use super::drawing;
use shape::{Shape, Way};

/// The program of a seed, over the whole language.
pub(crate) fn random_program(seed: u64) -> Program {
    drawn(seed, true)
}

/// The program of a seed, without the register machine, which other tools have not.
pub(crate) fn random_iec_program(seed: u64) -> Program {
    drawn(seed, false)
}

fn drawn(seed: u64, register_machine: bool) -> Program {
    let program = Program { units: Vec::new(), ..drawing::program("random") };
    let mut generator = Generator {
        dice: Dice::new(seed, 1),
        register_machine,
        unit: unit::empty(),
        program,
        value_types: Vec::new(),
        named_arrays: Vec::new(),
        structures: Vec::new(),
        functions: Vec::new(),
        blocks: Vec::new(),
        scope: Vec::new(),
        wholes: Vec::new(),
        instances: Vec::new(),
        pending: Vec::new(),
        nodes: 0,
        fed_nodes: Vec::new(),
        in_pin: false,
        in_function: false,
        in_index: false,
        fixed_indices: false,
        addresses: false,
        weight: 0,
        turns: 1,
    };
    generator.draw();
    generator.program
}

/// Something elementary that can be named.
#[derive(Clone)]
struct Entry {
    root: Root,
    way: Vec<Way>,
    ty: Elementary,
    class: VariableClass,
}

/// An array or structure that can be named.
#[derive(Clone)]
struct Whole {
    root: Root,
    way: Vec<Way>,
    shape: Shape,
    class: VariableClass,
}

/// What something is named for.
#[derive(Clone, Copy, PartialEq)]
enum Purpose {
    Read,
    /// To read something that is no constant.
    ReadVariable,
    Write,
}

impl Purpose {
    fn allows(self, class: VariableClass) -> bool {
        match self {
            Self::Read => true,
            Self::ReadVariable => class != VariableClass::Constant,
            Self::Write => !matches!(class, VariableClass::Constant | VariableClass::Input),
        }
    }
}

/// A function block or function of the program's own, as its callers see it.
#[derive(Clone)]
struct Signature {
    name: String,
    result: Option<Elementary>,
    inputs: Vec<(String, Elementary)>,
    references: Vec<(String, Shape)>,
    outputs: Vec<(String, Shape)>,
    /// About how much a call comes to.
    weight: usize,
}

/// What an instance is of.
#[derive(Clone)]
enum Kind {
    Standard(StandardBlock),
    Own(Signature),
}

/// A block instance.
#[derive(Clone)]
struct Instance {
    /// With constant indices, if it is in an array.
    reference: Reference,
    kind: Kind,
    /// Whether a declaration gives its type, so that the call need not.
    declared: bool,
}

struct Generator {
    dice: Dice,
    /// Whether its blocks and registers are drawn, too.
    register_machine: bool,
    program: Program,
    /// What is being drawn.
    unit: Unit,
    /// Types with other names: enumerations, too.
    value_types: Vec<(Elementary, String)>,
    named_arrays: Vec<(Shape, String)>,
    structures: Vec<Shape>,
    functions: Vec<Signature>,
    blocks: Vec<Signature>,
    scope: Vec<Entry>,
    wholes: Vec<Whole>,
    instances: Vec<Instance>,
    /// The instances that no call stands for yet.
    pending: Vec<Instance>,
    /// How many nodes this rung has.
    nodes: usize,
    /// Those of them that all their feeders stand before.
    fed_nodes: Vec<String>,
    /// Whether this is a circuit at a pin, which cannot start at a node of the rung around it.
    in_pin: bool,
    /// Whether this is a function, which remembers nothing.
    in_function: bool,
    in_index: bool,
    /// Whether indices have to be constant.
    fixed_indices: bool,
    /// Whether variables stand at addresses.
    addresses: bool,
    /// About how much the calls of own units and functions in this unit come to.
    weight: usize,
    /// How often the loops around repeat what is drawn.
    turns: usize,
}

impl Generator {
    fn rung(&mut self, place: usize) {
        self.nodes = 0;
        self.fed_nodes.clear();
        let mut elements = self.series(0);
        elements.extend(self.ending());
        let rung = Rung {
            name: self.dice.percent(70).then(|| drawing::name(&format!("r{place}"))),
            title: self.dice.percent(20).then(|| format!("what rung {place} is for").into()),
            enabled: !self.dice.percent(4),
            ..drawing::rung(elements)
        };
        self.unit.rungs.push(rung);
    }

    /// Whether another call of something is not too much to be written out; it is noted.
    fn affords(&mut self, called: &Signature) -> bool {
        let weight = self.weight + called.weight * self.turns;
        let affordable = weight < if matches!(self.unit.kind, UnitKind::Program { .. }) { 300 } else { 100 };
        if affordable {
            self.weight = weight;
        }
        affordable
    }

    /// A reference to something of a type, if there is any.
    fn place(&mut self, ty: Elementary, purpose: Purpose) -> Option<Reference> {
        let fits = |entry: &&Entry| entry.ty == ty && purpose.allows(entry.class);
        let fitting: Vec<Entry> = self.scope.iter().filter(fits).cloned().collect();
        if fitting.is_empty() {
            return None;
        }
        let entry = self.dice.pick(&fitting).clone();
        Some(self.refer(&entry.root, &entry.way))
    }

    /// A reference to an array or structure that a condition holds for, if there is any.
    fn whole(&mut self, fits: impl Fn(&Whole) -> bool) -> Option<(Reference, Shape)> {
        let fitting: Vec<Whole> = self.wholes.iter().filter(|whole| fits(whole)).cloned().collect();
        if fitting.is_empty() {
            return None;
        }
        let whole = self.dice.pick(&fitting).clone();
        Some((self.refer(&whole.root, &whole.way), whole.shape))
    }
}
