//! Images: how one starts, `P_init`; what of it is kept, `P_save`; and BOOLs that come from outside, made 0 or 1.

use std::collections::BTreeMap;
use std::ops::Range;

use cranelift_codegen::ir::condcodes::IntCC;
use cranelift_codegen::ir::{InstBuilder, Value, types};
use cranelift_module::{DataId, FuncId};

use super::Role;
use super::assembly::{Assembly, Body, Contents, plain};
use super::clock::place;
use crate::engine::clif::CompileError;
use crate::interface::{LAST_TICKS, Symbol, image_size, retained_bools};
use crate::logic::Layout;

/// Bytes of the words in which an image is initialised.
const WORD: u32 = 8;

/// The image before the first scan, without its zeros: words of zero, and words that follow as they are, again and again.
/// Each such pair starts with both numbers, of 32 bits each.
fn initial(layout: &Layout) -> Vec<u8> {
    let mut words: BTreeMap<u32, [u8; WORD as usize]> = BTreeMap::new();
    for slot in layout.slots() {
        let bits = slot.initial.bits().to_le_bytes();
        let bytes = &bits[..slot.ty.size() as usize];
        if bytes.iter().any(|byte| *byte != 0) {
            let word = words.entry(slot.offset / WORD).or_default();
            word[(slot.offset % WORD) as usize..][..bytes.len()].copy_from_slice(bytes);
        }
    }
    let mut data = Vec::new();
    let mut pair = |zeros: u32, words: &[[u8; WORD as usize]]| {
        data.extend(zeros.to_le_bytes());
        data.extend(u32::try_from(words.len()).unwrap_or(u32::MAX).to_le_bytes());
        data.extend(words.as_flattened());
    };
    let (mut at, mut run_start, mut run) = (0, 0, Vec::new());
    for (word, bytes) in words {
        // A word of zero within a run is no longer than the two numbers.
        if !run.is_empty() && word > at + 1 {
            let started = run_start;
            pair(started, &run);
            run.clear();
            run_start = word - at;
        } else if run.is_empty() {
            run_start = word;
        } else {
            run.resize(run.len() + (word - at) as usize, [0; WORD as usize]);
        }
        run.push(bytes);
        at = word + 1;
    }
    if !run.is_empty() {
        pair(run_start, &run);
    }
    pair(image_size(layout) / WORD - at, &[]);
    data
}

/// `void P_init(void *image, const void *retained)`
pub(super) fn write_init(assembly: &mut Assembly<'_>, layout: &Layout, counter: DataId) -> Result<(), CompileError> {
    let initial = initial(layout);
    let size = i64::try_from(initial.len()).unwrap_or(i64::MAX);
    let initial = assembly.local_data("initial", Contents::Bytes(initial))?;
    let copy = if layout.retained().is_empty() { None } else { Some(assembly.copy()?) };
    assembly.export(Symbol::Init, Role::Image, &[types::I64; 2], |body, params| {
        let (image, retained) = (params[0], params[1]);
        let from = body.address(initial);
        let end = body.builder.ins().iadd_imm_s(from, size);
        expand(body, image, from, end);
        let counter = body.address(counter);
        let ticks = body.builder.ins().load(types::I32, plain(), counter, 0);
        body.builder.ins().store(plain(), ticks, image, place(layout, LAST_TICKS));
        let Some(copy) = copy else { return };
        let [given, done] = [body.builder.create_block(), body.builder.create_block()];
        body.builder.ins().brif(retained, given, &[], done, &[]);
        body.builder.switch_to_block(given);
        for (at, run) in gathered(layout) {
            copy_run(body, copy, (image, run.start), (retained, at), run.end - run.start);
        }
        make_bools(body, image, &retained_bools(layout));
        body.builder.ins().jump(done, &[]);
        body.builder.switch_to_block(done);
    })
}

/// `void P_save(const void *image, void *retained)`
pub(super) fn write_save(assembly: &mut Assembly<'_>, layout: &Layout) -> Result<(), CompileError> {
    let copy = if layout.retained().is_empty() { None } else { Some(assembly.copy()?) };
    assembly.export(Symbol::Save, Role::Image, &[types::I64; 2], |body, params| {
        let (image, retained) = (params[0], params[1]);
        for (at, run) in gathered(layout) {
            if let Some(copy) = copy {
                copy_run(body, copy, (retained, at), (image, run.start), run.end - run.start);
            }
        }
    })
}

/// The retained runs, each with where it lies among the gathered bytes.
fn gathered(layout: &Layout) -> impl Iterator<Item = (u32, Range<u32>)> {
    layout.retained().iter().scan(0, |at, run| {
        let here = *at;
        *at += run.end - run.start;
        Some((here, run.clone()))
    })
}

fn copy_run(body: &mut Body<'_>, copy: FuncId, to: (Value, u32), from: (Value, u32), count: u32) {
    let [to, from] = [to, from].map(|(pointer, at)| body.offset(pointer, at));
    let count = body.number(i64::from(count));
    body.call(copy, &[to, from, count]);
}

/// Writes the words that [`initial`] tells to `image`.
fn expand(body: &mut Body<'_>, image: Value, from: Value, end: Value) {
    let word = i64::from(WORD);
    let [pair, zeros, zero, words, copied, behind, done] = std::array::from_fn(|_| body.builder.create_block());
    let pointer = |body: &mut Body<'_>, block| body.builder.append_block_param(block, types::I64);
    body.builder.ins().jump(pair, &[image.into(), from.into()]);

    let (to, from) = (pointer(body, pair), pointer(body, pair));
    body.builder.switch_to_block(pair);
    let zero_count = body.builder.ins().uload32(plain(), from, 0);
    let word_count = body.builder.ins().uload32(plain(), from, 4);
    let first = body.builder.ins().iadd_imm_s(from, 8);
    body.builder.ins().jump(zeros, &[to.into(), zero_count.into()]);

    let (to, left) = (pointer(body, zeros), pointer(body, zeros));
    body.builder.switch_to_block(zeros);
    body.builder.ins().brif(left, zero, &[], words, &[to.into(), first.into(), word_count.into()]);
    body.builder.switch_to_block(zero);
    let nothing = body.number(0);
    body.builder.ins().store(plain(), nothing, to, 0);
    let (to, left) = (body.builder.ins().iadd_imm_s(to, word), body.builder.ins().iadd_imm_s(left, -1));
    body.builder.ins().jump(zeros, &[to.into(), left.into()]);

    let (to, from, left) = (pointer(body, words), pointer(body, words), pointer(body, words));
    body.builder.switch_to_block(words);
    body.builder.ins().brif(left, copied, &[], behind, &[]);
    body.builder.switch_to_block(copied);
    let value = body.builder.ins().load(types::I64, plain(), from, 0);
    body.builder.ins().store(plain(), value, to, 0);
    let (next_to, next_from) = (body.builder.ins().iadd_imm_s(to, word), body.builder.ins().iadd_imm_s(from, word));
    let left = body.builder.ins().iadd_imm_s(left, -1);
    body.builder.ins().jump(words, &[next_to.into(), next_from.into(), left.into()]);

    body.builder.switch_to_block(behind);
    let more = body.builder.ins().icmp(IntCC::UnsignedLessThan, from, end);
    body.builder.ins().brif(more, pair, &[to.into(), from.into()], done, &[]);
    body.builder.switch_to_block(done);
}

impl Assembly<'_> {
    /// The function that copies bytes, which are the same or apart: `copy(to, from, count)`. Words where both are aligned.
    pub(super) fn copy(&mut self) -> Result<FuncId, CompileError> {
        if let Some(copy) = self.copy_function() {
            return Ok(copy);
        }
        let copy = self.local_function("copy", Role::Helper, &[types::I64; 3], &[], |body, params| {
            let [words, word, bytes, byte, done] = std::array::from_fn(|_| body.builder.create_block());
            let parameters = |body: &mut Body<'_>, block| -> [Value; 3] {
                std::array::from_fn(|_| body.builder.append_block_param(block, types::I64))
            };
            let [to, from, count] = [params[0].into(), params[1].into(), params[2].into()];
            let either = body.builder.ins().bor(params[0], params[1]);
            let low = body.builder.ins().band_imm_u(either, i64::from(WORD) - 1);
            body.builder.ins().brif(low, bytes, &[to, from, count], words, &[to, from, count]);

            let [to, from, count] = parameters(body, words);
            body.builder.switch_to_block(words);
            let size = body.number(i64::from(WORD));
            let enough = body.builder.ins().icmp(IntCC::UnsignedGreaterThanOrEqual, count, size);
            let rest = [to.into(), from.into(), count.into()];
            body.builder.ins().brif(enough, word, &[], bytes, &rest);
            body.builder.switch_to_block(word);
            let value = body.builder.ins().load(types::I64, plain(), from, 0);
            body.builder.ins().store(plain(), value, to, 0);
            step(body, words, [to, from, count], i64::from(WORD));

            let [to, from, count] = parameters(body, bytes);
            body.builder.switch_to_block(bytes);
            body.builder.ins().brif(count, byte, &[], done, &[]);
            body.builder.switch_to_block(byte);
            let value = body.builder.ins().load(types::I8, plain(), from, 0);
            body.builder.ins().store(plain(), value, to, 0);
            step(body, bytes, [to, from, count], 1);

            body.builder.switch_to_block(done);
            body.builder.ins().return_(&[]);
        })?;
        self.set_copy_function(copy);
        Ok(copy)
    }
}

/// The next turn of a loop that copies.
fn step(body: &mut Body<'_>, block: cranelift_codegen::ir::Block, [to, from, count]: [Value; 3], size: i64) {
    let [to, from] = [to, from].map(|pointer| body.builder.ins().iadd_imm_s(pointer, size));
    let count = body.builder.ins().iadd_imm_s(count, -size);
    body.builder.ins().jump(block, &[to.into(), from.into(), count.into()]);
}

/// How far from a pointer an access is short on every target.
const NEAR: u32 = 2040;

/// Makes each byte of some runs 1 that is not 0, eight at a time, in a straight line.
pub(super) fn make_bools(body: &mut Body<'_>, image: Value, runs: &[Range<u32>]) {
    if runs.is_empty() {
        return;
    }
    let low_bits = body.number(0x7F7F_7F7F_7F7F_7F7F);
    let ones = body.number(0x0101_0101_0101_0101);
    let (mut pointer, mut base) = (image, 0);
    for run in runs {
        let mut at = run.start;
        while at < run.end {
            let fitting = |width: u32| at.is_multiple_of(width) && at + width <= run.end;
            let width = [8, 4, 2].into_iter().find(|width| fitting(*width)).unwrap_or(1);
            if at - base > NEAR {
                (pointer, base) = (body.offset(image, at), at);
            }
            let way = i32::try_from(at - base).unwrap_or_default();
            let ins = body.builder.ins();
            let bytes = match width {
                8 => ins.load(types::I64, plain(), pointer, way),
                4 => ins.uload32(plain(), pointer, way),
                2 => ins.uload16(types::I64, plain(), pointer, way),
                _ => ins.uload8(types::I64, plain(), pointer, way),
            };
            // The top bit of a byte: whether any of the others is set, or it was.
            let others = body.builder.ins().band(bytes, low_bits);
            let carried = body.builder.ins().iadd(others, low_bits);
            let any = body.builder.ins().bor(carried, bytes);
            let down = body.builder.ins().ushr_imm_u(any, 7);
            let bools = body.builder.ins().band(down, ones);
            let ins = body.builder.ins();
            match width {
                8 => ins.store(plain(), bools, pointer, way),
                4 => ins.istore32(plain(), bools, pointer, way),
                2 => ins.istore16(plain(), bools, pointer, way),
                _ => ins.istore8(plain(), bools, pointer, way),
            };
            at += width;
        }
    }
}
