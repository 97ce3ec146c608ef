//! What each operation on values is in C: an operator where one computes what logic wants, else a function of the library.

use super::body::Body;
use super::expression::{Binding, Expression, Form, ring};
use super::helper;
use super::library::{function, short};
use crate::elementary::{Elementary, Value, canonical};
use crate::emit::structure::c_type;
use crate::logic::{Binary, Compare, Helper, Unary, ValueId};

/// The unsigned or signed type of 32 or 64 bits that quotients of a type are computed in.
fn wide(ty: Elementary) -> &'static str {
    match (ty.is_signed(), ty.size() == 8) {
        (true, false) => "int32_t",
        (true, true) => "int64_t",
        (false, false) => "uint32_t",
        (false, true) => "uint64_t",
    }
}

impl Body<'_> {
    pub(super) fn unary(&mut self, op: Unary, a: ValueId) -> Expression {
        let ty = self.ty(a);
        match op {
            Unary::Not => {
                let a = self.value(a);
                let all = Expression::constant(ty, canonical(ty, u64::MAX));
                Expression::bitwise(Binding::Xor, &a, &all, narrow(ty))
            }
            Unary::Negate | Unary::Absolute if ty.is_real() => {
                let a = self.storable(a);
                let function = self.function(if op == Unary::Negate { "neg" } else { "abs" }, ty);
                Expression::call(&function, &[&a], Form::Exact)
            }
            Unary::Negate => {
                let a = self.take(a).ring(ty);
                Expression::infix("0u", "-", &a.tight(), Form::Ring, &[&a])
            }
            Unary::Absolute if !ty.is_signed() => self.take(a),
            Unary::Absolute => {
                let a = self.exact(a);
                let function = function("abs", short(wide(ty)));
                Expression::call(&function, &[&a], Form::Ring)
            }
            Unary::SquareRoot => {
                let a = self.value(a);
                let function = self.function("sqrt", ty);
                Expression::call(&function, &[&a], Form::Exact)
            }
        }
    }

    pub(super) fn binary(&mut self, op: Binary, a: ValueId, b: ValueId) -> Expression {
        let ty = self.ty(a);
        match op {
            Binary::And => self.bitwise(Binding::And, ty, a, b),
            Binary::Or => self.bitwise(Binding::Or, ty, a, b),
            Binary::Xor => self.bitwise(Binding::Xor, ty, a, b),
            Binary::Add if ty.is_real() => self.real(a, "+", b),
            Binary::Subtract if ty.is_real() => self.real(a, "-", b),
            Binary::Multiply if ty.is_real() => self.real(a, "*", b),
            Binary::Divide if ty.is_real() => self.real(a, "/", b),
            Binary::Add => self.sum(ty, a, "+", b),
            Binary::Subtract => self.sum(ty, a, "-", b),
            Binary::Multiply => self.sum(ty, a, "*", b),
            Binary::Divide => self.quotient("/", "div", a, b),
            Binary::Remainder => self.quotient("%", "rem", a, b),
            Binary::Minimum => self.least("min", ty, a, b),
            Binary::Maximum => self.least("max", ty, a, b),
            Binary::ShiftLeft => self.shift("<<", "shl", a, b),
            Binary::ShiftRight => self.shift(">>", "shr", a, b),
            Binary::RotateLeft | Binary::RotateRight => {
                let (a, amount) = (self.exact(a), self.take(b));
                let amount = if op == Binary::RotateLeft {
                    amount.exact(Elementary::Udint)
                } else {
                    // Down by so many is up by minus so many, since widths are powers of two.
                    let amount = amount.ring(Elementary::Udint);
                    Expression::infix("0u", "-", &amount.tight(), Form::Exact, &[&amount])
                };
                let function = self.function("rol", ty);
                Expression::call(&function, &[&a, &amount], Form::Exact)
            }
        }
    }

    fn bitwise(&mut self, binding: Binding, ty: Elementary, a: ValueId, b: ValueId) -> Expression {
        let (a, b) = (self.value(a), self.value(b));
        Expression::bitwise(binding, &a, &b, narrow(ty))
    }

    fn real(&mut self, a: ValueId, operator: &str, b: ValueId) -> Expression {
        let (a, b) = (self.value(a), self.value(b));
        Expression::infix(&a.tight(), operator, &b.tight(), Form::Unsettled, &[&a, &b])
    }

    fn sum(&mut self, ty: Elementary, a: ValueId, operator: &str, b: ValueId) -> Expression {
        let (a, b) = (self.take(a), self.take(b));
        // `a + -5` is `a - 5`.
        let negative = b.constant.map(u64::cast_signed).filter(|constant| ty.is_signed() && *constant < 0);
        let (operator, b) = match (operator, negative) {
            ("+", Some(constant)) => ("-", Expression::constant(ty, constant.unsigned_abs())),
            ("-", Some(constant)) => ("+", Expression::constant(ty, constant.unsigned_abs())),
            (operator, _) => (operator, b),
        };
        // What indices into arrays that start at 0 are full of.
        match operator {
            "+" if a.constant == Some(0) => return b,
            "+" | "-" if b.constant == Some(0) => return a,
            _ => {}
        }
        let (a, b) = (a.ring(ty), b.ring(ty));
        Expression::infix(&a.tight(), operator, &b.tight(), Form::Ring, &[&a, &b])
    }

    fn quotient(&mut self, operator: &str, stem: &str, a: ValueId, b: ValueId) -> Expression {
        let ty = self.ty(a);
        let (a, b) = (self.exact(a), self.exact(b));
        let made = match b.constant.map(u64::cast_signed) {
            // Neither zero nor, which could overflow, -1.
            Some(divisor) if divisor != 0 && !(ty.is_signed() && divisor == -1) => {
                Expression::infix(&a.tight(), operator, &b.tight(), Form::Exact, &[&a, &b])
            }
            _ => {
                let function = function(stem, short(wide(ty)));
                Expression::call(&function, &[&a, &b], Form::Exact)
            }
        };
        if ty.size() < 4 { made.cast(c_type(ty), Form::Exact) } else { made }
    }

    fn least(&mut self, stem: &str, ty: Elementary, a: ValueId, b: ValueId) -> Expression {
        let (a, b) = (self.exact(a), self.exact(b));
        let function = self.function(stem, ty);
        Expression::call(&function, &[&a, &b], Form::Exact)
    }

    fn shift(&mut self, operator: &str, stem: &str, a: ValueId, b: ValueId) -> Expression {
        let ty = self.ty(a);
        // Bits above the type's may only come from what is moved up.
        let a = if stem == "shr" { self.exact(a) } else { self.take(a) };
        let (a, amount) = (a.ring(ty), self.exact(b));
        match amount.constant {
            Some(constant) if constant < u64::from(ty.bits()) => {
                Expression::infix(&a.tight(), operator, &amount.tight(), Form::Ring, &[&a, &amount])
            }
            Some(_) => Expression::constant(ty, 0),
            None => {
                let function = function(stem, short(ring(ty)));
                Expression::call(&function, &[&a, &amount], Form::Ring)
            }
        }
    }

    pub(super) fn compare(&mut self, op: Compare, a_id: ValueId, b_id: ValueId) -> Expression {
        let ty = self.ty(a_id);
        let (a, b) = (self.exact(a_id), self.exact(b_id));
        let bool = Elementary::Bool;
        if let Some(known) = known(op, ty, &a, &b) {
            return Expression::constant(bool, u64::from(known));
        }
        let not =
            |of: &Expression| Expression::bitwise(Binding::Xor, of, &Expression::constant(bool, 1), Form::Promoted);
        let both = |binding, a: &Expression, b: &Expression| Expression::bitwise(binding, a, b, Form::Promoted);
        if ty == bool {
            return match op {
                Compare::Equal => not(&both(Binding::Xor, &a, &b)),
                Compare::NotEqual => both(Binding::Xor, &a, &b),
                Compare::Less => both(Binding::And, &not(&a), &b),
                Compare::LessOrEqual => both(Binding::Or, &not(&a), &b),
                Compare::Greater => both(Binding::And, &a, &not(&b)),
                Compare::GreaterOrEqual => both(Binding::Or, &a, &not(&b)),
            };
        }
        if ty.size() == 8 && !ty.is_real() {
            let less = |a: &Expression, b: &Expression| {
                let function = self.function("lt", ty);
                Expression::call(&function, &[a, b], Form::Exact)
            };
            match op {
                Compare::Less => return less(&a, &b),
                Compare::Greater => return less(&b, &a),
                Compare::LessOrEqual => return not(&less(&b, &a)),
                Compare::GreaterOrEqual => return not(&less(&a, &b)),
                Compare::Equal | Compare::NotEqual => {}
            }
        }
        let (a, b) = (self.comparable(a_id, a), self.comparable(b_id, b));
        let operator = match op {
            Compare::Equal => "==",
            Compare::NotEqual => "!=",
            Compare::Less => "<",
            Compare::LessOrEqual => "<=",
            Compare::Greater => ">",
            Compare::GreaterOrEqual => ">=",
        };
        Expression::infix(&a.tight(), operator, &b.tight(), Form::Exact, &[&a, &b]).cast("uint8_t", Form::Exact)
    }

    /// An operand of a comparison. One that is made of bits gets a name: compilers see where bits are compared with what
    /// they can never be, and warn.
    fn comparable(&mut self, id: ValueId, taken: Expression) -> Expression {
        let is_bits = [" & ", " | ", " ^ "].iter().any(|operator| taken.text.contains(operator));
        if is_bits && !self.ty(id).is_real() { self.named(id, &taken) } else { taken }
    }

    pub(super) fn select(&mut self, condition: ValueId, a: ValueId, b: ValueId) -> Expression {
        let ty = self.ty(a);
        let (condition, a, b) = (self.argument(condition), self.storable(a), self.storable(b));
        let function = self.function("select", ty);
        Expression::call(&function, &[&condition, &a, &b], Form::Exact)
    }

    pub(super) fn convert(&mut self, a: ValueId, to: Elementary) -> Expression {
        let from = self.ty(a);
        if from == to {
            return self.take(a);
        }
        match (from.is_real(), to.is_real()) {
            _ if to == Elementary::Bool => {
                let (taken, zero) = (self.exact(a), Expression::constant(from, 0));
                let taken = self.comparable(a, taken);
                Expression::infix(&taken.tight(), "!=", &zero.text, Form::Exact, &[&taken]).cast("uint8_t", Form::Exact)
            }
            (false, false) => {
                let a = self.take(a);
                // The low bits are all that is wanted of a sum.
                let congruent = a.form == Form::Ring && to.size() <= from.size() && ring(to) == ring(from);
                if congruent { a } else { a.value(from).cast(c_type(to), Form::Exact) }
            }
            (true, true) => self.value(a).cast(c_type(to), Form::Unsettled),
            (true, false) => {
                let a = self.value(a);
                let (least, most) = to.range().unwrap_or((0, 0));
                let end = |end: i128| {
                    let bits = u64::try_from(end.unsigned_abs()).unwrap_or(u64::MAX);
                    Expression::constant(Elementary::Lword, bits)
                };
                let function = self.function("integer", from);
                let integer = Expression::call(&function, &[&a, &end(least), &end(most)], Form::Exact);
                if c_type(to) == "uint64_t" { integer } else { integer.cast(c_type(to), Form::Exact) }
            }
            (false, true) if from.size() == 8 && !from.is_signed() => {
                let a = self.value(a);
                let function = self.function("unsigned", to);
                Expression::call(&function, &[&a], Form::Exact)
            }
            (false, true) => self.exact(a).cast(c_type(to), Form::Exact),
        }
    }

    pub(super) fn reinterpret(&mut self, a: ValueId, to: Elementary) -> Expression {
        let from = self.ty(a);
        match (from.is_real(), to.is_real()) {
            (true, false) => {
                let a = self.storable(a);
                let bits = Expression::call(&self.function("bits", from), &[&a], Form::Exact);
                if c_type(to) == ring(from) { bits } else { bits.cast(c_type(to), Form::Exact) }
            }
            (false, true) => {
                let a = self.exact(a);
                let a = if c_type(from) == ring(to) { a } else { a.cast(ring(to), Form::Exact) };
                Expression::call(&self.function("real", to), &[&a], Form::Exact)
            }
            // Of one width, the low bits are all.
            (true, true) | (false, false) => self.convert(a, to),
        }
    }

    pub(super) fn call(&mut self, helper: Helper, a: ValueId, b: Option<ValueId>) -> Expression {
        let ty = self.ty(a);
        let mut lreal = |id: ValueId| {
            let operand = self.value(id);
            if ty == Elementary::Real { operand.cast("double", Form::Unsettled) } else { operand }
        };
        let mut arguments = vec![lreal(a)];
        arguments.extend(b.map(lreal));
        let arguments: Vec<&Expression> = arguments.iter().collect();
        let made = Expression::call(&helper::name(helper), &arguments, Form::Unsettled);
        if ty == Elementary::Real { made.cast("float", Form::Unsettled) } else { made }
    }
}

/// What a comparison gives whatever the data, so that no compiler has to warn of it: one of the same, or with an end of
/// the range.
fn known(op: Compare, ty: Elementary, a: &Expression, b: &Expression) -> Option<bool> {
    let (least, most) = ty.range()?;
    let number = |expression: &Expression| Value::from_bits(ty, expression.constant?).as_integer();
    let (a_number, b_number) = (number(a), number(b));
    let ordered = match op {
        Compare::Equal | Compare::LessOrEqual | Compare::GreaterOrEqual if a.text == b.text => return Some(true),
        Compare::NotEqual | Compare::Less | Compare::Greater if a.text == b.text => return Some(false),
        Compare::Equal | Compare::NotEqual => return None,
        Compare::Less | Compare::GreaterOrEqual => b_number == Some(least) || a_number == Some(most),
        Compare::Greater | Compare::LessOrEqual => b_number == Some(most) || a_number == Some(least),
    };
    ordered.then_some(matches!(op, Compare::LessOrEqual | Compare::GreaterOrEqual))
}

/// What `&`, `|` and `^` leave of a type.
fn narrow(ty: Elementary) -> Form {
    if ty.size() < 4 { Form::Promoted } else { Form::Exact }
}
