//! A ladder program inside a host program: load it, scan it, read and write its variables by name.
//!
//! [`Controller`] is a whole program with its image: every format in, either engine behind it. It must never do I/O and
//! never read a clock: bytes and time come from the host program, so that a run can be repeated. It must never panic,
//! whatever the bytes and names; and a failed call must leave it as it was.
//!
//! In real time and with a field, [`Controller::scan_loop`] makes a [`ScanLoop`] over it: the runtime's cycle of copy in,
//! scan and copy out, which knows bytes only.

mod error;
mod image;
mod retained;
mod variables;

use std::collections::HashMap;
use std::fmt;
use std::sync::Arc;
use std::time::Duration;

use rung_runtime::{Clock, FieldIo, Scan, ScanLoop, TickSource};

use crate::diagnostic::{Code, Diagnostic};
use crate::elementary::{ToValue, Unfit, Value};
use crate::engine::interp::Interpreter;
use crate::engine::jit::Jit;
use crate::load::Loaded;
use crate::logic::image::EarlierLayout;
use crate::logic::{Layout, Slot};
use crate::lower::lower;
use crate::opt::optimise;
use crate::source::{Source, Span};

pub use error::{Error, Findings};
pub(crate) use image::{Aligned, Runs};
pub use retained::Retained;
use variables::Names;
pub use variables::Variable;

/// What runs the scans.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub enum Engine {
    /// Machine code for this process, made when the program is loaded: milliseconds then, nanoseconds a rung after.
    #[default]
    Jit,
    /// The interpreter, on any machine and at once.
    Interpreter,
}

/// How a program is loaded. [`Settings::default`] is what [`Controller::load`] takes.
#[derive(Clone, Debug, Default)]
pub struct Settings {
    /// What runs the scans.
    pub engine: Engine,
    /// Whether a program of another tool runs without the elements that Rung has not. They are warnings then.
    pub allow_missing: bool,
    /// The layout that an earlier build had, from [`read_map`](crate::logic::map::read_map): what it places stays in its
    /// place, as `rung build --previous-map` has it.
    pub earlier: Option<EarlierLayout>,
}

/// A ladder program that runs in this process.
///
/// Time is the host program's: it says at each [`Controller::scan`] how long the program has been running. Between
/// scans it reads and writes variables by name. Names are those of a trace of `rung sim`: `pump`, `delay.ET`,
/// `recipe[3]`, `axis.position`; in any case.
///
/// ```
/// use std::time::Duration;
/// use rung::Controller;
///
/// let text = b"
/// program lamp
/// input  switch
/// output lamp
/// var    times : INT retain
///
/// rung r10
///   switch delay:TON(PT := T#20ms) (lamp)
///
/// rung r20
///   ^lamp {times := times + 1}
/// ";
/// let mut controller = Controller::load("lamp.rung", text)?;
///
/// controller.write("switch", true)?;
/// for scan in 0..3 {
///     controller.scan(Duration::from_millis(10 * scan));
/// }
/// assert!(controller.read::<bool>("lamp")?);
/// assert_eq!(controller.read::<i16>("times")?, 1);
/// assert_eq!(controller.read::<Duration>("delay.ET")?, Duration::from_millis(20));
///
/// // The text was edited: what has the same name and type goes on with the value that it has.
/// let edited = String::from_utf8_lossy(text).replace("times + 1", "times + 10");
/// controller.swap("lamp.rung", edited.as_bytes())?;
/// assert_eq!(controller.read::<i16>("times")?, 1);
/// # Ok::<(), rung::Error>(())
/// ```
pub struct Controller {
    name: String,
    layout: Arc<Layout>,
    runs: Runs,
    names: Names,
    settings: Settings,
    warnings: Findings,
    engine: Box<dyn Scan + Send>,
    image: Aligned,
    now: i64,
}

impl Controller {
    /// Loads a program, in whatever format its content shows, and compiles it for this machine. Every variable holds its
    /// initial value. The name is what diagnostics call it.
    ///
    /// # Errors
    /// [`Error::Program`] with all that is wrong with it, or [`Error::Compile`].
    ///
    /// ```
    /// use rung::{Controller, Error};
    ///
    /// let wrong = b"program p input a output b\nrung r10\n  a /c (b)";
    /// let Err(Error::Program(findings)) = Controller::load("p.rung", wrong) else { panic!("`c` is not declared") };
    /// assert_eq!(findings.diagnostics[0].code.to_string(), "R0301");
    /// assert!(findings.to_string().contains("p.rung:3:6"), "{findings}");
    /// ```
    pub fn load(name: impl Into<String>, bytes: &[u8]) -> Result<Self, Error> {
        Self::load_with(name, bytes, Settings::default())
    }

    /// Loads a program with other settings than the default.
    ///
    /// # Errors
    /// [`Error::Program`], or [`Error::Compile`].
    pub fn load_with(name: impl Into<String>, bytes: &[u8], settings: Settings) -> Result<Self, Error> {
        Self::start(Loaded::decode(name, bytes), settings)
    }

    /// Loads a program of which the text is at hand, or that is the files of a folder: see [`Source::joined`].
    ///
    /// # Errors
    /// [`Error::Program`], or [`Error::Compile`].
    pub fn load_source(source: Source, settings: Settings) -> Result<Self, Error> {
        Self::start(Loaded::parse(source), settings)
    }

    fn start(mut loaded: Loaded, settings: Settings) -> Result<Self, Error> {
        let checked = loaded.check_to_run(settings.allow_missing);
        let lowered = checked.map(|checked| lower(&checked, &loaded.source, settings.earlier.as_ref()));
        let Loaded { source, mut diagnostics, program: drawing, .. } = loaded;
        drop(drawing);
        let program = match lowered {
            Some(Ok(program)) => optimise(program),
            refused => {
                if refused.is_some() {
                    let message = "the variables and blocks take more than 1 GiB";
                    diagnostics.push(Diagnostic::new(Code::ImageTooLarge, Span::default(), message));
                }
                return Err(Error::Program(Box::new(Findings { source, diagnostics })));
            }
        };
        let engine: Box<dyn Scan + Send> = match settings.engine {
            Engine::Jit => Box::new(Jit::compile(&program)?),
            Engine::Interpreter => Box::new(Interpreter::new(&program)),
        };
        let layout = program.layout;
        Ok(Self {
            name: program.name,
            runs: Runs::new(&layout),
            names: Names::new(&layout),
            settings,
            warnings: Findings { source, diagnostics },
            engine,
            image: Aligned::new(&layout.initial_image()),
            layout,
            now: 0,
        })
    }

    /// Replaces the program by an edited one, between two scans. Variables and block states that have the same name
    /// and type in both keep their values, and what is new starts with its initial value; time goes on. The settings
    /// are those that the controller was loaded with.
    ///
    /// # Errors
    /// [`Error::Program`], or [`Error::Compile`]; the program that runs goes on then.
    pub fn swap(&mut self, name: impl Into<String>, bytes: &[u8]) -> Result<(), Error> {
        let mut edited = Self::load_with(name, bytes, self.settings.clone())?;
        let before: HashMap<&str, &Slot> = self.layout.slots().iter().map(|slot| (slot.name.as_str(), slot)).collect();
        for slot in edited.layout.slots() {
            if let Some(kept) = before.get(slot.name.as_str()).filter(|kept| kept.ty == slot.ty) {
                slot.write(edited.image.bytes_mut(), kept.read(self.image.bytes()));
            }
        }
        edited.now = self.now;
        *self = edited;
        Ok(())
    }

    /// Runs one scan at `now`, the time since the controller started. A time before that of the last scan counts as
    /// that, and one beyond 292 years as 292 years: time never goes back.
    pub fn scan(&mut self, now: Duration) {
        self.now = i64::try_from(now.as_nanos()).unwrap_or(i64::MAX).max(self.now);
        self.engine.scan(self.image.bytes_mut(), self.now);
    }

    /// The time of the last scan; 0 before the first one.
    pub fn now(&self) -> Duration {
        Duration::from_nanos(self.now.unsigned_abs())
    }

    /// Starts over, as after a power failure: retained variables keep their values, all others hold their initial ones,
    /// and time is 0.
    pub fn restart(&mut self) {
        let retained = self.retained();
        self.image.bytes_mut().copy_from_slice(&self.layout.initial_image());
        retained.put(&self.layout, self.image.bytes_mut());
        self.now = 0;
    }

    /// A variable's value as a Rust type: `bool`, an integer, `f32`, `f64`, [`Duration`] or [`Value`].
    ///
    /// # Errors
    /// [`Error::NoVariable`]; [`Error::NotGiven`] where the value is of another type, or beyond the range of this one.
    ///
    /// ```
    /// # let mut controller = rung::Controller::load("p", b"program p output speed : INT := -5")?;
    /// use rung::{Error, elementary::Value};
    ///
    /// assert_eq!(controller.read::<i16>("speed")?, -5);
    /// assert_eq!(controller.read::<i64>("Speed")?, -5);
    /// assert!(matches!(controller.read::<u16>("speed"), Err(Error::NotGiven { .. })));
    /// assert!(matches!(controller.read::<bool>("speed"), Err(Error::NotGiven { .. })));
    /// assert_eq!(controller.read::<Value>("speed")?.as_integer(), Some(-5));
    /// # Ok::<(), Error>(())
    /// ```
    pub fn read<T: TryFrom<Value, Error: Into<Unfit>>>(&self, name: &str) -> Result<T, Error> {
        let variable = self.variable(name)?;
        let not_given = |unfit: T::Error| Error::NotGiven { name: variable.name().to_owned(), unfit: unfit.into() };
        T::try_from(variable.slot().read(self.image.bytes())).map_err(not_given)
    }

    /// Sets a variable, an input or any other. What a rung computes is computed anew by the next scan.
    ///
    /// # Errors
    /// [`Error::NoVariable`]; [`Error::NotTaken`] where the variable is of another type or the value is out of its range,
    /// by the rules of [`ToValue::to_value`].
    ///
    /// ```
    /// # let mut controller = rung::Controller::load("p", b"program p input speed : INT input ratio : REAL")?;
    /// use rung::Error;
    ///
    /// controller.write("speed", 1500)?;
    /// controller.write("ratio", 0.25)?;
    /// assert!(matches!(controller.write("speed", 40_000), Err(Error::NotTaken { .. })));
    /// let missing = controller.write("spede", 1).unwrap_err();
    /// assert_eq!(missing.to_string(), "the program has no variable `spede`; is it `speed`?");
    /// # Ok::<(), Error>(())
    /// ```
    pub fn write(&mut self, name: &str, value: impl ToValue) -> Result<(), Error> {
        let variable = self.variable(name)?;
        let Some(value) = value.to_value(variable.ty()) else {
            let (name, ty) = (variable.name().to_owned(), variable.ty());
            return Err(Error::NotTaken { name, ty, given: format!("{value:?}") });
        };
        self.layout.slot(variable.id()).write(self.image.bytes_mut(), value);
        Ok(())
    }

    /// One variable.
    ///
    /// # Errors
    /// [`Error::NoVariable`]
    pub fn variable(&self, name: &str) -> Result<Variable<'_>, Error> {
        self.names.find(&self.layout, name)
    }

    /// Every variable that can be read and written, in order of declaration: of a block its outputs, of an array its
    /// elements, of a structure its members.
    pub fn variables(&self) -> impl Iterator<Item = Variable<'_>> {
        variables::all(&self.layout)
    }

    /// What the retained variables hold, to be kept while the power is off.
    ///
    /// ```
    /// # let text = b"program p var hours : INT retain";
    /// use rung::{Controller, Retained};
    ///
    /// let mut controller = Controller::load("p.rung", text)?;
    /// controller.write("hours", 12)?;
    /// let kept: Vec<u8> = controller.retained().to_bytes();
    ///
    /// let mut controller = Controller::load("p.rung", text)?;
    /// controller.restore(&Retained::from_bytes(&kept).ok_or("no retained bytes")?)?;
    /// assert_eq!(controller.read::<i16>("hours")?, 12);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn retained(&self) -> Retained {
        Retained::of(&self.layout, self.image.bytes())
    }

    /// Puts retained variables back, before the first scan. Of a program that was edited since, load the one before the
    /// edit, restore it and [swap](Self::swap) to the edited one.
    ///
    /// # Errors
    /// [`Error::OtherLayout`] or [`Error::RetainedSize`] when they are not of this program.
    pub fn restore(&mut self, retained: &Retained) -> Result<(), Error> {
        let (expected, found) = (self.layout.hash(), retained.layout_hash);
        if expected != found {
            return Err(Error::OtherLayout { expected, found });
        }
        let (expected, found) = (Retained::size(&self.layout), retained.bytes.len());
        if expected != found {
            return Err(Error::RetainedSize { expected, found });
        }
        retained.put(&self.layout, self.image.bytes_mut());
        Ok(())
    }

    /// Whether an index was out of range in some scan since the start.
    pub fn is_faulty(&self) -> bool {
        self.layout.fault().is_some_and(|slot| self.layout.slot(slot).read(self.image.bytes()).is_true())
    }

    /// The program in real time: a loop that copies a field's inputs in, scans at the time of a tick source, and copies
    /// the outputs out, while no cycle takes longer than the watchdog's time. Its time starts at 0, so it is to be had
    /// before the first scan or after a [restart](Self::restart); when it is dropped the outputs are off, and the
    /// variables can be read and written here again.
    pub fn scan_loop<F: FieldIo, T: TickSource, C: Clock>(
        &mut self,
        field: F,
        ticks: T,
        clock: C,
        watchdog: Duration,
    ) -> ScanLoop<'_, &mut (dyn Scan + Send), F, T, C> {
        let watchdog = u64::try_from(watchdog.as_nanos()).unwrap_or(u64::MAX);
        let regions = self.runs.regions().expect("the runs of a layout are in order and within it");
        ScanLoop::new(&mut *self.engine, field, ticks, clock, watchdog, regions, self.image.bytes_mut())
    }

    /// The name that the program gives itself.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Warnings about the program, such as a name that nothing uses.
    pub fn warnings(&self) -> &Findings {
        &self.warnings
    }

    /// The layout of the image: offsets, runs, and the hash that names it.
    pub fn layout(&self) -> &Layout {
        &self.layout
    }

    /// The image as the last scan, or a write since, left it.
    pub fn image(&self) -> &[u8] {
        self.image.bytes()
    }
}

impl fmt::Debug for Controller {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Controller").field("name", &self.name).field("now", &self.now()).finish_non_exhaustive()
    }
}
