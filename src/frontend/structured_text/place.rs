//! Moves the places of rungs: what was read from a text of its own belongs to a place in a file.

use crate::ladder::BlockCall;
use crate::ladder::{
    ArrayItem, Circuit, Element, ElementKind, Expression, ExpressionKind, Literal, Name, Reference, Root, Rung,
    Statement, StatementKind, Step, Wire,
};
use crate::source::Span;

/// Where each span of the text lies in the file.
pub(super) type Places<'a> = &'a dyn Fn(Span) -> Span;

/// Moves every span of a rung as structured text makes them: without nodes and pins' circuits.
pub(super) fn rung(rung: &mut Rung, places: Places<'_>) {
    rung.span = places(rung.span);
    circuit(&mut rung.circuit, places);
}

fn circuit(circuit: &mut Circuit, places: Places<'_>) {
    circuit.span = places(circuit.span);
    for branch in &mut circuit.branches {
        branch.span = places(branch.span);
        branch.elements.iter_mut().for_each(|one| element(one, places));
    }
}

fn element(element: &mut Element, places: Places<'_>) {
    element.span = places(element.span);
    match &mut element.kind {
        ElementKind::Contact { operand, .. } => expression(operand, places),
        ElementKind::Coil { target, .. } => reference(target, places),
        ElementKind::Block(block) => call(block, places),
        ElementKind::Condition(condition) => expression(condition, places),
        ElementKind::Assignment { target, value } => {
            reference(target, places);
            expression(value, places);
        }
        ElementKind::Statements(list) => statements(list, places),
        ElementKind::Parallel(inner) => circuit(inner, places),
        ElementKind::Jump { target } => name(target, places),
        ElementKind::Return => {}
    }
}

fn statements(list: &mut [Statement], places: Places<'_>) {
    for statement in list {
        statement.span = places(statement.span);
        match &mut statement.kind {
            StatementKind::Assignment { target, value } => {
                reference(target, places);
                expression(value, places);
            }
            StatementKind::Call(block) => call(block, places),
            StatementKind::If { branches, otherwise } => {
                for branch in branches {
                    expression(&mut branch.condition, places);
                    statements(&mut branch.body, places);
                }
                statements(otherwise, places);
            }
            StatementKind::Case { selector, branches, otherwise } => {
                expression(selector, places);
                for branch in branches {
                    for label in &mut branch.labels {
                        expression(&mut label.first, places);
                        label.last.iter_mut().for_each(|last| expression(last, places));
                    }
                    statements(&mut branch.body, places);
                }
                statements(otherwise, places);
            }
            StatementKind::For { variable, first, last, step, body } => {
                reference(variable, places);
                expression(first, places);
                expression(last, places);
                step.iter_mut().for_each(|step| expression(step, places));
                statements(body, places);
            }
            StatementKind::Exit | StatementKind::Return => {}
        }
    }
}

fn call(call: &mut BlockCall, places: Places<'_>) {
    reference(&mut call.instance, places);
    call.type_name.iter_mut().chain(&mut call.power_output).for_each(|one| name(one, places));
    for argument in &mut call.arguments {
        argument.span = places(argument.span);
        name(&mut argument.pin, places);
        match &mut argument.wire {
            Wire::Value(value) => expression(value, places),
            Wire::Circuit(inner) => circuit(inner, places),
            Wire::Output(target) => reference(target, places),
        }
    }
}

fn expression(expression_: &mut Expression, places: Places<'_>) {
    expression_.span = places(expression_.span);
    match &mut expression_.kind {
        ExpressionKind::Literal(Literal::Enumerated { ty, value }) => {
            name(ty, places);
            name(value, places);
        }
        ExpressionKind::Literal(_) => {}
        ExpressionKind::Read(read) => reference(read, places),
        ExpressionKind::Unary(_, operand) => expression(operand, places),
        ExpressionKind::Binary(_, left, right) => {
            expression(left, places);
            expression(right, places);
        }
        ExpressionKind::Call { function, arguments } => {
            name(function, places);
            for argument in arguments {
                argument.parameter.iter_mut().for_each(|one| name(one, places));
                expression(&mut argument.value, places);
            }
        }
        ExpressionKind::Array(items) => {
            for ArrayItem { repeat, value } in items {
                repeat.iter_mut().chain(value).for_each(|one| expression(one, places));
            }
        }
        ExpressionKind::Structure(members) => {
            for member in members {
                name(&mut member.member, places);
                expression(&mut member.value, places);
            }
        }
    }
}

fn reference(reference: &mut Reference, places: Places<'_>) {
    reference.span = places(reference.span);
    match &mut reference.root {
        Root::Name(root) => name(root, places),
        Root::Address(address) => address.span = places(address.span),
    }
    for step in &mut reference.steps {
        match step {
            Step::Member(member) => name(member, places),
            Step::Bit(_, span) => *span = places(*span),
            Step::Index(indices, span) => {
                *span = places(*span);
                indices.iter_mut().for_each(|index| expression(index, places));
            }
        }
    }
}

fn name(name: &mut Name, places: Places<'_>) {
    name.span = places(name.span);
}
