//! Where things lie: storage is a tree over types, and each of its leaves a run of slots.
//!
//! An array is no node over its elements but makes the runs below it longer (a structure of arrays): all elements of all
//! arrays around a leaf are one run, the last index fastest, so that one number picks an element at every leaf.
//! Nothing here knows names; `allocate` makes what is here, `place` finds its way through it.

use std::collections::HashMap;

use crate::check::{UnitId, VariableId};
use crate::logic::{ArrayId, SlotId};

/// The slots of one leaf.
#[derive(Clone, Copy)]
pub(super) struct Cells {
    /// The slot of the element 0.
    pub(super) first: SlotId,
    /// How many there are; 1 outside arrays.
    pub(super) count: u32,
    /// The same as an array, inside arrays.
    pub(super) array: Option<ArrayId>,
}

impl Cells {
    /// The slot of an element that is there.
    pub(super) fn slot(self, element: u32) -> SlotId {
        SlotId(self.first.0 + element)
    }
}

/// Where something of a type lies.
pub(super) enum Storage {
    /// A value.
    Value(Cells),
    /// An instance of a standard block.
    Block(BlockCells),
    /// An instance of a unit.
    Unit(Frame),
    /// An array; the elements share the runs.
    Array(Box<Self>),
    /// A structure, member by member.
    Structure(Vec<Self>),
}

/// Where an instance of a standard block lies.
pub(super) struct BlockCells {
    /// One entry an input; `None` where nobody could tell.
    pub(super) inputs: Vec<Option<Cells>>,
    /// One entry an output.
    pub(super) outputs: Vec<Cells>,
    /// One entry a state of the block's rule.
    pub(super) states: Vec<Cells>,
}

/// Where the variables of a unit, or the global ones, lie.
pub(super) struct Frame {
    /// Its variables, but one that stands for another, or whose storage is that of its address.
    pub(super) variables: HashMap<VariableId, Storage>,
    /// The memories of the edge contacts and edge coils, in the order of the drawing.
    pub(super) edges: Vec<Cells>,
}

impl Frame {
    /// Where one of its variables lies.
    pub(super) fn get(&self, variable: VariableId) -> Option<&Storage> {
        self.variables.get(&variable)
    }
}

/// The slots of a whole program.
pub(super) struct Slots {
    /// The global variables.
    pub(super) globals: Frame,
    /// What stands at addresses, by the first variable there.
    pub(super) located: HashMap<VariableId, Storage>,
    /// One entry a program instance.
    pub(super) programs: Vec<Frame>,
    /// The one frame of each function that is called.
    pub(super) functions: HashMap<UnitId, Frame>,
    /// One entry a task: when it is due next, if it has an interval.
    pub(super) due: Vec<Option<SlotId>>,
    /// Where execution goes on after the last jump of a program that was taken, if there are jumps.
    pub(super) jump: Option<SlotId>,
    /// Whether a computed index was ever out of range, if there are such.
    pub(super) fault: Option<SlotId>,
}
