//! Executable memory for the [lanes](crate::engine::lanes): installed and called as chunks are, but on words.
#![expect(unsafe_code, reason = "calling compiled code is the JIT's purpose")]

use std::io;

use memmap2::{Mmap, MmapMut};

use super::memory::synchronise;
use crate::engine::lanes::{Code, Word};

/// The type of a segment's function: the words, and the row of codes.
type Function = unsafe extern "C" fn(*mut Word, *mut Word);

/// Installed segments.
#[derive(Debug)]
pub(in crate::engine) struct Segments {
    functions: Vec<Function>,
    /// Words that a segment may reach, and those of a row.
    words: usize,
    row: usize,
    /// Where `functions` point to; `None` without any.
    _pages: Option<Mmap>,
}

impl Segments {
    /// Copies segments into memory of their own, for so many words and so many of a row.
    pub(in crate::engine) fn install(segments: &[Code], words: usize, row: usize) -> io::Result<Self> {
        let mut starts = Vec::with_capacity(segments.len());
        let mut size = 0usize;
        for segment in segments {
            size = size.next_multiple_of(segment.alignment as usize);
            starts.push(size);
            size += segment.bytes.len();
        }
        if size == 0 {
            return Ok(Self { functions: Vec::new(), words, row, _pages: None });
        }
        let mut pages = MmapMut::map_anon(size)?;
        for (segment, start) in segments.iter().zip(&starts) {
            pages[*start..start + segment.bytes.len()].copy_from_slice(&segment.bytes);
        }
        let pages = pages.make_exec()?;
        synchronise(&pages)?;
        let function = |start: &usize| {
            let code = pages[*start..].as_ptr();
            // SAFETY: at `code` lies the whole of a function that Cranelift compiled for this machine with the signature
            // `Function` and the C calling convention; `_pages` keeps it there as long as the function is known.
            unsafe { std::mem::transmute::<*const u8, Function>(code) }
        };
        let functions = starts.iter().map(function).collect();
        Ok(Self { functions, words, row, _pages: Some(pages) })
    }

    /// Runs a segment.
    ///
    /// # Panics
    /// When there are fewer words, or fewer of a row, than the segments were made for.
    #[inline]
    pub(in crate::engine) fn run(&self, segment: usize, words: &mut [Word], row: &mut [Word]) {
        assert!(words.len() >= self.words && row.len() >= self.row, "too few words for the program");
        // SAFETY: a segment reads and writes whole words, aligned as such: of the first pointer those of its plan, which
        // has `self.words`, and of the second those of a row, which has `self.row`; both slices are as long. They are
        // borrowed mutably, so that nobody else sees them, and apart.
        unsafe { self.functions[segment](words.as_mut_ptr(), row.as_mut_ptr()) }
    }
}
