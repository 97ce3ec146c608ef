//! Units that are JSON as a whole, as early projects have them.

use std::collections::HashSet;

use super::json::{Kind, Value};
use super::project::list;
use super::variables::{name_of, variable};
use crate::diagnostic::{Code, Diagnostic};
use crate::frontend::graph::expression;
use crate::frontend::graph::report::Report;
use crate::frontend::structured_text::{self, Scope};
use crate::ladder::{Name, Program, Rung, TypeReference, Unit, UnitKind, Variable};
use crate::source::{Source, Span};

/// What a unit does.
pub(super) enum Body<'d> {
    /// A drawing.
    Drawn(Value<'d>),
    /// Structured text: where it stands, in quotes.
    Text(Span),
    /// Nothing that could be read.
    None,
}

/// Reads a unit without its body.
pub(super) fn read<'d>(value: Value<'d>, globals: &[Variable], report: &mut Report) -> Option<(Unit, Body<'d>)> {
    let Some(data) = value.member("data") else {
        report.error(Code::BadElement, value.span(), "this unit has no `data`");
        return None;
    };
    let name = name_of(data, "unit", report)?;
    let kind = match value.text_of("type").as_deref() {
        Some("program") => UnitKind::Program { task: None },
        Some("function-block") => UnitKind::FunctionBlock,
        Some("function") => {
            let result = data.text_of("returnType");
            let result = result.filter(|result| !result.eq_ignore_ascii_case("VOID"));
            let result =
                result.map(|result| TypeReference::of_name(Name::new(result.trim().to_uppercase(), name.span)));
            UnitKind::Function { result }
        }
        _ => {
            let message = format!("`{}` is no program, function-block or function", name.text);
            report.error(Code::BadElement, name.span, message);
            return None;
        }
    };
    let mut variables: Vec<Variable> = Vec::new();
    let mut names = HashSet::new();
    for declared in list(data, "variables", report) {
        let Some((variable, external)) = variable(declared, report) else { continue };
        if !names.insert(variable.name.key()) {
            let message = format!("`{}` is declared twice in `{}`", variable.name.text, name.text);
            report.error(Code::DuplicateName, variable.span, message);
        } else if !external {
            variables.push(variable);
        } else if globals.iter().all(|global| global.name.key() != variable.name.key()) {
            let message = format!("no resource declares the global variable `{}`", variable.name.text);
            report.error(Code::UndeclaredName, variable.span, message);
        }
    }
    let body = data.member("body");
    let language = body.and_then(|body| body.text_of("language")).unwrap_or_default();
    let content = body.and_then(|body| body.member("value"));
    let body = match (&*language, content) {
        ("ld" | "fbd", Some(content)) if content.kind() == Kind::Object => Body::Drawn(content),
        ("st", Some(content)) if content.kind() == Kind::Text => Body::Text(content.whole()),
        ("ld" | "fbd" | "st" | "", _) => {
            report.error(Code::BadElement, name.span, format!("`{}` has no body", name.text));
            Body::None
        }
        (language, _) => {
            let message =
                format!("the body of `{}` is in {}, which is not supported", name.text, expression::clipped(language));
            report.push(Diagnostic::new(Code::NotSupported, name.span, message));
            Body::None
        }
    };
    let span = name.span;
    Some((Unit { kind, name, variables, rungs: Vec::new(), span }, body))
}

/// The rungs of structured text in quotes. What stands for one sign in JSON takes as many bytes in the text that is read, so
/// that places stay.
pub(super) fn statements(
    source: &Source,
    quoted: Span,
    program: &Program,
    unit: usize,
    report: &mut Report,
) -> Vec<Rung> {
    let written = source.slice(quoted);
    let inner = written.get(1..written.len().saturating_sub(1)).unwrap_or("");
    let mut text = String::with_capacity(inner.len());
    let mut rest = inner;
    while let Some(at) = rest.find('\\') {
        text.push_str(&rest[..at]);
        let sign = rest[at + 1..].chars().next();
        let length = match sign {
            Some('u') => rest[at..].char_indices().nth(6).map_or(rest.len() - at, |(end, _)| end),
            Some(sign) => 1 + sign.len_utf8(),
            None => 1,
        };
        let shown = match sign {
            Some('n') => '\n',
            Some(sign @ ('"' | '\\' | '/')) => sign,
            // No word of structured text needs other signs, and within comments they are the same to it.
            _ => ' ',
        };
        text.extend(std::iter::repeat_n(' ', length - 1));
        text.push(shown);
        rest = &rest[at + length..];
    }
    text.push_str(rest);
    let this = &program.units[unit];
    let result = match &this.kind {
        UnitKind::Function { result: Some(result) } => Some((&this.name, result)),
        _ => None,
    };
    let scope = Scope { types: &program.types, globals: &program.globals, variables: &this.variables, result };
    let start = quoted.range().start + 1;
    let place = |span: Span| Span::new(start + span.range().start, start + span.range().end);
    let body = structured_text::body(&text, &scope, &place);
    body.diagnostics.into_iter().for_each(|problem| report.push(problem));
    body.rungs
}
