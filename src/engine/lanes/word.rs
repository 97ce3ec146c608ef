//! One bit for each of 128 lanes: what a BOOL is here.

use std::ops::{BitAnd, BitAndAssign, BitOr, BitOrAssign, BitXor, Not};

/// A bit for each lane: lane 0 is the lowest of the first half. Aligned as vector instructions want it.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
#[repr(C, align(16))]
pub(in crate::engine) struct Word([u64; 2]);

impl Word {
    /// FALSE in every lane.
    pub(super) const ZEROS: Self = Self([0; 2]);
    /// TRUE in every lane.
    pub(super) const ONES: Self = Self([u64::MAX; 2]);

    /// The same in every lane.
    pub(super) const fn all(value: bool) -> Self {
        if value { Self::ONES } else { Self::ZEROS }
    }

    /// Whether it is FALSE in every lane.
    #[inline]
    pub(super) fn is_zero(self) -> bool {
        self.0[0] | self.0[1] == 0
    }

    /// Whether a lane, below 128, is TRUE.
    #[inline]
    pub(super) fn get(self, lane: usize) -> bool {
        self.0[lane / 64] >> (lane % 64) & 1 != 0
    }

    /// Sets a lane, below 128.
    #[inline]
    pub(super) fn set(&mut self, lane: usize, value: bool) {
        let bit = 1 << (lane % 64);
        let half = &mut self.0[lane / 64];
        *half = *half & !bit | if value { bit } else { 0 };
    }

    /// The lanes that are TRUE, in order.
    pub(super) fn lanes(self) -> impl Iterator<Item = usize> {
        (0..super::LANES).filter(move |lane| self.get(*lane))
    }

    /// A byte for each lane, of which the lowest bit is set where it is TRUE, and no other.
    #[inline]
    pub(super) fn bytes(self) -> [u8; super::LANES] {
        let mut bytes = [0; super::LANES];
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
    pub(super) fn of_bytes(bytes: &[u8; super::LANES]) -> Self {
        let mut halves = [0; 2];
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

impl From<u128> for Word {
    fn from(bits: u128) -> Self {
        #[expect(clippy::cast_possible_truncation, reason = "the two halves")]
        Self([bits as u64, (bits >> 64) as u64])
    }
}

impl From<Word> for u128 {
    fn from(word: Word) -> Self {
        Self::from(word.0[0]) | Self::from(word.0[1]) << 64
    }
}

impl BitAnd for Word {
    type Output = Self;

    #[inline]
    fn bitand(self, other: Self) -> Self {
        Self([self.0[0] & other.0[0], self.0[1] & other.0[1]])
    }
}

impl BitOr for Word {
    type Output = Self;

    #[inline]
    fn bitor(self, other: Self) -> Self {
        Self([self.0[0] | other.0[0], self.0[1] | other.0[1]])
    }
}

impl BitXor for Word {
    type Output = Self;

    #[inline]
    fn bitxor(self, other: Self) -> Self {
        Self([self.0[0] ^ other.0[0], self.0[1] ^ other.0[1]])
    }
}

impl Not for Word {
    type Output = Self;

    #[inline]
    fn not(self) -> Self {
        Self([!self.0[0], !self.0[1]])
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
        for _ in 0..200 {
            bits = bits.rotate_left(7) ^ bits.wrapping_mul(0x2545_F491_4F6C_DD1D);
            let word = Word::from(bits);
            let bytes = word.bytes();
            let expected: Vec<u8> = (0..super::super::LANES).map(|lane| (bits >> lane & 1) as u8).collect();
            assert_eq!(bytes.as_slice(), expected);
            assert_eq!(Word::of_bytes(&bytes), word);
            assert_eq!(u128::from(word), bits);
        }
    }

    #[test]
    fn a_lane_is_set_alone() {
        for lane in [0, 1, 63, 64, 127] {
            let mut word = Word::ZEROS;
            word.set(lane, true);
            assert_eq!(u128::from(word), 1 << lane);
            assert_eq!(word.lanes().collect::<Vec<_>>(), [lane]);
            word.set(lane, false);
            assert!(word.is_zero());
        }
    }
}
