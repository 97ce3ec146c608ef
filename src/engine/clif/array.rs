//! Elements of arrays, by an index that is known only while the program runs.
//!
//! No access may ever leave the array, whatever the index, and none branches: an index that names no element is
//! replaced by 0, of which a load drops what it reads and a store writes back what is there.

use cranelift_codegen::ir::condcodes::IntCC;
use cranelift_codegen::ir::{InstBuilder, MemFlagsData, Value, types};

use super::lower::{Lowering, holder};
use crate::elementary::Elementary;
use crate::logic::{Array, ArrayId, ValueId};

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
        let default = self.integer_constant(holder(ty), 0);
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
        let condition = self.flag(condition);
        let to = self.program.layout.array(to);
        self.make_all_pending(to);
        let slot = self.program.layout.slot(to.first);
        let from = self.program.layout.slot(self.program.layout.array(from).first).offset;
        let [source, target] = [from, slot.offset].map(|offset| self.pointer(offset));
        let source = self.choose(condition, source, target);
        let size = to.count.saturating_mul(slot.ty.size());
        self.copy(target, source, size);
    }

    /// A pointer to a byte of the image.
    fn pointer(&mut self, offset: u32) -> Value {
        let (pointer, way) = self.address(offset);
        if way == 0 { pointer } else { self.builder.ins().iadd_imm_s(pointer, i64::from(way)) }
    }

    /// Copies bytes, block by block: where the two overlap they are the same.
    fn copy(&mut self, target: Value, source: Value, size: u32) {
        let flags = MemFlagsData::new().with_notrap();
        let (mut at, mut left) = (0i32, size);
        for (ty, bytes) in [(types::I8X16, 16), (types::I64, 8), (types::I32, 4), (types::I16, 2), (types::I8, 1)] {
            while left >= bytes {
                let block = self.builder.ins().load(ty, flags, source, at);
                self.builder.ins().store(flags, block, target, at);
                at = at.saturating_add(i32::try_from(bytes).unwrap_or_default());
                left -= bytes;
            }
        }
    }
}
