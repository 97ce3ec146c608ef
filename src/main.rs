//! The `rung` command; all of it is in the library's [`rung::cli`].

use std::process::ExitCode;

fn main() -> ExitCode {
    rung::cli::main()
}
