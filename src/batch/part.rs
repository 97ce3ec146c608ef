//! Up to 512 plants of a batch, which one core runs.

use rung_runtime::Scan;

use super::{BatchError, LANES, Shared, Variable, WORD_LANES};
use crate::elementary::{Elementary, Value};
use crate::engine::interp::Interpreter;
use crate::engine::lanes::Group;
use crate::logic::SlotId;

/// What the plants of a part hold.
#[derive(Debug)]
pub(super) enum State {
    /// A bit each.
    Lanes { group: Box<Group>, lanes: usize },
    /// Each on its own.
    Scalar { interpreter: Box<Interpreter>, images: Vec<Vec<u8>> },
}

impl State {
    /// So many plants before their first scan.
    pub(super) fn new(shared: &Shared, lanes: usize) -> Self {
        match &shared.lanes {
            Some(compiled) => Self::Lanes { group: Box::new(compiled.group(lanes)), lanes },
            None => Self::scalar(shared, vec![shared.program.layout.initial_image(); lanes]),
        }
    }

    fn scalar(shared: &Shared, images: Vec<Vec<u8>>) -> Self {
        Self::Scalar { interpreter: Box::new(shared.interpreter.clone()), images }
    }

    /// Goes on with each plant on its own.
    fn separate(&mut self, shared: &Shared) -> (&mut Interpreter, &mut [Vec<u8>]) {
        if let Self::Lanes { lanes, .. } = *self {
            let images = (0..lanes).map(|lane| self.image(shared, lane)).collect();
            *self = Self::scalar(shared, images);
        }
        match self {
            Self::Scalar { interpreter, images } => (interpreter, images),
            Self::Lanes { .. } => unreachable!("they were separated"),
        }
    }

    pub(super) fn get(&self, shared: &Shared, lane: usize, slot: SlotId) -> Value {
        match (self, &shared.lanes) {
            (Self::Lanes { group, .. }, Some(lanes)) => lanes.get(group, lane, slot),
            (Self::Scalar { images, .. }, _) => shared.program.layout.slot(slot).read(&images[lane]),
            (Self::Lanes { .. }, None) => unreachable!("a group is of compiled lanes"),
        }
    }

    pub(super) fn set(&mut self, shared: &Shared, lane: usize, slot: SlotId, value: Value) {
        if let (Self::Lanes { group, .. }, Some(lanes)) = (&mut *self, &shared.lanes)
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
            Self::Lanes { .. } => {
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
        if let (Self::Lanes { group, .. }, Some(lanes)) = (&mut *self, &shared.lanes)
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

    /// How many lanes it has, 1 to 512.
    pub fn lanes(&self) -> usize {
        self.lanes
    }

    /// How many words hold a BOOL of its lanes: word k holds the 128 lanes from 128 x k on.
    pub fn words(&self) -> usize {
        self.lanes.div_ceil(WORD_LANES)
    }

    /// A bit for each lane that a word has; none for a word that there is not.
    pub fn all(&self, word: usize) -> u128 {
        let lanes = self.lanes.saturating_sub(word.saturating_mul(WORD_LANES)).min(WORD_LANES);
        if lanes == 0 { 0 } else { u128::MAX >> (WORD_LANES - lanes) }
    }

    /// Whether its plants run a bit each still, and not each on its own.
    pub fn is_joined(&self) -> bool {
        matches!(self.state, State::Lanes { .. })
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
            let bits = if value.is_true() { u128::MAX } else { 0 };
            return (0..self.words()).try_for_each(|word| self.set_word(word, variable, bits));
        }
        (0..self.lanes).try_for_each(|lane| self.set(lane, variable, value))
    }

    /// A BOOL variable in the lanes of a word, the first as the lowest bit; of another type, whether it is other than
    /// 0.
    ///
    /// # Errors
    /// [`BatchError::NoSuchLane`] when there is no such word.
    pub fn word(&self, word: usize, variable: Variable) -> Result<u128, BatchError> {
        self.checked(word.saturating_mul(WORD_LANES))?;
        let all = self.all(word);
        Ok(match (&*self.state, &self.shared.lanes) {
            (State::Lanes { group, .. }, Some(lanes)) => all & lanes.word(group, variable.slot, word),
            (State::Scalar { .. } | State::Lanes { .. }, _) => {
                let value = |lane| self.state.get(self.shared, word * WORD_LANES + lane, variable.slot);
                let lanes = all.count_ones() as usize;
                (0..lanes).map(|lane| u128::from(value(lane).is_true()) << lane).sum()
            }
        })
    }

    /// Sets a BOOL variable in the lanes of a word, the first by the lowest bit.
    ///
    /// # Errors
    /// [`BatchError::NoSuchLane`] when there is no such word, [`BatchError::WrongType`] when the variable is no BOOL.
    pub fn set_word(&mut self, word: usize, variable: Variable, bits: u128) -> Result<(), BatchError> {
        self.checked(word.saturating_mul(WORD_LANES))?;
        fits(variable, Elementary::Bool)?;
        self.set_bits(word, variable.slot, bits);
        Ok(())
    }

    /// Sets a slot that is a BOOL in the lanes of a word that there is.
    pub(crate) fn set_bits(&mut self, word: usize, slot: SlotId, bits: u128) {
        match (&mut *self.state, &self.shared.lanes) {
            (State::Lanes { group, .. }, Some(lanes)) => lanes.set_word(group, slot, word, bits),
            (State::Scalar { .. } | State::Lanes { .. }, _) => {
                for lane in 0..WORD_LANES {
                    self.put(word * WORD_LANES + lane, slot, Value::bool(bits >> lane & 1 != 0));
                }
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
