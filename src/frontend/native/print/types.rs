//! Declarations of types: on one line, but a structure always with its members one below the other, and an enumeration
//! if it has no room or a comment in it.

use unicode_width::UnicodeWidthStr;

use super::{LINE_WIDTH, Page, words};
use crate::ladder::{Expression, Field, Name, TypeDeclaration, TypeKind};

/// Where members and values stand.
const INSIDE: usize = 2;

/// Prints the declarations and the comments before and in them.
pub(super) fn print(page: &mut Page<'_>, types: &[TypeDeclaration]) {
    let mut apart = true;
    for declaration in types {
        let structure = matches!(declaration.kind, TypeKind::Structure(_));
        page.item(declaration.name.span.start, apart || structure);
        let head = format!("type {} : ", words::name(&declaration.name.text));
        let ends_at = page.text.len();
        match &declaration.kind {
            TypeKind::Alias { ty, initial } => {
                page.push(&format!("{head}{}{}", words::type_reference(ty), words::initial(initial.as_ref())));
            }
            TypeKind::Structure(fields) => {
                page.push(&format!("{head}struct"));
                print_fields(page, fields, declaration.span.end.saturating_sub(1));
            }
            TypeKind::Enumeration { base, values, initial } => {
                let base = base.as_ref().map_or(String::new(), |base| format!("{} ", words::name(&base.text)));
                let initial = initial.as_ref().map_or(String::new(), |name| format!(" := {}", words::name(&name.text)));
                print_enumeration(page, &format!("{head}{base}("), values, &format!("){initial}"));
            }
        }
        apart = page.text[ends_at..].contains('\n');
    }
}

fn print_fields(page: &mut Page<'_>, fields: &[Field], closing: u32) {
    let names: Vec<_> = fields.iter().map(|field| words::name(&field.name.text)).collect();
    let column = names.iter().map(|name| name.width()).max().unwrap_or(0);
    for (field, name) in fields.iter().zip(&names) {
        page.flush(field.name.span.start, INSIDE);
        page.line(INSIDE);
        let blanks = " ".repeat(column - name.width());
        let ty = words::type_reference(&field.ty);
        page.push(&format!("{name}{blanks} : {ty}{}", words::initial(field.initial.as_ref())));
    }
    page.flush(closing, INSIDE);
    page.line(0);
    page.push("end_struct");
}

fn print_enumeration(page: &mut Page<'_>, head: &str, values: &[(Name, Option<Expression>)], tail: &str) {
    let words: Vec<String> = values
        .iter()
        .map(|(name, number)| format!("{}{}", words::name(&name.text), words::initial(number.as_ref())))
        .collect();
    let line = format!("{head}{}{tail}", words.join(", "));
    let last = values.last().map_or(0, |(name, _)| name.span.start);
    if line.width() <= LINE_WIDTH && !page.has_comment_before(last) {
        page.push(&line);
        return;
    }
    page.push(head);
    for (index, ((name, _), word)) in values.iter().zip(&words).enumerate() {
        page.flush(name.span.start, INSIDE);
        page.line(INSIDE);
        page.push(word);
        page.push(if index + 1 < words.len() { "," } else { "" });
    }
    page.line(0);
    page.push(tail);
}
