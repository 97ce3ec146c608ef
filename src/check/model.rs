//! The checked program: every name resolved, every type known, every constant folded.
//!
//! This is what `lower` turns into logic and what the tests' independent evaluator walks. Its fields can be read by
//! all and made by this module's parent only, so that whoever holds a [`Checked`] holds a program that runs.

use crate::elementary::{Elementary, Value};
use crate::ladder::functions::Function;
use crate::ladder::library::StandardBlock;
use crate::ladder::{Address, BinaryOperator, CoilKind, ContactKind, UnaryOperator, VariableClass};
use crate::source::Span;

/// A program that was checked and has no error.
#[derive(Clone, PartialEq, Debug)]
pub struct Checked {
    pub(super) name: String,
    pub(super) variables: Vec<Variable>,
    pub(super) rungs: Vec<Rung>,
}

impl Checked {
    /// The program's name.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Its variables and block instances: the declared ones in order, then those that their use declares.
    pub fn variables(&self) -> &[Variable] {
        &self.variables
    }

    /// One variable.
    pub fn variable(&self, id: VariableId) -> &Variable {
        &self.variables[id.index()]
    }

    /// The rungs that run, in order.
    pub fn rungs(&self) -> &[Rung] {
        &self.rungs
    }
}

/// A variable, by its place in [`Checked::variables`].
#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Debug)]
pub struct VariableId(pub u32);

impl VariableId {
    /// The place as an index.
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// A variable or block instance.
#[derive(Clone, PartialEq, Debug)]
pub struct Variable {
    /// Its name, as it was spelled first; an address that was used without a declaration is spelled canonically, as `%IX0.3`.
    pub name: String,
    /// What it is declared as. An address without a declaration has the class of its area, and so has a `var` at one.
    pub class: VariableClass,
    /// Its type.
    pub ty: Type,
    /// What it starts with, the same for all that share storage. Of a block instance, which has no value of its own, it is FALSE.
    pub initial: Value,
    /// Whether it keeps its value, or a block all of its memory, while the power is off.
    pub retain: bool,
    /// Its address.
    pub address: Option<Address>,
    /// The earlier variable at the same address and of the same width, whose storage this one shares.
    pub shares: Option<VariableId>,
    /// Its name where it is declared, or first used.
    pub span: Span,
}

/// The type of a variable.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Type {
    /// A value.
    Elementary(Elementary),
    /// An instance of a standard block.
    Block(StandardBlock),
}

/// Something that can be read and written.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub struct Place {
    /// The variable or block instance.
    pub variable: VariableId,
    /// The pin, if it is an instance.
    pub pin: Option<PinId>,
    /// One bit of the (bit string) value, from 0.
    pub bit: Option<u8>,
}

/// A pin of a block, by its place in the block's list of inputs or of outputs.
#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Debug)]
pub enum PinId {
    /// An input. Not wired, it keeps its last value; at first that is 0.
    Input(usize),
    /// An output.
    Output(usize),
}

/// A rung that runs.
#[derive(Clone, PartialEq, Debug)]
pub struct Rung {
    /// Its name, or `rung N` by its place among all rungs of the source, from 1.
    pub label: String,
    /// What it is for, in the drawer's words.
    pub title: Option<String>,
    /// How many nodes its branches name.
    pub nodes: u32,
    /// Its network.
    pub circuit: Circuit,
    /// Where.
    pub span: Span,
}

/// A rung that runs, by its place in [`Checked::rungs`].
#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Debug)]
pub struct RungIndex(pub u32);

impl RungIndex {
    /// The place as an index.
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// A node of a rung, from 0.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub struct NodeId(pub u32);

/// Branches in parallel, run from the first to the last. The power on the right is the OR of those branches that end there.
#[derive(Clone, PartialEq, Debug)]
pub struct Circuit {
    /// At least one.
    pub branches: Vec<Branch>,
}

/// Elements in series.
#[derive(Clone, PartialEq, Debug)]
pub struct Branch {
    /// The node that it starts at, every feeder of which stands before; else it starts at the left of its circuit.
    pub from: Option<NodeId>,
    /// In order.
    pub elements: Vec<Element>,
    /// The node that it feeds; else it ends at the right of its circuit.
    pub to: Option<NodeId>,
}

/// One element, which maps the power on its left to the power on its right.
#[derive(Clone, PartialEq, Debug)]
pub enum Element {
    /// Power passes as a BOOL says.
    Contact {
        /// How the operand is read.
        kind: ContactKind,
        /// A BOOL.
        operand: Expression,
    },
    /// Writes a BOOL and passes its power on.
    Coil {
        /// What is written.
        kind: CoilKind,
        /// A BOOL.
        target: Place,
    },
    /// Calls a block.
    Call(Call),
    /// Conducts while a BOOL expression is true.
    Condition(Expression),
    /// Writes while it has power, and passes its power on. The expression is computed in either case.
    Assignment {
        /// What is written.
        target: Place,
        /// A value of its type.
        value: Expression,
    },
    /// Branches in parallel.
    Parallel(Circuit),
    /// With power, execution goes on at once at a later rung. What stands between is not executed, the later elements
    /// of this rung among it: nothing is written, no block runs, no memory follows its edge. The last of its branch
    /// and in no circuit at a pin; there is no power on its right.
    Jump(RungIndex),
    /// The same to behind the last rung.
    Return,
}

/// A call of a block. In this order: the wired inputs are computed and kept, in the order written; the block runs;
/// the wired outputs are written.
#[derive(Clone, PartialEq, Debug)]
pub struct Call {
    /// The instance.
    pub instance: VariableId,
    /// Its type.
    pub block: StandardBlock,
    /// The input that the power on the left feeds. `None`: that power is EN instead, and while it is FALSE the block
    /// does not run and keeps its outputs and memories, and the wired outputs are not written.
    pub power_input: Option<usize>,
    /// The other wired inputs, in the order written.
    pub inputs: Vec<Input>,
    /// The wired outputs, in the order written: which one, and where to.
    pub outputs: Vec<(usize, Place)>,
    /// The BOOL output that gives the power on the right. `None`: the power is ENO, which equals EN, and is
    /// TRUE where the power on the left feeds an input.
    pub power_output: Option<usize>,
}

/// A wired input.
#[derive(Clone, PartialEq, Debug)]
pub struct Input {
    /// Which one.
    pub pin: usize,
    /// What it gets.
    pub wire: Wire,
}

/// What an input gets.
#[derive(Clone, PartialEq, Debug)]
pub enum Wire {
    /// A value of its type.
    Value(Expression),
    /// The power on the right of a circuit from the left rail.
    Circuit(Circuit),
}

/// An expression and its type.
#[derive(Clone, PartialEq, Debug)]
pub struct Expression {
    /// The type of its value.
    pub ty: Elementary,
    /// What it is.
    pub kind: ExpressionKind,
}

/// What an expression is. All operators are total: integers wrap around, what is divided by zero is 0 (of MOD too),
/// REALs follow IEEE 754.
#[derive(Clone, PartialEq, Debug)]
pub enum ExpressionKind {
    /// A constant.
    Constant(Value),
    /// What a place holds now.
    Read(Place),
    /// An operand of the same type.
    Unary(UnaryOperator, Box<Expression>),
    /// Two operands of one type, which but for comparisons is also the result's.
    Binary(BinaryOperator, Box<Expression>, Box<Expression>),
    /// An operand of a narrower numeric type, widened without loss; INT to REAL and DINT to LREAL are such, too.
    Widen(Box<Expression>),
    /// A function of operands of the types that its parameters have.
    Call {
        /// Which.
        function: Function,
        /// Its arguments, in the order of the parameters.
        arguments: Vec<Expression>,
    },
}
