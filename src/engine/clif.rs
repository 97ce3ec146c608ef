//! One chunk of logic to one Cranelift function.
