//! A segment to machine code for x86-64 with AVX2: vectors of 256 bits, which Cranelift has not, so that a turn does
//! twice as many lanes.
//!
//! The code is a straight line in a loop, so one pass over it is enough: a value stays in a register from where it is
//! made to its last use, and where there are too few, the one that is needed last waits on the stack. Five operations
//! on vectors are all that there is, and no instruction does anything but such an operation, move a vector or close
//! the loop.
//!
//! The function is the same as the others, by the System V convention: the words in `rdi`, the row in `rsi`, the turns
//! in `rdx`.

#[cfg(test)]
mod tests;

use super::fold::{Instruction, Operand};
use super::way;
use crate::engine::lanes::plan::Cell;

/// Vectors of [`VECTOR_LANES`](crate::engine::lanes::VECTOR_LANES) that a turn goes through.
pub(super) const VECTORS: usize = 2;

/// Bytes of a vector.
const BYTES: u8 = 32;

/// Registers that values may be in; behind them one to move through, and one with all ones.
const REGISTERS: u8 = 14;
const SCRATCH: u8 = 14;
const ONES: u8 = 15;

/// Values that may wait on the stack, at most: so that the frame is within a page, and never reaches beyond what is
/// below the stack unseen.
const MOST_SLOTS: u32 = 64;

/// Opcodes of the second map with the prefix 66, but for the last: AND NOT inverts the first of its two operands.
const AND: u8 = 0xDB;
const AND_NOT: u8 = 0xDF;
const OR: u8 = 0xEB;
const XOR: u8 = 0xEF;
const EQUAL: u8 = 0x76;
const LOAD: u8 = 0x6F;
const STORE: u8 = 0x7F;

/// Prefixes, as in a VEX: with 66 memory has to be aligned where it is moved, with F3 not.
const ALIGNED: u8 = 1;
const ANYWHERE: u8 = 2;

/// Base registers.
const STACK: u8 = 4;
const ROW: u8 = 6;
const WORDS: u8 = 7;

/// Whether this machine runs such code.
pub(super) fn is_there() -> bool {
    #[cfg(all(target_arch = "x86_64", unix))]
    {
        std::arch::is_x86_feature_detected!("avx2")
    }
    #[cfg(not(all(target_arch = "x86_64", unix)))]
    {
        false
    }
}

/// The code of a segment, unless too many of its values are needed at once; `moves` tells which pointers a turn moves on.
pub(super) fn assemble(instructions: &[Instruction], moves: [bool; 2]) -> Option<Vec<u8>> {
    let mut uses = vec![Vec::new(); instructions.len()];
    for (index, instruction) in instructions.iter().enumerate().rev() {
        instruction.made().for_each(|made| uses[made as usize].push(index));
    }
    let mut body = Body {
        bytes: Vec::with_capacity(instructions.len() * 9),
        uses,
        registers: [None; REGISTERS as usize],
        places: vec![Place::default(); instructions.len()],
        free_slots: Vec::new(),
        slots: 0,
    };
    for (index, instruction) in instructions.iter().enumerate() {
        body.instruction(index, *instruction);
    }
    if body.slots > MOST_SLOTS {
        return None;
    }
    around(&body.bytes, body.slots * u32::from(BYTES), moves)
}

/// A loop around its body, and a frame of so many bytes around the loop.
fn around(body: &[u8], frame: u32, moves: [bool; 2]) -> Option<Vec<u8>> {
    let mut code = Code::default();
    if frame > 0 {
        // sub rsp, frame
        code.bytes.extend([0x48, 0x81, 0xEC]);
        code.bytes.extend(frame.to_le_bytes());
    }
    code.vector(EQUAL, ALIGNED, ONES, ONES, Where::Register(ONES));
    let start = code.bytes.len();
    code.bytes.extend(body);
    // add rdi, 32; add rsi, 32; sub rdx, 1; jnz start
    for (base, moves) in [WORDS, ROW].into_iter().zip(moves) {
        if moves {
            code.bytes.extend([0x48, 0x83, 0xC0 | base, BYTES]);
        }
    }
    code.bytes.extend([0x48, 0x83, 0xEA, 1, 0x0F, 0x85]);
    let back = i32::try_from(code.bytes.len() + 4 - start).ok()?;
    code.bytes.extend((-back).to_le_bytes());
    if frame > 0 {
        // add rsp, frame
        code.bytes.extend([0x48, 0x81, 0xC4]);
        code.bytes.extend(frame.to_le_bytes());
    }
    // vzeroupper; ret
    code.bytes.extend([0xC5, 0xF8, 0x77, 0xC3]);
    Some(code.bytes)
}

/// What an instruction of the machine reads or writes.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Where {
    Register(u8),
    /// So many bytes behind what a base register points to.
    Memory(u8, i32),
}

/// Bytes of instructions.
#[derive(Default)]
struct Code {
    bytes: Vec<u8>,
}

impl Code {
    /// An instruction on whole vectors of 256 bits, of the second map: a register, another that the prefix names, and the
    /// third operand.
    fn vector(&mut self, opcode: u8, prefix: u8, register: u8, second: u8, third: Where) {
        // All of these are stored inverted.
        let high = |register: u8| u8::from(register < 8);
        let (extends, mode, low) = match third {
            Where::Register(third) => (high(third), 0xC0, third & 7),
            Where::Memory(base, _) => (1, 0x80, base),
        };
        let named = (!second & 15) << 3 | 1 << 2 | prefix;
        if extends == 1 {
            self.bytes.extend([0xC5, high(register) << 7 | named]);
        } else {
            self.bytes.extend([0xC4, high(register) << 7 | 1 << 6 | 1, named]);
        }
        self.bytes.extend([opcode, mode | (register & 7) << 3 | low]);
        if let Where::Memory(base, way) = third {
            if base == STACK {
                // No index.
                self.bytes.push(0x24);
            }
            self.bytes.extend(way.to_le_bytes());
        }
    }

    fn load(&mut self, to: u8, from: Where) {
        self.vector(LOAD, ANYWHERE, to, 0, from);
    }

    fn store(&mut self, to: Where, from: u8) {
        self.vector(STORE, ANYWHERE, from, 0, to);
    }
}

/// Where a value is: in a register, on the stack, or both.
#[derive(Clone, Copy, Default, Debug)]
struct Place {
    register: Option<u8>,
    slot: Option<u32>,
}

/// What the loop does in a turn.
struct Body {
    bytes: Vec<u8>,
    /// By instruction: the instructions that use what it makes and are still to come, the next one last.
    uses: Vec<Vec<usize>>,
    /// By register: what is in it.
    registers: [Option<u32>; REGISTERS as usize],
    places: Vec<Place>,
    free_slots: Vec<u32>,
    slots: u32,
}

impl Body {
    fn instruction(&mut self, index: usize, instruction: Instruction) {
        let (opcode, first, second) = match instruction {
            Instruction::Store(cell, value) => return self.store(cell, value),
            _ if self.uses[index].is_empty() => return self.used(instruction),
            Instruction::Load(cell) => {
                let to = self.register(index, None);
                return self.emit(|code| code.load(to, address(cell)));
            }
            Instruction::Not(a) => (XOR, Where::Register(ONES), self.place(a)),
            Instruction::And(a, b) => (AND, self.place(a), self.place(b)),
            Instruction::Or(a, b) => (OR, self.place(a), self.place(b)),
            Instruction::Xor(a, b) => (XOR, self.place(a), self.place(b)),
            Instruction::AndNot(kept, inverted) => (AND_NOT, self.place(inverted), self.place(kept)),
        };
        let (first, second) = match (opcode, first, second) {
            // The order is free.
            (AND | OR | XOR, Where::Memory(..), Where::Register(_)) => (second, first),
            (..) => (first, second),
        };
        self.used(instruction);
        let (first, to) = match first {
            Where::Register(first) => (first, self.register(index, None)),
            Where::Memory(..) => {
                let to = self.register(index, Some(second));
                self.emit(|code| code.load(to, first));
                (to, to)
            }
        };
        self.emit(|code| code.vector(opcode, ALIGNED, to, first, second));
    }

    fn store(&mut self, cell: Cell, value: Operand) {
        let from = match self.place(value) {
            Where::Register(register) => register,
            memory @ Where::Memory(..) => {
                self.emit(|code| code.load(SCRATCH, memory));
                SCRATCH
            }
        };
        self.emit(|code| code.store(address(cell), from));
        self.used(Instruction::Store(cell, value));
    }

    fn emit(&mut self, instruction: impl FnOnce(&mut Code)) {
        let mut code = Code { bytes: std::mem::take(&mut self.bytes) };
        instruction(&mut code);
        self.bytes = code.bytes;
    }

    fn place(&self, operand: Operand) -> Where {
        match operand {
            Operand::Memory(cell) => address(cell),
            Operand::Made(made) => match self.places[made as usize] {
                Place { register: Some(register), .. } => Where::Register(register),
                Place { register: None, slot: Some(slot) } => on_stack(slot),
                Place { register: None, slot: None } => unreachable!("a value is somewhere until its last use"),
            },
        }
    }

    /// Takes what an instruction used off the uses to come, and gives back the places of what is used no more.
    fn used(&mut self, instruction: Instruction) {
        for made in instruction.made() {
            let index = made as usize;
            self.uses[index].pop();
            if self.uses[index].is_empty() {
                let Place { register, slot } = std::mem::take(&mut self.places[index]);
                if let Some(register) = register {
                    self.registers[usize::from(register)] = None;
                }
                self.free_slots.extend(slot);
            }
        }
    }

    /// A register for what an instruction makes, but for one that it still reads after writing it.
    fn register(&mut self, index: usize, except: Option<Where>) -> u8 {
        let mut found = (0, 0);
        for register in (0..REGISTERS).filter(|register| except != Some(Where::Register(*register))) {
            let next = match self.registers[usize::from(register)] {
                None => usize::MAX,
                Some(made) => self.uses[made as usize].last().copied().unwrap_or_default(),
            };
            if next > found.1 {
                found = (register, next);
            }
        }
        let register = found.0;
        if let Some(other) = self.registers[usize::from(register)] {
            self.evict(other, register);
        }
        self.registers[usize::from(register)] = Some(u32::try_from(index).unwrap_or(u32::MAX));
        self.places[index].register = Some(register);
        register
    }

    /// Leaves a value on the stack only.
    fn evict(&mut self, made: u32, register: u8) {
        if self.places[made as usize].slot.is_none() {
            let slot = self.free_slots.pop().unwrap_or(self.slots);
            self.slots = self.slots.max(slot + 1);
            self.places[made as usize].slot = Some(slot);
            self.emit(|code| code.store(on_stack(slot), register));
        }
        self.places[made as usize].register = None;
    }
}

fn address(cell: Cell) -> Where {
    match cell {
        Cell::Word(word) => Where::Memory(WORDS, way(word)),
        Cell::Row(stamp) => Where::Memory(ROW, way(stamp)),
    }
}

fn on_stack(slot: u32) -> Where {
    Where::Memory(STACK, i32::try_from(slot * u32::from(BYTES)).unwrap_or(i32::MAX))
}
