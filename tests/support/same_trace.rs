//! Whether two programs that should be one compute the same.

use rung::check::Checked;
use rung::elementary::Value;
use rung::engine::interp::Interpreter;
use rung::logic::Layout;
use rung::lower::lower;
use rung::source::Source;
use rung_runtime::Scan;

use super::random_stimuli::Stimuli;

/// A program on the interpreter.
struct Machine {
    layout: Layout,
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

/// The names under which an input can be observed: with several programs each has the name of its instance before it, and an input
/// of a block has none.
pub(crate) fn observed_as(layout: &Layout, input: &str) -> Vec<String> {
    let is_it = |name: &str| match name.len().checked_sub(input.len()) {
        Some(before) => {
            name.is_char_boundary(before)
                && name[before..].eq_ignore_ascii_case(input)
                && (before == 0 || name[..before].ends_with('.'))
        }
        None => false,
    };
    let names = layout.observed().iter().map(|observed| observed.name.clone());
    names.filter(|name| is_it(name)).collect()
}

/// Compares what can be observed of the first program with what the second has under the same names, after every scan.
///
/// # Errors
/// The first scan and variable in which they differ.
pub(crate) fn same_trace(first: &Checked, second: &Checked, seed: u64, scans: u64) -> Result<(), String> {
    let mut stimuli = Stimuli::new(seed, first);
    let (mut first, mut second) = (Machine::new(first)?, Machine::new(second)?);
    for scan in 0..scans {
        let (now, changes) = stimuli.next();
        for (input, value) in changes {
            for name in observed_as(&first.layout, &input) {
                first.set(&name, value)?;
                second.set(&name, value)?;
            }
        }
        for machine in [&mut first, &mut second] {
            machine.interpreter.scan(&mut machine.image, now);
        }
        for observed in first.layout.observed() {
            let (expected, found) = (first.get(&observed.name), second.get(&observed.name));
            if expected != found {
                return Err(format!("scan {scan}: {} is {found:?}, not {expected:?}", observed.name));
            }
        }
    }
    Ok(())
}
