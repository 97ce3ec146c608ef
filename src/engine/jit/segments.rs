//! Executable memory for the [lanes](crate::engine::lanes): installed and called as chunks are, but on words.
#![expect(unsafe_code, reason = "calling compiled code is the JIT's purpose")]

use std::io;

use memmap2::{Mmap, MmapMut};

use super::memory::synchronise;
use crate::engine::lanes::{Code, VECTORS, Word};

/// The type of a function: the words, the row of stamps, and the turns.
type Function = unsafe extern "C" fn(*mut Word, *mut Word, i64);

/// Installed segments.
#[derive(Debug)]
pub(in crate::engine) struct Segments {
    /// Each with the words that it may reach from its two pointers, and the vectors that a turn goes through.
    functions: Vec<(Function, [usize; 2], usize)>,
    /// Where `functions` point to; `None` without any.
    _pages: Option<Mmap>,
}

impl Segments {
    /// Copies segments into memory of their own.
    pub(in crate::engine) fn install(segments: &[Code]) -> io::Result<Self> {
        let mut starts = Vec::with_capacity(segments.len());
        let mut size = 0usize;
        for segment in segments {
            size = size.next_multiple_of(segment.alignment as usize);
            starts.push(size);
            size += segment.bytes.len();
        }
        if size == 0 {
            return Ok(Self { functions: Vec::new(), _pages: None });
        }
        let mut pages = MmapMut::map_anon(size)?;
        for (segment, start) in segments.iter().zip(&starts) {
            pages[*start..start + segment.bytes.len()].copy_from_slice(&segment.bytes);
        }
        let pages = pages.make_exec()?;
        synchronise(&pages)?;
        let function = |(segment, start): (&Code, &usize)| {
            let code = pages[*start..].as_ptr();
            // SAFETY: at `code` lies the whole of a function that was compiled for this machine with the signature
            // `Function` and the C calling convention; `_pages` keeps it there as long as the function is known.
            (unsafe { std::mem::transmute::<*const u8, Function>(code) }, segment.reach, segment.vectors)
        };
        let functions = segments.iter().zip(&starts).map(function).collect();
        Ok(Self { functions, _pages: Some(pages) })
    }

    /// Runs a segment, on so many vectors of each word.
    ///
    /// # Panics
    /// When there are fewer words, or fewer of a row, than the segment was made for; or no vectors, or more than a word
    /// has.
    #[inline]
    pub(in crate::engine) fn run(&self, segment: usize, words: &mut [Word], row: &mut [Word], vectors: usize) {
        let (function, [reach, row_reach], of_a_turn) = self.functions[segment];
        let fits = words.len() >= reach && row.len() >= row_reach && VECTORS.is_multiple_of(of_a_turn);
        assert!(fits && (1..=VECTORS).contains(&vectors), "too few words for the program");
        let turns = i64::try_from(vectors.div_ceil(of_a_turn)).unwrap_or(i64::MAX);
        // SAFETY: in each of its turns, which together go through no more vectors than a word has, the function reads and
        // writes vectors, aligned as such, of each of the words below its two reaches; both slices are as long. They are
        // borrowed mutably, so that nobody else sees them, and are apart.
        unsafe { function(words.as_mut_ptr(), row.as_mut_ptr(), turns) }
    }
}
