//! A segment to one Cranelift function on 128-bit vectors, one bit a lane.
//!
//! A function is a loop over the vectors of a word: all of a segment for the first, then for the next.
//!
//! As in [`clif`](crate::engine::clif), a function takes its pointers as arguments and has no relocations, loads are
//! made where their value is used, so that they become part of the instruction that uses it, and what is used more
//! than once passes through a block of its own, so that loads below it still can.
//!
//! ```text
//! extern "C" fn(words: *mut Word, row: *mut Word, vectors: i64)
//! ```

use std::collections::HashMap;

use cranelift_codegen::Context;
use cranelift_codegen::ir::condcodes::IntCC;
use cranelift_codegen::ir::{
    AbiParam, BlockArg, Function, InstBuilder, MemFlagsData, Signature, Type, UserFuncName, Value, types,
};
use cranelift_codegen::isa::{CallConv, TargetIsa};
use cranelift_frontend::{FunctionBuilder, FunctionBuilderContext};

use super::plan::{Bit, BitOp, Cell, FALSE_WORD, Piece, Plan, TRUE_WORD};
use super::word::Word;
use crate::engine::clif::{self, CompileError};
use crate::parallel;

/// What holds a vector of a word.
const VECTOR: Type = types::I8X16;

/// The code of a segment.
#[derive(Debug)]
pub(in crate::engine) struct Code {
    /// Without relocations.
    pub(in crate::engine) bytes: Vec<u8>,
    /// What its first byte must be aligned to, a power of two.
    pub(in crate::engine) alignment: u32,
    /// How many words it may reach from each of its pointers.
    pub(in crate::engine) reach: [usize; 2],
}

/// The code of a plan's segments, in order, made on all cores; it does not depend on how many there are.
///
/// # Errors
/// That of the first that has one: when Cranelift refuses it.
pub(super) fn compile(plan: &Plan, isa: &dyn TargetIsa) -> Result<Vec<Code>, CompileError> {
    let pieces = plan.tasks.iter().flatten();
    let segments: Vec<&[BitOp]> = pieces
        .filter_map(|piece| match piece {
            Piece::Segment(ops) => Some(ops.as_slice()),
            Piece::Steps(_) => None,
        })
        .collect();
    let start = || (Context::new(), FunctionBuilderContext::new());
    let reach = [plan.words, plan.stamps.len()];
    let work = |memory: &mut (Context, FunctionBuilderContext), index: usize| {
        function(index, isa, memory, reach, |builder, pointers| segment(segments[index], builder, pointers))
    };
    parallel::each(segments.len(), start, work).into_iter().collect()
}

/// Makes a function of two pointers and of how many vectors they are to be moved on by: a loop over its body.
fn function(
    index: usize,
    isa: &dyn TargetIsa,
    (context, builder_context): &mut (Context, FunctionBuilderContext),
    reach: [usize; 2],
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
    let [words, row] = [words, row].map(|pointer| builder.ins().iadd_imm_s(pointer, i64::from(VECTOR.bytes())));
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
    Ok(Code { bytes: compiled.code_buffer().to_vec(), alignment, reach })
}

/// Fills a function with a segment.
fn segment<'f>(ops: &[BitOp], builder: FunctionBuilder<'f>, [words, row]: [Value; 2]) -> FunctionBuilder<'f> {
    let mut uses = vec![0; ops.len()];
    ops.iter().flat_map(operands).for_each(|operand| uses[operand as usize] += 1);
    let held = vec![None; ops.len()];
    let mut lowering = Lowering { ops, builder, words, row, uses, held, pending: HashMap::new() };
    for index in 0..ops.len() {
        lowering.op(index);
    }
    lowering.builder
}

/// The operands of an operation.
fn operands(op: &BitOp) -> impl Iterator<Item = u32> + use<> {
    let operands = match *op {
        BitOp::Load(_) | BitOp::Store(_, Bit::Constant(_)) => [None, None],
        BitOp::Not(a) | BitOp::Store(_, Bit::Made(a)) => [Some(a), None],
        BitOp::And(a, b) | BitOp::Or(a, b) | BitOp::Xor(a, b) => [Some(a), Some(b)],
    };
    operands.into_iter().flatten()
}

struct Lowering<'a, 'f> {
    ops: &'a [BitOp],
    builder: FunctionBuilder<'f>,
    words: Value,
    row: Value,
    /// By operation: uses that are still to come.
    uses: Vec<u32>,
    held: Vec<Option<Value>>,
    /// Loads of a place in memory since it was last stored.
    pending: HashMap<Cell, Vec<u32>>,
}

impl Lowering<'_, '_> {
    fn op(&mut self, index: usize) {
        let op = self.ops[index];
        let id = u32::try_from(index).unwrap_or(u32::MAX);
        let value = match op {
            BitOp::Store(cell, bit) => {
                let value = self.bit(bit);
                self.make_pending(cell);
                let (pointer, way) = self.address(cell);
                self.builder.ins().store(MemFlagsData::trusted(), value, pointer, way);
                return;
            }
            _ if self.uses[index] == 0 => return,
            // Made where they are used.
            BitOp::Load(cell) => return self.pending.entry(cell).or_default().push(id),
            BitOp::Not(_) if self.is_late_not(id) => return,
            BitOp::Not(a) => self.inverted(a),
            BitOp::And(a, b) => self.and(a, b),
            BitOp::Or(a, b) => {
                let (a, b) = self.both(a, b);
                self.builder.ins().bor(a, b)
            }
            BitOp::Xor(a, b) => {
                let (a, b) = self.both(a, b);
                self.builder.ins().bxor(a, b)
            }
        };
        self.held[index] = Some(if self.uses[index] > 1 { self.settled(value) } else { value });
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

    fn bit(&mut self, bit: Bit) -> Value {
        match bit {
            Bit::Constant(value) => self.load(Cell::Word(if value { TRUE_WORD } else { FALSE_WORD })),
            Bit::Made(id) => self.value(id),
        }
    }

    /// Uses a value. A load is made anew for each use, which costs nothing where it is part of an instruction.
    fn value(&mut self, id: u32) -> Value {
        let index = id as usize;
        self.uses[index] = self.uses[index].saturating_sub(1);
        match (self.held[index], self.ops[index]) {
            (Some(value), _) => value,
            (None, BitOp::Load(cell)) => self.load(cell),
            (None, BitOp::Not(a)) => self.inverted(a),
            (None, BitOp::And(..) | BitOp::Or(..) | BitOp::Xor(..) | BitOp::Store(..)) => {
                unreachable!("operands are made before, and only the above are late")
            }
        }
    }

    /// Whether a value will be loaded where it is used.
    fn is_late_load(&self, id: u32) -> bool {
        self.held[id as usize].is_none() && matches!(self.ops[id as usize], BitOp::Load(_))
    }

    /// Whether a NOT is left to its only use. Not so that of a NOT, or a long chain of them would nest as deep.
    fn is_late_not(&self, id: u32) -> bool {
        match self.ops[id as usize] {
            BitOp::Not(inner) => self.uses[id as usize] == 1 && !matches!(self.ops[inner as usize], BitOp::Not(_)),
            _ => false,
        }
    }

    /// What a NOT that was left to its use inverts.
    fn late_not(&self, id: u32) -> Option<u32> {
        match self.ops[id as usize] {
            BitOp::Not(inner) if self.held[id as usize].is_none() && self.is_late_not(id) => Some(inner),
            _ => None,
        }
    }

    fn inverted(&mut self, a: u32) -> Value {
        let a = self.value(a);
        let ones = self.load(Cell::Word(TRUE_WORD));
        self.builder.ins().bxor(a, ones)
    }

    /// Two values, a load behind the other, where it becomes part of the instruction.
    fn both(&mut self, a: u32, b: u32) -> (Value, Value) {
        let (first, second) = if self.is_late_load(a) && !self.is_late_load(b) { (b, a) } else { (a, b) };
        let first = self.value(first);
        (first, self.value(second))
    }

    /// An AND; x AND NOT y is one instruction, of which x may be a load.
    fn and(&mut self, a: u32, b: u32) -> Value {
        let (kept, inverted) = match (self.late_not(a), self.late_not(b)) {
            (Some(inner), None) => (b, inner),
            (_, Some(inner)) => (a, inner),
            (None, None) => {
                let (a, b) = self.both(a, b);
                return self.builder.ins().band(a, b);
            }
        };
        let inner = self.value(inverted);
        let inner = self.builder.ins().bnot(inner);
        let kept = self.value(kept);
        self.builder.ins().band(kept, inner)
    }

    /// Makes the loads of a place that is about to be stored.
    fn make_pending(&mut self, cell: Cell) {
        for load in self.pending.remove(&cell).unwrap_or_default() {
            let index = load as usize;
            if self.uses[index] > 0 && self.held[index].is_none() {
                let value = self.load(cell);
                self.held[index] = Some(value);
            }
        }
    }
}

/// A word's way from the pointer, in bytes; [`Lanes`](super::Lanes) refuses programs with more words than have one.
fn way(word: u32) -> i32 {
    i32::try_from(u64::from(word) * size_of::<Word>() as u64).unwrap_or(i32::MAX)
}
