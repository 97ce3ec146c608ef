//! The C interface of a built program: what its functions and data are called, and what stands where.
//!
//! Objects and emitted C export the same, so that firmware can take either; what both must agree on is written here
//! only. Nothing here may make code.
//!
//! An image of the interface is the [layout](Layout)'s bytes, at the same offsets on every target, and behind them a
//! clock of [`CLOCK_SIZE`] bytes:
//!
//! ```text
//! layout.size() + LAST_TICKS    u32    the tick counter when it was last latched
//! layout.size() + 4             u32    reserved, 0
//! layout.size() + TOTAL_TICKS   u64    ticks since the image was initialised
//! ```

#[cfg(test)]
mod tests;

use std::fmt;
use std::ops::Range;

use crate::diagnostic::Code;
use crate::elementary::Elementary;
use crate::logic::Layout;

/// The version of the interface. It grows with each change that firmware must know of.
pub const ABI_VERSION: u32 = 1;

/// Bytes of the clock behind the layout of an image; a multiple of the image's alignment.
pub const CLOCK_SIZE: u32 = 16;

/// Where in the clock the counter of the last latch lies, a 32-bit word.
pub const LAST_TICKS: u32 = 0;

/// Where in the clock the sum of all ticks lies, a 64-bit word.
pub const TOTAL_TICKS: u32 = 8;

/// The prefix where none is given.
pub const DEFAULT_PREFIX: &str = "ladder";

/// The tick's period where none is given, in nanoseconds.
pub const DEFAULT_TICK: i64 = 1_000_000;

/// The longest prefix, in bytes. C compares at least 63 bytes of a name; the longest symbol adds 14.
pub const LONGEST_PREFIX: usize = 48;

/// What a built program exports. All else of it is local.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum Symbol {
    /// `P_image_t P_image`: an image ready-made.
    Image,
    /// `const uint32_t P_image_size`: bytes of an image, the clock included.
    ImageSize,
    /// `const uint32_t P_retain_offset`: the first retained byte, 0 if there is none.
    RetainOffset,
    /// `const uint32_t P_retain_size`: bytes of all retained runs together.
    RetainSize,
    /// `const uint64_t P_layout_hash`: [`Layout::hash`].
    LayoutHash,
    /// `const uint32_t P_abi_version`: [`ABI_VERSION`].
    AbiVersion,
    /// `void P_init(void *image, const void *retained)`.
    Init,
    /// `void P_save(const void *image, void *retained)`.
    Save,
    /// `void P_scan(void *image, int64_t now)`.
    Scan,
    /// `void P_tick(void)`.
    Tick,
    /// `void P_cycle(void *image)`.
    Cycle,
}

impl Symbol {
    /// Every one: the data, then the functions.
    pub const ALL: [Self; 11] = [
        Self::Image,
        Self::ImageSize,
        Self::RetainOffset,
        Self::RetainSize,
        Self::LayoutHash,
        Self::AbiVersion,
        Self::Init,
        Self::Save,
        Self::Scan,
        Self::Tick,
        Self::Cycle,
    ];

    /// What stands behind the prefix and `_`.
    pub const fn suffix(self) -> &'static str {
        match self {
            Self::Image => "image",
            Self::ImageSize => "image_size",
            Self::RetainOffset => "retain_offset",
            Self::RetainSize => "retain_size",
            Self::LayoutHash => "layout_hash",
            Self::AbiVersion => "abi_version",
            Self::Init => "init",
            Self::Save => "save",
            Self::Scan => "scan",
            Self::Tick => "tick",
            Self::Cycle => "cycle",
        }
    }
}

/// What of the interface can be chosen.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Interface {
    prefix: String,
    tick: i64,
}

impl Default for Interface {
    fn default() -> Self {
        Self { prefix: DEFAULT_PREFIX.to_owned(), tick: DEFAULT_TICK }
    }
}

/// Why there is no such interface.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum BadInterface {
    /// The prefix is no identifier of C, starts with `_`, or is longer than [`LONGEST_PREFIX`].
    Prefix(String),
    /// The tick's period, in nanoseconds, is not above 0.
    Tick(i64),
}

impl BadInterface {
    /// The code of the error.
    pub fn code(&self) -> Code {
        match self {
            Self::Prefix(_) => Code::BadSymbol,
            Self::Tick(_) => Code::BadTiming,
        }
    }

    /// What to do about it.
    pub fn hint(&self) -> String {
        match self {
            Self::Prefix(_) => format!(
                "take letters from A to Z, digits and `_`, a letter first, at most {LONGEST_PREFIX}, \
                 as in `{DEFAULT_PREFIX}`"
            ),
            Self::Tick(_) => "give the period of the timer interrupt, as in `1ms`".to_owned(),
        }
    }
}

impl fmt::Display for BadInterface {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Prefix(prefix) => {
                let shown: String = prefix.chars().filter(|c| !c.is_control()).take(LONGEST_PREFIX + 1).collect();
                write!(f, "`{shown}` is no prefix for symbols")
            }
            Self::Tick(tick) => write!(f, "a tick of {tick} ns"),
        }
    }
}

impl std::error::Error for BadInterface {}

impl Interface {
    /// The interface with a prefix, an ASCII identifier of C that does not start with `_`, and a tick's period in
    /// nanoseconds.
    ///
    /// # Errors
    /// When the prefix is none, or the period is not above 0.
    pub fn new(prefix: &str, tick: i64) -> Result<Self, BadInterface> {
        let identifier = prefix.starts_with(|c: char| c.is_ascii_alphabetic())
            && prefix.chars().all(|c| c.is_ascii_alphanumeric() || c == '_');
        if !identifier || prefix.len() > LONGEST_PREFIX {
            return Err(BadInterface::Prefix(prefix.to_owned()));
        }
        if tick <= 0 {
            return Err(BadInterface::Tick(tick));
        }
        Ok(Self { prefix: prefix.to_owned(), tick })
    }

    /// The prefix of all symbols, without the `_` behind it.
    pub fn prefix(&self) -> &str {
        &self.prefix
    }

    /// The tick's period in nanoseconds, above 0.
    pub fn tick(&self) -> i64 {
        self.tick
    }

    /// A symbol's name.
    pub fn symbol(&self, symbol: Symbol) -> String {
        format!("{}_{}", self.prefix, symbol.suffix())
    }
}

/// Bytes of an image, the clock included.
pub fn image_size(layout: &Layout) -> u32 {
    // A layout has at most 2^30.
    layout.size() + CLOCK_SIZE
}

/// Where in an image the first retained byte lies; 0 if there is none.
pub fn retain_offset(layout: &Layout) -> u32 {
    layout.retained().first().map_or(0, |run| run.start)
}

/// Bytes of all retained runs together, as `P_save` gathers them one behind the other.
pub fn retain_size(layout: &Layout) -> u32 {
    layout.retained().iter().map(|run| run.end - run.start).sum()
}

/// The runs of bytes in an image that are retained BOOLs, which `P_init` makes 0 or 1: in order, none next to another.
pub fn retained_bools(layout: &Layout) -> Vec<Range<u32>> {
    let retained = |at: u32| layout.retained().iter().any(|run| run.contains(&at));
    let bools = layout.slots().iter().filter(|slot| slot.ty == Elementary::Bool && retained(slot.offset));
    runs(bools.map(|slot| slot.offset..slot.offset + 1).collect())
}

/// The runs of bytes in an image that are BOOLs of inputs, which `P_cycle` makes 0 or 1: in order, none next to another.
pub fn input_bools(layout: &Layout) -> Vec<Range<u32>> {
    runs(layout.inputs().iter().map(|extent| extent.bools.clone()).collect())
}

/// Ranges in order, those that touch joined and the empty ones left out.
fn runs(mut ranges: Vec<Range<u32>>) -> Vec<Range<u32>> {
    ranges.retain(|range| !range.is_empty());
    ranges.sort_by_key(|range| range.start);
    let mut runs: Vec<Range<u32>> = Vec::new();
    for range in ranges {
        match runs.last_mut() {
            Some(last) if range.start <= last.end => last.end = last.end.max(range.end),
            _ => runs.push(range),
        }
    }
    runs
}
