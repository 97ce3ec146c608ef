//! The independent evaluator: what a checked program computes, told a second time.
//!
//! It walks [`Checked`] directly, round by round, and is written from the semantics alone: ladder elements as they
//! are drawn, timers as machines with three states, no primitive operation anywhere. It must share no code with
//! `lower`, `logic` or the engines, for it is what they are tested against; logarithms, powers and angles, of which only
//! one implementation gives the same bits, it takes from `mathematics` as they do. It is slow, and may be.
//!
//! `storage` is what variables are, `place` how one is found; `walk` runs rungs, `call` blocks and functions,
//! `statement` structured text, `expression` and `function` compute; `block` and what is beside it are the standard
//! blocks.

mod activity;
mod analog;
mod block;
mod call;
mod expression;
mod function;
mod place;
mod register_machine;
mod statement;
mod storage;
#[cfg(test)]
mod tests;
mod walk;

use std::collections::{HashMap, HashSet};

use rung::check::{Checked, Element, Task, Type, VariableId};
use rung::elementary::{Elementary, Value};
use rung::ladder::key;

use activity::Activities;
pub(crate) use activity::Activity;
#[cfg(test)]
pub(crate) use block::Instance;
use storage::{Frame, FrameId, Register, Storage};

/// A program that is being evaluated.
pub(crate) struct Oracle<'a> {
    checked: &'a Checked,
    globals: Frame,
    /// One for each program instance, in their order.
    programs: Vec<Frame>,
    /// The storage of each variable with an address, by the first variable that stands at it.
    located: HashMap<VariableId, Storage>,
    /// Every value of the globals, the programs and what is in them: all but those of calls of functions.
    registers: HashSet<Register>,
    /// Whether what runs is a function in an expression that is computed for nothing: it writes its own values only.
    muted: bool,
    frames: u32,
    /// When each task is due next.
    due: Vec<i128>,
    fault: bool,
    /// The time of this round.
    now: i64,
    /// What each contact and coil that sees edges remembers, in each instance, once a scan came to it. An element is
    /// known by where it lies in the program, which is not moved meanwhile.
    memories: HashMap<(FrameId, *const Element), bool>,
    activities: Activities,
    names: Vec<String>,
    /// What is behind each name.
    watched: Vec<(Storage, Elementary)>,
    places: HashMap<String, usize>,
}

impl<'a> Oracle<'a> {
    /// A program before its first round.
    pub(crate) fn new(checked: &'a Checked) -> Self {
        let mut oracle = Self {
            checked,
            globals: Frame::default(),
            programs: Vec::new(),
            located: HashMap::new(),
            registers: HashSet::new(),
            muted: false,
            frames: 0,
            due: vec![0; checked.tasks().len()],
            fault: false,
            now: 0,
            memories: HashMap::new(),
            activities: Activities::default(),
            names: Vec::new(),
            watched: Vec::new(),
            places: HashMap::new(),
        };
        oracle.globals = oracle.frame(checked.globals(), &[]);
        for id in checked.globals() {
            let storage = oracle.globals.get(id).expect("it is global").clone();
            oracle.observe(checked.variable(id).name.to_string(), checked.variable(id).ty, &storage);
        }
        for program in checked.programs() {
            let frame = oracle.frame(checked.unit(program.unit).variables(), &[]);
            for id in checked.unit(program.unit).variables() {
                let variable = checked.variable(id);
                let name = match checked.programs().len() {
                    1 => variable.name.to_string(),
                    _ => format!("{}.{}", program.name, variable.name),
                };
                oracle.observe(name, variable.ty, frame.get(id).expect("it is the program's"));
            }
            oracle.programs.push(frame);
        }
        let frames = oracle.programs.iter().chain([&oracle.globals]);
        oracle.registers = frames.flat_map(Frame::values).collect();
        oracle
    }

    /// Names what can be observed of a variable.
    fn observe(&mut self, name: String, ty: Type, storage: &Storage) {
        let checked = self.checked;
        match ty {
            Type::Elementary(ty) => {
                self.places.insert(key(&name), self.names.len());
                self.watched.push((storage.clone(), ty));
                self.names.push(name);
            }
            Type::Array(array) => {
                let array = checked.array(array);
                for place in 0..array.count() {
                    let (mut rest, mut indices) = (place, Vec::new());
                    for dimension in array.dimensions.iter().rev() {
                        indices.insert(0, (dimension.first + i64::from(rest % dimension.count)).to_string());
                        rest /= dimension.count;
                    }
                    let element = storage.part(place as usize);
                    self.observe(format!("{name}[{}]", indices.join(",")), array.element, &element);
                }
            }
            Type::Structure(structure) => {
                for (place, field) in checked.structure(structure).fields.iter().enumerate() {
                    self.observe(format!("{name}.{}", field.name), field.ty, &storage.part(place));
                }
            }
            Type::Block(block) => {
                for (place, pin) in block.outputs().iter().enumerate() {
                    let output = Storage::Value(storage.block().borrow().outputs[place].clone());
                    self.observe(format!("{name}.{}", pin.name), Type::Elementary(pin.ty), &output);
                }
            }
            Type::Unit(unit) => {
                for id in &checked.unit(unit).outputs {
                    let variable = checked.variable(*id);
                    let output = storage.unit().get(*id).expect("an output is one of its unit's variables");
                    self.observe(format!("{name}.{}", variable.name), variable.ty, output);
                }
            }
        }
    }

    /// Everything that can be observed: the globals, then program by program, in the order of declaration; of arrays
    /// and structures each element, of an instance each of its outputs.
    pub(crate) fn names(&self) -> &[String] {
        &self.names
    }

    /// The value of a name out of [`Oracle::names`], in any case.
    ///
    /// # Panics
    /// When there is no such name.
    pub(crate) fn get(&self, name: &str) -> Value {
        let (storage, ty) = self.watched(name);
        storage.read(*ty)
    }

    /// The values of [`Oracle::names`], in their order.
    pub(crate) fn values(&self) -> impl Iterator<Item = Value> {
        self.watched.iter().map(|(storage, ty)| storage.read(*ty))
    }

    /// All names and their values.
    pub(crate) fn observed(&self) -> Vec<(String, Value)> {
        self.names().iter().map(|name| (name.clone(), self.get(name))).collect()
    }

    /// Gives a name a value, as a copy-in does.
    ///
    /// # Panics
    /// When there is no such name.
    pub(crate) fn set(&mut self, name: &str, value: Value) {
        self.watched(name).0.write(value);
    }

    /// Whether an index was out of range in anything that was executed so far.
    pub(crate) fn fault(&self) -> bool {
        self.fault
    }

    /// How often each element changed so far, in the order in which scans first came to them.
    pub(crate) fn activities(&self) -> &[Activity] {
        self.activities.all()
    }

    /// Writes a value that the program computed.
    fn put(&self, target: &Storage, value: Value) {
        if !self.is_muted(target) {
            target.write(value);
        }
    }

    /// Writes all of an array or structure, as [`Storage::copy`] does.
    fn put_copy(&self, target: &Storage, source: &Storage) {
        if !self.is_muted(target) {
            target.copy(source);
        }
    }

    fn is_muted(&self, target: &Storage) -> bool {
        self.muted && target.values().iter().any(|register| self.registers.contains(register))
    }

    fn watched(&self, name: &str) -> &(Storage, Elementary) {
        let place = self.places.get(&key(name)).unwrap_or_else(|| panic!("no variable is named {name}"));
        &self.watched[*place]
    }

    /// Runs one round at `now`, nanoseconds since the controller started: every task that is due, in their order.
    pub(crate) fn scan(&mut self, now: i64) {
        self.now = now;
        let checked = self.checked;
        for (place, task) in checked.tasks().iter().enumerate() {
            let runs = self.is_due(place, task);
            let kind = if task.interval.is_some() { "task with an interval" } else { "task of every round" };
            self.activities.saw(FrameId::default(), task, kind, vec![Value::bool(runs)]);
            if !runs {
                continue;
            }
            for (index, program) in checked.programs().iter().enumerate() {
                if program.task.index() == place {
                    let frame = self.programs[index].clone();
                    self.run(program.unit, &frame);
                }
            }
        }
    }

    /// Whether a task runs now; if so, it is due again at the next multiple of its interval.
    fn is_due(&mut self, place: usize, task: &Task) -> bool {
        let Some(interval) = task.interval else { return true };
        let (now, interval) = (i128::from(self.now), i128::from(interval));
        let runs = now >= self.due[place];
        if runs {
            self.due[place] = (now / interval + 1) * interval;
        }
        runs
    }
}
