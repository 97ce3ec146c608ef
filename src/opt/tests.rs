//! Each pass before and after, a file a pass. That they change no image is tested with an engine, in `tests/passes.rs`.

mod algebra;
mod check;
mod chunk;
mod cut;
mod fold;
mod forward;
mod narrow;
mod reduce;
mod share;
mod simplify;
mod sweep;

use super::PASSES;
use crate::elementary::{Elementary, Value};
use crate::logic::{Area, ArrayId, Builder, LayoutBuilder, Op, Origin, Program, Slot, SlotId};

/// A program over BOOLs `a` to `e` and an INT `n`, made by `sections`, one after another.
fn program(sections: &[fn(&mut Builder, &[SlotId])]) -> Program {
    let mut layout = LayoutBuilder::new();
    let mut slot = |name: &str, ty| {
        let (name, initial) = (name.to_owned(), Value::default_of(ty));
        layout.slot(Slot { name: name.into(), ty, offset: 0, area: Area::Memory, retain: false, initial, line: 0 })
    };
    let mut slots: Vec<SlotId> = ["a", "b", "c", "d", "e"].map(|name| slot(name, Elementary::Bool)).to_vec();
    slots.push(slot("n", Elementary::Int));
    let mut logic = Builder::new("p", layout.finish(None).expect("a small image"));
    for section in sections {
        section(&mut logic, &slots);
        logic.end_section(Origin { label: "r".into(), line: 1 });
    }
    logic.finish()
}

fn pass(name: &str, program: Program) -> Program {
    let pass = PASSES.iter().find(|pass| pass.name == name).expect("a pass of that name");
    (pass.run)(program)
}

/// The instructions after a pass and the sweep.
fn after(name: &str, sections: &[fn(&mut Builder, &[SlotId])]) -> String {
    print(&pass("sweep", pass(name, program(sections))))
}

/// One instruction after another, slots by name and values by place.
fn print(program: &Program) -> String {
    let name = |slot: SlotId| program.layout.slot(slot).name.clone();
    let mut out = Vec::new();
    for (index, instruction) in program.instructions.iter().enumerate() {
        out.push(match instruction.op {
            Op::Constant(bits) => format!("v{index} = {bits}"),
            Op::Now => format!("v{index} = now"),
            Op::Load(slot) => format!("v{index} = {}", name(slot)),
            Op::Store(slot, a) => format!("{} := {a}", name(slot)),
            Op::LoadIndexed(array, place) => format!("v{index} = {array}[{place}]"),
            Op::StoreIndexed(array, place, a) => format!("{array}[{place}] := {a}"),
            Op::CopyArray(to, from, condition) => format!("{to} := {from} while {condition}"),
            Op::Unary(op, a) => format!("v{index} = {} {a}", op.mnemonic()),
            Op::Binary(op, a, b) => format!("v{index} = {} {a} {b}", op.mnemonic()),
            Op::Compare(op, a, b) => format!("v{index} = {} {a} {b}", op.mnemonic()),
            Op::Select(c, a, b) => format!("v{index} = select {c} {a} {b}"),
            Op::Convert(a) => format!("v{index} = {}({a})", instruction.ty),
            Op::Reinterpret(a) => format!("v{index} = {}'({a})", instruction.ty),
            Op::Call(helper, ..) => {
                let operands: Vec<String> = instruction.op.operands().map(|operand| operand.to_string()).collect();
                format!("v{index} = {} {}", helper.mnemonic(), operands.join(" "))
            }
        });
    }
    out.join("; ")
}

/// A program over arrays `x` and `y` of three INTs, INTs `n` and `m`, and a LINT `i`, of one section.
fn over_arrays(section: impl Fn(&mut Builder, [ArrayId; 2], &[SlotId])) -> Program {
    let mut layout = LayoutBuilder::new();
    let mut slot = |name: &str, ty| {
        let (name, initial) = (name.to_owned(), Value::default_of(ty));
        layout.slot(Slot { name: name.into(), ty, offset: 0, area: Area::Memory, retain: false, initial, line: 0 })
    };
    let names = ["x[0]", "x[1]", "x[2]", "y[0]", "y[1]", "y[2]", "n", "m"];
    let mut slots = names.map(|name| slot(name, Elementary::Int)).to_vec();
    slots.push(slot("i", Elementary::Lint));
    let arrays = [slots[0], slots[3]].map(|first| layout.array(first, 3));
    let mut logic = Builder::new("p", layout.finish(None).expect("a small image"));
    section(&mut logic, arrays, &slots);
    logic.end_section(Origin { label: "r".into(), line: 1 });
    logic.finish()
}

fn lint(value: i64) -> Value {
    Value::from_bits(Elementary::Lint, value.cast_unsigned())
}
