//! A segment to one function, on a bit for each lane: by Cranelift on 128-bit vectors, or [`wide`] on 256-bit ones.
//!
//! A function is a loop over the vectors of a word: all of a segment for the first, then for the next.
//!
//! As in [`clif`](crate::engine::clif), a function takes its pointers as arguments and has no relocations, loads are
//! made where their value is used, so that they become part of the instruction that uses it, and what is used more
//! than once passes through a block of its own, so that loads below it still can.
//!
//! ```text
//! extern "C" fn(words: *mut Word, row: *mut Word, turns: i64)
//! ```

mod fold;
mod wide;

use cranelift_codegen::Context;
use cranelift_codegen::ir::condcodes::IntCC;
use cranelift_codegen::ir::{
    AbiParam, BlockArg, Function, InstBuilder, MemFlagsData, Signature, Type, UserFuncName, Value, types,
};
use cranelift_codegen::isa::{CallConv, TargetIsa};
use cranelift_frontend::{FunctionBuilder, FunctionBuilderContext};

use super::epoch;
use super::plan::{BitOp, Cell, Piece, Plan, TRUE_WORD};
use super::word::Word;
use crate::engine::clif::{self, CompileError};
use crate::parallel;
use fold::{Instruction, Operand, fold};

/// Bytes of a line of the cache, and of a fetch of instructions.
const LINE: u32 = 64;

/// What holds a vector of a word.
const VECTOR: Type = types::I8X16;

/// What a function does with its two pointers.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(in crate::engine) struct Through {
    /// How many words it may reach from each.
    pub(in crate::engine) reach: [usize; 2],
    /// Whether each is moved on by a turn. What one that is not points to has the same in all vectors.
    pub(in crate::engine) moves: [bool; 2],
}

/// The code of a segment.
#[derive(Debug)]
pub(in crate::engine) struct Code {
    /// Without relocations.
    pub(in crate::engine) bytes: Vec<u8>,
    /// What its first byte must be aligned to, a power of two.
    pub(in crate::engine) alignment: u32,
    /// What it may reach from its pointers.
    pub(in crate::engine) through: Through,
    /// Vectors of a word that a turn goes through; a word has some such turns.
    pub(in crate::engine) vectors: usize,
}

/// The code of a plan's segments, in order, and behind them that of the segments of an [epoch], and where those begin;
/// made on all cores, and it does not depend on how many there are. It may be `wide` where this machine
/// [has](wide::is_there) such vectors.
///
/// # Errors
/// That of the first that has one: when Cranelift refuses it.
pub(super) fn compile(plan: &Plan, isa: &dyn TargetIsa, wide: bool) -> Result<(Vec<Code>, usize), CompileError> {
    let of_epoch = if plan.stamps.is_empty() { Vec::new() } else { epoch::segments(plan.stamp_stride()) };
    let pieces = plan.tasks.iter().flatten();
    let segments = pieces.filter_map(|piece| match piece {
        Piece::Segment(ops) => Some(ops),
        Piece::Steps(_) => None,
    });
    let mut segments: Vec<&Vec<BitOp>> = segments.collect();
    let first = segments.len();
    segments.extend(&of_epoch);
    let start = || (Context::new(), FunctionBuilderContext::new());
    let wide = wide && wide::is_there();
    let work = |memory: &mut (Context, FunctionBuilderContext), index: usize| {
        let instructions = fold(segments[index]);
        let through = if index < first {
            Through { reach: [plan.words, plan.stamps.len()], moves: [true, true] }
        } else {
            let last = (epoch::KINDS - 1) * plan.stamp_stride() + 1;
            Through { reach: [epoch::COMMON, last], moves: [false, true] }
        };
        match wide.then(|| wide::assemble(&instructions, through.moves)).flatten() {
            Some(bytes) => Ok(Code { bytes, alignment: LINE, through, vectors: wide::VECTORS }),
            None => {
                function(index, isa, memory, through, |builder, pointers| segment(&instructions, builder, pointers))
            }
        }
    };
    let code: Result<Vec<Code>, CompileError> = parallel::each(segments.len(), start, work).into_iter().collect();
    Ok((code?, first))
}

/// Makes a function of two pointers and of how many turns to make: a loop over its body.
fn function(
    index: usize,
    isa: &dyn TargetIsa,
    (context, builder_context): &mut (Context, FunctionBuilderContext),
    through: Through,
    body: impl FnOnce(FunctionBuilder<'_>, [Value; 2]) -> FunctionBuilder<'_>,
) -> Result<Code, CompileError> {
    context.clear();
    let mut signature = Signature::new(CallConv::triple_default(isa.triple()));
    signature.params.extend([AbiParam::new(isa.pointer_type()); 2]);
    signature.params.push(AbiParam::new(types::I64));
    let name = UserFuncName::user(0, u32::try_from(index).unwrap_or(u32::MAX));
    context.func = Function::with_name_signature(name, signature);
    let mut builder = FunctionBuilder::new(&mut context.func, builder_context);
    let block = builder.create_block();
    builder.append_block_params_for_function_params(block);
    builder.switch_to_block(block);
    builder.seal_block(block);
    let turn = builder.create_block();
    let arguments: Vec<BlockArg> = builder.block_params(block).iter().map(|param| BlockArg::from(*param)).collect();
    builder.ins().jump(turn, &arguments);
    let [words, row, left] =
        [isa.pointer_type(), isa.pointer_type(), types::I64].map(|ty| builder.append_block_param(turn, ty));
    builder.switch_to_block(turn);
    let mut builder = body(builder, [words, row]);
    let step = |moves: bool| if moves { i64::from(VECTOR.bytes()) } else { 0 };
    let [words, row] = [(words, through.moves[0]), (row, through.moves[1])]
        .map(|(pointer, moves)| builder.ins().iadd_imm_s(pointer, step(moves)));
    let left = builder.ins().iadd_imm_s(left, -1);
    let done = builder.create_block();
    let more = builder.ins().icmp_imm_s(IntCC::NotEqual, left, 0);
    builder.ins().brif(more, turn, &[words.into(), row.into(), left.into()], done, &[]);
    builder.seal_block(turn);
    builder.switch_to_block(done);
    builder.seal_block(done);
    builder.ins().return_(&[]);
    builder.finalize(isa.frontend_config());
    let refused = |reason: String| CompileError::Chunk { sections: index..index + 1, reason };
    let compiled = clif::generate(context, isa).map_err(|error| refused(error.to_string()))?;
    if !compiled.buffer.relocs().is_empty() {
        return Err(refused("the code refers to something outside of itself".to_owned()));
    }
    let alignment = isa.function_alignment().minimum.max(compiled.buffer.alignment);
    Ok(Code { bytes: compiled.code_buffer().to_vec(), alignment, through, vectors: 1 })
}

/// Fills a function with a segment.
fn segment<'f>(
    instructions: &[Instruction],
    builder: FunctionBuilder<'f>,
    [words, row]: [Value; 2],
) -> FunctionBuilder<'f> {
    let mut uses = vec![0; instructions.len()];
    instructions.iter().flat_map(Instruction::made).for_each(|made| uses[made as usize] += 1);
    let mut lowering = Lowering { builder, words, row, made: vec![None; instructions.len()] };
    for (index, instruction) in instructions.iter().enumerate() {
        let value = lowering.instruction(*instruction);
        lowering.made[index] = if uses[index] > 1 { value.map(|value| lowering.settled(value)) } else { value };
    }
    lowering.builder
}

struct Lowering<'f> {
    builder: FunctionBuilder<'f>,
    words: Value,
    row: Value,
    /// By instruction: what it made.
    made: Vec<Option<Value>>,
}

impl Lowering<'_> {
    fn instruction(&mut self, instruction: Instruction) -> Option<Value> {
        let value = match instruction {
            Instruction::Store(cell, value) => {
                let value = self.operand(value);
                let (pointer, way) = self.address(cell);
                self.builder.ins().store(MemFlagsData::trusted(), value, pointer, way);
                return None;
            }
            Instruction::Load(cell) => self.load(cell),
            Instruction::Not(a) => {
                let a = self.operand(a);
                let ones = self.load(Cell::Word(TRUE_WORD));
                self.builder.ins().bxor(a, ones)
            }
            Instruction::And(a, b) => {
                let (a, b) = (self.operand(a), self.operand(b));
                self.builder.ins().band(a, b)
            }
            // One instruction, of which what is kept may be a load.
            Instruction::AndNot(kept, inverted) => {
                let inverted = self.operand(inverted);
                let inverted = self.builder.ins().bnot(inverted);
                let kept = self.operand(kept);
                self.builder.ins().band(kept, inverted)
            }
            Instruction::Or(a, b) => {
                let (a, b) = (self.operand(a), self.operand(b));
                self.builder.ins().bor(a, b)
            }
            Instruction::Xor(a, b) => {
                let (a, b) = (self.operand(a), self.operand(b));
                self.builder.ins().bxor(a, b)
            }
        };
        Some(value)
    }

    /// See [`clif`](crate::engine::clif): the jump to the block that follows makes no code.
    fn settled(&mut self, value: Value) -> Value {
        let block = self.builder.create_block();
        let settled = self.builder.append_block_param(block, VECTOR);
        self.builder.ins().jump(block, &[value.into()]);
        self.builder.switch_to_block(block);
        self.builder.seal_block(block);
        settled
    }

    fn address(&self, cell: Cell) -> (Value, i32) {
        match cell {
            Cell::Word(word) => (self.words, way(word)),
            Cell::Row(stamp) => (self.row, way(stamp)),
        }
    }

    fn load(&mut self, cell: Cell) -> Value {
        let (pointer, way) = self.address(cell);
        self.builder.ins().load(VECTOR, MemFlagsData::trusted(), pointer, way)
    }

    /// A load is made anew for each use, which costs nothing where it is part of an instruction.
    fn operand(&mut self, operand: Operand) -> Value {
        match operand {
            Operand::Memory(cell) => self.load(cell),
            Operand::Made(index) => match self.made[index as usize] {
                Some(value) => value,
                None => unreachable!("operands are made before"),
            },
        }
    }
}

/// A word's way from the pointer, in bytes; [`Lanes`](super::Lanes) refuses programs with more words than have one.
fn way(word: u32) -> i32 {
    i32::try_from(u64::from(word) * size_of::<Word>() as u64).unwrap_or(i32::MAX)
}
