//! Executable memory: chunks are copied in, the pages become executable and read-only, and they are called.
//!
//! Pages are never writable and executable at once, and are given back when dropped.
#![expect(unsafe_code, reason = "calling compiled code is the JIT's purpose")]

use std::io;
use std::ops::Range;
use std::sync::Arc;

use memmap2::{Mmap, MmapMut};

use crate::engine::clif::{BASES, Chunk};
use crate::engine::helpers::{COPY, HELPERS, HelperFunction};

/// The type of a chunk's function: the image at each base, with the time second.
type Function = unsafe extern "C" fn(*mut u8, i64, *mut u8, *mut u8, *mut u8, *mut u8);

/// The type of the function of a chunk that calls helpers: it takes the table of them, too.
type HelpedFunction = unsafe extern "C" fn(*mut u8, i64, *mut u8, *mut u8, *mut u8, *mut u8, *const Table);

/// The table of helpers, as chunks expect it.
#[repr(C)]
struct Table {
    functions: [HelperFunction; COPY],
    copy: unsafe extern "C" fn(*mut u8, *const u8, usize),
}

/// What chunks that call helpers are given.
static TABLE: Table = Table { functions: HELPERS, copy };

/// Copies the elements of an array.
unsafe extern "C" fn copy(to: *mut u8, from: *const u8, count: usize) {
    // SAFETY: a chunk passes the first bytes of two arrays of its layout, both `count` bytes long, in the image that it
    // was called with; see `Code::run`.
    unsafe { std::ptr::copy(from, to, count) }
}

/// Bytes of code up to which it is taken to stay in the second level of the cache from scan to scan. What is larger comes
/// from further away in every scan, once and in order, which processors do not foresee for instructions.
const CACHED: usize = 512 << 10;

/// Bytes of code from which on large pages are asked for: one of x86-64's.
const LARGE: usize = 2 << 20;

/// Installed code.
#[derive(Debug)]
pub(super) struct Code {
    calls: Vec<Call>,
    /// Whether it is fetched ahead, a chunk before it runs.
    fetched_ahead: bool,
    /// Bytes that an image must have.
    reach: usize,
    /// The function of the only chunk, where that takes no pointer but the image: most programs are so small that finding and
    /// preparing a call would cost as much as their rungs.
    only: Option<Function>,
}

#[derive(Clone, Copy, Debug)]
enum Entry {
    Plain(Function),
    Helped(HelpedFunction),
}

/// The code of one chunk. What shares pages goes with the last of it.
#[derive(Clone, Debug)]
pub(super) struct Call {
    entry: Entry,
    bases: [u32; BASES],
    /// Where in `pages` the code is; `entry` points to its first byte.
    code: Range<usize>,
    pages: Arc<Mmap>,
}

impl Call {
    /// Copies chunks into memory of their own, one behind the other.
    pub(super) fn install(chunks: &[Chunk]) -> io::Result<Vec<Self>> {
        let mut starts = Vec::with_capacity(chunks.len());
        let mut size = 0usize;
        for chunk in chunks {
            size = size.next_multiple_of(chunk.alignment as usize);
            starts.push(size);
            size += chunk.code.len();
        }
        if size == 0 {
            return Ok(Vec::new());
        }
        // Systems lay what is a multiple of a large page at one.
        let mut pages = MmapMut::map_anon(if size < LARGE { size } else { size.next_multiple_of(LARGE) })?;
        if size >= LARGE {
            ask_for_large_pages(&pages);
        }
        for (chunk, start) in chunks.iter().zip(&starts) {
            pages[*start..start + chunk.code.len()].copy_from_slice(&chunk.code);
        }
        let pages = pages.make_exec()?;
        synchronise(&pages)?;
        let pages = Arc::new(pages);
        let call = |(chunk, start): (&Chunk, &usize)| {
            let range = *start..*start + chunk.code.len();
            let code = pages[range.clone()].as_ptr();
            let entry = if chunk.calls_helpers {
                // SAFETY: as below, with the signature `HelpedFunction`, which chunks that call helpers have.
                Entry::Helped(unsafe { std::mem::transmute::<*const u8, HelpedFunction>(code) })
            } else {
                // SAFETY: at `code` lies the whole of a function that Cranelift compiled for this machine with the
                // signature `Function` and the C calling convention; `pages` keeps it there as long as the call.
                Entry::Plain(unsafe { std::mem::transmute::<*const u8, Function>(code) })
            };
            Self { entry, bases: chunk.bases, code: range, pages: Arc::clone(&pages) }
        };
        Ok(chunks.iter().zip(&starts).map(call).collect())
    }

    /// Has the code brought near, while others run.
    #[cfg(target_arch = "x86_64")]
    fn fetch(&self) {
        use std::arch::x86_64::{_MM_HINT_T1, _mm_prefetch};

        const LINE: usize = 64;
        for line in self.pages[self.code.clone()].chunks(LINE) {
            // SAFETY: a hint, which faults nowhere; every processor of x86-64 has it.
            unsafe { _mm_prefetch::<_MM_HINT_T1>(line.as_ptr().cast()) }
        }
    }

    #[cfg(not(target_arch = "x86_64"))]
    fn fetch(&self) {}
}

impl Code {
    /// Chunks to be run on images of at least `image_size` bytes, for which they were made.
    pub(super) fn new(calls: Vec<Call>, image_size: usize) -> Self {
        let only = match calls.as_slice() {
            [Call { entry: Entry::Plain(function), bases, .. }] if *bases == [0; BASES] => Some(*function),
            _ => None,
        };
        let fetched_ahead = calls.iter().map(|call| call.code.len()).sum::<usize>() > CACHED;
        Self { calls, fetched_ahead, reach: image_size, only }
    }

    /// The code of each chunk.
    pub(super) fn calls(&self) -> &[Call] {
        &self.calls
    }

    /// Runs all chunks in order.
    ///
    /// # Panics
    /// When the image is too short.
    #[inline]
    pub(super) fn run_all(&self, image: &mut [u8], now: i64) {
        let Some(function) = self.only else { return self.run(0..self.calls.len(), image, now) };
        assert!(image.len() >= self.reach, "the image is shorter than the program's layout");
        let image = image.as_mut_ptr();
        // SAFETY: as in `run`; the chunk's bases are all the image itself, and `calls` keeps its pages.
        unsafe { function(image, now, image, image, image, image) }
    }

    /// Runs some chunks in order.
    ///
    /// # Panics
    /// When the image is too short.
    #[inline(never)]
    pub(super) fn run(&self, chunks: Range<usize>, image: &mut [u8], now: i64) {
        assert!(image.len() >= self.reach, "the image is shorter than the program's layout");
        let image = image.as_mut_ptr();
        let calls = &self.calls[chunks];
        for (index, Call { entry, bases: [a, b, c, d, e], .. }) in calls.iter().enumerate() {
            if self.fetched_ahead
                && let Some(next) = calls.get(index + 1)
            {
                next.fetch();
            }
            let at = |base: u32| image.wrapping_add(base as usize);
            let (a, b, c, d, e) = (at(*a), at(*b), at(*c), at(*d), at(*e));
            // SAFETY: the chunk reads and writes the slots of its layout, at the pointers' offsets from the image,
            // and of BOOLs up to 3 bytes more; all are below the layout's size, and the image is as long. The
            // image is borrowed mutably, so that nobody else sees it. The table has a function for every helper, of
            // the type that chunks call, and lasts for ever.
            unsafe {
                match entry {
                    Entry::Plain(function) => function(a, now, b, c, d, e),
                    Entry::Helped(function) => function(a, now, b, c, d, e, &raw const TABLE),
                }
            }
        }
    }
}

/// Has the system use large pages, of which the processor can remember more; they are not needed.
fn ask_for_large_pages(pages: &MmapMut) {
    #[cfg(target_os = "linux")]
    let _ = pages.advise(memmap2::Advice::HugePage);
    #[cfg(not(target_os = "linux"))]
    let _ = pages;
}

/// Makes the processor fetch what was written: x86-64 does so by itself.
#[cfg(target_arch = "x86_64")]
#[expect(clippy::unnecessary_wraps, reason = "elsewhere it can fail")]
pub(super) fn synchronise(_: &Mmap) -> io::Result<()> {
    Ok(())
}

/// Makes the processor, on every core, fetch what was written.
#[cfg(not(target_arch = "x86_64"))]
pub(super) fn synchronise(pages: &Mmap) -> io::Result<()> {
    // SAFETY: the range is mapped and readable.
    let cleared = unsafe { wasmtime_internal_jit_icache_coherence::clear_cache(pages.as_ptr().cast(), pages.len()) };
    cleared
        .and_then(|()| wasmtime_internal_jit_icache_coherence::pipeline_flush_mt())
        .map_err(|error| io::Error::other(error.to_string()))
}
