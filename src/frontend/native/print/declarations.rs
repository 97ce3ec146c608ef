//! Declarations: one a line, but names that were declared together stay together, with their clauses and their
//! comments in columns.

use unicode_width::UnicodeWidthStr;

use super::{LINE_WIDTH, Page, comment_lines, words};
use crate::ladder::{Comment, Variable, VariableClass};
use crate::source::Span;

/// The widest list of names that clauses are put in a column behind.
const WIDEST_NAMES: usize = 32;

/// The widest declaration that comments are put in a column behind.
const WIDEST_LINE: usize = 64;

/// One line to be.
struct Line<'a> {
    /// Keyword and names.
    names: String,
    /// What follows them, with a blank before it; empty if nothing does.
    clauses: String,
    comment: Option<&'a Comment>,
}

/// Prints the declarations and the comments before and behind them, all behind one word; without one each has that of its
/// class. What follows them starts at `end`.
pub(super) fn print(page: &mut Page<'_>, variables: &[Variable], word: Option<&str>, end: u32) {
    page.flush_trailing(variables.first().map_or(end, |variable| variable.name.span.start));
    let mut lines = Vec::new();
    let mut rest = variables;
    let mut separate = true;
    while let Some((first, after)) = rest.split_first() {
        if page.has_comment_before(first.name.span.start) {
            print_lines(page, &lines);
            lines.clear();
            page.blank_line();
            page.flush(first.name.span.start, 0);
        } else if std::mem::take(&mut separate) {
            page.blank_line();
        }
        separate = false;
        let names = 1 + together(page, word, first, after);
        let (group, others) = rest.split_at(names);
        rest = others;
        let mut line = Line { names: head(word, first.class), clauses: clauses(first), comment: None };
        let list: Vec<_> = group.iter().map(|variable| words::name(&variable.name.text)).collect();
        line.names.push_str(&list.join(", "));
        let next = rest.first().map_or(end, |variable| variable.name.span.start);
        if page.comments.first().is_some_and(|comment| !comment.own_line && !comment.text.contains('\n')) {
            line.comment = page.next_comment(next);
        }
        lines.push(line);
    }
    print_lines(page, &lines);
}

/// How many of the next variables were declared with the first, can stay with it, and have room on its line.
fn together(page: &Page<'_>, word: Option<&str>, first: &Variable, after: &[Variable]) -> usize {
    let same = |next: &&Variable| {
        first.span != Span::default()
            && next.span == first.span
            && next.class == first.class
            && next.retain == first.retain
            && next.ty == first.ty
            && next.address == first.address
            && next.initial == first.initial
            && !page.has_comment_before(next.name.span.start)
    };
    let others = after.iter().take_while(same);
    let mut width = head(word, first.class).len() + words::name(&first.name.text).width() + clauses(first).width();
    let room = |next: &&Variable| {
        width += 2 + words::name(&next.name.text).width();
        width <= LINE_WIDTH
    };
    others.take_while(room).count()
}

fn head(word: Option<&str>, class: VariableClass) -> String {
    if let Some(word) = word {
        let constant = if class == VariableClass::Constant { "const " } else { "" };
        return format!("{word}{constant}");
    }
    let keyword = match class {
        VariableClass::Input => "input",
        VariableClass::Output => "output",
        VariableClass::Memory => "var",
        VariableClass::Constant => "const",
        VariableClass::InOut => "inout",
        VariableClass::Temporary => "temp",
    };
    format!("{keyword:<7}")
}

fn clauses(variable: &Variable) -> String {
    let mut text = String::new();
    if let Some(ty) = &variable.ty {
        text.push_str(" : ");
        text.push_str(&words::type_reference(ty));
    }
    if let Some(address) = &variable.address {
        text.push_str(" at ");
        text.push_str(&address.to_string());
    }
    if let Some(initial) = &variable.initial {
        text.push_str(" := ");
        text.push_str(&words::expression(initial));
    }
    if variable.retain {
        text.push_str(" retain");
    }
    text
}

/// The column behind the widest of what is narrow enough.
fn column(widths: impl Iterator<Item = usize>, widest: usize) -> usize {
    widths.filter(|width| *width <= widest).max().unwrap_or(0)
}

fn print_lines(page: &mut Page<'_>, lines: &[Line<'_>]) {
    let with_clauses = lines.iter().filter(|line| !line.clauses.is_empty());
    let clause_column = column(with_clauses.map(|line| line.names.width()), WIDEST_NAMES);
    let text = |line: &Line<'_>| match line.clauses.as_str() {
        "" => line.names.clone(),
        clauses => format!("{}{clauses}", padded(&line.names, clause_column)),
    };
    let with_comment = lines.iter().filter(|line| line.comment.is_some());
    let comment_column = column(with_comment.map(|line| text(line).width()), WIDEST_LINE);
    for line in lines {
        page.line(0);
        match line.comment {
            None => page.push(&text(line)),
            Some(comment) => {
                page.push(&padded(&text(line), comment_column));
                page.push("  ");
                page.push(&comment_lines(&comment.text).concat());
                page.commented = true;
            }
        }
    }
}

fn padded(text: &str, width: usize) -> String {
    format!("{text}{}", " ".repeat(width.saturating_sub(text.width())))
}
