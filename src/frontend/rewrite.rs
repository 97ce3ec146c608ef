//! Changes what rungs mention: every variable that is read or written, every call. It mirrors `uses`, which only looks.

use crate::ladder::{
    BlockCall, Circuit, Element, ElementKind, Expression, ExpressionKind, Reference, Statement, StatementKind, Step,
    Wire,
};

/// What is done to each.
pub(super) trait Change {
    /// To a variable, or to an instance that is called.
    fn reference(&mut self, reference: &mut Reference);

    /// To a call, before what is in it.
    fn call(&mut self, call: &mut BlockCall) {
        let _ = call;
    }
}

impl<F: FnMut(&mut Reference)> Change for F {
    fn reference(&mut self, reference: &mut Reference) {
        self(reference);
    }
}

/// Changes every reference in a circuit.
pub(super) fn references(circuit: &mut Circuit, change: &mut dyn Change) {
    for element in circuit.branches.iter_mut().flat_map(|branch| &mut branch.elements) {
        self::element(element, change);
    }
}

fn element(element: &mut Element, change: &mut dyn Change) {
    match &mut element.kind {
        ElementKind::Contact { operand, .. } => expression(operand, change),
        ElementKind::Coil { target, .. } => reference(target, change),
        ElementKind::Block(block) => call(block, change),
        ElementKind::Condition(condition) => expression(condition, change),
        ElementKind::Assignment { target, value } => {
            reference(target, change);
            expression(value, change);
        }
        ElementKind::Statements(list) => statements(list, change),
        ElementKind::Parallel(inner) => references(inner, change),
        ElementKind::Jump { .. } | ElementKind::Return => {}
    }
}

fn call(call: &mut BlockCall, change: &mut dyn Change) {
    change.call(call);
    reference(&mut call.instance, change);
    for argument in &mut call.arguments {
        match &mut argument.wire {
            Wire::Value(value) => expression(value, change),
            Wire::Circuit(inner) => references(inner, change),
            Wire::Output(target) => reference(target, change),
        }
    }
}

fn statements(list: &mut [Statement], change: &mut dyn Change) {
    for statement in list {
        match &mut statement.kind {
            StatementKind::Assignment { target, value } => {
                reference(target, change);
                expression(value, change);
            }
            StatementKind::Call(block) => call(block, change),
            StatementKind::If { branches, otherwise } => {
                for branch in branches {
                    expression(&mut branch.condition, change);
                    statements(&mut branch.body, change);
                }
                statements(otherwise, change);
            }
            StatementKind::Case { selector, branches, otherwise } => {
                expression(selector, change);
                for branch in branches {
                    for label in &mut branch.labels {
                        expression(&mut label.first, change);
                        label.last.iter_mut().for_each(|last| expression(last, change));
                    }
                    statements(&mut branch.body, change);
                }
                statements(otherwise, change);
            }
            StatementKind::For { variable, first, last, step, body } => {
                reference(variable, change);
                [first, last].into_iter().chain(step).for_each(|bound| expression(bound, change));
                statements(body, change);
            }
            StatementKind::Exit | StatementKind::Return => {}
        }
    }
}

fn expression(expression_: &mut Expression, change: &mut dyn Change) {
    match &mut expression_.kind {
        ExpressionKind::Literal(_) => {}
        ExpressionKind::Read(read) => reference(read, change),
        ExpressionKind::Unary(_, operand) => expression(operand, change),
        ExpressionKind::Binary(_, left, right) => {
            expression(left, change);
            expression(right, change);
        }
        ExpressionKind::Call { arguments, .. } => {
            arguments.iter_mut().for_each(|argument| expression(&mut argument.value, change));
        }
        ExpressionKind::Array(items) => {
            let parts = items.iter_mut().flat_map(|item| item.repeat.iter_mut().chain(&mut item.value));
            parts.for_each(|part| expression(part, change));
        }
        ExpressionKind::Structure(members) => {
            members.iter_mut().for_each(|member| expression(&mut member.value, change));
        }
    }
}

fn reference(reference: &mut Reference, change: &mut dyn Change) {
    change.reference(reference);
    for step in &mut reference.steps {
        if let Step::Index(indices, _) = step {
            indices.iter_mut().for_each(|index| expression(index, change));
        }
    }
}
