//! Source files and places in them.
//!
//! A [`Source`] is one file's text; a [`Span`] is a byte range of one. Everything that a person wrote keeps
//! its span to the end, so that a diagnostic, a report or a generated comment can name the line.
//! This module must never read a file: bytes come in from the caller.

mod encoding;

use std::fmt;
use std::ops::Range;
use std::sync::OnceLock;

use crate::diagnostic::{Code, Diagnostic};

/// The largest source, in bytes: 256 MiB, far above any drawing and well within [`Span`]'s 32 bits.
pub const MAXIMUM_BYTES: usize = 256 << 20;

/// A byte range of one source: `start` is included, `end` is not.
#[derive(Clone, Copy, Default, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Span {
    /// First byte.
    pub start: u32,
    /// One past the last byte.
    pub end: u32,
}

impl Span {
    /// The range `start..end` in bytes.
    pub fn new(start: usize, end: usize) -> Self {
        let clamp = |offset: usize| u32::try_from(offset).unwrap_or(u32::MAX);
        Self { start: clamp(start), end: clamp(end) }
    }

    /// The smallest span that covers both.
    #[must_use]
    pub fn to(self, other: Self) -> Self {
        Self { start: self.start.min(other.start), end: self.end.max(other.end) }
    }

    /// The span as a range for indexing.
    pub fn range(self) -> Range<usize> {
        self.start as usize..self.end as usize
    }
}

impl fmt::Debug for Span {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}..{}", self.start, self.end)
    }
}

/// One source file, or the files of a folder: its name as the user gave it and its text, valid UTF-8 without a byte order mark.
#[derive(Clone, Debug)]
pub struct Source {
    name: String,
    text: String,
    /// Found when a line is first asked for: most sources have nothing to tell of.
    line_starts: OnceLock<Vec<u32>>,
    /// The files that it is made of, where it is more than one: where each starts, and its name.
    files: Vec<(u32, String)>,
}

impl Source {
    /// A source from text. Text above [`MAXIMUM_BYTES`] is for [`Source::decode`] to refuse.
    pub fn new(name: impl Into<String>, text: impl Into<String>) -> Self {
        Self { name: name.into(), text: text.into(), line_starts: OnceLock::new(), files: Vec::new() }
    }

    /// The files of a folder as one source, one behind the other, each starting on a line of its own. Their names are kept, so
    /// that diagnostics name the file and count its lines. Together they may have [`MAXIMUM_BYTES`].
    pub fn joined(name: impl Into<String>, files: impl IntoIterator<Item = (String, String)>) -> Self {
        let mut text = String::new();
        let mut starts = Vec::new();
        for (file, content) in files {
            if !text.is_empty() && !text.ends_with('\n') {
                text.push('\n');
            }
            starts.push((Span::new(text.len(), text.len()).start, file));
            text.push_str(&content);
        }
        Self { files: starts, ..Self::new(name, text) }
    }

    /// The files that it is made of, each with its name and its bytes; most sources are one file.
    pub fn files(&self) -> impl Iterator<Item = (&str, Range<usize>)> {
        let one = self.files.is_empty().then_some((self.name(), 0..self.text.len()));
        let ends = self.files.iter().skip(1).map(|(start, _)| *start as usize).chain([self.text.len()]);
        let many = self.files.iter().zip(ends).map(|((start, name), end)| (name.as_str(), *start as usize..end));
        one.into_iter().chain(many)
    }

    /// Which of its files a byte stands in, by its place among them.
    pub fn file_at(&self, byte: u32) -> usize {
        self.files.partition_point(|(start, _)| *start <= byte).saturating_sub(1)
    }

    /// The name of one of its files, and the place of its first line among all lines, from 0.
    pub fn file(&self, file: usize) -> (&str, usize) {
        self.files.get(file).map_or((self.name(), 0), |(start, name)| (name.as_str(), self.line(*start) - 1))
    }

    /// A source from a file's bytes: UTF-8, UTF-16 with a byte order mark, or Latin-1 where an XML header says so.
    ///
    /// # Errors
    /// A source that holds the readable part, with a diagnostic at the first bad byte, when the bytes are not
    /// such text, hold a NUL, or are more than [`MAXIMUM_BYTES`].
    pub fn decode(name: impl Into<String>, bytes: impl Into<Vec<u8>>) -> Result<Self, Box<(Self, Diagnostic)>> {
        let (name, mut bytes) = (name.into(), bytes.into());
        if bytes.len() <= MAXIMUM_BYTES
            && let Some((text, whole)) = encoding::other(&bytes)
        {
            let at = Span::new(text.len(), text.len());
            if !whole {
                let problem = Diagnostic::new(Code::NotText, at, "what stands here is not UTF-16 text");
                return Err(Box::new((Self::new(name, text), problem.hint("save the file as UTF-8"))));
            }
            return Self::without_nul(name, text);
        }
        if bytes.starts_with(b"\xEF\xBB\xBF") {
            bytes.drain(..3);
        }
        if bytes.len() > MAXIMUM_BYTES {
            let problem =
                Diagnostic::new(Code::FileTooLarge, Span::default(), format!("this file has {} bytes", bytes.len()))
                    .hint(format!("a source may have at most {MAXIMUM_BYTES} bytes"));
            return Err(Box::new((Self::new(name, ""), problem)));
        }
        match String::from_utf8(bytes) {
            Err(error) => {
                let good = error.utf8_error().valid_up_to();
                let good = String::from_utf8_lossy(&error.as_bytes()[..good]).into_owned();
                let at = Span::new(good.len(), good.len());
                let problem =
                    Diagnostic::new(Code::NotText, at, "a byte here is not UTF-8 text").hint("save the file as UTF-8");
                Err(Box::new((Self::new(name, good), problem)))
            }
            Ok(text) => Self::without_nul(name, text),
        }
    }

    fn without_nul(name: String, mut text: String) -> Result<Self, Box<(Self, Diagnostic)>> {
        let Some(at) = memchr::memchr(0, text.as_bytes()) else { return Ok(Self::new(name, text)) };
        text.truncate(at);
        let problem = Diagnostic::new(Code::NotText, Span::new(at, at), "a NUL byte stands here")
            .hint("this looks like a binary file");
        Err(Box::new((Self::new(name, text), problem)))
    }

    /// The name as the user gave it.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The whole text.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// The text of one span; empty where the span is not of this source.
    pub fn slice(&self, span: Span) -> &str {
        self.text.get(span.range()).unwrap_or("")
    }

    fn line_starts(&self) -> &[u32] {
        self.line_starts.get_or_init(|| {
            let ends = memchr::memchr_iter(b'\n', self.text.as_bytes()).map(|at| Span::new(at + 1, at + 1).start);
            std::iter::once(0).chain(ends).collect()
        })
    }

    /// The line (from 1) in which a byte stands.
    pub fn line(&self, byte: u32) -> usize {
        self.line_starts().partition_point(|start| *start <= byte)
    }

    /// The byte range of a line (from 0), its line break included; `None` past the last line.
    pub fn line_range(&self, line: usize) -> Option<Range<usize>> {
        let start = *self.line_starts().get(line)? as usize;
        let end = self.line_starts().get(line + 1).map_or(self.text.len(), |next| *next as usize);
        Some(start..end)
    }
}
