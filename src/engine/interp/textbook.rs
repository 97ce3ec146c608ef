//! The textbook interpreter: one instruction after another, each as `evaluate` defines it.
//!
//! It is the [`Executor`] and nothing else; the other engines are tested against it. A speed-up measured over it is one
//! over the usual interpreter.

use std::ops::Range;

use rung_runtime::Scan;

use crate::logic::execute::Executor;
use crate::logic::{Instruction, Program, Turn, verify};

/// A program, interpreted instruction by instruction.
#[derive(Clone, Debug)]
pub struct Textbook {
    /// Each task: when it is due, and its instructions.
    tasks: Vec<(Turn, Range<usize>)>,
    instructions: Vec<Instruction>,
    executor: Executor,
    /// The result of each instruction, in register form.
    values: Vec<u64>,
}

impl Textbook {
    /// Makes ready to interpret a verified program.
    pub fn new(program: &Program) -> Self {
        debug_assert_eq!(verify(program), Ok(()), "engines take verified programs only");
        let tasks = (0..program.tasks.len())
            .map(|task| {
                let turn = Turn::of(&program.tasks[task], &program.layout);
                (turn, program.instruction_range(program.task_range(task)))
            })
            .collect();
        Self {
            tasks,
            instructions: program.instructions.clone(),
            executor: Executor::new(&program.layout),
            values: vec![0; program.instructions.len()],
        }
    }
}

impl Scan for Textbook {
    fn scan(&mut self, image: &mut [u8], now: i64) {
        for task in 0..self.tasks.len() {
            let (turn, range) = self.tasks[task].clone();
            if turn.take(image, now) {
                self.executor.execute(&self.instructions, range, &mut self.values, image, now);
            }
        }
    }
}
