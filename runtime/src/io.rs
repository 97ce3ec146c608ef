//! The field: whatever stands between the process image and the plant.

use crate::{Inputs, Outputs};

/// Field I/O: a bus, a port or a simulated panel.
///
/// The program sees the plant through the image only: all inputs are copied in before a scan, all outputs out
/// after it.
pub trait FieldIo {
    /// What can go wrong. The controller stops and puts the outputs off.
    type Error;

    /// Copies all inputs in. A BOOL may be any byte; other than 0 is TRUE.
    ///
    /// # Errors
    /// When the inputs cannot be had. Those written so far are not scanned.
    fn copy_in(&mut self, inputs: Inputs<'_>) -> Result<(), Self::Error>;

    /// Copies all outputs out.
    ///
    /// # Errors
    /// When they, or some, cannot be set.
    fn copy_out(&mut self, outputs: Outputs<'_>) -> Result<(), Self::Error>;

    /// Puts every output into its safe state. This is called once, when the controller stops for whatever reason;
    /// also after an error, so that it must try each output even where another fails.
    ///
    /// # Errors
    /// When an output may still be on.
    fn outputs_off(&mut self) -> Result<(), Self::Error>;
}
