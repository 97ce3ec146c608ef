//! What random programs really exercised, as a table.

use std::collections::BTreeMap;
use std::fmt;

use rung::elementary::Elementary;
use rung::ladder::library::StandardBlock;
use rung::ladder::{
    BlockCall, Branch, CaseLabel, Circuit, ElementKind, Expression, ExpressionKind, Literal, Program, Reference, Root,
    Statement, StatementKind, Step, TypeKind, UnitKind, Wire,
};

use super::oracle::Activity;

/// How often each kind of thing occurred and changed.
#[derive(Default)]
pub(crate) struct Coverage {
    counts: BTreeMap<String, Count>,
}

#[derive(Default)]
struct Count {
    occurred: u64,
    /// How many of them changed at least once.
    alive: u64,
    toggles: u64,
}

impl Coverage {
    /// Adds what the elements of one program did.
    pub(crate) fn add_activities(&mut self, activities: &[Activity]) {
        for activity in activities {
            let count = self.counts.entry(activity.kind.clone()).or_default();
            count.occurred += 1;
            count.alive += u64::from(activity.toggles > 0);
            count.toggles += activity.toggles;
        }
    }

    /// Adds what one program is made of.
    pub(crate) fn add_program(&mut self, program: &Program) {
        self.saw_if(program.registers.is_some(), "sizes of the register machine");
        program.types.iter().for_each(|declared| {
            self.saw(match declared.kind {
                TypeKind::Alias { .. } => "type with another name",
                TypeKind::Structure(_) => "type structure",
                TypeKind::Enumeration { .. } => "type enumeration",
            })
        });
        for unit in &program.units {
            self.saw(match unit.kind {
                UnitKind::Program { .. } => "unit program",
                UnitKind::FunctionBlock => "unit function block",
                UnitKind::Function { .. } => "unit function",
            });
        }
        program.instances.iter().for_each(|_| self.saw("named instance of a program"));
        program.tasks.iter().for_each(|_| self.saw("task"));
        program.globals.iter().for_each(|_| self.saw("global"));
        for variable in program.globals.iter().chain(program.units.iter().flat_map(|unit| &unit.variables)) {
            let array = variable.ty.as_ref().is_some_and(|ty| !ty.dimensions.is_empty());
            let many = variable.ty.as_ref().is_some_and(|ty| ty.dimensions.len() > 1);
            self.saw_if(many, "declared array of many dimensions");
            let ty = variable.ty.as_ref().map_or(Elementary::Bool.name(), |ty| &ty.name.text);
            let ty = if Elementary::from_name(ty).is_some() || StandardBlock::from_name(ty).is_some() {
                ty
            } else {
                "own type"
            };
            self.saw(&format!("declared {}{ty}", if array { "array of " } else { "" }));
            self.saw(&format!("declared {:?}", variable.class));
            self.saw_if(variable.initial.is_some(), "declared with an initial value");
            variable.initial.iter().for_each(|initial| self.add_expression(initial));
            self.saw_if(variable.retain, "declared retain");
            self.saw_if(variable.address.is_some(), "declared at an address");
        }
        for rung in program.rungs() {
            self.saw_if(!rung.enabled, "rung that is off");
            self.add_circuit(&rung.circuit);
        }
    }

    /// Adds what another table counted.
    pub(crate) fn add(&mut self, other: Self) {
        for (kind, more) in other.counts {
            let count = self.counts.entry(kind).or_default();
            count.occurred += more.occurred;
            count.alive += more.alive;
            count.toggles += more.toggles;
        }
    }

    /// The kinds that should occur and change but did not.
    pub(crate) fn missing<'a>(&self, kinds: &[&'a str]) -> Vec<&'a str> {
        let missing = |kind: &&&str| self.counts.get(**kind).is_none_or(|count| count.toggles == 0);
        kinds.iter().filter(missing).copied().collect()
    }

    /// Those of what programs are made of that never occurred.
    pub(crate) fn never_drawn<'a>(&self, kinds: &'a [String]) -> Vec<&'a str> {
        let missing = |kind: &&String| !self.counts.contains_key(&format!("- {kind}"));
        kinds.iter().filter(missing).map(String::as_str).collect()
    }

    fn saw(&mut self, kind: &str) {
        self.counts.entry(format!("- {kind}")).or_default().occurred += 1;
    }

    fn saw_if(&mut self, seen: bool, kind: &str) {
        if seen {
            self.saw(kind);
        }
    }

    fn add_circuit(&mut self, circuit: &Circuit) {
        for Branch { from, elements, to, .. } in &circuit.branches {
            self.saw_if(from.is_some() || to.is_some(), "branch at a node");
            self.saw_if(elements.is_empty(), "branch without elements");
            for element in elements {
                match &element.kind {
                    ElementKind::Contact { operand, .. } => self.add_expression(operand),
                    ElementKind::Coil { target, .. } => self.add_reference(target),
                    ElementKind::Condition(condition) => self.add_expression(condition),
                    ElementKind::Assignment { target, value } => {
                        self.add_reference(target);
                        self.add_expression(value);
                    }
                    ElementKind::Parallel(circuit) => self.add_circuit(circuit),
                    ElementKind::Jump { .. } | ElementKind::Return => {}
                    ElementKind::Block(call) => self.add_call(call),
                    ElementKind::Statements(statements) => self.add_statements(statements),
                }
            }
        }
    }

    fn add_call(&mut self, call: &BlockCall) {
        self.saw_if(call.power_output.is_some(), "call with a chosen power output");
        for argument in &call.arguments {
            self.saw_if(argument.pin.key() == "en", "pin EN");
            self.saw_if(argument.pin.key() == "eno", "pin ENO");
            match &argument.wire {
                Wire::Value(value) => {
                    self.saw("pin with a value");
                    self.add_expression(value);
                }
                Wire::Circuit(circuit) => {
                    self.saw("pin with a circuit");
                    self.add_circuit(circuit);
                }
                Wire::Output(target) => {
                    self.saw("pin with an output");
                    self.add_reference(target);
                }
            }
        }
    }

    fn add_statements(&mut self, statements: &[Statement]) {
        for statement in statements {
            match &statement.kind {
                StatementKind::Assignment { target, value } => {
                    self.add_reference(target);
                    self.add_expression(value);
                }
                StatementKind::Call(call) => self.add_call(call),
                StatementKind::If { branches, otherwise } => {
                    for branch in branches {
                        self.add_expression(&branch.condition);
                        self.add_statements(&branch.body);
                    }
                    self.add_statements(otherwise);
                }
                StatementKind::Case { selector, branches, otherwise } => {
                    self.add_expression(selector);
                    for branch in branches {
                        let is_range = |label: &CaseLabel| label.last.is_some();
                        self.saw_if(branch.labels.iter().any(is_range), "CASE of a range");
                        self.add_statements(&branch.body);
                    }
                    self.add_statements(otherwise);
                }
                StatementKind::For { variable, body, step, .. } => {
                    self.saw_if(step.is_some(), "FOR by a step");
                    self.add_reference(variable);
                    self.add_statements(body);
                }
                StatementKind::Exit | StatementKind::Return => {}
            }
        }
    }

    fn add_expression(&mut self, expression: &Expression) {
        match &expression.kind {
            ExpressionKind::Literal(Literal::Enumerated { .. }) => self.saw("operand of an enumeration"),
            ExpressionKind::Literal(_) => self.saw("operand literal"),
            ExpressionKind::Read(reference) => self.add_reference(reference),
            ExpressionKind::Unary(operator, operand) => {
                self.saw(&format!("operator {operator:?}"));
                self.add_expression(operand);
            }
            ExpressionKind::Binary(operator, left, right) => {
                self.saw(&format!("operator {}", operator.symbol()));
                self.add_expression(left);
                self.add_expression(right);
            }
            ExpressionKind::Call { function, arguments } => {
                self.saw(&format!("function {}", function.text));
                arguments.iter().for_each(|argument| self.add_expression(&argument.value));
            }
            ExpressionKind::Array(_) | ExpressionKind::Structure(_) => self.saw("initial value of many"),
        }
    }

    fn add_reference(&mut self, reference: &Reference) {
        self.saw_if(matches!(reference.root, Root::Address(_)), "operand address");
        for step in &reference.steps {
            self.saw(match step {
                Step::Member(_) => "operand member",
                Step::Bit(..) => "operand bit",
                Step::Index(..) => "operand index",
            });
            if let Step::Index(indices, _) = step {
                indices.iter().for_each(|index| self.add_expression(index));
            }
        }
    }
}

impl fmt::Display for Coverage {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{:34} {:>9} {:>9} {:>9}", "", "occurred", "changed", "changes")?;
        for (kind, count) in &self.counts {
            if kind.starts_with('-') {
                writeln!(f, "{kind:34} {:>9}", count.occurred)?;
            } else {
                writeln!(f, "{kind:34} {:>9} {:>9} {:>9}", count.occurred, count.alive, count.toggles)?;
            }
        }
        Ok(())
    }
}
