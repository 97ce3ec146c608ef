//! A round of tasks, `P_scan`: the chunks of those that are due, in order. When one is due is what
//! [`Turn`](crate::logic::Turn) says; here it is only written as code.

use cranelift_codegen::ir::condcodes::IntCC;
use cranelift_codegen::ir::{InstBuilder, Value, types};
use cranelift_codegen::isa::CallConv;
use cranelift_module::{DataId, FuncId};

use super::Role;
use super::assembly::{Assembly, Body, plain};
use crate::engine::clif::{BASES, Chunk, CompileError};
use crate::logic::{Program, Turn};

/// A chunk as it is called: the bases that it is given, and whether the table of helpers goes with them.
struct Call<'a> {
    function: FuncId,
    bases: &'a [u32],
    helped: bool,
}

/// Writes the round. A single chunk that takes the image and the time, and always runs, is the round itself.
pub(super) fn write(
    assembly: &mut Assembly<'_>,
    program: &Program,
    chunks: &[Chunk],
    table: Option<DataId>,
) -> Result<FuncId, CompileError> {
    let turns: Vec<Turn> = program.tasks.iter().map(|task| Turn::of(task, &program.layout)).collect();
    let mut calls = Vec::with_capacity(chunks.len());
    for (index, chunk) in chunks.iter().enumerate() {
        let bases = taken(chunk, assembly.call_convention());
        let pointers = bases.len() + usize::from(chunk.calls_helpers);
        let function = assembly.compiled(&format!("rungs{index}"), chunk, &vec![types::I64; pointers + 1])?;
        calls.push(Call { function, bases, helped: chunk.calls_helpers });
    }
    if let ([Call { function, bases: [0], helped: false }], [turn]) = (calls.as_slice(), turns.as_slice())
        && turn.periodic().is_none()
    {
        return Ok(*function);
    }
    let before = |section: usize| chunks.partition_point(|chunk| chunk.sections.start < section);
    assembly.local_function("round", Role::Round, &[types::I64; 2], &[], |body, params| {
        let (image, now) = (params[0], params[1]);
        for (task, turn) in turns.iter().enumerate() {
            let sections = program.task_range(task);
            let calls = &calls[before(sections.start)..before(sections.end)];
            let Some((interval, offset)) = turn.periodic() else {
                run(body, image, now, calls, table);
                continue;
            };
            let [due, next] = [body.builder.create_block(), body.builder.create_block()];
            let pointer = body.offset(image, offset);
            let when = body.builder.ins().load(types::I64, plain(), pointer, 0);
            let is_due = body.builder.ins().icmp(IntCC::SignedLessThanOrEqual, when, now);
            body.builder.ins().brif(is_due, due, &[], next, &[]);
            body.builder.switch_to_block(due);
            let then = next_due(body, interval, now);
            body.builder.ins().store(plain(), then, pointer, 0);
            run(body, image, now, calls, table);
            body.builder.ins().jump(next, &[]);
            body.builder.switch_to_block(next);
        }
        body.builder.ins().return_(&[]);
    })
}

/// The bases that a chunk is given. Those that it has no use for are left out where they would be in registers.
pub(super) fn taken(chunk: &Chunk, convention: CallConv) -> &[u32] {
    let in_registers = matches!(convention, CallConv::SystemV | CallConv::AppleAarch64);
    if in_registers && !chunk.calls_helpers { &chunk.bases[..chunk.used_bases.max(1)] } else { &chunk.bases[..BASES] }
}

/// Calls chunks.
fn run(body: &mut Body<'_>, image: Value, now: Value, calls: &[Call<'_>], table: Option<DataId>) {
    for Call { function, bases, helped } in calls {
        let mut arguments: Vec<Value> = bases.iter().map(|base| body.offset(image, *base)).collect();
        arguments.insert(1, now);
        if *helped && let Some(table) = table {
            arguments.push(body.address(table));
        }
        body.call(*function, &arguments);
    }
}

/// The first multiple of an interval after `now`, or the end of time. The interval is above 0.
fn next_due(body: &mut Body<'_>, interval: i64, now: Value) -> Value {
    let sign = body.builder.ins().sshr_imm_u(now, 63);
    let turned = body.builder.ins().bxor(now, sign);
    let magnitude = body.builder.ins().isub(turned, sign);
    let divisor = body.number(interval.max(1));
    let rest = body.builder.ins().urem(magnitude, divisor);
    let turned = body.builder.ins().bxor(rest, sign);
    let rest = body.builder.ins().isub(turned, sign);
    // Euclid's remainder is never below 0.
    let below = body.builder.ins().sshr_imm_u(rest, 63);
    let lift = body.builder.ins().band(below, divisor);
    let passed = body.builder.ins().iadd(rest, lift);
    let left = body.builder.ins().isub(divisor, passed);
    let then = body.builder.ins().iadd(now, left);
    let beyond = body.builder.ins().icmp(IntCC::SignedLessThan, then, now);
    held(body, then, beyond)
}

/// A time, or the end of time where a comparison holds.
fn held(body: &mut Body<'_>, time: Value, beyond: Value) -> Value {
    let mask = body.mask(beyond);
    let time = body.builder.ins().bor(time, mask);
    let greatest = body.builder.ins().ushr_imm_u(mask, 1);
    // Of all ones the sign goes; else nothing does.
    let sign = body.builder.ins().bxor(mask, greatest);
    let keep = body.builder.ins().bnot(sign);
    body.builder.ins().band(time, keep)
}
