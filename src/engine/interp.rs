//! The interpreter.
use crate::logic::Program;
use rung_runtime::Scan;

/// An interpreted program.
#[derive(Debug)]
pub struct Interpreter {}

impl Interpreter {
    /// Makes ready to interpret a program.
    pub fn new(_program: &Program) -> Self {
        unimplemented!()
    }
}

impl Scan for Interpreter {
    fn scan(&mut self, _image: &mut [u8], _now: i64) {
        unimplemented!()
    }
}
