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
            "{}: {}, {}, {}\n",
            loaded.source.name(),
            counted(loaded.program.rungs().count(), "rung"),
            counted(count(Severity::Error), "error"),
            counted(count(Severity::Warning), "warning")
        ))?;
    }
    if failed { Err(Failure::Said) } else { Ok(()) }
}

/// `1 rung`, `2 rungs`
fn counted(count: usize, what: &str) -> String {
    format!("{count} {what}{}", if count == 1 { "" } else { "s" })
}
