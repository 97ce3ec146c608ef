//! Replays: what a run was given, scan by scan, so that it can be run again.
//!
//! A scan is a pure function of the image, the inputs and `now`; so an image and, from there on, the inputs and
//! `now` of every scan are all there is to know. `rung run --engine both` leaves a replay where the engines
//! differ, `rung sim --replay` runs it. The file is JSON:
//!
//! ```json
//! {
//!   "format": "rung-replay-1",
//!   "program": "examples/pump.rung",
//!   "source_hash": "8c1f0a5be7d34411",
//!   "layout_hash": "03d5b6c2a9e8f701",
//!   "byte_order": "little",
//!   "reason": "delay.ET: 20 ms interpreted, 10 ms compiled",
//!   "start_image": null,
//!   "scans": [{ "now": 0, "inputs": "0100" }, { "now": 10000000, "inputs": "0100" }]
//! }
//! ```
//!
//! Bytes and hashes are in hexadecimal digits, two a byte. This module must never read or write a file, and
//! must never panic, whatever the text.

mod recorder;

use std::fmt::Write as _;

use serde::{Deserialize, Serialize};

pub use recorder::Recorder;

use crate::diagnostic::{Code, Diagnostic};
use crate::logic::Layout;
use crate::source::{Source, Span};

const FORMAT: &str = "rung-replay-1";
const BYTE_ORDER: &str = if cfg!(target_endian = "little") { "little" } else { "big" };

/// One recorded run, or the end of one.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Replay {
    /// The program's file, as it was given to the run.
    pub program: String,
    /// [`source_hash`] of its text.
    pub source_hash: u64,
    /// [`Layout::hash`] of its image.
    pub layout_hash: u64,
    /// Why it was recorded, for people; may be empty.
    pub reason: String,
    /// The whole image before the inputs of the first scan were copied in; `None` is the layout's initial image.
    pub start_image: Option<Vec<u8>>,
    /// The scans, in order.
    pub scans: Vec<RecordedScan>,
}

/// What one scan was given.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct RecordedScan {
    /// Nanoseconds since the controller started.
    pub now: i64,
    /// The bytes of [`Layout::inputs`], one run behind the other, with every BOOL 0 or 1.
    pub inputs: Vec<u8>,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    format: String,
    program: String,
    source_hash: String,
    layout_hash: String,
    byte_order: String,
    #[serde(default)]
    reason: String,
    start_image: Option<String>,
    scans: Vec<FileScan>,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct FileScan {
    now: i64,
    inputs: String,
}

impl Replay {
    /// Reads a replay's text.
    ///
    /// # Errors
    /// A [`Code::BadReplay`] where the text is none, or was recorded in another byte order. Whether it fits a
    /// program is for [`Replay::check`] to say.
    pub fn parse(source: &Source) -> Result<Self, Diagnostic> {
        let file: File = serde_json::from_str(source.text()).map_err(|error| {
            let line = source.line_range(error.line().saturating_sub(1)).unwrap_or_default();
            let at = (line.start + error.column().saturating_sub(1)).min(source.text().len());
            Diagnostic::new(Code::BadReplay, Span::new(at, at), error.to_string())
        })?;
        if file.format != FORMAT {
            return Err(bad(format!("its format is {:?}, not {FORMAT:?}", file.format)));
        }
        if file.byte_order != BYTE_ORDER {
            let message =
                format!("it was recorded in byte order {:?}; this machine's is {BYTE_ORDER:?}", file.byte_order);
            return Err(bad(message));
        }
        let scan = |(index, scan): (usize, &FileScan)| {
            let inputs = bytes_of(&scan.inputs)
                .ok_or_else(|| bad(format!("the inputs of scan {index} are no hexadecimal bytes")))?;
            Ok(RecordedScan { now: scan.now, inputs })
        };
        let start_image = file
            .start_image
            .as_deref()
            .map(|text| bytes_of(text).ok_or_else(|| bad("start_image is no hexadecimal bytes")));
        Ok(Self {
            source_hash: hash_of(&file.source_hash).ok_or_else(|| bad("source_hash is not 16 hexadecimal digits"))?,
            layout_hash: hash_of(&file.layout_hash).ok_or_else(|| bad("layout_hash is not 16 hexadecimal digits"))?,
            start_image: start_image.transpose()?,
            scans: file.scans.iter().enumerate().map(scan).collect::<Result<_, Diagnostic>>()?,
            program: file.program,
            reason: file.reason,
        })
    }

    /// The replay as text, which [`Replay::parse`] reads back.
    pub fn to_json(&self) -> String {
        let file = File {
            format: FORMAT.to_owned(),
            program: self.program.clone(),
            source_hash: format!("{:016x}", self.source_hash),
            layout_hash: format!("{:016x}", self.layout_hash),
            byte_order: BYTE_ORDER.to_owned(),
            reason: self.reason.clone(),
            start_image: self.start_image.as_deref().map(hexadecimal),
            scans: self
                .scans
                .iter()
                .map(|scan| FileScan { now: scan.now, inputs: hexadecimal(&scan.inputs) })
                .collect(),
        };
        // Strings and integers always have a JSON form.
        let mut text = serde_json::to_string_pretty(&file).unwrap_or_default();
        text.push('\n');
        text
    }

    /// Whether it can be run over an image of this layout.
    ///
    /// # Errors
    /// A [`Code::BadReplay`] when it is of another layout, or an image or a scan's inputs are of another size.
    pub fn check(&self, layout: &Layout) -> Result<(), Diagnostic> {
        if self.layout_hash != layout.hash() {
            let message =
                format!("it is of a program whose image is laid out otherwise (recorded from {})", self.program);
            return Err(bad(message).hint("the program's variables or blocks were changed since"));
        }
        if let Some(image) = self.start_image.as_ref().filter(|image| image.len() != layout.size() as usize) {
            return Err(bad(format!("its start image has {} bytes, not {}", image.len(), layout.size())));
        }
        let size = input_bytes(layout);
        match self.scans.iter().position(|scan| scan.inputs.len() != size) {
            Some(index) => {
                let found = self.scans[index].inputs.len();
                Err(bad(format!("scan {index} has {found} bytes of inputs, not {size}")))
            }
            None => Ok(()),
        }
    }

    /// The image that the first scan starts from.
    pub fn first_image(&self, layout: &Layout) -> Vec<u8> {
        self.start_image.clone().unwrap_or_else(|| layout.initial_image())
    }
}

impl RecordedScan {
    /// Copies the inputs into an image, as the runtime did before this scan. BOOLs become 0 or 1, whatever the
    /// file says.
    ///
    /// # Panics
    /// When [`Replay::check`] does not pass for this layout, or the image is not of it.
    pub fn copy_in(&self, layout: &Layout, image: &mut [u8]) {
        let mut rest = self.inputs.as_slice();
        for run in layout.inputs() {
            let (bytes, behind) = rest.split_at(run.bytes.len());
            image[run.bytes.start as usize..run.bytes.end as usize].copy_from_slice(bytes);
            for bool in &mut image[run.bools.start as usize..run.bools.end as usize] {
                *bool = u8::from(*bool != 0);
            }
            rest = behind;
        }
    }
}

/// What names a program's text: FNV-1a, 64 bits.
pub fn source_hash(source: &Source) -> u64 {
    let step = |hash: u64, byte: u8| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01B3);
    source.text().bytes().fold(0xCBF2_9CE4_8422_2325, step)
}

/// Bytes that all input runs have together.
pub fn input_bytes(layout: &Layout) -> usize {
    layout.inputs().iter().map(|run| run.bytes.len()).sum()
}

fn bad(message: impl Into<String>) -> Diagnostic {
    Diagnostic::new(Code::BadReplay, Span::default(), message)
}

fn hexadecimal(bytes: &[u8]) -> String {
    bytes.iter().fold(String::with_capacity(bytes.len() * 2), |mut text, byte| {
        // Writing to a string cannot fail.
        let _ = write!(text, "{byte:02x}");
        text
    })
}

fn bytes_of(text: &str) -> Option<Vec<u8>> {
    let digit = |byte: u8| char::from(byte).to_digit(16).and_then(|digit| u8::try_from(digit).ok());
    let (pairs, rest) = text.as_bytes().as_chunks::<2>();
    rest.is_empty().then(|| pairs.iter().map(|[high, low]| Some(digit(*high)? << 4 | digit(*low)?)).collect())?
}

fn hash_of(text: &str) -> Option<u64> {
    let digits = text.len() == 16 && text.bytes().all(|byte| byte.is_ascii_hexdigit());
    u64::from_str_radix(text, 16).ok().filter(|_| digits)
}

#[cfg(test)]
mod tests;
