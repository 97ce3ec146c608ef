//! What rungs mention: variables, functions, blocks. Each thing is shown once for each place where it stands.

use crate::ladder::{
    BlockCall, Circuit, Element, ElementKind, Expression, ExpressionKind, Name, Program, Reference, Root, Statement,
    StatementKind, Step, Wire,
};

/// Something that is mentioned.
#[derive(Clone, Copy)]
pub(super) enum Use<'a> {
    /// A variable, read or written, or an instance that is called.
    Reference(&'a Reference),
    /// A function in an expression.
    Function(&'a Name),
    /// The type of a block that its call names, and the instance.
    Block(&'a Name, &'a Reference),
}

pub(super) type Visit<'v, 'a> = &'v mut dyn FnMut(Use<'a>);

/// The instances that no declaration but their call declares.
pub(super) fn blocks_declared_by_use<'a>(program: &'a Program, visit: &mut dyn FnMut(&'a Name)) {
    for rung in program.rungs() {
        circuit(&rung.circuit, &mut |mentioned| {
            if let Use::Block(_, instance) = mentioned
                && let Some(name) = instance.as_name()
            {
                visit(name);
            }
        });
    }
}

pub(super) fn circuit<'a>(circuit_: &'a Circuit, visit: Visit<'_, 'a>) {
    circuit_.branches.iter().flat_map(|branch| &branch.elements).for_each(|one| element(one, visit));
}

pub(super) fn element<'a>(element: &'a Element, visit: Visit<'_, 'a>) {
    match &element.kind {
        ElementKind::Contact { operand, .. } => expression(operand, visit),
        ElementKind::Coil { target, .. } => reference(target, visit),
        ElementKind::Block(block) => call(block, visit),
        ElementKind::Condition(condition) => expression(condition, visit),
        ElementKind::Assignment { target, value } => {
            reference(target, visit);
            expression(value, visit);
        }
        ElementKind::Statements(list) => statements(list, visit),
        ElementKind::Parallel(inner) => circuit(inner, visit),
        ElementKind::Jump { .. } | ElementKind::Return => {}
    }
}

pub(super) fn call<'a>(call: &'a BlockCall, visit: Visit<'_, 'a>) {
    reference(&call.instance, visit);
    if let Some(ty) = &call.type_name {
        visit(Use::Block(ty, &call.instance));
    }
    for argument in &call.arguments {
        match &argument.wire {
            Wire::Value(value) => expression(value, visit),
            Wire::Circuit(inner) => circuit(inner, visit),
            Wire::Output(target) => reference(target, visit),
        }
    }
}

pub(super) fn statements<'a>(list: &'a [Statement], visit: Visit<'_, 'a>) {
    for statement in list {
        match &statement.kind {
            StatementKind::Assignment { target, value } => {
                reference(target, visit);
                expression(value, visit);
            }
            StatementKind::Call(block) => call(block, visit),
            StatementKind::If { branches, otherwise } => {
                for branch in branches {
                    expression(&branch.condition, visit);
                    statements(&branch.body, visit);
                }
                statements(otherwise, visit);
            }
            StatementKind::Case { selector, branches, otherwise } => {
                expression(selector, visit);
                for branch in branches {
                    for label in &branch.labels {
                        expression(&label.first, visit);
                        label.last.iter().for_each(|last| expression(last, visit));
                    }
                    statements(&branch.body, visit);
                }
                statements(otherwise, visit);
            }
            StatementKind::For { variable, first, last, step, body } => {
                reference(variable, visit);
                [first, last].into_iter().chain(step).for_each(|bound| expression(bound, visit));
                statements(body, visit);
            }
            StatementKind::Exit | StatementKind::Return => {}
        }
    }
}

/// The calls among statements.
pub(super) fn calls<'a>(list: &'a [Statement], visit: &mut dyn FnMut(&'a BlockCall)) {
    for statement in list {
        match &statement.kind {
            StatementKind::Call(call) => visit(call),
            StatementKind::If { branches, otherwise } => {
                branches.iter().for_each(|branch| calls(&branch.body, visit));
                calls(otherwise, visit);
            }
            StatementKind::Case { branches, otherwise, .. } => {
                branches.iter().for_each(|branch| calls(&branch.body, visit));
                calls(otherwise, visit);
            }
            StatementKind::For { body, .. } => calls(body, visit),
            StatementKind::Assignment { .. } | StatementKind::Exit | StatementKind::Return => {}
        }
    }
}

pub(super) fn expression<'a>(expression_: &'a Expression, visit: Visit<'_, 'a>) {
    match &expression_.kind {
        ExpressionKind::Literal(_) => {}
        ExpressionKind::Read(read) => reference(read, visit),
        ExpressionKind::Unary(_, operand) => expression(operand, visit),
        ExpressionKind::Binary(_, left, right) => {
            expression(left, visit);
            expression(right, visit);
        }
        ExpressionKind::Call { function, arguments } => {
            visit(Use::Function(function));
            arguments.iter().for_each(|argument| expression(&argument.value, visit));
        }
        ExpressionKind::Array(items) => {
            items
                .iter()
                .flat_map(|item| item.repeat.iter().chain(&item.value))
                .for_each(|part| expression(part, visit));
        }
        ExpressionKind::Structure(members) => members.iter().for_each(|member| expression(&member.value, visit)),
    }
}

pub(super) fn reference<'a>(reference: &'a Reference, visit: Visit<'_, 'a>) {
    visit(Use::Reference(reference));
    for step in &reference.steps {
        if let Step::Index(indices, _) = step {
            indices.iter().for_each(|index| expression(index, visit));
        }
    }
}

/// Whether a mention depends on an index that is computed while the program runs.
pub(super) fn has_computed_index(mentioned: Use<'_>) -> bool {
    let Use::Reference(reference) = mentioned else { return false };
    let is_literal = |index: &Expression| match &index.kind {
        ExpressionKind::Unary(_, operand) => matches!(operand.kind, ExpressionKind::Literal(_)),
        kind => matches!(kind, ExpressionKind::Literal(_)),
    };
    reference.steps.iter().any(|step| match step {
        Step::Index(indices, _) => !indices.iter().all(is_literal),
        _ => false,
    })
}

/// The key of the name that a mention starts with.
pub(super) fn root_key(mentioned: Use<'_>) -> Option<String> {
    match mentioned {
        Use::Reference(reference) => match &reference.root {
            Root::Name(name) => Some(name.key()),
            Root::Address(_) => None,
        },
        Use::Function(name) | Use::Block(name, _) => Some(name.key()),
    }
}
