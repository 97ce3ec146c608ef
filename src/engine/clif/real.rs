//! Operations on REAL and LREAL, and all conversions.
//!
//! Values stay in integer registers between operations: a select between two floats would be a branch on x86-64.
//! Conversions to and from unsigned integers, and all that hold at the ends of a range, are made of integer
//! operations, since Cranelift's own branch.

use cranelift_codegen::ir::condcodes::{FloatCC, IntCC};
use cranelift_codegen::ir::{AbiParam, InstBuilder, MemFlagsData, Signature, Type, Value, types};

use super::lower::{Lowering, holder};
use crate::elementary::Elementary;
use crate::logic::evaluate::{NAN32, NAN64};
use crate::logic::{Binary, Compare, Helper, Unary, ValueId};

/// 2^52 as an LREAL: from here on all are whole.
const WHOLE: u64 = 0x4330_0000_0000_0000;
const FRACTION_BITS: u32 = 52;
const EXPONENT_OF_ONE: u64 = 1023;
const GREATEST_EXPONENT: u64 = 0x7FF;

fn float(ty: Elementary) -> Type {
    if ty == Elementary::Real { types::F32 } else { types::F64 }
}

fn sign_bit(ty: Elementary) -> u64 {
    1 << (ty.bits() - 1)
}

impl Lowering<'_, '_> {
    fn float_of(&mut self, ty: Elementary, bits: Value) -> Value {
        self.builder.ins().bitcast(float(ty), MemFlagsData::new(), bits)
    }

    /// The bits of a result, a NaN replaced by the one that arithmetic makes.
    fn bits_of(&mut self, ty: Elementary, value: Value) -> Value {
        let bits = self.builder.ins().bitcast(holder(ty), MemFlagsData::new(), value);
        let nan = if ty == Elementary::Real { u64::from(NAN32) } else { NAN64 };
        let nan = self.integer_constant(holder(ty), nan);
        let is_nan = self.builder.ins().fcmp(FloatCC::Unordered, value, value);
        self.choose(is_nan, nan, bits)
    }

    pub(super) fn real_unary(&mut self, op: Unary, ty: Elementary, a: ValueId) -> Value {
        let a = self.value(a);
        match op {
            Unary::Negate => {
                let sign = self.integer_constant(holder(ty), sign_bit(ty));
                self.builder.ins().bxor(a, sign)
            }
            Unary::Absolute => self.without_sign(ty, a),
            Unary::SquareRoot => {
                let a = self.float_of(ty, a);
                let root = self.builder.ins().sqrt(a);
                self.bits_of(ty, root)
            }
            Unary::Not => unreachable!("not an operation on reals in a verified program"),
        }
    }

    fn without_sign(&mut self, ty: Elementary, bits: Value) -> Value {
        let others = self.integer_constant(holder(ty), sign_bit(ty) - 1);
        self.builder.ins().band(bits, others)
    }

    pub(super) fn real_binary(&mut self, op: Binary, ty: Elementary, a: ValueId, b: ValueId) -> Value {
        let (a, b) = (self.value(a), self.value(b));
        let (a, b) = (self.float_of(ty, a), self.float_of(ty, b));
        let ins = self.builder.ins();
        let value = match op {
            Binary::Add => ins.fadd(a, b),
            Binary::Subtract => ins.fsub(a, b),
            Binary::Multiply => ins.fmul(a, b),
            Binary::Divide => ins.fdiv(a, b),
            Binary::And
            | Binary::Or
            | Binary::Xor
            | Binary::Remainder
            | Binary::Minimum
            | Binary::Maximum
            | Binary::ShiftLeft
            | Binary::ShiftRight
            | Binary::RotateLeft
            | Binary::RotateRight => unreachable!("not an operation on reals in a verified program"),
        };
        self.bits_of(ty, value)
    }

    /// A helper, on LREALs, whatever the type.
    pub(super) fn call(&mut self, helper: Helper, ty: Elementary, a: ValueId, b: Option<ValueId>) -> Value {
        let a = self.lreal(ty, a);
        let b = b.map_or(a, |b| self.lreal(ty, b));
        let Some(table) = self.helpers else { unreachable!("a chunk with a call takes the table") };
        let pointer = self.builder.func.dfg.value_type(table);
        let row = i32::try_from(helper as usize * pointer.bytes() as usize).unwrap_or(i32::MAX);
        let function = self.builder.ins().load(pointer, MemFlagsData::trusted().with_readonly(), table, row);
        let signature = match self.helper_signature {
            Some(signature) => signature,
            None => {
                let mut signature = Signature::new(self.builder.func.signature.call_conv);
                signature.params.extend([AbiParam::new(types::F64); 2]);
                signature.returns.push(AbiParam::new(types::F64));
                *self.helper_signature.insert(self.builder.import_signature(signature))
            }
        };
        let call = self.builder.ins().call_indirect(signature, function, &[a, b]);
        let value = self.builder.inst_results(call)[0];
        let value = if ty == Elementary::Real { self.builder.ins().fdemote(types::F32, value) } else { value };
        self.bits_of(ty, value)
    }

    fn lreal(&mut self, ty: Elementary, id: ValueId) -> Value {
        let value = self.value(id);
        let value = self.float_of(ty, value);
        if ty == Elementary::Real { self.builder.ins().fpromote(types::F64, value) } else { value }
    }

    pub(super) fn real_compare(&mut self, op: Compare, ty: Elementary, a: ValueId, b: ValueId) -> Value {
        let condition = match op {
            Compare::Equal => FloatCC::Equal,
            Compare::NotEqual => FloatCC::NotEqual,
            Compare::Less => FloatCC::LessThan,
            Compare::LessOrEqual => FloatCC::LessThanOrEqual,
            Compare::Greater => FloatCC::GreaterThan,
            Compare::GreaterOrEqual => FloatCC::GreaterThanOrEqual,
        };
        let (a, b) = (self.value(a), self.value(b));
        let (a, b) = (self.float_of(ty, a), self.float_of(ty, b));
        let holds = self.builder.ins().fcmp(condition, a, b);
        self.truth(holds)
    }

    pub(super) fn convert(&mut self, id: ValueId, to: Elementary) -> Value {
        let from = self.type_of(id);
        if from == to {
            return self.value(id);
        }
        let value = if from == Elementary::Bool {
            let flag = self.flag(id);
            if self.target.whole_bools {
                self.builder.ins().ireduce(types::I32, flag)
            } else {
                self.builder.ins().uextend(types::I32, flag)
            }
        } else {
            self.value(id)
        };
        match (from.is_real(), to.is_real()) {
            _ if to == Elementary::Bool => {
                // The two zeros differ in sign only; a NaN is not zero.
                let value = if from.is_real() { self.without_sign(from, value) } else { value };
                let zero = self.integer_constant(holder(from), 0);
                let holds = self.builder.ins().icmp(IntCC::NotEqual, value, zero);
                self.truth(holds)
            }
            (false, false) => {
                let value = match (from.size() == 8, to.size() == 8) {
                    (true, false) => self.builder.ins().ireduce(types::I32, value),
                    (false, true) => self.in_64_bits(from, value),
                    (true, true) | (false, false) => value,
                };
                self.canonical(to, value)
            }
            (true, true) => {
                let value = self.float_of(from, value);
                let value = if to == Elementary::Real {
                    self.builder.ins().fdemote(types::F32, value)
                } else {
                    self.builder.ins().fpromote(types::F64, value)
                };
                self.bits_of(to, value)
            }
            (true, false) => self.integer_of_real(from, to, value),
            (false, true) => self.real_of_integer(from, to, value),
        }
    }

    fn in_64_bits(&mut self, ty: Elementary, value: Value) -> Value {
        match (ty.size() == 8, ty.is_signed()) {
            (true, _) => value,
            (false, true) => self.builder.ins().sextend(types::I64, value),
            (false, false) => self.builder.ins().uextend(types::I64, value),
        }
    }

    fn real_of_integer(&mut self, from: Elementary, to: Elementary, value: Value) -> Value {
        let wide = self.in_64_bits(from, value);
        let real = if from.is_signed() || from.size() < 8 {
            self.builder.ins().fcvt_from_sint(float(to), wide)
        } else {
            // With its top bit set: half of it, the lost bit kept so that rounding sees it, and the result doubled.
            let top = self.builder.ins().ushr_imm_u(wide, 63);
            let lost = self.builder.ins().band(wide, top);
            let half = self.builder.ins().ushr(wide, top);
            let half = self.builder.ins().bor(half, lost);
            let real = self.builder.ins().fcvt_from_sint(float(to), half);
            // 1.0 or 2.0.
            let factor = self.builder.ins().iadd_imm_u(top, 1);
            let factor = self.builder.ins().fcvt_from_sint(float(to), factor);
            self.builder.ins().fmul(real, factor)
        };
        self.builder.ins().bitcast(holder(to), MemFlagsData::new(), real)
    }

    fn integer_of_real(&mut self, from: Elementary, to: Elementary, bits: Value) -> Value {
        let bits = if from == Elementary::Real {
            let value = self.float_of(from, bits);
            let wide = self.builder.ins().fpromote(types::F64, value);
            self.builder.ins().bitcast(types::I64, MemFlagsData::new(), wide)
        } else {
            bits
        };
        let negative = self.builder.ins().sshr_imm_u(bits, 63);
        let size = self.without_sign(Elementary::Lreal, bits);
        let size = self.whole(size);

        // The magnitude: the fraction with its leading one, moved down from the top of 64 bits.
        let exponent = self.builder.ins().ushr_imm_u(size, i64::from(FRACTION_BITS));
        let fraction = self.builder.ins().ishl_imm_u(size, 63 - i64::from(FRACTION_BITS));
        let leading = self.integer_constant(types::I64, 1 << 63);
        let fraction = self.builder.ins().bor(fraction, leading);
        let top = self.integer_constant(types::I64, EXPONENT_OF_ONE + 63);
        let amount = self.builder.ins().isub(top, exponent);
        let shifted = self.builder.ins().ushr(fraction, amount);
        let zero = self.integer_constant(types::I64, 0);
        let one = self.integer_constant(types::I64, EXPONENT_OF_ONE);
        let below_one = self.builder.ins().icmp(IntCC::UnsignedLessThan, exponent, one);
        let magnitude = self.choose(below_one, zero, shifted);

        // Held at the end of the range on its side, which is also where infinity goes; NaN is 0.
        let (least, greatest) = to.range().unwrap_or((0, 0));
        let most = |end: i128| u64::try_from(end.unsigned_abs()).unwrap_or(u64::MAX);
        let up = self.integer_constant(types::I64, most(greatest));
        let down = self.integer_constant(types::I64, most(least));
        let is_negative = self.builder.ins().icmp(IntCC::NotEqual, negative, zero);
        let limit = self.choose(is_negative, down, up);
        let within = self.builder.ins().icmp(IntCC::UnsignedLessThan, magnitude, limit);
        let held = self.choose(within, magnitude, limit);
        let beyond = self.builder.ins().icmp(IntCC::UnsignedGreaterThan, exponent, top);
        let held = self.choose(beyond, limit, held);
        let infinity = self.integer_constant(types::I64, GREATEST_EXPONENT << FRACTION_BITS);
        let is_nan = self.builder.ins().icmp(IntCC::UnsignedGreaterThan, size, infinity);
        let held = self.choose(is_nan, zero, held);

        let value = self.builder.ins().bxor(held, negative);
        let value = self.builder.ins().isub(value, negative);
        if to.size() == 8 { value } else { self.builder.ins().ireduce(types::I32, value) }
    }

    /// The bits of an LREAL without sign, rounded half to even: adding 2^52 leaves no place for a fraction.
    fn whole(&mut self, size: Value) -> Value {
        let large = self.integer_constant(types::I64, WHOLE);
        let has_fraction = self.builder.ins().icmp(IntCC::UnsignedLessThan, size, large);
        let value = self.float_of(Elementary::Lreal, size);
        let offset = self.float_of(Elementary::Lreal, large);
        let sum = self.builder.ins().fadd(value, offset);
        let rounded = self.builder.ins().fsub(sum, offset);
        let rounded = self.builder.ins().bitcast(types::I64, MemFlagsData::new(), rounded);
        self.choose(has_fraction, rounded, size)
    }
}
