//! Reading a program's file, in whatever format it is, or the folder of a project.

mod project;

use std::io::Read;
use std::path::Path;

use super::{Failure, report};
use crate::check::Checked;
use crate::diagnostic::{self, Code};
use crate::load::Loaded;
use crate::source::{MAXIMUM_BYTES, Source};

/// A text file that is no program, such as stimuli or a map.
pub(crate) fn read_source(path: &Path) -> Result<Source, Failure> {
    Source::decode(path.display().to_string(), read_bytes(path)?)
        .map_err(|undecoded| Failure::diagnostics(&undecoded.0, &[undecoded.1]))
}

/// The bytes of a file, or of the standard input for `-`; no more than one past [`MAXIMUM_BYTES`].
fn read_bytes(path: &Path) -> Result<Vec<u8>, Failure> {
    let most = MAXIMUM_BYTES as u64 + 1;
    let mut bytes = Vec::new();
    let read = if path == Path::new("-") {
        std::io::stdin().lock().take(most).read_to_end(&mut bytes)
    } else {
        std::fs::File::open(path).and_then(|file| {
            let length = file.metadata().map_or(0, |metadata| metadata.len().min(most));
            // Less of it only means that the buffer has to grow.
            let _ = bytes.try_reserve_exact(usize::try_from(length).unwrap_or(0) + 1);
            file.take(most).read_to_end(&mut bytes)
        })
    };
    match read {
        Ok(_) => Ok(bytes),
        Err(error) => Err(Failure::new(Code::CannotRead, format!("{} cannot be read: {error}", path.display()))),
    }
}

/// Reads and parses a program.
///
/// # Errors
/// When the file cannot be read. What is wrong inside it is in [`Loaded::diagnostics`].
pub(crate) fn load(path: &Path) -> Result<Loaded, Failure> {
    if path.is_dir() {
        return Ok(Loaded::parse(project::read(path)?));
    }
    Ok(Loaded::decode(path.display().to_string(), read_bytes(path)?))
}

/// Whether a program runs without what Rung has not.
#[derive(Clone, Copy, Debug, clap::Args)]
pub(crate) struct Missing {
    /// Run a program of another tool without the elements that Rung has not; no power passes where they were
    #[arg(long)]
    allow_missing: bool,
}

/// Reads, parses and checks a program that is to run; warnings are printed.
///
/// # Errors
/// When it cannot be read or has an error.
pub(crate) fn load_checked(path: &Path, missing: Missing) -> Result<(Loaded, Checked), Failure> {
    let mut loaded = load(path)?;
    match loaded.check_to_run(missing.allow_missing) {
        Some(checked) => {
            report(&diagnostic::render(&loaded.source, &loaded.diagnostics));
            Ok((loaded, checked))
        }
        None => Err(Failure::diagnostics(&loaded.source, &loaded.diagnostics)),
    }
}
