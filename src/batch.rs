//! Batches: many independent plants of one program, scanned together.
//!
//! A plant is a process image of its own; all have one `now`. They run in **parts** of up to 512, a bit each
//! ([`engine::lanes`](crate::engine::lanes)), and the parts on all cores. Every plant computes exactly what it would
//! alone: where the lanes cannot do something for all of them at once (a time that goes back, a timer's start that is
//! set from outside), that part goes on with an interpreter for each plant, slower and as exact. Nothing here may do
//! I/O
//! or read a clock.
//!
//! ```
//! # use rung::{check, frontend, lower, opt, source::Source};
//! use rung::batch::Batch;
//! use rung::elementary::Value;
//!
//! # let source = Source::new("p.rung", "program p\ninput a\noutput q\nrung\n  a t:TON(PT := T#20ms) (q)\n");
//! # let checked = check::check(&frontend::parse(&source).program).0.unwrap();
//! # let program = opt::optimise(lower::lower(&checked, &source, None).unwrap());
//! let mut batch = Batch::new(&program, 1000)?;
//! let (a, q) = (batch.variable("a")?, batch.variable("q")?);
//! batch.set(7, a, Value::bool(true))?;
//! for scan in 0..4 {
//!     batch.scan(scan * 10_000_000);
//! }
//! assert!(batch.get(7, q)?.is_true() && !batch.get(8, q)?.is_true());
//! # Ok::<(), rung::batch::BatchError>(())
//! ```

mod error;
mod part;
mod random;

use std::collections::HashMap;
use std::sync::{Mutex, PoisonError};

pub use error::BatchError;
pub use part::Part;
pub use random::RandomInputs;

use crate::elementary::{Elementary, Value};
use crate::engine::interp::Interpreter;
use crate::engine::lanes::{LANES, Lanes, VECTOR_LANES};
use crate::logic::{Program, SlotId};
use crate::parallel;
use part::State;

/// Lanes of a word: those whose BOOLs are read and set at once.
pub const WORD_LANES: usize = VECTOR_LANES;

/// Bytes that all images together may have.
const MOST_BYTES: u64 = 1 << 36;

/// Instructions that a core should have to do for it to be worth waking it for one scan.
const WORTH_A_THREAD: usize = 1_000_000;

/// Words of a part.
const PART_WORDS: usize = LANES / WORD_LANES;

/// Many plants of one program.
#[derive(Debug)]
pub struct Batch {
    shared: Shared,
    parts: Vec<State>,
    lanes: usize,
}

/// What all parts have in common.
#[derive(Debug)]
struct Shared {
    program: Program,
    /// `None` where there is no code for this machine's vectors.
    lanes: Option<Lanes>,
    interpreter: Interpreter,
    names: HashMap<String, SlotId>,
}

/// A variable of a batch's program.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Variable {
    slot: SlotId,
    ty: Elementary,
}

impl Variable {
    /// Its type.
    pub fn ty(self) -> Elementary {
        self.ty
    }

    /// Where it is in the image.
    pub fn slot(self) -> SlotId {
        self.slot
    }
}

impl Batch {
    /// So many plants of a verified program, at least one, before their first scan: every variable holds its initial
    /// value.
    /// Optimised programs run faster. Where there is no code for this machine's vectors, plants are interpreted.
    ///
    /// # Errors
    /// [`BatchError::NoLanes`] for no plant at all, [`BatchError::TooLarge`] when their images come to more than 64
    /// GiB.
    pub fn new(program: &Program, lanes: usize) -> Result<Self, BatchError> {
        if lanes == 0 {
            return Err(BatchError::NoLanes);
        }
        let bytes = (lanes as u64).next_multiple_of(LANES as u64).saturating_mul(u64::from(program.layout.size()));
        if bytes > MOST_BYTES {
            return Err(BatchError::TooLarge { bytes });
        }
        let observed = program.layout.observed().iter();
        let mut names = HashMap::new();
        for observed in observed {
            names.entry(observed.name.as_str().to_lowercase()).or_insert(observed.slot);
        }
        let shared = Shared {
            program: program.clone(),
            lanes: Lanes::compile(program).ok(),
            interpreter: Interpreter::new(program),
            names,
        };
        let mut batch = Self { shared, parts: Vec::new(), lanes };
        batch.reset();
        Ok(batch)
    }

    /// How many plants there are. A plant, or lane, is named by its number, from 0.
    pub fn lanes(&self) -> usize {
        self.lanes
    }

    /// How many words hold a BOOL of all lanes: word k holds lanes 128 x k and on.
    pub fn words(&self) -> usize {
        self.lanes.div_ceil(WORD_LANES)
    }

    /// How many parts they run in.
    pub fn parts(&self) -> usize {
        self.parts.len()
    }

    /// The variable of a name, in any case: one that a trace shows, or an output of a block as `instance.member`.
    ///
    /// # Errors
    /// [`BatchError::NoSuchVariable`]
    pub fn variable(&self, name: &str) -> Result<Variable, BatchError> {
        let slot = self.shared.names.get(&name.to_lowercase());
        let slot = *slot.ok_or_else(|| BatchError::NoSuchVariable { name: name.to_owned() })?;
        Ok(Variable { slot, ty: self.shared.program.layout.slot(slot).ty })
    }

    /// The value of a variable in a lane.
    ///
    /// # Errors
    /// [`BatchError::NoSuchLane`]
    pub fn get(&self, lane: usize, variable: Variable) -> Result<Value, BatchError> {
        self.checked(lane)?;
        Ok(self.parts[lane / LANES].get(&self.shared, lane % LANES, variable.slot))
    }

    /// Sets a variable in a lane. What a rung writes lasts until that rung runs.
    ///
    /// # Errors
    /// [`BatchError::NoSuchLane`], or [`BatchError::WrongType`] for a value of another type.
    pub fn set(&mut self, lane: usize, variable: Variable, value: Value) -> Result<(), BatchError> {
        self.checked(lane)?;
        self.part(lane / LANES).set(lane % LANES, variable, value)
    }

    /// Sets a variable in all lanes.
    ///
    /// # Errors
    /// [`BatchError::WrongType`]
    pub fn set_all(&mut self, variable: Variable, value: Value) -> Result<(), BatchError> {
        (0..self.parts.len()).try_for_each(|part| self.part(part).set_all(variable, value))
    }

    /// A BOOL variable in the lanes of a word, the first lane as the lowest bit; of another type, whether it is other
    /// than
    /// 0. Bits beyond the last lane are 0.
    ///
    /// # Errors
    /// [`BatchError::NoSuchLane`] when there is no such word.
    pub fn word(&mut self, word: usize, variable: Variable) -> Result<u128, BatchError> {
        self.checked(word.saturating_mul(WORD_LANES))?;
        self.part(word / PART_WORDS).word(word % PART_WORDS, variable)
    }

    /// Sets a BOOL variable in the lanes of a word, the first lane by the lowest bit. Bits beyond the last lane do not
    /// count.
    ///
    /// # Errors
    /// [`BatchError::NoSuchLane`] when there is no such word, [`BatchError::WrongType`] when it is no BOOL.
    pub fn set_word(&mut self, word: usize, variable: Variable, bits: u128) -> Result<(), BatchError> {
        self.checked(word.saturating_mul(WORD_LANES))?;
        self.part(word / PART_WORDS).set_word(word % PART_WORDS, variable, bits)
    }

    /// Runs one scan in every lane, at a time in nanoseconds; on all cores where it is long enough to be worth it.
    pub fn scan(&mut self, now: i64) {
        let work = self.shared.program.instructions.len().saturating_mul(self.parts.len());
        if work / WORTH_A_THREAD < 2 {
            (0..self.parts.len()).for_each(|part| self.part(part).scan(now));
        } else {
            self.each(|mut part| part.scan(now));
        }
    }

    /// Does something with every part, on all cores, such as many scans with inputs before each: parts need not wait
    /// for one
    /// another. Gives the results in the order of the parts.
    pub fn each<R: Send>(&mut self, work: impl Fn(Part<'_>) -> R + Sync) -> Vec<R> {
        let (shared, lanes) = (&self.shared, self.lanes);
        let parts: Vec<Mutex<&mut State>> = self.parts.iter_mut().map(Mutex::new).collect();
        let run = |_: &mut (), index: usize| {
            // Each is locked once: this only hands it over.
            let mut state = parts[index].lock().unwrap_or_else(PoisonError::into_inner);
            work(Part::of(shared, &mut state, index, lanes))
        };
        parallel::each(parts.len(), || (), run)
    }

    /// The process image of a lane, as a scalar engine would leave it.
    ///
    /// # Errors
    /// [`BatchError::NoSuchLane`]
    pub fn image(&self, lane: usize) -> Result<Vec<u8>, BatchError> {
        self.checked(lane)?;
        Ok(self.parts[lane / LANES].image(&self.shared, lane % LANES))
    }

    /// Replaces the process image of a lane. Bytes between slots do not count.
    ///
    /// # Errors
    /// [`BatchError::NoSuchLane`], or [`BatchError::WrongSize`] when it is not as long as the program's.
    pub fn set_image(&mut self, lane: usize, image: &[u8]) -> Result<(), BatchError> {
        self.checked(lane)?;
        let size = self.shared.program.layout.size() as usize;
        if image.len() != size {
            return Err(BatchError::WrongSize { found: image.len(), size });
        }
        let (shared, state) = (&self.shared, &mut self.parts[lane / LANES]);
        for (id, slot) in (0..).map(SlotId).zip(shared.program.layout.slots()) {
            state.set(shared, lane % LANES, id, slot.read(image));
        }
        Ok(())
    }

    /// The lanes in which any of some variables has another value than in a given lane.
    ///
    /// # Errors
    /// [`BatchError::NoSuchLane`]
    pub fn differing(&mut self, from: usize, variables: &[Variable]) -> Result<Vec<usize>, BatchError> {
        let expected: Vec<Value> = variables.iter().map(|one| self.get(from, *one)).collect::<Result<_, _>>()?;
        let differs = |lane: &usize| {
            let mut pairs = variables.iter().zip(&expected);
            pairs.any(|(one, expected)| self.get(*lane, *one).is_ok_and(|found| found != *expected))
        };
        Ok((0..self.lanes).filter(differs).collect())
    }

    /// Starts all over: every variable of every lane holds its initial value, and no scan has been.
    pub fn reset(&mut self) {
        let of_part = |part: usize| (self.lanes - part * LANES).min(LANES);
        self.parts = (0..self.lanes.div_ceil(LANES)).map(|part| State::new(&self.shared, of_part(part))).collect();
    }

    /// One part.
    ///
    /// # Panics
    /// When there is no such part.
    pub fn part(&mut self, part: usize) -> Part<'_> {
        Part::of(&self.shared, &mut self.parts[part], part, self.lanes)
    }

    fn checked(&self, lane: usize) -> Result<(), BatchError> {
        if lane < self.lanes { Ok(()) } else { Err(BatchError::NoSuchLane { lane, lanes: self.lanes }) }
    }
}
