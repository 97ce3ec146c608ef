//! Reading the folder of an OpenPLC project: `project.json`, its data types and its units.

use std::path::{Path, PathBuf};

use super::read_source;
use crate::cli::Failure;
use crate::diagnostic::Code;
use crate::source::{MAXIMUM_BYTES, Source};

/// Folders with the files that a program is made of; others hold devices, servers and what was built.
const FOLDERS: [&str; 4] = ["datatypes", "pous/functions", "pous/function-blocks", "pous/programs"];
/// How such files end. The last is how early projects keep units.
const ENDINGS: [&str; 8] = ["dt", "st", "ld", "fbd", "il", "py", "cpp", "json"];
/// How many files a project may have, and how deep folders in it may nest.
const MOST_FILES: usize = 10_000;
const MOST_DEPTH: usize = 8;

/// The files of a project as one source.
///
/// # Errors
/// When the folder holds no project, or a file of it cannot be read.
pub(super) fn read(folder: &Path) -> Result<Source, Failure> {
    let described = folder.join("project.json");
    if !described.is_file() {
        let message = format!("{} is a folder without a project.json", folder.display());
        return Err(Failure::new(Code::CannotRead, message));
    }
    let mut paths = vec![described];
    for inner in FOLDERS {
        find(&folder.join(inner), 0, &mut paths)?;
    }
    let mut files = Vec::new();
    let mut bytes = 0;
    for path in &paths {
        let source = read_source(path)?;
        bytes += source.text().len() + 1;
        if bytes > MAXIMUM_BYTES {
            let message = format!("the files of {} have more than {MAXIMUM_BYTES} bytes together", folder.display());
            return Err(Failure::new(Code::FileTooLarge, message));
        }
        files.push((source.name().to_owned(), source.text().to_owned()));
    }
    Ok(Source::joined(folder.display().to_string(), files))
}

/// Adds the files of a folder, in the order of their names; a folder that is not there has none.
fn find(folder: &Path, depth: usize, paths: &mut Vec<PathBuf>) -> Result<(), Failure> {
    let Ok(entries) = std::fs::read_dir(folder) else { return Ok(()) };
    let mut found: Vec<PathBuf> = entries.filter_map(|entry| Some(entry.ok()?.path())).collect();
    found.sort();
    for path in found {
        let ending = path.extension().and_then(|ending| ending.to_str()).unwrap_or("");
        if path.is_dir() {
            if depth < MOST_DEPTH {
                find(&path, depth + 1, paths)?;
            }
        } else if ENDINGS.contains(&ending) {
            if paths.len() >= MOST_FILES {
                let message = format!("{} has more than {MOST_FILES} files", folder.display());
                return Err(Failure::new(Code::FileTooLarge, message));
            }
            paths.push(path);
        }
    }
    Ok(())
}
