//! Reproducible chance: the same seed gives the same throws on every machine and with every version of `rand`.

use rand::Rng;
use rand_pcg::Pcg32;

/// A stream of random choices.
pub(crate) struct Dice(Pcg32);

impl Dice {
    /// The stream of a seed; streams of one seed that differ in `purpose` are independent.
    pub(crate) fn new(seed: u64, purpose: u64) -> Self {
        let mut generator = Pcg32::new(seed, purpose);
        generator.next_u32();
        Self(generator)
    }

    /// 0 to `count` - 1; 0 for a `count` of 0.
    pub(crate) fn below(&mut self, count: usize) -> usize {
        let throw = self.0.next_u32() as usize;
        if count == 0 { 0 } else { throw % count }
    }

    /// `least` to `most`, both included.
    pub(crate) fn between(&mut self, least: usize, most: usize) -> usize {
        least + self.below(most - least + 1)
    }

    /// Whether a thing happens that happens so many times in a hundred.
    pub(crate) fn percent(&mut self, percent: usize) -> bool {
        self.below(100) < percent
    }

    /// One of several.
    ///
    /// # Panics
    /// When there is none.
    pub(crate) fn pick<'a, T>(&mut self, from: &'a [T]) -> &'a T {
        &from[self.below(from.len())]
    }

    /// 64 random bits.
    pub(crate) fn bits(&mut self) -> u64 {
        self.0.next_u64()
    }
}
