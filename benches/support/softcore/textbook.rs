//! A program as bytecode for `textbook.c`: an operation of logic is an operation there.

use rung::elementary::Elementary;
use rung::engine::interp::Stream;
use rung::logic::{Binary, Compare, Op, Program, Unary, ValueId};

/// The first word of each operation, in the order of `textbook.c`.
#[derive(Clone, Copy)]
enum Operation {
    Load8,
    Load64,
    Not,
    And,
    Or,
    ExclusiveOr,
    Add64,
    Subtract64,
    Minimum64,
    Maximum64,
    Equal64,
    NotEqual64,
    Less64,
    LessOrEqual64,
    Greater64,
    GreaterOrEqual64,
    Select8,
    Select64,
    End,
}

/// A generated program of one task: BOOL and TIME only.
pub(crate) fn stream(program: &Program) -> Stream {
    let now = program.layout.size();
    let mut bytecode = Bytecode { words: Vec::new(), cells: vec![0; now as usize + 8], places: Vec::new() };
    // The constants lie before what is computed, since they keep their cells.
    for (index, instruction) in program.instructions.iter().enumerate() {
        if let Op::Constant(bits) = instruction.op {
            let place = bytecode.cell(instruction.ty);
            let (bytes, size) = (bits.to_ne_bytes(), instruction.ty.size() as usize);
            let bytes = if cfg!(target_endian = "little") { &bytes[..size] } else { &bytes[8 - size..] };
            bytecode.cells[place..place + size].copy_from_slice(bytes);
            bytecode.places.push((index, place));
        }
    }
    let constants: std::collections::HashMap<usize, usize> = bytecode.places.drain(..).collect();
    let mut places = vec![0; program.instructions.len()];
    let (first, mut most) = (bytecode.cells.len(), bytecode.cells.len());
    for chunk in program.chunks() {
        // No value lives beyond its chunk.
        bytecode.cells.truncate(first);
        for index in program.instruction_range(chunk) {
            let instruction = program.instructions[index];
            let of = |value: ValueId| places[value.index()];
            places[index] = match instruction.op {
                Op::Constant(_) => constants[&index],
                Op::Now => now as usize,
                Op::Load(slot) => {
                    let from = program.layout.slot(slot).offset as usize;
                    let to = bytecode.cell(instruction.ty);
                    bytecode.push(load(instruction.ty), &[to, from]);
                    to
                }
                Op::Store(slot, value) => {
                    let slot = program.layout.slot(slot);
                    bytecode.push(load(slot.ty), &[slot.offset as usize, of(value)]);
                    continue;
                }
                op => {
                    let operands: Vec<usize> = op.operands().map(of).collect();
                    let first = op.operands().next().map(|value| program.instructions[value.index()].ty);
                    let to = bytecode.cell(instruction.ty);
                    let all: Vec<usize> = [to].into_iter().chain(operands).collect();
                    bytecode.push(operation(op, first.unwrap_or(instruction.ty), instruction.ty), &all);
                    to
                }
            };
        }
        most = most.max(bytecode.cells.len());
    }
    bytecode.push(Operation::End, &[]);
    bytecode.cells.resize(most, 0);
    Stream { words: bytecode.words, cells: bytecode.cells, now: u16::try_from(now).expect("a small image") }
}

struct Bytecode {
    words: Vec<u16>,
    cells: Vec<u8>,
    /// The constants: the instruction, and where its cell is.
    places: Vec<(usize, usize)>,
}

impl Bytecode {
    /// A cell of its own for a value.
    fn cell(&mut self, ty: Elementary) -> usize {
        let place = self.cells.len().next_multiple_of(ty.size() as usize);
        self.cells.resize(place + ty.size() as usize, 0);
        place
    }

    fn push(&mut self, operation: Operation, cells: &[usize]) {
        self.words.push(operation as u16);
        self.words.extend(cells.iter().map(|cell| u16::try_from(*cell).expect("less than 64 KiB of cells")));
    }
}

/// Loads and stores are one: bytes go from cell to cell.
fn load(ty: Elementary) -> Operation {
    if ty == Elementary::Bool { Operation::Load8 } else { Operation::Load64 }
}

fn operation(op: Op, of: Elementary, ty: Elementary) -> Operation {
    let boolean = of == Elementary::Bool;
    match op {
        Op::Unary(Unary::Not, _) if boolean => Operation::Not,
        Op::Binary(Binary::And, ..) if boolean => Operation::And,
        Op::Binary(Binary::Or, ..) if boolean => Operation::Or,
        Op::Binary(Binary::Xor, ..) if boolean => Operation::ExclusiveOr,
        Op::Binary(Binary::Add, ..) => Operation::Add64,
        Op::Binary(Binary::Subtract, ..) => Operation::Subtract64,
        Op::Binary(Binary::Minimum, ..) => Operation::Minimum64,
        Op::Binary(Binary::Maximum, ..) => Operation::Maximum64,
        Op::Compare(compare, ..) if !boolean => match compare {
            Compare::Equal => Operation::Equal64,
            Compare::NotEqual => Operation::NotEqual64,
            Compare::Less => Operation::Less64,
            Compare::LessOrEqual => Operation::LessOrEqual64,
            Compare::Greater => Operation::Greater64,
            Compare::GreaterOrEqual => Operation::GreaterOrEqual64,
        },
        Op::Select(..) if ty == Elementary::Bool => Operation::Select8,
        Op::Select(..) => Operation::Select64,
        other => panic!("generated programs hold no {other:?}"),
    }
}
