//! The running program: its threads, and what the user interface shares with them.
//!
//! The scan thread must never wait for the user interface: it gives away copies where there is room for them, and
//! goes on where there is none.

use std::convert::Infallible;
use std::num::NonZeroU32;
use std::sync::atomic::{AtomicBool, AtomicI64, AtomicU64, Ordering};
use std::sync::mpsc::{self, Receiver, SyncSender};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};
use std::{fmt, io};

use rung_runtime::host::{
    Driver, End, Grant, Heartbeat, MonotonicClock, Panel, PanelIo, Role, Statistics, TickThread, Watchdog, lock_memory,
    schedule_this_thread,
};
use rung_runtime::{BadRegions, Scan, ScanLoop};

use super::points::Point;
use crate::controller::{Aligned, Runs};
use crate::elementary::Value;
use crate::logic::Layout;
use crate::logic::image::Slot;

/// Changes that wait to be told before more are only counted.
const MOST_CHANGES: usize = 4096;
/// How long a scan thread that missed its heartbeat has to end by itself before it counts as hung.
const GRACE: Duration = Duration::from_millis(500);

/// When cycles and ticks are.
#[derive(Clone, Copy, Debug)]
pub(super) struct Timing {
    /// Nanoseconds from one tick to the next.
    pub tick: NonZeroU32,
    /// Ticks from one cycle to the next.
    pub cycle: NonZeroU32,
    /// The tick at which the run ends by itself.
    pub ends_at: Option<u64>,
    /// Nanoseconds that a cycle may take.
    pub watchdog: u64,
}

/// What the system granted.
#[derive(Debug)]
pub(super) struct Scheduling {
    scan: Grant,
    tick: String,
    memory: Grant,
}

impl fmt::Display for Scheduling {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { scan, tick, memory } = self;
        write!(f, "real-time scan thread {scan}, real-time tick thread {tick}, locked memory {memory}")
    }
}

/// A told variable has changed.
#[derive(Clone, Copy, Debug)]
pub(super) struct Change {
    pub now: i64,
    /// The place among those that are told.
    pub index: usize,
    pub value: Value,
}

/// What the threads share.
#[derive(Debug)]
pub(super) struct Shared {
    pub panel: Arc<Panel>,
    pub statistics: Statistics,
    pub stop: Arc<AtomicBool>,
    heartbeat: Arc<Heartbeat>,
    /// Changes for which there was no room.
    untold: AtomicU64,
    /// A copy of the image after some scan, whenever one is wanted.
    copy: Mutex<Vec<u8>>,
    copy_wanted: AtomicBool,
    now: AtomicI64,
}

impl Shared {
    /// Asks for a copy of the image and gives the last that came.
    pub(super) fn image(&self, into: &mut Vec<u8>) {
        into.clone_from(&self.copy.lock().unwrap_or_else(PoisonError::into_inner));
        self.copy_wanted.store(true, Ordering::Relaxed);
    }

    /// Nanoseconds since the controller started, at the last scan.
    pub(super) fn now(&self) -> i64 {
        self.now.load(Ordering::Relaxed)
    }

    /// Changes that could not be told since this was asked last.
    pub(super) fn take_untold(&self) -> u64 {
        self.untold.swap(0, Ordering::Relaxed)
    }

    /// Whether the watchdog's thread has put the outputs off.
    pub(super) fn tripped(&self) -> bool {
        self.heartbeat.tripped()
    }
}

/// A running program.
#[derive(Debug)]
pub(super) struct Machine<E> {
    pub shared: Arc<Shared>,
    pub scheduling: Scheduling,
    pub changes: Receiver<Change>,
    thread: JoinHandle<Outcome<E>>,
    _watchdog: Watchdog,
}

/// How a run ended, and what it left.
#[derive(Debug)]
pub(super) struct Outcome<E> {
    pub end: End<Infallible>,
    pub engine: E,
    /// The image as the last scan left it.
    pub image: Vec<u8>,
}

/// Why there is no outcome.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Lost {
    /// The scan thread does not answer; the outputs are off.
    Hung,
    /// The scan thread panicked; the outputs are off.
    Panicked,
}

impl<E: Scan + Send + 'static> Machine<E> {
    /// Starts a program on a panel whose inputs are set as given.
    ///
    /// # Errors
    /// When the system gives no thread or timer.
    pub(super) fn start(
        engine: E,
        layout: &Layout,
        inputs: &[(Slot, Value)],
        timing: Timing,
        told: &[Point],
        stop: Arc<AtomicBool>,
    ) -> io::Result<Self> {
        let image = layout.initial_image();
        let runs = Runs::new(layout);
        let panel = Panel::new(&runs.regions().map_err(|BadRegions| bad_layout())?, &image);
        for (slot, value) in inputs {
            set(&panel, slot, *value);
        }
        let heartbeat = Arc::new(Heartbeat::default());
        let off = Arc::clone(&panel);
        let watchdog = Watchdog::start(Arc::clone(&heartbeat), move || off.outputs_off())?;
        let shared = Arc::new(Shared {
            panel,
            statistics: Statistics::default(),
            stop,
            heartbeat,
            untold: AtomicU64::new(0),
            copy: Mutex::new(image.clone()),
            copy_wanted: AtomicBool::new(true),
            now: AtomicI64::new(0),
        });
        let (sender, changes) = mpsc::sync_channel(MOST_CHANGES);
        let teller = Teller::new(told, &image, sender);
        let (started, wait) = mpsc::sync_channel(1);
        let mine = Arc::clone(&shared);
        let thread = thread::Builder::new()
            .name("rung-scan".to_owned())
            .spawn(move || scan_thread(engine, image, &runs, timing, &mine, teller, &started))?;
        match wait.recv() {
            Ok(scheduling) => Ok(Self { shared, scheduling: scheduling?, changes, thread, _watchdog: watchdog }),
            Err(_) => Err(io::Error::other("the scan thread ended before it began")),
        }
    }

    /// Whether there is nothing more to come.
    pub(super) fn is_over(&self) -> bool {
        self.thread.is_finished() || self.shared.tripped()
    }

    /// Waits for the end, which must have been asked for or have come.
    pub(super) fn finish(self) -> Result<Outcome<E>, Lost> {
        let mut tripped_at = None;
        while !self.thread.is_finished() {
            if self.shared.tripped() && tripped_at.get_or_insert_with(Instant::now).elapsed() > GRACE {
                return Err(Lost::Hung);
            }
            thread::sleep(Duration::from_millis(2));
        }
        self.thread.join().map_err(|_| Lost::Panicked)
    }
}

/// The scan thread, from its scheduling to outputs off.
fn scan_thread<E: Scan>(
    mut engine: E,
    image: Vec<u8>,
    runs: &Runs,
    timing: Timing,
    shared: &Shared,
    mut teller: Teller,
    started: &SyncSender<io::Result<Scheduling>>,
) -> Outcome<E> {
    let mut image = Aligned::new(&image);
    let ticks = match TickThread::start(timing.tick) {
        Ok(ticks) => ticks,
        Err(error) => {
            // The starter waits for it, and then for nothing more.
            let _ = started.send(Err(error));
            return Outcome { end: End::Asked(Ok(())), engine, image: image.bytes().to_vec() };
        }
    };
    let scan = schedule_this_thread(Role::Scan);
    let scheduling = Scheduling { scan, tick: ticks.scheduling().to_string(), memory: lock_memory() };
    let Ok(regions) = runs.regions() else {
        let _ = started.send(Err(bad_layout()));
        return Outcome { end: End::Asked(Ok(())), engine, image: image.bytes().to_vec() };
    };
    let _ = started.send(Ok(scheduling));
    let driver = Driver {
        cycle: timing.cycle,
        ends_at: timing.ends_at,
        watchdog: timing.watchdog,
        heartbeat: &shared.heartbeat,
        statistics: &shared.statistics,
        stop: &shared.stop,
    };
    let field = PanelIo::new(Arc::clone(&shared.panel));
    let clock = MonotonicClock;
    let mut scan_loop = ScanLoop::new(&mut engine, field, &ticks, clock, timing.watchdog, regions, image.bytes_mut());
    let end = driver.run(&mut scan_loop, |image, cycle| {
        shared.now.store(cycle.now, Ordering::Relaxed);
        if shared.copy_wanted.load(Ordering::Relaxed)
            && let Ok(mut copy) = shared.copy.try_lock()
        {
            copy.copy_from_slice(image);
            shared.copy_wanted.store(false, Ordering::Relaxed);
        }
        teller.tell(image, cycle.now, &shared.untold);
    });
    drop(scan_loop);
    Outcome { end, engine, image: image.bytes().to_vec() }
}

/// Sets an input of a panel.
pub(super) fn set(panel: &Panel, slot: &Slot, value: Value) {
    let mut bytes = [0; 8];
    let bytes = &mut bytes[..slot.ty.size() as usize];
    Slot { offset: 0, ..slot.clone() }.write(bytes, value);
    panel.set(slot.offset, bytes);
}

/// An input of a panel as it is set.
pub(super) fn input(panel: &Panel, slot: &Slot) -> Value {
    let mut bytes = [0; 8];
    let bytes = &mut bytes[..slot.ty.size() as usize];
    panel.input(slot.offset, bytes);
    Slot { offset: 0, ..slot.clone() }.read(bytes)
}

fn bad_layout() -> io::Error {
    io::Error::other("the parts of the process image overlap")
}

/// Tells of variables that change.
#[derive(Debug)]
struct Teller {
    told: Vec<(Slot, Value)>,
    sender: SyncSender<Change>,
}

impl Teller {
    fn new(told: &[Point], image: &[u8], sender: SyncSender<Change>) -> Self {
        let told = told.iter().map(|point| (point.slot.clone(), point.slot.read(image))).collect();
        Self { told, sender }
    }

    fn tell(&mut self, image: &[u8], now: i64, untold: &AtomicU64) {
        for (index, (slot, before)) in self.told.iter_mut().enumerate() {
            let value = slot.read(image);
            if value != std::mem::replace(before, value) && self.sender.try_send(Change { now, index, value }).is_err()
            {
                untold.fetch_add(1, Ordering::Relaxed);
            }
        }
    }
}

#[cfg(test)]
mod tests;
