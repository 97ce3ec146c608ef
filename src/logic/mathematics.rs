//! The functions that [`Op::Call`] names, as programs of logic, so that any back end makes code of them without knowing more
//! than it does.
//!
//! They are recorded from [`mathematics`], which also computes what
//! [`evaluate::helper`](super::evaluate::helper) says; so their results are the same, to the bit. Each is one chunk of one
//! section without a call, and every operation in it takes the same time whatever it is given, as far as the target's do.
//! Nothing may be computed here.

use std::cell::RefCell;
use std::collections::HashMap;
use std::fmt;
use std::marker::PhantomData;
use std::ops::{Add, BitAnd, BitOr, BitXor, Div, Mul, Neg, Not, Sub};

use super::{
    Area, Binary, Builder, Compare, Helper, Instruction, LayoutBuilder, Op, Origin, Program, Slot, SlotId, Unary,
    ValueId,
};
use crate::elementary::{Elementary, Value};
use crate::mathematics::{self, Arithmetic, BitWord, RealNumber, TruthValue};

/// The first operand, an LREAL, in the image of a helper's program.
pub const FIRST: SlotId = SlotId(0);
/// The second operand, an LREAL. It is there also where the helper takes only one.
pub const SECOND: SlotId = SlotId(1);
/// The result, an LREAL. A NaN is the one that arithmetic makes.
pub const RESULT: SlotId = SlotId(2);

/// The program that computes a helper of LREALs: it loads [`FIRST`] and, where the helper takes two, [`SECOND`], and
/// stores [`RESULT`]. Of REALs the operands are to be converted before, and the result after.
pub fn program(helper: Helper) -> Program {
    let slots = [("a", Area::Input), ("b", Area::Input), ("result", Area::Output)];
    let (ty, initial) = (Elementary::Lreal, Value::default_of(Elementary::Lreal));
    let mut layout = LayoutBuilder::new();
    for (name, area) in slots {
        layout.slot(Slot { name: name.into(), ty, offset: 0, area, retain: false, initial, line: 0 });
    }
    let layout = layout.finish(None).unwrap_or_else(|_| unreachable!("three slots fit"));
    let recorder = Recorder {
        state: RefCell::new(State { builder: Builder::new(helper.mnemonic(), layout), known: HashMap::new() }),
    };
    let result = record(&recorder, helper).value;
    let mut builder = recorder.state.into_inner().builder;
    builder.store(RESULT, result);
    builder.end_section(Origin { label: helper.mnemonic().into(), line: 0 });
    without_idle(builder.finish())
}

/// The same program without what nothing uses, such as a constant that is only wanted as another type.
fn without_idle(mut program: Program) -> Program {
    let mut used = vec![false; program.instructions.len()];
    for (index, Instruction { op, .. }) in program.instructions.iter().enumerate().rev() {
        if used[index] || !op.has_value() {
            used[index] = true;
            op.operands().for_each(|operand| used[operand.index()] = true);
        }
    }
    let mut next = 0;
    let places: Vec<u32> = used
        .iter()
        .map(|used| {
            let place = next;
            next += u32::from(*used);
            place
        })
        .collect();
    let all = std::mem::take(&mut program.instructions).into_iter().zip(used);
    program.instructions = all
        .filter(|(_, used)| *used)
        .map(|(Instruction { ty, op }, _)| Instruction { ty, op: op.map_operands(|v| ValueId(places[v.index()])) })
        .collect();
    program.sections.iter_mut().for_each(|section| section.end = next);
    program
}

fn record(m: &Recorder, helper: Helper) -> Recorded<'_, Real> {
    let a = m.load(FIRST);
    match helper {
        Helper::Ln => mathematics::ln(m, a),
        Helper::Log10 => mathematics::log10(m, a),
        Helper::Exp => mathematics::exp(m, a),
        Helper::Sin => mathematics::sin(m, a),
        Helper::Cos => mathematics::cos(m, a),
        Helper::Tan => mathematics::tan(m, a),
        Helper::Asin => mathematics::asin(m, a),
        Helper::Acos => mathematics::acos(m, a),
        Helper::Atan => mathematics::atan(m, a),
        Helper::Power => mathematics::pow(m, a, m.load(SECOND)),
    }
}

/// What makes an instruction of every operation, but no second one of the same.
struct Recorder {
    state: RefCell<State>,
}

struct State {
    builder: Builder,
    known: HashMap<(Elementary, Op), ValueId>,
}

/// A value that the program will have when it runs.
struct Recorded<'a, Kind> {
    recorder: &'a Recorder,
    value: ValueId,
    kind: PhantomData<Kind>,
}

impl<Kind> Clone for Recorded<'_, Kind> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<Kind> Copy for Recorded<'_, Kind> {}

impl<Kind> fmt::Debug for Recorded<'_, Kind> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.value.fmt(f)
    }
}

/// An LREAL.
#[derive(Debug)]
struct Real;
/// An LWORD, or a LINT with the same bits.
#[derive(Debug)]
struct Word;
/// A BOOL.
#[derive(Debug)]
struct Flag;

impl State {
    fn push(&mut self, ty: Elementary, op: Op) -> ValueId {
        if let Some(known) = self.known.get(&(ty, op)) {
            return *known;
        }
        let value = self.builder.push(ty, op);
        self.known.insert((ty, op), value);
        value
    }

    /// A word as the one or the other of its types.
    fn word_as(&mut self, ty: Elementary, word: ValueId) -> ValueId {
        match self.builder.op(word) {
            _ if self.builder.ty(word) == ty => word,
            Op::Constant(bits) => self.push(ty, Op::Constant(bits)),
            Op::Reinterpret(inner) if self.builder.ty(inner) == ty => inner,
            _ => self.push(ty, Op::Reinterpret(word)),
        }
    }

    /// The amount of a shift.
    fn amount(&mut self, word: ValueId) -> ValueId {
        match self.builder.op(word) {
            Op::Constant(bits) => self.push(Elementary::Udint, Op::Constant(bits & u64::from(u32::MAX))),
            _ => self.push(Elementary::Udint, Op::Convert(word)),
        }
    }
}

impl Recorder {
    fn load(&self, slot: SlotId) -> Recorded<'_, Real> {
        self.push(Elementary::Lreal, Op::Load(slot))
    }

    fn push<Kind>(&self, ty: Elementary, op: Op) -> Recorded<'_, Kind> {
        self.recorded(self.state.borrow_mut().push(ty, op))
    }

    fn recorded<Kind>(&self, value: ValueId) -> Recorded<'_, Kind> {
        Recorded { recorder: self, value, kind: PhantomData }
    }

    /// An operation on words, as values of a type.
    fn on_words(&self, ty: Elementary, op: Binary, [a, b]: [Recorded<'_, Word>; 2]) -> Recorded<'_, Word> {
        let mut state = self.state.borrow_mut();
        let (a, b) = (state.word_as(ty, a.value), state.word_as(ty, b.value));
        let value = state.push(ty, Op::Binary(op, a, b));
        self.recorded(value)
    }

    fn shift<'a>(&'a self, op: Binary, a: Recorded<'_, Word>, amount: Recorded<'_, Word>) -> Recorded<'a, Word> {
        let mut state = self.state.borrow_mut();
        let (a, amount) = (state.word_as(Elementary::Lword, a.value), state.amount(amount.value));
        let value = state.push(Elementary::Lword, Op::Binary(op, a, amount));
        self.recorded(value)
    }
}

impl<'a> Arithmetic for &'a Recorder {
    type Real = Recorded<'a, Real>;
    type Word = Recorded<'a, Word>;
    type Flag = Recorded<'a, Flag>;

    fn real(self, value: f64) -> Self::Real {
        self.push(Elementary::Lreal, Op::Constant(value.to_bits()))
    }

    fn word(self, value: u64) -> Self::Word {
        self.push(Elementary::Lword, Op::Constant(value))
    }

    fn root(self, a: Self::Real) -> Self::Real {
        self.push(Elementary::Lreal, Op::Unary(Unary::SquareRoot, a.value))
    }

    fn magnitude(self, a: Self::Real) -> Self::Real {
        self.push(Elementary::Lreal, Op::Unary(Unary::Absolute, a.value))
    }

    fn bits(self, a: Self::Real) -> Self::Word {
        let mut state = self.state.borrow_mut();
        match state.builder.op(a.value) {
            Op::Reinterpret(inner) => self.recorded(inner),
            _ => self.recorded(state.push(Elementary::Lword, Op::Reinterpret(a.value))),
        }
    }

    fn of_bits(self, a: Self::Word) -> Self::Real {
        self.push(Elementary::Lreal, Op::Reinterpret(a.value))
    }

    fn number(self, a: Self::Word) -> Self::Real {
        let mut state = self.state.borrow_mut();
        let a = state.word_as(Elementary::Lint, a.value);
        self.recorded(state.push(Elementary::Lreal, Op::Convert(a)))
    }

    fn less(self, a: Self::Real, b: Self::Real) -> Self::Flag {
        self.push(Elementary::Bool, Op::Compare(Compare::Less, a.value, b.value))
    }

    fn at_most(self, a: Self::Real, b: Self::Real) -> Self::Flag {
        self.push(Elementary::Bool, Op::Compare(Compare::LessOrEqual, a.value, b.value))
    }

    fn equal(self, a: Self::Real, b: Self::Real) -> Self::Flag {
        self.push(Elementary::Bool, Op::Compare(Compare::Equal, a.value, b.value))
    }

    fn below(self, a: Self::Word, b: Self::Word) -> Self::Flag {
        let mut state = self.state.borrow_mut();
        let [a, b] = [a, b].map(|word| state.word_as(Elementary::Lword, word.value));
        self.recorded(state.push(Elementary::Bool, Op::Compare(Compare::Less, a, b)))
    }

    fn is_known(self, _: Self::Flag) -> bool {
        false
    }

    fn any(self, a: Self::Word) -> Self::Flag {
        let mut state = self.state.borrow_mut();
        let [a, none] = [a.value, state.push(Elementary::Lword, Op::Constant(0))]
            .map(|word| state.word_as(Elementary::Lword, word));
        self.recorded(state.push(Elementary::Bool, Op::Compare(Compare::NotEqual, a, none)))
    }

    fn choose(self, condition: Self::Flag, a: Self::Real, b: Self::Real) -> Self::Real {
        self.push(Elementary::Lreal, Op::Select(condition.value, a.value, b.value))
    }

    fn choose_word(self, condition: Self::Flag, a: Self::Word, b: Self::Word) -> Self::Word {
        let mut state = self.state.borrow_mut();
        let [a, b] = [a, b].map(|word| state.word_as(Elementary::Lword, word.value));
        self.recorded(state.push(Elementary::Lword, Op::Select(condition.value, a, b)))
    }

    fn up(self, a: Self::Word, amount: Self::Word) -> Self::Word {
        self.shift(Binary::ShiftLeft, a, amount)
    }

    fn down(self, a: Self::Word, amount: Self::Word) -> Self::Word {
        self.shift(Binary::ShiftRight, a, amount)
    }
}

impl RealNumber for Recorded<'_, Real> {}
impl BitWord for Recorded<'_, Word> {}
impl TruthValue for Recorded<'_, Flag> {}

macro_rules! on_reals {
    ($($name:ident $method:ident $op:ident;)*) => {$(
        impl $name for Recorded<'_, Real> {
            type Output = Self;

            fn $method(self, b: Self) -> Self {
                self.recorder.push(Elementary::Lreal, Op::Binary(Binary::$op, self.value, b.value))
            }
        }

        impl $name<f64> for Recorded<'_, Real> {
            type Output = Self;

            fn $method(self, b: f64) -> Self {
                $name::$method(self, self.recorder.real(b))
            }
        }
    )*};
}

on_reals! {
    Add add Add;
    Sub sub Subtract;
    Mul mul Multiply;
    Div div Divide;
}

impl Neg for Recorded<'_, Real> {
    type Output = Self;

    fn neg(self) -> Self {
        self.recorder.push(Elementary::Lreal, Op::Unary(Unary::Negate, self.value))
    }
}

macro_rules! on_words {
    ($($name:ident $method:ident $op:ident $ty:ident;)*) => {$(
        impl $name for Recorded<'_, Word> {
            type Output = Self;

            fn $method(self, b: Self) -> Self {
                self.recorder.on_words(Elementary::$ty, Binary::$op, [self, b])
            }
        }
    )*};
}

on_words! {
    Add add Add Lint;
    Sub sub Subtract Lint;
    Mul mul Multiply Lint;
    BitAnd bitand And Lword;
    BitOr bitor Or Lword;
    BitXor bitxor Xor Lword;
}

macro_rules! on_flags {
    ($($name:ident $method:ident $op:ident;)*) => {$(
        impl $name for Recorded<'_, Flag> {
            type Output = Self;

            fn $method(self, b: Self) -> Self {
                self.recorder.push(Elementary::Bool, Op::Binary(Binary::$op, self.value, b.value))
            }
        }
    )*};
}

on_flags! {
    BitAnd bitand And;
    BitOr bitor Or;
    BitXor bitxor Xor;
}

impl Not for Recorded<'_, Word> {
    type Output = Self;

    fn not(self) -> Self {
        let mut state = self.recorder.state.borrow_mut();
        let a = state.word_as(Elementary::Lword, self.value);
        self.recorder.recorded(state.push(Elementary::Lword, Op::Unary(Unary::Not, a)))
    }
}

impl Not for Recorded<'_, Flag> {
    type Output = Self;

    fn not(self) -> Self {
        self.recorder.push(Elementary::Bool, Op::Unary(Unary::Not, self.value))
    }
}
