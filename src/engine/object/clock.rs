//! Time on a soft-core: the tick counter, which the timer interrupt moves on, and the cycle, which latches it.
//!
//! The counter is a word of 32 bits on every target, loaded and stored as one, so that an interrupt can come at any
//! time. A latch takes the difference from the last one, so that the counter may wrap around between two.

use cranelift_codegen::ir::condcodes::IntCC;
use cranelift_codegen::ir::{InstBuilder, types};
use cranelift_module::{DataId, FuncId};

use super::Role;
use super::assembly::{Assembly, Contents, plain};
use super::image::make_bools;
use crate::engine::clif::CompileError;
use crate::interface::{LAST_TICKS, Symbol, TOTAL_TICKS, input_bools};
use crate::logic::Layout;

/// The counter.
pub(super) fn counter(assembly: &mut Assembly<'_>) -> Result<DataId, CompileError> {
    assembly.local_data("ticks", Contents::Zeros(4))
}

/// Where something of the clock lies from the start of an image.
pub(super) fn place(layout: &Layout, of_clock: u32) -> i32 {
    // An image has at most 2^30 bytes.
    i32::try_from(layout.size() + of_clock).unwrap_or(i32::MAX)
}

/// `void P_tick(void)`
pub(super) fn write_tick(assembly: &mut Assembly<'_>, counter: DataId) -> Result<(), CompileError> {
    assembly.export(Symbol::Tick, Role::Tick, &[], |body, _| {
        let counter = body.address(counter);
        let ticks = body.builder.ins().load(types::I32, plain(), counter, 0);
        let ticks = body.builder.ins().iadd_imm_s(ticks, 1);
        body.builder.ins().store(plain(), ticks, counter, 0);
    })
}

/// `void P_cycle(void *image)`
pub(super) fn write_cycle(
    assembly: &mut Assembly<'_>,
    layout: &Layout,
    counter: DataId,
    round: FuncId,
) -> Result<(), CompileError> {
    let tick = assembly.interface().tick();
    assembly.export(Symbol::Cycle, Role::Cycle, &[types::I64], |body, params| {
        let image = params[0];
        make_bools(body, image, &input_bools(layout));
        let counter = body.address(counter);
        let ticks = body.builder.ins().load(types::I32, plain(), counter, 0);
        let last = body.builder.ins().load(types::I32, plain(), image, place(layout, LAST_TICKS));
        body.builder.ins().store(plain(), ticks, image, place(layout, LAST_TICKS));
        let passed = body.builder.ins().isub(ticks, last);
        let passed = body.builder.ins().uextend(types::I64, passed);
        let before = body.builder.ins().load(types::I64, plain(), image, place(layout, TOTAL_TICKS));
        let total = body.builder.ins().iadd(before, passed);
        body.builder.ins().store(plain(), total, image, place(layout, TOTAL_TICKS));
        let period = body.number(tick);
        let now = body.builder.ins().imul(total, period);
        // Held at the end of time.
        let most = body.number(i64::MAX / tick);
        let beyond = body.builder.ins().icmp(IntCC::UnsignedGreaterThan, total, most);
        // A time that is not beyond it has no sign.
        let mask = body.mask(beyond);
        let now = body.builder.ins().bor(now, mask);
        let now = body.builder.ins().ishl_imm_u(now, 1);
        let now = body.builder.ins().ushr_imm_u(now, 1);
        body.call(round, &[image, now]);
    })
}
