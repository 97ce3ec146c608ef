//! What can go wrong with a controller, as types to match on; each also says it to a person.

use std::fmt;

use crate::diagnostic::{Diagnostic, render};
use crate::elementary::{Elementary, Unfit};
use crate::engine::jit::CompileError;
use crate::source::Source;

/// Diagnostics together with the source that they are about. Displayed as `rung check` prints them: each with its code,
/// its line and what to do about it.
#[derive(Clone)]
pub struct Findings {
    /// The program's text.
    pub source: Source,
    /// What was found in it, in no particular order.
    pub diagnostics: Vec<Diagnostic>,
}

impl fmt::Display for Findings {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(render(&self.source, &self.diagnostics).trim_end())
    }
}

/// As displayed: what `unwrap` and `?` in `main` print is for people, too.
impl fmt::Debug for Findings {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "\n{self}")
    }
}

/// Why a controller could not do what was asked. It is then as it was before.
#[derive(Debug)]
#[non_exhaustive]
pub enum Error {
    /// The program has errors: at least one of the findings is one.
    Program(Box<Findings>),
    /// The program is sound, but no machine code could be made of it here. The interpreter takes it all the same.
    Compile(CompileError),
    /// There is no variable of this name.
    NoVariable {
        /// The name that was asked for.
        name: String,
        /// The name that is nearest to it, where one is near.
        nearest: Option<String>,
    },
    /// A variable cannot be set to this.
    NotTaken {
        /// The variable, as the program spells it.
        name: String,
        /// Its type.
        ty: Elementary,
        /// What it was to be set to, as `{:?}` has it.
        given: String,
    },
    /// A variable's value cannot be had as the Rust type that was asked for.
    NotGiven {
        /// The variable, as the program spells it.
        name: String,
        /// Its value, and the type that was asked for.
        unfit: Unfit,
    },
    /// Retained bytes are of an image that is laid out otherwise.
    OtherLayout {
        /// This program's layout.
        expected: u64,
        /// The layout that they are of.
        found: u64,
    },
    /// There are too few or too many retained bytes.
    RetainedSize {
        /// How many this program has.
        expected: usize,
        /// How many there are.
        found: usize,
    },
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Program(findings) => findings.fmt(f),
            Self::Compile(error) => error.fmt(f),
            Self::NoVariable { name, nearest: None } => write!(f, "the program has no variable `{name}`"),
            Self::NoVariable { name, nearest: Some(nearest) } => {
                write!(f, "the program has no variable `{name}`; is it `{nearest}`?")
            }
            Self::NotTaken { name, ty, given } => write!(f, "`{name}` is of type {ty} and cannot be set to {given}"),
            Self::NotGiven { name, unfit } => write!(f, "`{name}`: {unfit}"),
            Self::OtherLayout { expected, found } => write!(
                f,
                "these retained bytes are of the layout {found:016x}, and the program's is {expected:016x}: its \
                 variables or blocks were changed since"
            ),
            Self::RetainedSize { expected, found } => {
                write!(f, "there are {found} retained bytes, and the program has {expected}")
            }
        }
    }
}

impl std::error::Error for Error {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            Self::Compile(error) => Some(error),
            Self::NotGiven { unfit, .. } => Some(unfit),
            Self::Program(_)
            | Self::NoVariable { .. }
            | Self::NotTaken { .. }
            | Self::OtherLayout { .. }
            | Self::RetainedSize { .. } => None,
        }
    }
}

impl From<CompileError> for Error {
    fn from(error: CompileError) -> Self {
        Self::Compile(error)
    }
}
