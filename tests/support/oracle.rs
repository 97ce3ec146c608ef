//! The independent evaluator: what a checked program computes, told a second time.
//!
//! It walks [`Checked`] directly, scan by scan, and is written from the semantics alone: ladder elements as they
//! are drawn, timers as machines with three states, no primitive operation anywhere. It must share no code with
//! `lower`, `logic` or the engines, for it is what they are tested against. It is slow, and may be.

mod analog;
mod block;
mod expression;
mod function;
#[cfg(test)]
mod tests;
mod walk;

use std::collections::HashMap;

use rung::check::{Checked, Element, PinId, Place, Type, VariableId};
use rung::elementary::Value;
use rung::ladder::key;

pub(crate) use block::Instance;

/// How often the power on the right of one element changed; or for a block any of its BOOL outputs, or any output if
/// it has no BOOL.
#[derive(Clone, Debug)]
pub(crate) struct Activity {
    /// What the element is, as a coverage table names it.
    pub kind: String,
    /// How often it changed from one scan to the next.
    pub toggles: u64,
    last: Vec<Value>,
}

/// A program that is being evaluated.
pub(crate) struct Oracle<'a> {
    checked: &'a Checked,
    /// The value of each variable that has its own storage; of others and of instances it is not used.
    values: Vec<Value>,
    /// The block of each variable that is an instance.
    instances: Vec<Option<Instance>>,
    /// What each contact and coil that sees edges remembers, once a scan came to it. An element is known by where it
    /// lies in the program, which is not moved meanwhile.
    memories: HashMap<*const Element, bool>,
    /// One for each element that a scan came to, in the order of the first times.
    activities: Vec<Activity>,
    places_of_activities: HashMap<*const Element, usize>,
    names: Vec<String>,
    places: HashMap<String, Place>,
}

impl<'a> Oracle<'a> {
    /// A program before its first scan.
    pub(crate) fn new(checked: &'a Checked) -> Self {
        let mut oracle = Self {
            checked,
            values: checked.variables().iter().map(|variable| variable.initial).collect(),
            instances: Vec::new(),
            memories: HashMap::new(),
            activities: Vec::new(),
            places_of_activities: HashMap::new(),
            names: Vec::new(),
            places: HashMap::new(),
        };
        for (index, variable) in checked.variables().iter().enumerate() {
            let id = VariableId(u32::try_from(index).expect("a program of the tests is small"));
            let place = |pin| Place { variable: id, pin, bit: None };
            match variable.ty {
                Type::Elementary(_) => {
                    oracle.instances.push(None);
                    oracle.name(variable.name.clone(), place(None));
                }
                Type::Block(block) => {
                    oracle.instances.push(Some(Instance::new(block)));
                    for (output, pin) in block.outputs().iter().enumerate() {
                        oracle.name(format!("{}.{}", variable.name, pin.name), place(Some(PinId::Output(output))));
                    }
                }
            }
        }
        oracle
    }

    fn name(&mut self, name: String, place: Place) {
        self.places.insert(key(&name), place);
        self.names.push(name);
    }

    /// Everything that can be observed: each variable, and for an instance each of its outputs, in declaration order.
    pub(crate) fn names(&self) -> &[String] {
        &self.names
    }

    /// The value of a name out of [`Oracle::names`], in any case.
    ///
    /// # Panics
    /// When there is no such name.
    pub(crate) fn get(&self, name: &str) -> Value {
        self.read(self.place(name))
    }

    /// Gives a name a value, as a copy-in does.
    ///
    /// # Panics
    /// When there is no such name.
    pub(crate) fn set(&mut self, name: &str, value: Value) {
        self.write(self.place(name), value);
    }

    /// How often each element changed so far, in the order in which scans first came to them.
    pub(crate) fn activities(&self) -> &[Activity] {
        &self.activities
    }

    fn place(&self, name: &str) -> Place {
        *self.places.get(&key(name)).unwrap_or_else(|| panic!("no variable is named {name}"))
    }

    /// The variable whose storage a variable uses: that of the first at its address.
    fn storage(&self, id: VariableId) -> VariableId {
        self.checked.variable(id).shares.map_or(id, |earlier| self.storage(earlier))
    }

    fn instance(&mut self, id: VariableId) -> &mut Instance {
        self.instances[id.index()].as_mut().expect("checking lets only instances be called")
    }

    fn read(&self, place: Place) -> Value {
        let whole = match (place.pin, self.checked.variable(place.variable).ty) {
            (Some(pin), _) => {
                let instance = self.instances[place.variable.index()].as_ref().expect("only instances have pins");
                match pin {
                    PinId::Input(input) => instance.inputs[input],
                    PinId::Output(output) => instance.outputs[output],
                }
            }
            (None, Type::Elementary(ty)) => {
                // Two types at one address are two views of the same bits.
                Value::from_bits(ty, self.values[self.storage(place.variable).index()].bits())
            }
            (None, Type::Block(block)) => panic!("an instance of {} has no value", block.name()),
        };
        match place.bit {
            None => whole,
            Some(bit) => Value::bool(whole.bits() >> bit & 1 == 1),
        }
    }

    fn write(&mut self, place: Place, value: Value) {
        let whole = Place { bit: None, ..place };
        let value = match place.bit {
            None => value,
            Some(bit) => {
                let old = self.read(whole);
                let others = old.bits() & !(1 << bit);
                Value::from_bits(old.ty(), others | u64::from(value.is_true()) << bit)
            }
        };
        match place.pin {
            None => {
                let storage = self.storage(place.variable);
                let kept = &mut self.values[storage.index()];
                *kept = Value::from_bits(kept.ty(), value.bits());
            }
            Some(PinId::Input(input)) => self.instance(place.variable).inputs[input] = value,
            Some(PinId::Output(output)) => self.instance(place.variable).outputs[output] = value,
        }
    }
}
