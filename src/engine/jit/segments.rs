//! Executable memory for the [lanes](crate::engine::lanes): installed and called as chunks are, but on words.
#![expect(unsafe_code, reason = "calling compiled code is the JIT's purpose")]

use std::io;

use memmap2::{Mmap, MmapMut};

use super::memory::synchronise;
use crate::engine::lanes::{Code, Through, VECTORS, Word};

/// The type of a function: the words, the row of stamps, and the turns.
type Function = unsafe extern "C" fn(*mut Word, *mut Word, i64);

/// Installed segments.
#[derive(Debug)]
pub(in crate::engine) struct Segments {
    /// Each with what it may reach from its two pointers, and the vectors that a turn goes through.
    functions: Vec<(Function, Through, usize)>,
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
            (unsafe { std::mem::transmute::<*const u8, Function>(code) }, segment.through, segment.vectors)
        };
        let functions = segments.iter().zip(&starts).map(function).collect();
        Ok(Self { functions, _pages: Some(pages) })
    }

    /// Runs a segment, on so many words one after the other, and so many vectors of each.
    ///
    /// # Panics
    /// When there are fewer words, or fewer of a row, than the segment was made for and is moved on by; or no vectors, or
    /// more than a word has.
    #[inline]
    pub(in crate::engine) fn run(
        &self,
        segment: usize,
        words: &mut [Word],
        row: &mut [Word],
        [count, vectors]: [usize; 2],
    ) {
        let (function, Through { reach, moves }, of_a_turn) = self.functions[segment];
        let last = |moves: bool| if moves { count.saturating_sub(1) } else { 0 };
        let fits = words.len() >= reach[0] + last(moves[0]) && row.len() >= reach[1] + last(moves[1]);
        let whole = count > 0 && (1..=VECTORS).contains(&vectors) && VECTORS.is_multiple_of(of_a_turn);
        assert!(fits && whole, "too few words for the program");
        let turns = i64::try_from(((count - 1) * VECTORS + vectors).div_ceil(of_a_turn)).unwrap_or(i64::MAX);
        // SAFETY: in each turn the function reads and writes vectors, aligned as such, of the words below its two reaches,
        // and moves the pointers on by those vectors, or not at all, `count` words at the most; both slices are as long.
        // They are borrowed mutably, so that nobody else sees them, and are apart.
        unsafe { function(words.as_mut_ptr(), row.as_mut_ptr(), turns) }
    }
}
