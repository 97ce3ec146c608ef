//! What the command prints and writes, and how it fails.

use std::io::{self, ErrorKind, Write};
use std::path::Path;
use std::process::ExitCode;

use crate::diagnostic::{self, Code, Diagnostic};
use crate::source::Source;

/// Why a subcommand stops.
#[derive(Debug)]
pub(crate) enum Failure {
    /// An error, rendered: it is printed to the standard error stream, and the exit code is 1.
    Error(String),
    /// It was all said already; the exit code is 1.
    Said,
    /// Whoever read the standard output has closed it, which is no error.
    Closed,
}

impl Failure {
    /// A coded error that belongs to no place in a source.
    pub(crate) fn new(code: Code, message: impl AsRef<str>) -> Self {
        Self::Error(format!("error[{code}]: {}\n", message.as_ref()))
    }

    /// Diagnostics about one source.
    pub(crate) fn diagnostics(source: &Source, diagnostics: &[Diagnostic]) -> Self {
        Self::Error(diagnostic::render(source, diagnostics))
    }
}

/// Prints to the standard output, without a line break of its own.
pub(crate) fn print(text: &str) -> Result<(), Failure> {
    let mut stdout = io::stdout().lock();
    stdout.write_all(text.as_bytes()).and_then(|()| stdout.flush()).map_err(|error| match error.kind() {
        ErrorKind::BrokenPipe => Failure::Closed,
        _ => Failure::new(Code::CannotWrite, format!("the standard output cannot be written: {error}")),
    })
}

/// Prints to the standard error stream; that it cannot be written is no reason to stop.
pub(crate) fn report(text: &str) {
    let _ = io::stderr().lock().write_all(text.as_bytes());
}

/// Writes a file whole or not at all: into a temporary file beside it, which then takes its name. `-` is the
/// standard output.
pub(crate) fn write_whole(path: &Path, bytes: &[u8]) -> Result<(), Failure> {
    if path == Path::new("-") {
        let mut stdout = io::stdout().lock();
        return stdout.write_all(bytes).and_then(|()| stdout.flush()).map_err(|error| cannot_write(path, &error));
    }
    // A device or a pipe has no whole to replace.
    if path.metadata().is_ok_and(|metadata| !metadata.is_file()) {
        return std::fs::write(path, bytes).map_err(|error| cannot_write(path, &error));
    }
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let write = || -> io::Result<()> {
        let mut file = tempfile::Builder::new().permissions(permissions(path)).tempfile_in(folder)?;
        file.write_all(bytes)?;
        file.as_file().sync_all()?;
        file.persist(path).map_err(|error| error.error)?;
        Ok(())
    };
    write().map_err(|error| cannot_write(path, &error))
}

/// The permissions of the file that is replaced, or those of any new file: a temporary file's own would hide it
/// from others.
fn permissions(path: &Path) -> std::fs::Permissions {
    #[cfg(unix)]
    let usual = std::os::unix::fs::PermissionsExt::from_mode(0o666);
    #[cfg(not(unix))]
    let usual = tempfile::tempfile().and_then(|file| file.metadata()).expect("a temporary file").permissions();
    path.metadata().map_or(usual, |metadata| metadata.permissions())
}

fn cannot_write(path: &Path, error: &io::Error) -> Failure {
    if path == Path::new("-") && error.kind() == ErrorKind::BrokenPipe {
        return Failure::Closed;
    }
    Failure::new(Code::CannotWrite, format!("{} cannot be written: {error}", path.display()))
}

/// The exit code of a finished subcommand, with its last words printed.
pub(super) fn exit(result: Result<(), Failure>) -> ExitCode {
    match result {
        Ok(()) | Err(Failure::Closed) => ExitCode::SUCCESS,
        Err(Failure::Said) => ExitCode::FAILURE,
        Err(Failure::Error(text)) => {
            report(&text);
            ExitCode::FAILURE
        }
    }
}
