//! One program on every engine and in the evaluator, side by side.

use std::fmt::Write as _;
use std::sync::Arc;

use rung::check::{self, Checked};
use rung::diagnostic;
use rung::elementary::Value;
use rung::engine::interp::Interpreter;
use rung::engine::jit::Jit;
use rung::ladder::Program;
use rung::source::Source;
use rung::{logic, lower, opt};
use rung_runtime::Scan;

use super::oracle::Oracle;

/// The checked form of a program.
///
/// # Errors
/// What checking said, when it found an error.
pub(crate) fn checked(program: &Program) -> Result<Checked, String> {
    let (checked, diagnostics) = check::check(program);
    checked.ok_or_else(|| diagnostic::render(&Source::new("drawn", ""), &diagnostics))
}

/// An engine with its own image.
struct Engine {
    name: &'static str,
    scan: Box<dyn Scan>,
    image: Vec<u8>,
}

/// A program on all engines.
pub(crate) struct Rig<'a> {
    /// The evaluator.
    pub(crate) oracle: Oracle<'a>,
    layout: Arc<logic::Layout>,
    engines: Vec<Engine>,
}

/// Where engines differ.
#[derive(Debug)]
pub(crate) struct Difference {
    /// The variable; empty when only memory that has no name differs.
    pub(crate) name: String,
    /// What each says.
    pub(crate) values: String,
}

impl<'a> Rig<'a> {
    /// All engines before the first scan.
    ///
    /// # Errors
    /// Why there is no such engine.
    pub(crate) fn new(checked: &'a Checked) -> Result<Self, String> {
        let plain = lower::lower(checked, &Source::new("drawn", ""), None).map_err(|error| format!("{error:?}"))?;
        let optimised = opt::optimise(plain.clone());
        if optimised.layout != plain.layout {
            return Err("optimising changed the layout".to_owned());
        }
        let jit = |program| Jit::compile(program).map_err(|error| format!("{error:?}"));
        let scans: [(&'static str, Box<dyn Scan>); 4] = [
            ("interpreter", Box::new(Interpreter::new(&plain))),
            ("interpreter, optimised", Box::new(Interpreter::new(&optimised))),
            ("JIT", Box::new(jit(&plain)?)),
            ("JIT, optimised", Box::new(jit(&optimised)?)),
        ];
        let image = plain.layout.initial_image();
        let engines = scans.into_iter().map(|(name, scan)| Engine { name, scan, image: image.clone() }).collect();
        let rig = Self { oracle: Oracle::new(checked), layout: plain.layout, engines };
        let observed: Vec<&str> = rig.layout.observed().iter().map(|observed| observed.name.as_str()).collect();
        if observed != rig.oracle.names() {
            return Err(format!("the layout observes {observed:?}, the evaluator {:?}", rig.oracle.names()));
        }
        Ok(rig)
    }

    /// Gives an input a value everywhere.
    ///
    /// # Panics
    /// When nothing has that name.
    pub(crate) fn set(&mut self, name: &str, value: Value) {
        self.oracle.set(name, value);
        let observed = self.layout.observed().iter().find(|observed| observed.name.eq_ignore_ascii_case(name));
        let slot = self.layout.slot(observed.unwrap_or_else(|| panic!("nothing is named {name}")).slot);
        for engine in &mut self.engines {
            slot.write(&mut engine.image, value);
        }
    }

    /// Runs one scan everywhere.
    ///
    /// # Errors
    /// The first variable that is not the same everywhere.
    pub(crate) fn scan(&mut self, now: i64) -> Result<(), Difference> {
        self.oracle.scan(now);
        for engine in &mut self.engines {
            engine.scan.scan(&mut engine.image, now);
        }
        for (observed, expected) in self.layout.observed().iter().zip(self.oracle.values()) {
            let slot = self.layout.slot(observed.slot);
            // Two variables at one address may see one slot as two types.
            if slot.read(&self.engines[0].image).bits() != Value::from_bits(slot.ty, expected.bits()).bits() {
                return Err(self.difference(&observed.name, expected));
            }
        }
        let first = &self.engines[0];
        let fault = self.layout.slots().iter().find(|slot| slot.name == "#fault");
        let fault = fault.is_some_and(|slot| slot.read(&first.image).is_true());
        if fault != self.oracle.fault() {
            let values = format!("{} evaluator\n{fault} {}\n", self.oracle.fault(), first.name);
            return Err(Difference { name: "#fault".to_owned(), values });
        }
        let Some(engine) = self.engines.iter().find(|engine| engine.image != first.image) else { return Ok(()) };
        let slots = self.layout.slots().iter();
        let differing: Vec<&str> = slots
            .filter(|slot| slot.read(&engine.image) != slot.read(&first.image))
            .map(|slot| slot.name.as_str())
            .collect();
        let visible = self.layout.observed().iter().zip(self.oracle.values());
        let mut visible = visible.filter(|(observed, _)| {
            let slot = self.layout.slot(observed.slot);
            slot.read(&engine.image).bits() != slot.read(&first.image).bits()
        });
        if let Some((observed, expected)) = visible.next() {
            return Err(self.difference(&observed.name, expected));
        }
        let values = format!("{} and {} differ in the image at {differing:?}\n", first.name, engine.name);
        Err(Difference { name: String::new(), values })
    }

    /// What each says to a variable that is not the same everywhere.
    fn difference(&self, name: &str, expected: Value) -> Difference {
        let mut values = format!("{expected:?} evaluator\n");
        let observed = self.layout.observed().iter().find(|observed| observed.name == name);
        for (engine, observed) in self.engines.iter().zip(observed.into_iter().cycle()) {
            let _ = writeln!(values, "{:?} {}", self.layout.slot(observed.slot).read(&engine.image), engine.name);
        }
        Difference { name: name.to_owned(), values }
    }
}
