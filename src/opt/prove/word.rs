//! Arithmetic on words of literals, the lowest bit first.
//!
//! Written so that what the narrow and the wide form of a computation have in common is one node: sums and differences
//! start at the lowest bit, and comparisons, products and quotients take words without the bits that only repeat the sign.

use super::graph::{Graph, Literal};

/// A value's bits, the lowest first.
pub(super) type Word = Vec<Literal>;

/// The low bits of a number.
pub(super) fn constant(bits: u64, width: usize) -> Word {
    (0..width).map(|bit| Literal::constant(bit < 64 && bits >> bit & 1 != 0)).collect()
}

/// The number that a word of at most 64 bits is, if all its bits are known.
pub(super) fn as_constant(word: &[Literal]) -> Option<u64> {
    word.iter().enumerate().try_fold(0, |bits, (bit, literal)| Some(bits | u64::from(literal.as_constant()?) << bit))
}

/// A word with more bits or fewer; the new ones are the highest old one if it is signed, else FALSE.
pub(super) fn extended(word: &[Literal], signed: bool, width: usize) -> Word {
    let above = word.last().copied().filter(|_| signed).unwrap_or(Literal::FALSE);
    word.iter().copied().chain(std::iter::repeat(above)).take(width).collect()
}

/// A number as the shortest signed word.
pub(super) fn signed(word: &[Literal], is_signed: bool) -> Word {
    let mut word = word.to_vec();
    if !is_signed {
        word.push(Literal::FALSE);
    }
    while word.len() > 1 && word[word.len() - 1] == word[word.len() - 2] {
        word.pop();
    }
    word
}

/// A factor of a product of which no more bits are wanted than it has, as the shortest signed word: whether a factor has a
/// sign does not count then, and it is taken to have one where that makes it shorter.
pub(super) fn factor(word: &[Literal], is_signed: bool) -> Word {
    let with_sign = signed(word, true);
    if is_signed || with_sign.len() < word.len() { with_sign } else { signed(word, false) }
}

/// A number as the shortest word without a sign.
pub(super) fn unsigned(word: &[Literal]) -> Word {
    let length = word.iter().rposition(|literal| *literal != Literal::FALSE).map_or(0, |last| last + 1);
    word[..length].to_vec()
}

impl Graph {
    pub(super) fn each(
        &mut self,
        a: &[Literal],
        b: &[Literal],
        op: fn(&mut Self, Literal, Literal) -> Literal,
    ) -> Word {
        a.iter().zip(b).map(|(a, b)| op(self, *a, *b)).collect()
    }

    pub(super) fn select_word(&mut self, condition: Literal, a: &[Literal], b: &[Literal]) -> Word {
        a.iter().zip(b).map(|(a, b)| self.select(condition, *a, *b)).collect()
    }

    /// `a + b + carry`, as wide as they are.
    fn sum(&mut self, a: &[Literal], b: &[Literal], mut carry: Literal) -> Word {
        let mut sum = Word::with_capacity(a.len());
        for (a, b) in a.iter().zip(b) {
            let either = self.xor(*a, *b);
            sum.push(self.xor(either, carry));
            let (both, passed) = (self.and(*a, *b), self.and(either, carry));
            carry = self.or(both, passed);
        }
        sum
    }

    pub(super) fn add(&mut self, a: &[Literal], b: &[Literal]) -> Word {
        // The order of operands is not to count.
        let (a, b) = if a <= b { (a, b) } else { (b, a) };
        self.sum(a, b, Literal::FALSE)
    }

    pub(super) fn subtract(&mut self, a: &[Literal], b: &[Literal]) -> Word {
        let inverse: Word = b.iter().map(|literal| !*literal).collect();
        self.sum(a, &inverse, Literal::TRUE)
    }

    pub(super) fn negate(&mut self, a: &[Literal]) -> Word {
        self.subtract(&constant(0, a.len()), a)
    }

    /// The inverse where a condition holds: minus `a`.
    pub(super) fn negate_if(&mut self, condition: Literal, a: &[Literal]) -> Word {
        let negative = self.negate(a);
        self.select_word(condition, &negative, a)
    }

    /// Whether two signed words are one number.
    pub(super) fn equal(&mut self, a: &[Literal], b: &[Literal]) -> Literal {
        let width = a.len().max(b.len());
        let (a, b) = (extended(a, true, width), extended(b, true, width));
        let mut equal = Literal::TRUE;
        for (a, b) in a.into_iter().zip(b) {
            let differ = self.xor(a, b);
            equal = self.and(equal, !differ);
        }
        equal
    }

    /// Whether one signed word is less than another.
    pub(super) fn less(&mut self, a: &[Literal], b: &[Literal]) -> Literal {
        let width = a.len().max(b.len());
        let (a, b) = (extended(a, true, width), extended(b, true, width));
        let mut less = Literal::FALSE;
        for (bit, (a, b)) in a.into_iter().zip(b).enumerate() {
            // The highest bit weighs the other way round.
            let (a, b) = if bit + 1 == width { (b, a) } else { (a, b) };
            let (below, differ) = (self.and(!a, b), self.xor(a, b));
            let before = self.and(!differ, less);
            less = self.or(below, before);
        }
        less
    }

    /// Whether any bit is set.
    pub(super) fn any(&mut self, word: &[Literal]) -> Literal {
        word.iter().fold(Literal::FALSE, |any, literal| self.or(any, *literal))
    }

    /// A word moved by an amount that is not known: `moved` moves it by one that is.
    pub(super) fn moved(
        &mut self,
        word: &[Literal],
        amount: &[Literal],
        moved: impl Fn(&[Literal], usize) -> Word,
    ) -> Word {
        let mut word = word.to_vec();
        for (stage, bit) in amount.iter().enumerate() {
            let further = moved(&word, 1 << stage);
            word = self.select_word(*bit, &further, &word);
        }
        word
    }
}

/// The bits moved up, zeros in.
pub(super) fn shifted_left(word: &[Literal], amount: usize) -> Word {
    let amount = amount.min(word.len());
    std::iter::repeat_n(Literal::FALSE, amount).chain(word[..word.len() - amount].iter().copied()).collect()
}

/// The bits moved down, zeros in.
pub(super) fn shifted_right(word: &[Literal], amount: usize) -> Word {
    extended(&word[amount.min(word.len())..], false, word.len())
}

/// The bits moved up and around the end.
pub(super) fn rotated_left(word: &[Literal], amount: usize) -> Word {
    let mut word = word.to_vec();
    let width = word.len();
    word.rotate_right(amount % width);
    word
}

/// The bits moved down and around the end.
pub(super) fn rotated_right(word: &[Literal], amount: usize) -> Word {
    let mut word = word.to_vec();
    let width = word.len();
    word.rotate_left(amount % width);
    word
}
