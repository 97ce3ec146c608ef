//! Reading a program's file, in whatever format it is, or the folder of a project.

mod project;

use std::io::Read;
use std::path::Path;

use super::{Failure, report};
use crate::check::{Checked, check};
use crate::diagnostic::{self, Code, Diagnostic, any_error};
use crate::frontend::{self, Parsed, leave_out};
use crate::ladder::Program;
use crate::source::{MAXIMUM_BYTES, Source};

/// A file that was read and parsed, with or without errors.
#[derive(Debug)]
pub(crate) struct Loaded {
    /// The file.
    pub source: Source,
    /// The program, as far as it could be read.
    pub program: Program,
    /// What the front end said.
    pub diagnostics: Vec<Diagnostic>,
}

/// A text file that is no program, such as stimuli or a map.
pub(crate) fn read_source(path: &Path) -> Result<Source, Failure> {
    Source::decode(path.display().to_string(), &read_bytes(path)?)
        .map_err(|undecoded| Failure::diagnostics(&undecoded.0, &[undecoded.1]))
}

/// The bytes of a file, or of the standard input for `-`; no more than one past [`MAXIMUM_BYTES`].
fn read_bytes(path: &Path) -> Result<Vec<u8>, Failure> {
    let most = MAXIMUM_BYTES as u64 + 1;
    let mut bytes = Vec::new();
    let read = if path == Path::new("-") {
        std::io::stdin().lock().take(most).read_to_end(&mut bytes)
    } else {
        std::fs::File::open(path).and_then(|file| file.take(most).read_to_end(&mut bytes))
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
        let source = project::read(path)?;
        let Parsed { program, diagnostics } = frontend::parse(&source);
        return Ok(Loaded { source, program, diagnostics });
    }
    let bytes = read_bytes(path)?;
    let (source, undecoded) = match Source::decode(path.display().to_string(), &bytes) {
        Ok(source) => (source, None),
        Err(undecoded) => (undecoded.0, Some(undecoded.1)),
    };
    drop(bytes);
    let Parsed { program, mut diagnostics } = frontend::parse(&source);
    if let Some(problem) = undecoded {
        // What the parser says of the readable part would only distract.
        diagnostics = vec![problem];
    }
    Ok(Loaded { source, program, diagnostics })
}

impl Loaded {
    /// Checks what there is of the program, with everything that there is to say about it. What Rung has not is left out, and
    /// the rest checked; where the front end found other errors, what the rest would mean is guesswork.
    pub(crate) fn check(&mut self) -> Option<Checked> {
        if self.diagnostics.iter().any(|found| found.is_error() && found.code != Code::NotSupported) {
            return None;
        }
        self.diagnostics.extend(leave_out(&mut self.program));
        let (checked, found) = check(&self.program);
        self.diagnostics.extend(found);
        checked
    }
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
    let checked = loaded.check();
    if missing.allow_missing {
        for found in loaded.diagnostics.iter_mut().filter(|found| found.code == Code::NotSupported) {
            found.code = Code::LeftOut;
        }
    }
    match checked {
        Some(checked) if !any_error(&loaded.diagnostics) => {
            report(&diagnostic::render(&loaded.source, &loaded.diagnostics));
            Ok((loaded, checked))
        }
        _ => Err(Failure::diagnostics(&loaded.source, &loaded.diagnostics)),
    }
}
