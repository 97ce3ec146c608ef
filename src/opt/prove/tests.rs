//! The prover, a file a matter.

mod bits;
mod mutants;
mod passes;
mod proofs;

use crate::elementary::{Elementary, Value};
use crate::logic::{Area, Builder, LayoutBuilder, Origin, Program, Slot, SlotId, ValueId};
use crate::opt::{PASSES, Pass};

/// What becomes of a pass's output.
type Run = fn(Program) -> Program;

/// A pass for tests.
fn pass(run: Run) -> Pass {
    Pass { name: "test", run, of_all: true }
}

/// A program of one section over slots `x0`, `x1`, ... of some types, and `y` for the result.
fn program(types: &[Elementary], result: Elementary, section: impl Fn(&mut Builder, &[ValueId]) -> ValueId) -> Program {
    let mut layout = LayoutBuilder::new();
    let mut slot = |name: String, ty| {
        let initial = Value::default_of(ty);
        layout.slot(Slot { name: name.into(), ty, offset: 0, area: Area::Memory, retain: false, initial, line: 0 })
    };
    let slots: Vec<SlotId> = types.iter().enumerate().map(|(index, ty)| slot(format!("x{index}"), *ty)).collect();
    let result = slot("y".to_owned(), result);
    let mut logic = Builder::new("p", layout.finish(None).expect("a small image"));
    let values: Vec<ValueId> = slots.iter().map(|slot| logic.load(*slot)).collect();
    let value = section(&mut logic, &values);
    logic.store(result, value);
    logic.end_section(Origin { label: "r".into(), line: 1 });
    logic.finish()
}

/// The passes but those that only cut.
fn optimised(program: Program) -> Program {
    PASSES.iter().fold(program, |program, pass| (pass.run)(program))
}
