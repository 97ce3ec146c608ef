//! Where a place is: the way into a variable, with indices that are computed.

use rung::check::{Index, Place, Step, Type};
use rung::elementary::{Elementary, Value};

use super::Oracle;
use super::expression::number;
use super::storage::{Frame, Register, Storage};

/// What is done with an expression or a place.
pub(super) struct Attempt {
    /// Whether it has power; else what is computed has no effect.
    pub(super) executed: bool,
    /// Whether an index was out of range.
    pub(super) failed: bool,
}

impl Attempt {
    pub(super) fn new(executed: bool) -> Self {
        Self { executed, failed: false }
    }
}

impl Oracle<'_> {
    /// The storage of a place.
    pub(super) fn locate(&mut self, frame: &Frame, place: &Place, attempt: &mut Attempt) -> Storage {
        let mut storage = self.whole(frame, place);
        for (depth, step) in place.path.iter().enumerate() {
            storage = match step {
                Step::Field(field) => storage.part(*field),
                Step::Pin(pin) => storage.pin(*pin),
                Step::Variable(id) => storage.variable_of(*id),
                Step::Element(indices) => match self.element_at(frame, place, depth, indices, attempt) {
                    Some(element) => storage.part(element),
                    None => Storage::Nowhere,
                },
            };
        }
        match (place.bit, storage) {
            (None, storage) => storage,
            (Some(bit), Storage::Value(register)) => Storage::Bit(register, bit),
            (Some(_), Storage::Nowhere) => Storage::Nowhere,
            (Some(bit), storage) => panic!("{storage:?} has no bit {bit}"),
        }
    }

    /// The values from a place on to the end of the array that it is an element of; of what is no element itself.
    pub(super) fn behind(&mut self, frame: &Frame, place: &Place, attempt: &mut Attempt) -> Vec<Register> {
        let Some((Step::Element(indices), path)) = place.path.split_last() else {
            return self.locate(frame, place, attempt).values();
        };
        let array = Place { variable: place.variable, path: path.into(), bit: None };
        let storage = self.locate(frame, &array, attempt);
        match (storage, self.element_at(frame, place, path.len(), indices, attempt)) {
            (Storage::Parts(elements), Some(first)) => elements[first..].iter().flat_map(Storage::values).collect(),
            _ => Vec::new(),
        }
    }

    fn whole(&self, frame: &Frame, place: &Place) -> Storage {
        let own = frame.get(place.variable).or_else(|| self.globals.get(place.variable));
        // What another program declares at an address is there for all.
        let own = own.or_else(|| self.located.get(&place.variable));
        own.unwrap_or_else(|| panic!("{} is no variable of this unit", self.checked.variable(place.variable).name))
            .clone()
    }

    /// The place of an element among all of its array, which is what the path leads to at that depth.
    fn element_at(
        &mut self,
        frame: &Frame,
        place: &Place,
        depth: usize,
        indices: &[Index],
        attempt: &mut Attempt,
    ) -> Option<usize> {
        let array = Place { variable: place.variable, path: place.path[..depth].into(), bit: None };
        let Type::Array(array) = self.checked.type_of(&array) else { panic!("{array:?} is no array") };
        let dimensions = &self.checked.array(array).dimensions;
        let mut element = Some(0);
        for (index, dimension) in indices.iter().zip(dimensions) {
            let offset = match index {
                Index::Constant(offset) => i128::from(*offset),
                Index::Computed(expression) => {
                    let offset = number(self.value(frame, expression, attempt)) - i128::from(dimension.first);
                    self.activities.saw(
                        frame.id,
                        expression.as_ref(),
                        "index a[i]",
                        vec![Value::bool(offset & 1 == 1)],
                    );
                    offset
                }
            };
            let inside = (0..i128::from(dimension.count)).contains(&offset);
            if inside {
                let offset = usize::try_from(offset).expect("it is below the count");
                element = element.map(|element| element * dimension.count as usize + offset);
            } else {
                element = None;
            }
        }
        if element.is_none() {
            self.fails(attempt);
            self.activities.executed(frame.id, indices, "index out of range");
        }
        element
    }

    /// An index was out of range.
    fn fails(&mut self, attempt: &mut Attempt) {
        attempt.failed = true;
        self.fault |= attempt.executed && !self.muted;
    }

    /// What a place holds now.
    pub(super) fn read(&mut self, frame: &Frame, place: &Place, attempt: &mut Attempt) -> Value {
        let ty = match (place.bit, self.checked.type_of(place)) {
            (Some(_), _) => Elementary::Bool,
            (None, Type::Elementary(ty)) => ty,
            (None, ty) => panic!("{ty:?} has no value"),
        };
        self.locate(frame, place, attempt).read(ty)
    }
}
