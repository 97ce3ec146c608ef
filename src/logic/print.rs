//! Logic as text, for people and for [`parse`](super::parse), which gets the very same program back from it.
//!
//! ```text
//! program "pump"
//! image 8
//!   s0 BOOL at 0 input line 3 = FALSE "start"
//!   array a0 s0 count 1
//!   inputs 0..1 bools 0..1
//!   observe s0 "start"
//! task "fast" every T#10ms due s1
//! chunk
//! section 0 line 5 "r10"
//!   v0 = load s0 ; start
//! ```
//!
//! A program whose only task is not named and runs in every round has no line for it. One thing to a line; a semicolon starts a comment. It must print unverified programs, too, for those who look for
//! the fault in one; only verified ones can be parsed again.

use std::fmt::{self, Write};

use super::image::Observed;
use super::{Area, Array, Op, Origin, Program, Slot, SlotId, Task, ValueId};
use crate::elementary::{Elementary, Value, f32_of};

/// The text of a program.
pub fn print(program: &Program) -> String {
    let mut text = String::new();
    // A `String` takes all that is written to it.
    let _ = program_text(&mut text, program);
    text
}

fn program_text(text: &mut String, program: &Program) -> fmt::Result {
    writeln!(text, "program {}", Quoted(&program.name))?;
    image(text, program)?;
    let mut used = vec![false; program.origins.len()];
    for section in &program.sections {
        if let Some(used) = used.get_mut(section.origin as usize) {
            *used = true;
        }
    }
    for (index, Origin { label, line }) in program.origins.iter().enumerate().filter(|(index, _)| !used[*index]) {
        writeln!(text, "origin {index} line {line} {}", Quoted(label))?;
    }
    let plain = matches!(program.tasks.as_slice(), [task] if task.is_plain());
    let mut tasks = program.tasks.iter().filter(|_| !plain);
    let (mut place, mut task_end) = (0, 0);
    for (index, section) in program.sections.iter().enumerate() {
        while task_end <= index
            && let Some(next) = tasks.next()
        {
            task(text, next)?;
            task_end = next.end as usize;
        }
        if section.starts_chunk {
            writeln!(text, "chunk")?;
        }
        write!(text, "section {}", section.origin)?;
        match program.origins.get(section.origin as usize) {
            Some(Origin { label, line }) => writeln!(text, " line {line} {}", Quoted(label))?,
            None => writeln!(text)?,
        }
        while place < program.instructions.len().min(section.end as usize) {
            instruction(text, program, place)?;
            place += 1;
        }
    }
    tasks.try_for_each(|next| task(text, next))
}

fn task(text: &mut String, Task { name, interval, due, .. }: &Task) -> fmt::Result {
    write!(text, "task {}", Quoted(name))?;
    if let Some(interval) = interval {
        write!(text, " every {}", Literal(Value::time(*interval)))?;
    }
    if let Some(due) = due {
        write!(text, " due {due}")?;
    }
    writeln!(text)
}

fn image(text: &mut String, program: &Program) -> fmt::Result {
    let layout = &program.layout;
    writeln!(text, "image {}", layout.size())?;
    for (index, slot) in layout.slots().iter().enumerate() {
        let Slot { name, ty, offset, area, retain, initial, line } = slot;
        let retain = if *retain { " retain" } else { "" };
        write!(text, "  s{index} {ty} at {offset} {}{retain} line {line} = ", area_name(*area))?;
        writeln!(text, "{} {}", Literal(*initial), Quoted(name))?;
    }
    for (index, Array { first, count }) in layout.arrays().iter().enumerate() {
        writeln!(text, "  array a{index} {first} count {count}")?;
    }
    for extent in layout.inputs() {
        writeln!(text, "  inputs {:?} bools {:?}", extent.bytes, extent.bools)?;
    }
    for run in layout.outputs() {
        writeln!(text, "  outputs {run:?}")?;
    }
    for run in layout.retained() {
        writeln!(text, "  retained {run:?}")?;
    }
    for Observed { name, slot } in layout.observed() {
        writeln!(text, "  observe {slot} {}", Quoted(name))?;
    }
    Ok(())
}

fn instruction(text: &mut String, program: &Program, place: usize) -> fmt::Result {
    let instruction = program.instructions[place];
    let ty = instruction.ty;
    let comment = |slot: SlotId| program.layout.slots().get(slot.index()).map_or("", |slot| slot.name.as_str());
    let ty_of =
        |value: ValueId| program.instructions.get(value.index()).map_or(Elementary::Bool, |instruction| instruction.ty);
    match instruction.op {
        Op::Store(slot, a) => writeln!(text, "  store {slot}, {a} ; {}", Escaped(comment(slot))),
        Op::StoreIndexed(array, index, a) => writeln!(text, "  store_indexed {array}, {index}, {a}"),
        Op::CopyArray(to, from, condition) => writeln!(text, "  copy_array {to}, {from}, {condition}"),
        op => {
            write!(text, "  v{place} = ")?;
            match op {
                Op::Constant(bits) => writeln!(text, "const {ty} {}", Literal(Value::from_bits(ty, bits))),
                Op::Now => writeln!(text, "now"),
                Op::Load(slot) => writeln!(text, "load {slot} ; {}", Escaped(comment(slot))),
                Op::LoadIndexed(array, index) => writeln!(text, "load_indexed {array}, {index}"),
                Op::Store(..) | Op::StoreIndexed(..) | Op::CopyArray(..) => Ok(()),
                Op::Unary(op, a) => writeln!(text, "{} {ty} {a}", op.mnemonic()),
                Op::Binary(op, a, b) => writeln!(text, "{} {ty} {a}, {b}", op.mnemonic()),
                Op::Compare(op, a, b) => writeln!(text, "{} {} {a}, {b}", op.mnemonic(), ty_of(a)),
                Op::Select(condition, a, b) => writeln!(text, "select {ty} {condition}, {a}, {b}"),
                Op::Convert(a) => writeln!(text, "convert {ty} {a} ; from {}", ty_of(a)),
                Op::Reinterpret(a) => writeln!(text, "reinterpret {ty} {a} ; from {}", ty_of(a)),
                Op::Call(helper, a, None) => writeln!(text, "{} {ty} {a}", helper.mnemonic()),
                Op::Call(helper, a, Some(b)) => writeln!(text, "{} {ty} {a}, {b}", helper.mnemonic()),
            }
        }
    }
}

/// The word for a part of the image.
pub(super) const fn area_name(area: Area) -> &'static str {
    match area {
        Area::Input => "input",
        Area::Output => "output",
        Area::Memory => "memory",
        Area::State => "state",
    }
}

/// The part of the image that a word names.
pub(super) fn area_of(name: &str) -> Option<Area> {
    [Area::Input, Area::Output, Area::Memory, Area::State].into_iter().find(|area| area_name(*area) == name)
}

/// Units of TIME, the largest first, in nanoseconds.
pub(super) const UNITS: [(&str, i128); 7] = [
    ("d", 86_400_000_000_000),
    ("h", 3_600_000_000_000),
    ("m", 60_000_000_000),
    ("s", 1_000_000_000),
    ("ms", 1_000_000),
    ("us", 1_000),
    ("ns", 1),
];

/// A value as text says it, exactly: `-5`, `16#FF`, `T#1050ms`, `0.1`.
pub fn literal(value: Value) -> impl fmt::Display {
    Literal(value)
}

/// A value, exactly: as IEC 61131-3 writes it, but that infinities and NaNs are bits.
struct Literal(Value);

impl fmt::Display for Literal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (ty, bits) = (self.0.ty(), self.0.bits());
        match (self.0.as_integer(), self.0.as_real()) {
            (_, Some(real)) if !real.is_finite() => write!(f, "16#{bits:X}"),
            (_, Some(_)) if ty == Elementary::Real => write!(f, "{:?}", f32_of(bits)),
            (_, Some(real)) => write!(f, "{real:?}"),
            _ if ty == Elementary::Bool => f.write_str(if bits == 0 { "FALSE" } else { "TRUE" }),
            _ if ty.is_bit_string() => write!(f, "16#{bits:X}"),
            (Some(number), _) if ty == Elementary::Time => {
                let (unit, size) = UNITS.iter().find(|(_, size)| number % size == 0).copied().unwrap_or(("ns", 1));
                let (unit, size) = if number == 0 { ("s", 1) } else { (unit, size) };
                write!(f, "T#{}{unit}", number / size)
            }
            (number, _) => write!(f, "{}", number.unwrap_or_default()),
        }
    }
}

/// A text whose backslashes, quotes and control characters are escaped, so that it stays in its line.
struct Escaped<'a>(&'a str);

impl fmt::Display for Escaped<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.chars().try_for_each(|character| match character {
            '"' | '\\' => write!(f, "\\{character}"),
            _ if character.is_control() => write!(f, "\\u{{{:x}}}", u32::from(character)),
            _ => f.write_char(character),
        })
    }
}

struct Quoted<'a>(&'a str);

impl fmt::Display for Quoted<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "\"{}\"", Escaped(self.0))
    }
}
