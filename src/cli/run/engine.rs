//! The engines that `rung run` chooses from.

use rung_runtime::Scan;

use crate::engine::both::{Both, Difference};
use crate::engine::elide::Elided;
use crate::engine::interp::Interpreter;
use crate::engine::jit::{CompileError, Jit};
use crate::logic::Program;
use crate::replay::{Recorder, Replay};

/// Which engine runs the program
#[derive(Clone, Copy, PartialEq, Eq, Debug, clap::ValueEnum)]
pub(super) enum Kind {
    /// Compiled in this process
    Jit,
    /// Interpreted
    Interp,
    /// Both on every scan, compared; the run stops where they differ
    Both,
}

impl Kind {
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Jit => "jit",
            Self::Interp => "interp",
            Self::Both => "both",
        }
    }
}

/// An engine that is ready to run.
#[derive(Debug)]
pub(super) enum Engine {
    Jit(Jit),
    Interp(Interpreter),
    Both(Box<Recorder<Both<Interpreter, Jit>>>),
    /// One of the others, without the scans that would change nothing.
    Elided(Box<Elided<Self>>),
}

impl Engine {
    pub(super) fn new(kind: Kind, program: &Program) -> Result<Self, CompileError> {
        Ok(match kind {
            Kind::Jit => Self::Jit(Jit::compile(program)?),
            Kind::Interp => Self::Interp(Interpreter::new(program)),
            Kind::Both => {
                let both = Both::new(Interpreter::new(program), Jit::compile(program)?, &program.layout);
                Self::Both(Box::new(Recorder::new(both, &program.layout)))
            }
        })
    }

    /// The same, but scans that would change nothing are left out.
    pub(super) fn elided(kind: Kind, program: &Program) -> Result<Self, CompileError> {
        Ok(Self::Elided(Box::new(Elided::new(Self::new(kind, program)?, program))))
    }

    /// Scans that were left out, where any may be.
    pub(super) fn left_out(&self) -> Option<u64> {
        if let Self::Elided(elided) = self { Some(elided.left_out()) } else { None }
    }

    /// Bytes of machine code, where there is any.
    pub(super) fn code_bytes(&self) -> Option<usize> {
        match self {
            Self::Jit(jit) => Some(jit.code_bytes()),
            Self::Interp(_) => None,
            Self::Both(both) => Some(both.recorded().second().code_bytes()),
            Self::Elided(elided) => elided.engine().code_bytes(),
        }
    }

    /// What the two engines disagree on, and the scans that lead there; the replay's reason and program are left
    /// empty.
    pub(super) fn difference(&self, program: &Program) -> Option<(Difference, Replay)> {
        let both = match self {
            Self::Both(both) => both,
            Self::Elided(elided) => return elided.engine().difference(program),
            Self::Jit(_) | Self::Interp(_) => return None,
        };
        let difference = both.recorded().difference(program)?;
        Some((difference, both.replay(String::new(), 0, &program.layout, String::new())))
    }
}

impl Scan for Engine {
    fn scan(&mut self, image: &mut [u8], now: i64) {
        match self {
            Self::Jit(jit) => jit.scan(image, now),
            Self::Interp(interpreter) => interpreter.scan(image, now),
            Self::Both(both) => both.scan(image, now),
            Self::Elided(elided) => elided.scan(image, now),
        }
    }

    fn scan_inputs(&mut self, image: &mut [u8], now: i64) {
        match self {
            Self::Elided(elided) => elided.scan_inputs(image, now),
            Self::Jit(_) | Self::Interp(_) | Self::Both(_) => self.scan(image, now),
        }
    }

    fn trusted(&self) -> bool {
        match self {
            Self::Jit(_) | Self::Interp(_) => true,
            Self::Both(both) => both.trusted(),
            Self::Elided(elided) => elided.trusted(),
        }
    }
}
