//! Random inputs for many plants, from a seed: the same for a seed and a lane, however many lanes there are, whichever
//! others run and on whatever machine. So what happened in one lane can be run again alone.
//!
//! Each input has a pace of its own, the same in all lanes: it changes in one scan of 2, 8, 32 or 128, as some signals
//! flicker and others stay as long as a timer takes. A BOOL turns; another type gets a small number mostly, and
//! sometimes any. Every choice is made of bits of a PCG number, never by a distribution whose algorithm may change.

use std::collections::{HashMap, HashSet};

use rand::Rng;
use rand_pcg::Pcg64;

use super::{Part, WORD_LANES};
use crate::elementary::{Elementary, Value};
use crate::logic::{Area, Layout, SlotId};
use crate::simulate::{Setting, Stimuli};

/// Changes of inputs: a scan has one in so many, as a power of two.
const PACES: [u32; 4] = [1, 3, 5, 7];

/// The stream of random numbers from which the paces come. The streams of the words count from 0.
const PACE_STREAM: u128 = u128::MAX;

/// The inputs of the plants of a word, scan by scan.
#[derive(Clone, Debug)]
pub struct RandomInputs {
    inputs: Vec<Input>,
    generator: Pcg64,
}

#[derive(Clone, Debug)]
struct Input {
    slot: SlotId,
    ty: Elementary,
    pace: u32,
    /// What a BOOL is now, in each lane.
    bits: u128,
}

impl RandomInputs {
    /// The inputs of a word of a batch, before the first scan: all variables that are inputs, but for some.
    pub fn new(layout: &Layout, seed: u64, word: usize, except: &HashSet<SlotId>) -> Self {
        let mut paces = Pcg64::new(u128::from(seed), PACE_STREAM);
        let mut seen = HashSet::new();
        let observed = layout.observed().iter().map(|observed| observed.slot);
        let slots = observed.filter(|slot| layout.slot(*slot).area == Area::Input && seen.insert(*slot));
        let input = |slot: SlotId| {
            let (ty, initial) = (layout.slot(slot).ty, layout.slot(slot).initial);
            // Each has its pace before some are taken out, so that this does not depend on which.
            let pace = PACES[usize::from(paces.next_u64().to_le_bytes()[7] & 3)];
            Input { slot, ty, pace, bits: if initial.is_true() { u128::MAX } else { 0 } }
        };
        let inputs: Vec<Input> = slots.map(input).collect();
        let inputs = inputs.into_iter().filter(|input| !except.contains(&input.slot)).collect();
        Self { inputs, generator: Pcg64::new(u128::from(seed), word as u128) }
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.inputs.is_empty()
    }

    /// Changes the inputs for the next scan, in a word of a part that there is.
    pub fn apply(&mut self, part: &mut Part<'_>, word: usize) {
        self.next(|change| match change {
            Change::Bits(slot, bits) => part.set_bits(word, slot, bits),
            Change::Value(lane, setting) => part.put(word * WORD_LANES + lane, setting.slot, setting.value),
        });
    }

    /// What one lane gets in so many scans, `cycle` nanoseconds apart, as stimuli; together with others that all lanes
    /// get.
    pub fn stimuli_of(mut self, lane: usize, cycle: i64, scans: u64, others: &Stimuli) -> Stimuli {
        let fixed = others.rows().flat_map(|row| row.settings.iter().map(move |setting| (row.time, *setting)));
        let mut settings: Vec<(i64, Setting)> = fixed.collect();
        let mut last: HashMap<SlotId, bool> = HashMap::new();
        for scan in 0..scans {
            let now = i64::try_from(scan).unwrap_or(i64::MAX).saturating_mul(cycle);
            self.next(|change| match change {
                Change::Bits(slot, bits) => {
                    let bit = bits >> (lane % WORD_LANES) & 1 != 0;
                    let changes = last.insert(slot, bit) != Some(bit);
                    if changes {
                        settings.push((now, Setting { slot, value: Value::bool(bit) }));
                    }
                }
                Change::Value(of, setting) if of == lane % WORD_LANES => settings.push((now, setting)),
                Change::Value(..) => {}
            });
        }
        Stimuli::of(settings)
    }

    /// Tells what changes before the next scan.
    fn next(&mut self, mut change: impl FnMut(Change)) {
        let Self { inputs, generator } = self;
        for input in inputs {
            let mut lanes = u128::MAX;
            for _ in 0..input.pace {
                lanes &= u128::from(generator.next_u64()) | u128::from(generator.next_u64()) << 64;
            }
            if lanes == 0 {
                continue;
            }
            if input.ty == Elementary::Bool {
                input.bits ^= lanes;
                change(Change::Bits(input.slot, input.bits));
                continue;
            }
            while lanes != 0 {
                let lane = lanes.trailing_zeros() as usize;
                lanes &= lanes - 1;
                let value = value(generator, input.ty);
                change(Change::Value(lane, Setting { slot: input.slot, value }));
            }
        }
    }
}

enum Change {
    /// A BOOL in all lanes.
    Bits(SlotId, u128),
    /// Another in one.
    Value(usize, Setting),
}

/// A value of a type other than BOOL: one of a few small ones mostly.
fn value(generator: &mut Pcg64, ty: Elementary) -> Value {
    let [kind, small, ..] = generator.next_u64().to_le_bytes();
    let any = generator.next_u64();
    match (ty, kind % 16) {
        (Elementary::Time, 0) => Value::time((any >> 24).cast_signed()),
        (Elementary::Time, _) => Value::time(i64::from(small % 64) * 10_000_000),
        // No NaN and no infinity, which stay where they are computed with: those are for a table to give.
        (Elementary::Real | Elementary::Lreal, kind) => {
            let scale = [1.0, 1.0, 1.0, 1e6, 1e-6][usize::from(kind % 5)];
            let number = (f64::from(small) - 64.0) * 0.25 * scale;
            Value::real(ty, number).unwrap_or(Value::default_of(ty))
        }
        (_, 0) => Value::from_bits(ty, any),
        (_, 1 | 2) => Value::from_bits(ty, u64::from(small).wrapping_sub(128)),
        (_, 3..6) => Value::from_bits(ty, u64::from(small)),
        (_, _) => Value::from_bits(ty, u64::from(small % 12)),
    }
}
