//! Variables and types as the editor has them in JSON.

use std::borrow::Cow;

use thin_vec::ThinVec;

use super::json::{Kind, Value};
use super::project::list;
use crate::diagnostic::Code;
use crate::elementary::Elementary;
use crate::frontend::graph::expression::{self, Fault};
use crate::frontend::graph::report::Report;
use crate::frontend::located;
use crate::ladder::{Dimension, Expression, ExpressionKind, Literal, Name, TypeReference, Variable, VariableClass};

/// The name of something that has to have one.
pub(super) fn name_of(value: Value<'_>, what: &str, report: &mut Report) -> Option<Name> {
    let name = value.member("name").and_then(|name| Some((name.text()?, name.span())));
    match name.filter(|(text, _)| !text.trim().is_empty()) {
        Some((text, span)) => Some(Name::new(text.trim(), span)),
        None => {
            report.error(Code::BadElement, value.span(), format!("this {what} has no name"));
            None
        }
    }
}

/// A variable; and whether it is a global one that a unit only names.
pub(super) fn variable(value: Value<'_>, report: &mut Report) -> Option<(Variable, bool)> {
    let name = name_of(value, "variable", report)?;
    let span = name.span;
    let class = value.text_of("class").unwrap_or(Cow::Borrowed("local"));
    let flag = value.text_of("flag").unwrap_or_default().to_ascii_lowercase();
    let class_of = match class.to_ascii_lowercase().as_str() {
        "input" => VariableClass::Input,
        "output" => VariableClass::Output,
        "inout" => VariableClass::InOut,
        "temp" => VariableClass::Temporary,
        "local" | "external" | "global" if flag == "constant" => VariableClass::Constant,
        "local" | "external" | "global" => VariableClass::Memory,
        other => {
            let message = format!("`{}` is of a class that there is not: {}", name.text, expression::clipped(other));
            report.error(Code::BadElement, span, message);
            return None;
        }
    };
    let ty = type_of(value, &name, report)?;
    let address = value.text_of("location").and_then(|text| match expression::address(text.trim(), span) {
        Ok(address) => Some(address),
        Err(_) if text.trim_end().ends_with('*') => located::open(text.trim(), span),
        Err(Fault::Bad(message)) => {
            report.error(Code::BadAddress, span, message);
            None
        }
        Err(fault) => {
            report.fault(fault, span);
            None
        }
    });
    let initial = value.member("initialValue").and_then(|initial| initial_value(initial, Some(&ty), report));
    let retain = flag == "retain";
    let external = class.eq_ignore_ascii_case("external");
    Some((
        Variable {
            class: class_of,
            name,
            ty: Some(ty),
            address: address.map(Box::new),
            initial: initial.map(Box::new),
            retain,
            span,
        },
        external,
    ))
}

/// The type in the member `type` of a variable or member.
pub(super) fn type_of(value: Value<'_>, name: &Name, report: &mut Report) -> Option<TypeReference> {
    let ty = value.member("type");
    let array = ty.filter(|ty| ty.text_of("definition").as_deref() == Some("array"));
    let data = array.and_then(|array| array.member("data"));
    let named = match data {
        Some(data) => data.member("baseType").and_then(|base| base.text_of("value")),
        None => ty.and_then(|ty| ty.text_of("value")),
    };
    let Some(named) = named else {
        report.error(Code::BadElement, name.span, format!("`{}` has no type", name.text));
        return None;
    };
    let dimensions = match data {
        Some(data) => dimensions(data, report)?,
        None => ThinVec::new(),
    };
    let text = if Elementary::from_name(&named).is_some() { named.to_uppercase() } else { named.trim().to_owned() };
    Some(TypeReference { dimensions, name: Name::new(text, name.span), span: name.span })
}

/// The bounds of an array, each as `0..9`.
pub(super) fn dimensions(value: Value<'_>, report: &mut Report) -> Option<ThinVec<Dimension>> {
    let mut dimensions = ThinVec::new();
    for item in list(value, "dimensions", report) {
        let span = item.span();
        let bounds = item.text_of("dimension").or_else(|| item.text()).unwrap_or_default();
        let Some((first, last)) = bounds.split_once("..") else {
            let message = format!("`{}` says no bounds of an array", expression::clipped(&bounds));
            report.error(Code::BadElement, span, message);
            return None;
        };
        let [first, last] = [first, last].map(|bound| report.read(expression::expression(bound, span), span));
        dimensions.push(Dimension { first: first?, last: last? });
    }
    if dimensions.is_empty() {
        report.error(Code::BadElement, value.span(), "this array has no dimension");
        return None;
    }
    Some(dimensions)
}

/// An initial value, where one is written.
pub(super) fn initial_value(value: Value<'_>, ty: Option<&TypeReference>, report: &mut Report) -> Option<Expression> {
    let span = value.span();
    let text = match value.kind() {
        Kind::Text => value.text()?,
        Kind::Number => Cow::Owned(value.number()?.to_string()),
        Kind::True => Cow::Borrowed("TRUE"),
        Kind::False => Cow::Borrowed("FALSE"),
        Kind::Null | Kind::Object | Kind::Array => return None,
    };
    if text.trim().is_empty() {
        return None;
    }
    let mut read = report.read(expression::initial_value(&text, span), span)?;
    let is_bool = ty.is_some_and(|ty| ty.dimensions.is_empty() && ty.name.text.eq_ignore_ascii_case("BOOL"));
    if let (true, ExpressionKind::Literal(Literal::Integer { value, ty: None, .. })) = (is_bool, &read.kind)
        && let bit @ (0 | 1) = value.get()
    {
        read.kind = ExpressionKind::Literal(Literal::Bool(bit == 1));
    }
    Some(read)
}
