//! The JIT.
use crate::logic::Program;
use rung_runtime::Scan;

/// A compiled program.
#[derive(Debug)]
pub struct Jit {}

/// Why a program cannot be compiled.
#[derive(Debug)]
pub struct CompileError(pub String);

impl Jit {
    /// Compiles every chunk of a program for this machine.
    pub fn compile(_program: &Program) -> Result<Self, CompileError> {
        unimplemented!()
    }
    /// Bytes of machine code.
    pub fn code_bytes(&self) -> usize {
        unimplemented!()
    }
}

impl Scan for Jit {
    fn scan(&mut self, _image: &mut [u8], _now: i64) {
        unimplemented!()
    }
}
