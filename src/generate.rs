//! Synthetic programs: as large as asked for, with timers, from a seed.
//!
//! They are for measuring, so two machines and two versions must make the same program of the same options: every
//! choice is a remainder of a PCG number, never a distribution whose algorithm may change. It takes time in
//! proportion to the program's size, reads no clock and knows no file.
//!
//! Each rung is one to three branches of contacts in parallel, then perhaps an on-delay timer, then a coil that no
//! other rung writes. A contact reads an input or any rung's coil, its own too. Checking finds nothing to say.

#[cfg(test)]
mod tests;

use std::error::Error;
use std::fmt;

use lean_string::LeanString;
use rand::Rng;
use rand_pcg::Pcg32;
use thin_vec::ThinVec;

use crate::elementary::Elementary;
use crate::ladder::library::StandardBlock;
use crate::ladder::{
    Argument, BlockCall, Branch, Circuit, CoilKind, ContactKind, Element, ElementKind, Expression, ExpressionKind,
    Literal, Name, Origin, Program, Reference, Root, Rung, TypeReference, Variable, VariableClass, Wire,
};
use crate::source::Span;

/// The most contacts that a program may have on average: beyond it, its text would be too large to be a source.
pub const MAXIMUM_CONTACTS: u64 = 6_000_000;

/// How far, in rungs, a near reference reaches to either side.
pub const NEAR_RUNGS: u32 = 16;

/// How many rungs share an input.
const RUNGS_PER_INPUT: u32 = 3;

/// One rung in so many drives an output; the coils of the others are memory.
const RUNGS_PER_OUTPUT: u32 = 4;

/// Where a generated program stands in its source: nowhere, until it is printed.
const NOWHERE: Span = Span { start: 0, end: 0 };

/// What is asked for.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Options {
    /// Exactly so many rungs.
    pub rungs: u32,
    /// Exactly so many on-delay timers, at most one a rung, evenly spread.
    pub timers: u32,
    /// Contacts in a rung, from 1, on average over many rungs.
    pub contacts_per_rung: u32,
    /// How many references in a hundred are to rungs within [`NEAR_RUNGS`]; the others go anywhere.
    pub near_percent: u32,
    /// What the random choices start from.
    pub seed: u64,
}

impl Default for Options {
    /// 100 rungs, a timer per 6 of them, 6 contacts a rung, references anywhere.
    fn default() -> Self {
        Self { rungs: 100, timers: 16, contacts_per_rung: 6, near_percent: 0, seed: 0 }
    }
}

/// Why there is no program for some options.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum OptionsError {
    /// More timers than rungs.
    TooManyTimers {
        /// The timers.
        timers: u32,
        /// The rungs.
        rungs: u32,
    },
    /// A rung without contacts would always conduct.
    NoContacts,
    /// A share of more than 100 in a hundred.
    NotAPercentage(u32),
    /// More than [`MAXIMUM_CONTACTS`].
    TooLarge {
        /// How many contacts that would be.
        contacts: u64,
    },
}

impl fmt::Display for OptionsError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::TooManyTimers { timers, rungs } => {
                write!(f, "{timers} timers do not fit into {rungs} rungs: there is at most one in a rung")
            }
            Self::NoContacts => write!(f, "a rung needs at least one contact"),
            Self::NotAPercentage(percent) => write!(f, "{percent} % is more than all"),
            Self::TooLarge { contacts } => {
                write!(f, "{contacts} contacts are too many: a program may have {MAXIMUM_CONTACTS}")
            }
        }
    }
}

impl Error for OptionsError {}

/// Makes the program of some options.
///
/// # Errors
/// [`OptionsError`]
pub fn generate(options: &Options) -> Result<Program, OptionsError> {
    let Options { rungs, timers, contacts_per_rung, near_percent, seed } = *options;
    let contacts = u64::from(rungs) * u64::from(contacts_per_rung);
    if timers > rungs {
        return Err(OptionsError::TooManyTimers { timers, rungs });
    }
    if contacts_per_rung == 0 {
        return Err(OptionsError::NoContacts);
    }
    if near_percent > 100 {
        return Err(OptionsError::NotAPercentage(near_percent));
    }
    if contacts > MAXIMUM_CONTACTS {
        return Err(OptionsError::TooLarge { contacts });
    }
    let mut generator = Generator { options: *options, random: Pcg32::new(seed, 0) };
    let inputs = (0..rungs.div_ceil(RUNGS_PER_INPUT)).map(|input| variable(VariableClass::Input, input_name(input)));
    let coils = (0..rungs).map(|rung| {
        let class = if drives_output(rung) { VariableClass::Output } else { VariableClass::Memory };
        variable(class, coil_name(rung))
    });
    let rungs_of_it = (0..rungs).map(|rung| generator.rung(rung)).collect();
    Ok(Program::of_one(Origin::Native, name(format!("synthetic_{rungs}")), inputs.chain(coils).collect(), rungs_of_it))
}

struct Generator {
    options: Options,
    random: Pcg32,
}

impl Generator {
    /// 0 to `count` - 1.
    fn below(&mut self, count: u32) -> u32 {
        self.random.next_u32() % count.max(1)
    }

    fn rung(&mut self, rung: u32) -> Rung {
        // One to three branches make two on average, and 1 to n - 1 contacts make n / 2.
        let most = (self.options.contacts_per_rung - 1).max(1);
        let branches = if self.options.contacts_per_rung == 1 { 1 } else { 1 + self.below(3) };
        let mut branches: Vec<Vec<Element>> = (0..branches)
            .map(|branch| (0..=self.below(most)).map(|place| self.contact(rung, branch == 0 && place == 0)).collect())
            .collect();
        let mut elements = match branches.pop() {
            Some(only) if branches.is_empty() => only,
            last => {
                let branches = branches.into_iter().chain(last).map(series).collect();
                vec![element(ElementKind::Parallel(Circuit { branches, span: NOWHERE }))]
            }
        };
        let timer = self.has_timer(rung).then(|| self.timer(rung));
        let target = reference(coil_name(rung));
        // Of a million rungs, what vectors hold in reserve is much.
        elements.reserve_exact(2);
        elements.extend(timer);
        elements.push(element(ElementKind::Coil { kind: CoilKind::Plain, target }));
        Rung {
            name: Some(name(format!("r{rung}"))),
            title: None,
            enabled: true,
            circuit: Circuit { branches: vec![series(elements)], span: NOWHERE },
            span: NOWHERE,
        }
    }

    /// The first contact of the first of the rungs that share an input reads it, so that none is without use.
    fn contact(&mut self, rung: u32, first: bool) -> Element {
        let text = if first && rung.is_multiple_of(RUNGS_PER_INPUT) {
            input_name(rung / RUNGS_PER_INPUT)
        } else {
            let from = self.referred_rung(rung);
            // As many to each input as to each coil.
            if self.below(RUNGS_PER_INPUT + 1) == 0 { input_name(from / RUNGS_PER_INPUT) } else { coil_name(from) }
        };
        let kind = if self.below(3) == 0 { ContactKind::Closed } else { ContactKind::Open };
        let operand = expression(ExpressionKind::Read(reference(text)));
        element(ElementKind::Contact { kind, operand })
    }

    fn referred_rung(&mut self, rung: u32) -> u32 {
        let rungs = self.options.rungs;
        if self.below(100) < self.options.near_percent {
            let least = rung.saturating_sub(NEAR_RUNGS);
            let most = (rung + NEAR_RUNGS).min(rungs - 1);
            least + self.below(most - least + 1)
        } else {
            self.below(rungs)
        }
    }

    /// Spreads the timers evenly, as a line is drawn on a grid: rung k has one when k + 1 rungs have more than k.
    fn has_timer(&self, rung: u32) -> bool {
        let within = |rungs: u32| u64::from(rungs) * u64::from(self.options.timers) / u64::from(self.options.rungs);
        within(rung + 1) > within(rung)
    }

    fn timer(&mut self, rung: u32) -> Element {
        let preset = i64::from(1 + self.below(200)) * 10_000_000;
        let wire = Wire::Value(expression(ExpressionKind::Literal(Literal::Time(preset))));
        element(ElementKind::Block(Box::new(BlockCall {
            instance: reference(format!("t{rung}")),
            type_name: Some(name(StandardBlock::Ton.name())),
            arguments: vec![Argument { pin: name("PT"), wire, span: NOWHERE }],
            power_output: None,
        })))
    }
}

fn drives_output(rung: u32) -> bool {
    rung.is_multiple_of(RUNGS_PER_OUTPUT)
}

fn input_name(input: u32) -> String {
    format!("i{input}")
}

fn coil_name(rung: u32) -> String {
    if drives_output(rung) { format!("q{rung}") } else { format!("m{rung}") }
}

fn name(text: impl Into<LeanString>) -> Name {
    Name::new(text, NOWHERE)
}

fn variable(class: VariableClass, text: String) -> Variable {
    Variable {
        class,
        name: name(text),
        ty: (class == VariableClass::Memory).then(|| TypeReference::of_name(name(Elementary::Bool.name()))),
        address: None,
        initial: None,
        retain: false,
        span: NOWHERE,
    }
}

fn series(elements: Vec<Element>) -> Branch {
    Branch { from: None, elements, to: None, span: NOWHERE }
}

fn element(kind: ElementKind) -> Element {
    Element { kind, span: NOWHERE }
}

fn expression(kind: ExpressionKind) -> Expression {
    Expression { kind, span: NOWHERE }
}

fn reference(text: String) -> Reference {
    Reference { root: Root::Name(name(text)), steps: ThinVec::new(), span: NOWHERE }
}
