//! Batches: every plant computes what it would alone, the whole image after every scan.

mod batch;
mod command;
mod programs;

#[path = "../support"]
#[allow(dead_code, reason = "other test programs use the rest")]
mod support {
    pub(crate) mod corpus;
    pub(crate) mod dice;
    pub(crate) mod drawing;
    pub(crate) mod random_program;
    pub(crate) mod random_stimuli;
}

use rung::batch::Batch;
use rung::check::check;
use rung::diagnostic::render;
use rung::elementary::Value;
use rung::engine::interp::Interpreter;
use rung::logic::{Program, Slot};
use rung::source::Source;
use rung::{frontend, lower, opt};
use rung_runtime::Scan;

/// The optimised program of a native text.
fn program(text: &str) -> Program {
    let source = Source::new("test.rung", text);
    let parsed = frontend::parse(&source);
    let (checked, problems) = check(&parsed.program);
    let checked = checked.unwrap_or_else(|| {
        panic!("{}{}", render(&source, &parsed.diagnostics), render(&source, &problems));
    });
    opt::optimise(lower::lower(&checked, &source, None).expect("a small image"))
}

/// A batch, and as many interpreted images.
struct Rig<'p> {
    program: &'p Program,
    batch: Batch,
    interpreter: Interpreter,
    images: Vec<Vec<u8>>,
}

impl<'p> Rig<'p> {
    fn new(program: &'p Program, lanes: usize) -> Self {
        let batch = Batch::new(program, lanes).expect("a small image");
        let images = vec![program.layout.initial_image(); lanes];
        Self { program, batch, interpreter: Interpreter::new(program), images }
    }

    /// Sets a variable of a lane in both.
    fn set(&mut self, lane: usize, name: &str, value: Value) {
        let variable = self.batch.variable(name).unwrap_or_else(|error| panic!("{error}"));
        let slot = self.program.layout.slot(variable.slot());
        let value = Value::from_bits(slot.ty, value.bits());
        slot.write(&mut self.images[lane], value);
        self.batch.set(lane, variable, value).expect("a value of its type");
    }

    /// Runs a scan in both.
    fn scan(&mut self, now: i64) {
        self.batch.scan(now);
        self.images.iter_mut().for_each(|image| self.interpreter.scan(image, now));
    }

    /// What is not the same in both, of some lanes.
    fn difference(&self, lanes: impl Iterator<Item = usize>) -> Option<String> {
        for lane in lanes {
            let (found, expected) = (self.batch.image(lane).expect("a lane"), &self.images[lane]);
            if found != *expected {
                let differs = |slot: &&Slot| slot.read(&found) != slot.read(expected);
                let slot = self.program.layout.slots().iter().find(differs);
                let values = slot.map(|slot| (&slot.name, slot.read(&found), slot.read(expected)));
                return Some(format!("lane {lane}: {values:?}\n{}", rung::logic::print(self.program)));
            }
        }
        None
    }
}
