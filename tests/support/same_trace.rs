//! Whether two programs that should be one compute the same.

use std::sync::Arc;

use rung::check::Checked;
use rung::elementary::Value;
use rung::engine::interp::Interpreter;
use rung::logic::Layout;
use rung::lower::lower;
use rung::source::Source;
use rung_runtime::Scan;

use super::random_stimuli::{Stimuli, observed};

/// A program on the interpreter.
struct Machine {
    layout: Arc<Layout>,
    interpreter: Interpreter,
    image: Vec<u8>,
}

impl Machine {
    fn new(checked: &Checked) -> Result<Self, String> {
        let logic = lower(checked, &Source::new("drawn", ""), None).map_err(|error| format!("{error:?}"))?;
        let interpreter = Interpreter::new(&logic);
        let image = logic.layout.initial_image();
        Ok(Self { layout: logic.layout, interpreter, image })
    }

    fn set(&mut self, name: &str, value: Value) -> Result<(), String> {
        let mut observed = self.layout.observed().iter();
        let Some(found) = observed.find(|observed| observed.name.eq_ignore_ascii_case(name)) else {
            return Err(format!("nothing is named {name}"));
        };
        let slot = self.layout.slot(found.slot).clone();
        slot.write(&mut self.image, value);
        Ok(())
    }

    fn get(&self, name: &str) -> Option<Value> {
        let observed = self.layout.observed().iter().find(|observed| observed.name.eq_ignore_ascii_case(name))?;
        Some(self.layout.slot(observed.slot).read(&self.image))
    }
}

/// Compares what can be observed of the first program with what the second has under the same names, after every scan; names
/// for which `is_kept` does not hold may be others in the second. An address that nothing declares is a variable only where
/// something uses it: one that the second has not must not be written in the first.
///
/// # Errors
/// The first scan and variable in which they differ.
pub(crate) fn same_trace(
    first: &Checked,
    second: &Checked,
    seed: u64,
    scans: u64,
    is_kept: impl Fn(&str) -> bool,
) -> Result<(), String> {
    let drawn = first;
    let (mut first, mut second) = (Machine::new(first)?, Machine::new(second)?);
    let mut stimuli = Stimuli::new(seed, drawn, &observed(&first.layout));
    for scan in 0..scans {
        let (now, changes) = stimuli.next();
        for (name, value) in changes {
            first.set(&name, value)?;
            if !is_unused(&name, &second) {
                second.set(&name, value)?;
            }
        }
        let before = first.image.clone();
        for machine in [&mut first, &mut second] {
            machine.interpreter.scan(&mut machine.image, now);
        }
        for observed in first.layout.observed().iter().filter(|observed| is_kept(&observed.name)) {
            let expected = first.get(&observed.name);
            let found = match is_unused(&observed.name, &second) {
                true => Some(first.layout.slot(observed.slot).read(&before)),
                false => second.get(&observed.name),
            };
            if expected != found {
                return Err(format!("scan {scan}: {} is {found:?}, not {expected:?}", observed.name));
            }
        }
    }
    Ok(())
}

/// Whether a name is an address that a program does not use.
fn is_unused(name: &str, machine: &Machine) -> bool {
    name.starts_with('%') && machine.get(name).is_none()
}
