//! Up to 128 plants of a batch, which one core runs.

use rung_runtime::Scan;

use super::{BatchError, LANES, Shared, Variable};
use crate::elementary::{Elementary, Value};
use crate::engine::interp::Interpreter;
use crate::engine::lanes::Group;
use crate::logic::SlotId;

/// What the plants of a part hold.
#[derive(Debug)]
pub(super) enum State {
    /// A bit each.
    Lanes(Box<Group>),
    /// Each on its own.
    Scalar { interpreter: Box<Interpreter>, images: Vec<Vec<u8>> },
}

impl State {
    pub(super) fn new(shared: &Shared) -> Self {
        match &shared.lanes {
            Some(lanes) => Self::Lanes(Box::new(lanes.group())),
            None => Self::scalar(shared, vec![shared.program.layout.initial_image(); LANES]),
        }
    }

    fn scalar(shared: &Shared, images: Vec<Vec<u8>>) -> Self {
        Self::Scalar { interpreter: Box::new(shared.interpreter.clone()), images }
    }

    /// Goes on with each plant on its own.
    fn separate(&mut self, shared: &Shared) -> (&mut Interpreter, &mut [Vec<u8>]) {
        if let Self::Lanes(_) = self {
            let images = (0..LANES).map(|lane| self.image(shared, lane)).collect();
            *self = Self::scalar(shared, images);
        }
        match self {
            Self::Scalar { interpreter, images } => (interpreter, images),
            Self::Lanes(_) => unreachable!("they were separated"),
        }
    }

    pub(super) fn get(&self, shared: &Shared, lane: usize, slot: SlotId) -> Value {
        match (self, &shared.lanes) {
            (Self::Lanes(group), Some(lanes)) => lanes.get(group, lane, slot),
            (Self::Scalar { images, .. }, _) => shared.program.layout.slot(slot).read(&images[lane]),
            (Self::Lanes(_), None) => unreachable!("a group is of compiled lanes"),
        }
    }

    pub(super) fn set(&mut self, shared: &Shared, lane: usize, slot: SlotId, value: Value) {
        if let (Self::Lanes(group), Some(lanes)) = (&mut *self, &shared.lanes)
            && lanes.set(group, lane, slot, value).is_ok()
        {
            return;
        }
        let (_, images) = self.separate(shared);
        shared.program.layout.slot(slot).write(&mut images[lane], value);
    }

    pub(super) fn image(&self, shared: &Shared, lane: usize) -> Vec<u8> {
        match self {
            Self::Scalar { images, .. } => images[lane].clone(),
            Self::Lanes(_) => {
                let layout = &shared.program.layout;
                let mut image = vec![0; layout.size() as usize];
                for (id, slot) in (0..).map(SlotId).zip(layout.slots()) {
                    slot.write(&mut image, self.get(shared, lane, id));
                }
                image
            }
        }
    }

    fn scan(&mut self, shared: &Shared, now: i64) {
        if let (Self::Lanes(group), Some(lanes)) = (&mut *self, &shared.lanes)
            && lanes.scan(group, now).is_ok()
        {
            return;
        }
        let (interpreter, images) = self.separate(shared);
        images.iter_mut().for_each(|image| interpreter.scan(image, now));
    }
}

/// A part of a batch, with lanes counted from its own first.
#[derive(Debug)]
pub struct Part<'b> {
    shared: &'b Shared,
    state: &'b mut State,
    index: usize,
    lanes: usize,
}

impl<'b> Part<'b> {
    pub(super) fn of(shared: &'b Shared, state: &'b mut State, index: usize, all: usize) -> Self {
        Self { shared, state, index, lanes: (all - index * LANES).min(LANES) }
    }

    /// Which part it is, from 0.
    pub fn index(&self) -> usize {
        self.index
    }

    /// The number of its first lane in the batch.
    pub fn first(&self) -> usize {
        self.index * LANES
    }

    /// How many lanes it has, 1 to 128.
    pub fn lanes(&self) -> usize {
        self.lanes
    }

    /// A bit for each of its lanes.
    pub fn all(&self) -> u128 {
        u128::MAX >> (LANES - self.lanes)
    }

    /// Whether its plants run a bit each still, and not each on its own.
    pub fn is_joined(&self) -> bool {
        matches!(self.state, State::Lanes(_))
    }

    /// The value of a variable in a lane.
    ///
    /// # Errors
    /// [`BatchError::NoSuchLane`]
    pub fn get(&self, lane: usize, variable: Variable) -> Result<Value, BatchError> {
        self.checked(lane)?;
        Ok(self.state.get(self.shared, lane, variable.slot))
    }

    /// Sets a variable in a lane.
    ///
    /// # Errors
    /// [`BatchError::NoSuchLane`], or [`BatchError::WrongType`] for a value of another type.
    pub fn set(&mut self, lane: usize, variable: Variable, value: Value) -> Result<(), BatchError> {
        self.checked(lane)?;
        fits(variable, value.ty())?;
        self.state.set(self.shared, lane, variable.slot, value);
        Ok(())
    }

    /// Sets a variable in all its lanes.
    ///
    /// # Errors
    /// [`BatchError::WrongType`]
    pub fn set_all(&mut self, variable: Variable, value: Value) -> Result<(), BatchError> {
        if value.ty() == Elementary::Bool {
            return self.set_word(variable, if value.is_true() { u128::MAX } else { 0 });
        }
        (0..self.lanes).try_for_each(|lane| self.set(lane, variable, value))
    }

    /// A BOOL variable in all its lanes, the first as the lowest bit; of another type, whether it is other than 0.
    pub fn word(&self, variable: Variable) -> u128 {
        let word = match (&*self.state, &self.shared.lanes) {
            (State::Lanes(group), Some(lanes)) => lanes.word(group, variable.slot),
            (State::Scalar { .. } | State::Lanes(_), _) => {
                let holds =
                    |lane| u128::from(self.state.get(self.shared, lane, variable.slot).is_true()) << lane;
                (0..self.lanes).map(holds).sum()
            }
        };
        word & self.all()
    }

    /// Sets a BOOL variable in all its lanes, the first by the lowest bit.
    ///
    /// # Errors
    /// [`BatchError::WrongType`] when the variable is no BOOL.
    pub fn set_word(&mut self, variable: Variable, bits: u128) -> Result<(), BatchError> {
        fits(variable, Elementary::Bool)?;
        self.set_bits(variable.slot, bits);
        Ok(())
    }

    /// Sets a slot that is a BOOL in all its lanes.
    pub(crate) fn set_bits(&mut self, slot: SlotId, bits: u128) {
        match (&mut *self.state, &self.shared.lanes) {
            (State::Lanes(group), Some(lanes)) => lanes.set_word(group, slot, bits),
            (State::Scalar { .. } | State::Lanes(_), _) => {
                (0..self.lanes).for_each(|lane| self.put(lane, slot, Value::bool(bits >> lane & 1 != 0)));
            }
        }
    }

    /// Sets a slot in a lane, of which there may be fewer.
    pub(crate) fn put(&mut self, lane: usize, slot: SlotId, value: Value) {
        if lane < self.lanes {
            self.state.set(self.shared, lane, slot, value);
        }
    }

    /// The variable in a slot.
    pub(crate) fn variable(&self, slot: SlotId) -> Variable {
        Variable { slot, ty: self.shared.program.layout.slot(slot).ty }
    }

    /// Runs one scan in all its lanes, at a time in nanoseconds.
    pub fn scan(&mut self, now: i64) {
        self.state.scan(self.shared, now);
    }

    fn checked(&self, lane: usize) -> Result<(), BatchError> {
        if lane < self.lanes { Ok(()) } else { Err(BatchError::NoSuchLane { lane, lanes: self.lanes }) }
    }
}

fn fits(variable: Variable, found: Elementary) -> Result<(), BatchError> {
    let expected = variable.ty;
    if expected == found { Ok(()) } else { Err(BatchError::WrongType { expected, found }) }
}
