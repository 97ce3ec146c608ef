//! The checked program: every name resolved, every type known, every constant folded.
//!
//! This is what `lower` turns into logic and what the tests' independent evaluator walks. Its fields can be read by
//! all and made by this module's parent only, so that whoever holds a [`Checked`] holds a program that runs.

use std::ops::Range;

use lean_string::LeanString;
use thin_vec::ThinVec;

use crate::elementary::{Elementary, Value};
use crate::ladder::functions::Function;
use crate::ladder::library::StandardBlock;
use crate::ladder::{Address, BinaryOperator, CoilKind, ContactKind, UnaryOperator, VariableClass};
use crate::source::Span;

/// A program that was checked and has no error.
#[derive(Clone, PartialEq, Debug)]
pub struct Checked {
    pub(super) name: LeanString,
    pub(super) arrays: Vec<ArrayType>,
    pub(super) structures: Vec<Structure>,
    pub(super) variables: Vec<Variable>,
    pub(super) globals: Vec<VariableId>,
    pub(super) units: Vec<Unit>,
    pub(super) tasks: Vec<Task>,
    pub(super) programs: Vec<ProgramInstance>,
}

impl Checked {
    /// The name of the whole.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The array types.
    pub fn array(&self, id: ArrayTypeId) -> &ArrayType {
        &self.arrays[id.0 as usize]
    }

    /// The structures.
    pub fn structure(&self, id: StructureId) -> &Structure {
        &self.structures[id.0 as usize]
    }

    /// All variables and block instances: those of all units, each unit's side by side, and the global ones.
    pub fn variables(&self) -> &[Variable] {
        &self.variables
    }

    /// One variable.
    pub fn variable(&self, id: VariableId) -> &Variable {
        &self.variables[id.index()]
    }

    /// The global variables: the declared ones in order, then the addresses and registers that their use declares.
    pub fn globals(&self) -> impl Iterator<Item = VariableId> + use<'_> {
        self.globals.iter().copied()
    }

    /// The programs, function blocks and functions.
    pub fn units(&self) -> &[Unit] {
        &self.units
    }

    /// One unit.
    pub fn unit(&self, id: UnitId) -> &Unit {
        &self.units[id.index()]
    }

    /// The tasks, in the order in which those run that are due in one round: by priority, then as declared. Programs
    /// without a task run in one more, which is due in every round and comes last.
    pub fn tasks(&self) -> &[Task] {
        &self.tasks
    }

    /// The program instances, task by task in the order of [`Checked::tasks`], and within a task as declared.
    pub fn programs(&self) -> &[ProgramInstance] {
        &self.programs
    }

    /// The type of a place, without regard to its bit.
    pub fn type_of(&self, place: &Place) -> Type {
        place.path.iter().fold(self.variable(place.variable).ty, |ty, step| match (step, ty) {
            (Step::Field(field), Type::Structure(structure)) => self.structure(structure).fields[*field].ty,
            (Step::Pin(pin), Type::Block(block)) => Type::Elementary(match pin {
                PinId::Input(pin) => block.inputs()[*pin].ty,
                PinId::Output(pin) => block.outputs()[*pin].ty,
            }),
            (Step::Variable(variable), _) => self.variable(*variable).ty,
            (Step::Element(_), Type::Array(array)) => self.array(array).element,
            _ => unreachable!("checking makes only paths that their types have"),
        })
    }
}

macro_rules! ids {
    ($($(#[$doc:meta])* $name:ident;)*) => {$(
        $(#[$doc])*
        #[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Debug)]
        pub struct $name(pub u32);

        impl $name {
            /// The place as an index.
            pub fn index(self) -> usize {
                self.0 as usize
            }
        }
    )*};
}

ids! {
    /// A variable, by its place in [`Checked::variables`].
    VariableId;
    /// A unit, by its place in [`Checked::units`].
    UnitId;
    /// An array type, by its place among all.
    ArrayTypeId;
    /// A structure, by its place among all.
    StructureId;
    /// A task, by its place in [`Checked::tasks`].
    TaskId;
    /// A rung that runs, by its place in [`Unit::rungs`].
    RungIndex;
    /// A node of a rung, from 0.
    NodeId;
}

/// A task.
#[derive(Clone, PartialEq, Debug)]
pub struct Task {
    /// Its name.
    pub name: LeanString,
    /// Nanoseconds, above 0: it is due in the first round at or after each multiple, the first round included. Without one
    /// it is due in every round.
    pub interval: Option<i64>,
    /// Where; of the one that no declaration made, nowhere.
    pub span: Span,
}

/// A program that runs.
#[derive(Clone, PartialEq, Debug)]
pub struct ProgramInstance {
    /// Its name.
    pub name: LeanString,
    /// The program that it is one of.
    pub unit: UnitId,
    /// The task that it runs in.
    pub task: TaskId,
}

/// A program, function block or function.
#[derive(Clone, PartialEq, Debug)]
pub struct Unit {
    /// Its name.
    pub name: LeanString,
    /// What it is.
    pub kind: UnitKind,
    /// Its variables: the declared ones in order, then those that their use declares.
    pub(super) variables: Range<u32>,
    /// Of a function block or function: the variables that a call gives it, in order.
    pub inputs: Vec<VariableId>,
    /// Of a function block or function: the variables that a call takes from it, in order; of a function with a
    /// result, that first.
    pub outputs: Vec<VariableId>,
    /// Of a function block or function: the variables that stand for those of the caller, in order.
    pub references: Vec<VariableId>,
    /// The rungs that run, in order.
    pub rungs: Vec<Rung>,
    /// Its first line.
    pub span: Span,
}

impl Unit {
    /// Its variables, in order.
    pub fn variables(&self) -> impl Iterator<Item = VariableId> + use<> {
        self.variables.clone().map(VariableId)
    }

    /// Of a function: the variable that holds its result.
    pub fn result(&self) -> Option<VariableId> {
        if self.kind == (UnitKind::Function { has_result: true }) { self.outputs.first().copied() } else { None }
    }
}

/// What a unit is.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum UnitKind {
    /// It runs by itself.
    Program,
    /// Its instances run where they are called.
    FunctionBlock,
    /// It runs where it is called, and starts afresh each time: all its variables hold their initial values then. None
    /// of them, or of what it calls, remembers anything.
    Function {
        /// Whether it has a result.
        has_result: bool,
    },
}

/// A variable or block instance.
#[derive(Clone, PartialEq, Debug)]
pub struct Variable {
    /// Its name, as it was spelled first; an address that was used without a declaration is spelled canonically, as `%IX0.3`.
    pub name: LeanString,
    /// What it is declared as. An address without a declaration has the class of its area, and so has a `var` at one.
    pub class: VariableClass,
    /// Its type.
    pub ty: Type,
    /// What it starts with, the same for all that share storage.
    pub initial: Initial,
    /// Whether it keeps its value, or a block all of its memory, while the power is off.
    pub retain: bool,
    /// Its address.
    pub address: Option<Box<Address>>,
    /// The earlier variable at the same address and of the same width, whose storage this one shares.
    pub shares: Option<VariableId>,
    /// Its name where it is declared, or first used.
    pub span: Span,
}

/// The type of a variable.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum Type {
    /// A value.
    Elementary(Elementary),
    /// An instance of a standard block.
    Block(StandardBlock),
    /// An instance of a function block of the program's own.
    Unit(UnitId),
    /// Elements of one type.
    Array(ArrayTypeId),
    /// Members side by side.
    Structure(StructureId),
}

/// An array type. Two that are written alike are one.
#[derive(Clone, PartialEq, Eq, Hash, Debug)]
pub struct ArrayType {
    /// At least one, the slowest first.
    pub dimensions: Vec<Dimension>,
    /// The type of its elements.
    pub element: Type,
}

impl ArrayType {
    /// How many elements it has.
    pub fn count(&self) -> u32 {
        self.dimensions.iter().map(|dimension| dimension.count).product()
    }
}

/// One dimension of an array.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub struct Dimension {
    /// The index of the first element.
    pub first: i64,
    /// How many there are, at least 1.
    pub count: u32,
}

/// A structure.
#[derive(Clone, PartialEq, Debug)]
pub struct Structure {
    /// Its name.
    pub name: LeanString,
    /// Its members, in order.
    pub fields: Vec<Field>,
}

/// A member of a structure.
#[derive(Clone, PartialEq, Debug)]
pub struct Field {
    /// Its name.
    pub name: LeanString,
    /// Its type.
    pub ty: Type,
    /// What it starts with, where the variable does not say.
    pub initial: Initial,
}

/// What a variable starts with.
#[derive(Clone, PartialEq, Debug)]
pub enum Initial {
    /// What its type says: zero; of a structure's members and of a block's variables what is declared there.
    Default,
    /// A value of its type.
    Value(Value),
    /// One for each element, in order.
    Elements(ThinVec<Initial>),
    /// For some members of a structure or block instance, each once; the others start with what their declaration says.
    Members(ThinVec<(Step, Initial)>),
}

impl Initial {
    /// The value of something elementary.
    pub fn value(&self, ty: Elementary) -> Value {
        match self {
            Self::Value(value) => *value,
            _ => Value::default_of(ty),
        }
    }
}

/// Something that has storage: a variable, or the part of it at the end of a path.
#[derive(Clone, PartialEq, Debug)]
pub struct Place {
    /// The variable or block instance.
    pub variable: VariableId,
    /// The way from there; empty for all of it.
    pub path: ThinVec<Step>,
    /// One bit of the (bit string) value, from 0.
    pub bit: Option<u8>,
}

impl Place {
    /// All of a variable.
    pub fn of(variable: VariableId) -> Self {
        Self { variable, path: ThinVec::new(), bit: None }
    }
}

/// One step into a variable.
#[derive(Clone, PartialEq, Debug)]
pub enum Step {
    /// A member of a structure, by its place.
    Field(usize),
    /// A pin of a standard block.
    Pin(PinId),
    /// A variable of an instance of a unit.
    Variable(VariableId),
    /// An element of an array, one index for each dimension.
    Element(Vec<Index>),
}

/// An index of one dimension.
#[derive(Clone, PartialEq, Debug)]
pub enum Index {
    /// From 0, below the count.
    Constant(u32),
    /// A LINT between the declared bounds, or outside them: then the whole place reads as its type's default, and what is written
    /// to it is lost.
    Computed(Box<Expression>),
}

/// A pin of a standard block, by its place in the block's list of inputs, or of outputs.
#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Debug)]
pub enum PinId {
    /// An input. Not wired, it keeps its last value; at first that is the pin's default.
    Input(usize),
    /// An output.
    Output(usize),
}

/// A rung that runs.
#[derive(Clone, PartialEq, Debug)]
pub struct Rung {
    /// Its name, or `rung N` by its place among all rungs of the source, from 1.
    pub label: LeanString,
    /// What it is for, in the drawer's words.
    pub title: Option<LeanString>,
    /// How many nodes its branches name.
    pub nodes: u32,
    /// Its network.
    pub circuit: Circuit,
    /// Where.
    pub span: Span,
}

/// Branches in parallel, run from the first to the last. The power on the right is the OR of those branches that end there.
#[derive(Clone, PartialEq, Debug)]
pub struct Circuit {
    /// At least one.
    pub branches: Box<[Branch]>,
}

/// Elements in series.
#[derive(Clone, PartialEq, Debug)]
pub struct Branch {
    /// The node that it starts at, every feeder of which stands before; else it starts at the left of its circuit.
    pub from: Option<NodeId>,
    /// In order.
    pub elements: Box<[Element]>,
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
    /// Calls a block, or a function in a box of its own.
    Call(Box<Call>),
    /// Conducts while a BOOL expression is true.
    Condition(Expression),
    /// Writes while it has power. The expression is computed in either case. The power on its right is that on its left;
    /// but FALSE where an index was out of range.
    Assignment {
        /// What is written.
        target: Place,
        /// A value of its type.
        value: Box<Expression>,
    },
    /// Executes while it has power. The power on its right is that on its left; but FALSE where an index was out of range in
    /// what was executed.
    Statements(Vec<Statement>),
    /// Branches in parallel.
    Parallel(Circuit),
    /// With power, execution goes on at once at a later rung. What stands between is not executed, the later elements
    /// of this rung among it: nothing is written, no block runs, no memory follows its edge. The last of its branch
    /// and in no circuit at a pin; there is no power on its right.
    Jump(RungIndex),
    /// The same to behind the last rung of the unit.
    Return,
}

/// A call. In this order: the wired inputs are computed and, of an instance, kept, in the order written; what is called
/// runs; the wired outputs are written.
///
/// It is **enabled** while both EN, where that is wired, and the power on the left are TRUE; but the power on the left does
/// not count where it feeds an input, and there is none in a statement. What is not enabled does not run: an instance keeps its
/// outputs and memories, and of the wired outputs only ENO is written.
#[derive(Clone, PartialEq, Debug)]
pub struct Call {
    /// What is called.
    pub callee: Callee,
    /// What is wired to EN.
    pub enable: Option<Wire>,
    /// The input that the power on the left feeds.
    pub power_input: Option<usize>,
    /// The other wired inputs, in the order written. Of a standard function all are wired. Not wired, an input of an instance
    /// keeps its last value, and one of a function has its initial value.
    pub inputs: Vec<Input>,
    /// The places that its references stand for, each by its place among the unit's references or, of a standard block, among
    /// its inputs; all are given. Computed indices are in no such place that holds block instances.
    pub references: Vec<(usize, Place)>,
    /// The wired outputs, in the order written: which one, and where to.
    pub outputs: Vec<(Output, Place)>,
    /// What gives the power on the right; it is FALSE for an output of a function that is not enabled.
    pub power_output: Output,
}

/// What a call calls.
#[derive(Clone, PartialEq, Debug)]
pub enum Callee {
    /// An instance of a standard block. Computed indices are in no such place.
    Standard(StandardBlock, Place),
    /// An instance of a function block of the program's own. Computed indices are in no such place.
    Unit(UnitId, Place),
    /// A standard function, with the type of its result. Its one output is that.
    Function(Function, Elementary),
    /// A function of the program's own.
    UserFunction(UnitId),
}

/// An output of what is called.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum Output {
    /// By its place among the outputs.
    Pin(usize),
    /// Whether the call was enabled and did not fail: no index out of range at a pin, and no integer or TIME divided by an
    /// integer zero, or by no time, by DIV or MOD.
    Eno,
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
    /// A function of the program's own: what each of its inputs, in their order, gets.
    UserCall {
        /// Which; it has a result.
        unit: UnitId,
        /// As many as it has inputs; those that are not given have their initial values.
        arguments: ThinVec<Option<Expression>>,
        /// The places that its references stand for, in their order.
        references: ThinVec<Place>,
    },
    /// A function of operands of the types that its parameters have.
    Call {
        /// Which.
        function: Function,
        /// Its arguments, in the order of the parameters.
        arguments: ThinVec<Expression>,
    },
}

/// Ranges of values, both ends included.
type Labels = Vec<(Value, Value)>;

/// One statement, which is executed where it stands.
#[derive(Clone, PartialEq, Debug)]
pub enum Statement {
    /// Writes a value.
    Assignment {
        /// What is written.
        target: Place,
        /// A value of its type.
        value: Expression,
    },
    /// Writes all of an array or structure.
    Copy {
        /// What is written.
        target: Place,
        /// What it gets, of the same type.
        source: Place,
        /// A BOOL that is set to whether all indices were in range.
        done: Option<Place>,
    },
    /// Calls.
    Call(Call),
    /// The first branch whose condition holds is executed. A condition is computed only if none before it holds.
    If {
        /// In order: a BOOL, and what it is for.
        branches: Vec<(Expression, Vec<Statement>)>,
        /// What is executed if none holds.
        otherwise: Vec<Statement>,
    },
    /// The first branch with a label that the selector matches is executed.
    Case {
        /// An integer, computed once.
        selector: Expression,
        /// In order: ranges, both ends included, and what they are for.
        branches: Vec<(Labels, Vec<Statement>)>,
        /// What is executed if none matches.
        otherwise: Vec<Statement>,
    },
    /// Repeats a body: before the n-th time, from 0, `first + n * step` is written to the variable, and at the end one step
    /// more.
    For {
        /// A variable of an integer type, all of it.
        variable: Place,
        /// Of that type.
        first: Value,
        /// Not 0.
        step: i128,
        /// How many times.
        count: u32,
        /// What is repeated.
        body: Vec<Statement>,
    },
    /// Leaves the innermost FOR.
    Exit,
    /// Leaves the unit, as [`Element::Return`] does.
    Return,
}
