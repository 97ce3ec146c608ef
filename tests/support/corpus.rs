//! Where the files are that strangers wrote: in the folder that `RUNG_CORPUS` names, else in `shared/corpus` beside the
//! checkout. They are not part of the project, and a test that needs them says so where they are not there.

use std::path::{Path, PathBuf};

/// The folder, where there is one.
pub(crate) fn folder() -> Option<PathBuf> {
    let beside = || Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/corpus");
    let folder = std::env::var_os("RUNG_CORPUS").map_or_else(beside, PathBuf::from);
    folder.is_dir().then_some(folder)
}
