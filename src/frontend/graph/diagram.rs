//! The elements of a body and the wires between them, whatever format they were read from.
//!
//! No name is left to resolve: a wire names the element, and the pin of a block, that it comes from.

use std::collections::HashSet;

use crate::ladder::{Expression, ExpressionKind, Name, Reference};
use crate::source::Span;

/// A body.
pub(in crate::frontend) struct Diagram {
    /// What the format calls the number of an element.
    pub(in crate::frontend) id_name: &'static str,
    /// The elements, in order of the file.
    pub(in crate::frontend) items: Vec<Item>,
    /// Those with a wire from nowhere, which was reported.
    pub(in crate::frontend) faulty: HashSet<usize>,
}

impl Diagram {
    /// A body without elements.
    pub(in crate::frontend) fn new(id_name: &'static str) -> Self {
        Self { id_name, items: Vec::new(), faulty: HashSet::new() }
    }
}

/// One element.
pub(in crate::frontend) struct Item {
    pub(in crate::frontend) id: u64,
    pub(in crate::frontend) span: Span,
    pub(in crate::frontend) x: i64,
    pub(in crate::frontend) y: i64,
    /// The place that the drawer gave it in the order of execution; 0 says nothing.
    pub(in crate::frontend) order: u64,
    pub(in crate::frontend) kind: ItemKind,
}

/// What is done to the value of a pin, contact, coil or variable.
#[derive(Clone, Copy, Default, PartialEq, Eq, Debug)]
pub(in crate::frontend) struct Modifier {
    pub(in crate::frontend) negated: bool,
    pub(in crate::frontend) edge: Option<Edge>,
}

#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(in crate::frontend) enum Edge {
    Rising,
    Falling,
}

#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(in crate::frontend) enum Storage {
    Set,
    Reset,
}

/// What an element is. `inputs` of one pin are its wires: the power there is the OR of theirs.
pub(in crate::frontend) enum ItemKind {
    LeftRail,
    /// Takes power and does nothing.
    RightRail,
    Contact {
        operand: Expression,
        modifier: Modifier,
        inputs: Vec<Source>,
    },
    /// A coil, or a variable with a wire to it.
    Coil(Coil),
    Block(Block),
    /// A variable or expression as what it gives.
    Value(Expression),
    /// Gives on to its continuations.
    Connector {
        inputs: Vec<Source>,
    },
    Continuation {
        name: String,
    },
    Jump {
        label: Option<Name>,
        inputs: Vec<Source>,
    },
    Label(Name),
    Comment(String),
}

pub(in crate::frontend) struct Coil {
    pub(in crate::frontend) target: Reference,
    pub(in crate::frontend) modifier: Modifier,
    pub(in crate::frontend) storage: Option<Storage>,
    pub(in crate::frontend) inputs: Vec<Source>,
    /// Whether it is drawn as a variable rather than as a coil.
    pub(in crate::frontend) variable: bool,
    /// What it gives as a variable, where wires start at it too.
    pub(in crate::frontend) value: Option<Expression>,
}

pub(in crate::frontend) struct Block {
    pub(in crate::frontend) type_name: Name,
    /// None for a function.
    pub(in crate::frontend) instance: Option<Reference>,
    pub(in crate::frontend) inputs: Vec<InputPin>,
    pub(in crate::frontend) outputs: Vec<OutputPin>,
}

pub(in crate::frontend) struct InputPin {
    pub(in crate::frontend) name: Name,
    pub(in crate::frontend) modifier: Modifier,
    /// Of an in-out parameter.
    pub(in crate::frontend) in_out: bool,
    pub(in crate::frontend) sources: Vec<Source>,
}

pub(in crate::frontend) struct OutputPin {
    pub(in crate::frontend) name: Name,
    pub(in crate::frontend) negated: bool,
}

/// Where a wire comes from. Numbers are places among the items and among the pins of one.
#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Debug)]
pub(in crate::frontend) enum Source {
    /// A left rail.
    Rail,
    /// The right side of a contact or coil.
    Power(usize),
    /// A variable or expression.
    Value(usize),
    /// An output of a block.
    Output(usize, usize),
    /// The variable at an in-out pin of a block.
    InOut(usize, usize),
}

impl Source {
    /// The element that has to run first.
    pub(in crate::frontend) fn item(self) -> Option<usize> {
        match self {
            Self::Power(item) | Self::Output(item, _) | Self::InOut(item, _) => Some(item),
            Self::Rail | Self::Value(_) => None,
        }
    }
}

impl Block {
    pub(in crate::frontend) fn input(&self, name: &str) -> Option<usize> {
        self.inputs.iter().position(|pin| pin.name.text.eq_ignore_ascii_case(name))
    }

    pub(in crate::frontend) fn output(&self, name: &str) -> Option<usize> {
        self.outputs.iter().position(|pin| pin.name.text.eq_ignore_ascii_case(name))
    }
}

/// The negation of a value.
pub(in crate::frontend) fn negate(value: Expression) -> Expression {
    let span = value.span;
    Expression { kind: ExpressionKind::Unary(crate::ladder::UnaryOperator::Not, Box::new(value)), span }
}
