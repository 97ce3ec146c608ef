//! Random programs that check without an error, small and entangled, so that things happen in them.
//!
//! A seed gives one program. Every element, block, type and way to wire a pin occurs; presets are small and
//! variables few, so that timers expire and counters fill while stimuli (see `random_stimuli`) come in.

mod circuit;
mod declaration;
mod expression;
mod function;
mod jump;

use rung::elementary::Elementary;
use rung::ladder::library::StandardBlock;
use rung::ladder::{Program, Reference, Root, Rung, VariableClass};

use super::dice::Dice;
use super::drawing;

/// The program of a seed.
pub(crate) fn random_program(seed: u64) -> Program {
    let mut generator = Generator {
        dice: Dice::new(seed, 1),
        program: drawing::program("random"),
        scope: Vec::new(),
        instances: Vec::new(),
        pending: Vec::new(),
        nodes: 0,
        fed_nodes: Vec::new(),
        in_pin: false,
    };
    generator.declare();
    let rungs = generator.dice.between(1, 25);
    for place in 0..rungs {
        generator.rung(place);
    }
    // Every instance is called, or its members could not be named.
    while !generator.pending.is_empty() {
        let place = generator.program.units[0].rungs.len();
        generator.rung(place);
    }
    generator.add_jumps();
    generator.program
}

/// Something elementary that can be named.
#[derive(Clone)]
struct Entry {
    root: Root,
    ty: Elementary,
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

impl Entry {
    fn is_for(&self, purpose: Purpose) -> bool {
        match purpose {
            Purpose::Read => true,
            Purpose::ReadVariable => self.class != VariableClass::Constant,
            Purpose::Write => matches!(self.class, VariableClass::Output | VariableClass::Memory),
        }
    }
}

/// A block instance.
#[derive(Clone)]
struct Instance {
    name: String,
    block: StandardBlock,
    /// Whether a declaration gives its type, so that the call need not.
    declared: bool,
}

struct Generator {
    dice: Dice,
    program: Program,
    scope: Vec<Entry>,
    instances: Vec<Instance>,
    /// The instances that no call stands for yet.
    pending: Vec<Instance>,
    /// How many nodes this rung has.
    nodes: usize,
    /// Those of them that all their feeders stand before.
    fed_nodes: Vec<String>,
    /// Whether this is a circuit at a pin, which cannot start at a node of the rung around it.
    in_pin: bool,
}

impl Generator {
    fn rung(&mut self, place: usize) {
        self.nodes = 0;
        self.fed_nodes.clear();
        let mut elements = self.series(0);
        elements.extend(self.ending());
        let rung = Rung {
            name: self.dice.percent(70).then(|| drawing::name(&format!("r{place}"))),
            title: self.dice.percent(20).then(|| format!("what rung {place} is for")),
            enabled: !self.dice.percent(4),
            ..drawing::rung(elements)
        };
        self.program.units[0].rungs.push(rung);
    }

    /// A reference to something of a type, if there is any. Names come in another case now and then.
    fn place(&mut self, ty: Elementary, purpose: Purpose) -> Option<Reference> {
        let fits = |entry: &&Entry| entry.ty == ty && entry.is_for(purpose);
        let fitting: Vec<Entry> = self.scope.iter().filter(fits).cloned().collect();
        if fitting.is_empty() {
            return None;
        }
        let entry = self.dice.pick(&fitting).clone();
        Some(self.refer(&entry))
    }

    fn refer(&mut self, entry: &Entry) -> Reference {
        let root = match &entry.root {
            Root::Name(name) if self.dice.percent(10) => Root::Name(drawing::name(&name.text.to_uppercase())),
            root => root.clone(),
        };
        Reference { root, steps: Vec::new(), span: drawing::NOWHERE }
    }
}
