//! Built programs on the processors that they are for, under emulators: the firmware of `examples/softcore` as a reader
//! starts it, and many programs at once, of which every image must be that of the interpreter after every scan.
//!
//! A tool that is missing is a failure that names its package, never a reason to leave something out.

mod examples;
mod firmware;
mod linking;
mod suite;
mod target;
mod traces;

#[path = "../support"]
#[allow(dead_code, reason = "this test uses a part of the support only")]
mod support {
    pub(crate) mod coverage;
    pub(crate) mod dice;
    pub(crate) mod drawing;
    pub(crate) mod oracle;
    pub(crate) mod random_program;
    pub(crate) mod random_stimuli;
    pub(crate) mod step_table;
}
