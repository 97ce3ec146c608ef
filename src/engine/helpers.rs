//! The table of helpers that compiled chunks call: C functions on LREALs, each computing what
//! [`evaluate::helper`] says, and behind them one that copies long arrays. Nothing may be computed here.

use crate::logic::{Helper, evaluate};

/// A helper as chunks call it. One that takes a single operand does not look at the second.
pub type HelperFunction = extern "C" fn(f64, f64) -> f64;

/// The place in the table of the function that copies long arrays, counted in pointers: behind the others. It is given
/// two pointers, to and from as many bytes as a third number says, which are the same or apart.
pub const COPY: usize = Helper::ALL.len();

macro_rules! table {
    ($($name:ident)*) => { [$({
        extern "C" fn function(a: f64, b: f64) -> f64 {
            evaluate::helper(Helper::$name, a, b)
        }
        (Helper::$name, function as HelperFunction)
    },)*] };
}

const FUNCTIONS: [(Helper, HelperFunction); Helper::ALL.len()] = table!(Ln Log10 Exp Sin Cos Tan Asin Acos Atan Power);

/// The functions on LREALs, in the order of [`Helper::ALL`].
pub const HELPERS: [HelperFunction; Helper::ALL.len()] = {
    let mut table = [FUNCTIONS[0].1; Helper::ALL.len()];
    let mut row = 0;
    while row < table.len() {
        assert!(FUNCTIONS[row].0 as usize == row, "the functions stand in the order of the op table");
        table[row] = FUNCTIONS[row].1;
        row += 1;
    }
    table
};
