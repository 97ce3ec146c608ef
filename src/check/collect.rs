//! What the rungs declare by use: block instances named with their type, and addresses. Also the guard of everything
//! after it: no circuit or expression that is nested deeper than [`MAXIMUM_DEPTH`] may be walked by another stage.

use std::collections::HashMap;

use lean_string::LeanString;

use super::Checker;
use super::address::{Extent, class_of, direct_type};
use super::model::{ArrayType, Dimension, Initial, Type, Variable};
use super::scope::State;
use super::type_table::MOST_ELEMENTS;
use crate::diagnostic::{Code, Diagnostic};
use crate::elementary::Elementary;
use crate::ladder::{
    Address, BlockCall, Circuit, ElementKind, Expression, ExpressionKind, Literal, Reference, Root, Statement,
    StatementKind, Step, VariableClass, Wire,
};
use crate::source::Span;

/// The registers of the register machine, which their use declares.
const REGISTERS: [(&str, VariableClass); 3] =
    [("ireg", VariableClass::Input), ("oreg", VariableClass::Output), ("hreg", VariableClass::Memory)];

/// How many registers a class has that is used by a computed index and whose size is nowhere said.
const REGISTERS_BY_DEFAULT: i64 = 512;

/// Addresses and registers that rungs use, and that no declaration may come to declare.
#[derive(Default)]
pub(super) struct Direct {
    addresses: Vec<(Extent, Address)>,
    known: HashMap<Extent, ()>,
    /// For each class of registers, how many its uses need, and the first use.
    registers: [Option<(i64, Span)>; 3],
    /// How deep the rungs nest that were seen since this was 0.
    deepest: usize,
}

/// How deep circuits and expressions may nest, counted together: more than the native text's limits on circuits and on
/// expressions add up to.
pub const MAXIMUM_DEPTH: usize = 300;

/// What is nested too deeply.
struct TooDeep(Span);

fn deeper(depth: usize, span: Span) -> Result<usize, TooDeep> {
    if depth < MAXIMUM_DEPTH { Ok(depth + 1) } else { Err(TooDeep(span)) }
}

impl Checker<'_> {
    /// Declares the instances that the rungs of a unit declare by use, and notes the addresses and registers, and the rungs that are
    /// nested too deeply to be checked.
    ///
    /// Gives how deep they nest.
    pub(super) fn collect_instances(&mut self, unit: usize) -> usize {
        let program = self.program;
        self.direct.deepest = 0;
        for (index, rung) in program.units[unit].rungs.iter().enumerate() {
            if let Err(problem) = self.collect_circuit(&rung.circuit, 0) {
                self.report_depth(&problem);
                self.too_deep.insert((unit, index));
            }
        }
        self.direct.deepest
    }

    /// Declares, as global variables, the addresses and registers that rungs use and nothing declares.
    pub(super) fn declare_direct(&mut self) {
        self.scope.enter(None);
        let direct = std::mem::take(&mut self.direct);
        for (extent, address) in direct.addresses {
            if !self.scope.addresses.contains_key(&extent) {
                let ty = Type::Elementary(direct_type(address.width));
                let (name, span) = (address.to_string().into(), address.span);
                let variable = variable(name, class_of(address.area), ty, Some(Box::new(address)), span);
                let id = self.scope.add_nameless(variable, State::Known);
                self.scope.addresses.insert(extent, id);
            }
        }
        for ((name, class), used) in REGISTERS.into_iter().zip(direct.registers) {
            let size = self.registers.size_of(class);
            let Some((needed, span)) = used.or(size.map(|(_, span)| (0, span))) else { continue };
            let count = size.map_or(needed, |(size, _)| size).max(1);
            let fits = u32::try_from(count).ok().filter(|count| *count <= MOST_ELEMENTS);
            if fits.is_none() {
                let message = format!("there cannot be {count} registers");
                self.report.push(Diagnostic::new(Code::TooManyElements, span, message));
            }
            let (count, state) = fits.map_or((1, State::Broken), |count| (count, State::Known));
            let dimensions = vec![Dimension { first: 0, count }];
            let ty = Type::Array(self.array(ArrayType { dimensions, element: Type::Elementary(Elementary::Word) }));
            // One of that name was declared otherwise.
            let _ = self.scope.add(variable(name.into(), class, ty, None, span), state);
        }
    }

    /// As for a rung, for an initial value: whether it is shallow enough to be walked.
    pub(super) fn collect_initial(&mut self, expression: &Expression) -> bool {
        self.collect_expression(expression, 0).map_err(|problem| self.report_depth(&problem)).is_ok()
    }

    fn report_depth(&mut self, TooDeep(span): &TooDeep) {
        let message = format!("this is nested more than {MAXIMUM_DEPTH} deep");
        let problem = Diagnostic::new(Code::TooDeep, *span, message);
        self.report.push(problem.hint("split it, with a variable in between"));
    }

    fn collect_circuit(&mut self, circuit: &Circuit, depth: usize) -> Result<(), TooDeep> {
        let depth = deeper(depth, circuit.span)?;
        self.direct.deepest = self.direct.deepest.max(depth);
        for element in circuit.branches.iter().flat_map(|branch| &branch.elements) {
            match &element.kind {
                ElementKind::Contact { operand, .. } => self.collect_expression(operand, depth)?,
                ElementKind::Coil { target, .. } => self.collect_reference(target, depth)?,
                ElementKind::Block(call) => self.collect_call(call, depth)?,
                ElementKind::Condition(condition) => self.collect_expression(condition, depth)?,
                ElementKind::Assignment { target, value } => {
                    self.collect_reference(target, depth)?;
                    self.collect_expression(value, depth)?;
                }
                ElementKind::Parallel(circuit) => self.collect_circuit(circuit, depth)?,
                ElementKind::Statements(statements) => self.collect_statements(statements, depth)?,
                ElementKind::Jump { .. } | ElementKind::Return => {}
            }
        }
        Ok(())
    }

    fn collect_statements(&mut self, statements: &[Statement], depth: usize) -> Result<(), TooDeep> {
        for statement in statements {
            let depth = deeper(depth, statement.span)?;
            self.direct.deepest = self.direct.deepest.max(depth);
            match &statement.kind {
                StatementKind::Assignment { target, value } => {
                    self.collect_reference(target, depth)?;
                    self.collect_expression(value, depth)?;
                }
                StatementKind::Call(call) => self.collect_call(call, depth)?,
                StatementKind::If { branches, otherwise } => {
                    for branch in branches {
                        self.collect_expression(&branch.condition, depth)?;
                        self.collect_statements(&branch.body, depth)?;
                    }
                    self.collect_statements(otherwise, depth)?;
                }
                StatementKind::Case { selector, branches, otherwise } => {
                    self.collect_expression(selector, depth)?;
                    for branch in branches {
                        for label in &branch.labels {
                            self.collect_expression(&label.first, depth)?;
                            label.last.iter().try_for_each(|last| self.collect_expression(last, depth))?;
                        }
                        self.collect_statements(&branch.body, depth)?;
                    }
                    self.collect_statements(otherwise, depth)?;
                }
                StatementKind::For { variable, first, last, step, body } => {
                    self.collect_reference(variable, depth)?;
                    for bound in [Some(first), Some(last), step.as_ref()].into_iter().flatten() {
                        self.collect_expression(bound, depth)?;
                    }
                    self.collect_statements(body, depth)?;
                }
                StatementKind::Exit | StatementKind::Return => {}
            }
        }
        Ok(())
    }

    fn collect_call(&mut self, call: &BlockCall, depth: usize) -> Result<(), TooDeep> {
        self.collect_reference(&call.instance, depth)?;
        if let (Some(type_name), Some(instance)) = (&call.type_name, call.instance.as_name())
            && self.scope.find(instance).is_none()
        {
            // What is wrong with the type is said where the call is checked.
            let block = self.block_type(type_name);
            let ty = block.unwrap_or(Type::Elementary(Elementary::Bool));
            let state = if block.is_some() { State::Known } else { State::Broken };
            let name = instance.text.clone();
            let variable = variable(name, VariableClass::Memory, ty, None, instance.span);
            // There was none of that name.
            let _ = self.scope.add(variable, state);
        }
        for argument in &call.arguments {
            match &argument.wire {
                Wire::Value(value) => self.collect_expression(value, depth)?,
                Wire::Circuit(circuit) => self.collect_circuit(circuit, depth)?,
                Wire::Output(target) => self.collect_reference(target, depth)?,
            }
        }
        Ok(())
    }

    fn collect_expression(&mut self, expression: &Expression, depth: usize) -> Result<(), TooDeep> {
        let depth = deeper(depth, expression.span)?;
        self.direct.deepest = self.direct.deepest.max(depth);
        match &expression.kind {
            ExpressionKind::Literal(_) => {}
            ExpressionKind::Read(reference) => self.collect_reference(reference, depth)?,
            ExpressionKind::Array(items) => {
                for expression in items.iter().flat_map(|item| item.repeat.iter().chain(&item.value)) {
                    self.collect_expression(expression, depth)?;
                }
            }
            ExpressionKind::Structure(members) => {
                for member in members {
                    self.collect_expression(&member.value, depth)?;
                }
            }
            ExpressionKind::Unary(_, operand) => self.collect_expression(operand, depth)?,
            ExpressionKind::Binary(_, left, right) => {
                self.collect_expression(left, depth)?;
                self.collect_expression(right, depth)?;
            }
            ExpressionKind::Call { arguments, .. } => {
                for argument in arguments {
                    self.collect_expression(&argument.value, depth)?;
                }
            }
        }
        Ok(())
    }

    fn collect_reference(&mut self, reference: &Reference, depth: usize) -> Result<(), TooDeep> {
        match &reference.root {
            Root::Address(address) => {
                if let Some(extent) = self.extent(address)
                    && self.direct.known.insert(extent.clone(), ()).is_none()
                {
                    self.direct.addresses.push((extent, (**address).clone()));
                }
            }
            Root::Name(name) => {
                let class = REGISTERS.iter().position(|(register, _)| name.text.eq_ignore_ascii_case(register));
                if let Some(class) = class
                    && self.scope.find(name).is_none()
                {
                    let needed = registers_for(reference.steps.first());
                    let (most, _) = self.direct.registers[class].get_or_insert((0, name.span));
                    *most = needed.max(*most);
                }
            }
        }
        for step in &reference.steps {
            if let Step::Index(indices, _) = step {
                indices.iter().try_for_each(|index| self.collect_expression(index, depth))?;
            }
        }
        Ok(())
    }
}

/// How many registers there must be for one to be named like this.
fn registers_for(step: Option<&Step>) -> i64 {
    let Some(Step::Index(indices, _)) = step else { return REGISTERS_BY_DEFAULT };
    match indices.first().map(|index| &index.kind) {
        Some(ExpressionKind::Literal(Literal::Integer { value, .. })) => {
            i64::try_from(value.get()).ok().and_then(|index| index.checked_add(1)).unwrap_or(i64::MAX)
        }
        _ => REGISTERS_BY_DEFAULT,
    }
}

/// A variable that its first use declares.
fn variable(name: LeanString, class: VariableClass, ty: Type, address: Option<Box<Address>>, span: Span) -> Variable {
    Variable { name, class, ty, initial: Initial::Default, retain: false, address, shares: None, span }
}
