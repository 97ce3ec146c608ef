//! What the rungs declare by use: block instances named with their type, and addresses. Also the guard of everything
//! after it: no circuit or expression that is nested deeper than [`MAXIMUM_DEPTH`] may be walked by another stage.

use std::collections::HashSet;

use super::Checker;
use super::address::{class_of, direct_type};
use super::model::{Type, Variable};
use super::scope::State;
use crate::diagnostic::{Code, Diagnostic};
use crate::elementary::{Elementary, Value};
use crate::ladder::library::StandardBlock;
use crate::ladder::{
    Address, BlockCall, Circuit, ElementKind, Expression, ExpressionKind, Reference, Root, VariableClass, Wire,
};
use crate::source::Span;

/// How deep circuits and expressions may nest, counted together: more than the native text's limits on circuits and on
/// expressions add up to.
pub const MAXIMUM_DEPTH: usize = 300;

/// What is nested too deeply.
struct TooDeep(Span);

fn deeper(depth: usize, span: Span) -> Result<usize, TooDeep> {
    if depth < MAXIMUM_DEPTH { Ok(depth + 1) } else { Err(TooDeep(span)) }
}

impl Checker<'_> {
    /// Declares what the rungs declare by use. The result: those rungs that are nested too deeply to be checked.
    pub(super) fn collect_uses(&mut self) -> HashSet<usize> {
        let mut too_deep = HashSet::new();
        for (index, rung) in self.program.rungs.iter().enumerate() {
            if let Err(problem) = self.collect_circuit(&rung.circuit, 0) {
                self.report_depth(&problem);
                too_deep.insert(index);
            }
        }
        too_deep
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
        for element in circuit.branches.iter().flat_map(|branch| &branch.elements) {
            match &element.kind {
                ElementKind::Contact { operand, .. } => self.collect_expression(operand, depth)?,
                ElementKind::Coil { target, .. } => self.collect_reference(target),
                ElementKind::Block(call) => self.collect_call(call, depth)?,
                ElementKind::Condition(condition) => self.collect_expression(condition, depth)?,
                ElementKind::Assignment { target, value } => {
                    self.collect_reference(target);
                    self.collect_expression(value, depth)?;
                }
                ElementKind::Parallel(circuit) => self.collect_circuit(circuit, depth)?,
                ElementKind::Jump { .. } | ElementKind::Return => {}
            }
        }
        Ok(())
    }

    fn collect_call(&mut self, call: &BlockCall, depth: usize) -> Result<(), TooDeep> {
        if let Some(type_name) = &call.type_name
            && self.scope.find(&call.instance).is_none()
        {
            // What is wrong with the type is said where the call is checked.
            let block = StandardBlock::from_name(&type_name.text);
            let ty = block.map_or(Type::Elementary(Elementary::Bool), Type::Block);
            let state = if block.is_some() { State::Known } else { State::Broken };
            let name = call.instance.text.clone();
            let variable = variable(name, VariableClass::Memory, ty, None, call.instance.span);
            // There was none of that name.
            let _ = self.scope.add(variable, state);
        }
        for argument in &call.arguments {
            match &argument.wire {
                Wire::Value(value) => self.collect_expression(value, depth)?,
                Wire::Circuit(circuit) => self.collect_circuit(circuit, depth)?,
                Wire::Output(target) => self.collect_reference(target),
            }
        }
        Ok(())
    }

    fn collect_expression(&mut self, expression: &Expression, depth: usize) -> Result<(), TooDeep> {
        let depth = deeper(depth, expression.span)?;
        match &expression.kind {
            ExpressionKind::Literal(_) => {}
            ExpressionKind::Read(reference) => self.collect_reference(reference),
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

    fn collect_reference(&mut self, reference: &Reference) {
        if let Root::Address(address) = &reference.root
            && let Some(extent) = self.extent(address)
            && !self.scope.addresses.contains_key(&extent)
        {
            let ty = Type::Elementary(direct_type(address.width));
            let variable =
                variable(address.to_string(), class_of(address.area), ty, Some(address.clone()), address.span);
            let id = self.scope.add_nameless(variable, State::Known);
            self.scope.addresses.insert(extent, id);
        }
    }
}

/// A variable that its first use declares.
fn variable(name: String, class: VariableClass, ty: Type, address: Option<Address>, span: Span) -> Variable {
    let initial = Value::default_of(match ty {
        Type::Elementary(ty) => ty,
        Type::Block(_) => Elementary::Bool,
    });
    Variable { name, class, ty, initial, retain: false, address, shares: None, span }
}
