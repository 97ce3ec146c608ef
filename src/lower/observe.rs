//! What can be watched of a program, and in which order: the columns of its traces.

use std::collections::HashMap;

use super::allocate::{first_at_address, indices};
use super::storage::{Frame, Storage};
use crate::check::{Checked, Type, VariableId};
use crate::logic::LayoutBuilder;

/// Makes slots watchable in the order of their names: an array element by element, of an instance the outputs.
pub(super) struct Observer<'a> {
    pub(super) checked: &'a Checked,
    pub(super) located: &'a HashMap<VariableId, Storage>,
    pub(super) layout: &'a mut LayoutBuilder,
}

impl Observer<'_> {
    /// A variable of a frame, or what it is in the element of an array of instances that has this number.
    pub(super) fn variable(&mut self, id: VariableId, frame: &Frame, element: u32, prefix: &str) {
        let variable = self.checked.variable(id);
        let located = || self.located.get(&first_at_address(self.checked, id));
        if let Some(storage) = frame.get(id).or_else(located) {
            self.part(variable.ty, storage, element, format!("{prefix}{}", variable.name));
        }
    }

    /// The element of each run in the storage that has this number.
    fn part(&mut self, ty: Type, storage: &Storage, element: u32, name: String) {
        match (ty, storage) {
            (_, Storage::Value(cells)) => self.layout.observe(name, cells.slot(element)),
            (Type::Array(array), Storage::Array(inner)) => {
                let array = self.checked.array(array);
                for (place, index) in (0..).zip(indices(array)) {
                    self.part(array.element, inner, element * array.count() + place, format!("{name}[{index}]"));
                }
            }
            (Type::Structure(structure), Storage::Structure(members)) => {
                for (field, member) in self.checked.structure(structure).fields.iter().zip(members) {
                    self.part(field.ty, member, element, format!("{name}.{}", field.name));
                }
            }
            (Type::Block(block), Storage::Block(cells)) => {
                for (pin, cells) in block.outputs().iter().zip(&cells.outputs) {
                    self.layout.observe(format!("{name}.{}", pin.name), cells.slot(element));
                }
            }
            (Type::Unit(unit), Storage::Unit(frame)) => {
                for output in &self.checked.unit(unit).outputs {
                    self.variable(*output, frame, element, &format!("{name}."));
                }
            }
            _ => unreachable!("storage is made for its type"),
        }
    }
}
