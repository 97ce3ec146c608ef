//! Arrays and structures as a whole: copied, and set to what they start with.
//!
//! Where a whole run is meant it is one copy of an array; where only a part of it is, it goes element by element.

use super::Lowering;
use super::cell::{Cell, Pick};
use super::place::{Node, Part};
use super::storage::{Cells, Storage};
use crate::check::Type;
use crate::logic::ValueId;

impl<'a> Lowering<'a> {
    /// Copies all values of an array or structure to another of its type.
    pub(super) fn copy(&mut self, target: Part<'a>, source: Part<'a>, condition: Option<ValueId>) {
        let condition = self.reaching(target.home, condition);
        for ((to, count), (from, _)) in self.leaves(target).into_iter().zip(self.leaves(source)) {
            let whole = |cells: Cells, pick| matches!(pick, Pick::Constant(_)) && cells.count == count;
            let whole = whole(to, target.pick) && whole(from, source.pick);
            match (to.array, from.array) {
                (Some(to), Some(from)) if whole => self.logic.copy_array(to, from, condition),
                _ => {
                    for number in 0..count {
                        let pick = source.pick.inside(&mut self.logic, count, number);
                        let value = Cell { cells: from, pick }.load(&mut self.logic);
                        let pick = target.pick.inside(&mut self.logic, count, number);
                        Cell { cells: to, pick }.store(&mut self.logic, condition, value);
                    }
                }
            }
            self.forget(to);
        }
    }

    /// Sets all values of a variable to what they start with.
    pub(super) fn initialise(&mut self, part: Part<'a>) {
        let condition = self.reaching(part.home, None);
        for (cells, count) in self.leaves(part) {
            for number in 0..count {
                let pick = part.pick.inside(&mut self.logic, count, number);
                // A computed one is of an array of instances, which all start alike.
                let slot = if let Pick::Constant(element) = pick { cells.slot(element) } else { cells.slot(number) };
                let initial = self.logic.layout().slot(slot).initial;
                let value = self.logic.constant(initial);
                Cell { cells, pick }.store(&mut self.logic, condition, value);
            }
        }
    }

    /// The runs of all values in a part, each with the number of elements that are the part's.
    fn leaves(&self, part: Part<'a>) -> Vec<(Cells, u32)> {
        let mut leaves = Vec::new();
        match part.node {
            Node::Pin(cells) => leaves.push((cells, 1)),
            Node::Storage(storage) => self.add_leaves(part.ty, storage, 1, &mut leaves),
        }
        leaves
    }

    fn add_leaves(&self, ty: Type, storage: &Storage, count: u32, leaves: &mut Vec<(Cells, u32)>) {
        match (ty, storage) {
            (_, Storage::Value(cells)) => leaves.push((*cells, count)),
            (Type::Array(array), Storage::Array(elements)) => {
                let array = self.checked.array(array);
                self.add_leaves(array.element, elements, count * array.count(), leaves);
            }
            (Type::Structure(structure), Storage::Structure(members)) => {
                for (field, member) in self.checked.structure(structure).fields.iter().zip(members) {
                    self.add_leaves(field.ty, member, count, leaves);
                }
            }
            // An instance is no value.
            _ => {}
        }
    }
}
