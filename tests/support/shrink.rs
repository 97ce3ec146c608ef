//! Smaller programs out of a program: each leaves out one part.

use rung::ladder::{
    BlockCall, Circuit, Element, ElementKind, Expression, ExpressionKind, Program, Reference, Statement, StatementKind,
    Step, Wire,
};

/// The smallest program that can be made by leaving out one part after the other, such that `is_wrong` still holds.
pub(crate) fn smallest(program: &Program, mut is_wrong: impl FnMut(&Program) -> bool) -> Program {
    let mut smallest = program.clone();
    loop {
        let mut place = 0;
        let mut found = false;
        while let Some(smaller) = without(&smallest, place) {
            if is_wrong(&smaller) {
                (smallest, found) = (smaller, true);
            } else {
                place += 1;
            }
        }
        if !found {
            return smallest;
        }
    }
}

/// The program without one of its parts, the large ones first; none when there are not so many.
fn without(program: &Program, place: usize) -> Option<Program> {
    let mut smaller = program.clone();
    let mut cut = Cut { left: place, done: false };
    cut.program(&mut smaller);
    cut.done.then_some(smaller)
}

/// Counts parts down, and leaves out the one that it comes to at zero.
struct Cut {
    left: usize,
    done: bool,
}

impl Cut {
    fn is_here(&mut self) -> bool {
        if self.done || self.left > 0 {
            self.left = self.left.saturating_sub(usize::from(!self.done));
            return false;
        }
        self.done = true;
        true
    }

    /// Leaves out an item, of which at least so many stay.
    fn items<T>(&mut self, items: &mut Vec<T>, least: usize) {
        for place in (0..items.len()).rev() {
            if items.len() > least && self.is_here() {
                items.remove(place);
                return;
            }
        }
    }

    fn program(&mut self, program: &mut Program) {
        self.items(&mut program.units, 1);
        self.items(&mut program.instances, 0);
        for unit in &mut program.units {
            self.items(&mut unit.rungs, 0);
        }
        let rungs = |program: &mut Program, visit: &mut dyn FnMut(&mut Circuit)| {
            program.units.iter_mut().flat_map(|unit| &mut unit.rungs).for_each(|rung| visit(&mut rung.circuit));
        };
        rungs(program, &mut |circuit| self.circuit(circuit));
        for unit in &mut program.units {
            self.items(&mut unit.variables, 0);
            for variable in unit.variables.iter_mut().filter(|variable| variable.initial.is_some()) {
                if self.is_here() {
                    variable.initial = None;
                }
            }
        }
        self.items(&mut program.globals, 0);
        self.items(&mut program.types, 0);
        self.items(&mut program.tasks, 0);
    }

    fn circuit(&mut self, circuit: &mut Circuit) {
        self.items(&mut circuit.branches, 1);
        for branch in &mut circuit.branches {
            self.items(&mut branch.elements, 0);
            branch.elements.iter_mut().for_each(|element| self.element(element));
        }
    }

    fn element(&mut self, element: &mut Element) {
        match &mut element.kind {
            ElementKind::Contact { operand, .. } => self.expression(operand),
            ElementKind::Coil { target, .. } => self.reference(target),
            ElementKind::Block(call) => self.call(call),
            ElementKind::Condition(condition) => self.expression(condition),
            ElementKind::Assignment { target, value } => {
                self.reference(target);
                self.expression(value);
            }
            ElementKind::Statements(statements) => self.statements(statements, 1),
            ElementKind::Parallel(circuit) => self.circuit(circuit),
            ElementKind::Jump { .. } | ElementKind::Return => {}
        }
    }

    fn call(&mut self, call: &mut BlockCall) {
        self.items(&mut call.arguments, 0);
        if call.power_output.is_some() && self.is_here() {
            call.power_output = None;
        }
        for argument in &mut call.arguments {
            match &mut argument.wire {
                Wire::Value(value) => self.expression(value),
                Wire::Circuit(circuit) => self.circuit(circuit),
                Wire::Output(target) => self.reference(target),
            }
        }
    }

    fn statements(&mut self, statements: &mut Vec<Statement>, least: usize) {
        self.items(statements, least);
        for place in 0..statements.len() {
            let inner = match &statements[place].kind {
                StatementKind::If { branches, otherwise } => [&branches[0].body, otherwise].map(Clone::clone).to_vec(),
                StatementKind::Case { branches, otherwise, .. } => {
                    branches.iter().map(|branch| &branch.body).chain([otherwise]).cloned().collect()
                }
                StatementKind::For { body, .. } => vec![body.clone()],
                _ => continue,
            };
            for body in inner {
                if !body.is_empty() && self.is_here() {
                    statements.splice(place..=place, body);
                    return;
                }
            }
        }
        statements.iter_mut().for_each(|statement| self.statement(statement));
    }

    fn statement(&mut self, statement: &mut Statement) {
        match &mut statement.kind {
            StatementKind::Assignment { target, value } => {
                self.reference(target);
                self.expression(value);
            }
            StatementKind::Call(call) => self.call(call),
            StatementKind::If { branches, otherwise } => {
                self.items(branches, 1);
                for branch in branches {
                    self.expression(&mut branch.condition);
                    self.statements(&mut branch.body, 0);
                }
                self.statements(otherwise, 0);
            }
            StatementKind::Case { selector, branches, otherwise } => {
                self.expression(selector);
                self.items(branches, 1);
                for branch in branches {
                    self.items(&mut branch.labels, 1);
                    self.statements(&mut branch.body, 0);
                }
                self.statements(otherwise, 0);
            }
            StatementKind::For { body, .. } => self.statements(body, 0),
            StatementKind::Exit | StatementKind::Return => {}
        }
    }

    /// An operand stands for an operation.
    fn expression(&mut self, expression: &mut Expression) {
        let operands: Vec<Expression> = match &expression.kind {
            ExpressionKind::Unary(_, operand) => vec![(**operand).clone()],
            ExpressionKind::Binary(_, left, right) => vec![(**left).clone(), (**right).clone()],
            ExpressionKind::Call { arguments, .. } => arguments.iter().map(|argument| argument.value.clone()).collect(),
            _ => Vec::new(),
        };
        for operand in operands {
            if self.is_here() {
                *expression = operand;
                return;
            }
        }
        match &mut expression.kind {
            ExpressionKind::Read(reference) => self.reference(reference),
            ExpressionKind::Unary(_, operand) => self.expression(operand),
            ExpressionKind::Binary(_, left, right) => {
                self.expression(left);
                self.expression(right);
            }
            ExpressionKind::Call { arguments, .. } => {
                arguments.iter_mut().for_each(|argument| self.expression(&mut argument.value));
            }
            _ => {}
        }
    }

    fn reference(&mut self, reference: &mut Reference) {
        for step in &mut reference.steps {
            if let Step::Index(indices, _) = step {
                indices.iter_mut().for_each(|index| self.expression(index));
            }
        }
    }
}
