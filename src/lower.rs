//! Lowering: from a checked program to one straight-line scan of logic.
//!
//! `allocate` gives every variable, pin and memory its slots, as `used` finds them needed and `storage` describes, and
//! `observe` says which can be watched; `network`,
//! `statement`, `call` and `expression` turn the rungs into primitives, element by element in the order of the drawing,
//! with `place` for what is read and written and `guard` for what is not executed; `blocks` has each function block's rule,
//! `functions` each function's; at last `arrange` lays the image out by use. The code that comes out is naive on purpose:
//! nothing here may simplify or reorder, that is for the passes.

mod aggregate;
mod allocate;
mod arrange;
mod attempt;
mod blocks;
mod call;
mod cell;
mod expression;
mod functions;
mod guard;
mod network;
mod observe;
mod place;
mod statement;
mod storage;
mod used;

#[cfg(test)]
mod tests;

use attempt::Attempt;
use cell::Pick;
use guard::Guard;
use place::Part;
use statement::Counter;
use storage::{Cells, Frame, Slots};

use crate::check::{Checked, ProgramInstance, RungIndex, UnitId, UnitKind, VariableId};
use crate::logic::image::{EarlierLayout, ImageTooLarge};
use crate::logic::{Builder, Origin, Program, ValueId};
use crate::source::{Source, Span};

/// Instructions that there is room for at first, for each rung: most rungs come to fewer, and where the system gives memory
/// out as it is touched, as Linux does, room that is not used takes none.
const INSTRUCTIONS_PER_RUNG: usize = 24;

/// Lowers a checked program; slots that an earlier layout has keep their offsets.
///
/// # Errors
/// [`ImageTooLarge`] when the variables and memories do not fit an image.
pub fn lower(checked: &Checked, source: &Source, earlier: Option<&EarlierLayout>) -> Result<Program, ImageTooLarge> {
    let line = |span: Span| u32::try_from(source.line(span.start)).unwrap_or(0);
    let (slots, layout) = allocate::allocate(checked, line, earlier)?;
    let mut lowering = Lowering {
        logic: Builder::new(checked.name(), layout),
        checked,
        slots: &slots,
        unit: Running::nothing(&slots),
        guard: Guard::default(),
        attempt: Attempt::default(),
        failed: None,
        counters: Vec::new(),
    };
    let rungs = |program: &ProgramInstance| checked.unit(program.unit).rungs.len();
    let rungs = checked.programs().iter().map(rungs).fold(0, usize::saturating_add);
    lowering.logic.reserve(INSTRUCTIONS_PER_RUNG.saturating_mul(rungs));
    for ((task, number), due) in checked.tasks().iter().zip(0..).zip(&slots.due) {
        for (program, frame) in checked.programs().iter().zip(&slots.programs) {
            if program.task.0 == number {
                lowering.program(program.unit, frame, line);
            }
        }
        lowering.logic.end_task(&task.name, task.interval, *due);
    }
    arrange::by_use(lowering.logic.finish(), earlier)
}

/// The state of lowering one program.
struct Lowering<'a> {
    logic: Builder,
    checked: &'a Checked,
    slots: &'a Slots,
    /// The unit that is being lowered, or inlined.
    unit: Running<'a>,
    guard: Guard,
    attempt: Attempt,
    /// Whether an index was out of range in what was executed of the braces that are being lowered.
    failed: Option<ValueId>,
    /// The variables of the loops that are being unrolled, the innermost last.
    counters: Vec<Counter>,
}

/// One run of a unit.
struct Running<'a> {
    id: UnitId,
    is_function: bool,
    /// Behind the last rung.
    end: RungIndex,
    /// Where its variables lie, and which element of the runs there are those of this instance.
    frame: &'a Frame,
    pick: Pick,
    /// What some of its variables stand for.
    references: Vec<(VariableId, Part<'a>)>,
    /// The memories of the edge contacts and edge coils that are still to come, in the order of the drawing.
    edges: std::slice::Iter<'a, Cells>,
    /// The power on each node of the rung, as far as it is fed.
    nodes: Vec<Option<ValueId>>,
}

impl<'a> Running<'a> {
    /// Before the first program.
    fn nothing(slots: &'a Slots) -> Self {
        let frame = &slots.globals;
        let (id, end, pick) = (UnitId(0), RungIndex(0), Pick::Constant(0));
        let (references, edges, nodes) = (Vec::new(), frame.edges.iter(), Vec::new());
        Self { id, is_function: false, end, frame, pick, references, edges, nodes }
    }

    fn new(
        checked: &Checked,
        id: UnitId,
        frame: &'a Frame,
        pick: Pick,
        references: Vec<(VariableId, Part<'a>)>,
    ) -> Self {
        let unit = checked.unit(id);
        Self {
            id,
            is_function: matches!(unit.kind, UnitKind::Function { .. }),
            end: RungIndex(u32::try_from(unit.rungs.len()).unwrap_or(u32::MAX)),
            frame,
            pick,
            references,
            edges: frame.edges.iter(),
            nodes: Vec::new(),
        }
    }
}

impl<'a> Lowering<'a> {
    /// A program instance: a section for each of its rungs.
    fn program(&mut self, id: UnitId, frame: &'a Frame, line: impl Fn(Span) -> u32) {
        self.unit = Running::new(self.checked, id, frame, Pick::Constant(0), Vec::new());
        self.enter_program();
        self.initialise_temporaries();
        for (index, rung) in (0..).zip(&self.checked.unit(id).rungs) {
            self.land(RungIndex(index));
            self.rung(rung);
            self.logic.end_section(Origin { label: rung.label.clone(), line: line(rung.span) });
        }
    }
}
