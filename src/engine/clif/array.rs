//! Elements of arrays, by an index that is known only while the program runs, and whole arrays.
//!
//! No access may ever leave the array, whatever the index, and none branches: an index that names no element is
//! replaced by 0, of which a load drops what it reads and a store writes back what is there. A copy that is not to be
//! made copies an array onto itself.

use cranelift_codegen::ir::condcodes::IntCC;
use cranelift_codegen::ir::{AbiParam, InstBuilder, MemFlagsData, Signature, Value, types};

use super::MOVED;
use super::lower::Lowering;
use crate::elementary::Elementary;
use crate::engine::helpers;
use crate::logic::{Array, ArrayId, Program, ValueId};

/// An element's place in memory, which is always one of the array.
struct Element {
    ty: Elementary,
    /// Whether the index names it, in 8 bits.
    exists: Value,
    pointer: Value,
    way: i32,
}

impl Lowering<'_, '_> {
    fn element(&mut self, Array { first, count }: Array, index: ValueId) -> Element {
        let slot = self.program.layout.slot(first);
        let index = self.value(index);
        let end = self.integer_constant(types::I64, u64::from(count));
        let exists = self.builder.ins().icmp(IntCC::UnsignedLessThan, index, end);
        let zero = self.integer_constant(types::I64, 0);
        let index = self.choose(exists, index, zero);
        let bytes = self.builder.ins().ishl_imm_u(index, i64::from(slot.ty.size().trailing_zeros()));
        let (pointer, way) = self.address(slot.offset);
        let pointer = self.builder.ins().iadd(pointer, bytes);
        Element { ty: slot.ty, exists, pointer, way }
    }

    pub(super) fn load_indexed(&mut self, array: ArrayId, index: ValueId) -> Value {
        let Element { ty, exists, pointer, way } = self.element(self.program.layout.array(array), index);
        let value = self.read(ty, pointer, way);
        let default = self.integer_constant(self.holder(ty), 0);
        self.choose(exists, value, default)
    }

    pub(super) fn store_indexed(&mut self, array: ArrayId, index: ValueId, value: ValueId) {
        let array = self.program.layout.array(array);
        let value = self.value(value);
        let Element { ty, exists, pointer, way } = self.element(array, index);
        self.make_all_pending(array);
        let old = self.read(ty, pointer, way);
        let (value, old) = self.narrowed(value, old);
        let value = self.choose(exists, value, old);
        self.write(ty, value, pointer, way);
    }

    /// Copies an array onto another while a condition holds, else the other onto itself.
    pub(super) fn copy_array(&mut self, to: ArrayId, from: ArrayId, condition: ValueId) {
        let size = size(self.program, to);
        let called = copy_is_called(self.program, to);
        let [to, from] = [to, from].map(|array| self.program.layout.array(array));
        let [target, source] = [to, from].map(|array| self.program.layout.slot(array.first).offset);
        let always = self.constant(condition).is_some_and(|bits| bits != 0);
        let condition = self.flag(condition);
        self.make_all_pending(to);
        let [target, source] = [target, source].map(|offset| self.pointer(offset));
        let source = if always { source } else { self.choose(condition, source, target) };
        if called {
            self.call_copy(target, source, size);
        } else {
            self.moves(target, source, size);
        }
    }

    /// A pointer to a byte of the image.
    fn pointer(&mut self, offset: u32) -> Value {
        let (pointer, way) = self.address(offset);
        if way == 0 { pointer } else { self.builder.ins().iadd_imm_s(pointer, i64::from(way)) }
    }

    /// Copies bytes, the widest moves first. Where the two overlap they are the same, so one move after another does.
    fn moves(&mut self, target: Value, source: Value, size: u32) {
        let flags = MemFlagsData::new().with_notrap();
        let widths = [(types::I8X16, 16), (types::I64, 8), (types::I32, 4), (types::I16, 2), (types::I8, 1)];
        let widths = if self.target.wide_moves { &widths[..] } else { &widths[1..] };
        let (mut at, end) = (0, i32::try_from(size).unwrap_or(i32::MAX));
        for (ty, width) in widths {
            while end - at >= *width {
                let moved = self.builder.ins().load(*ty, flags, source, at);
                self.builder.ins().store(flags, moved, target, at);
                at += width;
            }
        }
    }

    fn call_copy(&mut self, target: Value, source: Value, size: u32) {
        let Some(table) = self.helpers else { unreachable!("a chunk with a long copy takes the table") };
        let pointer = self.builder.func.dfg.value_type(table);
        let row = i32::try_from(helpers::COPY * pointer.bytes() as usize).unwrap_or(i32::MAX);
        let function = self.builder.ins().load(pointer, MemFlagsData::trusted().with_readonly(), table, row);
        let size = self.integer_constant(pointer, u64::from(size));
        let signature = match self.copy_signature {
            Some(signature) => signature,
            None => {
                let mut signature = Signature::new(self.builder.func.signature.call_conv);
                signature.params.extend([AbiParam::new(pointer); 3]);
                *self.copy_signature.insert(self.builder.import_signature(signature))
            }
        };
        self.builder.ins().call_indirect(signature, function, &[target, source, size]);
    }
}

/// Whether a copy to an array is a call of a helper.
pub(in crate::engine) fn copy_is_called(program: &Program, to: ArrayId) -> bool {
    size(program, to) > MOVED
}

/// Bytes of an array.
fn size(program: &Program, array: ArrayId) -> u32 {
    let Array { first, count } = program.layout.array(array);
    // Less than an image has.
    count.saturating_mul(program.layout.slot(first).ty.size())
}
