//! `rung fmt`: the one canonical form of native text.

use std::path::PathBuf;

use super::{Failure, load, print, report, write_whole};
use crate::diagnostic::{self, Code, Diagnostic, any_error};
use crate::frontend::{self, native};
use crate::source::Span;

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
        if !frontend::is_native(loaded.source.text()) {
            let problem = Diagnostic::new(Code::OtherFormat, Span::default(), "this file is not in native text")
                .hint("`rung convert` writes it as native text, to a file of its own");
            report(&diagnostic::render(&loaded.source, &[problem]));
            failed = true;
            continue;
        }
        if any_error(&loaded.diagnostics) {
            report(&diagnostic::render(&loaded.source, &loaded.diagnostics));
            failed = true;
            continue;
        }
        let text = native::print(&loaded.program);
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
