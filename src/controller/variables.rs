//! The variables of a controller: what can be read and written, found by name.

use std::collections::HashMap;

use super::Error;
use crate::check::spelling::{Budget, nearest};
use crate::elementary::{Elementary, Value};
use crate::logic::image::Observed;
use crate::logic::{Area, Layout, Slot, SlotId};

/// A variable, or an output of a block: what a name stands for.
#[derive(Clone, Copy, Debug)]
pub struct Variable<'a> {
    observed: &'a Observed,
    slot: &'a Slot,
}

impl<'a> Variable<'a> {
    fn new(layout: &'a Layout, observed: &'a Observed) -> Self {
        Self { observed, slot: layout.slot(observed.slot) }
    }

    /// Its name, as the program spells it.
    pub fn name(self) -> &'a str {
        &self.observed.name
    }

    /// Its type.
    pub fn ty(self) -> Elementary {
        self.slot.ty
    }

    /// Whether it is an input, an output, a variable, or what a block holds.
    pub fn area(self) -> Area {
        self.slot.area
    }

    /// Whether it is kept while the power is off.
    pub fn is_retained(self) -> bool {
        self.slot.retain
    }

    /// What it holds before the first scan.
    pub fn initial(self) -> Value {
        self.slot.initial
    }

    /// The line of the source that declares it, from 1; 0 where there is none.
    pub fn line(self) -> u32 {
        self.slot.line
    }

    /// Where it lies in the image, in bytes from its start.
    pub fn offset(self) -> u32 {
        self.slot.offset
    }

    pub(super) fn id(self) -> SlotId {
        self.observed.slot
    }

    pub(super) fn slot(self) -> &'a Slot {
        self.slot
    }
}

/// Every variable of a layout, in order of declaration.
pub(super) fn all(layout: &Layout) -> impl Iterator<Item = Variable<'_>> {
    layout.observed().iter().map(|observed| Variable::new(layout, observed))
}

/// Where each name is among what a layout observes: as it is spelled, so that finding that allocates nothing, and in
/// lower case.
#[derive(Debug)]
pub(super) struct Names(HashMap<Box<str>, usize>);

impl Names {
    pub(super) fn new(layout: &Layout) -> Self {
        let mut places = HashMap::new();
        for (place, observed) in layout.observed().iter().enumerate() {
            for name in [observed.name.as_str().into(), observed.name.as_str().to_lowercase().into()] {
                places.entry(name).or_insert(place);
            }
        }
        Self(places)
    }

    /// The variable of that name, in any case.
    pub(super) fn find<'l>(&self, layout: &'l Layout, name: &str) -> Result<Variable<'l>, Error> {
        let place = self.0.get(name).or_else(|| self.0.get(name.to_lowercase().as_str()));
        match place.and_then(|place| layout.observed().get(*place)) {
            Some(observed) => Ok(Variable::new(layout, observed)),
            None => {
                let names = layout.observed().iter().map(|observed| observed.name.as_str());
                let nearest = nearest(name, names, &mut Budget::default()).map(str::to_owned);
                Err(Error::NoVariable { name: name.to_owned(), nearest })
            }
        }
    }
}
