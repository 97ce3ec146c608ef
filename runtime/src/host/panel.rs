//! A simulated panel: the first field. A user interface sets its inputs and reads its outputs.
//!
//! The scan must never wait for the user interface: where that has the panel in hand, the scan goes on with the
//! inputs of its last cycle and shows its outputs one cycle later.

use std::convert::Infallible;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError, TryLockError};

use crate::{FieldIo, Inputs, Outputs, Regions};

/// The panel, as the user interface has it in hand. Places are bytes from the start of the image.
#[derive(Debug)]
pub struct Panel {
    wires: Mutex<Wires>,
    off: AtomicBool,
}

#[derive(Clone, Debug)]
struct Wires {
    inputs: Vec<Run>,
    outputs: Vec<Run>,
}

#[derive(Clone, Debug)]
struct Run {
    start: usize,
    bytes: Box<[u8]>,
}

fn find(runs: &mut [Run], offset: u32, size: usize) -> Option<&mut [u8]> {
    let offset = offset as usize;
    runs.iter_mut().find_map(|run| {
        let at = offset.checked_sub(run.start)?;
        run.bytes.get_mut(at..at.checked_add(size)?)
    })
}

impl Panel {
    /// A panel for these regions, its inputs as in `image`, its outputs off.
    ///
    /// # Panics
    /// When `image` is smaller than the regions.
    pub fn new(regions: &Regions<'_>, image: &[u8]) -> Arc<Self> {
        let inputs = regions.inputs().iter().map(|run| {
            let (start, end) = (run.bytes.start as usize, run.bytes.end as usize);
            Run { start, bytes: image[start..end].into() }
        });
        let outputs =
            regions.outputs().iter().map(|run| Run { start: run.start as usize, bytes: vec![0; run.len()].into() });
        let wires = Wires { inputs: inputs.collect(), outputs: outputs.collect() };
        Arc::new(Self { wires: Mutex::new(wires), off: AtomicBool::new(false) })
    }

    fn wires(&self) -> MutexGuard<'_, Wires> {
        // Nothing is left half-done by a panic: the worst is a torn value of the panicking writer.
        self.wires.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Sets an input; FALSE where there is none of these bytes.
    pub fn set(&self, offset: u32, bytes: &[u8]) -> bool {
        find(&mut self.wires().inputs, offset, bytes.len()).map(|input| input.copy_from_slice(bytes)).is_some()
    }

    /// Reads an input as it is set; FALSE where there is none of these bytes.
    pub fn input(&self, offset: u32, bytes: &mut [u8]) -> bool {
        find(&mut self.wires().inputs, offset, bytes.len()).map(|input| bytes.copy_from_slice(input)).is_some()
    }

    /// Reads an output as it came out; zero while the outputs are off, FALSE where there is none of these bytes.
    pub fn output(&self, offset: u32, bytes: &mut [u8]) -> bool {
        let found = find(&mut self.wires().outputs, offset, bytes.len()).map(|output| bytes.copy_from_slice(output));
        if self.is_off() {
            bytes.fill(0);
        }
        found.is_some()
    }

    /// Puts the outputs off for good, whatever comes out after. Any thread may do so at any time; it never waits.
    pub fn outputs_off(&self) {
        self.off.store(true, Ordering::Release);
    }

    /// Whether the outputs were put off.
    pub fn is_off(&self) -> bool {
        self.off.load(Ordering::Acquire)
    }
}

/// The controller's side of a panel.
#[derive(Debug)]
pub struct PanelIo {
    panel: Arc<Panel>,
    inputs: Vec<Run>,
}

impl PanelIo {
    /// Wires a controller to a panel.
    pub fn new(panel: Arc<Panel>) -> Self {
        let inputs = panel.wires().inputs.clone();
        Self { panel, inputs }
    }
}

impl Panel {
    /// For the scan: `None` while the user interface has the panel in hand.
    fn try_wires(&self) -> Option<MutexGuard<'_, Wires>> {
        match self.wires.try_lock() {
            Ok(wires) => Some(wires),
            Err(TryLockError::Poisoned(wires)) => Some(wires.into_inner()),
            Err(TryLockError::WouldBlock) => None,
        }
    }
}

impl FieldIo for PanelIo {
    type Error = Infallible;

    fn copy_in(&mut self, mut inputs: Inputs<'_>) -> Result<(), Infallible> {
        if let Some(wires) = self.panel.try_wires() {
            for (kept, set) in self.inputs.iter_mut().zip(&wires.inputs) {
                kept.bytes.copy_from_slice(&set.bytes);
            }
        }
        for ((_, bytes), kept) in inputs.runs().zip(&self.inputs) {
            bytes.copy_from_slice(&kept.bytes);
        }
        Ok(())
    }

    fn copy_out(&mut self, outputs: Outputs<'_>) -> Result<(), Infallible> {
        if let Some(mut wires) = self.panel.try_wires() {
            for ((_, bytes), shown) in outputs.runs().zip(&mut wires.outputs) {
                shown.bytes.copy_from_slice(bytes);
            }
        }
        Ok(())
    }

    fn outputs_off(&mut self) -> Result<(), Infallible> {
        self.panel.outputs_off();
        Ok(())
    }
}
