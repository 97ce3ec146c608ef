//! What the command prints and writes, and how it fails.

use std::fs::File;
use std::io::{self, BufWriter, ErrorKind, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use tempfile::NamedTempFile;

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
    /// Someone asked it to end before it was done; there is nothing to say, and the exit code is 130.
    Interrupted,
}

impl Failure {
    /// A coded error that belongs to no place in a source.
    pub(crate) fn new(code: Code, message: impl AsRef<str>) -> Self {
        Self::Error(format!("error[{code}]: {}\n", message.as_ref()))
    }

    /// The same, with what to do about it.
    pub(crate) fn hinted(code: Code, message: impl AsRef<str>, hint: impl AsRef<str>) -> Self {
        Self::Error(format!("error[{code}]: {}\n  = hint: {}\n", message.as_ref(), hint.as_ref()))
    }

    /// Diagnostics about one source.
    pub(crate) fn diagnostics(source: &Source, diagnostics: &[Diagnostic]) -> Self {
        Self::Error(diagnostic::render(source, diagnostics))
    }
}

/// Prints to the standard output, without a line break of its own.
pub(crate) fn print(text: &str) -> Result<(), Failure> {
    let mut stdout = io::stdout().lock();
    stdout
        .write_all(text.as_bytes())
        .and_then(|()| stdout.flush())
        .map_err(|error| cannot_write(Path::new("-"), &error))
}

/// Prints to the standard error stream; that it cannot be written is no reason to stop.
pub(crate) fn report(text: &str) {
    let _ = io::stderr().lock().write_all(text.as_bytes());
}

/// Writes a file whole or not at all, see [`WholeFile`].
pub(crate) fn write_whole(path: &Path, bytes: &[u8]) -> Result<(), Failure> {
    let mut file = WholeFile::create(path)?;
    file.write_all(bytes).map_err(|error| cannot_write(path, &error))?;
    file.finish()
}

/// A file that is written bit by bit, and whole or not at all: what is written goes to a temporary file beside it,
/// which takes its name at the end. `-` is the standard output, which like a device has no whole to replace.
#[derive(Debug)]
pub(crate) struct WholeFile {
    path: PathBuf,
    sink: Sink,
}

#[derive(Debug)]
enum Sink {
    Stdout(BufWriter<io::Stdout>),
    Device(BufWriter<File>),
    Temporary(BufWriter<NamedTempFile>),
}

impl WholeFile {
    /// Starts a file; nothing is seen of it before [`WholeFile::finish`]. A link stays one, and what it points to is
    /// written.
    pub(crate) fn create(path: &Path) -> Result<Self, Failure> {
        let linked = path.is_symlink().then(|| path.canonicalize()).and_then(Result::ok);
        let path = linked.as_deref().unwrap_or(path);
        let create = || -> io::Result<Sink> {
            if path == Path::new("-") {
                return Ok(Sink::Stdout(BufWriter::new(io::stdout())));
            }
            if path.metadata().is_ok_and(|metadata| !metadata.is_file()) {
                return Ok(Sink::Device(BufWriter::new(File::options().write(true).open(path)?)));
            }
            let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
            let made = tempfile::Builder::new().permissions(permissions(path)).tempfile_in(folder);
            let file = made.map_err(without_path)?;
            Ok(Sink::Temporary(BufWriter::new(file)))
        };
        let sink = create().map_err(|error| cannot_write(path, &error))?;
        Ok(Self { path: path.to_owned(), sink })
    }

    /// Gives the file its name, with all that was written.
    pub(crate) fn finish(self) -> Result<(), Failure> {
        let Self { path, sink } = self;
        let finish = || -> io::Result<()> {
            match sink {
                Sink::Stdout(mut out) => out.flush(),
                Sink::Device(mut out) => out.flush(),
                Sink::Temporary(out) => {
                    let file = out.into_inner().map_err(io::IntoInnerError::into_error)?;
                    file.as_file().sync_all()?;
                    file.persist(&path).map_err(|error| error.error)?;
                    Ok(())
                }
            }
        };
        finish().map_err(|error| cannot_write(&path, &error))
    }
}

impl Write for WholeFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match &mut self.sink {
            Sink::Stdout(out) => out.write(bytes),
            Sink::Device(out) => out.write(bytes),
            Sink::Temporary(out) => out.write(bytes),
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        match &mut self.sink {
            Sink::Stdout(out) => out.flush(),
            Sink::Device(out) => out.flush(),
            Sink::Temporary(out) => out.flush(),
        }
    }
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

/// An error without the name of the temporary file, which whoever asked for a file has never heard of.
fn without_path(error: io::Error) -> io::Error {
    // `tempfile` gives the system's error behind its own only as text.
    match error.to_string().split_once(" at path ") {
        Some((what, _)) => io::Error::new(error.kind(), what),
        None => error,
    }
}

/// A failure to write a file; that the standard output is closed is none.
pub(crate) fn cannot_write(path: &Path, error: &io::Error) -> Failure {
    if path == Path::new("-") {
        return match error.kind() {
            ErrorKind::BrokenPipe => Failure::Closed,
            _ => Failure::new(Code::CannotWrite, format!("the standard output cannot be written: {error}")),
        };
    }
    Failure::new(Code::CannotWrite, format!("{} cannot be written: {error}", path.display()))
}

/// The exit code of a finished subcommand, with its last words printed.
pub(super) fn exit(result: Result<(), Failure>) -> ExitCode {
    match result {
        Ok(()) | Err(Failure::Closed) => ExitCode::SUCCESS,
        Err(Failure::Said) => ExitCode::FAILURE,
        Err(Failure::Interrupted) => ExitCode::from(130),
        Err(Failure::Error(text)) => {
            report(&text);
            ExitCode::FAILURE
        }
    }
}
