//! The translated program as one stream of 16-bit words, for an interpreter on a small machine.
//!
//! A run of gates is its length and then six words a gate: the table, the four inputs, the target. A step follows it in
//! five: the kind, the target, the operands. After the last run stands [`END`]. Operands and targets are offsets into
//! the cells.

use super::Interpreter;
use super::gate::Gate;
use super::step::{Kind, Step};
use crate::logic::Turn;

/// In the place of a step's kind: the stream ends.
const END: u16 = 16;

/// A program as a stream, and the cells that it runs on.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Stream {
    /// Runs of gates, and steps between them.
    pub words: Vec<u16>,
    /// What the cells hold before the first scan but for the image, at their head, which is 0: constants, in the byte order
    /// of this machine.
    pub cells: Vec<u8>,
    /// The cell of the time, 8 bytes, to be set before a scan.
    pub now: u16,
}

impl Interpreter {
    /// The program as a stream. `None` where it needs more: several tasks, 64 KiB of cells or more, or steps other than
    /// to move and choose values and to compute with TIME and LINT.
    pub fn stream(&self) -> Option<Stream> {
        let [only] = self.tasks.as_slice() else { return None };
        if only.turn != Turn::default() {
            return None;
        }
        let mut words = Vec::new();
        let mut gates = self.gates.as_slice();
        for step in &self.steps {
            let (run, rest) = gates.split_at(step.gates_before as usize);
            push_run(&mut words, run)?;
            push_step(&mut words, step)?;
            gates = rest;
        }
        push_run(&mut words, gates)?;
        words.push(END);
        Some(Stream { words, cells: self.cells.clone(), now: u16::try_from(self.image_size).ok()? })
    }
}

fn push_run(words: &mut Vec<u16>, gates: &[Gate]) -> Option<()> {
    words.push(u16::try_from(gates.len()).ok()?);
    for gate in gates {
        let (table, inputs, target) = gate.parts();
        words.push(table);
        for cell in inputs.into_iter().chain([target]) {
            words.push(u16::try_from(cell).ok()?);
        }
    }
    Some(())
}

fn push_step(words: &mut Vec<u16>, step: &Step) -> Option<()> {
    words.push(number(step.kind)?);
    for cell in [step.target].into_iter().chain(step.operands) {
        words.push(u16::try_from(cell).ok()?);
    }
    Some(())
}

/// The word for a kind of step, if a stream can hold it.
fn number(kind: Kind) -> Option<u16> {
    Some(match kind {
        Kind::Copy8 => 0,
        Kind::Copy16 => 1,
        Kind::Copy32 => 2,
        Kind::Copy64 => 3,
        Kind::Select8 => 4,
        Kind::Select16 => 5,
        Kind::Select32 => 6,
        Kind::Select64 => 7,
        Kind::Add64 => 8,
        Kind::Subtract64 => 9,
        Kind::Minimum64 => 10,
        Kind::Maximum64 => 11,
        Kind::Less64 => 12,
        Kind::LessOrEqual64 => 13,
        Kind::Equal64 => 14,
        Kind::NotEqual64 => 15,
        Kind::Unary(..)
        | Kind::Binary(..)
        | Kind::Compare(..)
        | Kind::Convert(..)
        | Kind::Call(..)
        | Kind::LoadIndexed(..)
        | Kind::StoreIndexed(..)
        | Kind::CopyArray => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::source::Source;
    use crate::{check, frontend, lower};

    fn stream(text: &str) -> Option<Stream> {
        let source = Source::new("program", text);
        let checked = check::check(&frontend::parse(&source).program).0.expect("a sound program");
        Interpreter::new(&lower::lower(&checked, &source, None).expect("a small image")).stream()
    }

    #[test]
    fn contacts_are_one_run_of_gates() {
        let stream = stream("program p\ninput a, b\noutput c\nrung r\n  a /b (c)\n").expect("gates alone");
        // The table of a AND NOT b over a and b, whatever the other inputs; they are a again.
        assert_eq!(stream.words, [1, 0x2222, 0, 1, 0, 0, 2, END]);
        assert_eq!(stream.now, 8);
    }

    #[test]
    fn a_timer_is_steps_and_gates() {
        let stream = stream("program p\ninput a\noutput c\nrung r\n  a t:TON(PT := T#1s) (c)\n").expect("a timer");
        assert_eq!(stream.words.last(), Some(&END));
        assert!(stream.words.iter().all(|word| usize::from(*word) < stream.cells.len() || *word > 255));
    }

    #[test]
    fn what_a_stream_cannot_hold_is_refused() {
        let declarations = "program p\nvar x : INT\nrung r\n";
        assert_eq!(stream(&format!("{declarations}  {{x := x * 3}}\n")), None);
        let task = "task fast(interval := T#10ms, priority := 1)\n";
        assert_eq!(stream(&format!("{task}program p with fast\ninput a\noutput c\nrung r\n  a (c)\n")), None);
    }
}
