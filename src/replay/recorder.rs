//! Recording the end of a run in bounded memory.
//!
//! Scans are logged in two halves; when the newer one is full, the older is forgotten and the image is kept as
//! the start of a new half. Recording a scan must never allocate.

use rung_runtime::Scan;

use super::{RecordedScan, Replay, input_bytes};
use crate::logic::Layout;

/// The most scans that one half holds.
const MOST_SCANS: usize = 1 << 12;
/// The most bytes of inputs that one half holds, as long as that is room for one scan.
const MOST_BYTES: usize = 1 << 22;

/// A scan whose inputs and times are recorded.
#[derive(Debug)]
pub struct Recorder<S> {
    scan: S,
    input_runs: Vec<std::ops::Range<usize>>,
    input_bytes: usize,
    most_scans: usize,
    older: Half,
    newer: Half,
}

/// Some scans and the image before them.
#[derive(Debug)]
struct Half {
    image: Vec<u8>,
    times: Vec<i64>,
    inputs: Vec<u8>,
}

impl Half {
    fn new(image: Vec<u8>, scans: usize, input_bytes: usize) -> Self {
        Self { image, times: Vec::with_capacity(scans), inputs: Vec::with_capacity(scans * input_bytes) }
    }

    fn clear(&mut self) {
        self.times.clear();
        self.inputs.clear();
    }
}

impl<S: Scan> Recorder<S> {
    /// Records a program's scans.
    pub fn new(scan: S, layout: &Layout) -> Self {
        let input_bytes = input_bytes(layout);
        Self::with_room(scan, layout, (MOST_BYTES / input_bytes.max(1)).clamp(1, MOST_SCANS))
    }

    pub(super) fn with_room(scan: S, layout: &Layout, most_scans: usize) -> Self {
        let input_bytes = input_bytes(layout);
        let half = || Half::new(layout.initial_image(), most_scans, input_bytes);
        let run = |run: &crate::logic::image::Extent| run.bytes.start as usize..run.bytes.end as usize;
        let input_runs = layout.inputs().iter().map(run).collect();
        Self { scan, input_runs, input_bytes, most_scans, older: half(), newer: half() }
    }

    /// What is recorded.
    pub fn recorded(&self) -> &S {
        &self.scan
    }

    /// The last scans, some thousands at most unless the run has fewer, and the image before them.
    pub fn replay(&self, program: String, source_hash: u64, layout: &Layout, reason: String) -> Replay {
        let scans = |half: &Half| {
            let inputs = |index: usize| half.inputs[index * self.input_bytes..(index + 1) * self.input_bytes].to_vec();
            let scan = |(index, now): (usize, &i64)| RecordedScan { now: *now, inputs: inputs(index) };
            half.times.iter().enumerate().map(scan).collect::<Vec<_>>()
        };
        let start = if self.older.times.is_empty() { &self.newer } else { &self.older };
        Replay {
            program,
            source_hash,
            layout_hash: layout.hash(),
            reason,
            start_image: (start.image != layout.initial_image()).then(|| start.image.clone()),
            scans: [scans(&self.older), scans(&self.newer)].concat(),
        }
    }
}

impl<S: Scan> Scan for Recorder<S> {
    fn scan(&mut self, image: &mut [u8], now: i64) {
        if self.newer.times.len() == self.most_scans {
            std::mem::swap(&mut self.older, &mut self.newer);
            self.newer.clear();
        }
        if self.newer.times.is_empty() {
            // The inputs in it are this scan's already; they are copied in again when it is replayed.
            self.newer.image.copy_from_slice(image);
        }
        self.newer.times.push(now);
        for run in &self.input_runs {
            self.newer.inputs.extend_from_slice(&image[run.clone()]);
        }
        self.scan.scan(image, now);
    }

    fn trusted(&self) -> bool {
        self.scan.trusted()
    }
}
