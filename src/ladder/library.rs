//! The standard function blocks: their names, pins and types.
//!
//! One entry a block, and its rule in one function of `lower`; nothing else must know what pins a block has.
//! What each block computes is said in the manual, from IEC 61131-3, 6.6.3.5, and for the register machine from the paper
//! that its page names.

use crate::elementary::Elementary::{self, Bool, Dint, Int, Lint, Real, Time, Udint, Ulint, Usint, Word};
use crate::elementary::Value;

/// One input or output of a block.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Pin {
    /// Its name, as the standard spells it.
    pub name: &'static str,
    /// Its type.
    pub ty: Elementary,
    /// What it holds before it is wired for the first time; of what is no number, its bits.
    pub initial: i64,
    /// The least and the greatest constant that it takes; none where it takes all of its type.
    pub range: Option<(i64, i64)>,
    /// What it takes.
    pub takes: Takes,
}

/// What an input takes.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Takes {
    /// A value.
    Value,
    /// A as constant, which has to be wired.
    Constant,
    /// A variable, which the block reads and writes; or an element of an array, from which on it may use those behind it. It has
    /// to be wired.
    Reference,
}

impl Pin {
    /// What it holds before it is wired for the first time.
    pub fn initial_value(&self) -> Value {
        Value::from_bits(self.ty, self.initial.cast_unsigned())
    }
}

macro_rules! or_zero {
    () => {
        0
    };
    ($value:literal) => {
        $value
    };
}

macro_rules! or_none {
    () => {
        None
    };
    ($least:literal $greatest:literal) => {
        Some(($least, $greatest))
    };
}

macro_rules! takes {
    () => {
        Takes::Value
    };
    (constant) => {
        Takes::Constant
    };
    (reference) => {
        Takes::Reference
    };
}

// A pin is its name and type; `= 1` is its default, `in 0 to 9` the range of its constants, `as constant` or `as reference`
// what else than a value it takes. Behind a semicolon stand pins that differ in nothing but the number behind their name.
macro_rules! pins {
    ((
        $($name:literal: $ty:ident $(= $initial:literal)? $(in $least:literal to $greatest:literal)? $(as $takes:ident)?),*
        $(; $series:literal $($number:literal)+: $series_ty:ident = $series_initial:literal)?
    )) => {
        &[
            $(Pin {
                name: $name,
                ty: $ty,
                initial: or_zero!($($initial)?),
                range: or_none!($($least $greatest)?),
                takes: takes!($($takes)?),
            },)*
            $($(Pin {
                name: concat!($series, $number),
                ty: $series_ty,
                initial: $series_initial,
                range: None,
                takes: Takes::Value,
            },)+)?
        ]
    };
}

// A row is one rule; its blocks differ in nothing but the type that the row calls COUNT.
macro_rules! blocks {
    ($(#[$doc:meta] $($variant:ident $name:literal $($count:ident)?),+: $inputs:tt => $outputs:tt;)*) => {
        /// A standard function block.
        #[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
        pub enum StandardBlock {
            $($(#[$doc] $variant,)+)*
        }

        impl StandardBlock {
            /// Every block, in the order of the enumeration.
            pub const ALL: &'static [Self] = &[$($(Self::$variant,)+)*];

            /// Its type name, as the standard spells it.
            pub const fn name(self) -> &'static str {
                match self { $($(Self::$variant => $name,)+)* }
            }

            /// Its inputs, in order.
            pub const fn inputs(self) -> &'static [Pin] {
                match self { $($(Self::$variant => const { $(const COUNT: Elementary = $count;)? pins!($inputs) },)+)* }
            }

            /// Its outputs, in order.
            pub const fn outputs(self) -> &'static [Pin] {
                match self { $($(Self::$variant => const { $(const COUNT: Elementary = $count;)? pins!($outputs) },)+)* }
            }
        }
    };
}

blocks! {
    /// On-delay timer.
    Ton "TON": ("IN": Bool, "PT": Time) => ("Q": Bool, "ET": Time);
    /// Off-delay timer.
    Tof "TOF": ("IN": Bool, "PT": Time) => ("Q": Bool, "ET": Time);
    /// Pulse timer.
    Tp "TP": ("IN": Bool, "PT": Time) => ("Q": Bool, "ET": Time);
    /// Retentive on-delay timer.
    Tonr "TONR": ("IN": Bool, "R": Bool, "PT": Time) => ("Q": Bool, "ET": Time);
    /// Up counter.
    Ctu "CTU" Int, CtuInt "CTU_INT" Int, CtuDint "CTU_DINT" Dint, CtuLint "CTU_LINT" Lint,
    CtuUdint "CTU_UDINT" Udint, CtuUlint "CTU_ULINT" Ulint:
        ("CU": Bool, "R": Bool, "PV": COUNT) => ("Q": Bool, "CV": COUNT);
    /// Down counter.
    Ctd "CTD" Int, CtdInt "CTD_INT" Int, CtdDint "CTD_DINT" Dint, CtdLint "CTD_LINT" Lint,
    CtdUdint "CTD_UDINT" Udint, CtdUlint "CTD_ULINT" Ulint:
        ("CD": Bool, "LD": Bool, "PV": COUNT) => ("Q": Bool, "CV": COUNT);
    /// Up-down counter.
    Ctud "CTUD" Int, CtudInt "CTUD_INT" Int, CtudDint "CTUD_DINT" Dint, CtudLint "CTUD_LINT" Lint,
    CtudUdint "CTUD_UDINT" Udint, CtudUlint "CTUD_ULINT" Ulint:
        ("CU": Bool, "CD": Bool, "R": Bool, "LD": Bool, "PV": COUNT) => ("QU": Bool, "QD": Bool, "CV": COUNT);
    /// Rising edge.
    RTrig "R_TRIG": ("CLK": Bool) => ("Q": Bool);
    /// Falling edge.
    FTrig "F_TRIG": ("CLK": Bool) => ("Q": Bool);
    /// Bistable, set dominant.
    Sr "SR": ("S1": Bool, "R": Bool) => ("Q1": Bool);
    /// Bistable, reset dominant.
    Rs "RS": ("S": Bool, "R1": Bool) => ("Q1": Bool);
    /// Semaphore, which one of its users claims and releases.
    Sema "SEMA": ("CLAIM": Bool, "RELEASE": Bool) => ("BUSY": Bool);
    /// Integral over time.
    Integral "INTEGRAL": ("RUN": Bool, "R1": Bool, "XIN": Real, "X0": Real, "CYCLE": Time) => ("Q": Bool, "XOUT": Real);
    /// Derivative with respect to time.
    Derivative "DERIVATIVE": ("RUN": Bool, "XIN": Real, "CYCLE": Time) => ("XOUT": Real);
    /// Three-term controller.
    Pid "PID": ("AUTO": Bool, "PV": Real, "SP": Real, "X0": Real, "KP": Real, "TR": Real, "TD": Real, "CYCLE": Time) => ("XOUT": Real);
    /// Ramp from one value to another.
    Ramp "RAMP": ("RUN": Bool, "X0": Real, "X1": Real, "TR": Time, "CYCLE": Time) => ("BUSY": Bool, "XOUT": Real);
    /// Two-point switch with a dead band.
    Hysteresis "HYSTERESIS": ("XIN1": Real, "XIN2": Real, "EPS": Real) => ("Q": Bool);
    /// Timer of the register machine, in tenths of a second or in seconds.
    Tt "TT", Ts "TS":
        ("TIMING": Bool, "ENABLE": Bool = 1, "KIND": Usint in 0 to 3 as constant, "PRESET": Word in 0 to 9999)
        => ("Q": Bool, "VALUE": Word);
    /// Up counter of the register machine.
    Uc "UC": ("COUNT": Bool, "ENABLE": Bool = 1, "PRESET": Word in 0 to 9999) => ("Q": Bool, "VALUE": Word);
    /// Down counter of the register machine.
    Dc "DC": ("COUNT": Bool, "ENABLE": Bool = 1, "PRESET": Word in 0 to 9999) => ("Q": Bool, "VALUE": Word);
    /// Drum: an up counter with taps.
    Dr "DR":
        ("STEP": Bool, "ENABLE": Bool = 1, "PRESET": Word = 2047 in 0 to 2047;
            "TAP" 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16: Word = 65535)
        => ("Q": Bool, "VALUE": Word; "Q" 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16: Bool = 0);
    /// Shift register, towards the highest bit of the highest register or towards the lowest bit of the lowest.
    Shiftl "SHIFTL", Shiftr "SHIFTR":
        ("SHIFT": Bool, "DATA": Bool, "ENABLE": Bool = 1, "COUNT": Usint = 1 in 1 to 15,
            "REGISTER": Word as reference, "LENGTH": Usint in 1 to 32 as constant)
        => ("Q": Bool);
    /// Sets, or clears, a bit of a register.
    Bs "BS", Bc "BC": ("IN": Bool, "REGISTER": Word as reference, "BIT": Usint in 0 to 15) => ("Q": Bool);
}

impl StandardBlock {
    /// The block of that type name, in any case.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.iter().copied().find(|block| block.name().eq_ignore_ascii_case(name))
    }

    /// The place of an input among [`StandardBlock::inputs`], by its name in any case.
    pub fn input(self, name: &str) -> Option<usize> {
        self.inputs().iter().position(|pin| pin.name.eq_ignore_ascii_case(name))
    }

    /// How the standard spells an input that some tools call otherwise: `RESET` of a counter is its `R`. `None` where the block has
    /// an input of that very name, or none that it could be.
    pub fn input_called(self, name: &str) -> Option<&'static str> {
        /// Names of the first edition of the standard and of CODESYS, with those of today.
        const OTHER_NAMES: &[(&str, &str)] =
            &[("RESET", "R"), ("LOAD", "LD"), ("SET1", "S1"), ("SET", "S"), ("RESET1", "R1")];
        if self.input(name).is_some() {
            return None;
        }
        let mut others = OTHER_NAMES.iter().filter(|(other, _)| other.eq_ignore_ascii_case(name));
        others.find_map(|(_, pin)| self.input(pin).map(|place| self.inputs()[place].name))
    }

    /// The place of an output among [`StandardBlock::outputs`], by its name in any case.
    pub fn output(self, name: &str) -> Option<usize> {
        self.outputs().iter().position(|pin| pin.name.eq_ignore_ascii_case(name))
    }
}
