//! Calls of functions with EN, as other tools write them: `x := ADD(EN := a, IN1 := b, IN2 := c, ENO => e);`. While EN is FALSE such
//! a call gives the default of its type and ENO is FALSE. Here the assignment becomes an IF that says so:
//! `IF a THEN ADD(OUT => x, IN1 := b, IN2 := c, ENO => e); ELSE x := 0; e := FALSE; END_IF`.

use super::body::Scope;
use crate::diagnostic::{Code, Diagnostic};
use crate::elementary::Elementary;
use crate::frontend::text::Reader;
use crate::ladder::{
    BlockCall, ConditionalBranch, Expression, ExpressionKind, Literal, Name, Reference, Root, Statement, StatementKind,
    Step, TypeKind, TypeReference, Variable, Width, Wire, key,
};
use crate::source::Span;

/// The statement with every assigned call with EN in it replaced.
pub(super) fn statement(statement: Statement, scope: &Scope<'_>, reader: &mut Reader<'_>) -> Statement {
    let span = statement.span;
    let list = |list: Vec<Statement>, reader: &mut Reader<'_>| -> Vec<Statement> {
        list.into_iter().map(|one| self::statement(one, scope, reader)).collect()
    };
    let kind = match statement.kind {
        StatementKind::Call(call) if is_assigned(&call) => enabled(call, span, scope, reader),
        StatementKind::If { branches, otherwise } => StatementKind::If {
            branches: branches
                .into_iter()
                .map(|branch| ConditionalBranch { body: list(branch.body, reader), ..branch })
                .collect(),
            otherwise: list(otherwise, reader),
        },
        StatementKind::Case { selector, branches, otherwise } => StatementKind::Case {
            selector,
            branches: branches
                .into_iter()
                .map(|branch| crate::ladder::CaseBranch { body: list(branch.body, reader), ..branch })
                .collect(),
            otherwise: list(otherwise, reader),
        },
        StatementKind::For { variable, first, last, step, body } => {
            StatementKind::For { variable, first, last, step, body: list(body, reader) }
        }
        kind => kind,
    };
    Statement { kind, span }
}

/// Whether the call is the right side of an assignment, which stands before it.
fn is_assigned(call: &BlockCall) -> bool {
    call.arguments.first().is_some_and(|first| first.span.start < call.instance.span.start)
}

fn enabled(mut call: BlockCall, span: Span, scope: &Scope<'_>, reader: &mut Reader<'_>) -> StatementKind {
    let Some(enable) = call.arguments.iter().position(|argument| argument.pin.text.eq_ignore_ascii_case("EN")) else {
        return StatementKind::Call(call);
    };
    let Wire::Value(condition) = call.arguments.remove(enable).wire else { return StatementKind::Call(call) };
    let mut otherwise = Vec::new();
    for argument in &call.arguments {
        let Wire::Output(target) = &argument.wire else { continue };
        let value = if argument.pin.text.eq_ignore_ascii_case("ENO") {
            Some(ExpressionKind::Literal(Literal::Bool(false)))
        } else if argument.span.start < call.instance.span.start {
            let value = default_of_place(target, scope);
            if value.is_none() {
                let message =
                    "the type of what is assigned here is not known, and with it what the call gives while EN is FALSE";
                let problem = Diagnostic::new(Code::NotSupported, target.span, message);
                reader.report(problem.hint("assign to a variable of an elementary type that the unit declares"));
            }
            value
        } else {
            None
        };
        otherwise.extend(value.map(|kind| {
            let value = Expression { kind, span: target.span };
            Statement { kind: StatementKind::Assignment { target: target.clone(), value }, span: argument.span }
        }));
    }
    let body = vec![Statement { kind: StatementKind::Call(call), span }];
    StatementKind::If { branches: vec![ConditionalBranch { condition, body }], otherwise }
}

/// What a place of an elementary type or an enumeration holds by default.
fn default_of_place(place: &Reference, scope: &Scope<'_>) -> Option<ExpressionKind> {
    let mut ty = match &place.root {
        Root::Address(address) if place.steps.is_empty() => {
            return Some(zero(if address.width == Width::Bit { Elementary::Bool } else { Elementary::Word }));
        }
        Root::Address(_) => return Some(zero(Elementary::Bool)),
        Root::Name(name) => type_of_name(name, scope)?,
    };
    // An alias of an array stands for the array.
    let mut dimensions = ty.dimensions.len();
    for step in &place.steps {
        let resolved = resolve(ty, dimensions, scope)?;
        (ty, dimensions) = match step {
            Step::Bit(..) => return Some(zero(Elementary::Bool)),
            Step::Index(..) => (resolved, 0),
            Step::Member(member) => {
                let fields = scope.types.iter().find(|declared| declared.name.key() == key(&resolved.name.text))?;
                let TypeKind::Structure(fields) = &fields.kind else { return None };
                let ty = &fields.iter().find(|field| field.name.key() == member.key())?.ty;
                (ty, ty.dimensions.len())
            }
        };
    }
    let resolved = resolve(ty, dimensions, scope)?;
    default_of_type(resolved, dimensions, scope)
}

fn type_of_name<'a>(name: &Name, scope: &Scope<'a>) -> Option<&'a TypeReference> {
    let wanted = name.key();
    if let Some((_, ty)) = scope.result.filter(|(result, _)| result.key() == wanted) {
        return Some(ty);
    }
    let find = |variables: &'a [Variable]| variables.iter().find(|variable| variable.name.key() == wanted);
    find(scope.variables).or_else(|| find(scope.globals))?.ty.as_ref()
}

/// The type behind aliases: elementary, a structure, an enumeration or an array.
fn resolve<'a>(mut ty: &'a TypeReference, dimensions: usize, scope: &Scope<'a>) -> Option<&'a TypeReference> {
    if dimensions > 0 {
        return Some(ty);
    }
    for _ in 0..=scope.types.len() {
        let declared = scope.types.iter().find(|declared| declared.name.key() == key(&ty.name.text));
        match declared.map(|declared| &declared.kind) {
            Some(TypeKind::Alias { ty: of, .. }) => ty = of,
            _ => return Some(ty),
        }
        if !ty.dimensions.is_empty() {
            return Some(ty);
        }
    }
    None
}

fn default_of_type(ty: &TypeReference, dimensions: usize, scope: &Scope<'_>) -> Option<ExpressionKind> {
    if dimensions > 0 {
        return None;
    }
    if let Some(ty) = Elementary::from_name(&ty.name.text) {
        return Some(zero(ty));
    }
    let declared = scope.types.iter().find(|declared| declared.name.key() == key(&ty.name.text))?;
    let TypeKind::Enumeration { values, initial, .. } = &declared.kind else { return None };
    let value = initial.as_ref().or_else(|| values.first().map(|(name, _)| name))?.clone();
    Some(ExpressionKind::Literal(Literal::Enumerated { ty: Box::new(declared.name.clone()), value: Box::new(value) }))
}

fn zero(ty: Elementary) -> ExpressionKind {
    ExpressionKind::Literal(match ty {
        Elementary::Bool => Literal::Bool(false),
        Elementary::Time => Literal::Time(0),
        ty if ty.is_real() => Literal::Real { value: 0.0, ty: None },
        _ => Literal::Integer { value: 0.into(), base: 10, ty: None },
    })
}
