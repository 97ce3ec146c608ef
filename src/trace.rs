//! Traces: what the variables were after every scan, written as a table, as waves or as a picture.
//!
//! A trace is made scan by scan as it is recorded, in memory that does not grow with the number of scans, and its
//! bytes are determined by what was recorded: this module must never read a clock, and writes only to what it is given.

mod csv;
mod svg;
mod vcd;

use std::collections::{HashMap, HashSet};
use std::fmt;
use std::io;

use crate::elementary::{Elementary, Value, f32_of};
use crate::logic::image::Observed;
use crate::logic::{Area, Layout, Slot};
use crate::simulate::decimal::Milliseconds;

pub use self::csv::CsvTrace;
pub use self::svg::{Period, SvgTrace};
pub use self::vcd::VcdTrace;

/// A trace that is being recorded.
pub trait Trace {
    /// Records the variables as they are in an image, after the scan at `now` nanoseconds. Times never go back.
    ///
    /// # Errors
    /// When what it is written to fails.
    ///
    /// # Panics
    /// When the image is shorter than the layout of the signals.
    fn record(&mut self, now: i64, image: &[u8]) -> io::Result<()>;

    /// Writes what is still to be written. Nothing may be recorded after.
    ///
    /// # Errors
    /// When what it is written to fails.
    fn finish(&mut self) -> io::Result<()>;
}

/// A variable of a trace.
#[derive(Clone, PartialEq, Debug)]
pub struct Signal {
    name: String,
    slot: Slot,
}

impl Signal {
    /// Its name in the trace: `name`, or `instance.member`.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Its type.
    pub fn ty(&self) -> Elementary {
        self.slot.ty
    }

    /// The part of the image that it belongs to.
    pub fn area(&self) -> Area {
        self.slot.area
    }

    /// The block instance that it is a member of, if any, and its name there. The point of an address, such as
    /// `%IX0.3`, parts nothing.
    pub fn parts(&self) -> (Option<&str>, &str) {
        match self.name.rsplit_once('.') {
            Some((instance, member)) if !self.name.starts_with('%') => (Some(instance), member),
            _ => (None, &self.name),
        }
    }

    /// Its value in an image.
    fn read(&self, image: &[u8]) -> Value {
        self.slot.read(image)
    }

    /// Everything that can be observed, in order of declaration.
    pub fn all(layout: &Layout) -> Vec<Self> {
        let signal =
            |observed: &Observed| Self { name: observed.name.to_string(), slot: layout.slot(observed.slot).clone() };
        layout.observed().iter().map(signal).collect()
    }

    /// The named ones, in the order named. The name of a program, a block instance, an array or a structure stands for
    /// all that is in it.
    ///
    /// # Errors
    /// The first name that there is not.
    pub fn select(layout: &Layout, names: &[String]) -> Result<Vec<Self>, String> {
        let all = Self::all(layout);
        let mut wanted: HashMap<String, Vec<usize>> =
            names.iter().map(|name| (name.to_lowercase(), Vec::new())).collect();
        for (index, signal) in all.iter().enumerate() {
            let name = signal.name.to_lowercase();
            let parts = if name.starts_with('%') { "" } else { &name };
            let wholes = parts.match_indices(['.', '[']).map(|(end, _)| &name[..end]);
            for whole in wholes.chain([name.as_str()]) {
                if let Some(found) = wanted.get_mut(whole) {
                    found.push(index);
                }
            }
        }
        let mut seen = HashSet::new();
        let mut selected = Vec::new();
        for name in names {
            let found = wanted.get(&name.to_lowercase()).filter(|found| !found.is_empty()).ok_or(name)?;
            selected.extend(found.iter().filter(|index| seen.insert(**index)).map(|index| all[*index].clone()));
        }
        Ok(selected)
    }
}

/// A value as a trace spells it: BOOL as 0 or 1, TIME in milliseconds with as many decimals as it needs, REAL and
/// LREAL in the shortest form that reads back as the same number.
pub(crate) struct Spelled(pub(crate) Value);

impl fmt::Display for Spelled {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let bits = self.0.bits();
        let real = match self.0.ty() {
            Elementary::Time => return Milliseconds(bits.cast_signed()).fmt(f),
            Elementary::Real => format!("{:?}", f32_of(bits)),
            Elementary::Lreal => format!("{:?}", f64::from_bits(bits)),
            ty if ty.is_signed() => return bits.cast_signed().fmt(f),
            _ => return bits.fmt(f),
        };
        f.write_str(real.strip_suffix(".0").unwrap_or(&real))
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn values_are_spelled_shortly_and_exactly() {
        let real = |value: f32| Spelled(Value::from_bits(Elementary::Real, u64::from(value.to_bits()))).to_string();
        let reals = [0.0, -0.0, 1.0, 0.1, -2.5, 1e20, 1e-7, f32::MAX, f32::NAN, f32::INFINITY, f32::NEG_INFINITY];
        assert_eq!(
            reals.map(real),
            ["0", "-0", "1", "0.1", "-2.5", "1e20", "1e-7", "3.4028235e38", "NaN", "inf", "-inf"]
        );
        let lreal = Spelled(Value::real(Elementary::Lreal, 1.0 / 3.0).expect("an LREAL")).to_string();
        assert_eq!(lreal, "0.3333333333333333");
        let greatest = Spelled(Value::from_bits(Elementary::Ulint, u64::MAX)).to_string();
        assert_eq!(greatest, "18446744073709551615");
    }

    proptest! {
        #[test]
        fn every_real_reads_back_equal(bits: u32, wide: u64) {
            let real = f32::from_bits(bits);
            let text = Spelled(Value::from_bits(Elementary::Real, u64::from(bits))).to_string();
            let back: f32 = text.parse().expect("a number");
            prop_assert!(back.to_bits() == bits || (back.is_nan() && real.is_nan()), "{}", text);

            let text = Spelled(Value::from_bits(Elementary::Lreal, wide)).to_string();
            let back: f64 = text.parse().expect("a number");
            prop_assert!(back.to_bits() == wide || (back.is_nan() && f64::from_bits(wide).is_nan()), "{}", text);
        }
    }
}
