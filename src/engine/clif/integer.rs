//! Operations on integers, bit strings and TIME.

use cranelift_codegen::ir::condcodes::IntCC;
use cranelift_codegen::ir::{InstBuilder, Value, types};

use super::lower::{Lowering, holder};
use crate::elementary::Elementary;
use crate::logic::{Binary, Unary, ValueId};

impl Lowering<'_, '_> {
    pub(super) fn integer_unary(&mut self, op: Unary, ty: Elementary, a: ValueId) -> Value {
        // x64 would join a wide load with the 1 in a register of its own.
        let a = if op == Unary::Not { self.exact_value(a) } else { self.value(a) };
        match op {
            Unary::Not if ty == Elementary::Bool => {
                let form = self.builder.func.dfg.value_type(a);
                let one = self.integer_constant(form, 1);
                self.builder.ins().bxor(a, one)
            }
            Unary::Not => {
                let value = self.builder.ins().bnot(a);
                self.canonical(ty, value)
            }
            Unary::Negate => {
                let value = self.builder.ins().ineg(a);
                self.canonical(ty, value)
            }
            Unary::Absolute if ty.is_signed() => {
                let value = self.magnitude(ty, a);
                self.canonical(ty, value)
            }
            Unary::Absolute => a,
            Unary::SquareRoot => unreachable!("not an operation on integers in a verified program"),
        }
    }

    pub(super) fn integer_binary(&mut self, op: Binary, ty: Elementary, a: ValueId, b: ValueId) -> Value {
        match op {
            Binary::Divide | Binary::Remainder => return self.divide(op, ty, a, b),
            Binary::And
            | Binary::Or
            | Binary::Xor
            | Binary::Add
            | Binary::Subtract
            | Binary::Multiply
            | Binary::Minimum
            | Binary::Maximum
            | Binary::ShiftLeft
            | Binary::ShiftRight
            | Binary::RotateLeft
            | Binary::RotateRight => {}
        }
        let constant = self.constant(b);
        let (a, b) = (self.value(a), self.value(b));
        match op {
            Binary::And => self.builder.ins().band(a, b),
            Binary::Or => self.builder.ins().bor(a, b),
            Binary::Xor => self.builder.ins().bxor(a, b),
            Binary::Add => {
                let value = self.builder.ins().iadd(a, b);
                self.canonical(ty, value)
            }
            Binary::Subtract => {
                let value = self.builder.ins().isub(a, b);
                self.canonical(ty, value)
            }
            Binary::Multiply => {
                let value = self.builder.ins().imul(a, b);
                self.canonical(ty, value)
            }
            Binary::Minimum | Binary::Maximum => {
                let less = if ty.is_signed() { IntCC::SignedLessThan } else { IntCC::UnsignedLessThan };
                let a_is_less = self.builder.ins().icmp(less, a, b);
                if op == Binary::Minimum { self.choose(a_is_less, a, b) } else { self.choose(a_is_less, b, a) }
            }
            Binary::ShiftLeft => {
                let value = self.builder.ins().ishl(a, b);
                let value = self.canonical(ty, value);
                self.unless_beyond(ty, value, b, constant)
            }
            Binary::ShiftRight => {
                let value = self.builder.ins().ushr(a, b);
                self.unless_beyond(ty, value, b, constant)
            }
            Binary::RotateLeft | Binary::RotateRight => self.rotate(op, ty, a, b),
            Binary::Divide | Binary::Remainder => unreachable!("done above"),
        }
    }

    /// A value in its register form: what an operation left above a narrow type's bits is replaced.
    pub(super) fn canonical(&mut self, ty: Elementary, value: Value) -> Value {
        let narrow = match ty.size() {
            1 => types::I8,
            2 => types::I16,
            _ => return value,
        };
        let value = self.builder.ins().ireduce(narrow, value);
        if ty.is_signed() {
            self.builder.ins().sextend(types::I32, value)
        } else {
            self.builder.ins().uextend(types::I32, value)
        }
    }

    /// The bits of a value as another type, which is as wide: only the way to extend those of a narrow one can differ.
    pub(super) fn reinterpret(&mut self, a: ValueId, to: Elementary) -> Value {
        let value = self.value(a);
        if to == Elementary::Bool { value } else { self.canonical(to, value) }
    }

    /// All ones where a signed value is negative, else zero.
    fn sign_mask(&mut self, ty: Elementary, value: Value) -> Value {
        self.builder.ins().sshr_imm_u(value, i64::from(holder(ty).bits()) - 1)
    }

    /// `value` with its sign turned where `mask` is all ones.
    fn turned(&mut self, value: Value, mask: Value) -> Value {
        let value = self.builder.ins().bxor(value, mask);
        self.builder.ins().isub(value, mask)
    }

    fn magnitude(&mut self, ty: Elementary, value: Value) -> Value {
        let mask = self.sign_mask(ty, value);
        self.turned(value, mask)
    }

    /// Quotient or remainder by way of the unsigned ones of the magnitudes: those of the least integer and -1 come
    /// out right, and Cranelift's signed division would branch. A divisor of 0 is replaced by 1.
    fn divide(&mut self, op: Binary, ty: Elementary, a: ValueId, b: ValueId) -> Value {
        let signed = ty.is_signed();
        let form = holder(ty);
        let constant = self.constant(b);
        let (a, b) = (self.value(a), self.value(b));
        let dividend = if signed { self.magnitude(ty, a) } else { a };
        let (divisor, zero) = match constant {
            // Seen to be other than 0, it is not tested for it.
            Some(bits) if bits != 0 => {
                let magnitude = if signed { bits.cast_signed().unsigned_abs() } else { bits };
                (self.integer_constant(form, magnitude), None)
            }
            _ => {
                let magnitude = if signed { self.magnitude(ty, b) } else { b };
                let none = self.integer_constant(form, 0);
                let zero = self.builder.ins().icmp(IntCC::Equal, b, none);
                let zero = self.builder.ins().uextend(form, zero);
                (self.builder.ins().bor(magnitude, zero), Some(zero))
            }
        };
        if op == Binary::Remainder {
            // By 1, in place of 0, it is 0.
            let value = self.builder.ins().urem(dividend, divisor);
            return if signed {
                let mask = self.sign_mask(ty, a);
                self.turned(value, mask)
            } else {
                value
            };
        }
        let mut value = self.builder.ins().udiv(dividend, divisor);
        if let Some(zero) = zero {
            let one = self.integer_constant(form, 1);
            let mask = self.builder.ins().isub(zero, one);
            value = self.builder.ins().band(value, mask);
        }
        if signed {
            let differ = self.builder.ins().bxor(a, b);
            let mask = self.sign_mask(ty, differ);
            value = self.turned(value, mask);
        }
        self.canonical(ty, value)
    }

    /// `value`, or 0 where the amount of a shift is the width or more; a constant below it is seen not to be.
    fn unless_beyond(&mut self, ty: Elementary, value: Value, amount: Value, constant: Option<u64>) -> Value {
        if constant.is_some_and(|amount| amount < u64::from(ty.bits())) {
            return value;
        }
        let width = self.integer_constant(types::I32, u64::from(ty.bits()));
        let within = self.builder.ins().icmp(IntCC::UnsignedLessThan, amount, width);
        let zero = self.integer_constant(holder(ty), 0);
        self.choose(within, value, zero)
    }

    /// The amount counts modulo the width, which is what Cranelift's rotations do.
    fn rotate(&mut self, op: Binary, ty: Elementary, a: Value, amount: Value) -> Value {
        if self.target.rotates_by_shifts {
            return self.rotate_by_shifts(op, ty, a, amount);
        }
        let exact = match ty.size() {
            1 => Some(types::I8),
            2 => Some(types::I16),
            _ => None,
        };
        let value = exact.map_or(a, |exact| self.builder.ins().ireduce(exact, a));
        let value = if op == Binary::RotateLeft {
            self.builder.ins().rotl(value, amount)
        } else {
            self.builder.ins().rotr(value, amount)
        };
        if exact.is_some() { self.builder.ins().uextend(holder(ty), value) } else { value }
    }

    /// Two shifts whose amounts add up to the width, or are both 0.
    fn rotate_by_shifts(&mut self, op: Binary, ty: Elementary, a: Value, amount: Value) -> Value {
        let within = self.integer_constant(types::I32, u64::from(ty.bits()) - 1);
        let rest = self.builder.ins().ineg(amount);
        let amount = self.builder.ins().band(amount, within);
        let rest = self.builder.ins().band(rest, within);
        let (left, right) = if op == Binary::RotateLeft { (amount, rest) } else { (rest, amount) };
        let up = self.builder.ins().ishl(a, left);
        let down = self.builder.ins().ushr(a, right);
        let value = self.builder.ins().bor(up, down);
        self.canonical(ty, value)
    }
}
