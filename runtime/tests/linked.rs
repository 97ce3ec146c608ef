//! A linked program, called through its symbols: here those of a counter that this test makes itself.
#![expect(unsafe_code, reason = "the test plays the part of an object that was built")]

use std::ffi::c_void;
use std::num::NonZeroU32;
use std::ptr;
use std::sync::atomic::{AtomicU32, Ordering};

use rung_runtime::{
    Clock, Extent, FieldIo, Inputs, LinkError, Memory, Outputs, Regions, Retained, ScanLoop, TickCounter, program,
};

/// Bytes: the input, the output, two retained, padding; then what `P_cycle` keeps.
const SIZE: usize = 24;
const HASH: u64 = 0xFEED;

static TICKS: AtomicU32 = AtomicU32::new(0);

fn image_of(image: *mut c_void) -> &'static mut [u8] {
    // SAFETY: the tests below hand in images of that size only.
    unsafe { std::slice::from_raw_parts_mut(image.cast(), SIZE) }
}

/// A program that adds its input to its output, and to what it retains the tenth part of the time.
#[unsafe(no_mangle)]
extern "C" fn fake_init(image: *mut c_void, retained: *const c_void) {
    let image = image_of(image);
    image.fill(0);
    image[1] = 100;
    if !retained.is_null() {
        // SAFETY: there are two retained bytes.
        image[2..4].copy_from_slice(unsafe { std::slice::from_raw_parts(retained.cast(), 2) });
    }
}

#[unsafe(no_mangle)]
extern "C" fn fake_save(image: *const c_void, retained: *mut c_void) {
    // SAFETY: there are two retained bytes at offset 2.
    unsafe { ptr::copy_nonoverlapping(image.cast::<u8>().add(2), retained.cast(), 2) }
}

#[unsafe(no_mangle)]
extern "C" fn fake_scan(image: *mut c_void, now: i64) {
    let image = image_of(image);
    image[1] += image[0];
    image[2] += u8::try_from(now / 10).unwrap_or(u8::MAX);
}

#[unsafe(no_mangle)]
extern "C" fn fake_tick() {
    TICKS.fetch_add(1, Ordering::Relaxed);
}

#[unsafe(no_mangle)]
extern "C" fn fake_cycle(image: *mut c_void) {
    fake_scan(image, i64::from(TICKS.load(Ordering::Relaxed)) * 10);
}

#[unsafe(no_mangle)]
static mut fake_image: [u64; SIZE / 8] = [0; SIZE / 8];
#[unsafe(no_mangle)]
static fake_image_size: u32 = 24;
#[unsafe(no_mangle)]
static fake_retain_offset: u32 = 2;
#[unsafe(no_mangle)]
static fake_retain_size: u32 = 2;
#[unsafe(no_mangle)]
static fake_layout_hash: u64 = HASH;
#[unsafe(no_mangle)]
static fake_abi_version: u32 = 1;

program! {
    /// The counter.
    unsafe static COUNTER = "fake";
}

/// The same of a later version of the interface, which must never be called.
mod later {
    use super::c_void;

    #[unsafe(no_mangle)]
    extern "C" fn later_init(_: *mut c_void, _: *const c_void) {
        unreachable!("it is of another version");
    }
    #[unsafe(no_mangle)]
    extern "C" fn later_save(_: *const c_void, _: *mut c_void) {
        unreachable!("it is of another version");
    }
    #[unsafe(no_mangle)]
    extern "C" fn later_scan(_: *mut c_void, _: i64) {
        unreachable!("it is of another version");
    }
    #[unsafe(no_mangle)]
    extern "C" fn later_tick() {}
    #[unsafe(no_mangle)]
    extern "C" fn later_cycle(_: *mut c_void) {
        unreachable!("it is of another version");
    }
    #[unsafe(no_mangle)]
    static mut later_image: [u64; 1] = [0];
    #[unsafe(no_mangle)]
    static later_image_size: u32 = 8;
    #[unsafe(no_mangle)]
    static later_retain_offset: u32 = 0;
    #[unsafe(no_mangle)]
    static later_retain_size: u32 = 0;
    #[unsafe(no_mangle)]
    static later_layout_hash: u64 = 0;
    #[unsafe(no_mangle)]
    static later_abi_version: u32 = 2;

    rung_runtime::program! {
        pub(super) unsafe static LATER = "later";
    }
}

#[test]
fn an_image_starts_runs_and_is_saved() {
    let mut memory = Memory::<64>::new();
    let mut counter = COUNTER.start(memory.bytes(), None).expect("nothing is wrong");
    assert_eq!(counter.image().len(), SIZE);
    counter.image()[0] = 3;
    counter.scan(20);
    counter.scan(30);
    assert_eq!(counter.image()[..4], [3, 106, 5, 0]);
    let mut kept = [0xFF; 2];
    assert_eq!(counter.save(&mut kept), Ok(()));
    assert_eq!(kept, [5, 0]);

    let mut memory = Memory::<SIZE>::default();
    let retained = Retained { layout_hash: COUNTER.layout_hash(), bytes: &kept };
    let mut counter = COUNTER.start(memory.bytes(), Some(retained)).expect("nothing is wrong");
    assert_eq!(counter.image()[..4], [0, 100, 5, 0]);
    let before = TICKS.load(Ordering::Relaxed);
    counter.program().tick();
    assert_eq!(TICKS.load(Ordering::Relaxed), before + 1);
    counter.cycle();
    assert!(counter.image()[2] > 5);
}

#[test]
fn the_constants_of_the_program_are_told() {
    let told = (COUNTER.image_size(), COUNTER.retain_offset(), COUNTER.retain_size(), COUNTER.layout_hash());
    assert_eq!(told, (24, 2, 2, HASH));
}

#[test]
fn the_image_that_the_program_brings_is_given_away_once() {
    let image = COUNTER.take_image().expect("the first");
    assert_eq!(image.len(), SIZE);
    assert!(COUNTER.start(image, None).is_ok());
    assert!(COUNTER.take_image().is_none());
}

#[test]
fn memory_that_cannot_hold_an_image_is_refused_and_not_touched() {
    let mut memory = Memory::<64>::new();
    memory.bytes().fill(9);
    let refused = COUNTER.start(&mut memory.bytes()[..23], None).err();
    assert_eq!(refused, Some(LinkError::TooSmall { needed: 24, found: 23 }));
    for start in 1..8 {
        assert_eq!(COUNTER.start(&mut memory.bytes()[start..], None).err(), Some(LinkError::Misaligned));
    }
    assert!(memory.bytes().iter().all(|byte| *byte == 9));
    assert!(COUNTER.start(&mut memory.bytes()[8..32], None).is_ok());
    assert_eq!(memory.bytes()[32], 9);
}

#[test]
fn retained_bytes_of_another_layout_or_size_are_refused() {
    let mut memory = Memory::<SIZE>::new();
    let mut start = |layout_hash, bytes| COUNTER.start(memory.bytes(), Some(Retained { layout_hash, bytes })).err();
    assert_eq!(start(HASH + 1, &[1, 2]), Some(LinkError::OtherLayout));
    assert_eq!(start(HASH, &[1]), Some(LinkError::RetainedSize { needed: 2, found: 1 }));
    assert_eq!(start(HASH, &[]), Some(LinkError::RetainedSize { needed: 2, found: 0 }));
    assert_eq!(start(HASH, &[1, 2]), None);
    let counter = COUNTER.start(memory.bytes(), None).expect("nothing is wrong");
    assert_eq!(counter.save(&mut [0; 3]), Err(LinkError::RetainedSize { needed: 2, found: 3 }));
}

#[test]
fn a_program_of_another_version_is_never_called() {
    let mut memory = Memory::<64>::new();
    let error = later::LATER.start(memory.bytes(), None).err();
    assert_eq!(error, Some(LinkError::OtherAbi { found: 2 }));
    let message = error.map(|error| error.to_string());
    assert_eq!(message.as_deref(), Some("the program's interface has version 2, and 1 is the one that is known"));
}

/// A field of one input and one output.
struct Field<'o>(u8, &'o mut Vec<u8>);

impl FieldIo for Field<'_> {
    type Error = std::convert::Infallible;

    fn copy_in(&mut self, mut inputs: Inputs<'_>) -> Result<(), Self::Error> {
        inputs.runs().for_each(|(_, bytes)| bytes.fill(self.0));
        Ok(())
    }

    fn copy_out(&mut self, outputs: Outputs<'_>) -> Result<(), Self::Error> {
        outputs.runs().for_each(|(_, bytes)| self.1.extend(bytes));
        Ok(())
    }

    fn outputs_off(&mut self) -> Result<(), Self::Error> {
        self.1.push(0);
        Ok(())
    }
}

struct StandingClock;

impl Clock for StandingClock {
    fn nanoseconds(&self) -> u64 {
        0
    }
}

#[test]
fn a_scan_loop_runs_it_with_a_field_and_ticks_of_its_own() {
    let mut memory = Memory::<SIZE>::new();
    let image = COUNTER.start(memory.bytes(), None).expect("nothing is wrong").into_image();
    let inputs = [Extent { bytes: 0..1, bools: 0..1 }];
    const OUTPUTS: std::ops::Range<u32> = 1..2;
    let outputs = std::slice::from_ref(&OUTPUTS);
    let regions = Regions::new(&inputs, outputs, &[], 24).expect("sound regions");
    let ticks = TickCounter::new(NonZeroU32::new(10).expect("not zero"));
    let mut out = Vec::new();
    let mut scan_loop = ScanLoop::new(&COUNTER, Field(0xFF, &mut out), &ticks, StandingClock, 1, regions, image);
    assert!(scan_loop.cycle().is_ok());
    ticks.tick();
    assert!(scan_loop.cycle().is_ok());
    assert_eq!(scan_loop.image()[..3], [1, 102, 1]);
    drop(scan_loop);
    assert_eq!(out, [101, 102, 0]);
}

#[test]
#[should_panic(expected = "the image needs 24 bytes, and there are 8")]
fn a_scan_of_an_image_that_is_too_short_panics_before_the_call() {
    rung_runtime::Scan::scan(&mut &COUNTER, Memory::<8>::new().bytes(), 0);
}
