//! The helpers that a program calls, as functions of the object: nothing is taken from a C library. Only those that are
//! used are there.
//!
//! Each is the program of logic that says what it computes, compiled like any other: its image is on the stack.

use cranelift_codegen::ir::{InstBuilder, StackSlotData, StackSlotKind, Value, types};
use cranelift_module::{DataId, FuncId};

use super::Role;
use super::assembly::{Assembly, plain};
use super::round::taken;
use crate::engine::clif::{self, Chunk, CompileError};
use crate::engine::helpers::COPY;
use crate::engine::target::Target;
use crate::logic::{Helper, Op, Program, SlotId, mathematics};

/// The helpers that a program calls, in the order of their table.
fn called(program: &Program) -> impl Iterator<Item = Helper> {
    let calls = |helper: Helper| {
        program
            .instructions
            .iter()
            .any(|instruction| matches!(instruction.op, Op::Call(called, ..) if called == helper))
    };
    Helper::ALL.iter().copied().filter(move |helper| calls(*helper))
}

/// The table that chunks are given which call helpers; `None` where none does. The chunks of the helpers go to `code`.
pub(super) fn table(
    assembly: &mut Assembly<'_>,
    program: &Program,
    target: &Target,
    chunks: &[Chunk],
    code: &mut Vec<(Helper, Vec<Chunk>)>,
) -> Result<Option<DataId>, CompileError> {
    if !chunks.iter().any(|chunk| chunk.calls_helpers) {
        return Ok(None);
    }
    let mut rows = vec![None; COPY + 1];
    for helper in called(program) {
        let program = mathematics::program(helper);
        let chunks = clif::compile(&program, target)?;
        rows[helper as usize] = Some(function(assembly, helper, &program, &chunks)?);
        code.push((helper, chunks));
    }
    if program.instructions.iter().any(|instruction| matches!(instruction.op, Op::CopyArray(..))) {
        rows[COPY] = Some(assembly.copy()?);
    }
    assembly.table("helpers", &rows).map(Some)
}

/// A function of two LREALs around the program of a helper.
fn function(
    assembly: &mut Assembly<'_>,
    helper: Helper,
    program: &Program,
    chunks: &[Chunk],
) -> Result<FuncId, CompileError> {
    let name = helper.mnemonic();
    let mut calls = Vec::with_capacity(chunks.len());
    for (index, chunk) in chunks.iter().enumerate() {
        let bases = taken(chunk, assembly.call_convention());
        let params = vec![types::I64; bases.len() + 1];
        calls.push((assembly.compiled(&format!("{name}.part{index}"), chunk, &params)?, bases));
    }
    let place = |slot: SlotId| i32::try_from(program.layout.slot(slot).offset).unwrap_or(i32::MAX);
    let size = program.layout.size();
    assembly.local_function(name, Role::Helper, &[types::F64; 2], &[types::F64], |body, params| {
        let slot = StackSlotData::new(StackSlotKind::ExplicitSlot, size, 3);
        let slot = body.builder.create_sized_stack_slot(slot);
        let image = body.builder.ins().stack_addr(types::I64, slot, 0);
        body.builder.ins().store(plain(), params[0], image, place(mathematics::FIRST));
        body.builder.ins().store(plain(), params[1], image, place(mathematics::SECOND));
        let now = body.number(0);
        for (function, bases) in &calls {
            let mut arguments: Vec<Value> = bases.iter().map(|base| body.offset(image, *base)).collect();
            arguments.insert(1, now);
            body.call(*function, &arguments);
        }
        let result = body.builder.ins().load(types::F64, plain(), image, place(mathematics::RESULT));
        body.builder.ins().return_(&[result]);
    })
}
