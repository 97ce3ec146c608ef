//! The walk over the instructions of some sections: what becomes an expression of its own, and what part of another.
//!
//! A value with one use is written where it is used, one with several where it is made, unless it is stored first: then
//! the others read it from there. A load is written at each use. Before a slot is stored, all that was not yet written
//! and reads it becomes a constant of its own. So the statements come in the order of the instructions, and no value is
//! computed twice.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

use super::expression::{Binding, Expression, Form};
use super::library::{function, short};
use crate::elementary::Elementary;
use crate::emit::structure::{Structure, c_type};
use crate::logic::{ArrayId, Op, Program, SlotId, ValueId};

/// Where lines are broken, in characters.
const WIDTH: usize = 110;

/// An expression longer than this, in bytes, is cut.
const LONGEST: usize = 240;

/// An expression nested deeper than this is cut; C promises 63.
const DEEPEST: u32 = 20;

/// What has become of a value.
enum State {
    /// It is not made yet, or no longer needed.
    Nothing,
    /// It is to be written where it is used.
    Pending(Expression),
    /// It has a name.
    Named(Form),
}

/// Where slots lie.
#[derive(Clone, Copy)]
pub(super) enum Places<'a> {
    /// In the structure that `image` points to.
    Image(&'a Structure<'a>),
    /// In variables of these names, of which none is part of an array.
    Variables(&'a [&'a str]),
}

impl Places<'_> {
    fn slot(self, slot: SlotId) -> String {
        match self {
            Self::Image(structure) => format!("image->{}", structure.access(slot)),
            Self::Variables(names) => names[slot.index()].to_owned(),
        }
    }

    fn pointer(self, slot: SlotId) -> String {
        match self {
            Self::Image(structure) => structure.pointer(slot),
            Self::Variables(names) => format!("&{}", names[slot.index()]),
        }
    }
}

/// The statements of some sections.
pub(super) struct Body<'a> {
    pub(super) program: &'a Program,
    places: Places<'a>,
    /// The first instruction.
    first: usize,
    states: Vec<State>,
    /// How often each value is still to be used by what counts.
    uses: Vec<u32>,
    /// Whether the first use is to be stored.
    stored_first: Vec<bool>,
    /// Which values were pending and read a slot, some of them no longer.
    readers: BTreeMap<SlotId, Vec<ValueId>>,
    lines: Vec<Line>,
}

/// A line of the function, or a statement of several.
struct Line {
    /// The value that it defines.
    defines: Option<ValueId>,
    text: String,
}

impl<'a> Body<'a> {
    pub(super) fn new(program: &'a Program, places: Places<'a>, instructions: Range<usize>) -> Self {
        let count = instructions.len();
        let mut body = Self {
            program,
            places,
            first: instructions.start,
            states: std::iter::repeat_with(|| State::Nothing).take(count).collect(),
            uses: vec![0; count],
            stored_first: vec![false; count],
            readers: BTreeMap::new(),
            lines: Vec::new(),
        };
        // Backwards, so that what only the unused use is not used either, and the last that counts is the first use.
        for place in instructions.rev() {
            let op = program.instructions[place].op;
            if op.has_value() && body.uses[place - body.first] == 0 {
                continue;
            }
            for operand in op.operands() {
                let operand = operand.index() - body.first;
                body.uses[operand] += 1;
                body.stored_first[operand] = matches!(op, Op::Store(..));
            }
        }
        body
    }

    /// The statements, but those that define what none of the others reads: an operation may turn out not to need an
    /// operand.
    pub(super) fn finish(self) -> String {
        let mut read = BTreeSet::new();
        let mut kept: Vec<&str> = Vec::new();
        for line in self.lines.iter().rev() {
            if line.defines.is_none_or(|id| read.contains(&id)) {
                read.extend(values(&line.text).filter(|id| Some(*id) != line.defines));
                kept.push(&line.text);
            }
        }
        kept.into_iter().rev().collect()
    }

    /// Writes the comment above a rung.
    pub(super) fn heading(&mut self, comment: &str) {
        let line = if self.lines.is_empty() { "" } else { "\n" };
        self.lines.push(Line { defines: None, text: format!("{line}    {comment}\n") });
    }

    /// Writes a statement, broken into lines.
    fn statement(&mut self, statement: &str) {
        self.define(None, statement);
    }

    fn define(&mut self, defines: Option<ValueId>, statement: &str) {
        let (mut text, mut column) = ("    ".to_owned(), 4);
        for (number, word) in statement.split(' ').enumerate() {
            if number > 0 && column + word.len() >= WIDTH {
                text.push_str("\n        ");
                column = 8;
            } else if number > 0 {
                text.push(' ');
                column += 1;
            }
            text.push_str(word);
            column += word.len();
        }
        text.push('\n');
        self.lines.push(Line { defines, text });
    }

    /// The type of a value.
    pub(super) fn ty(&self, value: ValueId) -> Elementary {
        self.program.instructions[value.index()].ty
    }

    /// Writes an instruction, or keeps it for later.
    pub(super) fn instruction(&mut self, place: usize) {
        let instruction = self.program.instructions[place];
        let id = ValueId(u32::try_from(place).unwrap_or(u32::MAX));
        let at = place - self.first;
        if instruction.op.has_value() && self.uses[at] == 0 {
            return;
        }
        match instruction.op {
            Op::Store(slot, value) => {
                let taken = self.storable(value);
                let access = self.places.slot(slot);
                // What else uses it reads it there, unless it has a name or is such a reading or a constant itself.
                let at = value.index() - self.first;
                let is_simple = |expression: &Expression| {
                    expression.constant.is_some() || (expression.depth == 0 && expression.binding == Binding::Primary)
                };
                let moves =
                    self.uses[at] > 0 && matches!(&self.states[at], State::Pending(pending) if !is_simple(pending));
                if moves {
                    self.states[at] = State::Nothing;
                }
                self.before_store(slot..SlotId(slot.0.saturating_add(1)));
                self.statement(&format!("{access} = {};", taken.text));
                if moves {
                    self.keep(value, Expression::load(access, slot));
                }
            }
            Op::StoreIndexed(array, index, value) => {
                let (index, value) = (self.exact(index), self.storable(value));
                self.before_store(self.program.layout.array(array).slots());
                let (pointer, count, ty) = self.array(array);
                let put = self.function("put", ty);
                self.statement(&format!("{put}({pointer}, {count}u, {}, {});", index.text, value.text));
            }
            Op::CopyArray(to, from, condition) => {
                let condition = self.argument(condition);
                if self.program.layout.array(to) == self.program.layout.array(from) || condition.constant == Some(0) {
                    return;
                }
                self.before_store(self.program.layout.array(to).slots());
                let ((to, count, ty), (from, ..)) = (self.array(to), self.array(from));
                if condition.constant == Some(1) {
                    let copy = self.function("move", ty);
                    self.statement(&format!("{copy}({to}, {from}, {count}u);"));
                } else {
                    let copy = self.function("copy", ty);
                    self.statement(&format!("{copy}({to}, {from}, {count}u, {});", condition.text));
                }
            }
            Op::Load(slot) => {
                self.keep(id, Expression::load(self.places.slot(slot), slot));
            }
            Op::LoadIndexed(array, index) => {
                let index = self.exact(index);
                let (pointer, count, ty) = self.array(array);
                let at = self.function("at", ty);
                let text = format!("{at}({pointer}, {count}u, {})", index.text);
                self.name(id, &Expression::new(text, Binding::Primary, Form::Exact, &[&index]));
            }
            Op::Constant(bits) => {
                self.keep(id, Expression::constant(instruction.ty, bits));
            }
            Op::Now => self.keep(id, Expression::name("now")),
            Op::Unary(op, a) => {
                let made = self.unary(op, a);
                self.made(id, made);
            }
            Op::Binary(op, a, b) => {
                let made = self.binary(op, a, b);
                self.made(id, made);
            }
            Op::Compare(op, a, b) => {
                let made = self.compare(op, a, b);
                self.made(id, made);
            }
            Op::Select(condition, a, b) => {
                let made = self.select(condition, a, b);
                self.made(id, made);
            }
            Op::Convert(a) => {
                let made = self.convert(a, instruction.ty);
                self.made(id, made);
            }
            Op::Reinterpret(a) => {
                let made = self.reinterpret(a, instruction.ty);
                self.made(id, made);
            }
            Op::Call(helper, a, b) => {
                let made = self.call(helper, a, b);
                self.made(id, made);
            }
        }
    }

    /// A new value: where it is used, or with a name.
    fn made(&mut self, id: ValueId, made: Expression) {
        let at = id.index() - self.first;
        let waits = self.uses[at] == 1 || self.stored_first[at] || made.constant.is_some();
        if waits && made.text.len() <= LONGEST && made.depth <= DEEPEST {
            self.keep(id, made);
        } else {
            self.name(id, &made);
        }
    }

    fn keep(&mut self, id: ValueId, expression: Expression) {
        for slot in &expression.reads {
            self.readers.entry(*slot).or_default().push(id);
        }
        self.states[id.index() - self.first] = State::Pending(expression);
    }

    /// Gives a value a name.
    fn name(&mut self, id: ValueId, expression: &Expression) {
        let ty = self.ty(id);
        let value = expression.clone().narrow(ty);
        self.define(Some(id), &format!("const {} {id} = {};", c_type(ty), value.text));
        let form = if value.form == Form::Unsettled { Form::Unsettled } else { Form::Exact };
        self.states[id.index() - self.first] = State::Named(form);
    }

    /// The name of a value that was taken, given to it for this use and all later ones.
    pub(super) fn named(&mut self, id: ValueId, taken: &Expression) -> Expression {
        self.name(id, taken);
        Expression::name(id.to_string())
    }

    /// Names what is still to be used of what reads some slots.
    fn before_store(&mut self, slots: Range<SlotId>) {
        let readers: Vec<SlotId> = self.readers.range(slots).map(|(slot, _)| *slot).collect();
        for slot in readers {
            for id in self.readers.remove(&slot).unwrap_or_default() {
                let at = id.index() - self.first;
                match &self.states[at] {
                    State::Pending(pending) if self.uses[at] > 0 && pending.reads.contains(&slot) => {
                        let pending = pending.clone();
                        self.name(id, &pending);
                    }
                    _ => {}
                }
            }
        }
    }

    /// A value for one of its uses.
    pub(super) fn take(&mut self, id: ValueId) -> Expression {
        let at = id.index() - self.first;
        self.uses[at] = self.uses[at].saturating_sub(1);
        match &mut self.states[at] {
            State::Named(form) => Expression { form: *form, ..Expression::name(id.to_string()) },
            State::Pending(pending) if self.uses[at] > 0 => pending.clone(),
            state @ State::Pending(_) => match std::mem::replace(state, State::Nothing) {
                State::Pending(pending) => pending,
                State::Nothing | State::Named(_) => unreachable!("it is pending"),
            },
            State::Nothing => unreachable!("a verified program defines {id} before its uses"),
        }
    }

    /// The value, of any form but [`Form::Ring`].
    pub(super) fn value(&mut self, id: ValueId) -> Expression {
        let ty = self.ty(id);
        self.take(id).value(ty)
    }

    /// The value as it may be stored or given to a function.
    pub(super) fn argument(&mut self, id: ValueId) -> Expression {
        let ty = self.ty(id);
        self.take(id).narrow(ty)
    }

    /// The value in its very type.
    pub(super) fn exact(&mut self, id: ValueId) -> Expression {
        let ty = self.ty(id);
        self.take(id).exact(ty)
    }

    /// The value with the bits that it is to be stored with, or told from others by.
    pub(super) fn storable(&mut self, id: ValueId) -> Expression {
        let ty = self.ty(id);
        let value = self.argument(id);
        if value.form == Form::Unsettled {
            let settled = self.function("settled", ty);
            Expression::call(&settled, &[&value], Form::Exact)
        } else {
            value
        }
    }

    /// The function of the library for a type.
    pub(super) fn function(&self, stem: &str, ty: Elementary) -> String {
        function(stem, short(c_type(ty)))
    }

    /// A pointer to an array, how many elements it has, and of which type.
    fn array(&self, array: ArrayId) -> (String, u32, Elementary) {
        let array = self.program.layout.array(array);
        (self.places.pointer(array.first), array.count, self.program.layout.slot(array.first).ty)
    }
}

/// The values that a text names.
fn values(text: &str) -> impl Iterator<Item = ValueId> {
    let is_part = |character: char| character.is_ascii_alphanumeric() || character == '_';
    // A member may have such a name, too.
    let words = text.split(move |character| !is_part(character) && character != '>');
    words.filter_map(|word| word.strip_prefix('v')?.parse().ok().map(ValueId))
}
