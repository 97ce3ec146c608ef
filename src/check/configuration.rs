//! What runs when: tasks, program instances, and the size of the register machine.

use std::collections::{HashMap, HashSet};

use lean_string::LeanString;

use super::Checker;
use super::model::{ProgramInstance, Task, TaskId, Type, UnitId};
use crate::diagnostic::{Code, Diagnostic};
use crate::elementary::Elementary;
use crate::ladder::{self, Name, UnitKind, VariableClass};
use crate::source::Span;

/// Registers of all classes together, unless the program says otherwise: those of the register machine's paper.
const REGISTERS: i64 = 2047;

/// What the register machine has. All but the registers of one class are limits only.
pub(super) struct Resources {
    classes: [Option<(i64, Span)>; 3],
    registers: i64,
    pub(super) timers: i64,
    pub(super) drums: i64,
    pub(super) shifts: i64,
}

impl Default for Resources {
    fn default() -> Self {
        Self { classes: [None; 3], registers: REGISTERS, timers: 64, drums: 16, shifts: 32 }
    }
}

impl Resources {
    /// How many registers of a class the program says that there are, and where.
    pub(super) fn size_of(&self, class: VariableClass) -> Option<(i64, Span)> {
        match class {
            VariableClass::Input => self.classes[0],
            VariableClass::Output => self.classes[1],
            _ => self.classes[2],
        }
    }
}

impl Checker<'_> {
    /// What `registers(…)` says.
    pub(super) fn check_registers(&mut self) {
        let Some(registers) = &self.program.registers else { return };
        for setting in &registers.settings {
            let Some(value) = self.bound(&setting.value) else { continue };
            let span = setting.value.span;
            if !(1..=i64::from(super::type_table::MOST_ELEMENTS)).contains(&value) {
                let message = format!("there cannot be {value} of them");
                self.report.push(Diagnostic::new(Code::OutOfRange, span, message));
                continue;
            }
            match setting.name.key().as_str() {
                "ireg" => self.registers.classes[0] = Some((value, span)),
                "oreg" => self.registers.classes[1] = Some((value, span)),
                "hreg" => self.registers.classes[2] = Some((value, span)),
                "registers" => self.registers.registers = value,
                "timers" => self.registers.timers = value,
                "drums" => self.registers.drums = value,
                "shifts" => self.registers.shifts = value,
                _ => {
                    let message = format!("the register machine has no `{}`", setting.name.text);
                    let problem = Diagnostic::new(Code::BadResource, setting.name.span, message);
                    self.report.push(problem.hint("it has ireg, oreg, hreg, registers, timers, drums and shifts"));
                }
            }
        }
    }

    /// Reports more registers than the register machine has.
    pub(super) fn check_register_count(&mut self) {
        let mut all = 0;
        let mut last = None;
        for name in ["ireg", "oreg", "hreg"] {
            let Some(id) = self.scope.find_global(name) else { continue };
            let variable = &self.scope.entry(id).variable;
            if let Type::Array(array) = variable.ty {
                all += i64::from(self.types.arrays[array.index()].count());
                last = Some(variable.span);
            }
        }
        if let (Some(span), true) = (last, all > self.registers.registers) {
            let message =
                format!("there are {all} registers here, and the register machine has {}", self.registers.registers);
            let problem = Diagnostic::new(Code::BadResource, span, message);
            self.report.push(problem.hint(format!("`registers(registers := {all})` gives it more")));
        }
    }

    /// The tasks in the order in which they run, and the program instances task by task.
    pub(super) fn check_tasks(&mut self) -> (Vec<Task>, Vec<ProgramInstance>) {
        let program = self.program;
        let mut names: HashMap<String, (usize, Span)> = HashMap::new();
        let mut tasks: Vec<(i64, Task)> = Vec::new();
        for declared in &program.tasks {
            if let Some((_, first)) = names.get(&declared.name.key()) {
                let message = format!("there are two tasks `{}`", declared.name.text);
                let problem = Diagnostic::new(Code::DuplicateName, declared.name.span, message);
                self.report.push(problem.related(*first, "the first is here"));
                continue;
            }
            names.insert(declared.name.key(), (tasks.len(), declared.name.span));
            let interval = declared.interval.as_ref().and_then(|interval| self.interval(interval));
            let priority = declared.priority.as_ref().and_then(|priority| self.bound(priority)).unwrap_or(0);
            tasks.push((priority, Task { name: declared.name.text.clone(), interval, span: declared.name.span }));
        }
        let mut instances: Vec<(usize, ProgramInstance)> = Vec::new();
        let free = tasks.len();
        let mut unit_of = HashMap::new();
        let instantiated: HashSet<String> = program.instances.iter().map(|instance| instance.program.key()).collect();
        for (index, unit) in (0..).zip(&program.units) {
            let UnitKind::Program { task } = &unit.kind else { continue };
            unit_of.entry(unit.name.key()).or_insert(UnitId(index));
            if instantiated.contains(&unit.name.key()) {
                continue;
            }
            let place = task.as_ref().map_or(Some(free), |task| self.task_named(task, &names));
            let instance = ProgramInstance { name: unit.name.text.clone(), unit: UnitId(index), task: TaskId(0) };
            instances.extend(place.map(|place| (place, instance)));
        }
        for declared in &program.instances {
            let place = declared.task.as_ref().map_or(Some(free), |task| self.task_named(task, &names));
            let Some(unit) = unit_of.get(&declared.program.key()).copied() else {
                let message = format!("there is no program `{}`", declared.program.text);
                self.report.push(Diagnostic::new(Code::BadResource, declared.program.span, message));
                continue;
            };
            let instance = ProgramInstance { name: declared.name.text.clone(), unit, task: TaskId(0) };
            instances.extend(place.map(|place| (place, instance)));
        }
        self.check_instance_names(&instances);
        // A stable sort: tasks of one priority run as declared.
        let mut order: Vec<usize> = (0..tasks.len()).collect();
        order.sort_by_key(|task| tasks[*task].0);
        order.push(free);
        let mut programs = Vec::with_capacity(instances.len());
        let mut by_task: Vec<Vec<ProgramInstance>> = vec![Vec::new(); order.len()];
        for (place, instance) in instances {
            by_task[place].push(instance);
        }
        let mut ordered = Vec::with_capacity(order.len());
        for (id, task) in (0..).zip(&order) {
            let of_task = std::mem::take(&mut by_task[*task]).into_iter();
            programs.extend(of_task.map(|instance| ProgramInstance { task: TaskId(id), ..instance }));
            let without = Task { name: LeanString::new(), interval: None, span: Span::default() };
            ordered.push(tasks.get(*task).map_or(without, |(_, task)| task.clone()));
        }
        (ordered, programs)
    }

    fn interval(&mut self, interval: &ladder::Expression) -> Option<i64> {
        if !self.collect_initial(interval) {
            return None;
        }
        let value = self.value(interval, Elementary::Time)?.constant();
        let nanoseconds = value.and_then(|value| i64::try_from(value.as_integer()?).ok());
        if nanoseconds.is_none_or(|nanoseconds| nanoseconds <= 0) {
            let problem =
                Diagnostic::new(Code::BadResource, interval.span, "an interval is a constant time above zero");
            self.report.push(problem.hint("write it as `interval := 10ms`; without one the task runs in every round"));
            return None;
        }
        nanoseconds
    }

    fn task_named(&mut self, name: &Name, names: &HashMap<String, (usize, Span)>) -> Option<usize> {
        let found = names.get(&name.key()).map(|(place, _)| *place);
        if found.is_none() {
            let message = format!("there is no task `{}`", name.text);
            let problem = Diagnostic::new(Code::BadResource, name.span, message);
            self.report.push(problem.hint(format!("declare it: `task {}(interval := 10ms)`", name.text)));
        }
        found
    }

    /// Reports program instances and units of one name, and no program at all.
    fn check_instance_names(&mut self, instances: &[(usize, ProgramInstance)]) {
        let program = self.program;
        let mut instances_of: HashMap<String, usize> = HashMap::new();
        for instance in &program.instances {
            *instances_of.entry(instance.program.key()).or_default() += 1;
        }
        let mut names: HashMap<String, Span> = HashMap::new();
        let mut declare = |checker: &mut Self, what: &str, name: &Name| {
            if let Some(first) = names.get(&name.key()) {
                let message = format!("{what} `{}` is declared twice", name.text);
                let problem = Diagnostic::new(Code::DuplicateName, name.span, message);
                checker.report.push(problem.related(*first, "declared first here"));
            } else {
                names.insert(name.key(), name.span);
            }
        };
        for unit in &program.units {
            let what = match unit.kind {
                UnitKind::Program { .. } => "the program",
                // That was said when the types were declared.
                UnitKind::FunctionBlock if self.is_type_twice(&unit.name) => continue,
                UnitKind::FunctionBlock => "the function block",
                UnitKind::Function { .. } => "the function",
            };
            declare(self, what, &unit.name);
        }
        for instance in &program.instances {
            let is_only = instance.name.key() == instance.program.key() && instances_of[&instance.program.key()] == 1;
            // The only instance of a program may have its name.
            if !is_only {
                declare(self, "the program instance", &instance.name);
            }
        }
        if instances.len() > 1 {
            self.check_global_names(instances);
        }
        if instances.is_empty() && !self.report.has_errors() {
            let problem = Diagnostic::new(Code::BadResource, program.name.span, "there is no program that runs");
            self.report.push(problem.hint("function blocks and functions run where a program calls them"));
        }
    }

    /// Reports program instances that are called as a global variable: `a.b` would be a variable of the one and a member of the
    /// other.
    fn check_global_names(&mut self, instances: &[(usize, ProgramInstance)]) {
        for (_, instance) in instances {
            let Some(global) = self.scope.find_global(&instance.name) else { continue };
            let declared = self.scope.entry(global).variable.span;
            let message = format!("`{}` is also the name of a program that runs", instance.name);
            let problem = Diagnostic::new(Code::DuplicateName, declared, message);
            self.report
                .push(problem.hint("rename one of the two: traces tell `program.variable` from `variable.member`"));
        }
    }
}
