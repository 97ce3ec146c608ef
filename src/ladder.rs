//! A ladder program as it was drawn: types, global variables, tasks and units (programs, function blocks, functions),
//! in each unit its declarations and rungs, and in each rung the network of contacts, coils and blocks, everything
//! with its span.
//!
//! This is what front ends make, `fmt` and `show` print, and `check` resolves. It holds names, not meanings:
//! nothing here must look a name up, fold a constant or know how an element computes.
//!
//! A rung's network is a tree of series and parallel with **named nodes** for what no such tree can hold. A
//! branch may end at a node and another may start there, so that any directed network, bridges included, is a
//! list of branches. Within a rung the elements run depth first, left to right and top to bottom, exactly in the
//! order of the tree.

mod configuration;
mod expression;
pub mod functions;
pub mod library;
mod statement;
#[cfg(test)]
mod tests;
mod types;

pub use configuration::{ProgramInstance, Registers, Setting, Task};
pub use expression::{
    ArrayItem, BinaryOperator, Expression, ExpressionKind, FunctionArgument, Literal, Magnitude, MemberValue,
    Reference, Root, Step, UnaryOperator,
};
pub use statement::{CaseBranch, CaseLabel, ConditionalBranch, Statement, StatementKind};
pub use types::{Dimension, Field, TypeDeclaration, TypeKind, TypeReference};

use std::fmt;

/// What names are: text that stands in place where it is short.
pub use lean_string::LeanString;
/// A list that is a pointer where it is empty.
pub use thin_vec::ThinVec;

use crate::source::Span;

/// A name with its spelling as written. Names are compared without regard to case.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Name {
    /// As written, without back quotes. Up to 16 bytes stand in the name itself, which hold most names.
    pub text: LeanString,
    /// Where.
    pub span: Span,
}

impl Name {
    /// A name at a place.
    pub fn new(text: impl Into<LeanString>, span: Span) -> Self {
        Self { text: text.into(), span }
    }

    /// What two spellings of one name have in common: the form to compare and to look up by.
    pub fn key(&self) -> String {
        key(&self.text)
    }
}

/// The form in which names are compared: IEC 61131-3 identifiers are case-insensitive.
pub fn key(name: &str) -> String {
    name.to_lowercase()
}

/// What a program was read from, where checking depends on it.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Origin {
    /// Rung's own text: a doubtful construct is an error.
    Native,
    /// A file of another tool: what that tool accepts is at most a warning.
    Imported,
}

/// One source: everything that it declares.
#[derive(Clone, PartialEq, Debug)]
pub struct Program {
    /// What it was read from.
    pub origin: Origin,
    /// Its name: of the only program, or of the file.
    pub name: Name,
    /// The types that it declares, in order.
    pub types: Vec<TypeDeclaration>,
    /// The variables that all units see, in order. Each is memory or a constant.
    pub globals: Vec<Variable>,
    /// The size of the register machine, where it is said.
    pub registers: Option<Registers>,
    /// The tasks, in order.
    pub tasks: Vec<Task>,
    /// Programs, function blocks and functions, in order.
    pub units: Vec<Unit>,
    /// The program instances that are named one by one. A program that none names runs as one instance of its own name.
    pub instances: Vec<ProgramInstance>,
    /// Every comment of the source, in order of place; printers put them back beside what they stood beside.
    pub comments: Vec<Comment>,
}

impl Program {
    /// A source that declares one program and nothing else.
    pub fn of_one(origin: Origin, name: Name, variables: Vec<Variable>, rungs: Vec<Rung>) -> Self {
        let unit =
            Unit { kind: UnitKind::Program { task: None }, name: name.clone(), variables, rungs, span: name.span };
        Self { units: vec![unit], ..Self::empty(origin, name) }
    }

    /// A source that declares nothing.
    pub fn empty(origin: Origin, name: Name) -> Self {
        Self {
            origin,
            name,
            types: Vec::new(),
            globals: Vec::new(),
            registers: None,
            tasks: Vec::new(),
            units: Vec::new(),
            instances: Vec::new(),
            comments: Vec::new(),
        }
    }

    /// The rungs of all units, in order.
    pub fn rungs(&self) -> impl Iterator<Item = &Rung> {
        self.units.iter().flat_map(|unit| &unit.rungs)
    }
}

/// A program organisation unit (IEC 61131-3, 6.6).
#[derive(Clone, PartialEq, Debug)]
pub struct Unit {
    /// What it is.
    pub kind: UnitKind,
    /// Its name.
    pub name: Name,
    /// The declared variables and block instances, in order.
    pub variables: Vec<Variable>,
    /// The rungs, in order of execution. What is written in structured text is a rung for each statement.
    pub rungs: Vec<Rung>,
    /// Its first line.
    pub span: Span,
}

/// What a unit is.
#[derive(Clone, PartialEq, Debug)]
pub enum UnitKind {
    /// It runs by itself, in a task or in every round of scans.
    Program {
        /// The task that it runs in.
        task: Option<Name>,
    },
    /// A type of instances, each with a memory of its own.
    FunctionBlock,
    /// Computes and remembers nothing. The result is written to its own name.
    Function {
        /// The type of the result; without one there is none.
        result: Option<TypeReference>,
    },
}

/// A comment of the source.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Comment {
    /// What it says, without the marks that make it a comment and without surrounding blanks.
    pub text: String,
    /// Where, marks included.
    pub span: Span,
    /// Whether it stands on a line of its own rather than behind something.
    pub own_line: bool,
}

/// What a declaration declares.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum VariableClass {
    /// Of a program: copied in before each scan. Of a block or function: what a call gives it.
    Input,
    /// Of a program: copied out after each scan. Of a block or function: what a call takes from it.
    Output,
    /// Neither: memory, or a block instance.
    Memory,
    /// Never written after start.
    Constant,
    /// Of a function block or function: the caller's variable itself, for as long as the call lasts (VAR_IN_OUT).
    InOut,
    /// Holds its initial value again whenever the unit starts to run (VAR_TEMP).
    Temporary,
}

/// A declared variable or block instance.
#[derive(Clone, PartialEq, Debug)]
pub struct Variable {
    /// What it is declared as.
    pub class: VariableClass,
    /// Its name.
    pub name: Name,
    /// Its type; BOOL where it is left out.
    pub ty: Option<TypeReference>,
    /// The IEC address that it stands at.
    pub address: Option<Box<Address>>,
    /// The value that it starts with.
    pub initial: Option<Box<Expression>>,
    /// Whether it keeps its value while the power is off.
    pub retain: bool,
    /// The whole declaration.
    pub span: Span,
}

/// The area of a directly represented variable (IEC 61131-3, 6.5.5).
#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Debug)]
pub enum Area {
    /// `%I`
    Input,
    /// `%Q`
    Output,
    /// `%M`
    Memory,
}

/// The width of a directly represented variable.
#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Debug)]
pub enum Width {
    /// `X`, or no letter: one bit.
    Bit,
    /// `B`: 8 bits.
    Byte,
    /// `W`: 16 bits.
    Word,
    /// `D`: 32 bits.
    Double,
    /// `L`: 64 bits.
    Long,
}

impl Width {
    /// How many bits.
    pub const fn bits(self) -> u32 {
        match self {
            Self::Bit => 1,
            Self::Byte => 8,
            Self::Word => 16,
            Self::Double => 32,
            Self::Long => 64,
        }
    }
}

/// An IEC address: `%IX0.3` is area `Input`, width `Bit`, numbers 0 and 3.
#[derive(Clone, PartialEq, Eq, Hash, Debug)]
pub struct Address {
    /// Where it lies.
    pub area: Area,
    /// How wide it is.
    pub width: Width,
    /// The hierarchical numbers, at least one.
    pub numbers: Vec<u32>,
    /// Where it is written.
    pub span: Span,
}

/// The canonical spelling, `%IX0.3`: a bit's address always has its `X`.
impl fmt::Display for Address {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let area = match self.area {
            Area::Input => 'I',
            Area::Output => 'Q',
            Area::Memory => 'M',
        };
        let width = match self.width {
            Width::Bit => 'X',
            Width::Byte => 'B',
            Width::Word => 'W',
            Width::Double => 'D',
            Width::Long => 'L',
        };
        write!(f, "%{area}{width}")?;
        for (place, number) in self.numbers.iter().enumerate() {
            write!(f, "{}{number}", if place == 0 { "" } else { "." })?;
        }
        Ok(())
    }
}

/// One rung.
#[derive(Clone, PartialEq, Debug)]
pub struct Rung {
    /// Its name, where it has one.
    pub name: Option<Name>,
    /// What it is for, in the drawer's words.
    pub title: Option<LeanString>,
    /// Whether it runs; one that is off is checked and drawn all the same.
    pub enabled: bool,
    /// Its network. The left rail is its left side; the power at its right side is not used.
    pub circuit: Circuit,
    /// From its first word to its last element.
    pub span: Span,
}

/// Branches in parallel, from top to bottom: the power on the right is the OR of theirs.
#[derive(Clone, PartialEq, Debug)]
pub struct Circuit {
    /// At least one.
    pub branches: Vec<Branch>,
    /// Where.
    pub span: Span,
}

/// Elements in series, from left to right.
#[derive(Clone, PartialEq, Debug)]
pub struct Branch {
    /// The node that it starts at; without one, the left side of the circuit around it.
    pub from: Option<Box<Name>>,
    /// In order; empty for a plain wire.
    pub elements: Vec<Element>,
    /// The node that it ends at and feeds; without one, the right side of the circuit around it. The power on a
    /// node is the OR of all branches that end there, and they all must stand before the first that starts there.
    pub to: Option<Box<Name>>,
    /// Where.
    pub span: Span,
}

/// One element of a branch.
#[derive(Clone, PartialEq, Debug)]
pub struct Element {
    /// What it is.
    pub kind: ElementKind,
    /// Where.
    pub span: Span,
}

/// What an element is.
#[derive(Clone, PartialEq, Debug)]
pub enum ElementKind {
    /// Passes power on as its operand says.
    Contact {
        /// How it reads the operand.
        kind: ContactKind,
        /// What it reads: a reference, or a literal TRUE or FALSE.
        operand: Expression,
    },
    /// Writes a variable and passes its power on.
    Coil {
        /// What it writes.
        kind: CoilKind,
        /// To where.
        target: Reference,
    },
    /// Calls a function block or, in a box of its own, a function.
    Block(Box<BlockCall>),
    /// Braces around a BOOL expression: a contact that conducts while it is true.
    Condition(Expression),
    /// Braces around an assignment: it executes while it has power, and passes its power on.
    Assignment {
        /// What it writes.
        target: Reference,
        /// The value.
        value: Box<Expression>,
    },
    /// Structured text in braces: it executes while there is power, and passes its power on.
    Statements(Vec<Statement>),
    /// Branches in parallel.
    Parallel(Circuit),
    /// With power, execution goes on at once at a later rung; nothing between is executed. The last of its branch.
    Jump {
        /// The name of that rung.
        target: Name,
    },
    /// With power, the scan ends at once. The last of its branch.
    Return,
}

/// How a contact reads its operand.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum ContactKind {
    /// Normally open: conducts while it is TRUE.
    Open,
    /// Normally closed: conducts while it is FALSE.
    Closed,
    /// Conducts for the scan in which it becomes TRUE.
    Rising,
    /// Conducts for the scan in which it becomes FALSE.
    Falling,
}

/// What a coil writes.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum CoilKind {
    /// The power.
    Plain,
    /// The power, negated.
    Negated,
    /// TRUE while there is power, else nothing.
    Set,
    /// FALSE while there is power, else nothing.
    Reset,
    /// TRUE for the scan in which the power comes.
    Rising,
    /// TRUE for the scan in which the power goes.
    Falling,
}

/// A call of a function block or function.
#[derive(Clone, PartialEq, Debug)]
pub struct BlockCall {
    /// The instance; or the name of a function, where nothing is declared under it.
    pub instance: Reference,
    /// The type, where the call names it; an instance declared elsewhere needs none.
    pub type_name: Option<Name>,
    /// What is wired to the pins, in the order written. `EN` and `ENO` are pins of every box.
    pub arguments: Vec<Argument>,
    /// The BOOL output that gives the power on the right, where one is chosen.
    pub power_output: Option<Name>,
}

/// One wired pin.
#[derive(Clone, PartialEq, Debug)]
pub struct Argument {
    /// The pin; of an argument that only its place tells, a name without letters.
    pub pin: Name,
    /// What is wired to it.
    pub wire: Wire,
    /// The whole argument.
    pub span: Span,
}

/// What is wired to a pin.
#[derive(Clone, PartialEq, Debug)]
pub enum Wire {
    /// `pin := expression`
    Value(Expression),
    /// `pin := [ circuit ]`, from the left rail, to a BOOL input.
    Circuit(Circuit),
    /// `pin => variable`, from an output.
    Output(Reference),
}
