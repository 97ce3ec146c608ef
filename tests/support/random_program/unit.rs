//! Random units: function blocks and functions, each of which may use those before it, then programs and what runs them.

use rung::elementary::Elementary;
use rung::ladder::{ProgramInstance, Registers, Setting, Task, TypeReference, Unit, UnitKind, Variable, VariableClass};

use super::expression::time;
use super::shape::{Shape, Way};
use super::{Entry, Generator, Signature, Whole};
use crate::support::drawing::{self, NOWHERE};

const MILLISECOND: i64 = 1_000_000;

/// A unit in which nothing is drawn yet.
pub(super) fn empty() -> Unit {
    Unit {
        kind: UnitKind::Program { task: None },
        name: drawing::name("random"),
        variables: Vec::new(),
        rungs: Vec::new(),
        span: NOWHERE,
    }
}

impl Generator {
    /// All of a program.
    pub(super) fn draw(&mut self) {
        self.declare_types();
        self.declare_globals();
        let (globals, wholes) = (self.scope.clone(), self.wholes.clone());
        for number in 0..*self.dice.pick(&[0, 0, 1, 2]) {
            self.function_unit(number, &globals, &wholes);
        }
        for number in 0..*self.dice.pick(&[0, 0, 1, 2]) {
            self.block_unit(number, &globals, &wholes);
        }
        let tasks = *self.dice.pick(&[0, 0, 0, 1, 2, 3]);
        for number in 0..tasks {
            self.task(number);
        }
        let programs = *self.dice.pick(if tasks == 0 { &[1, 1, 1, 2] } else { &[1, 2, 3] });
        for number in 0..programs {
            self.program_unit(number, &globals, &wholes);
        }
        if self.register_machine && (programs > 1 || !self.blocks.is_empty()) {
            // Instances in instances may be more than the register machine has unless told.
            let limits = ["timers", "drums", "shifts"].map(|name| setting(name, 5000));
            let registers = self.program.registers.get_or_insert(Registers { settings: Vec::new(), span: NOWHERE });
            registers.settings.extend(limits);
        }
    }

    /// Starts to draw a unit, which sees the globals.
    fn start(&mut self, kind: UnitKind, name: &str, globals: &[Entry], wholes: &[Whole]) {
        self.in_function = matches!(kind, UnitKind::Function { .. });
        self.unit = Unit { kind, name: drawing::name(name), ..empty() };
        (self.scope, self.wholes) = (globals.to_vec(), wholes.to_vec());
        self.instances.clear();
        self.weight = 0;
    }

    /// Draws the rungs of a unit whose declarations are made.
    fn finish(&mut self, rungs: usize) {
        self.pending.clone_from(&self.instances);
        for place in 0..rungs {
            self.rung(place);
        }
        // Every instance is called, or its members could not be named.
        while !self.pending.is_empty() {
            let place = self.unit.rungs.len();
            self.rung(place);
        }
        self.add_jumps();
        self.in_function = false;
        self.weight += 20 * self.unit.rungs.len();
        let unit = std::mem::replace(&mut self.unit, empty());
        self.program.units.push(unit);
    }

    fn function_unit(&mut self, number: usize, globals: &[Entry], wholes: &[Whole]) {
        let name = format!("f{number}");
        let result = self.dice.percent(80).then(|| self.usual_type());
        let kind = UnitKind::Function { result: result.map(|ty| TypeReference::of_name(drawing::name(ty.name()))) };
        self.start(kind, &name, globals, wholes);
        if let Some(ty) = result {
            self.add_name(&name, &Shape::Value(ty), VariableClass::Output);
        }
        let signature = self.pins(name, result);
        self.declare_local();
        let rungs = self.dice.between(1, 2);
        self.finish(rungs);
        self.functions.push(Signature { weight: self.weight, ..signature });
    }

    fn block_unit(&mut self, number: usize, globals: &[Entry], wholes: &[Whole]) {
        let name = format!("block{number}");
        self.start(UnitKind::FunctionBlock, &name, globals, wholes);
        let signature = self.pins(name, None);
        self.declare_local();
        self.declare_instances(2);
        let rungs = self.dice.between(1, 3);
        self.finish(rungs);
        self.blocks.push(Signature { weight: self.weight, ..signature });
    }

    fn program_unit(&mut self, number: usize, globals: &[Entry], wholes: &[Whole]) {
        let name = format!("main{number}");
        let tasks: Vec<Task> = self.program.tasks.clone();
        let mut task = || (!tasks.is_empty() && self.dice.percent(85)).then(|| self.dice.pick(&tasks).name.clone());
        let (own, first, second) = (task(), task(), task());
        self.start(UnitKind::Program { task: own }, &name, globals, wholes);
        self.declare(number);
        self.declare_instances(if number == 0 { 5 } else { 2 });
        let rungs = self.dice.between(1, if number == 0 { 9 } else { 3 });
        self.finish(rungs);
        // Instances under names of their own run instead of the one of the program's name.
        if self.dice.percent(20) {
            for (instance, task) in [("one", first), ("two", second)] {
                self.program.instances.push(ProgramInstance {
                    name: drawing::name(&format!("{instance}{number}")),
                    program: drawing::name(&name),
                    task,
                    span: NOWHERE,
                });
            }
        }
    }

    /// What calls of a unit give it and take from it.
    fn pins(&mut self, name: String, result: Option<Elementary>) -> Signature {
        use VariableClass::{InOut, Input, Output};
        let mut signature =
            Signature { name, result, inputs: Vec::new(), references: Vec::new(), outputs: Vec::new(), weight: 0 };
        for number in 0..self.dice.between(1, 3) {
            let ty = if number == 0 && self.dice.percent(60) { Elementary::Bool } else { self.usual_type() };
            let name = format!("p{number}");
            self.declare_variable(Input, &name, ty);
            signature.inputs.push((name, ty));
        }
        for number in 0..*self.dice.pick(&[0, 0, 1, 2]) {
            let shape = if self.dice.percent(60) { Shape::Value(self.usual_type()) } else { self.some_shape() };
            let name = format!("io{number}");
            self.declare_shape(InOut, &name, &shape);
            signature.references.push((name, shape));
        }
        for number in 0..self.dice.between(usize::from(result.is_none()), 2) {
            let shape = match self.dice.below(10) {
                0 => self.some_shape(),
                1..6 => Shape::Value(Elementary::Bool),
                _ => Shape::Value(self.usual_type()),
            };
            let name = format!("y{number}");
            self.declare_shape(Output, &name, &shape);
            signature.outputs.push((name, shape));
        }
        signature
    }

    /// Variables that nothing outside sees.
    fn declare_local(&mut self) {
        use VariableClass::{Constant, Memory, Temporary};
        self.declare_variable(Memory, "flag", Elementary::Bool);
        for (class, prefix) in [(Memory, "v"), (Temporary, "t"), (Constant, "k")] {
            if self.dice.percent(50) {
                let ty = self.usual_type();
                self.declare_variable(class, &format!("{prefix}_0"), ty);
            }
        }
        if self.dice.percent(30) {
            let class = *self.dice.pick(&[Memory, Temporary, Constant]);
            let shape = self.some_shape();
            self.declare_shape(class, "parts", &shape);
        }
    }

    fn declare_globals(&mut self) {
        use VariableClass::{Constant, Memory};
        if self.register_machine && self.dice.percent(40) {
            let counts = [4, 5, 6].map(|most| self.dice.between(1, most));
            let settings = vec![setting("ireg", counts[0]), setting("oreg", counts[1]), setting("hreg", counts[2])];
            self.program.registers = Some(Registers { settings, span: NOWHERE });
            for ((name, class), count) in
                [("ireg", VariableClass::Input), ("oreg", VariableClass::Output), ("hreg", Memory)].iter().zip(counts)
            {
                let bounds = super::shape::Bounds { first: 0, count: u32::try_from(count).expect("it is small") };
                let shape = Shape::Array(vec![bounds], Box::new(Shape::Value(Elementary::Word)));
                self.add_name(name, &shape, *class);
            }
        } else if self.register_machine && self.dice.percent(30) {
            for (name, class) in [("oreg", VariableClass::Output), ("hreg", Memory)] {
                let root = rung::ladder::Root::Name(drawing::name(name));
                self.scope.push(Entry { root, way: vec![Way::Register(6)], ty: Elementary::Word, class });
            }
        }
        for number in 0..*self.dice.pick(&[0, 0, 1, 3]) {
            let ty = self.usual_type();
            let class = if self.dice.percent(85) { Memory } else { Constant };
            self.declare_variable(class, &format!("g_{number}"), ty);
        }
        if self.dice.percent(20) {
            let shape = self.some_shape();
            self.declare_shape(Memory, "g_parts", &shape);
        }
        self.program.globals = std::mem::take(&mut self.unit.variables);
        if self.dice.percent(30) {
            self.addresses = true;
            self.use_addresses();
        }
    }

    fn task(&mut self, number: usize) {
        let interval = *self.dice.pick(&[0, 1, 2, 5, 7, 10, 50, 200]);
        let priority =
            self.dice.percent(70).then(|| self.dice.below(4)).map(|priority| drawing::integer(priority as i128));
        self.program.tasks.push(Task {
            name: drawing::name(&format!("task{number}")),
            interval: (interval > 0).then(|| time(interval * MILLISECOND)),
            priority,
            span: NOWHERE,
        });
    }

    /// A type that blocks and indices often need.
    pub(super) fn usual_type(&mut self) -> Elementary {
        use Elementary::{Bool, Dint, Int, Real, Time, Word};
        if self.dice.percent(60) {
            *self.dice.pick(&[Bool, Bool, Int, Int, Dint, Real, Time, Word])
        } else {
            *self.dice.pick(&Elementary::ALL)
        }
    }

    /// Declares an array, a structure or a value.
    pub(super) fn declare_shape(&mut self, class: VariableClass, name: &str, shape: &Shape) {
        let given = match class {
            VariableClass::InOut => 0,
            VariableClass::Constant => 100,
            _ => 50,
        };
        let variable = Variable {
            ty: Some(self.type_reference(shape)),
            initial: self.dice.percent(given).then(|| Box::new(self.initial_of(shape))),
            ..drawing::variable(class, name, Elementary::Bool)
        };
        self.unit.variables.push(variable);
        self.add_name(name, shape, class);
    }

    pub(super) fn add_name(&mut self, name: &str, shape: &Shape, class: VariableClass) {
        self.spread(&rung::ladder::Root::Name(drawing::name(name)), &[], shape, class);
    }
}

fn setting(name: &str, value: usize) -> Setting {
    Setting { name: drawing::name(name), value: drawing::integer(value as i128) }
}
