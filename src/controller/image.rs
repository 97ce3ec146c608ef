//! The image of a program that runs: its memory, and its runs as the runtime takes them.

use std::ops::Range;

use rung_runtime::{BadRegions, Extent, Regions};

use crate::logic::Layout;
use crate::logic::image::ALIGNMENT;

/// The runs of a layout, as the runtime takes them.
#[derive(Clone, Debug)]
pub(crate) struct Runs {
    inputs: Vec<Extent>,
    outputs: Vec<Range<u32>>,
    retained: Vec<Range<u32>>,
    size: u32,
}

impl Runs {
    pub(crate) fn new(layout: &Layout) -> Self {
        let inputs = layout.inputs().iter();
        Self {
            inputs: inputs.map(|run| Extent { bytes: run.bytes.clone(), bools: run.bools.clone() }).collect(),
            outputs: layout.outputs().to_vec(),
            retained: layout.retained().to_vec(),
            size: layout.size(),
        }
    }

    pub(crate) fn regions(&self) -> Result<Regions<'_>, BadRegions> {
        Regions::new(&self.inputs, &self.outputs, &self.retained, self.size)
    }
}

/// An image whose first byte is aligned as engines want it.
#[derive(Debug)]
pub(crate) struct Aligned {
    bytes: Vec<u8>,
    start: usize,
    size: usize,
}

impl Aligned {
    pub(crate) fn new(image: &[u8]) -> Self {
        let alignment = ALIGNMENT as usize;
        let mut bytes = vec![0; image.len() + alignment];
        let start = bytes.as_ptr().align_offset(alignment).min(alignment);
        bytes[start..start + image.len()].copy_from_slice(image);
        Self { bytes, start, size: image.len() }
    }

    pub(crate) fn bytes(&self) -> &[u8] {
        &self.bytes[self.start..self.start + self.size]
    }

    pub(crate) fn bytes_mut(&mut self) -> &mut [u8] {
        &mut self.bytes[self.start..self.start + self.size]
    }
}
