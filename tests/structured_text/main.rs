//! Structured text from outside: what each construct becomes, what each mistake is called, that what is written means the same when
//! it is read again, and that no bytes do harm.

mod constructs;
mod hostile;
mod random;
mod regressions;
mod units;

#[path = "../support"]
#[allow(dead_code, reason = "other test programs use the rest")]
mod support {
    pub(crate) mod dice;
    pub(crate) mod drawing;
    pub(crate) mod random_program;
    pub(crate) mod random_stimuli;
    pub(crate) mod same_trace;
    pub(crate) mod shrink;
}
