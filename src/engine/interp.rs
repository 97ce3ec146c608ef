//! Two interpreters: [`Textbook`], which is obviously right, and [`Interpreter`], which is fast.
//!
//! The fast one translates a program once into a compact stream and then only walks it. Everything lies in one array
//! of bytes, its **cells**: the image, the time, the constants and the values between. Whatever is boolean becomes
//! gates, of which a whole run executes without a branch; loads, stores, constants and negations cost nothing of
//! their own. All else becomes steps with cells as operands. Neither may know any block.

mod access;
mod gate;
mod step;
mod stream;
mod textbook;
mod translate;

#[cfg(test)]
mod tests;

use std::ops::Range;

use rung_runtime::Scan;

pub use stream::Stream;
pub use textbook::Textbook;

use crate::logic::{Program, Turn, verify};
use gate::Gate;
use step::Step;

/// A program, translated for fast interpretation. A scan expects every BOOL of the image to be 0 or 1.
#[derive(Clone, Debug)]
pub struct Interpreter {
    tasks: Vec<Part>,
    gates: Vec<Gate>,
    steps: Vec<Step>,
    /// The image; then the time; then the constants; then what is computed on the way, anew in each chunk.
    cells: Vec<u8>,
    image_size: usize,
}

/// A task: when it is due, and what is its.
#[derive(Clone, Debug)]
struct Part {
    turn: Turn,
    gates: Range<usize>,
    steps: Range<usize>,
}

impl Interpreter {
    /// Translates a verified program.
    pub fn new(program: &Program) -> Self {
        debug_assert_eq!(verify(program), Ok(()), "engines take verified programs only");
        translate::translate(program)
    }

    /// Bytes of the translated program: what a scan reads besides the image and the values.
    pub fn code_bytes(&self) -> usize {
        size_of_val(self.gates.as_slice()) + size_of_val(self.steps.as_slice())
    }
}

impl Scan for Interpreter {
    fn scan(&mut self, image: &mut [u8], now: i64) {
        let Self { tasks, gates, steps, cells, image_size } = self;
        // Two copies of the image cost far less than telling two arrays apart at every operand.
        cells[..*image_size].copy_from_slice(&image[..*image_size]);
        cells[*image_size..*image_size + 8].copy_from_slice(&now.to_ne_bytes());
        for Part { turn, gates: own, steps: range } in tasks {
            if !turn.take(cells, now) {
                continue;
            }
            let mut gates = &gates[own.clone()];
            for step in &steps[range.clone()] {
                let (run, rest) = gates.split_at(step.gates_before as usize);
                run.iter().for_each(|gate| gate.execute(cells));
                gates = rest;
                step.execute(cells);
            }
            gates.iter().for_each(|gate| gate.execute(cells));
        }
        image[..*image_size].copy_from_slice(&cells[..*image_size]);
    }
}
