//! The programs in `benches/inputs`: those of `rung gen` in the sizes that the literature measured.

/// Their rungs.
pub(crate) const INPUTS: [u32; 2] = [18, 1451];

/// The text of one.
pub(crate) fn text(rungs: u32) -> String {
    let path = format!("{}/benches/inputs/{rungs}.rung", env!("CARGO_MANIFEST_DIR"));
    std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{path}: {error}"))
}
