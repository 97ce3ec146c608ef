//! `rung check`: all diagnostics of the given files.

use std::path::PathBuf;

use super::{Failure, load, print, report};
use crate::diagnostic::{self, Severity, any_error};

/// Checks programs and prints every diagnostic; the exit code is 1 when one of them is an error
#[derive(Debug, clap::Args)]
pub(super) struct Arguments {
    /// The programs; `-` is the standard input
    #[arg(required = true)]
    files: Vec<PathBuf>,
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let mut failed = false;
    for path in &arguments.files {
        let mut loaded = match load(path) {
            Ok(loaded) => loaded,
            Err(Failure::Error(text)) => {
                report(&text);
                failed = true;
                continue;
            }
            Err(other) => return Err(other),
        };
        loaded.check();
        report(&diagnostic::render(&loaded.source, &loaded.diagnostics));
        failed |= any_error(&loaded.diagnostics);
        let count = |severity: Severity| {
            loaded.diagnostics.iter().filter(|diagnostic| diagnostic.code.severity() == severity).count()
        };
        print(&format!(
            "{}: {} rungs, {} errors, {} warnings\n",
            loaded.source.name(),
            loaded.program.rungs().count(),
            count(Severity::Error),
            count(Severity::Warning)
        ))?;
    }
    if failed { Err(Failure::Said) } else { Ok(()) }
}
