//! Elements of runs: one that is known, or one that an index picks while the program runs.
//!
//! An index that picks nothing must read as the type's default and write nothing, whatever else is computed from it.

use super::storage::Cells;
use crate::elementary::{Elementary, Value};
use crate::logic::{Binary, Builder, ValueId};

/// Which element of each run, counted from 0 over all arrays around it.
#[derive(Clone, Copy)]
pub(super) enum Pick {
    /// One that is there.
    Constant(u32),
    /// One that is known while the program runs.
    Computed {
        /// A LINT.
        number: ValueId,
        /// Whether all indices are in range; else the number means nothing.
        valid: ValueId,
    },
}

impl Pick {
    /// The element with this number inside an array of `count` elements, which this element is.
    pub(super) fn inside(self, logic: &mut Builder, count: u32, number: u32) -> Self {
        match self {
            Self::Constant(outer) => Self::Constant(outer * count + number),
            Self::Computed { number: outer, valid } => {
                let (count, inner) = (lint(logic, count), lint(logic, number));
                let start = logic.binary(Binary::Multiply, outer, count);
                Self::Computed { number: logic.binary(Binary::Add, start, inner), valid }
            }
        }
    }

    /// The same with an inner number that is computed, too.
    pub(super) fn inside_computed(self, logic: &mut Builder, count: u32, number: ValueId, valid: ValueId) -> Self {
        let (outer, valid) = match self {
            Self::Constant(outer) => (lint(logic, outer), valid),
            Self::Computed { number: outer, valid: outer_valid } => (outer, logic.and(outer_valid, valid)),
        };
        let count = lint(logic, count);
        let start = logic.binary(Binary::Multiply, outer, count);
        Self::Computed { number: logic.binary(Binary::Add, start, number), valid }
    }
}

/// A value's place: an element of a run.
#[derive(Clone, Copy)]
pub(super) struct Cell {
    /// The run.
    pub(super) cells: Cells,
    /// Which of it.
    pub(super) pick: Pick,
}

impl Cell {
    /// What it holds.
    pub(super) fn load(self, logic: &mut Builder) -> ValueId {
        match (self.pick, self.cells.array) {
            (Pick::Constant(element), _) => logic.load(self.cells.slot(element)),
            (Pick::Computed { number, valid }, Some(array)) => {
                let index = or_none(logic, valid, number);
                logic.load_indexed(array, index)
            }
            (Pick::Computed { .. }, None) => unreachable!("only arrays have indices"),
        }
    }

    /// Sets it while a condition, if there is one, is TRUE.
    pub(super) fn store(self, logic: &mut Builder, condition: Option<ValueId>, value: ValueId) {
        match (self.pick, self.cells.array) {
            (Pick::Constant(element), _) => logic.store_if(condition, self.cells.slot(element), value),
            (Pick::Computed { number, valid }, Some(array)) => {
                let valid = condition.map_or(valid, |condition| logic.and(condition, valid));
                let index = or_none(logic, valid, number);
                logic.store_indexed(array, index, value);
            }
            (Pick::Computed { .. }, None) => unreachable!("only arrays have indices"),
        }
    }

    /// The element so many places behind in the same run; outside the run, one that is not there.
    pub(super) fn behind(self, logic: &mut Builder, places: u32) -> Self {
        let pick = match self.pick {
            pick if places == 0 => pick,
            Pick::Constant(element) => match element.checked_add(places).filter(|last| *last < self.cells.count) {
                Some(last) => Pick::Constant(last),
                None => Pick::Computed { number: lint(logic, 0), valid: logic.bool(false) },
            },
            Pick::Computed { number, valid } => {
                let places = lint(logic, places);
                Pick::Computed { number: logic.binary(Binary::Add, number, places), valid }
            }
        };
        Self { pick, ..self }
    }
}

/// The number, or while it is not valid one that no array has.
fn or_none(logic: &mut Builder, valid: ValueId, number: ValueId) -> ValueId {
    let none = logic.constant(Value::from_bits(Elementary::Lint, u64::MAX));
    logic.select(valid, number, none)
}

/// A number as a LINT.
pub(super) fn lint(logic: &mut Builder, number: u32) -> ValueId {
    logic.constant(Value::from_bits(Elementary::Lint, u64::from(number)))
}
