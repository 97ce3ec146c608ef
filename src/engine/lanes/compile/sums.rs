//! The sums of an epoch, of all slots of a class: for each lane the last code that is not 0, and in which row.
//!
//! A turn for each vector of each slot; the rows are joined in pairs, and the pairs in pairs. Of two, the later counts
//! in the
//! lanes in which it has a code, else the earlier: so the bit of the row's number that tells the two apart is whether
//! the later has one.
//!
//! ```text
//! extern "C" fn(to: *mut Word, rows: *const Word, vectors: i64)
//! ```

use cranelift_codegen::ir::{InstBuilder, MemFlagsData, Value};
use cranelift_frontend::FunctionBuilder;

use super::{VECTOR, way};
use crate::engine::lanes::plan::{Class, Plan};
use crate::engine::lanes::track::ROWS;

/// Some rows, summed up.
struct Node {
    /// The lanes with any code.
    any: Value,
    /// The bits of the row's number, the lowest first.
    number: Vec<Value>,
    /// The bits of the code.
    code: Vec<Value>,
}

/// Fills a function with the sums of a class. Each kind of sum is one run of words, as [`Class::sums`] counts them:
/// any,
/// the number's bits, the code's.
pub(super) fn sums<'f>(
    plan: &Plan,
    class: &Class,
    builder: FunctionBuilder<'f>,
    [to, rows]: [Value; 2],
) -> FunctionBuilder<'f> {
    let mut summing = Summing { plan, class, builder, rows };
    let Node { any, number, code } = summing.node(0, ROWS);
    let Summing { mut builder, .. } = summing;
    for (kind, value) in std::iter::once(any).chain(number).chain(code).enumerate() {
        builder.ins().store(MemFlagsData::trusted(), value, to, place(kind * class.tracks.len()));
    }
    builder
}

fn place(word: usize) -> i32 {
    way(u32::try_from(word).unwrap_or(u32::MAX))
}

struct Summing<'a, 'f> {
    plan: &'a Plan,
    class: &'a Class,
    builder: FunctionBuilder<'f>,
    /// The slot's place in the first row, but for the class's.
    rows: Value,
}

impl Summing<'_, '_> {
    /// The sum of some rows, a power of two.
    fn node(&mut self, first: usize, count: usize) -> Node {
        if count == 1 {
            return self.row(first);
        }
        let (early, late) = (self.node(first, count / 2), self.node(first + count / 2, count / 2));
        let any = self.builder.ins().bor(early.any, late.any);
        let mut number = self.choose(&late, &early.number, &late.number);
        number.push(late.any);
        let code = self.choose(&late, &early.code, &late.code);
        Node { any, number, code }
    }

    /// The later bits in the lanes in which the later rows have a code, else the earlier.
    fn choose(&mut self, late: &Node, early_bits: &[Value], late_bits: &[Value]) -> Vec<Value> {
        early_bits
            .iter()
            .zip(late_bits)
            .map(|(early_bit, late_bit)| {
                let not = self.builder.ins().bnot(late.any);
                let kept = self.builder.ins().band(*early_bit, not);
                self.builder.ins().bor(kept, *late_bit)
            })
            .collect()
    }

    fn row(&mut self, row: usize) -> Node {
        let first = row * self.plan.row_words + self.class.row;
        let load = |bit: usize| place(first + bit * self.class.tracks.len());
        let ways: Vec<i32> = (0..self.class.bits).map(load).collect();
        let flags = MemFlagsData::trusted();
        let code: Vec<Value> =
            ways.into_iter().map(|way| self.builder.ins().load(VECTOR, flags, self.rows, way)).collect();
        let mut bits = code.iter().copied();
        let Some(first) = bits.next() else { unreachable!("a class has at least one bit") };
        let any = bits.fold(first, |any, bit| self.builder.ins().bor(any, bit));
        // The only bit of a code is whether there is one.
        let code = if code.len() == 1 { Vec::new() } else { code };
        Node { any, number: Vec::new(), code }
    }
}
