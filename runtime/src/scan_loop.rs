//! The scan loop's one cycle: copy in, latch the time, scan, copy out; and outputs off as soon as anything is wrong.
//!
//! One `now` holds for the whole scan. Outputs leave only from the image, and only after a scan that ended in
//! time and may be trusted. A loop that has stopped never runs again. No cycle may allocate.

use crate::{FieldIo, Inputs, Latch, Outputs, Regions, Scan, TickSource};

/// A clock to measure scans with, which may be finer than the ticks. No program sees it.
pub trait Clock {
    /// Nanoseconds since any fixed moment; never less than before.
    fn nanoseconds(&self) -> u64;
}

/// A program, its image, its field and its time: what a soft PLC runs cyclically, in real time.
///
/// It knows bytes only; who wants variables by name, typed values and no field at all takes `rung::Controller`, and
/// gets one of these over it for real time.
#[derive(Debug)]
pub struct ScanLoop<'a, S, F: FieldIo, T, C> {
    scan: S,
    field: F,
    ticks: Latch<T>,
    clock: C,
    watchdog: u64,
    regions: Regions<'a>,
    image: &'a mut [u8],
    running: bool,
}

/// One cycle that went well.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Cycle {
    /// The time that the scan saw, in nanoseconds since the loop started.
    pub now: i64,
    /// Nanoseconds from before the copy in to after the copy out.
    pub took: u64,
}

/// Why a loop stopped.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Fault<E> {
    /// The inputs could not be copied in.
    Input(E),
    /// The outputs could not be copied out.
    Output(E),
    /// A cycle took longer than the watchdog allows, in nanoseconds.
    Watchdog {
        /// How long it took.
        took: u64,
        /// How long it may take.
        limit: u64,
    },
    /// The scan does not trust its own result.
    Distrusted,
    /// It had stopped before.
    AlreadyStopped,
}

/// A loop that stopped by itself.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Stopped<E> {
    /// Why.
    pub fault: Fault<E>,
    /// Whether all outputs are known to be off.
    pub outputs_off: Result<(), E>,
}

impl<'a, S: Scan, F: FieldIo, T: TickSource, C: Clock> ScanLoop<'a, S, F, T, C> {
    /// A loop at time 0 that is ready for its first cycle.
    ///
    /// `image` holds what every variable starts with; `watchdog` is how many nanoseconds a cycle may take.
    ///
    /// # Panics
    /// When `image` is not of the size that `regions` are for.
    pub fn new(
        scan: S,
        field: F,
        ticks: T,
        clock: C,
        watchdog: u64,
        regions: Regions<'a>,
        image: &'a mut [u8],
    ) -> Self {
        assert_eq!(image.len(), regions.size() as usize, "the image is of another size");
        Self { scan, field, ticks: Latch::new(ticks), clock, watchdog, regions, image, running: true }
    }

    /// Runs one cycle.
    ///
    /// # Errors
    /// The fault that stopped the loop. The outputs are off then, unless the field says that it failed.
    pub fn cycle(&mut self) -> Result<Cycle, Stopped<F::Error>> {
        if !self.running {
            return Err(Stopped { fault: Fault::AlreadyStopped, outputs_off: Ok(()) });
        }
        self.run().map_err(|fault| Stopped { fault, outputs_off: self.stop() })
    }

    fn run(&mut self) -> Result<Cycle, Fault<F::Error>> {
        let began = self.clock.nanoseconds();
        self.field.copy_in(Inputs::new(&self.regions, self.image)).map_err(Fault::Input)?;
        self.regions.normalise(self.image);
        let ticks = self.ticks.latch();
        let now = self.ticks.nanoseconds(ticks);
        // The image is borrowed for as long as there is a controller: nobody else can have written to it.
        self.scan.scan_inputs(self.image, now);
        if !self.scan.trusted() {
            return Err(Fault::Distrusted);
        }
        // Before the copy out, so that what comes too late stays in; and after it, since it may be what hung.
        self.in_time(began)?;
        self.field.copy_out(Outputs::new(&self.regions, self.image)).map_err(Fault::Output)?;
        let took = self.in_time(began)?;
        Ok(Cycle { now, took })
    }

    fn in_time(&self, began: u64) -> Result<u64, Fault<F::Error>> {
        let took = self.clock.nanoseconds().saturating_sub(began);
        if took > self.watchdog { Err(Fault::Watchdog { took, limit: self.watchdog }) } else { Ok(took) }
    }

    /// The ticks since the loop started.
    pub fn ticks(&mut self) -> &mut Latch<T> {
        &mut self.ticks
    }

    /// The clock that measures it.
    pub fn clock(&self) -> &C {
        &self.clock
    }

    /// The image as the last scan left it.
    pub fn image(&self) -> &[u8] {
        self.image
    }

    /// The program.
    pub fn scan(&self) -> &S {
        &self.scan
    }
}

impl<S, F: FieldIo, T, C> ScanLoop<'_, S, F, T, C> {
    /// Stops for good and puts the outputs off. Dropping the loop does the same.
    ///
    /// # Errors
    /// When the field cannot say that all outputs are off.
    pub fn stop(&mut self) -> Result<(), F::Error> {
        if core::mem::replace(&mut self.running, false) { self.field.outputs_off() } else { Ok(()) }
    }
}

impl<S, F: FieldIo, T, C> Drop for ScanLoop<'_, S, F, T, C> {
    fn drop(&mut self) {
        // There is nobody left to tell that it failed.
        let _ = self.stop();
    }
}
