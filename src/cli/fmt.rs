//! `rung fmt`: the one canonical form of native text.

use std::path::PathBuf;

use super::{Failure, load, print, report, write_whole};
use crate::diagnostic::{self, any_error};
use crate::frontend::native;
use crate::ladder::Origin;

/// Writes programs in the canonical form of the native text
#[derive(Debug, clap::Args)]
pub(super) struct Arguments {
    /// The programs; `-` is the standard input, whose text goes to the standard output
    #[arg(required = true)]
    files: Vec<PathBuf>,
    /// Only say which files are not in canonical form; the exit code is 1 when there is one
    #[arg(long)]
    check: bool,
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let mut failed = false;
    for path in &arguments.files {
        let loaded = match load(path) {
            Ok(loaded) => loaded,
            Err(Failure::Error(text)) => {
                report(&text);
                failed = true;
                continue;
            }
            Err(other) => return Err(other),
        };
        if any_error(&loaded.diagnostics) {
            report(&diagnostic::render(&loaded.source, &loaded.diagnostics));
            failed = true;
            continue;
        }
        let text = native::print(&loaded.program);
        // A file of another tool stays as it is; what it is in native text goes to the standard output.
        if loaded.program.origin == Origin::Imported && !arguments.check {
            print(&text)?;
            continue;
        }
        let changed = text != loaded.source.text();
        if arguments.check {
            if changed {
                print(&format!("{}\n", path.display()))?;
                failed = true;
            }
        } else if changed || path.as_os_str() == "-" {
            write_whole(path, text.as_bytes())?;
        }
    }
    if failed { Err(Failure::Said) } else { Ok(()) }
}
