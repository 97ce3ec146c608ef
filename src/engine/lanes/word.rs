//! One bit for each lane of a group: what a BOOL is here.

use std::array::from_fn;
use std::ops::{BitAnd, BitAndAssign, BitOr, BitOrAssign, Not};

use super::LANES;

/// Vectors of 128 bits in a word, which code goes through one after the other. Four are a line of the cache, of which
/// so
/// nothing is fetched in vain, and code that is fetched once runs four times; more would not fit beside each other.
pub(in crate::engine) const VECTORS: usize = 4;

/// Lanes of a vector.
pub(super) const VECTOR_LANES: usize = 128;

const HALVES: usize = VECTORS * 2;

/// A bit for each lane: lane 0 is the lowest of the first 64.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
#[repr(C, align(64))]
pub(in crate::engine) struct Word([u64; HALVES]);

impl Word {
    /// FALSE in every lane.
    pub(super) const ZEROS: Self = Self([0; HALVES]);
    /// TRUE in every lane.
    pub(super) const ONES: Self = Self([u64::MAX; HALVES]);

    /// The same in every lane.
    pub(super) const fn all(value: bool) -> Self {
        if value { Self::ONES } else { Self::ZEROS }
    }

    /// Whether it is FALSE in every lane.
    #[inline]
    pub(super) fn is_zero(self) -> bool {
        self.0.into_iter().fold(0, |any, half| any | half) == 0
    }

    /// Whether a lane is TRUE.
    #[inline]
    pub(super) fn get(self, lane: usize) -> bool {
        self.0[lane / 64] >> (lane % 64) & 1 != 0
    }

    /// Sets a lane.
    #[inline]
    pub(super) fn set(&mut self, lane: usize, value: bool) {
        let bit = 1 << (lane % 64);
        let half = &mut self.0[lane / 64];
        *half = *half & !bit | if value { bit } else { 0 };
    }

    /// The lanes of a vector, the first as the lowest bit.
    pub(super) fn vector(self, vector: usize) -> u128 {
        u128::from(self.0[vector * 2]) | u128::from(self.0[vector * 2 + 1]) << 64
    }

    /// Sets the lanes of a vector, the first by the lowest bit.
    pub(super) fn set_vector(&mut self, vector: usize, bits: u128) {
        #[expect(clippy::cast_possible_truncation, reason = "the two halves")]
        {
            (self.0[vector * 2], self.0[vector * 2 + 1]) = (bits as u64, (bits >> 64) as u64);
        }
    }

    /// The lanes that are TRUE, in order.
    pub(super) fn lanes(self) -> impl Iterator<Item = usize> {
        (0..VECTORS).flat_map(move |vector| {
            let mut left = self.vector(vector);
            std::iter::from_fn(move || {
                let lane = left.trailing_zeros() as usize;
                (left != 0).then(|| {
                    left &= left - 1;
                    vector * VECTOR_LANES + lane
                })
            })
        })
    }

    /// A byte for each lane, of which the lowest bit is set where it is TRUE, and no other.
    #[inline]
    pub(super) fn bytes(self) -> [u8; LANES] {
        let mut bytes = [0; LANES];
        for (half, bytes) in self.0.iter().zip(bytes.as_chunks_mut::<64>().0) {
            for (eight, bytes) in half.to_le_bytes().into_iter().zip(bytes.as_chunks_mut::<8>().0) {
                // Each byte gets all eight bits and keeps its own, which then carries into the top bit, and no further.
                let own = u64::from(eight).wrapping_mul(0x0101_0101_0101_0101) & 0x8040_2010_0804_0201;
                *bytes = ((own + 0x7F7F_7F7F_7F7F_7F7F) >> 7 & 0x0101_0101_0101_0101).to_le_bytes();
            }
        }
        bytes
    }

    /// The lanes of which the byte, 0 or 1, is 1: the inverse of [`Word::bytes`].
    #[inline]
    pub(super) fn of_bytes(bytes: &[u8; LANES]) -> Self {
        let mut halves = [0; HALVES];
        for (half, bytes) in halves.iter_mut().zip(bytes.as_chunks::<64>().0) {
            for (index, eight) in bytes.as_chunks::<8>().0.iter().enumerate() {
                // The product has bit i of the top byte from byte i, and no two terms meet.
                let packed = u64::from_le_bytes(*eight).wrapping_mul(0x0102_0408_1020_4080) >> 56;
                *half |= packed << (8 * index);
            }
        }
        Self(halves)
    }
}

impl BitAnd for Word {
    type Output = Self;

    #[inline(always)]
    fn bitand(self, other: Self) -> Self {
        Self(from_fn(|half| self.0[half] & other.0[half]))
    }
}

impl BitOr for Word {
    type Output = Self;

    #[inline(always)]
    fn bitor(self, other: Self) -> Self {
        Self(from_fn(|half| self.0[half] | other.0[half]))
    }
}

impl Not for Word {
    type Output = Self;

    #[inline(always)]
    fn not(self) -> Self {
        Self(self.0.map(|half| !half))
    }
}

impl BitAndAssign for Word {
    #[inline]
    fn bitand_assign(&mut self, other: Self) {
        *self = *self & other;
    }
}

impl BitOrAssign for Word {
    #[inline]
    fn bitor_assign(&mut self, other: Self) {
        *self = *self | other;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bits_become_bytes_and_bytes_bits() {
        let mut bits = 0x9E37_79B9_7F4A_7C15_F39C_C060_5CED_C834_u128;
        let mut word = Word::ZEROS;
        for round in 0..200 {
            bits = bits.rotate_left(7) ^ bits.wrapping_mul(0x2545_F491_4F6C_DD1D);
            word.set_vector(round % VECTORS, bits);
            assert_eq!(word.vector(round % VECTORS), bits);
            let bytes = word.bytes();
            let expected: Vec<u8> = (0..LANES).map(|lane| u8::from(word.get(lane))).collect();
            assert_eq!(bytes.as_slice(), expected);
            assert_eq!(Word::of_bytes(&bytes), word);
            assert_eq!(word.lanes().count(), expected.iter().filter(|bit| **bit == 1).count());
        }
    }

    #[test]
    fn a_lane_is_set_alone() {
        for lane in [0, 1, 63, 64, 127, 128, LANES - 1] {
            let mut word = Word::ZEROS;
            word.set(lane, true);
            assert_eq!(word.lanes().collect::<Vec<_>>(), [lane]);
            word.set(lane, false);
            assert!(word.is_zero());
        }
    }
}
