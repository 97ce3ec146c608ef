//! The helpers that a program calls, as functions of the object: nothing is taken from a C library. Only those that are
//! used are there.

use cranelift_module::DataId;

use super::assembly::Assembly;
use crate::engine::clif::{Chunk, CompileError};
use crate::engine::helpers::COPY;
use crate::logic::{Helper, Op, Program};

/// The table that chunks are given which call helpers; `None` where none does.
pub(super) fn table(
    assembly: &mut Assembly<'_>,
    program: &Program,
    chunks: &[Chunk],
) -> Result<Option<DataId>, CompileError> {
    if !chunks.iter().any(|chunk| chunk.calls_helpers) {
        return Ok(None);
    }
    let mut rows = vec![None; COPY + 1];
    for helper in Helper::ALL {
        let calls = |op: Op| matches!(op, Op::Call(called, ..) if called == *helper);
        if program.instructions.iter().any(|instruction| calls(instruction.op)) {
            return Err(CompileError::Object(format!("there is no `{}` for objects yet", helper.mnemonic())));
        }
    }
    if program.instructions.iter().any(|instruction| matches!(instruction.op, Op::CopyArray(..))) {
        rows[COPY] = Some(assembly.copy()?);
    }
    assembly.table("helpers", &rows).map(Some)
}
