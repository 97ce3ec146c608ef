//! Why a batch does not do what it is asked for.

use std::error::Error;
use std::fmt;

use crate::elementary::Elementary;

/// See the module.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum BatchError {
    /// No plants were asked for.
    NoLanes,
    /// The images of all plants together are too large.
    TooLarge {
        /// Bytes that they would have.
        bytes: u64,
    },
    /// There is no such lane.
    NoSuchLane {
        /// The lane.
        lane: usize,
        /// How many there are.
        lanes: usize,
    },
    /// The program has no such variable.
    NoSuchVariable {
        /// Its name.
        name: String,
    },
    /// A value is of another type than its variable.
    WrongType {
        /// The variable's.
        expected: Elementary,
        /// The value's.
        found: Elementary,
    },
    /// An image is not of the program's size.
    WrongSize {
        /// Bytes that it has.
        found: usize,
        /// Bytes that it should have.
        size: usize,
    },
}

impl fmt::Display for BatchError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoLanes => write!(f, "a batch has at least one lane"),
            Self::TooLarge { bytes } => {
                write!(f, "the process images of all lanes would have {} GiB", bytes.div_ceil(1 << 30))
            }
            Self::NoSuchLane { lane, lanes } => write!(f, "there is no lane {lane}: there are {lanes}, counted from 0"),
            Self::NoSuchVariable { name } => write!(f, "the program has no variable `{name}`"),
            Self::WrongType { expected, found } => write!(f, "the variable is {expected}, and the value {found}"),
            Self::WrongSize { found, size } => write!(f, "the image has {found} bytes, not {size}"),
        }
    }
}

impl Error for BatchError {}
