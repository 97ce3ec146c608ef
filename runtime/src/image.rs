//! The parts of a process image that the runtime itself touches.
//!
//! It knows runs of bytes and which of them are BOOLs, and nothing of variables. It must never let the field
//! reach beyond the inputs and outputs.

use core::ops::Range;

/// A run of inputs, in bytes from the start of the image.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Extent {
    /// All of it.
    pub bytes: Range<u32>,
    /// The part that holds BOOLs, each of which is one byte and must be 0 or 1 in a scan.
    pub bools: Range<u32>,
}

/// Where inputs, outputs and retained variables lie in an image.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Regions<'a> {
    inputs: &'a [Extent],
    outputs: &'a [Range<u32>],
    retained: &'a [Range<u32>],
    size: u32,
}

/// Runs that overlap, are out of order or reach outside the image.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct BadRegions;

impl<'a> Regions<'a> {
    /// The regions of an image of `size` bytes; each list in order of place.
    ///
    /// # Errors
    /// [`BadRegions`]
    pub fn new(
        inputs: &'a [Extent],
        outputs: &'a [Range<u32>],
        retained: &'a [Range<u32>],
        size: u32,
    ) -> Result<Self, BadRegions> {
        let within = |run: &Extent| run.bytes.start <= run.bools.start && run.bools.end <= run.bytes.end;
        let sound = ordered(inputs.iter().map(|run| &run.bytes), size)
            && inputs.iter().all(|run| run.bools.start <= run.bools.end && within(run))
            && ordered(outputs, size)
            && ordered(retained, size);
        if sound { Ok(Self { inputs, outputs, retained, size }) } else { Err(BadRegions) }
    }

    /// The runs that are copied in before a scan.
    pub fn inputs(&self) -> &'a [Extent] {
        self.inputs
    }

    /// The runs that are copied out after a scan.
    pub fn outputs(&self) -> &'a [Range<u32>] {
        self.outputs
    }

    /// The runs that are kept while the power is off.
    pub fn retained(&self) -> &'a [Range<u32>] {
        self.retained
    }

    /// Bytes of the whole image.
    pub fn size(&self) -> u32 {
        self.size
    }

    /// Makes every BOOL among the inputs 0 or 1: a field may deliver any byte, the program computes with bits.
    pub(crate) fn normalise(&self, image: &mut [u8]) {
        for run in self.inputs {
            for bool in &mut image[index(&run.bools)] {
                *bool = u8::from(*bool != 0);
            }
        }
    }
}

fn ordered<'r>(runs: impl IntoIterator<Item = &'r Range<u32>>, size: u32) -> bool {
    let mut end = 0;
    runs.into_iter().all(|run| {
        let follows = end <= run.start && run.start <= run.end && run.end <= size;
        end = run.end;
        follows
    })
}

fn index(run: &Range<u32>) -> Range<usize> {
    run.start as usize..run.end as usize
}

/// The inputs of an image, for the field to fill.
#[derive(Debug)]
pub struct Inputs<'a> {
    image: &'a mut [u8],
    extents: &'a [Extent],
}

impl<'a> Inputs<'a> {
    pub(crate) fn new(regions: &Regions<'a>, image: &'a mut [u8]) -> Self {
        Self { image, extents: regions.inputs }
    }

    /// Every run in order: where it starts in the image, and its bytes, which hold the last scan's values.
    pub fn runs(&mut self) -> impl Iterator<Item = (u32, &mut [u8])> {
        let (mut rest, mut at) = (&mut *self.image, 0);
        self.extents.iter().map(move |extent| {
            let bytes = index(&extent.bytes);
            let (run, behind) = core::mem::take(&mut rest)[bytes.start - at..].split_at_mut(bytes.len());
            (rest, at) = (behind, bytes.end);
            (extent.bytes.start, run)
        })
    }
}

/// The outputs of an image, for the field to take.
#[derive(Clone, Copy, Debug)]
pub struct Outputs<'a> {
    image: &'a [u8],
    runs: &'a [Range<u32>],
}

impl<'a> Outputs<'a> {
    pub(crate) fn new(regions: &Regions<'a>, image: &'a [u8]) -> Self {
        Self { image, runs: regions.outputs }
    }

    /// Every run in order: where it starts in the image, and its bytes.
    pub fn runs(&self) -> impl Iterator<Item = (u32, &'a [u8])> {
        let image = self.image;
        self.runs.iter().map(move |run| (run.start, &image[index(run)]))
    }
}
