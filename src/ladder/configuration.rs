//! What runs when, and with which resources: tasks, program instances, the size of the register machine.

use super::{Expression, Name};
use crate::source::Span;

/// A task: programs that run together, in every round of scans at which it is due.
#[derive(Clone, PartialEq, Debug)]
pub struct Task {
    /// Its name.
    pub name: Name,
    /// A constant TIME; without one the task runs in every round.
    pub interval: Option<Expression>,
    /// A constant integer: of those due in one round, lower numbers run first. Without one, 0.
    pub priority: Option<Expression>,
    /// The whole declaration.
    pub span: Span,
}

/// An instance of a program under a name of its own.
#[derive(Clone, PartialEq, Debug)]
pub struct ProgramInstance {
    /// Its name.
    pub name: Name,
    /// The program that it is one of.
    pub program: Name,
    /// The task that it runs in.
    pub task: Option<Name>,
    /// The whole declaration.
    pub span: Span,
}

/// The resources of the register machine, as far as they are not the default.
#[derive(Clone, PartialEq, Debug)]
pub struct Registers {
    /// `hreg := 64`: what, and how many.
    pub settings: Vec<Setting>,
    /// The whole declaration.
    pub span: Span,
}

/// One resource of the register machine.
#[derive(Clone, PartialEq, Debug)]
pub struct Setting {
    /// `ireg`, `oreg` and `hreg`: registers of that class; `registers`: of all classes; `timers`, `drums`, `shifts`.
    pub name: Name,
    /// A constant integer.
    pub value: Expression,
}
