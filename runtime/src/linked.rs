//! A built program, from Rust: what `rung build` wrote as an object file or as C, linked into this firmware.
//!
//! [`program!`](crate::program) names the symbols of one prefix, which is the only promise that has to be made; all else
//! is checked here before a foreign function is called: the version of the interface, the size of the image and its
//! alignment, the layout of retained bytes. Nothing here may allocate, or know a variable: the map and the header that
//! `rung build` writes say where each lies.
#![expect(unsafe_code, reason = "calling what was linked is this module's purpose")]

use core::ffi::c_void;
use core::fmt;
#[cfg(target_has_atomic = "8")]
use core::sync::atomic::{AtomicBool, Ordering};

use crate::Scan;

/// The version of the C interface that this module speaks: what `P_abi_version` must be.
pub const ABI_VERSION: u32 = 1;

/// Alignment of an image's first byte.
pub const IMAGE_ALIGNMENT: usize = 8;

/// The functions and constants of one prefix.
#[doc(hidden)]
#[derive(Clone, Copy, Debug)]
pub struct Symbols {
    pub init: unsafe extern "C" fn(*mut c_void, *const c_void),
    pub save: unsafe extern "C" fn(*const c_void, *mut c_void),
    pub scan: unsafe extern "C" fn(*mut c_void, i64),
    pub tick: unsafe extern "C" fn(),
    pub cycle: unsafe extern "C" fn(*mut c_void),
    pub image: *mut c_void,
    pub image_size: &'static u32,
    pub retain_offset: &'static u32,
    pub retain_size: &'static u32,
    pub layout_hash: &'static u64,
    pub abi_version: &'static u32,
}

/// A program that is linked into this one; [`program!`](crate::program) makes it.
#[derive(Debug)]
pub struct Linked {
    symbols: Symbols,
    /// Whether the ready-made image was given away.
    #[cfg(target_has_atomic = "8")]
    taken: AtomicBool,
}

// SAFETY: the functions may be called from anywhere, each with an image of its own, and the constants never change; the
// ready-made image is given away once only.
unsafe impl Sync for Linked {}

/// What retained variables held, and which layout says where each lies.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Retained<'a> {
    /// [`Linked::layout_hash`] of the program that saved them.
    pub layout_hash: u64,
    /// What [`Instance::save`] wrote.
    pub bytes: &'a [u8],
}

/// Why a linked program cannot be used so.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[non_exhaustive]
pub enum LinkError {
    /// It was built for another version of the interface than [`ABI_VERSION`].
    OtherAbi {
        /// Its version.
        found: u32,
    },
    /// There is too little memory for the image.
    TooSmall {
        /// Bytes that it needs.
        needed: usize,
        /// Bytes that there are.
        found: usize,
    },
    /// The memory does not start at a multiple of [`IMAGE_ALIGNMENT`].
    Misaligned,
    /// Retained bytes are of a program whose image is laid out otherwise.
    OtherLayout,
    /// There are too few or too many retained bytes.
    RetainedSize {
        /// Bytes that the program retains.
        needed: usize,
        /// Bytes that there are.
        found: usize,
    },
}

impl fmt::Display for LinkError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::OtherAbi { found } => {
                write!(f, "the program's interface has version {found}, and {ABI_VERSION} is the one that is known")
            }
            Self::TooSmall { needed, found } => write!(f, "the image needs {needed} bytes, and there are {found}"),
            Self::Misaligned => write!(f, "the image does not start at a multiple of {IMAGE_ALIGNMENT}"),
            Self::OtherLayout => f.write_str("the retained bytes are of an image that is laid out otherwise"),
            Self::RetainedSize { needed, found } => {
                write!(f, "the program retains {needed} bytes, and there are {found}")
            }
        }
    }
}

impl core::error::Error for LinkError {}

impl Linked {
    /// The program of these symbols.
    ///
    /// # Safety
    /// They must be those that `rung build` wrote under one prefix, from an object or a C file of one build.
    #[doc(hidden)]
    pub const unsafe fn new(symbols: Symbols) -> Self {
        Self {
            symbols,
            #[cfg(target_has_atomic = "8")]
            taken: AtomicBool::new(false),
        }
    }

    /// Bytes of an image.
    pub fn image_size(&self) -> usize {
        *self.symbols.image_size as usize
    }

    /// Where the first retained byte lies in the image; 0 where nothing is retained.
    pub fn retain_offset(&self) -> usize {
        *self.symbols.retain_offset as usize
    }

    /// Bytes that [`Instance::save`] writes.
    pub fn retain_size(&self) -> usize {
        *self.symbols.retain_size as usize
    }

    /// What names the layout of the image: it is in the map and the header, too.
    pub fn layout_hash(&self) -> u64 {
        *self.symbols.layout_hash
    }

    /// A tick period has passed: call this from the timer interrupt, and from nowhere else. It is one addition to a
    /// 32-bit counter, which all images of the program share.
    pub fn tick(&self) {
        // SAFETY: it takes nothing, and stores to the counter only, in one piece.
        unsafe { (self.symbols.tick)() }
    }

    /// The image that the program brings with it, which is of the right size; the first time only.
    #[cfg(target_has_atomic = "8")]
    pub fn take_image(&self) -> Option<&'static mut [u8]> {
        if self.taken.swap(true, Ordering::Relaxed) {
            return None;
        }
        // SAFETY: the image has that many bytes, lasts for ever, and nobody has it but who comes first.
        Some(unsafe { core::slice::from_raw_parts_mut(self.symbols.image.cast(), self.image_size()) })
    }

    /// Makes an image of the program in some memory, of which it uses as much as it needs: every variable at its initial
    /// value, or with what was retained, at time 0. There may be several.
    ///
    /// # Errors
    /// [`LinkError`]; the memory is not touched then.
    pub fn start<'m>(
        &'static self,
        memory: &'m mut [u8],
        retained: Option<Retained<'_>>,
    ) -> Result<Instance<'m>, LinkError> {
        self.check(memory)?;
        let retained = match retained {
            None => core::ptr::null(),
            Some(Retained { layout_hash, .. }) if layout_hash != self.layout_hash() => {
                return Err(LinkError::OtherLayout);
            }
            Some(Retained { bytes, .. }) if bytes.len() != self.retain_size() => {
                return Err(LinkError::RetainedSize { needed: self.retain_size(), found: bytes.len() });
            }
            Some(Retained { bytes, .. }) => bytes.as_ptr(),
        };
        let image = &mut memory[..self.image_size()];
        // SAFETY: the image is of the program's size and aligned, and borrowed mutably; the retained bytes are none, or as
        // many as the program reads.
        unsafe { (self.symbols.init)(image.as_mut_ptr().cast(), retained.cast()) }
        Ok(Instance { program: self, image })
    }

    /// Whether memory can hold an image, and the program can be called at all.
    fn check(&self, memory: &[u8]) -> Result<(), LinkError> {
        let found = *self.symbols.abi_version;
        if found != ABI_VERSION {
            return Err(LinkError::OtherAbi { found });
        }
        let (needed, found) = (self.image_size(), memory.len());
        if found < needed {
            return Err(LinkError::TooSmall { needed, found });
        }
        // Not `align_offset`, which may say that it does not know.
        if memory.as_ptr().addr().is_multiple_of(IMAGE_ALIGNMENT) { Ok(()) } else { Err(LinkError::Misaligned) }
    }
}

/// The scan alone, for a [`ScanLoop`](crate::ScanLoop) that has a field and ticks of its own. The image is one that
/// [`Linked::start`] made: see [`Instance::into_image`].
///
/// # Panics
/// When an image is too short or not aligned, or the program is of another version of the interface.
impl Scan for &Linked {
    fn scan(&mut self, image: &mut [u8], now: i64) {
        if let Err(error) = self.check(image) {
            panic!("{error}");
        }
        // SAFETY: the image has the program's size and alignment, and is borrowed mutably.
        unsafe { (self.symbols.scan)(image.as_mut_ptr().cast(), now) }
    }
}

/// One image of a linked program, which runs.
#[derive(Debug)]
pub struct Instance<'m> {
    program: &'static Linked,
    /// Of the program's size, and aligned.
    image: &'m mut [u8],
}

impl<'m> Instance<'m> {
    /// Runs one cycle at the time that [`Linked::tick`] has counted since the start. Every BOOL among the inputs becomes
    /// 0 or 1 first.
    pub fn cycle(&mut self) {
        // SAFETY: the image has the program's size and alignment, and is borrowed mutably.
        unsafe { (self.program.symbols.cycle)(self.image.as_mut_ptr().cast()) }
    }

    /// Runs one scan at `now`, nanoseconds since the start, for those who keep their own time. Every BOOL must be 0 or 1.
    pub fn scan(&mut self, now: i64) {
        // SAFETY: as in `cycle`.
        unsafe { (self.program.symbols.scan)(self.image.as_mut_ptr().cast(), now) }
    }

    /// Writes what the retained variables hold, for [`Linked::start`] to take after a power failure.
    ///
    /// # Errors
    /// [`LinkError::RetainedSize`] when `retained` is not of [`Linked::retain_size`].
    pub fn save(&self, retained: &mut [u8]) -> Result<(), LinkError> {
        let (needed, found) = (self.program.retain_size(), retained.len());
        if found != needed {
            return Err(LinkError::RetainedSize { needed, found });
        }
        // SAFETY: the image has the program's size and alignment, and there is room for as many bytes as it retains.
        unsafe { (self.program.symbols.save)(self.image.as_ptr().cast(), retained.as_mut_ptr().cast()) }
        Ok(())
    }

    /// The program.
    pub fn program(&self) -> &'static Linked {
        self.program
    }

    /// The image, for inputs to be put in and outputs to be taken. The map says what lies where.
    pub fn image(&mut self) -> &mut [u8] {
        self.image
    }

    /// Only the image, for a [`ScanLoop`](crate::ScanLoop) that scans it.
    pub fn into_image(self) -> &'m mut [u8] {
        self.image
    }
}

/// Memory for an image of up to `BYTES` bytes, aligned.
#[derive(Clone, Debug)]
#[repr(C, align(8))]
pub struct Memory<const BYTES: usize>([u8; BYTES]);

impl<const BYTES: usize> Memory<BYTES> {
    /// Memory that is all 0.
    pub const fn new() -> Self {
        Self([0; BYTES])
    }

    /// Its bytes, the first of which lies at a multiple of [`IMAGE_ALIGNMENT`].
    pub fn bytes(&mut self) -> &mut [u8] {
        &mut self.0
    }
}

impl<const BYTES: usize> Default for Memory<BYTES> {
    fn default() -> Self {
        Self::new()
    }
}

/// Names a program that is linked into this one, by its prefix, as a `static` of type [`Linked`].
///
/// The word `unsafe` is a promise: that what is linked under that prefix was made by `rung build`, all of it by one
/// build. Everything else about it is checked.
///
/// ```ignore
/// rung_runtime::program! {
///     /// The traffic light: `rung build traffic_light.rung --prefix light -o light.o`.
///     pub unsafe static LIGHT = "light";
/// }
///
/// fn timer_interrupt() {
///     LIGHT.tick();
/// }
///
/// fn main() -> Result<(), rung_runtime::LinkError> {
///     let mut memory = rung_runtime::Memory::<256>::new();
///     let mut light = LIGHT.start(memory.bytes(), None)?;
///     loop {
///         light.image()[NIGHT] = port::night();
///         light.cycle();
///         port::set_red(light.image()[RED]);
///     }
/// }
/// ```
#[macro_export]
macro_rules! program {
    ($(#[$attribute:meta])* $visibility:vis unsafe static $name:ident = $prefix:literal;) => {
        $(#[$attribute])*
        $visibility static $name: $crate::Linked = {
            unsafe extern "C" {
                #[link_name = concat!($prefix, "_init")]
                fn init(image: *mut ::core::ffi::c_void, retained: *const ::core::ffi::c_void);
                #[link_name = concat!($prefix, "_save")]
                fn save(image: *const ::core::ffi::c_void, retained: *mut ::core::ffi::c_void);
                #[link_name = concat!($prefix, "_scan")]
                fn scan(image: *mut ::core::ffi::c_void, now: i64);
                #[link_name = concat!($prefix, "_tick")]
                fn tick();
                #[link_name = concat!($prefix, "_cycle")]
                fn cycle(image: *mut ::core::ffi::c_void);
                #[link_name = concat!($prefix, "_image")]
                static mut image: u64;
                #[link_name = concat!($prefix, "_image_size")]
                static image_size: u32;
                #[link_name = concat!($prefix, "_retain_offset")]
                static retain_offset: u32;
                #[link_name = concat!($prefix, "_retain_size")]
                static retain_size: u32;
                #[link_name = concat!($prefix, "_layout_hash")]
                static layout_hash: u64;
                #[link_name = concat!($prefix, "_abi_version")]
                static abi_version: u32;
            }
            // SAFETY: whoever named the prefix promises that `rung build` wrote these symbols, with these types.
            unsafe {
                $crate::Linked::new($crate::Symbols {
                    init,
                    save,
                    scan,
                    tick,
                    cycle,
                    image: (&raw mut image).cast(),
                    image_size: &image_size,
                    retain_offset: &retain_offset,
                    retain_size: &retain_size,
                    layout_hash: &layout_hash,
                    abi_version: &abi_version,
                })
            }
        };
    };
}
