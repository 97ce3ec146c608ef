//! The `rung` command; all of it is in the library's [`rung::cli`].

use std::process::ExitCode;

/// Reading a large drawing makes a million small objects, for which this one takes less time and far fewer page faults than
/// the system's. A program that embeds the library keeps its own.
#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;

fn main() -> ExitCode {
    rung::cli::main()
}
