//! The `rung` command; all of it is in the library's [`rung::cli`].

use std::process::ExitCode;

/// Reading a large drawing makes a million small objects: a third of its time went to the system's allocator and to page
/// faults. A program that embeds the library keeps its own.
#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;

fn main() -> ExitCode {
    rung::cli::main()
}
